//! Numerical tools that know nothing of meshes: points, Gauss-Lobatto nodes, quadrature,
//! interpolation, Bernstein forms, transfinite maps, degrees of solutions, the sparse solver and every named tolerance.

pub mod bernstein;
pub mod gauss_lobatto;
pub mod interpolation;
pub mod modal;
pub mod quadrature;
pub mod solution_degrees;
pub mod sparse;
pub mod tolerances;
pub mod transfinite;

pub use gauss_lobatto::{legendre, GaussLobatto};
pub use interpolation::Interpolation;
pub use modal::Modal;
pub use quadrature::GaussLegendre;
pub use transfinite::coons_map;

/// A point of the plane.
pub type Point = nalgebra::Point2<f64>;
/// A displacement or direction in the plane.
pub type Vector = nalgebra::Vector2<f64>;

/// "No such index" in index arrays (neighbours, elements beside an edge).
pub const NONE: u32 = u32::MAX;

/// The z component of the cross product `a × b`.
#[inline]
pub fn cross(a: Vector, b: Vector) -> f64 {
    a.x * b.y - a.y * b.x
}

/// `v` turned by 90° counter-clockwise.
#[inline]
pub fn left_normal(v: Vector) -> Vector {
    Vector::new(-v.y, v.x)
}
