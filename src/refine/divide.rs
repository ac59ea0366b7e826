//! Chords divided into any number of equal parts, every part the exact restriction of its element's map.

use super::chords::chord_through;
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::error::{Error, Result};
use crate::mesh::{bubble_shape, part_of_bubbles, reversed_bubbles, QuadMesh, Vertex};
use crate::numerics::{Point, Vector};
use std::collections::HashMap;

/// Divides every edge into as many parts as `wanted` (one entry an edge, 0 counts as 1) asks for anywhere on its
/// chord, boundary edges in arc length. Elements become grids that follow their Coons maps, so repeated division
/// leaves maps that are smooth in themselves: errors of a solution fall as the order promises. `order` as for
/// [`split_chords`](super::split_chords).
///
/// # Errors
/// [`Error::Layout`] when the mesh is defective.
pub fn divide_chords(mesh: &QuadMesh, boundary: &Boundary, wanted: &[u32], order: usize) -> Result<QuadMesh> {
    let mut division = Division {
        mesh,
        boundary,
        parts: chord_parts(mesh, wanted),
        count: order.saturating_sub(1),
        vertices: mesh.vertices.clone(),
        between: Vec::with_capacity(mesh.edges.len()),
        shapes: HashMap::new(),
    };
    for e in 0..mesh.edges.len() {
        division.divide_edge(e);
    }
    let (mut quads, mut region) = (Vec::new(), Vec::new());
    for q in 0..mesh.quads.len() {
        division.divide_quad(q, &mut quads);
        region.resize(quads.len(), mesh.region[q]);
    }
    QuadMesh::new(boundary, division.vertices, quads, region, &division.shapes)
        .map_err(|(reason, at)| Error::Layout { reason, at: Some(at) })
}

/// Parts of each edge: the most that any edge of its chord wants.
pub(super) fn chord_parts(mesh: &QuadMesh, wanted: &[u32]) -> Vec<u32> {
    let mut parts = vec![0; mesh.edges.len()];
    for e in 0..mesh.edges.len() as u32 {
        if parts[e as usize] == 0 {
            let rungs = chord_through(mesh, e).rungs;
            let most = rungs.iter().filter_map(|r| wanted.get(*r as usize)).copied().max().unwrap_or(1);
            rungs.iter().for_each(|r| parts[*r as usize] = most.max(1));
        }
    }
    parts
}

/// Quads of `mesh` divided into so many parts.
pub(super) fn divided_quads(mesh: &QuadMesh, parts: &[u32]) -> f64 {
    let own = |edges: &[u32; 4]| f64::from(parts[edges[0] as usize]) * f64::from(parts[edges[1] as usize]);
    mesh.quad_edges.iter().map(own).sum()
}

struct Division<'a> {
    mesh: &'a QuadMesh,
    boundary: &'a Boundary,
    parts: Vec<u32>,
    /// Degrees with which a boundary edge's shape is carried inside.
    count: usize,
    vertices: Vec<Vertex>,
    /// The vertices along each edge, ends included.
    between: Vec<Vec<u32>>,
    shapes: HashMap<[u32; 2], Vec<Vector>>,
}

/// Share k / n as a position in [-1, 1].
fn position(k: usize, n: usize) -> f64 {
    2.0 * k as f64 / n as f64 - 1.0
}

impl Division<'_> {
    fn divide_edge(&mut self, e: usize) {
        let edge = &self.mesh.edges[e];
        let n = self.parts[e] as usize;
        let [a, b] = edge.vertices.map(|v| self.mesh.vertices[v as usize].point);
        let mut line = vec![edge.vertices[0]];
        for k in 1..n {
            let share = k as f64 / n as f64;
            let vertex = match edge.span {
                Some(span) => {
                    let chain = &self.boundary.chains[span.chain as usize];
                    let s = chain.wrap(span.start + share * (span.end - span.start));
                    let place = Place::Boundary(BoundaryPoint { chain: span.chain, s });
                    Vertex { point: chain.point(s), place }
                }
                None => {
                    let point = a + (b - a) * share + bubble_shape(&edge.bubbles, position(k, n));
                    Vertex { point, place: Place::Interior }
                }
            };
            line.push(self.add(vertex));
        }
        line.push(edge.vertices[1]);
        if edge.span.is_none() {
            self.add_shapes(&line, &edge.bubbles);
        }
        self.between.push(line);
    }

    fn add(&mut self, vertex: Vertex) -> u32 {
        self.vertices.push(vertex);
        self.vertices.len() as u32 - 1
    }

    /// Notes the shapes of the parts of a line of vertices with these bubbles.
    fn add_shapes(&mut self, line: &[u32], bubbles: &[Vector]) {
        let n = line.len() - 1;
        for k in 0..n {
            let part = if n == 1 {
                bubbles.to_vec()
            } else {
                part_of_bubbles(bubbles, position(k, n), position(k + 1, n))
            };
            self.shapes.insert([line[k], line[k + 1]], part);
        }
    }

    /// The vertices and the shape of side `s` of `quad`, from its corner `from`.
    fn side(&self, quad: usize, s: usize, from: usize) -> (Vec<u32>, Vec<Vector>) {
        let e = self.mesh.quad_edges[quad][s] as usize;
        let (mut line, shape) = (self.between[e].clone(), self.mesh.shape(self.boundary, e, self.count));
        if line[0] == self.mesh.quads[quad][from] {
            return (line, shape);
        }
        line.reverse();
        (line, reversed_bubbles(&shape))
    }

    fn divide_quad(&mut self, quad: usize, quads: &mut Vec<[u32; 4]>) {
        // Low and high are along u, left and right along v.
        let [(low, low_shape), (high, high_shape)] = [self.side(quad, 0, 0), self.side(quad, 2, 3)];
        let [(left, left_shape), (right, right_shape)] = [self.side(quad, 3, 0), self.side(quad, 1, 1)];
        let (nu, nv) = (low.len() - 1, left.len() - 1);
        let mut columns = vec![left.clone()];
        for i in 1..nu {
            let shape = blend(&left_shape, &right_shape, i as f64 / nu as f64);
            let [a, b] = [low[i], high[i]].map(|v| self.vertices[v as usize].point);
            let mut column = vec![low[i]];
            for j in 1..nv {
                let point: Point =
                    a + (b - a) * (j as f64 / nv as f64) + bubble_shape(&shape, position(j, nv));
                column.push(self.add(Vertex { point, place: Place::Interior }));
            }
            column.push(high[i]);
            self.add_shapes(&column, &shape);
            columns.push(column);
        }
        columns.push(right);
        for j in 1..nv {
            let row: Vec<u32> = columns.iter().map(|column| column[j]).collect();
            self.add_shapes(&row, &blend(&low_shape, &high_shape, j as f64 / nv as f64));
        }
        for j in 0..nv {
            for pair in columns.windows(2) {
                quads.push([pair[0][j], pair[1][j], pair[1][j + 1], pair[0][j + 1]]);
            }
        }
    }
}

/// The shape at `share` between two, of any numbers of bubbles.
fn blend(a: &[Vector], b: &[Vector], share: f64) -> Vec<Vector> {
    let get = |list: &[Vector], m: usize| list.get(m).copied().unwrap_or_else(Vector::zeros);
    (0..a.len().max(b.len())).map(|m| get(a, m) * (1.0 - share) + get(b, m) * share).collect()
}
