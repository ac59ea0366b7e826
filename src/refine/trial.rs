//! One change of the mesh: made, re-optimised, and kept only if everything still holds.

use super::collapse::Collapsed;
use super::respace::respace;
use crate::domain::Place;
use crate::mesh::QuadMesh;
use crate::smooth::{Effort, Optimiser};

/// What a coarser mesh has to keep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Least scaled Jacobian; a mesh that is below already must not get worse.
    pub scaled_jacobian: f64,
    /// Least ratio of smallest to largest Jacobian inside an element, likewise.
    pub jacobian_ratio: f64,
    /// Largest mean length of opposite sides, in the canonical frame.
    pub size: f64,
}

impl Limits {
    /// For a floor of the scaled Jacobian, without a limit on the size.
    pub fn new(scaled_jacobian: f64) -> Self {
        Limits { scaled_jacobian, jacobian_ratio: 0.05, size: f64::INFINITY }
    }
}

/// Rings of quads around a change that are re-optimised, and the effort, in turn until one will do.
const ATTEMPTS: [(usize, Effort); 3] = [(1, Effort::Quick), (3, Effort::Quick), (3, Effort::Full)];

/// A least Jacobian (over the element's area) after the first attempt from which a wider one has not been seen
/// to help.
const HOPELESS: f64 = -0.4;
/// Share of the floor from which full effort may still reach it.
const NEARLY: f64 = 0.8;

/// Completes a merge: boundary vertices re-spaced, the surroundings optimised. The mesh, and the
/// quads that were optimised, if the limits within so many rings hold for them; a second attempt costs more work. Adds the
/// element evaluations spent to `work`.
pub(super) fn settle(
    optimiser: &Optimiser,
    mut change: Collapsed,
    limits_at: &dyn Fn(usize) -> Limits,
    work: &mut u64,
) -> Option<(QuadMesh, Vec<u32>)> {
    let mesh = &mut change.mesh;
    let mut seeds = change.touched.clone();
    if let Some(error) = optimiser.boundary_error() {
        let mut chains: Vec<u32> = change
            .touched
            .iter()
            .flat_map(|v| change.stars.of(*v))
            .flat_map(|q| mesh.quad_edges[*q as usize])
            .filter_map(|e| mesh.edges[e as usize].span.map(|s| s.chain))
            .collect();
        chains.sort_unstable();
        chains.dedup();
        for chain in chains {
            seeds.extend(respace(optimiser.boundary(), error, mesh, chain)?);
        }
    }
    for (rings, effort) in ATTEMPTS {
        let active = change.stars.rings(mesh, &seeds, rings);
        let limits = limits_at(rings + 1);
        let outcome = optimiser.optimise(mesh, Some(&active), effort);
        *work += outcome.work;
        let quality = optimiser.quality_of(mesh, Some(&active));
        let others = quality.min_jacobian_ratio >= limits.jacobian_ratio
            && quality.error_ratio <= 1.0
            && quality.elements.iter().all(|e| e.size <= limits.size);
        if outcome.valid && others && quality.min_scaled_jacobian >= limits.scaled_jacobian {
            return Some((change.mesh, active));
        }
        // More work lifts the scaled Jacobian, not the rest; and what is far off will not come back.
        let far_off = quality.min_scaled_jacobian < NEARLY * limits.scaled_jacobian;
        let hopeless =
            if rings == 1 { outcome.least_jacobian < HOPELESS } else { !outcome.valid || !others || far_off };
        if hopeless {
            return None;
        }
    }
    None
}

/// How many boundary edges each chain has in the mesh.
pub(super) fn boundary_edges(mesh: &QuadMesh, chains: usize) -> Vec<usize> {
    let mut count = vec![0; chains];
    mesh.edges.iter().filter_map(|e| e.span).for_each(|s| count[s.chain as usize] += 1);
    count
}

/// Removes vertices that no quad uses.
pub(super) fn compact(mesh: &mut QuadMesh) {
    let mut used = vec![false; mesh.vertices.len()];
    mesh.quads.iter().flatten().for_each(|v| used[*v as usize] = true);
    let mut number = vec![0u32; used.len()];
    let mut next = 0;
    for (n, used) in number.iter_mut().zip(&used) {
        *n = next;
        next += u32::from(*used);
    }
    let mut at = 0;
    mesh.vertices.retain(|_| {
        at += 1;
        used[at - 1]
    });
    mesh.quads.iter_mut().flatten().for_each(|v| *v = number[*v as usize]);
    mesh.edges.iter_mut().flat_map(|e| &mut e.vertices).for_each(|v| *v = number[*v as usize]);
}

/// Whether a vertex lies on the boundary.
pub(super) fn on_boundary(mesh: &QuadMesh, v: u32) -> bool {
    mesh.vertices[v as usize].place != Place::Interior
}
