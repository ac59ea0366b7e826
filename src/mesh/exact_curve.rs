//! The exact boundary behind the chains' tables.

use crate::domain::{Boundary, BoundaryPoint, Domain};
use crate::error::{Error, Result};
use crate::numerics::tolerances::EXACT_FOOT;
use crate::numerics::Point;

/// Where a boundary point lies in the caller's own description.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePlace {
    /// The loop, and its segment, in the caller's order.
    pub loop_index: u32,
    pub segment: u32,
    /// The segment's parameter in the caller's direction.
    pub t: f64,
}

/// The exact boundary, in the caller's frame.
pub trait ExactCurve {
    /// The exact point at arc length `at.s` of chain `at.chain`.
    fn point(&self, at: BoundaryPoint) -> Result<Point>;

    /// The caller's name of parameter `t` of segment `segment` of the boundary's loop `loop_index`.
    fn place(&self, loop_index: u32, segment: u32, t: f64) -> CurvePlace;
}

/// The boundary's tables taken as the exact curves: for meshes without a [`Domain`].
#[derive(Debug, Clone, Copy)]
pub struct TableCurve<'a>(pub &'a Boundary);

impl ExactCurve for TableCurve<'_> {
    fn point(&self, at: BoundaryPoint) -> Result<Point> {
        Ok(self.0.frame.to_caller(self.0.chains[at.chain as usize].point(at.s)))
    }

    fn place(&self, loop_index: u32, segment: u32, t: f64) -> CurvePlace {
        CurvePlace { loop_index, segment, t }
    }
}

/// The curves of a [`Domain`]: what is at an arc length is found beside the table's point.
#[derive(Debug, Clone, Copy)]
pub struct DomainCurve<'a> {
    pub boundary: &'a Boundary,
    pub domain: &'a Domain,
}

/// Most evaluations of a curve for one point; the search halves its bracket at worst every second time.
const MOST_EVALUATIONS: usize = 60;

impl DomainCurve<'_> {
    fn source_loop(&self, loop_index: u32) -> u32 {
        self.boundary.loop_sources.get(loop_index as usize).copied().unwrap_or(loop_index)
    }
}

impl ExactCurve for DomainCurve<'_> {
    /// The point of the curve whose foot on the table's tangent at s is the table's point. So it is
    /// exactly on the curve, and at arc length s as exactly as the table is.
    fn point(&self, at: BoundaryPoint) -> Result<Point> {
        let chain = &self.boundary.chains[at.chain as usize];
        let s = chain.wrap(at.s);
        let (from, to) = chain.bracket(s);
        let source = self.source_loop(chain.loop_index) as usize;
        let segment =
            self.domain
                .loops()
                .get(source)
                .and_then(|l| l.segments().get(from.segment as usize))
                .ok_or_else(|| Error::Unsupported { what: "the boundary is not of this domain".into() })?;
        if s == from.s {
            return segment.point(from.t);
        }
        if s == to.s {
            return segment.point(to.t);
        }
        let (p, d) = chain.evaluate(s);
        let along = |x: Point| (self.boundary.frame.to_canonical(x) - p).dot(&d);
        // False position with the Illinois rule, on points alone: the parametrisation may stand still.
        let (mut a, mut b) = (from.t, to.t);
        let (mut fa, mut fb) = (along(segment.point(a)?), along(segment.point(b)?));
        let mut t = a + (b - a) * (s - from.s) / (to.s - from.s);
        let mut x = segment.point(t)?;
        for step in 0..MOST_EVALUATIONS {
            let f = along(x);
            if f.abs() <= EXACT_FOOT {
                break;
            }
            if (f > 0.0) == (fb > 0.0) {
                (b, fb) = (t, f);
                fa *= 0.5;
            } else {
                (a, fa) = (t, f);
                fb *= 0.5;
            }
            let next =
                if step % 4 == 3 || fa * fb >= 0.0 { 0.5 * (a + b) } else { a - fa * (b - a) / (fb - fa) };
            if next == t {
                break;
            }
            t = next;
            x = segment.point(t)?;
        }
        Ok(x)
    }

    fn place(&self, loop_index: u32, segment: u32, t: f64) -> CurvePlace {
        let source = self.source_loop(loop_index);
        let own = CurvePlace { loop_index: source, segment, t };
        let Some(l) = self.domain.loops().get(source as usize) else { return own };
        let Some(curve) = l.segments().get(segment as usize) else { return own };
        CurvePlace {
            loop_index: l.index() as u32,
            segment: curve.index() as u32,
            t: curve.caller_parameter(t),
        }
    }
}
