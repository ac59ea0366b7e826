//! Straight segments.

use crate::domain::curve::{Curve, CurveFailure};
use crate::numerics::{Point, Vector};
use std::sync::Arc;

/// The straight segment from `from` (t = 0) to `to` (t = 1).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    pub from: Point,
    pub to: Point,
}

impl Curve for Line {
    // The symmetric form gives the same bits when the segment is walked backwards.
    fn point(&self, t: f64) -> Result<Point, CurveFailure> {
        Ok(Point::from(self.from.coords * (1.0 - t) + self.to.coords * t))
    }

    fn derivative(&self, _t: f64) -> Option<Result<Vector, CurveFailure>> {
        Some(Ok(self.to - self.from))
    }

    fn is_line(&self) -> bool {
        true
    }

    fn with_end(&self, at_one: bool, p: Point) -> Option<Arc<dyn Curve>> {
        Some(Arc::new(if at_one { Line { to: p, ..*self } } else { Line { from: p, ..*self } }))
    }

    fn may_have_corners(&self) -> bool {
        false
    }
}
