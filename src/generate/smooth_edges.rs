//! Vertices at the joints and knots of the boundary, so that edges lie on smooth pieces of it.

use crate::domain::Boundary;
use crate::mesh::QuadMesh;
use crate::refine::OnChain;
use crate::smooth::{Optimiser, Quality};

/// Share of the mesh's least scaled Jacobian that moves may not go below: smooth edges are not worth bad angles.
const KEPT: f64 = 0.9;

/// Moves boundary vertices of `mesh`, which is valid, to breaks of their curves: all of a chain at once, or one by
/// one where that fails. A move is kept if the elements beside it keep the tolerance and a scaled Jacobian of `floor`
/// and [`KEPT`], or what they had. Whether anything moved.
pub(super) fn smooth_edges(
    mesh: &mut QuadMesh,
    boundary: &Boundary,
    optimiser: &Optimiser,
    floor: f64,
) -> bool {
    let around = mesh.quads_around();
    let least = floor.max(KEPT * optimiser.quality(mesh).min_scaled_jacobian);
    let beside = |vertices: &[u32]| {
        let mut quads: Vec<u32> = vertices.iter().flat_map(|v| &around[*v as usize]).copied().collect();
        quads.sort_unstable();
        quads.dedup();
        quads
    };
    let holds = |before: &Quality, after: &Quality| {
        after.valid()
            && after.error_ratio <= before.error_ratio.max(1.0)
            && after.min_scaled_jacobian >= least.min(before.min_scaled_jacobian)
    };
    let mut any = false;
    for mut chain in OnChain::with_breaks(mesh, boundary) {
        let candidates = chain.candidates();
        let quads = beside(chain.vertices());
        let before = optimiser.quality_of(mesh, Some(&quads));
        if let Some(undo) = chain.move_all(mesh, &candidates) {
            if holds(&before, &optimiser.quality_of(mesh, Some(&quads))) {
                any = true;
                continue;
            }
            undo.undo(mesh);
        }
        for candidate in candidates {
            let quads = beside(&[candidate.vertex]);
            let before = optimiser.quality_of(mesh, Some(&quads));
            let Some(undo) = chain.move_one(mesh, candidate) else { continue };
            if holds(&before, &optimiser.quality_of(mesh, Some(&quads))) {
                chain.accept(candidate);
                any = true;
            } else {
                undo.undo(mesh);
            }
        }
    }
    any
}
