//! Step 2 of the paper: the cross field.
//!
//! *In:* the [`Triangulation`] and the corners.
//! *Out:* a [`CrossField`]: u = (cos 4θ, sin 4θ) at the vertices, and the angle of one arm of the
//! cross around the border of every triangle, as the tracer needs it.
//!
//! The border polygon's edges are streamlines: the cross on a border edge is the edge's direction.
//! At a border vertex of interior angle θ that carries n quads the cross on the ray at polar angle φ
//! from the outgoing border edge (direction a₀) is a₀ + φ (θ − n π/2) / θ: the vertex is blown
//! up to an arc. n is 2 at every smooth border vertex. On a second try corners near a
//! tie of Table 1 take up singularities beside them (`absorption`).
//!
//! *Method:* linear finite elements for u, first harmonic (Kowalski, Ledoux, Frey 2013), then a few steps
//! of diffusion and renormalisation (Merriman, Bence, Osher 1992; Viertel, Osting 2019), which keep
//! singularities of equal sign apart ([`solve`]).

mod absorption;
mod border;
mod check;
mod diffusion;
mod thickness;
mod tips;
mod turning;

use absorption::absorb;
use border::Border;
pub use border::{quads_at_corner, Tips};

use crate::base_mesh::Triangulation;
use crate::domain::Boundary;
use crate::error::Result;
use crate::options::FieldMethod;

/// Most times that corners take up singularities and the field is solved again.
const ABSORPTIONS: usize = 8;

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

impl TriangleCross {
    /// The lifted angle where edge `i` starts (0, 1 or 2), after the turn at its corner.
    pub fn start_of_edge(&self, i: usize) -> f64 {
        (0..i).fold(self.start, |angle, k| angle + self.edge_turn[k] + self.corner_turn[k + 1])
    }
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

/// Solves for the cross field on `mesh`, whose border is that of `boundary`.
///
/// [`Error::CrossField`](crate::Error::CrossField) if the linear system cannot be solved or
/// the turns around a triangle do not add up to quarter turns (a degenerate mesh).
pub fn solve(mesh: &Triangulation, boundary: &Boundary, method: FieldMethod) -> Result<CrossField> {
    solve_with_corners(mesh, boundary, method, CornerRule::default())
}

/// How corners near a tie of Table 1 are treated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct CornerRule {
    pub tips: Tips,
    /// Whether corners of about 135°, 225° and 315° take up singularities in triangles at them: for a second try,
    /// when a separatrix found no way.
    pub absorbing: bool,
}

/// [`solve`] with a choice of the quads at corners near a tie.
///
/// # Errors
/// As [`solve`].
pub fn solve_with_corners(
    mesh: &Triangulation,
    boundary: &Boundary,
    method: FieldMethod,
    rule: CornerRule,
) -> Result<CrossField> {
    let mut border = Border::new(mesh, boundary, rule.tips)?;
    let mut rounds = 0;
    loop {
        let held = tips::held(mesh, boundary, &border);
        let u = diffusion::solve(mesh, &border, &held, method)?;
        let triangles = turning::triangle_crosses(mesh, &border, &held, &u)?;
        rounds += 1;
        if !rule.absorbing || rounds > ABSORPTIONS || !absorb(mesh, &triangles, &mut border) {
            return Ok(CrossField { u, triangles, quads_at: border.quads, border_angle: border.angle });
        }
    }
}
