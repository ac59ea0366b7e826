//! What the domain alone allows: the best scaled Jacobian and the least irregularity of any mesh.

use super::QuadMesh;
use crate::domain::{Boundary, Place};
use crate::numerics::tolerances::{CORNER_TURN, PORT_TURN};
use crate::numerics::{cross, Vector};
use std::f64::consts::{FRAC_PI_2, PI};

/// Least scaled Jacobian of a perfect mesh round a vertex of valence 3: sin 120°.
const VALENCE_3: f64 = 0.866_025_403_784_438_6;
/// The same for valence 5: sin 72°.
const VALENCE_5: f64 = 0.951_056_516_295_153_5;
/// Two numbers of quads at a corner count as equally good when their sines differ by less; it only
/// has to be above rounding.
const TIE: f64 = 1e-9;

/// Number of irregular vertices of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Irregular {
    /// Interior vertices of valence ≠ 4.
    pub interior: usize,
    /// Boundary vertices whose number of quads is not Table 1's for their angle (2 where smooth).
    pub boundary: usize,
}

/// How irregular a mesh of the domain has to be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IrregularityBound {
    /// W: the least Σ |2θ/π − n| + |4χ − Σ(2 − n)| over integers n ≥ 1 at the corners of angle θ.
    pub corners: f64,
    /// W_s: Σ round(|turn| / 90°) over the boundary's runs of one sign of curvature.
    pub curves: usize,
    /// max(2 W, W_s), rounded.
    pub expected: usize,
}

/// Number of quads at a corner of interior angle `angle` by Table 1 of the paper, ties downwards.
pub fn quads_by_table(angle: f64) -> usize {
    1 + [3.0, 5.0, 7.0].iter().filter(|k| angle > *k * (PI / 4.0) + TIE).count()
}

/// Irregular vertices of `mesh`.
pub fn irregular(mesh: &QuadMesh, boundary: &Boundary) -> Irregular {
    let mut result = Irregular::default();
    for (vertex, quads) in mesh.vertices.iter().zip(mesh.quads_at()) {
        match vertex.place {
            Place::Interior => result.interior += usize::from(quads != 4),
            Place::Boundary(_) => result.boundary += usize::from(quads != 2),
            Place::Junction(j) => {
                let angle = boundary.junctions.get(j as usize).map_or(PI, |j| j.angle);
                result.boundary += usize::from(quads as usize != quads_by_table(angle));
            }
        }
    }
    result
}

/// The corners' interior angles.
fn corner_angles(boundary: &Boundary) -> impl Iterator<Item = f64> + '_ {
    boundary.junctions.iter().map(|j| j.angle).filter(|a| (a - PI).abs() > CORNER_TURN)
}

/// 4χ of the domain: 4 · (1 − holes).
fn four_chi(boundary: &Boundary) -> i64 {
    4 * (2 - boundary.loops.len() as i64)
}

/// The largest scaled Jacobian that any mesh of the domain can have: the minimum over its corners of
/// max over n of sin(θ/n), and at most that of the irregular vertices those n force inside.
pub fn scaled_jacobian_ceiling(boundary: &Boundary) -> f64 {
    let mut ceiling = 1.0f64;
    // Σ (2 − n), least and largest where two n are equally good.
    let (mut low, mut high) = (0, 0);
    for angle in corner_angles(boundary) {
        let values = [1, 2, 3, 4].map(|n| (angle / n as f64).min(PI).sin());
        let best = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        ceiling = ceiling.min(best);
        let good = || (0..4).filter(|k| values[*k] > best - TIE).map(|k| 1 - k as i64);
        low += good().min().unwrap_or(0);
        high += good().max().unwrap_or(0);
    }
    let chi = four_chi(boundary);
    if chi > high {
        ceiling.min(VALENCE_3)
    } else if chi < low {
        ceiling.min(VALENCE_5)
    } else {
        ceiling
    }
}

