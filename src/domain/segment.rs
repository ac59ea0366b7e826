//! A curve segment as part of a loop: the caller's curve, walked in the loop's direction and joined
//! to its neighbours.

use crate::domain::curve::{Curve, CurveFailure};
use crate::domain::differences;
use crate::domain::gauss::{snap, GaussRule};
use crate::error::{Error, Result};
use crate::numerics::{Point, Vector};
use std::sync::Arc;

/// Steps of the extrapolation to a tangent where the derivative vanishes.
const LEVELS: i32 = 4;

/// A curve segment of a loop.
#[derive(Clone)]
pub struct CurveSegment {
    curve: Arc<dyn Curve>,
    name: String,
    /// The part of the curve's own parameter that it is.
    range: [f64; 2],
    /// Walked against the curve's own parameter.
    reversed: bool,
    /// Added linearly: the first at t = 0, the second at t = 1 (closes small gaps at joints).
    correction: [Vector; 2],
    /// Its number and its loop's in the caller's order.
    index: usize,
    loop_index: usize,
}

impl CurveSegment {
    pub(crate) fn new(curve: Arc<dyn Curve>, name: String, loop_index: usize, index: usize) -> Self {
        let correction = [Vector::zeros(); 2];
        CurveSegment { curve, name, range: [0.0, 1.0], reversed: false, correction, index, loop_index }
    }

    /// Name of its boundary.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its number among the segments of its loop, in the caller's order.
    pub fn index(&self) -> usize {
        self.index
    }

    /// Whether it is walked against the caller's parameter: the caller's t is then 1 − t.
    pub fn is_reversed(&self) -> bool {
        self.reversed
    }

    /// Whether it is a straight line.
    pub fn is_line(&self) -> bool {
        self.curve.is_line()
    }

    /// The parameter in the caller's sense.
    pub fn caller_parameter(&self, t: f64) -> f64 {
        let [a, b] = self.range;
        a + (b - a) * self.unreversed(t)
    }

    /// The parameter in the loop's direction of the caller's `t`; outside [0, 1] if it is of another part.
    pub(crate) fn loop_parameter(&self, t: f64) -> f64 {
        let [a, b] = self.range;
        self.unreversed((t - a) / (b - a))
    }

    /// The parameter in the caller's sense, as a share of the range.
    fn unreversed(&self, t: f64) -> f64 {
        if self.reversed {
            1.0 - t
        } else {
            t
        }
    }

    fn failure(&self, t: f64, reason: String) -> Error {
        let t = self.caller_parameter(t);
        Error::Callback { loop_index: self.loop_index, segment: self.index, t, reason }
    }

    /// The point at `t` in [0, 1], in the loop's direction and the caller's unit.
    pub fn point(&self, t: f64) -> Result<Point> {
        match self.curve.point(self.caller_parameter(t)) {
            Ok(p) => {
                let p = p + self.correction[0] * (1.0 - t) + self.correction[1] * t;
                if p.x.is_finite() && p.y.is_finite() {
                    Ok(p)
                } else {
                    Err(self.failure(t, format!("the point ({}, {}) is not finite", p.x, p.y)))
                }
            }
            Err(CurveFailure(reason)) => Err(self.failure(t, reason)),
        }
    }

    /// d/dt at `t`. It may vanish, or be infinite where the caller's parametrisation is singular.
    pub fn derivative(&self, t: f64) -> Result<Vector> {
        let [a, b] = self.range;
        let d = match self.curve.derivative(self.caller_parameter(t)) {
            Some(d) => d.map(|d| d * (b - a)),
            None => differences::derivative(|u| self.curve.point(a + (b - a) * u), self.unreversed(t)),
        };
        let d = d.map_err(|CurveFailure(reason)| self.failure(t, reason))?;
        Ok(if self.reversed { -d } else { d } + (self.correction[1] - self.correction[0]))
    }

