//! Step 3 of the paper: singularities, inside and at corners.
//!
//! *In:* the [`CrossField`](crate::cross_field::CrossField).
//! *Out:* interior [`Singularity`]s, with the directions of their separatrices, and the [`CornerFan`]s.
//! The index theorem 4χ = Σ (4 − valence) + Σ (2 − quads at the corner) is a hard gate.

use crate::numerics::Point;

/// An interior singularity: in triangle `triangle`, at `point`.
#[derive(Debug, Clone, PartialEq)]
pub struct Singularity {
    pub triangle: u32,
    pub point: Point,
    /// 3 or 5: the number of separatrices.
    pub valence: u8,
    /// Where each separatrix leaves the triangle: (edge, share of it from its start in (0, 1)),
    /// counter-clockwise; as many as the valence.
    pub ports: Vec<(u8, f64)>,
}

/// A corner of the border that is no smooth vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerFan {
    pub vertex: u32,
    /// The junction of the boundary.
    pub junction: u32,
    /// Interior angle in radians.
    pub angle: f64,
    /// Number of quads n that meet there (Table 1: n − 1 separatrices, at angles k θ / n);
    /// 0 below 45°: the region at the tip is a triangle, repaired by the paper's rule.
    pub quads: u8,
}
