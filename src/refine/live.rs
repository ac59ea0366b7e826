//! A mesh that loses quads in place: a change costs what it touches, not the mesh.

use super::patch::Patch;
use crate::mesh::QuadMesh;
use crate::numerics::NONE;

/// A mesh under coarsening. Quads, edges and vertices keep their numbers; what is gone stays in the
/// arrays, where nothing living refers to it, until [`LiveMesh::compact`].
#[derive(Debug, Clone)]
pub(super) struct LiveMesh {
    pub mesh: QuadMesh,
    /// The living quads at each vertex, ascending.
    stars: Vec<Vec<u32>>,
    alive: Vec<bool>,
    /// Number of living quads.
    pub count: usize,
    /// Number of boundary edges of each chain.
    pub boundary_edges: Vec<usize>,
}

/// New numbers by old ones, in the same order; `NONE` for what is gone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Numbering {
    pub vertices: Vec<u32>,
    pub edges: Vec<u32>,
}

/// What a change takes away, to be applied together with the patch that replaces it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Removal {
    pub quads: Vec<u32>,
    /// The new quads at each vertex that has others than before.
    pub stars: Vec<(u32, Vec<u32>)>,
    /// The chain of each boundary edge that vanishes.
    pub chains: Vec<u32>,
}

impl LiveMesh {
    /// All of `mesh`, on a boundary of so many chains.
    pub fn new(mesh: QuadMesh, chains: usize) -> Self {
        let mut stars = vec![Vec::new(); mesh.vertices.len()];
        for (q, quad) in mesh.quads.iter().enumerate() {
            quad.iter().for_each(|v| stars[*v as usize].push(q as u32));
        }
        let mut boundary_edges = vec![0; chains];
        mesh.edges.iter().filter_map(|e| e.span).for_each(|s| boundary_edges[s.chain as usize] += 1);
        LiveMesh { stars, alive: vec![true; mesh.quads.len()], count: mesh.quads.len(), boundary_edges, mesh }
    }

    /// The living quads at `v`, ascending.
    pub fn star(&self, v: u32) -> &[u32] {
        &self.stars[v as usize]
    }

    pub fn valence(&self, v: u32) -> usize {
        self.stars[v as usize].len()
    }

