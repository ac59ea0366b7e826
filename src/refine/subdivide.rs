//! The paper's subdivision of a whole mesh: boundary edges are halved until the tolerance holds on all.

use super::split_chords;
use crate::domain::Boundary;
use crate::error::{Error, Result};
use crate::mesh::{BoundaryError, QuadMesh};
use crate::numerics::tolerances::SHORTEST_EDGE;

/// Rounds of halving after which an edge is shorter than any that makes sense.
const MOST_ROUNDS: usize = 40;

/// Halves every boundary edge of `mesh` whose error exceeds the tolerance, the split carried along its
/// chord, until none does (Algorithm 1 of the paper).
///
/// # Errors
/// [`Error::Tolerance`] with the worst edge's place (canonical frame) when that needs more than
/// `max_elements` quads or edges without extent; [`Error::Layout`] when the mesh is defective.
pub fn subdivide(
    mesh: QuadMesh,
    boundary: &Boundary,
    error: &BoundaryError,
    max_elements: usize,
) -> Result<QuadMesh> {
    let mut mesh = mesh;
    for _ in 0..MOST_ROUNDS {
        let ratios: Vec<f64> =
            mesh.edges.iter().map(|e| e.span.map_or(0.0, |s| error.ratio(boundary, s))).collect();
        let bad: Vec<bool> = ratios.iter().map(|r| *r > 1.0).collect();
        let Some(worst) = (0..bad.len()).filter(|e| bad[*e]).max_by(|a, b| ratios[*a].total_cmp(&ratios[*b]))
        else {
            return Ok(mesh);
        };
        let refusal = Error::Tolerance {
            error: ratios[worst] * error.tolerance.value,
            tolerance: error.tolerance.value,
            at: mesh.edge_middle(boundary, worst),
        };
        let short = |e: usize| bad[e] && mesh.edges[e].span.is_some_and(|s| s.end - s.start < SHORTEST_EDGE);
        if (0..bad.len()).any(short) {
            return Err(refusal);
        }
        mesh = split_chords(&mesh, boundary, &bad, error.tolerance.order)
            .map_err(|(reason, at)| Error::Layout { reason, at: Some(at) })?;
        if mesh.quads.len() > max_elements {
            return Err(refusal);
        }
    }
    Err(Error::Tolerance {
        error: f64::INFINITY,
        tolerance: error.tolerance.value,
        at: mesh.vertices[0].point,
    })
}
