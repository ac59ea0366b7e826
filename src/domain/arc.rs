//! Circular and elliptic arcs.

use crate::domain::curve::{Curve, CurveFailure};
use crate::numerics::{Point, Vector};

/// The elliptic arc c + u cos θ + v sin θ, θ running linearly from `start` to `end` (radians).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipticArc {
    pub center: Point,
    /// The two conjugate half axes; perpendicular ones of equal length give a circle.
    pub u: Vector,
    pub v: Vector,
    pub start: f64,
    pub end: f64,
}

impl EllipticArc {
    /// The circular arc from angle `start` to `end`, counter-clockwise if `end > start`.
    pub fn circle(center: Point, radius: f64, start: f64, end: f64) -> Self {
        EllipticArc { center, u: Vector::new(radius, 0.0), v: Vector::new(0.0, radius), start, end }
    }

    /// The arc of the ellipse with half axes `radii`, turned by `rotation`; the angles are those of
    /// the parametric form, measured from its first axis.
    pub fn ellipse(center: Point, radii: [f64; 2], rotation: f64, start: f64, end: f64) -> Self {
        let (s, c) = rotation.sin_cos();
        let [a, b] = radii;
        EllipticArc { center, u: Vector::new(a * c, a * s), v: Vector::new(-b * s, b * c), start, end }
    }

    fn angle(&self, t: f64) -> f64 {
        self.start * (1.0 - t) + self.end * t
    }
}

impl Curve for EllipticArc {
    fn point(&self, t: f64) -> Result<Point, CurveFailure> {
        let (s, c) = self.angle(t).sin_cos();
        Ok(self.center + (self.u * c + self.v * s))
    }

    fn derivative(&self, t: f64) -> Option<Result<Vector, CurveFailure>> {
        let (s, c) = self.angle(t).sin_cos();
        Some(Ok((self.v * c - self.u * s) * (self.end - self.start)))
    }

    fn may_have_corners(&self) -> bool {
        false
    }
}
