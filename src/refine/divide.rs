//! Subdivision of edges, carried along their chords through the whole mesh.

use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::error::{Error, Result};
use crate::mesh::{QuadMesh, Vertex};
use crate::numerics::{Point, NONE};
use std::collections::HashMap;

/// Halves the edges `marked` and with each the whole chord of quads across it, so that the mesh stays
/// conforming. Halved interior edges become straight.
pub fn divide_chords(mesh: &QuadMesh, boundary: &Boundary, marked: &[u32]) -> Result<QuadMesh> {
    let mut divided = vec![false; mesh.edges.len()];
    let mut stack = marked.to_vec();
    while let Some(e) = stack.pop() {
        if std::mem::replace(&mut divided[e as usize], true) {
            continue;
        }
        for &q in mesh.edges[e as usize].quads.iter().filter(|&&q| q != NONE) {
            let own = &mesh.quad_edges[q as usize];
            if let Some(i) = own.iter().position(|&x| x == e) {
                stack.push(own[(i + 2) % 4]);
            }
        }
    }

    let mut vertices = mesh.vertices.clone();
    let middle: Vec<u32> = mesh
        .edges
        .iter()
        .zip(&divided)
        .map(|(edge, &divide)| {
            if !divide {
                return NONE;
            }
            let [a, b] = edge.vertices.map(|v| mesh.vertices[v as usize].point);
            let vertex = match edge.span {
                Some(span) => {
                    let chain = &boundary.chains[span.chain as usize];
                    let s = chain.wrap(0.5 * (span.start + span.end));
                    let place = Place::Boundary(BoundaryPoint { chain: span.chain, s });
                    Vertex { point: chain.point(s), place }
                }
                // At the middle the bubbles of even degree alone count: P_0 = 1, P_2 = -1/2, P_4 = 3/8.
                None => {
                    let bulge = edge.bubbles.iter().step_by(2).zip([1.0, -0.5, 0.375]);
                    let middle = nalgebra::center(&a, &b);
                    Vertex { point: bulge.fold(middle, |p, (c, w)| p + c * w), place: Place::Interior }
                }
            };
            vertices.push(vertex);
            vertices.len() as u32 - 1
        })
        .collect();

    let mut quads = Vec::with_capacity(mesh.quads.len() * 2);
    let mut region = Vec::with_capacity(mesh.quads.len() * 2);
    for (q, quad) in mesh.quads.iter().enumerate() {
        let [a, b, c, d] = *quad;
        let m = mesh.quad_edges[q].map(|e| middle[e as usize]);
        let parts: Vec<[u32; 4]> = match (m[0] != NONE, m[1] != NONE) {
            (false, false) => vec![*quad],
            (true, false) => vec![[a, m[0], m[2], d], [m[0], b, c, m[2]]],
            (false, true) => vec![[a, b, m[1], m[3]], [m[3], m[1], c, d]],
            (true, true) => {
                let sum =
                    m.iter().fold(nalgebra::Vector2::zeros(), |s, &v| s + vertices[v as usize].point.coords);
                vertices.push(Vertex { point: Point::from(sum * 0.25), place: Place::Interior });
                let o = vertices.len() as u32 - 1;
                vec![[a, m[0], o, m[3]], [m[0], b, m[1], o], [o, m[1], c, m[2]], [m[3], o, m[2], d]]
            }
        };
        region.extend(std::iter::repeat_n(mesh.region[q], parts.len()));
        quads.extend(parts);
    }
    let kept = mesh.edges.iter().zip(&divided).filter(|(e, &d)| !d && !e.bubbles.is_empty());
    let shapes: HashMap<_, _> = kept.map(|(e, _)| (e.vertices, e.bubbles.clone())).collect();
    QuadMesh::new(boundary, vertices, quads, region, &shapes)
        .map_err(|(reason, at)| Error::Layout { reason, at: Some(at) })
}