    /// d/dt at `t`, refused if it is not finite.
    pub(crate) fn finite_derivative(&self, t: f64) -> Result<Vector> {
        let d = self.derivative(t)?;
        if d.x.is_finite() && d.y.is_finite() {
            Ok(d)
        } else {
            Err(self.failure(t, "the derivative is not finite".into()))
        }
    }

    /// Unit tangent at `t` strictly inside (0, 1), also where the parametrisation stands still.
    pub(crate) fn tangent(&self, t: f64) -> Result<Vector> {
        let d = self.derivative(t)?;
        let n = d.norm();
        if n.is_finite() && n > 0.0 {
            return Ok(d / n);
        }
        let room = t.min(1.0 - t);
        for k in [20, 14, 8, 2] {
            let h = room * 0.5f64.powi(k);
            let d = self.point(t + h)? - self.point(t - h)?;
            if d.norm() > 0.0 {
                return Ok(d.normalize());
            }
        }
        self.end_tangent(false)
    }

    /// Whether its direction may jump inside.
    pub(crate) fn may_have_corners(&self) -> bool {
        self.curve.may_have_corners()
    }

    /// The two parts before and after parameter `t`; only before it is reversed or joined.
    pub(crate) fn split(&self, t: f64) -> [CurveSegment; 2] {
        let [a, b] = self.range;
        let middle = self.caller_parameter(t);
        [[a, middle], [middle, b]].map(|range| CurveSegment { range, ..self.clone() })
    }

    /// Its first point.
    pub fn start(&self) -> Result<Point> {
        self.point(0.0)
    }

    /// Its last point.
    pub fn end(&self) -> Result<Point> {
        self.point(1.0)
    }

    /// Parameters from 0 to 1, both included, between which it is smooth.
    pub fn pieces(&self) -> Vec<f64> {
        let mut t = vec![0.0];
        let [a, b] = self.range;
        let shares = self.curve.breaks().iter().map(|&k| snap((k - a) / (b - a)));
        t.extend(shares.filter(|&k| k > 0.0 && k < 1.0));
        if self.reversed {
            t[1..].reverse();
            t[1..].iter_mut().for_each(|b| *b = 1.0 - *b);
        }
        t.push(1.0);
        t.dedup();
        t
    }

    /// Parameters that show its shape: the pieces' ends and points between them at dyadic shares.
    pub(crate) fn sample_parameters(&self) -> Vec<f64> {
        if self.is_line() {
            return vec![0.0, 1.0];
        }
        let pieces = self.pieces();
        let per_piece = if pieces.len() > 2 { 4 } else { 64 };
        let mut t = Vec::with_capacity(per_piece * (pieces.len() - 1) + 1);
        for w in pieces.windows(2) {
            t.extend((0..per_piece).map(|k| snap(w[0] + (w[1] - w[0]) * k as f64 / per_piece as f64)));
        }
        t.push(1.0);
        t
    }

    /// Points that show its shape, both ends included.
    pub fn sample(&self) -> Result<Vec<Point>> {
        self.sample_parameters().into_iter().map(|t| self.point(t)).collect()
    }

    /// Diagonal of the bounding box of a few of its points.
    pub(crate) fn size(&self) -> Result<f64> {
        let mut bounds = crate::domain::Bounds::new();
        for k in 0..=8 {
            bounds.add(self.point(k as f64 / 8.0)?);
        }
        Ok(bounds.diagonal())
    }

    /// The same segment walked backwards.
    pub(crate) fn reverse(&mut self) {
        self.reversed = !self.reversed;
        self.correction.swap(0, 1);
    }

    /// Moves its end at t = 1 (`at_end`) or 0 to `to`.
    pub(crate) fn move_end(&mut self, at_end: bool, to: Point) -> Result<()> {
        if self.correction == [Vector::zeros(); 2] && self.range == [0.0, 1.0] {
            if let Some(curve) = self.curve.with_end(at_end != self.reversed, to) {
                self.curve = curve;
                return Ok(());
            }
        }
        let shift = to - self.point(if at_end { 1.0 } else { 0.0 })?;
        self.correction[usize::from(at_end)] += shift;
        Ok(())
    }

