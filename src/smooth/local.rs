//! Untangling where the mesh is tangled, and nowhere else.
//!
//! The regularised energy first makes everything round and only then barrier-like; on a mesh that
//! is right but for a few elements that costs more than it mends. So the inverted elements and some rings
//! around them are untangled by themselves, what lies around them fixed, with more rings in turn. Parts that do
//! not touch are problems of their own: each takes the steps that it needs and no more.

use super::optimiser::{Care, Schedule, FLATTEN_SWEEPS, MOST_WORK};
use super::problem::Problem;
use super::untangle::untangle;
use crate::mesh::{Edge, QuadMesh, Vertex};
use crate::numerics::NONE;

/// Rings of quads around inverted ones, in turn.
const RINGS: [usize; 7] = [1, 2, 4, 7, 12, 20, 32];
/// Share of the mesh above which the whole of it may as well be untangled.
const MOST: f64 = 0.7;

/// Rings from which a part that stays tangled is tried again with its vertices at the means of their neighbours:
/// where some lie outside the domain, no step that keeps the others apart brings them back.
const FLAT_FROM: usize = 4;
/// Work for each quad of a mesh that is larger than all others; a tenth of its elements may be inverted.
const WORK_PER_QUAD: u64 = 150;
/// Quads above which the whole mesh is not untangled for a few elements ...
const MANY: usize = 10_000;
/// ... and the share of them that is few. What the regularised energy does to all others first, making them round,
/// takes more steps to come back from than so large a mesh is given.
const FEW: f64 = 0.01;

/// Whether so many inverted elements of a mesh are better left than the whole of it untangled.
pub(super) fn few_of_many(inverted: usize, quads: usize) -> bool {
    quads > MANY && (inverted as f64) < FEW * quads as f64
}

/// The elements that are untangled: curved or straight-sided.
pub(super) trait Elements {
    /// The quads `active` as a function of what may move.
    fn problem<'a>(&'a self, mesh: &QuadMesh, active: &[u32]) -> Problem<'a>;
    /// The schedule for so many of them.
    fn schedule(&self, care: Care, quads: usize) -> Schedule;
    /// Whether a quad is inverted.
    fn inverted(&self, mesh: &QuadMesh, quad: u32) -> bool;
}

/// Untangles around inverted elements; a try that leaves more of them is forgotten. The number of inverted
/// elements left, or more if the work ran out.
pub(super) fn untangle_locally(
    elements: &impl Elements,
    mesh: &mut QuadMesh,
    care: Care,
    work: &mut u64,
) -> usize {
    let around = mesh.quads_around();
    let all: Vec<u32> = (0..mesh.quads.len() as u32).collect();
    let mut inverted = among(elements, mesh, &all);
    let most_work = MOST_WORK.max(WORK_PER_QUAD * mesh.quads.len() as u64);
    for rings in RINGS {
        if inverted.is_empty() {
            break;
        }
        let active = grow(mesh, &around, &inverted, rings);
        if active.len() as f64 > MOST * mesh.quads.len() as f64 {
            break;
        }
        let mut left = Vec::new();
        for part in parts(mesh, &active) {
            if *work > most_work {
                return inverted.len();
            }
            left.extend(untangle_part(elements, mesh, &part, rings >= FLAT_FROM, care, work));
        }
        inverted = left;
    }
    inverted.len()
}

/// Untangles the quads `part` as they are, then `flat` as well if that leaves some inverted; the better of both stays.
/// The inverted ones that are left.
fn untangle_part(
    elements: &impl Elements,
    mesh: &mut QuadMesh,
    part: &[u32],
    flat: bool,
    care: Care,
    work: &mut u64,
) -> Vec<u32> {
    let mut best = (among(elements, mesh, part), Saved::of(mesh, part));
    let schedule = elements.schedule(care, part.len());
    let starts: &[bool] = if flat { &[false, true] } else { &[false] };
    for flat in starts {
        if best.0.is_empty() {
            break;
        }
        let mut problem = elements.problem(mesh, part);
        if *flat {
            problem.flatten(FLATTEN_SWEEPS);
        }
        untangle(&mut problem, &mut Default::default(), &schedule, work);
        problem.store(mesh);
        let after = among(elements, mesh, part);
        // As many inverted ones, but less so, are progress; flattened ones have lost their places.
        if after.len() < best.0.len() || (!flat && after.len() == best.0.len()) {
            best = (after, Saved::of(mesh, part));
        }
    }
    best.1.restore(mesh);
    best.0
}

fn among(elements: &impl Elements, mesh: &QuadMesh, quads: &[u32]) -> Vec<u32> {
    quads.iter().copied().filter(|q| elements.inverted(mesh, *q)).collect()
}

/// Vertices and edges of some quads, as they were.
pub(super) struct Saved {
    vertices: Vec<(u32, Vertex)>,
    edges: Vec<(u32, Edge)>,
}

impl Saved {
    pub fn of(mesh: &QuadMesh, quads: &[u32]) -> Self {
        let vertices = quads.iter().flat_map(|q| mesh.quads[*q as usize]);
        let edges = quads.iter().flat_map(|q| mesh.quad_edges[*q as usize]);
        Saved {
            vertices: vertices.map(|v| (v, mesh.vertices[v as usize])).collect(),
            edges: edges.map(|e| (e, mesh.edges[e as usize].clone())).collect(),
        }
    }

    pub fn restore(self, mesh: &mut QuadMesh) {
        self.vertices.into_iter().for_each(|(v, vertex)| mesh.vertices[v as usize] = vertex);
        self.edges.into_iter().for_each(|(e, edge)| mesh.edges[e as usize] = edge);
    }
}

/// `quads` and `rings` rings of quads around them, ascending.
pub(super) fn grow(mesh: &QuadMesh, around: &[Vec<u32>], quads: &[u32], rings: usize) -> Vec<u32> {
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

/// The parts of `quads` that are connected through edges, each ascending.
pub(super) fn parts(mesh: &QuadMesh, quads: &[u32]) -> Vec<Vec<u32>> {
    let mut waiting = vec![false; mesh.quads.len()];
    quads.iter().for_each(|q| waiting[*q as usize] = true);
    let mut parts = Vec::new();
    for &first in quads {
        if !std::mem::replace(&mut waiting[first as usize], false) {
            continue;
        }
        let mut part = vec![first];
        let mut next = 0;
        while next < part.len() {
            for e in mesh.quad_edges[part[next] as usize] {
                for q in mesh.edges[e as usize].quads {
                    if q != NONE && std::mem::replace(&mut waiting[q as usize], false) {
                        part.push(q);
                    }
                }
            }
            next += 1;
        }
        part.sort_unstable();
        parts.push(part);
    }
    parts
}
