//! The one thing quadrel needs of a boundary curve.

use crate::numerics::{Point, Vector};
use std::sync::Arc;

/// Why a curve could not be evaluated, in words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CurveFailure(pub String);

/// A parametric curve over t in [0, 1]. Equal t must give equal points.
pub trait Curve: Send + Sync {
    /// The point at `t`, in the caller's unit.
    fn point(&self, t: f64) -> Result<Point, CurveFailure>;

    /// d/dt at `t`; `None` if it is not known (differences are used then).
    fn derivative(&self, t: f64) -> Option<Result<Vector, CurveFailure>> {
        let _ = t;
        None
    }

    /// Parameters strictly inside (0, 1), ascending, where the curve is less smooth
    /// (knots of a spline): quadrature stops there.
    fn breaks(&self) -> &[f64] {
        &[]
    }

    /// Whether the curve is a straight segment.
    fn is_line(&self) -> bool {
        false
    }

    /// Whether its direction may jump inside (0, 1): it is then searched for corners, which become ends of
    /// segments.
    fn may_have_corners(&self) -> bool {
        true
    }

    /// The same curve with its end at t = 0 or 1 (`at_one`) moved to `p`, if the kind of curve has a
    /// natural way to do that; else a linear function of t is added to it.
    fn with_end(&self, at_one: bool, p: Point) -> Option<Arc<dyn Curve>> {
        let _ = (at_one, p);
        None
    }
}