/// The bound on irregularity (see [`IrregularityBound`]).
pub fn irregularity_bound(boundary: &Boundary) -> IrregularityBound {
    let mut total = 0.0;
    let mut excess = four_chi(boundary);
    // Cost of one quad more and of one less at each corner.
    let (mut more, mut less) = (Vec::new(), Vec::new());
    for angle in corner_angles(boundary) {
        let ideal = angle / FRAC_PI_2;
        let n = ideal.round().max(1.0);
        let cost = |n: f64| (ideal - n).abs();
        total += cost(n);
        excess -= 2 - n as i64;
        more.push(cost(n + 1.0) - cost(n));
        if n > 1.0 {
            less.push(cost(n - 1.0) - cost(n));
        }
    }
    // Each step at a corner costs at most 1 and takes 1 off the second term, if taken the right way;
    // a second step at the same corner costs exactly 1 and so gains nothing.
    let (steps, count) = if excess < 0 { (&mut more, -excess) } else { (&mut less, excess) };
    steps.sort_by(f64::total_cmp);
    let gained: f64 = steps.iter().take(count as usize).map(|c| 1.0 - c).filter(|g| *g > 0.0).sum();
    let corners = total + count as f64 - gained;
    let curves = boundary.loops.iter().map(|l| loop_runs(boundary, l)).sum();
    let expected = ((2.0 * corners).round() as usize).max(curves);
    IrregularityBound { corners, curves, expected }
}

/// Signed angle from `a` to `b`.
fn turn(a: Vector, b: Vector) -> f64 {
    cross(a, b).atan2(a.dot(&b))
}

/// Σ round(|turn| / 90°) over the runs of one loop.
fn loop_runs(boundary: &Boundary, chains: &[u32]) -> usize {
    // Turns between consecutive samples, `None` at corners.
    let mut turns: Vec<Option<f64>> = Vec::new();
    for &c in chains {
        let chain = &boundary.chains[c as usize];
        turns.extend(chain.samples.windows(2).map(|w| Some(turn(w[0].tangent, w[1].tangent))));
        if let Some([_, end]) = chain.ends {
            let t = PI - boundary.junctions[end as usize].angle;
            turns.push(Some(t).filter(|t| t.abs() <= PORT_TURN));
        }
    }
    if let Some(corner) = turns.iter().position(Option::is_none) {
        turns.rotate_left(corner);
        let smooth = turns.split(Option::is_none);
        return smooth.map(|piece| runs(&piece.iter().flatten().copied().collect::<Vec<_>>()).0).sum();
    }
    // No corner: begin at an extreme of the direction, so that no run is cut in two.
    let mut turns: Vec<f64> = turns.into_iter().flatten().collect();
    match runs(&turns.repeat(2)).1 {
        Some(extreme) => {
            let count = turns.len();
            turns.rotate_left(extreme % count);
            runs(&turns).0
        }
        None => quarters(turns.iter().sum()),
    }
}

fn quarters(turn: f64) -> usize {
    (turn.abs() / FRAC_PI_2).round() as usize
}

/// Σ round(|turn| / 90°) over a piece without corners, and the index at which its second run begins.
/// Runs lie between the extremes of the direction; wiggles below [`CORNER_TURN`] are no extremes.
fn runs(turns: &[f64]) -> (usize, Option<usize>) {
    // Direction now, at the last extreme, and the farthest from it since.
    let (mut now, mut extreme, mut farthest, mut index) = (0.0f64, 0.0f64, 0.0f64, 0);
    let (mut total, mut first) = (0, None);
    for (i, t) in turns.iter().enumerate() {
        now += t;
        let (out, reached) = (now - extreme, farthest - extreme);
        if out.abs() > reached.abs() && out * reached >= 0.0 {
            (farthest, index) = (now, i + 1);
        } else if (farthest - now).abs() > CORNER_TURN {
            total += quarters(reached);
            first = first.or(Some(index));
            (extreme, farthest, index) = (farthest, now, i + 1);
        }
    }
    (total + quarters(farthest - extreme), first)
}
