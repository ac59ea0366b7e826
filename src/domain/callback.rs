//! Curves that the caller evaluates.

use crate::domain::curve::{Curve, CurveFailure};
use crate::numerics::{Point, Vector};

/// A closure from t in [0, 1] to coordinates; `Err` carries the caller's reason.
pub type CurveFn = dyn Fn(f64) -> Result<[f64; 2], String> + Send + Sync;

/// A curve given by a closure, with or without its derivative.
pub struct CallbackCurve {
    point: Box<CurveFn>,
    derivative: Option<Box<CurveFn>>,
}

impl CallbackCurve {
    /// `derivative` is d/dt; without it differences are used.
    pub fn new(point: Box<CurveFn>, derivative: Option<Box<CurveFn>>) -> Self {
        CallbackCurve { point, derivative }
    }
}

impl Curve for CallbackCurve {
    fn point(&self, t: f64) -> Result<Point, CurveFailure> {
        (self.point)(t).map(Point::from).map_err(CurveFailure)
    }

    fn derivative(&self, t: f64) -> Option<Result<Vector, CurveFailure>> {
        self.derivative.as_ref().map(|d| d(t).map(Vector::from).map_err(CurveFailure))
    }
}
