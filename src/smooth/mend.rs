//! Elements that are inverted where the usual samples do not look: optimised with denser ones, and nothing else.

use super::local::{grow, parts, Saved};
use super::optimiser::{Care, Optimiser};
use crate::mesh::QuadMesh;
use crate::numerics::tolerances::LEAST_JACOBIAN;
use crate::numerics::NONE;

/// Rings of quads around refused ones, in turn.
const RINGS: [usize; 3] = [1, 3, 6];

/// See [`Optimiser::mend`]; adds what it costs to `work`.
pub(super) fn mend(
    optimiser: &Optimiser,
    mesh: &mut QuadMesh,
    refused: &[u32],
    refuses: &dyn Fn(&QuadMesh, &[u32]) -> Vec<u32>,
    care: Care,
    work: &mut u64,
) -> Vec<u32> {
    let around = mesh.quads_around();
    let mut refused = refused.to_vec();
    for rings in RINGS {
        let mut left = Vec::new();
        for part in parts(mesh, &grow(mesh, &around, &refused, rings)) {
            left.extend(mend_part(optimiser, mesh, &part, refuses, care, work));
        }
        refused = left;
    }
    refused
}

/// Optimises the quads `part` as they are, then with straight edges between them if some stay refused: what is
/// straight-sided and not inverted at its corners is valid. What does not help is undone. Those still refused.
fn mend_part(
    optimiser: &Optimiser,
    mesh: &mut QuadMesh,
    part: &[u32],
    refuses: &dyn Fn(&QuadMesh, &[u32]) -> Vec<u32>,
    care: Care,
    work: &mut u64,
) -> Vec<u32> {
    let mut refused = refuses(mesh, part);
    let error = optimiser.quality_of(mesh, Some(part)).error_ratio;
    for straight in [false, true] {
        if refused.is_empty() {
            break;
        }
        let saved = Saved::of(mesh, part);
        if straight {
            straighten(mesh, part);
        }
        optimiser.run_dense(mesh, part, care, work);
        let after = refuses(mesh, part);
        let quality = optimiser.quality_of(mesh, Some(part));
        let inverted = quality.elements.iter().filter(|e| e.jacobian_ratio <= LEAST_JACOBIAN).count();
        // What is refused may be inverted to the samples, too; others may not be for its sake.
        if after.len() < refused.len() && inverted <= after.len() && quality.error_ratio <= error.max(1.0) {
            refused = after;
        } else {
            saved.restore(mesh);
        }
    }
    refused
}

/// Takes the bubbles off the edges between quads of `part`.
fn straighten(mesh: &mut QuadMesh, part: &[u32]) {
    let own = |q: u32| q != NONE && part.binary_search(&q).is_ok();
    for e in part.iter().flat_map(|q| mesh.quad_edges[*q as usize]) {
        let edge = &mut mesh.edges[e as usize];
        if edge.quads.into_iter().all(own) {
            edge.bubbles.clear();
        }
    }
}
