//! The canonical pose of a domain, and the canonical order of its loops and of their joints.
//!
//! Origin: the centroid of the area. Axis: towards the corner farthest from it (without corners:
//! the farthest segment end; without those: the farthest sampled point). Scale: the diagonal of the
//! bounding box in that pose. Several corners equally far away are told apart by moments of the
//! boundary seen from each; corners that even those do not tell apart are images of each other
//! under a symmetry of the domain.

use crate::domain::bounds::Bounds;
use crate::domain::frame::Frame;
use crate::domain::planar_domain::Domain;
use crate::error::Result;
use crate::numerics::tolerances::{CORNER_TURN, POSE_TIE};
use crate::numerics::{Point, Vector};

/// The canonical pose and order.
pub(crate) struct Canonical {
    pub frame: Frame,
    /// The least diagonal of a bounding box in any pose, in the canonical frame.
    pub least_diagonal: f64,
    /// Indices into [`Domain::loops`]: the outer one, then the holes.
    pub loops: Vec<usize>,
    /// For each of `loops` the segment it starts with.
    pub starts: Vec<usize>,
    /// For each of `loops` and each segment, in the domain's order: change of direction at its start.
    pub turns: Vec<Vec<f64>>,
}

/// Finds the pose and the order.
pub(crate) fn canonical(domain: &Domain) -> Result<Canonical> {
    let reference = domain.bounds().center();
    let m = domain.moments(reference)?;
    let origin = reference + Vector::new(m.x, m.y) / m.area;
    let mut samples = Vec::new();
    let mut turns = Vec::new();
    let (mut corners, mut joints) = (Vec::new(), Vec::new());
    for l in domain.loops() {
        let mut own = Vec::new();
        for (i, s) in l.segments().iter().enumerate() {
            samples.push(s.sample()?);
            let turn = l.turn(i)?;
            own.push(turn);
            joints.push(s.start()?);
            if turn.abs() > CORNER_TURN {
                corners.push(s.start()?);
            }
        }
        turns.push(own);
    }
    let flat: Vec<Point> = samples.iter().flatten().copied().collect();
    let radius = flat.iter().map(|p| (p - origin).norm()).fold(0.0, f64::max);
    let candidates = [&corners, &joints, &flat]
        .into_iter()
        .map(|points| farthest(points, origin, radius))
        .find(|far| !far.is_empty() && (far[0] - origin).norm() > 0.1 * radius)
        .unwrap_or_default();
    let axis = best_axis(&candidates, &samples, origin, radius);
    let mut frame = Frame { origin, scale: 1.0, axis };
    frame.scale = Bounds::of(&flat.iter().map(|&p| frame.to_canonical(p)).collect::<Vec<_>>()).diagonal();
    let least_diagonal = least_diagonal(&flat.iter().map(|&p| frame.to_canonical(p)).collect::<Vec<_>>());
    let mut starts = Vec::new();
    let mut keys = Vec::new();
    for (l, own) in domain.loops().iter().zip(&turns) {
        let mut points = Vec::new();
        for s in l.segments() {
            points.push(frame.to_canonical(s.start()?));
        }
        let start = first_joint(&points, own);
        starts.push(start);
        let center = l.moments(origin)?;
        let center = origin + Vector::new(center.x, center.y) / center.area;
        keys.push([frame.to_canonical(center), points[start]]);
    }
    let mut loops = vec![0];
    loops.extend(sorted_holes(&keys[1..]).into_iter().map(|k| k + 1));
    let starts = loops.iter().map(|&l| starts[l]).collect();
    let turns = loops.iter().map(|&l| turns[l].clone()).collect();
    Ok(Canonical { frame, least_diagonal, loops, starts, turns })
}

/// Poses in a quarter turn in which the bounding box is looked at.
const POSES: usize = 128;

/// A lower bound, by less than 1 %, of the bounding box's diagonal in any pose.
fn least_diagonal(points: &[Point]) -> f64 {
    let step = std::f64::consts::FRAC_PI_2 / POSES as f64;
    let diagonal = |pose: usize| {
        let (s, c) = (step * pose as f64).sin_cos();
        let turned = |p: &Point| Point::new(c * p.x - s * p.y, s * p.x + c * p.y);
        Bounds::of(&points.iter().map(turned).collect::<Vec<_>>()).diagonal()
    };
    // With the angle the diagonal changes by at most itself a radian.
    (0..POSES).map(diagonal).fold(f64::INFINITY, f64::min) * (1.0 - 0.5 * step)
}

