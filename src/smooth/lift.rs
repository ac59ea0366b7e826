//! Improving where the mesh is poor, and nowhere else.

use super::local::{grow, parts, Saved};
use super::optimiser::{Care, Optimiser};
use crate::mesh::QuadMesh;

/// Rings of quads around poor ones, in turn.
const RINGS: [usize; 3] = [2, 3, 5];

/// See [`Optimiser::lift`].
pub(super) fn lift(
    optimiser: &Optimiser,
    mesh: &mut QuadMesh,
    floor: f64,
    care: Care,
    most_work: u64,
) -> u64 {
    let around = mesh.quads_around();
    let all: Vec<u32> = (0..mesh.quads.len() as u32).collect();
    let mut work = 0;
    let mut poor = below(optimiser, mesh, &all, floor);
    for rings in RINGS {
        let mut left = Vec::new();
        for part in parts(mesh, &grow(mesh, &around, &poor, rings)) {
            if work > most_work {
                return work;
            }
            let saved = Saved::of(mesh, &part);
            let before = optimiser.quality_of(mesh, Some(&part));
            let outcome = optimiser.optimise(mesh, Some(&part), care);
            work += outcome.work;
            let after = outcome.quality;
            if !after.valid()
                || after.min_scaled_jacobian < before.min_scaled_jacobian
                || after.error_ratio > before.error_ratio.max(1.0)
            {
                saved.restore(mesh);
            }
            left.extend(below(optimiser, mesh, &part, floor));
        }
        poor = left;
    }
    work
}

fn below(optimiser: &Optimiser, mesh: &QuadMesh, quads: &[u32], floor: f64) -> Vec<u32> {
    let poor = |q: &u32| optimiser.element_quality(mesh, *q).scaled_jacobian < floor;
    quads.iter().copied().filter(poor).collect()
}
