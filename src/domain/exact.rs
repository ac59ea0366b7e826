//! Points on the exact curves at given arc lengths.

use crate::domain::boundary::Boundary;
use crate::domain::gauss::GaussRule;
use crate::domain::planar_domain::Domain;
use crate::error::{Error, Result};
use crate::numerics::tolerances::ARC_LENGTH_MATCH;
use crate::numerics::Point;
use crate::options::{Norm, Tolerance};

/// A place on a loop's curve: the segment's position in [`BoundaryLoop::segments`](crate::domain::BoundaryLoop::segments)
/// and its parameter, in the loop's direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePlace {
    /// Position in [`Domain::loops`].
    pub loop_index: usize,
    pub segment: usize,
    pub t: f64,
}

/// Most steps of the search for a parameter; bisection alone needs 52.
const MOST_STEPS: usize = 60;

impl Boundary {
    /// The place on the curves at arc length `s` of a chain: arc length and parameter agree to
    /// 1e-12 of the canonical length.
    pub fn curve_place(&self, domain: &Domain, chain: u32, s: f64) -> Result<CurvePlace> {
        let missing = || Error::InvalidArgument {
            what: "the chain",
            value: chain.to_string(),
            allowed: "a chain of this domain's boundary",
        };
        let table = self.chains.get(chain as usize).ok_or_else(missing)?;
        let loop_index = *self.loop_sources.get(table.loop_index as usize).ok_or_else(missing)? as usize;
        let segments = domain.loops().get(loop_index).ok_or_else(missing)?.segments();
        let s = table.wrap(s);
        let (a, b) = table.around(s);
        let place = |t| CurvePlace { loop_index, segment: a.segment as usize, t };
        let curve = segments.get(a.segment as usize).ok_or_else(missing)?;
        if s <= a.s || curve.is_line() {
            return Ok(place(a.t + (b.t - a.t) * ((s - a.s) / (b.s - a.s)).clamp(0.0, 1.0)));
        }
        if s >= b.s {
            return Ok(place(b.t));
        }
        // Newton, kept inside a shrinking bracket.
        let speed = |t: f64| Ok::<f64, Error>(curve.finite_derivative(t)?.norm() / self.frame.scale);
        let rule = GaussRule::eight();
        let (mut low, mut high) = (a.t, b.t);
        let mut t = a.t + (b.t - a.t) * (s - a.s) / (b.s - a.s);
        for _ in 0..MOST_STEPS {
            let mut length = 0.0;
            for (x, w) in rule.nodes.iter().zip(&rule.weights) {
                length += w * speed(a.t + (t - a.t) * x)?;
            }
            let miss = a.s + length * (t - a.t) - s;
            if miss.abs() <= ARC_LENGTH_MATCH {
                break;
            }
            if miss > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let next = t - miss / speed(t)?;
            t = if next > low && next < high { next } else { 0.5 * (low + high) };
        }
        Ok(place(t))
    }

    /// The point of the exact curve at arc length `s` of a chain, in the caller's frame.
    pub fn exact_point(&self, domain: &Domain, chain: u32, s: f64) -> Result<Point> {
        let place = self.curve_place(domain, chain, s)?;
        domain.loops()[place.loop_index].segments()[place.segment].point(place.t)
    }

    /// The boundary tolerance in the canonical frame: a length for [`Norm::Max`], else length^{3/2}.
    pub fn canonical_tolerance(&self, tolerance: Tolerance, norm: Norm) -> f64 {
        let power = |length: f64| if norm == Norm::Max { length } else { length * length.sqrt() };
        match tolerance {
            Tolerance::Absolute(e) => e / power(self.frame.scale),
            Tolerance::Relative(e) => e * power(self.diagonal),
        }
    }
}

impl CurvePlace {
    /// The same place as the caller counts: number of the loop, of the segment in it, and its parameter.
    pub fn in_callers_terms(&self, domain: &Domain) -> (usize, usize, f64) {
        let l = &domain.loops()[self.loop_index];
        let segment = &l.segments()[self.segment];
        (l.index(), segment.index(), segment.caller_parameter(self.t))
    }
}
