//! Products of small dense matrices stored row by row, without allocation: elements have a few dozen
//! nodes, where a general matrix product spends most of its time on overhead.

use nalgebra::DMatrix;

/// The entries of `m` row by row.
pub(super) fn row_major(m: &DMatrix<f64>) -> Vec<f64> {
    m.transpose().as_slice().to_vec()
}

/// The entries of the transpose of `m` row by row.
pub(super) fn row_major_transposed(m: &DMatrix<f64>) -> Vec<f64> {
    m.as_slice().to_vec()
}

/// out = a · b with a of rows × inner and b of inner × columns, row by row.
pub(super) fn multiply(a: &[f64], b: &[f64], rows: usize, inner: usize, columns: usize, out: &mut Vec<f64>) {
    out.clear();
    out.resize(rows * columns, 0.0);
    for (row, into) in a.chunks_exact(inner).zip(out.chunks_exact_mut(columns)) {
        for (c, source) in row.iter().zip(b.chunks_exact(columns)) {
            for (o, s) in into.iter_mut().zip(source) {
                *o += c * s;
            }
        }
    }
}

/// The transpose of `a`, of `rows` rows.
pub(super) fn transpose(a: &[f64], rows: usize, out: &mut Vec<f64>) {
    let columns = a.len() / rows;
    out.clear();
    for c in 0..columns {
        out.extend((0..rows).map(|r| a[r * columns + c]));
    }
}
