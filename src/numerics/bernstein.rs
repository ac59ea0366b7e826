//! Polynomials in Bernstein form, by way of the Chebyshev expansion.
//!
//! Values at Chebyshev-Lobatto points give Chebyshev coefficients, and these give Bernstein
//! coefficients by closed formulas: no linear system is solved, so every matrix entry is right to a few
//! roundings. The Bernstein coefficients of a polynomial on [-1, 1] bound it from both sides.
//!
//! Reference: R. T. Farouki, *The Bernstein polynomial basis: a centennial retrospective*, CAGD 29 (2012).

use nalgebra::DMatrix;

/// Takes values at the n + 1 Chebyshev-Lobatto points (ascending) to Chebyshev coefficients c_0 … c_n.
pub fn chebyshev_from_values(degree: usize) -> DMatrix<f64> {
    let n = degree.max(1);
    DMatrix::from_fn(n + 1, n + 1, |k, j| {
        // Point j is −cos(πj/n), so the j-th from the other end of the usual order; k (n − j) is
        // reduced by integers to keep the cosine's argument small.
        let turn = (k * (n - j)) % (2 * n);
        let half = |i: usize| if i == 0 || i == n { 0.5 } else { 1.0 };
        2.0 / n as f64 * half(k) * half(j) * (std::f64::consts::PI * turn as f64 / n as f64).cos()
    })
}

/// Takes Chebyshev coefficients c_0 … c_n to the n + 1 Bernstein coefficients of degree n on [-1, 1].
pub fn bernstein_from_chebyshev(degree: usize) -> DMatrix<f64> {
    let n = degree;
    let mut m = DMatrix::zeros(n + 1, n + 1);
    let mut column = Vec::with_capacity(n + 1);
    for k in 0..=n {
        // T_k has the degree-k Bernstein coefficients (−1)^{k−i} C(2k, 2i) / C(k, i).
        column.clear();
        column.extend((0..=k).map(|i| {
            let c = binomial(2 * k, 2 * i) / binomial(k, i);
            if (k - i) % 2 == 0 {
                c
            } else {
                -c
            }
        }));
        // Raise the degree to n by convex combinations.
        for d in k..n {
            let raised = |i: usize| {
                let share = i as f64 / (d + 1) as f64;
                let before = if i > 0 { column[i - 1] * share } else { 0.0 };
                let after = if i <= d { column[i] * (1.0 - share) } else { 0.0 };
                before + after
            };
            column = (0..=d + 1).map(raised).collect();
        }
        m.column_mut(k).copy_from_slice(&column);
    }
    m
}

/// n over k in floating point, exact up to 2^53.
fn binomial(n: usize, k: usize) -> f64 {
    (0..k.min(n - k)).fold(1.0, |b, i| (b * (n - i) as f64 / (i + 1) as f64).round())
}

/// Largest sum of absolute values over a row.
pub fn row_sum_norm(m: &DMatrix<f64>) -> f64 {
    m.row_iter().map(|r| r.iter().map(|x| x.abs()).sum()).fold(0.0, f64::max)
}
