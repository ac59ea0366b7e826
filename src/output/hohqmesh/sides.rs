//! Elements' sides as HOHQMesh's files have them.

use super::super::labels;
use crate::mesh::HighOrderMesh;
use crate::numerics::interpolation::{chebyshev_lobatto, Interpolation};
use crate::numerics::tolerances::STRAIGHT_SIDE;
use crate::numerics::{Point, Vector, NONE};
use std::fmt::Write;

/// What stands for the name of a side inside the domain.
const INSIDE: &str = "---";

/// The mesh's edges at Chebyshev-Lobatto points, and its boundaries' names.
pub struct Sides<'a> {
    mesh: &'a HighOrderMesh,
    /// For each edge, from its first vertex to its second; `None`: straight.
    curves: Vec<Option<Vec<Point>>>,
    names: Vec<String>,
}

/// First and last corner of a side, counted from 0 in the element.
pub fn side_corners(side: usize) -> [usize; 2] {
    [[0, 1], [1, 2], [3, 2], [0, 3]][side]
}

impl<'a> Sides<'a> {
    /// Interpolates the edges of `mesh`.
    pub fn new(mesh: &'a HighOrderMesh) -> Self {
        let n = mesh.order;
        let interpolation = Interpolation::new(mesh.reference_nodes.clone());
        let targets = chebyshev_lobatto(n);
        let mut curves = vec![None; mesh.edges.len()];
        for (e, sides) in mesh.element_edges.iter().enumerate() {
            for (s, &edge) in sides.iter().enumerate() {
                // The element to the left walks the edge from its first vertex to its second.
                if mesh.edges[edge as usize].elements[0] == e as u32 {
                    let nodes: Vec<Point> = (0..=n).map(|k| mesh.side_node(e, s, k)).collect();
                    if !straight(&mesh.reference_nodes, &nodes) {
                        let points = targets.iter().map(|x| interpolation.point(&nodes, *x)).collect();
                        curves[edge as usize] = Some(points);
                    }
                }
            }
        }
        Sides { mesh, curves, names: labels::words(&mesh.boundary_names) }
    }

    /// Writes the flags of element `e`'s sides and the curves of those that are not straight, each line after
    /// `prefix`.
    pub fn write(&self, text: &mut String, e: usize, prefix: &str) {
        let curves = self.mesh.element_edges[e].map(|edge| self.curves[edge as usize].as_ref());
        let [a, b, c, d] = curves.map(|c| u8::from(c.is_some()));
        let _ = writeln!(text, "{prefix}{a} {b} {c} {d}");
        for (s, curve) in curves.into_iter().enumerate() {
            let edge = self.mesh.edges[self.mesh.element_edges[e][s] as usize];
            let forward = edge.vertices[0] == self.mesh.elements[e][side_corners(s)[0]];
            for k in 0..curve.map_or(0, Vec::len) {
                let points = curve.map_or(&[][..], Vec::as_slice);
                let p = points[if forward { k } else { points.len() - 1 - k }];
                let _ = writeln!(text, "{prefix}{:?} {:?} 0.0", p.x, p.y);
            }
        }
    }

    /// The boundary's name of a side of element `e`.
    pub fn name(&self, e: usize, side: usize) -> &str {
        let edge = self.mesh.edges[self.mesh.element_edges[e][side] as usize];
        match edge.elements[1] {
            NONE => self.names.get(edge.boundary as usize).map_or("boundary", String::as_str),
            _ => INSIDE,
        }
    }
}

/// Whether the nodes lie where the straight line between the first and the last has them.
fn straight(reference: &[f64], nodes: &[Point]) -> bool {
    let (a, b) = (nodes[0], nodes[nodes.len() - 1]);
    let extent = [a, b].iter().flat_map(|p| [p.x.abs(), p.y.abs()]).fold(0.0, f64::max);
    let off = |(x, p): (&f64, &Point)| -> Vector { p - (a + (b - a) * (0.5 * (1.0 + x))) };
    reference.iter().zip(nodes).all(|place| off(place).norm() <= STRAIGHT_SIDE * extent)
}
