//! The mesh that refinement and smoothing change.

use super::reversed_bubbles;
use crate::domain::{Boundary, Place, Span};
use crate::numerics::{Point, Vector, NONE};
use std::collections::HashMap;

/// A vertex: its point, and where it may lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    pub point: Point,
    pub place: Place,
}

/// An edge; no two edges join the same two vertices.
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// On the boundary in the loop's direction.
    pub vertices: [u32; 2],
    /// The quads to its left and right; `NONE` outside. Boundary edges have a left quad only.
    pub quads: [u32; 2],
    /// The piece of boundary that a boundary edge follows.
    pub span: Option<Span>,
    /// Shape of an interior edge: coefficients of the bubbles 4 τ (1 − τ) P_m(2τ − 1), m = 0, 1, …,
    /// added to the straight edge from the first vertex to the second, τ in [0, 1]. Empty: straight.
    pub bubbles: Vec<Vector>,
}

/// A conforming all-quad mesh with curved edges, in the canonical frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct QuadMesh {
    pub vertices: Vec<Vertex>,
    /// Counter-clockwise corners.
    pub quads: Vec<[u32; 4]>,
    /// The layout region each quad comes from.
    pub region: Vec<u32>,
    pub edges: Vec<Edge>,
    /// `quad_edges[q][i]` joins corner i to corner i + 1.
    pub quad_edges: Vec<[u32; 4]>,
}

impl QuadMesh {
    /// The quads at each vertex, ascending.
    pub fn quads_around(&self) -> Vec<Vec<u32>> {
        let mut around = vec![Vec::new(); self.vertices.len()];
        for (q, quad) in (0u32..).zip(&self.quads) {
            quad.iter().for_each(|v| around[*v as usize].push(q));
        }
        around
    }

    /// Builds edges and adjacency. `shapes` gives the bubbles of interior edges by their vertices
    /// (first → second); edges it does not know are straight. `Err` tells the defect in words and where.
    pub fn new(
        boundary: &Boundary,
        vertices: Vec<Vertex>,
        quads: Vec<[u32; 4]>,
        region: Vec<u32>,
        shapes: &HashMap<[u32; 2], Vec<Vector>>,
    ) -> Result<QuadMesh, (String, Point)> {
        if quads.iter().flatten().any(|v| *v as usize >= vertices.len()) {
            return Err(("a quad has a vertex that does not exist".into(), Point::origin()));
        }
        let mut edges: Vec<Edge> = Vec::with_capacity(2 * quads.len() + 8);
        let mut known: HashMap<[u32; 2], u32> = HashMap::with_capacity(2 * quads.len() + 8);
        let mut quad_edges = Vec::with_capacity(quads.len());
        for (q, quad) in quads.iter().enumerate() {
            let mut own = [NONE; 4];
            for i in 0..4 {
                let (a, b) = (quad[i], quad[(i + 1) % 4]);
                let at = vertices[a as usize].point;
                if a == b {
                    return Err((format!("quad {q} has an edge without extent"), at));
                }
                own[i] = match known.get(&[a.min(b), a.max(b)]) {
                    Some(&e) => {
                        let edge = &mut edges[e as usize];
                        let right = edge.vertices == [b, a];
                        if !right || edge.quads[1] != NONE {
                            return Err((
                                format!("quad {q}: an edge has three quads or two of opposite orientation"),
                                at,
                            ));
                        }
                        edge.quads[1] = q as u32;
                        e
                    }
                    None => {
                        let e = edges.len() as u32;
                        known.insert([a.min(b), a.max(b)], e);
                        let bubbles = match (shapes.get(&[a, b]), shapes.get(&[b, a])) {
                            (Some(c), _) => c.clone(),
                            (None, Some(c)) => reversed_bubbles(c),
                            _ => Vec::new(),
                        };
                        edges.push(Edge { vertices: [a, b], quads: [q as u32, NONE], span: None, bubbles });
                        e
                    }
                };
            }
            quad_edges.push(own);
        }
        for edge in edges.iter_mut().filter(|e| e.quads[1] == NONE) {
            let [a, b] = edge.vertices.map(|v| &vertices[v as usize]);
            edge.span = boundary.span(a.place, b.place);
            edge.bubbles.clear();
            if edge.span.is_none() {
                return Err(("a border edge does not follow one boundary chain".into(), a.point));
            }
        }
        Ok(QuadMesh { vertices, quads, region, edges, quad_edges })
    }
}
