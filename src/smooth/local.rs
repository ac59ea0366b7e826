//! Untangling where the mesh is tangled, and nowhere else.
//!
//! The regularised energy first makes everything round and only then barrier-like; on a mesh that
//! is right but for a few elements that costs more than it mends. So the inverted elements and some rings
//! around them are untangled by themselves, the boundary fixed, with more rings in turn.

use super::optimiser::{Optimiser, Schedule};
use super::problem::Problem;
use super::reference::Reference;
use super::untangle::untangle;
use crate::mesh::QuadMesh;

/// Rings of quads around inverted ones, in turn.
const RINGS: [usize; 4] = [1, 2, 4, 7];
/// Share of the mesh above which the whole of it may as well be untangled.
const MOST: f64 = 0.7;

/// Untangles around inverted elements; a try that leaves more of them is forgotten.
pub(super) fn untangle_locally(
    optimiser: &Optimiser,
    reference: &Reference,
    mesh: &mut QuadMesh,
    schedule: &Schedule,
    evaluations: &mut usize,
) {
    let mut around = vec![Vec::new(); mesh.vertices.len()];
    for (q, quad) in mesh.quads.iter().enumerate() {
        quad.iter().for_each(|v| around[*v as usize].push(q as u32));
    }
    let mut inverted = inverted_quads(optimiser, mesh);
    for rings in RINGS {
        if inverted.is_empty() {
            return;
        }
        let active = grow(mesh, &around, &inverted, rings);
        if active.len() as f64 > MOST * mesh.quads.len() as f64 {
            return;
        }
        let before = mesh.clone();
        let mut problem = optimiser.problem(reference, mesh, Some(&active), false);
        untangle(&mut problem, &mut Default::default(), schedule, evaluations);
        Problem::store(&problem, mesh);
        let left = inverted_quads(optimiser, mesh);
        if left.len() > inverted.len() {
            *mesh = before;
        } else {
            inverted = left;
        }
    }
}

fn inverted_quads(optimiser: &Optimiser, mesh: &QuadMesh) -> Vec<u32> {
    let inverted = |q: &u32| optimiser.element_quality(mesh, *q).jacobian_ratio <= 0.0;
    (0..mesh.quads.len() as u32).filter(inverted).collect()
}

/// `quads` and `rings` rings of quads around them, ascending.
fn grow(mesh: &QuadMesh, around: &[Vec<u32>], quads: &[u32], rings: usize) -> Vec<u32> {
    let mut taken = vec![false; mesh.quads.len()];
    let mut all = quads.to_vec();
    all.iter().for_each(|q| taken[*q as usize] = true);
    let mut from = 0;
    for _ in 0..rings {
        let until = all.len();
        for k in from..until {
            for v in mesh.quads[all[k] as usize] {
                for &q in &around[v as usize] {
                    if !std::mem::replace(&mut taken[q as usize], true) {
                        all.push(q);
                    }
                }
            }
        }
        from = until;
    }
    all.sort_unstable();
    all
}
