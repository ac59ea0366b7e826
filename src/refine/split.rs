//! Splitting edges at the middle, carried through the mesh along their chords.

use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::mesh::{bubble_shape, part_of_bubbles, reversed_bubbles, QuadMesh, Vertex};
use crate::numerics::{Point, Vector, NONE};
use std::collections::HashMap;

/// Splits the edges in `marked` (one entry an edge) at the middle, and every edge of their chords: so
/// the mesh stays conforming. A quad that chords cross one way becomes two, both ways four. New edges
/// follow the transfinite map of the quad they cut, halves of edges keep their shape; `order` is the
/// number of degrees a boundary edge's shape is carried inside with.
///
/// # Errors
/// A defect in words and where, as [`QuadMesh::new`].
pub fn split_chords(
    mesh: &QuadMesh,
    boundary: &Boundary,
    marked: &[bool],
    order: usize,
) -> Result<QuadMesh, (String, Point)> {
    let split = whole_chords(mesh, marked);
    let count = order.saturating_sub(1);
    let mut vertices = mesh.vertices.clone();
    let mut shapes: HashMap<[u32; 2], Vec<Vector>> = HashMap::new();
    // The vertex at the middle of each split edge.
    let mut middle = vec![NONE; mesh.edges.len()];
    for (e, edge) in mesh.edges.iter().enumerate() {
        if !split[e] {
            shapes.insert(edge.vertices, edge.bubbles.clone());
            continue;
        }
        let place = match edge.span {
            Some(span) => {
                let s = boundary.chains[span.chain as usize].wrap(0.5 * (span.start + span.end));
                Place::Boundary(BoundaryPoint { chain: span.chain, s })
            }
            None => Place::Interior,
        };
        middle[e] = vertices.len() as u32;
        vertices.push(Vertex { point: mesh.edge_middle(boundary, e), place });
        let [a, b] = edge.vertices;
        shapes.insert([a, middle[e]], part_of_bubbles(&edge.bubbles, -1.0, 0.0));
        shapes.insert([middle[e], b], part_of_bubbles(&edge.bubbles, 0.0, 1.0));
    }
    let mut quads = Vec::with_capacity(mesh.quads.len() + split.len());
    let mut region = Vec::with_capacity(quads.capacity());
    for (q, (quad, edges)) in mesh.quads.iter().zip(&mesh.quad_edges).enumerate() {
        let ways = [split[edges[0] as usize], split[edges[1] as usize]];
        // The shape of side s walked from its corner `from_corner`.
        let side = |s: usize, from_corner: usize| {
            let e = edges[s] as usize;
            let shape = mesh.shape(boundary, e, count);
            if mesh.edges[e].vertices[0] == quad[from_corner] {
                shape
            } else {
                reversed_bubbles(&shape)
            }
        };
        // From the middle of side s to that of side s + 2: the mean of the sides beside it.
        let across = |s: usize| mean(&side((s + 1) % 4, (s + 1) % 4), &side((s + 3) % 4, s));
        let middles = edges.map(|e| middle[e as usize]);
        match ways {
            [false, false] => quads.push(*quad),
            [true, true] => {
                let lines = [across(0), across(1)];
                let [m0, m1, m2, m3] = middles;
                let [p, r] = [m0, m2].map(|m| vertices[m as usize].point);
                let center = vertices.len() as u32;
                let point = nalgebra::center(&p, &r) + bubble_shape(&lines[0], 0.0);
                vertices.push(Vertex { point, place: Place::Interior });
                for (line, ends) in lines.iter().zip([[m0, m2], [m1, m3]]) {
                    shapes.insert([ends[0], center], part_of_bubbles(line, -1.0, 0.0));
                    shapes.insert([center, ends[1]], part_of_bubbles(line, 0.0, 1.0));
                }
                let [a, b, c, d] = *quad;
                quads.extend([
                    [a, m0, center, m3],
                    [m0, b, m1, center],
                    [center, m1, c, m2],
                    [m3, center, m2, d],
                ]);
            }
            [first, _] => {
                let s = if first { 0 } else { 1 };
                let [a, b, c, d] = [0, 1, 2, 3].map(|k| quad[(s + k) % 4]);
                let (from, to) = (middles[s], middles[s + 2]);
                shapes.insert([from, to], across(s));
                quads.extend([[a, from, to, d], [from, b, c, to]]);
            }
        }
        region.resize(quads.len(), mesh.region[q]);
    }
    QuadMesh::new(boundary, vertices, quads, region, &shapes)
}

/// Half the sum of two shapes of any number of bubbles.
fn mean(a: &[Vector], b: &[Vector]) -> Vec<Vector> {
    let get = |list: &[Vector], m: usize| list.get(m).copied().unwrap_or_else(Vector::zeros);
    (0..a.len().max(b.len())).map(|m| (get(a, m) + get(b, m)) * 0.5).collect()
}

/// Marks all edges of the chords of the marked edges.
fn whole_chords(mesh: &QuadMesh, marked: &[bool]) -> Vec<bool> {
    let mut split = vec![false; mesh.edges.len()];
    let mut stack: Vec<u32> =
        (0..mesh.edges.len()).filter(|e| marked.get(*e) == Some(&true)).map(|e| e as u32).collect();
    stack.iter().for_each(|e| split[*e as usize] = true);
    while let Some(e) = stack.pop() {
        for q in mesh.edges[e as usize].quads.into_iter().filter(|q| *q != NONE) {
            let sides = &mesh.quad_edges[q as usize];
            let opposite = (0..4).find(|s| sides[*s] == e).map(|s| sides[(s + 2) % 4]);
            if let Some(o) = opposite.filter(|o| !split[*o as usize]) {
                split[o as usize] = true;
                stack.push(o);
            }
        }
    }
    split
}
