//! The one thing quadrel needs of a boundary curve.

use crate::numerics::{Point, Vector};

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
}