/// The points farthest from `origin`, up to rounding.
fn farthest(points: &[Point], origin: Point, radius: f64) -> Vec<Point> {
    let most = points.iter().map(|p| (p - origin).norm()).fold(0.0, f64::max);
    points.iter().copied().filter(|p| (p - origin).norm() >= most - POSE_TIE * radius).collect()
}

/// Of the candidates the direction from which the boundary's moments are the largest in lexicographic
/// order, differences below the tie tolerance counting as none.
fn best_axis(candidates: &[Point], samples: &[Vec<Point>], origin: Point, radius: f64) -> Vector {
    let direction = |p: &Point| (p - origin) / (p - origin).norm();
    match candidates {
        [] => return Vector::new(1.0, 0.0),
        [only] => return direction(only),
        _ => {}
    }
    // ∮ zᵏ ds over the sampled polyline, z = (point − origin) / radius as a complex number.
    let mut terms: Vec<[Vec<f64>; 2]> = vec![Default::default(); MOMENTS];
    for line in samples {
        for w in line.windows(2) {
            let length = (w[1] - w[0]).norm() / radius;
            let z = (nalgebra::center(&w[0], &w[1]) - origin) / radius;
            let mut power = Vector::new(length, 0.0);
            for term in terms.iter_mut() {
                power = complex_product(power, z);
                term[0].push(power.x);
                term[1].push(power.y);
            }
        }
    }
    let moments: Vec<Vector> = terms
        .into_iter()
        .map(|t| {
            let [x, y] = t.map(super::boundary_loop::sum_sorted);
            Vector::new(x, y)
        })
        .collect();
    let seen_from = |axis: Vector| -> Vec<f64> {
        let back = Vector::new(axis.x, -axis.y);
        let mut turned = Vector::new(1.0, 0.0);
        let mut seen = Vec::with_capacity(2 * MOMENTS);
        for m in &moments {
            turned = complex_product(turned, back);
            let v = complex_product(*m, turned);
            seen.extend([v.x, v.y]);
        }
        seen
    };
    let mut best = direction(&candidates[0]);
    let mut best_seen = seen_from(best);
    for candidate in &candidates[1..] {
        let axis = direction(candidate);
        let seen = seen_from(axis);
        let decisive = seen.iter().zip(&best_seen).find(|(a, b)| (*a - *b).abs() > POSE_TIE);
        if decisive.is_some_and(|(a, b)| a > b) {
            (best, best_seen) = (axis, seen);
        }
    }
    best
}

/// Number of complex moments compared.
const MOMENTS: usize = 12;

fn complex_product(a: Vector, b: Vector) -> Vector {
    Vector::new(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x)
}

/// The joint a loop starts at: of its corners (without any: of all joints) the farthest from the
/// centroid; of several the first counter-clockwise from the axis.
fn first_joint(points: &[Point], turns: &[f64]) -> usize {
    let has_corner = turns.iter().any(|t| t.abs() > CORNER_TURN);
    let eligible = |i: &usize| !has_corner || turns[*i].abs() > CORNER_TURN;
    let most = (0..points.len()).filter(eligible).map(|i| points[i].coords.norm()).fold(0.0, f64::max);
    let angle = |p: &Point| {
        let a = p.y.atan2(p.x);
        // A point on the axis may be on either side of it by rounding.
        if a < -POSE_TIE {
            a + 2.0 * std::f64::consts::PI
        } else {
            a
        }
    };
    (0..points.len())
        .filter(eligible)
        .filter(|&i| points[i].coords.norm() >= most - POSE_TIE)
        .min_by(|&a, &b| angle(&points[a]).total_cmp(&angle(&points[b])).then(a.cmp(&b)))
        .unwrap_or(0)
}

/// Holes by the place of their centroids: by x, then y, then their first joint likewise. Coordinates that
/// differ by rounding only count as equal.
fn sorted_holes(keys: &[[Point; 2]]) -> Vec<usize> {
    let n = keys.len();
    let columns: [Vec<u32>; 4] = [
        ranks(keys.iter().map(|k| k[0].x)),
        ranks(keys.iter().map(|k| k[0].y)),
        ranks(keys.iter().map(|k| k[1].x)),
        ranks(keys.iter().map(|k| k[1].y)),
    ];
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by_key(|&i| (columns.each_ref().map(|c| c[i]), i));
    order
}

/// The rank of each value, equal for values that differ by less than the tie tolerance.
fn ranks(values: impl Iterator<Item = f64>) -> Vec<u32> {
    let values: Vec<f64> = values.collect();
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0; values.len()];
    let mut rank = 0;
    for w in order.windows(2) {
        if values[w[1]] - values[w[0]] > POSE_TIE {
            rank += 1;
        }
        ranks[w[1]] = rank;
    }
    ranks
}
