//! The L2 error of an edge against the table of its chain, four points at once: it is asked for wherever boundary
//! vertices are placed or slide. The same sums as [`BoundaryError::measure`], in another order.

use super::boundary_error::{BoundaryError, MAX_NODES};
use crate::domain::walk::{walk, Four, FOUR};
use crate::domain::Chain;
use crate::numerics::{Point, Vector};
use pulp::NullaryFnOnce;

/// The edge from arc length `start` over `length`, with the breaks inside, counted from its start.
pub(super) struct SquaredError<'a> {
    pub error: &'a BoundaryError,
    pub chain: &'a Chain,
    pub start: f64,
    pub length: f64,
    pub breaks: &'a [f64],
}

impl SquaredError<'_> {
    /// Compiled for the widest registers there are, with the same result on any.
    pub fn value(self) -> f64 {
        pulp::Arch::new().dispatch(self)
    }
}

impl NullaryFnOnce for SquaredError<'_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        let SquaredError { error, chain, start, length, breaks } = self;
        let modal = error.modal();
        let n = error.parameters().len();
        let mut nodes = [Point::origin(); MAX_NODES];
        walk(
            chain,
            [start, length],
            error.parameters(),
            #[inline(always)]
            |first, four: Four| {
                for (k, node) in nodes[first..n].iter_mut().take(FOUR).enumerate() {
                    *node = Point::new(four.point[0][k], four.point[1][k]);
                }
            },
        );
        let mut modes = [Vector::zeros(); MAX_NODES];
        modal.modes(&nodes[..n], &mut modes[..n]);
        let mut sums = [0.0; FOUR];
        let mut from = 0.0;
        for to in breaks.iter().copied().chain([length]) {
            let rule = error.rule((to - from) / length);
            for first in (0..rule.nodes.len()).step_by(FOUR) {
                let (mut t, mut x, mut weight) = ([0.0; FOUR], [0.0; FOUR], [0.0; FOUR]);
                for k in 0..FOUR {
                    // Copies of the last point fill the four up, without a weight.
                    let q = (first + k).min(rule.nodes.len() - 1);
                    t[k] = (from + 0.5 * (1.0 + rule.nodes[q]) * (to - from)) / length;
                    x[k] = 2.0 * t[k] - 1.0;
                    weight[k] = if first + k == q { 0.5 * rule.weights[q] * (to - from) } else { 0.0 };
                }
                walk(
                    chain,
                    [start, length],
                    &t,
                    #[inline(always)]
                    |_, four: Four| {
                        let edge = modal.values(&modes[..n], &x);
                        for k in 0..FOUR {
                            let [dx, dy] = [four.point[0][k] - edge[0][k], four.point[1][k] - edge[1][k]];
                            sums[k] += weight[k] * (dx * dx + dy * dy);
                        }
                    },
                );
            }
            from = to;
        }
        (sums[0] + sums[2]) + (sums[1] + sums[3])
    }
}
