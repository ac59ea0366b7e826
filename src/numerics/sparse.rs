//! Sparse symmetric positive definite systems: one factorisation, many solves.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};

/// The Cholesky factors of a sparse symmetric positive definite matrix.
///
/// The order of elimination (approximate minimum degree) and every sum in it depend on the matrix
/// alone and run on one thread, so the same matrix gives the same bits.
#[derive(Debug, Clone)]
pub struct Cholesky {
    size: usize,
    factors: Llt<u32, f64>,
}

/// An entry (row, column, value) of the lower triangle; entries of the same place are added up.
pub type Entry = (u32, u32, f64);

impl Cholesky {
    /// Factors the `size` × `size` matrix whose lower triangle (row ≥ column) is the sum of `entries`.
    ///
    /// `Err` says in words what is wrong: an index out of range, an entry above the diagonal, a value
    /// that is not finite, a matrix that is not positive definite, or too little memory.
    pub fn new(size: usize, entries: impl IntoIterator<Item = Entry>) -> Result<Cholesky, String> {
        let entries = entries.into_iter();
        let mut triplets = Vec::with_capacity(entries.size_hint().0);
        for (row, column, value) in entries {
            if row as usize >= size || column > row {
                return Err(format!("entry ({row}, {column}) is outside the lower triangle of size {size}"));
            }
            if !value.is_finite() {
                return Err(format!("entry ({row}, {column}) is not finite"));
            }
            triplets.push(Triplet::new(row, column, value));
        }
        let matrix = SparseColMat::try_new_from_triplets(size, size, &triplets)
            .map_err(|e| format!("sparse matrix: {e:?}"))?;
        // They take about as much room as the factors that come now.
        drop(triplets);
        let symbolic =
            SymbolicLlt::try_new(matrix.symbolic(), Side::Lower).map_err(|e| format!("ordering: {e:?}"))?;
        let factors = Llt::try_new_with_symbolic(symbolic, matrix.as_ref(), Side::Lower)
            .map_err(|e| format!("Cholesky: {e:?}"))?;
        Ok(Cholesky { size, factors })
    }

    /// Solves for `K` right-hand sides at once: `b[i][k]` is row i of the k-th.
    ///
    /// `Err` if the length of `b` is not the matrix's size or the solution is not finite.
    pub fn solve<const K: usize>(&self, b: &[[f64; K]]) -> Result<Vec<[f64; K]>, String> {
        if b.len() != self.size {
            return Err(format!("right-hand side of length {} for size {}", b.len(), self.size));
        }
        if self.size == 0 {
            return Ok(Vec::new());
        }
        let mut x = Mat::from_fn(self.size, K, |i, k| b[i][k]);
        self.factors.solve_in_place(x.as_mut());
        let solution: Vec<[f64; K]> = (0..self.size).map(|i| std::array::from_fn(|k| x[(i, k)])).collect();
        match solution.iter().flatten().all(|v| v.is_finite()) {
            true => Ok(solution),
            false => Err("the solution is not finite".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// −u″ on n points: tridiagonal (2, −1).
    fn second_difference(n: u32) -> Vec<Entry> {
        let mut entries = Vec::new();
        for i in 0..n {
            // The diagonal in two halves: repeated entries have to add up.
            entries.extend([(i, i, 1.0), (i, i, 1.0)]);
            if i > 0 {
                entries.push((i, i - 1, -1.0));
            }
        }
        entries
    }

    #[test]
    fn solves_two_right_hand_sides() {
        let n = 500;
        let a = Cholesky::new(n, second_difference(n as u32)).unwrap();
        let exact: Vec<[f64; 2]> = (0..n).map(|i| [(i as f64 * 0.1).sin(), i as f64]).collect();
        let at = |i: isize, k: usize| match usize::try_from(i).ok().filter(|&i| i < n) {
            Some(i) => exact[i][k],
            None => 0.0,
        };
        let b: Vec<[f64; 2]> = (0..n as isize)
            .map(|i| std::array::from_fn(|k| 2.0 * at(i, k) - at(i - 1, k) - at(i + 1, k)))
            .collect();
        let x = a.solve(&b).unwrap();
        for (x, e) in x.iter().zip(&exact) {
            assert!((x[0] - e[0]).abs() < 1e-8 && (x[1] - e[1]).abs() < 1e-6, "{x:?} {e:?}");
        }
        assert_eq!(x, Cholesky::new(n, second_difference(n as u32)).unwrap().solve(&b).unwrap());
    }

    #[test]
    fn refuses_what_it_cannot_factor() {
        assert!(Cholesky::new(2, [(0, 0, 1.0), (1, 1, -1.0)]).is_err());
        assert!(Cholesky::new(2, [(0, 0, 1.0), (0, 1, 1.0)]).is_err());
        assert!(Cholesky::new(1, [(0, 0, f64::NAN)]).is_err());
        assert!(Cholesky::new(1, [(0, 0, 1.0)]).unwrap().solve(&[[1.0], [2.0]]).is_err());
        assert_eq!(Cholesky::new(0, []).unwrap().solve::<1>(&[]).unwrap(), Vec::<[f64; 1]>::new());
    }
}
