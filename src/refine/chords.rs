//! Chords: strips of quads from edge to opposite edge, from boundary to boundary or closed.

use super::live::LiveMesh;
use crate::mesh::QuadMesh;
use crate::numerics::NONE;

/// A chord. Every edge belongs to exactly one; a quad to two, or twice to one that crosses itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Chord {
    /// The edges crossed, in order; a closed chord's first is not repeated.
    pub rungs: Vec<u32>,
    /// The quads passed: one less than rungs, as many if closed.
    pub quads: Vec<u32>,
}

/// The side of `quad` that is edge `edge`.
pub(super) fn side_of(mesh: &QuadMesh, quad: u32, edge: u32) -> usize {
    mesh.quad_edges[quad as usize].iter().position(|e| *e == edge).unwrap_or(0)
}

/// Rungs and quads from `edge` into `quad` and on, until the boundary or `edge` again.
fn walk(mesh: &QuadMesh, edge: u32, quad: u32, chord: &mut Chord) -> bool {
    let (mut e, mut q) = (edge, quad);
    // No chord has more rungs than there are edges.
    for _ in 0..=mesh.edges.len() {
        if q == NONE {
            return false;
        }
        chord.quads.push(q);
        e = mesh.quad_edges[q as usize][(side_of(mesh, q, e) + 2) % 4];
        if e == edge {
            return true;
        }
        chord.rungs.push(e);
        let [left, right] = mesh.edges[e as usize].quads;
        q = if left == q { right } else { left };
    }
    false
}

/// The chord through `edge`.
pub(super) fn chord_through(mesh: &QuadMesh, edge: u32) -> Chord {
    let mut chord = Chord { rungs: vec![edge], quads: vec![] };
    let [left, right] = mesh.edges[edge as usize].quads;
    if walk(mesh, edge, left, &mut chord) || right == NONE {
        return chord;
    }
    let mut back = Chord { rungs: vec![], quads: vec![] };
    walk(mesh, edge, right, &mut back);
    back.rungs.reverse();
    back.quads.reverse();
    back.rungs.append(&mut chord.rungs);
    back.quads.append(&mut chord.quads);
    back
}

/// All chords of a mesh, in order of their first edges.
pub(super) fn chords(live: &LiveMesh) -> Vec<Chord> {
    let mut seen = vec![false; live.mesh.edges.len()];
    let mut list = Vec::new();
    for e in (0..live.mesh.edges.len() as u32).filter(|e| live.has_edge(*e)) {
        if !seen[e as usize] {
            let chord = chord_through(&live.mesh, e);
            chord.rungs.iter().for_each(|r| seen[*r as usize] = true);
            list.push(chord);
        }
    }
    list
}
