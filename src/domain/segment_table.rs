//! The arc-length table of one segment: adaptive bisection in the curve's parameter until the cubic
//! Hermite interpolant in arc length is as good as exact.

use crate::domain::frame::Frame;
use crate::domain::gauss::{snap, GaussRule};
use crate::domain::segment::CurveSegment;
use crate::error::Result;
use crate::numerics::tolerances::{TABLE_ERROR, TABLE_SHORTEST};
use crate::numerics::{cross, Point, Vector};
use std::collections::VecDeque;

/// A table entry of a segment, `s` from the segment's start; canonical frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Entry {
    pub s: f64,
    pub t: f64,
    pub point: Point,
    pub tangent: Vector,
    pub curvature: f64,
    /// The curve is less smooth here (a knot).
    pub is_break: bool,
}

/// Most intervals of one segment: a curve that is not smooth enough for them (noise) is resolved
/// evenly as far as they go.
const MOST_INTERVALS: usize = 1 << 16;

/// A node of the bisection.
#[derive(Debug, Clone, Copy)]
struct Node {
    t: f64,
    point: Point,
    tangent: Vector,
}

struct Interval {
    from: Node,
    to: Node,
    /// Interpolation error of the interval it was split from.
    parent_error: f64,
    /// It was split by the asymptotic error law.
    resolved: bool,
}

/// An accepted interval.
struct Piece {
    from: Node,
    to: Node,
    length: f64,
    starts_at_break: bool,
}

/// The table of `segment` from its start to its end; at least two entries, s strictly ascending.
pub(crate) fn segment_table(segment: &CurveSegment, frame: &Frame) -> Result<Vec<Entry>> {
    if segment.prefers_this_direction()? {
        return Walk { segment, frame }.table();
    }
    let mut backwards = segment.clone();
    backwards.reverse();
    let mut table = Walk { segment: &backwards, frame }.table()?;
    // Lengths are added up again from this end: the sums then depend on the shape alone.
    let lengths: Vec<f64> = table.windows(2).rev().map(|w| w[1].s - w[0].s).collect();
    table.reverse();
    let mut s = 0.0;
    for (i, e) in table.iter_mut().enumerate() {
        if i > 0 {
            s += lengths[i - 1];
        }
        *e = Entry { s, t: 1.0 - e.t, tangent: -e.tangent, curvature: -e.curvature, ..*e };
    }
    Ok(table)
}

/// A segment walked in its preferred direction.
struct Walk<'a> {
    segment: &'a CurveSegment,
    frame: &'a Frame,
}