    /// Unit tangent in the direction of travel at t = 1 (`at_end`) or 0: the limit where the derivative
    /// vanishes or is infinite.
    pub fn end_tangent(&self, at_end: bool) -> Result<Vector> {
        let size = if self.is_line() { 0.0 } else { self.size()? };
        let (end, inward) = if at_end { (1.0, -1.0) } else { (0.0, 1.0) };
        let d = self.derivative(end)?;
        let n = d.norm();
        // At a corner inside the caller's curve its derivative may be that of the other side.
        let at_end_of_curve = [0.0, 1.0].contains(&self.caller_parameter(end));
        if at_end_of_curve && n.is_finite() && n > 1e-7 * size {
            return Ok(d / n);
        }
        // Directions to points near the end, at steps that halve, extrapolated to it: they are smooth in t
        // whatever the order at which the derivative vanishes. The steps stop where rounding would show.
        let tip = self.point(end)?;
        let noise = f64::EPSILON * (tip.coords.norm() + size);
        let least = (1e-8 * size).max(1e6 * noise);
        let away = |k: i32| -> Result<Vector> { Ok(self.point(end + inward * 0.5f64.powi(k))? - tip) };
        let mut last = LEVELS;
        while last < 40 && away(last + 1)?.norm() >= least {
            last += 1;
        }
        let mut row: Vec<Vector> = Vec::new();
        for k in last - LEVELS + 1..=last {
            let d = away(k)?;
            let mut value = if d.norm() > 0.0 { d.normalize() } else { Vector::zeros() };
            let mut factor = 1.0;
            for old in &mut row {
                factor *= 2.0;
                let next = value + (value - *old) / (factor - 1.0);
                *old = std::mem::replace(&mut value, next);
            }
            row.push(value);
        }
        if let Some(t) = row.last().filter(|t| t.norm() > 0.5) {
            return Ok(t.normalize() * inward);
        }
        let chord = self.end()? - self.start()?;
        let n = chord.norm();
        Ok(if n > 0.0 { chord / n } else { Vector::new(1.0, 0.0) })
    }

    /// Whether its points alone, compared lexicographically, prefer this direction to the opposite:
    /// computations done in the preferred direction do not depend on how the caller walked it.
    pub(crate) fn prefers_this_direction(&self) -> Result<bool> {
        let (mut a, mut b) = (self.start()?, self.end()?);
        for t in [0.25, 0.125, 0.375] {
            if a != b {
                break;
            }
            (a, b) = (self.point(t)?, self.point(1.0 - t)?);
        }
        Ok((a.x, a.y) <= (b.x, b.y))
    }

    /// Integrates `f(point − origin, derivative)` over t in [0, 1]; several integrals at once.
    pub(crate) fn integrate<const K: usize>(
        &self,
        origin: Point,
        f: impl Fn(Vector, Vector) -> [f64; K],
    ) -> Result<[f64; K]> {
        let pieces = self.pieces();
        let (rule, parts) = match (self.is_line(), pieces.len()) {
            (true, _) => (GaussRule::two(), 1),
            (_, 2) => (GaussRule::sixteen(), 8),
            _ => (GaussRule::eight(), 1),
        };
        let mut sum = [0.0; K];
        for w in pieces.windows(2) {
            let h = (w[1] - w[0]) / parts as f64;
            for part in 0..parts {
                let a = w[0] + part as f64 * h;
                for (x, weight) in rule.nodes.iter().zip(&rule.weights) {
                    let t = snap(a + h * x);
                    let d = self.finite_derivative(t)?;
                    let value = f(self.point(t)? - origin, d);
                    for k in 0..K {
                        sum[k] += h * weight * value[k];
                    }
                }
            }
        }
        Ok(sum)
    }
}

impl std::fmt::Debug for CurveSegment {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("CurveSegment")
            .field("name", &self.name)
            .field("index", &self.index)
            .field("reversed", &self.reversed)
            .field("start", &self.start().ok())
            .field("end", &self.end().ok())
            .finish()
    }
}
