//! Rotations and mirrors that a boundary may have.

use super::isometry::{conjugate, product, Isometry};
use crate::domain::{Boundary, Chain};
use crate::numerics::tolerances::{POSE_TIE, SYMMETRY_ANGLE, SYMMETRY_ROUGH};
use crate::numerics::{left_normal, Vector};

/// Features nearer to the centroid, in canonical lengths, tell directions too badly.
const LEAST_RADIUS: f64 = 0.02;
/// Newton steps to the farthest point of a chain.
const STEPS: usize = 8;
/// Most features of a kind: a chain with more is an arc about the centroid, up to rounding.
const MOST: usize = 512;

/// The maps that take one feature to those like it: every symmetry is among them.
pub(super) enum Candidates {
    /// Rotations (without the identity) and mirrors, each by ascending angle.
    Few { rotations: Vec<Isometry>, mirrors: Vec<Isometry> },
    /// All chains are circles about the centroid: everything is a symmetry.
    All,
}

/// Something that a symmetry takes to its like.
struct Feature {
    at: Vector,
    /// Junctions: the angle through the domain; extremes of a closed chain: its length, shifted away from angles.
    kind: f64,
}

pub(super) fn candidates(boundary: &Boundary) -> Candidates {
    let junctions = boundary.junctions.iter().map(|j| Feature { at: j.point.coords, kind: j.angle });
    let mut features: Vec<Feature> = junctions.collect();
    let closed = || boundary.chains.iter().filter(|c| c.ends.is_none());
    if features.is_empty() && closed().all(is_centred_circle) {
        return Candidates::All;
    }
    for chain in closed().filter(|c| !is_centred_circle(c)) {
        features.extend(extremes(chain));
    }
    features.retain(|f| f.at.norm() > LEAST_RADIUS);
    let none = Candidates::Few { rotations: Vec::new(), mirrors: Vec::new() };
    let Some(class) = smallest_class(features) else { return none };
    let angle = |v: Vector| v.y.atan2(v.x).rem_euclid(std::f64::consts::TAU);
    let first = class[0].normalize();
    let (mut rotations, mut mirrors) = (Vec::new(), Vec::new());
    for (k, other) in class.iter().enumerate() {
        let other = other.normalize();
        if k > 0 {
            rotations.push(Isometry { turn: product(conjugate(first), other), mirror: false });
        }
        mirrors.push(Isometry { turn: product(first, other), mirror: true });
    }
    for list in [&mut rotations, &mut mirrors] {
        list.sort_by(|a, b| angle(a.turn).total_cmp(&angle(b.turn)));
    }
    Candidates::Few { rotations, mirrors }
}

/// Of the classes of features that are alike (kind and distance from the centroid) one with the fewest members:
/// the farthest.
fn smallest_class(mut features: Vec<Feature>) -> Option<Vec<Vector>> {
    features.sort_by(|a, b| b.at.norm().total_cmp(&a.at.norm()));
    let mut best: Option<Vec<Vector>> = None;
    let mut start = 0;
    while start < features.len() {
        let mut end = start + 1;
        while end < features.len() && features[end - 1].at.norm() - features[end].at.norm() <= SYMMETRY_ROUGH
        {
            end += 1;
        }
        let ring = &mut features[start..end];
        ring.sort_by(|a, b| a.kind.total_cmp(&b.kind));
        for class in ring.chunk_by(|a, b| b.kind - a.kind <= SYMMETRY_ANGLE) {
            if best.as_ref().is_none_or(|b| class.len() < b.len()) {
                best = Some(class.iter().map(|f| f.at).collect());
            }
        }
        start = end;
    }
    best
}

fn radii(chain: &Chain) -> impl Iterator<Item = f64> + '_ {
    chain.samples.iter().map(|s| s.point.coords.norm())
}

/// Whether a closed chain is a circle about the centroid.
fn is_centred_circle(chain: &Chain) -> bool {
    let [least, most] = [radii(chain).fold(f64::INFINITY, f64::min), radii(chain).fold(0.0, f64::max)];
    most - least <= POSE_TIE
}

/// The points of a closed chain farthest from the centroid; where those are an arc about it, the nearest.
fn extremes(chain: &Chain) -> Vec<Feature> {
    let farthest = extremes_of(chain, 1.0);
    let found = if farthest.len() <= MOST { farthest } else { extremes_of(chain, -1.0) };
    if found.len() > MOST {
        return Vec::new();
    }
    found.into_iter().map(|at| Feature { at, kind: 10.0 + chain.length }).collect()
}

/// The points where `sign` times the distance from the centroid is greatest.
fn extremes_of(chain: &Chain, sign: f64) -> Vec<Vector> {
    let mut radius: Vec<(f64, f64)> =
        chain.samples.iter().map(|x| (x.s, sign * x.point.coords.norm())).collect();
    // The last sample is the first again.
    radius.pop();
    radius.dedup_by(|a, b| a.0 == b.0);
    let most = radius.iter().map(|r| r.1).fold(f64::NEG_INFINITY, f64::max);
    let n = radius.len();
    let mut found: Vec<Vector> = Vec::new();
    let mut largest = most;
    for i in 0..n {
        let (s, r) = radius[i];
        let [before, after] = [radius[(i + n - 1) % n].1, radius[(i + 1) % n].1];
        // An extreme between samples is beside one that is a little below it.
        if r < before || r < after || r < most - LEAST_RADIUS {
            continue;
        }
        let at = refined(chain, s);
        largest = largest.max(sign * at.norm());
        found.push(at);
    }
    found.retain(|at| sign * at.norm() >= largest - SYMMETRY_ROUGH);
    let mut distinct: Vec<Vector> = Vec::new();
    for at in found {
        let known = distinct.last().into_iter().chain(distinct.first());
        if known.into_iter().all(|d| (d - at).norm() > 1e2 * SYMMETRY_ROUGH) {
            distinct.push(at);
        }
    }
    distinct
}

/// The stationary point of the distance from the centroid near `s`, or the point at `s` if Newton's steps leave it.
fn refined(chain: &Chain, s: f64) -> Vector {
    let start = chain.point(s).coords;
    let mut at = s;
    for _ in 0..STEPS {
        let (p, v) = chain.evaluate(at);
        let tangent = v.normalize();
        let slope = 1.0 + chain.curvature(at) * p.coords.dot(&left_normal(tangent));
        let step = p.coords.dot(&tangent) / slope;
        if !step.is_finite() || step.abs() > LEAST_RADIUS {
            return start;
        }
        at = chain.wrap(at - step);
    }
    let found = chain.point(at).coords;
    if (found - start).norm() < 2.0 * LEAST_RADIUS {
        found
    } else {
        start
    }
}
