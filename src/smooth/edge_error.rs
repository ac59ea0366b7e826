//! The boundary error of an edge as the optimiser sees it: its square and the derivatives with respect
//! to the two ends, and the barrier that keeps it below the tolerance.

use super::reference::Reference;
use super::walk::walk;
use crate::domain::Chain;
use crate::numerics::Vector;

/// Errors far below the limit, as a share of it, count as this: the barrier's root would otherwise
/// turn rounding errors of straight edges into slopes.
pub(super) const NEGLIGIBLE: f64 = 1e-3;

/// The square of an edge's L2 error, and its derivatives with respect to both ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SquaredError {
    pub value: f64,
    pub slope: [f64; 2],
}

/// For the edge that follows `chain` from `start` over `length`, with its nodes and the curve's
/// derivatives there.
pub(super) fn squared_error(
    reference: &Reference,
    chain: &Chain,
    start: f64,
    length: f64,
    nodes: &[[Vector; 2]],
) -> SquaredError {
    let n = nodes.len();
    let (mut sum, mut slope) = (0.0, [0.0; 2]);
    walk(chain, start, length, &reference.error_points, |q, point, tangent| {
        let row = &reference.error_lagrange[q * n..(q + 1) * n];
        let (mut gap, mut at_start, mut at_end) = (point, Vector::zeros(), Vector::zeros());
        for ((m, [p, v]), x) in row.iter().zip(nodes).zip(&reference.nodes) {
            gap -= p * *m;
            at_start += v * (m * (1.0 - x));
            at_end += v * (m * x);
        }
        let (w, t) = (reference.error_weights[q], reference.error_points[q]);
        sum += w * gap.norm_squared();
        slope[0] += w * gap.dot(&(tangent * (1.0 - t) - at_start));
        slope[1] += w * gap.dot(&(tangent * t - at_end));
    });
    SquaredError {
        value: length * sum,
        slope: [2.0 * length * slope[0] - sum, 2.0 * length * slope[1] + sum],
    }
}

/// Barrier −log(1 − (e/limit)^{1/(N+1)}) and its derivative with respect to e²; `None` at or above the
/// limit. The root makes it grow with the edge's length instead of at the last moment.
pub(super) fn barrier(order: usize, squared: f64, limit: f64) -> Option<(f64, f64)> {
    let limit = limit * limit;
    let floor = NEGLIGIBLE * NEGLIGIBLE;
    let share = (squared / limit + floor) / (1.0 + floor);
    if share >= 1.0 {
        return None;
    }
    let exponent = 0.5 / (order as f64 + 1.0);
    let root = share.powf(exponent);
    let slope = exponent * root / share / (1.0 + floor) / limit / (1.0 - root);
    Some((-(1.0 - root).ln(), slope))
}
