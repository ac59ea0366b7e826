//! Angles and sizes that elements keep while they are moved for something else.

// Several arrays run in step in every loop here; zipping them would hide the formulas.
#![allow(clippy::needless_range_loop)]

use crate::numerics::{cross, Vector};
use crate::smooth::kernel::Sides;

/// Weight of a squared shortfall of the scaled Jacobian, at each sample: a hundredth is worth a tenth of the errors that
/// elements are moved for.
const ANGLE_WEIGHT: f64 = 5e3;
/// Weight of a squared excess of the size: a thousandth is worth as much.
const SIZE_WEIGHT: f64 = 1e5;

/// What is to be kept: at least this scaled Jacobian, at most this mean length of opposite sides.
#[derive(Debug, Clone, Copy)]
pub(in crate::smooth) struct Demands {
    pub scaled_jacobian: f64,
    pub size: f64,
}

impl Demands {
    /// The cost of what an element with `count` samples a side, at `t`, is beyond what is to be kept; its gradient is added.
    #[inline(always)]
    pub fn penalty<const L: usize>(
        &self,
        count: usize,
        t: &[f64; L],
        sides: &Sides<L>,
        gradient: &mut Sides<L>,
    ) -> f64 {
        let corner = corners(sides, count);
        let slope = |side: usize, k: usize| Vector::new(sides.d[side][0][k], sides.d[side][1][k]);
        let mut sum = 0.0;
        for j in 0..count {
            for i in 0..count {
                let (u, v) = (t[i], t[j]);
                let a = slope(0, i) * (1.0 - v) + slope(2, i) * v + at(sides, 1, j)
                    - at(sides, 3, j)
                    - (corner[1] - corner[0]) * (1.0 - v)
                    - (corner[2] - corner[3]) * v;
                let b = slope(3, j) * (1.0 - u) + slope(1, j) * u + at(sides, 2, i)
                    - at(sides, 0, i)
                    - (corner[3] - corner[0]) * (1.0 - u)
                    - (corner[2] - corner[1]) * u;
                let lengths = a.norm() * b.norm();
                let scaled = cross(a, b) / lengths;
                let short = self.scaled_jacobian - scaled;
                if short <= 0.0 {
                    continue;
                }
                sum += ANGLE_WEIGHT * short * short;
                let factor = -2.0 * ANGLE_WEIGHT * short;
                let ga = (Vector::new(b.y, -b.x) / lengths - a * (scaled / a.norm_squared())) * factor;
                let gb = (Vector::new(-a.y, a.x) / lengths - b * (scaled / b.norm_squared())) * factor;
                for axis in 0..2 {
                    gradient.d[0][axis][i] += (1.0 - v) * ga[axis];
                    gradient.d[2][axis][i] += v * ga[axis];
                    gradient.d[3][axis][j] += (1.0 - u) * gb[axis];
                    gradient.d[1][axis][j] += u * gb[axis];
                }
                give(gradient, 1, j, ga);
                give(gradient, 3, j, -ga);
                give(gradient, 2, i, gb);
                give(gradient, 0, i, -gb);
                give_corners(gradient, count, [1.0 - v, v - 1.0, -v, v], ga);
                give_corners(gradient, count, [1.0 - u, u, -u, u - 1.0], gb);
            }
        }
        for pair in [[0, 2], [1, 3]] {
            let steps = |side: usize| (1..count).map(move |k| at(sides, side, k) - at(sides, side, k - 1));
            let length: f64 = pair.iter().flat_map(|side| steps(*side)).map(|step| step.norm()).sum();
            let over = 0.5 * length / self.size - 1.0;
            if over > 0.0 {
                sum += SIZE_WEIGHT * over * over;
                let factor = SIZE_WEIGHT * over / self.size;
                for side in pair {
                    for (k, step) in steps(side).enumerate() {
                        let g = step * (factor / step.norm());
                        give(gradient, side, k + 1, g);
                        give(gradient, side, k, -g);
                    }
                }
            }
        }
        sum
    }
}

#[inline(always)]
fn at<const L: usize>(sides: &Sides<L>, side: usize, k: usize) -> Vector {
    Vector::new(sides.c[side][0][k], sides.c[side][1][k])
}

/// Counter-clockwise from ξ = η = 0.
#[inline(always)]
pub(super) fn corners<const L: usize>(sides: &Sides<L>, count: usize) -> [Vector; 4] {
    [at(sides, 0, 0), at(sides, 0, count - 1), at(sides, 2, count - 1), at(sides, 2, 0)]
}

/// What each corner has in the bilinear map.
#[inline(always)]
pub(super) fn corner_shares(u: f64, v: f64) -> [f64; 4] {
    [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v]
}

#[inline(always)]
pub(super) fn give<const L: usize>(gradient: &mut Sides<L>, side: usize, k: usize, g: Vector) {
    gradient.c[side][0][k] += g.x;
    gradient.c[side][1][k] += g.y;
}

#[inline(always)]
pub(super) fn give_corners<const L: usize>(
    gradient: &mut Sides<L>,
    count: usize,
    shares: [f64; 4],
    g: Vector,
) {
    for ((side, k), share) in [(0, 0), (0, count - 1), (2, count - 1), (2, 0)].into_iter().zip(shares) {
        give(gradient, side, k, g * share);
    }
}
