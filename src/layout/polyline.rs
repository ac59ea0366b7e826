//! Polylines: points at shares of a measure, polygons' areas and angles.

use crate::numerics::{cross, Point, Vector};

/// A polyline with a measure along it (its length, or ∫ ds / h).
#[derive(Debug, Clone)]
pub(super) struct Measured<'a> {
    points: &'a [Point],
    /// Cumulative measure and length at each sample, and the polyline parameter there
    /// (index of the segment plus the share of it).
    samples: Vec<[f64; 3]>,
}

impl<'a> Measured<'a> {
    /// ∫ ds / h along `points` by midpoints, at least 16 of them. Sizes that are not positive count as 1.
    pub fn new(points: &'a [Point], size: &dyn Fn(Point) -> f64) -> Self {
        let length: f64 = points.windows(2).map(|p| (p[1] - p[0]).norm()).sum();
        let piece = length / 16.0;
        let mut samples = vec![[0.0; 3]];
        let (mut measure, mut run) = (0.0, 0.0);
        for (i, p) in points.windows(2).enumerate() {
            let d = p[1] - p[0];
            let n = if piece > 0.0 { (d.norm() / piece).ceil().clamp(1.0, 16.0) as usize } else { 1 };
            for k in 0..n {
                let h = size(p[0] + d * ((k as f64 + 0.5) / n as f64));
                let h = if h > 0.0 { h } else { 1.0 };
                run += d.norm() / n as f64;
                measure += d.norm() / n as f64 / h;
                samples.push([measure, run, i as f64 + (k + 1) as f64 / n as f64]);
            }
        }
        Measured { points, samples }
    }

    /// The whole measure.
    pub fn total(&self) -> f64 {
        self.samples[self.samples.len() - 1][0]
    }

    /// Point and share of the length at share `x` of the measure.
    pub fn at(&self, x: f64) -> (Point, f64) {
        let wanted = x * self.total();
        let i = self.samples.partition_point(|s| s[0] < wanted).clamp(1, self.samples.len() - 1);
        let (a, b) = (self.samples[i - 1], self.samples[i]);
        let y = if b[0] > a[0] { ((wanted - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0) } else { 0.0 };
        let length = self.samples[self.samples.len() - 1][1];
        let run = a[1] + y * (b[1] - a[1]);
        let share = if length > 0.0 { run / length } else { x };
        (at_parameter(self.points, a[2] + y * (b[2] - a[2])), share)
    }

    /// Polyline parameter (segment index plus share of it) at share `x` of the measure.
    pub fn parameter(&self, x: f64) -> f64 {
        let wanted = x * self.total();
        let i = self.samples.partition_point(|s| s[0] < wanted).clamp(1, self.samples.len() - 1);
        let (a, b) = (self.samples[i - 1], self.samples[i]);
        let y = if b[0] > a[0] { ((wanted - a[0]) / (b[0] - a[0])).clamp(0.0, 1.0) } else { 0.0 };
        a[2] + y * (b[2] - a[2])
    }
}

/// The point at a polyline parameter.
pub(super) fn at_parameter(points: &[Point], t: f64) -> Point {
    let i = (t.max(0.0) as usize).min(points.len() - 2);
    points[i] + (points[i + 1] - points[i]) * (t - i as f64)
}

/// Signed area of a closed polygon.
pub(super) fn area(polygon: &[Point]) -> f64 {
    let n = polygon.len();
    (0..n).map(|i| cross(polygon[i].coords, polygon[(i + 1) % n].coords)).sum::<f64>() / 2.0
}

/// Mean of some points.
pub(super) fn mean<'a>(points: impl IntoIterator<Item = &'a Point>) -> Point {
    let (mut sum, mut n) = (Vector::zeros(), 0.0);
    for p in points {
        sum += p.coords;
        n += 1.0;
    }
    Point::from(sum / f64::max(n, 1.0))
}

/// Angle in (0, 2π] from direction `from` counter-clockwise to direction `to`.
pub(super) fn turn(from: Vector, to: Vector) -> f64 {
    let a = cross(from, to).atan2(from.dot(&to));
    if a > 0.0 {
        a
    } else {
        a + std::f64::consts::TAU
    }
}

/// Whether the open polyline `path` leaves the polygon: crosses an edge of it (touching at the
/// path's ends excepted) or lies outside.
pub(super) fn leaves(path: &[Point], polygon: &[Point]) -> bool {
    let n = polygon.len();
    let side = |a: Point, b: Point, c: Point| cross(b - a, c - a);
    for p in path.windows(2) {
        for i in 0..n {
            let (a, b) = (polygon[i], polygon[(i + 1) % n]);
            let (s0, s1) = (side(a, b, p[0]), side(a, b, p[1]));
            let (t0, t1) = (side(p[0], p[1], a), side(p[0], p[1], b));
            if s0 * s1 < 0.0 && t0 * t1 < 0.0 {
                let x = p[0] + (p[1] - p[0]) * (s0 / (s0 - s1));
                let reach = 1e-9 * (path[0] - path[path.len() - 1]).norm();
                if (x - path[0]).norm() > reach && (x - path[path.len() - 1]).norm() > reach {
                    return true;
                }
            }
        }
    }
    let middle = at_parameter(path, 0.5 * (path.len() - 1) as f64);
    !contains(polygon, middle)
}

/// Whether a polygon contains a point (even-odd).
pub(super) fn contains(polygon: &[Point], p: Point) -> bool {
    let n = polygon.len();
    let mut inside = false;
    for i in 0..n {
        let (a, b) = (polygon[i], polygon[(i + 1) % n]);
        if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            inside = !inside;
        }
    }
    inside
}
