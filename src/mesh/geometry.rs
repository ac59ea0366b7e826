//! Nodes of a [`QuadMesh`]'s edges and elements at the Gauss-Lobatto points.
//!
//! Boundary edges interpolate their chain in arc length, interior edges are straight plus bubbles, and
//! the inside of an element is the Coons map of its four edges.

use super::{Edge, QuadMesh};
use crate::domain::Boundary;
use crate::numerics::{coons_map, legendre, GaussLobatto, Point, Vector};

/// Tables for meshes of one order; build once.
#[derive(Debug, Clone, PartialEq)]
pub struct Geometry {
    /// Gauss-Lobatto nodes in [-1, 1], N + 1 of them.
    pub reference: Vec<f64>,
    /// `bubbles[m][i]` = 4 τ (1 − τ) P_m(2τ − 1) at node i.
    bubbles: Vec<Vec<f64>>,
}

impl Geometry {
    /// Tables for order `order` (1 to 32).
    pub fn new(order: usize) -> Self {
        let reference = GaussLobatto::new(order).nodes;
        // More bubbles than the order can represent are interpolated like any other curve.
        let bubbles = (0..reference.len())
            .map(|m| reference.iter().map(|x| (1.0 - x * x) * legendre(m, *x).0).collect())
            .collect();
        Geometry { reference, bubbles }
    }

    /// Nodes an edge has: N + 1.
    pub fn edge_len(&self) -> usize {
        self.reference.len()
    }

    /// Nodes of edge `e` from its first vertex to its second, into `out` (N + 1 points). The ends are
    /// exactly the vertices.
    pub fn edge_nodes(&self, mesh: &QuadMesh, boundary: &Boundary, e: usize, out: &mut [Point]) {
        let edge = &mesh.edges[e];
        let n = self.reference.len() - 1;
        let [a, b] = edge.vertices.map(|v| mesh.vertices[v as usize].point);
        (out[0], out[n]) = (a, b);
        if let Some(span) = edge.span {
            let chain = &boundary.chains[span.chain as usize];
            for (node, xi) in out.iter_mut().zip(&self.reference).take(n).skip(1) {
                *node = chain.point(span.start + 0.5 * (1.0 + xi) * (span.end - span.start));
            }
            return;
        }
        for (i, (node, xi)) in out.iter_mut().zip(&self.reference).enumerate().take(n).skip(1) {
            *node = a + (b - a) * (0.5 * (1.0 + xi)) + self.bubble_offset(edge, i);
        }
    }

    /// What the bubbles of `edge` add at node `i` to the straight edge.
    pub fn bubble_offset(&self, edge: &Edge, i: usize) -> Vector {
        edge.bubbles.iter().zip(&self.bubbles).map(|(c, bubble)| c * bubble[i]).sum()
    }

    /// Nodes of all edges, N + 1 each, in the order of the mesh's edges.
    pub fn all_edge_nodes(&self, mesh: &QuadMesh, boundary: &Boundary) -> Vec<Point> {
        let len = self.edge_len();
        let mut nodes = vec![Point::origin(); len * mesh.edges.len()];
        for (e, out) in nodes.chunks_exact_mut(len).enumerate() {
            self.edge_nodes(mesh, boundary, e, out);
        }
        nodes
    }

    /// Nodes `[j][i]` of quad `q` from the nodes of all edges; replaces `out`. Both elements of an edge
    /// get the same bits on it.
    pub fn element_nodes(&self, mesh: &QuadMesh, edge_nodes: &[Point], q: usize, out: &mut Vec<Point>) {
        let len = self.edge_len();
        let mut reversed: [Vec<Point>; 4] = Default::default();
        let quad = &mesh.quads[q];
        for s in 0..4 {
            let e = mesh.quad_edges[q][s] as usize;
            if mesh.edges[e].vertices[0] != quad[s] {
                reversed[s].extend(edge_nodes[e * len..(e + 1) * len].iter().rev());
            }
        }
        let sides = [0, 1, 2, 3].map(|s| {
            let e = mesh.quad_edges[q][s] as usize;
            if reversed[s].is_empty() {
                &edge_nodes[e * len..(e + 1) * len]
            } else {
                reversed[s].as_slice()
            }
        });
        coons_map(&self.reference, sides, out);
    }
}
