//! Polynomials given at Gauss-Lobatto nodes, in Legendre's: evaluated anywhere without a division.
//!
//! Reference: C. W. Clenshaw, *A note on the summation of Chebyshev series*, Mathematics of Computation 9 (1955),
//! for the recurrence of Legendre polynomials.

use super::{legendre, GaussLobatto, Point, Vector};

/// The change from values at the N + 1 Gauss-Lobatto nodes to Legendre coefficients, and their sums.
#[derive(Debug, Clone, PartialEq)]
pub struct Modal {
    /// `to_modes[k * (N + 1) + i]`: share of node i in coefficient k.
    to_modes: Vec<f64>,
    /// P_{k+1} = up\[k\] x P_k − down\[k\] P_{k−1}.
    up: Vec<f64>,
    down: Vec<f64>,
}

impl Modal {
    /// For polynomials of the rule's order.
    pub fn new(rule: &GaussLobatto) -> Self {
        let order = rule.order();
        let mut to_modes = Vec::with_capacity((order + 1) * (order + 1));
        for k in 0..=order {
            // The rule's own norm of P_k: exact but for the last.
            let norm = if k == order { 2.0 / order.max(1) as f64 } else { 2.0 / (2 * k + 1) as f64 };
            to_modes.extend(rule.nodes.iter().zip(&rule.weights).map(|(x, w)| w * legendre(k, *x).0 / norm));
        }
        let k = |k: usize| k as f64;
        Modal {
            to_modes,
            up: (0..=order).map(|i| (2.0 * k(i) + 1.0) / (k(i) + 1.0)).collect(),
            down: (0..=order + 1).map(|i| k(i) / (k(i) + 1.0)).collect(),
        }
    }

    /// Coefficients of the polynomial that has these values at the nodes.
    pub fn modes(&self, values: &[Point], out: &mut [Vector]) {
        for (mode, row) in out.iter_mut().zip(self.to_modes.chunks_exact(values.len())) {
            *mode = Vector::zeros();
            for (value, share) in values.iter().zip(row) {
                *mode += value.coords * *share;
            }
        }
    }

    /// The polynomial of coefficients `modes` at `x` in [-1, 1].
    #[inline]
    pub fn value(&self, modes: &[Vector], x: f64) -> Vector {
        let (mut next, mut after) = (Vector::zeros(), Vector::zeros());
        for ((c, up), down) in modes.iter().zip(&self.up).zip(&self.down[1..]).rev() {
            (next, after) = (c + next * (up * x) - after * *down, next);
        }
        next
    }

    /// The same at several places: x, then y.
    #[inline(always)]
    pub fn values<const L: usize>(&self, modes: &[Vector], x: &[f64; L]) -> [[f64; L]; 2] {
        let (mut next, mut after) = ([[0.0; L]; 2], [[0.0; L]; 2]);
        for ((c, up), down) in modes.iter().zip(&self.up).zip(&self.down[1..]).rev() {
            for axis in 0..2 {
                for k in 0..L {
                    let value = c[axis] + next[axis][k] * (up * x[k]) - after[axis][k] * down;
                    (next[axis][k], after[axis][k]) = (value, next[axis][k]);
                }
            }
        }
        next
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::Interpolation;

    #[test]
    fn agrees_with_the_barycentric_form() {
        for order in [1, 2, 5, 12, 32] {
            let rule = GaussLobatto::new(order);
            let values: Vec<Point> =
                rule.nodes.iter().map(|x| Point::new((3.0 * x).sin(), x.exp())).collect();
            let modal = Modal::new(&rule);
            let mut modes = vec![Vector::zeros(); order + 1];
            modal.modes(&values, &mut modes);
            let nodal = Interpolation::new(rule.nodes.clone());
            for x in [-1.0, -0.83, -0.2, 0.0, 0.41, 0.999, 1.0] {
                let gap = (modal.value(&modes, x) - nodal.point(&values, x).coords).norm();
                assert!(gap < 1e-14, "order {order} at {x}: {gap}");
                let both = modal.values(&modes, &[x, -x]).map(|v| v[0]);
                assert_eq!(both, <[f64; 2]>::from(modal.value(&modes, x)));
            }
        }
    }
}
