//! The part of a mesh around a change, as a small mesh of its own.

use super::live::rings_around;
use super::merge::Merge;
use crate::domain::Boundary;
use crate::mesh::{reversed_bubbles, Edge, QuadMesh};
use crate::numerics::{Vector, NONE};
use std::collections::HashMap;

/// The quads around a merge, after it. Its outermost ring is there to hold the others.
#[derive(Debug, Clone, Default)]
pub(super) struct Patch {
    pub mesh: QuadMesh,
    /// Numbers in the whole mesh, which no merge changes: of edges that become one the least stays.
    pub vertices: Vec<u32>,
    pub quads: Vec<u32>,
    pub edges: Vec<u32>,
    /// Whether the mesh, not the domain, goes on behind an edge of the patch.
    pub rim: Vec<bool>,
    /// The ring each quad belongs to, 0 at the seeds.
    ring: Vec<usize>,
}

impl Patch {
    /// `rings` rings around the vertices `seeds` of the merged mesh. `None` if a border edge of the
    /// domain does not follow one chain.
    pub fn new(boundary: &Boundary, merge: &Merge, seeds: &[u32], rings: usize) -> Option<Patch> {
        let found = rings_around(seeds, rings, |v| merge.star(v), |q| merge.corners(q));
        let old = &merge.live.mesh;
        let mut patch = Patch {
            mesh: QuadMesh::default(),
            vertices: Vec::new(),
            quads: Vec::with_capacity(found.len()),
            edges: Vec::with_capacity(2 * found.len()),
            rim: Vec::new(),
            ring: Vec::with_capacity(found.len()),
        };
        let mut number_of: HashMap<u32, u32> = HashMap::with_capacity(2 * found.len());
        let mut edge_of: HashMap<[u32; 2], u32> = HashMap::with_capacity(3 * found.len());
        for (q, ring) in found {
            let local = patch.quads.len() as u32;
            let corners = merge.corners(q);
            let own = corners.map(|v| {
                *number_of.entry(v).or_insert_with(|| {
                    patch.vertices.push(v);
                    patch.mesh.vertices.push(merge.vertex(v));
                    patch.vertices.len() as u32 - 1
                })
            });
            let sides = merge.sides(q);
            let mut edges = [NONE; 4];
            for i in 0..4 {
                let (a, b) = (own[i], own[(i + 1) % 4]);
                let e = *edge_of.entry([a.min(b), a.max(b)]).or_insert(patch.edges.len() as u32);
                edges[i] = e;
                if e as usize == patch.edges.len() {
                    let bubbles = merge.bubbles(sides[i], corners[i]);
                    patch.edges.push(sides[i]);
                    patch.mesh.edges.push(Edge {
                        vertices: [a, b],
                        quads: [local, NONE],
                        span: None,
                        bubbles,
                    });
                    continue;
                }
                let edge = &mut patch.mesh.edges[e as usize];
                edge.quads[1] = local;
                let known = &mut patch.edges[e as usize];
                if *known != sides[i] {
                    // The edge's own direction is the other one.
                    let other = reversed_bubbles(&merge.bubbles(sides[i], corners[i]));
                    edge.bubbles = mean(&edge.bubbles, &other);
                    *known = sides[i].min(*known);
                }
            }
            patch.quads.push(q);
            patch.ring.push(ring);
            patch.mesh.quads.push(own);
            patch.mesh.quad_edges.push(edges);
            patch.mesh.region.push(old.region[q as usize]);
        }
        patch.rim = vec![false; patch.edges.len()];
        for (e, edge) in patch.mesh.edges.iter_mut().enumerate().filter(|(_, e)| e.quads[1] == NONE) {
            let [a, b] = edge.vertices.map(|v| patch.vertices[v as usize]);
            let beside = merge.star(a).iter().filter(|q| merge.corners(**q).contains(&b)).count();
            patch.rim[e] = beside > 1;
            if !patch.rim[e] {
                let [a, b] = edge.vertices.map(|v| patch.mesh.vertices[v as usize].place);
                edge.span = Some(boundary.span(a, b)?);
                edge.bubbles.clear();
            }
        }
        Some(patch)
    }

    /// Takes over what was moved in `inner`, a patch of the same merge with fewer rings: its quads come in the same
    /// order here, so that edges between them have the same directions.
    pub fn take_over(&mut self, inner: &Patch) {
        let place = |list: &[u32]| -> HashMap<u32, usize> { list.iter().copied().zip(0..).collect() };
        let (vertices, edges) = (place(&self.vertices), place(&self.edges));
        for (v, global) in inner.vertices.iter().enumerate() {
            if let Some(own) = vertices.get(global) {
                self.mesh.vertices[*own] = inner.mesh.vertices[v];
            }
        }
        for (e, global) in inner.edges.iter().enumerate().filter(|(e, _)| !inner.rim[*e]) {
            if let Some(own) = edges.get(global) {
                self.mesh.edges[*own].span = inner.mesh.edges[e].span;
                self.mesh.edges[*own].bubbles.clone_from(&inner.mesh.edges[e].bubbles);
            }
        }
    }

    /// The quads up to ring `rings`.
    pub fn within(&self, rings: usize) -> Vec<u32> {
        (0..self.quads.len() as u32).filter(|q| self.ring[*q as usize] <= rings).collect()
    }
}

/// The mean of two shapes; a straight one does not count.
fn mean(a: &[Vector], b: &[Vector]) -> Vec<Vector> {
    match (a.is_empty(), b.is_empty()) {
        (true, _) => b.to_vec(),
        (_, true) => a.to_vec(),
        _ => {
            let at = |c: &[Vector], m: usize| c.get(m).copied().unwrap_or_else(Vector::zeros);
            (0..a.len().max(b.len())).map(|m| (at(a, m) + at(b, m)) * 0.5).collect()
        }
    }
}