impl Walk<'_> {
    fn point(&self, t: f64) -> Result<Point> {
        Ok(self.frame.to_canonical(self.segment.point(t)?))
    }

    fn speed(&self, t: f64) -> Result<f64> {
        Ok(self.segment.finite_derivative(t)?.norm() / self.frame.scale)
    }

    fn node(&self, t: f64) -> Result<Node> {
        let tangent = match t {
            0.0 => self.segment.end_tangent(false)?,
            1.0 => self.segment.end_tangent(true)?,
            _ => self.segment.tangent(t)?,
        };
        let tangent = self.frame.vector_to_canonical(tangent * self.frame.scale);
        Ok(Node { t, point: self.point(t)?, tangent })
    }

    fn length(&self, rule: &GaussRule, a: f64, b: f64) -> Result<f64> {
        let mut sum = 0.0;
        for (x, w) in rule.nodes.iter().zip(&rule.weights) {
            sum += w * self.speed(snap(a + (b - a) * x))?;
        }
        Ok(sum * (b - a))
    }

    fn table(&self) -> Result<Vec<Entry>> {
        let ends = self.segment.pieces();
        let mut pieces = Vec::new();
        if self.segment.is_line() {
            let (from, to) = (self.node(0.0)?, self.node(1.0)?);
            let length = (to.point - from.point).norm();
            pieces.push(Piece { from, to, length, starts_at_break: false });
        } else {
            for w in ends.windows(2) {
                self.divide(w[0], w[1], &mut pieces)?;
            }
        }
        Ok(entries(&pieces))
    }

    /// Appends the accepted intervals of the smooth piece from `a` to `b`, in order. Levels are done one
    /// after the other, so that the limit on their number leaves an even resolution.
    fn divide(&self, a: f64, b: f64, pieces: &mut Vec<Piece>) -> Result<()> {
        let limit = pieces.len() + MOST_INTERVALS;
        let first = pieces.len();
        let (from, to) = (self.node(a)?, self.node(b)?);
        let mut open = VecDeque::from([Interval { from, to, parent_error: f64::INFINITY, resolved: false }]);
        while let Some(interval) = open.pop_front() {
            let Interval { from, to, parent_error, resolved } = interval;
            let estimate =
                if resolved { self.estimate_short(&from, &to)? } else { self.estimate(&from, &to)? };
            let Estimate { length, error, resolved } = estimate;
            let middle = snap(0.5 * (from.t + to.t));
            let indivisible = middle <= from.t || middle >= to.t;
            let full = pieces.len() + open.len() >= limit;
            // A smooth curve gains a factor of 16 by halving, a kink 2; noise gains nothing.
            let stagnant = length < 1e-3 && error > 0.7 * parent_error;
            if error <= TABLE_ERROR || length <= TABLE_SHORTEST || indivisible || full || stagnant {
                pieces.push(Piece { from, to, length, starts_at_break: false });
                continue;
            }
            // Once the fourth-order error law holds it tells how many parts are needed.
            let parts =
                if resolved { (1.1 * (error / TABLE_ERROR).powf(0.25)).ceil().clamp(2.0, 64.0) } else { 2.0 };
            let mut start = from;
            for k in 1..=parts as usize {
                let t = snap(from.t + (to.t - from.t) * (k as f64 / parts));
                let end = if k == parts as usize { to } else { self.node(t)? };
                if end.t > start.t {
                    open.push_back(Interval { from: start, to: end, parent_error: error, resolved });
                    start = end;
                }
            }
        }
        pieces[first..].sort_by(|p, q| p.from.t.total_cmp(&q.from.t));
        pieces[first].starts_at_break = first > 0;
        Ok(())
    }

    /// Length of an interval and error of its interpolant at three points, with a check of the quadrature.
    fn estimate(&self, from: &Node, to: &Node) -> Result<Estimate> {
        let at = |k: f64| snap(from.t + (to.t - from.t) * k);
        let t = [from.t, at(0.25), at(0.5), at(0.75), to.t];
        let mut quarters = [0.0; 4];
        for k in 0..4 {
            quarters[k] = self.length(GaussRule::four(), t[k], t[k + 1])?;
        }
        let length: f64 = quarters.iter().sum();
        let mismatch = (self.length(GaussRule::eight(), from.t, to.t)? - length).abs();
        let mut error = 10.0 * mismatch;
        let mut s = 0.0;
        for k in 1..4 {
            s += quarters[k - 1];
            error = error.max((self.point(t[k])? - hermite(from, to, length, s)).norm());
        }
        Ok(Estimate { length, error, resolved: mismatch < 1e-9 * length && error < 1e-3 * length })
    }

    /// The same for an interval so short that the error is largest at its middle.
    fn estimate_short(&self, from: &Node, to: &Node) -> Result<Estimate> {
        let middle = snap(0.5 * (from.t + to.t));
        let half = self.length(GaussRule::four(), from.t, middle)?;
        let length = half + self.length(GaussRule::four(), middle, to.t)?;
        let error = (self.point(middle)? - hermite(from, to, length, half)).norm();
        Ok(Estimate { length, error, resolved: true })
    }
}

/// What is known of an interval.
struct Estimate {
    length: f64,
    /// Largest distance seen of the interpolant from the curve.
    error: f64,
    /// The interval is short enough for the asymptotic error law.
    resolved: bool,
}

/// The Hermite interpolant of an interval at distance `s` from its start.
fn hermite(from: &Node, to: &Node, length: f64, s: f64) -> Point {
    if length <= 0.0 {
        return from.point;
    }
    let x = s / length;
    let (x2, x3) = (x * x, x * x * x);
    from.point
        + from.tangent * (length * (x3 - 2.0 * x2 + x))
        + (to.point - from.point) * (3.0 * x2 - 2.0 * x3)
        + to.tangent * (length * (x3 - x2))
}

/// Entries at the ends of the intervals. The curvature is that of the Hermite interpolants, their mean where
/// two intervals meet.
fn entries(pieces: &[Piece]) -> Vec<Entry> {
    let mut table: Vec<Entry> = Vec::with_capacity(pieces.len() + 1);
    let mut s = 0.0;
    for p in pieces {
        let h = p.length;
        let d = p.to.point - p.from.point;
        let (u, v) = (p.from.tangent, p.to.tangent);
        // Second derivatives at both ends, times h².
        let first = d * 6.0 - u * (4.0 * h) - v * (2.0 * h);
        let second = u * (2.0 * h) + v * (4.0 * h) - d * 6.0;
        let curvature = |t: Vector, bend: Vector| {
            // Below the rounding of the points there is no bend to be seen.
            if bend.norm() > 1e-14 && h > 0.0 {
                cross(t, bend) / (h * h)
            } else {
                0.0
            }
        };
        let (start, end) = (curvature(u, first), curvature(v, second));
        match table.last_mut() {
            None => table.push(Entry {
                s,
                t: p.from.t,
                point: p.from.point,
                tangent: u,
                curvature: start,
                is_break: false,
            }),
            Some(e) => {
                e.curvature = 0.5 * (e.curvature + start);
                e.is_break |= p.starts_at_break;
            }
        }
        s += h;
        let end = Entry { s, t: p.to.t, point: p.to.point, tangent: v, curvature: end, is_break: false };
        let several = table.len() > 1;
        match table.last_mut() {
            // Where the caller's parametrisation stands still, two parameters share a place.
            Some(e) if e.s >= s && several => *e = Entry { is_break: e.is_break, ..end },
            _ => table.push(end),
        }
    }
    table
}
