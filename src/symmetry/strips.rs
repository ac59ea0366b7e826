//! Strips of quads that lie beside their own images: of such two one is enough.

use super::automorphism::MeshSymmetries;
use super::group::Group;
use crate::mesh::QuadMesh;
use std::collections::{BTreeSet, HashMap};

/// Sets of strips (each by one edge that it crosses) whose removal may leave a mesh as symmetric as before: the images
/// of a strip under half of the symmetries, where the other half has others; if `whole` is asked for, also those
/// under all of them.
pub fn strip_orbits(
    mesh: &QuadMesh,
    group: &Group,
    symmetries: &MeshSymmetries,
    whole: bool,
) -> Vec<Vec<u32>> {
    let strips = strips(mesh);
    let known: HashMap<[u32; 2], u32> = (0..).zip(&mesh.edges).map(|(e, edge)| (edge.vertices, e)).collect();
    let image = |element: usize, strip: u32| {
        let position = symmetries.elements.iter().position(|e| *e == element)?;
        let [a, b] = mesh.edges[strip as usize].vertices.map(|v| symmetries.vertices[position][v as usize]);
        let edge = known.get(&[a, b]).or_else(|| known.get(&[b, a]))?;
        Some(strips[*edge as usize])
    };
    let orbit = |elements: &[usize], strip: u32| -> Option<BTreeSet<u32>> {
        elements.iter().map(|e| image(*e, strip)).collect()
    };
    let names: BTreeSet<u32> = strips.iter().copied().collect();
    let mut sets: Vec<BTreeSet<u32>> = Vec::new();
    for half in halves(group, &symmetries.elements) {
        for strip in &names {
            let (Some(own), Some(all)) = (orbit(&half, *strip), orbit(&symmetries.elements, *strip)) else {
                continue;
            };
            if own.len() < all.len() && !sets.contains(&own) {
                sets.push(own);
            }
        }
    }
    let all = names.iter().filter(|_| whole).filter_map(|strip| orbit(&symmetries.elements, *strip));
    for set in all {
        if !sets.contains(&set) {
            sets.push(set);
        }
    }
    sets.into_iter().map(|set| set.into_iter().collect()).collect()
}

/// For each edge the least edge of its strip: of the edges opposite to each other in quads, on and on.
fn strips(mesh: &QuadMesh) -> Vec<u32> {
    let mut strip: Vec<u32> = (0..mesh.edges.len() as u32).collect();
    fn root(strip: &[u32], mut e: u32) -> u32 {
        while strip[e as usize] != e {
            e = strip[e as usize];
        }
        e
    }
    for sides in &mesh.quad_edges {
        for [a, b] in [[sides[0], sides[2]], [sides[1], sides[3]]] {
            let (a, b) = (root(&strip, a), root(&strip, b));
            strip[a.max(b) as usize] = a.min(b);
        }
    }
    (0..mesh.edges.len() as u32).map(|e| root(&strip, e)).collect()
}

/// The subgroups of half the size of the subgroup `elements`.
fn halves(group: &Group, elements: &[usize]) -> Vec<Vec<usize>> {
    let turns: Vec<usize> = elements.iter().copied().filter(|e| *e < group.rotations).collect();
    let mirrors: Vec<usize> = elements.iter().copied().filter(|e| *e >= group.rotations).collect();
    let mut halves = Vec::new();
    if turns.len() % 2 == 0 {
        // Every other rotation, without mirrors or with every other of them.
        let few = turns.len() / 2;
        match mirrors.as_slice() {
            [] => halves.push(group.subgroup(few, None)),
            _ => halves.extend([0, 1].map(|k| group.subgroup(few, Some(mirrors[k] - group.rotations)))),
        }
    }
    if !mirrors.is_empty() {
        halves.push(turns);
    }
    halves
}
