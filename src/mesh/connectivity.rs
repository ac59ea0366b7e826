//! Who is whose neighbour in the finished mesh, and its nodes numbered without duplicates.

use super::HighOrderMesh;
use crate::numerics::{Point, NONE};

impl HighOrderMesh {
    /// For each element the one across each of its sides; `NONE` at the boundary.
    pub fn element_neighbors(&self) -> Vec<[u32; 4]> {
        let across = |e: usize, edge: u32| {
            let [left, right] = self.edges[edge as usize].elements;
            if left as usize == e {
                right
            } else {
                left
            }
        };
        self.element_edges.iter().enumerate().map(|(e, sides)| sides.map(|edge| across(e, edge))).collect()
    }

    /// For each edge its side in the element to its left and in the one to its right; `NONE` outside.
    pub fn edge_sides(&self) -> Vec<[u32; 2]> {
        let mut sides = vec![[NONE; 2]; self.edges.len()];
        for (e, own) in self.element_edges.iter().enumerate() {
            for (side, &edge) in (0..).zip(own) {
                let right = self.edges[edge as usize].elements[0] as usize != e;
                sides[edge as usize][usize::from(right)] = side;
            }
        }
        sides
    }

    /// Number of different nodes: at vertices, inside edges and inside elements.
    pub fn node_count(&self) -> usize {
        let inside = self.order - 1;
        self.vertices.len() + self.edges.len() * inside + self.elements.len() * inside * inside
    }

    /// The number of each element's nodes, `[element][j][i]`: vertices first, then N − 1 of each edge from
    /// its first vertex to its second, then (N − 1)² of each element, i fastest.
    pub fn node_numbers(&self) -> Vec<u32> {
        let n = self.order;
        let (row, inside) = (n + 1, n - 1);
        let at_edges = self.vertices.len();
        let at_insides = at_edges + self.edges.len() * inside;
        let mut numbers = vec![0; self.elements.len() * row * row];
        for (e, own) in numbers.chunks_exact_mut(row * row).enumerate() {
            let corners = self.elements[e];
            for (c, (i, j)) in [(0, 0), (n, 0), (n, n), (0, n)].into_iter().enumerate() {
                own[j * row + i] = corners[c];
            }
            for side in 0..4 {
                let edge = self.element_edges[e][side] as usize;
                let forward = self.edges[edge].vertices[0] == corners[side];
                for k in 1..n {
                    // The k-th node of the edge is the `along`-th when walking round the element.
                    let along = if forward { k } else { n - k };
                    let (i, j) = [(along, 0), (n, along), (n - along, n), (0, n - along)][side];
                    own[j * row + i] = (at_edges + edge * inside + k - 1) as u32;
                }
            }
            for j in 1..n {
                for i in 1..n {
                    own[j * row + i] = (at_insides + (e * inside + j - 1) * inside + i - 1) as u32;
                }
            }
        }
        numbers
    }

    /// The points of the nodes so numbered.
    pub fn shared_nodes(&self) -> Vec<Point> {
        let mut points = vec![Point::origin(); self.node_count()];
        for (number, point) in self.node_numbers().into_iter().zip(&self.nodes) {
            points[number as usize] = *point;
        }
        points
    }

    /// The largest error of each element's boundary edges, in the chosen norm; 0 for elements inside.
    pub fn element_boundary_errors(&self) -> Vec<f64> {
        let worst =
            |sides: &[u32; 4]| sides.iter().map(|e| self.edges[*e as usize].error).fold(0.0, f64::max);
        self.element_edges.iter().map(worst).collect()
    }
}