    /// The living quads, ascending.
    pub fn quads(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.alive.len() as u32).filter(|q| self.alive[*q as usize])
    }

    /// Whether edge `e` is still there.
    pub fn has_edge(&self, e: u32) -> bool {
        let q = self.mesh.edges[e as usize].quads[0];
        self.alive[q as usize] && self.mesh.quad_edges[q as usize].contains(&e)
    }

    /// The quads at the vertices `seeds` and `rings` rings of quads around them, ascending.
    pub fn rings(&self, seeds: &[u32], rings: usize) -> Vec<u32> {
        let found = rings_around(seeds, rings, |v| self.star(v), |q| self.mesh.quads[q as usize]);
        found.into_iter().map(|(q, _)| q).collect()
    }

    /// Puts `patch` in the place of what it was made from.
    pub fn splice(&mut self, patch: &Patch, removal: Removal) {
        for q in &removal.quads {
            self.alive[*q as usize] = false;
        }
        self.count -= removal.quads.len();
        removal.chains.iter().for_each(|c| self.boundary_edges[*c as usize] -= 1);
        for (v, star) in removal.stars {
            self.stars[v as usize] = star;
        }
        for (local, global) in patch.vertices.iter().enumerate() {
            self.mesh.vertices[*global as usize] = patch.mesh.vertices[local];
        }
        for (local, global) in patch.quads.iter().enumerate() {
            self.mesh.quads[*global as usize] = patch.mesh.quads[local].map(|v| patch.vertices[v as usize]);
            self.mesh.quad_edges[*global as usize] =
                patch.mesh.quad_edges[local].map(|e| patch.edges[e as usize]);
        }
        // Beyond the rim of the patch an edge has a neighbour that the patch does not know.
        for (local, global) in patch.edges.iter().enumerate().filter(|(e, _)| !patch.rim[*e]) {
            let mut edge = patch.mesh.edges[local].clone();
            edge.vertices = edge.vertices.map(|v| patch.vertices[v as usize]);
            edge.quads = edge.quads.map(|q| if q == NONE { NONE } else { patch.quads[q as usize] });
            self.mesh.edges[*global as usize] = edge;
        }
    }

    /// The living mesh alone, numbered in the old order.
    pub fn compact(self) -> QuadMesh {
        self.renumbered().0
    }

    /// The same with the new numbers.
    pub fn renumbered(self) -> (QuadMesh, Numbering) {
        let LiveMesh { mesh, stars, alive, .. } = self;
        let number = |keep: &[bool]| {
            let mut number = vec![NONE; keep.len()];
            for (n, i) in (0..keep.len()).filter(|i| keep[*i]).enumerate() {
                number[i] = n as u32;
            }
            number
        };
        let mut edge_kept = vec![false; mesh.edges.len()];
        for (edges, _) in mesh.quad_edges.iter().zip(&alive).filter(|(_, alive)| **alive) {
            edges.iter().for_each(|e| edge_kept[*e as usize] = true);
        }
        let vertex_kept: Vec<bool> = stars.iter().map(|s| !s.is_empty()).collect();
        let (vertex, edge, quad) = (number(&vertex_kept), number(&edge_kept), number(&alive));
        let quad_or_none = |q: u32| if q == NONE { NONE } else { quad[q as usize] };
        let mut edges = kept(mesh.edges, &edge_kept);
        for e in &mut edges {
            e.vertices = e.vertices.map(|v| vertex[v as usize]);
            e.quads = e.quads.map(quad_or_none);
        }
        let quads = kept(mesh.quads, &alive).into_iter().map(|q| q.map(|v| vertex[v as usize])).collect();
        let quad_edges =
            kept(mesh.quad_edges, &alive).into_iter().map(|q| q.map(|e| edge[e as usize])).collect();
        let mesh = QuadMesh {
            vertices: kept(mesh.vertices, &vertex_kept),
            quads,
            region: kept(mesh.region, &alive),
            edges,
            quad_edges,
        };
        (mesh, Numbering { vertices: vertex, edges: edge })
    }
}

/// The entries of `list` that are kept.
fn kept<T>(list: Vec<T>, keep: &[bool]) -> Vec<T> {
    list.into_iter().zip(keep).filter(|(_, keep)| **keep).map(|(x, _)| x).collect()
}

/// The quads at the vertices `seeds` and `rings` rings around them, each with its ring, ascending;
/// `star` gives the quads at a vertex, `corners` the vertices of a quad.
pub(super) fn rings_around<'a>(
    seeds: &[u32],
    rings: usize,
    star: impl Fn(u32) -> &'a [u32],
    corners: impl Fn(u32) -> [u32; 4],
) -> Vec<(u32, usize)> {
    // Sorted lists: most neighbourhoods are some dozens of quads.
    let (mut seen, mut done): (Vec<u32>, Vec<u32>) = (Vec::new(), Vec::new());
    let mut front = seeds.to_vec();
    let mut list = Vec::new();
    for ring in 0..=rings {
        let own = new_among(front, &mut done);
        let quads = new_among(own.into_iter().flat_map(&star).copied().collect(), &mut seen);
        front = quads.iter().flat_map(|q| corners(*q)).collect();
        list.extend(quads.into_iter().map(|q| (q, ring)));
    }
    list.sort_unstable();
    list
}

/// Those of `found` that are not `known`, ascending; they become so.
fn new_among(mut found: Vec<u32>, known: &mut Vec<u32>) -> Vec<u32> {
    found.sort_unstable();
    found.dedup();
    found.retain(|x| known.binary_search(x).is_err());
    known.extend(&found);
    known.sort_unstable();
    found
}
