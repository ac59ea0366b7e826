//! Curves given by two expressions x(t), y(t).

use crate::domain::{Curve, CurveFailure};
use crate::input::expression::Expression;
use crate::numerics::{Point, Vector};

/// The curve (x(t), y(t)).
#[derive(Debug, Clone, PartialEq)]
pub struct EquationCurve {
    pub x: Expression,
    pub y: Expression,
}

impl Curve for EquationCurve {
    fn point(&self, t: f64) -> Result<Point, CurveFailure> {
        Ok(Point::new(self.x.evaluate(t).0, self.y.evaluate(t).0))
    }

    fn derivative(&self, t: f64) -> Option<Result<Vector, CurveFailure>> {
        Some(Ok(Vector::new(self.x.evaluate(t).1, self.y.evaluate(t).1)))
    }
}
