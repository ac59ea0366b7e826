//! Rotations and mirrors about the origin.

use crate::numerics::{Point, Vector};

/// An orthogonal map of the canonical frame about its origin, the centroid of the area. With points as complex
/// numbers it is z ↦ turn · z, for a mirror z ↦ turn · z̄.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isometry {
    /// The cosine and sine of the angle turned by; for a mirror of twice its axis' angle.
    pub turn: Vector,
    pub mirror: bool,
}

/// The product of two vectors as complex numbers.
pub(super) fn product(a: Vector, b: Vector) -> Vector {
    Vector::new(a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x)
}

/// The complex conjugate.
pub(super) fn conjugate(v: Vector) -> Vector {
    Vector::new(v.x, -v.y)
}

/// The unit vector at `angle`, in radians.
pub(super) fn direction(angle: f64) -> Vector {
    Vector::new(angle.cos(), angle.sin())
}

impl Isometry {
    /// The map that moves nothing.
    pub fn identity() -> Self {
        Isometry { turn: Vector::new(1.0, 0.0), mirror: false }
    }

    /// The rotation by `angle`, in radians, counter-clockwise.
    pub fn rotation(angle: f64) -> Self {
        Isometry { turn: direction(angle), mirror: false }
    }

    /// The mirror at the line through the origin at `angle`, in radians.
    pub fn mirror(angle: f64) -> Self {
        Isometry { turn: direction(2.0 * angle), mirror: true }
    }

    /// The image of a displacement.
    pub fn vector(&self, v: Vector) -> Vector {
        product(self.turn, if self.mirror { conjugate(v) } else { v })
    }

    /// The image of a point.
    pub fn point(&self, p: Point) -> Point {
        Point::from(self.vector(p.coords))
    }

    /// The map that undoes it.
    pub fn inverse(&self) -> Self {
        if self.mirror {
            *self
        } else {
            Isometry { turn: conjugate(self.turn), ..*self }
        }
    }

    /// First `other`, then `self`.
    pub fn after(&self, other: &Isometry) -> Self {
        Isometry { turn: self.vector(other.turn), mirror: self.mirror != other.mirror }
    }

    /// The angle of a mirror's axis, in [0, π).
    pub fn axis(&self) -> f64 {
        0.5 * self.turn.y.atan2(self.turn.x).rem_euclid(2.0 * std::f64::consts::PI)
    }
}
