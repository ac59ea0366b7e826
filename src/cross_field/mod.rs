//! Step 2 of the paper: the cross field.
//!
//! *In:* the [`Triangulation`](crate::base_mesh::Triangulation) and the corners.
//! *Out:* a [`CrossField`]: u = (cos 4θ, sin 4θ) at the vertices, and the angle of one arm of the
//! cross around the border of every triangle, as the tracer needs it.
//!
//! The border polygon's edges are streamlines: the cross on a border edge is the edge's direction.
//! At a border vertex of interior angle θ that carries n quads the cross on the ray at polar angle φ
//! from the outgoing border edge (direction a₀) is a₀ + φ (θ − n π/2) / θ: the vertex is blown
//! up to an arc. n is 2 at every smooth border vertex.

/// The angle of one arm of the cross around a triangle, lifted to the real line.
///
/// Walking counter-clockwise the angle is `start` at corner 0 on edge 0, changes linearly by
/// `edge_turn[0]` along edge 0, then by `corner_turn[1]` at corner 1 (not 0 only at border
/// vertices), by `edge_turn[1]` along edge 1 and so on, and last by `corner_turn[0]` at corner 0.
/// The sum of all turns is `winding` · π/2. The reversed edge in the neighbour has exactly the
/// opposite turn and an angle that agrees modulo π/2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TriangleCross {
    pub start: f64,
    pub edge_turn: [f64; 3],
    pub corner_turn: [f64; 3],
    /// 0 in a regular triangle, +1 where a three-valent, −1 where a five-valent singularity is.
    pub winding: i32,
}

/// The cross field on a base mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossField {
    /// (cos 4θ, sin 4θ) at the vertices, as solved (not normalised when harmonic).
    pub u: Vec<[f64; 2]>,
    pub triangles: Vec<TriangleCross>,
    /// Quads at each border vertex: 2 where smooth, by Table 1 at corners, 0 at corners below 45°
    /// (the paper's triangle rule later gives them their one quad); for other vertices 0.
    pub quads_at: Vec<u8>,
    /// Interior angle of the border polygon at border vertices, in radians; else 0.
    pub border_angle: Vec<f64>,
}
