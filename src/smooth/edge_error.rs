//! The boundary error of an edge as the optimiser sees it: its square and the derivatives with respect
//! to the two ends, and the barrier that keeps it below the tolerance.

use super::reference::Reference;
use crate::domain::walk::{walk, Four, FOUR};
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
#[inline(always)]
pub(super) fn squared_error(
    reference: &Reference,
    chain: &Chain,
    [start, length]: [f64; 2],
    nodes: &[[Vector; 2]],
) -> SquaredError {
    let n = nodes.len();
    let (mut sum, mut at_start, mut at_end) = ([0.0; FOUR], [0.0; FOUR], [0.0; FOUR]);
    walk(
        chain,
        [start, length],
        &reference.error_points,
        #[inline(always)]
        |first, four: Four| {
            // Rows of four points: values of each node's polynomial, and the same times the node's parameter.
            let row = first * n..(first + FOUR) * n;
            let (values, shifted) = (&reference.error_lagrange[row.clone()], &reference.error_shifted[row]);
            let mut w = [0.0; FOUR];
            w.copy_from_slice(&reference.error_weights[first..first + FOUR]);
            let mut t = [0.0; FOUR];
            t.copy_from_slice(&reference.error_points[first..first + FOUR]);
            let mut along = [0.0; FOUR];
            let mut ahead = [0.0; FOUR];
            for axis in 0..2 {
                let (mut gap, mut all, mut end) = (four.point[axis], [0.0; FOUR], [0.0; FOUR]);
                for (([p, v], m), mx) in
                    nodes.iter().zip(values.chunks_exact(FOUR)).zip(shifted.chunks_exact(FOUR))
                {
                    for k in 0..FOUR {
                        gap[k] -= p[axis] * m[k];
                        all[k] += v[axis] * m[k];
                        end[k] += v[axis] * mx[k];
                    }
                }
                for k in 0..FOUR {
                    sum[k] += w[k] * gap[k] * gap[k];
                    // With the start moves (1 − t) of a point, with the end t.
                    along[k] += gap[k] * (four.slope[axis][k] - all[k]);
                    ahead[k] += gap[k] * (four.slope[axis][k] * t[k] - end[k]);
                }
            }
            for k in 0..FOUR {
                at_end[k] += w[k] * ahead[k];
                at_start[k] += w[k] * (along[k] - ahead[k]);
            }
        },
    );
    let (sum, start, end) = (total(sum), total(at_start), total(at_end));
    SquaredError { value: length * sum, slope: [2.0 * length * start - sum, 2.0 * length * end + sum] }
}

#[inline(always)]
fn total(x: [f64; FOUR]) -> f64 {
    (x[0] + x[2]) + (x[1] + x[3])
}

/// Barrier −log(1 − (e/limit)^{1/(N+1)}) and its derivative with respect to e²; `None` at or above the
/// limit. The root makes it grow with the edge's length instead of at the last moment.
#[inline(always)]
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
