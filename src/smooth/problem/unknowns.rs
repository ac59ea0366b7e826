//! Which vertices and edges move, and the numbering of their unknowns.

use super::{Freedom, LocalEdge, LocalElement, LocalVertex, Problem, Shape, EVENNESS};
use crate::domain::{Boundary, BoundaryPoint, Place, Span};
use crate::mesh::{BoundaryError, QuadMesh};
use crate::numerics::tolerances::DECISION_GRID;
use crate::numerics::{Vector, NONE};
use crate::smooth::kernel::{Measure, Target};
use crate::smooth::reference::Reference;
use crate::smooth::straightness::Straightness;

impl<'a> Problem<'a> {
    /// Quads `active` (all if `None`) of `mesh`: what has a neighbour outside stays fixed; so do
    /// boundary vertices unless `slide`.
    pub fn new(
        boundary: &'a Boundary,
        reference: &'a Reference,
        tolerance: Option<&'a BoundaryError>,
        mesh: &QuadMesh,
        active: Option<&[u32]>,
        slide: bool,
        straightness: &Straightness,
    ) -> Self {
        let all: Vec<u32>;
        let active = match active {
            Some(list) => list,
            None => {
                all = (0..mesh.quads.len() as u32).collect();
                &all
            }
        };
        let mut inside = vec![false; mesh.quads.len()];
        active.iter().for_each(|q| inside[*q as usize] = true);
        // Without a tolerance to be kept, elements of order 1 have boundary edges like all others.
        let chords = reference.order == 1 && tolerance.is_none();
        let is_inside = |q: u32| q == NONE || inside[q as usize];
        let mut vertex_of = vec![NONE; mesh.vertices.len()];
        let mut edge_of = vec![NONE; mesh.edges.len()];
        let (mut vertices, mut edges) = (Vec::new(), Vec::new());
        let mut pinned = Vec::new();
        for q in active {
            for e in mesh.quad_edges[*q as usize] {
                if edge_of[e as usize] != NONE {
                    continue;
                }
                edge_of[e as usize] = edges.len() as u32;
                let edge = &mesh.edges[e as usize];
                let rim = !edge.quads.iter().all(|q| is_inside(*q));
                let ends = edge.vertices.map(|v| {
                    if vertex_of[v as usize] == NONE {
                        vertex_of[v as usize] = vertices.len() as u32;
                        vertices.push(LocalVertex {
                            global: v,
                            freedom: Freedom::Fixed,
                            point: mesh.vertices[v as usize].point.coords,
                            tangent: Vector::zeros(),
                            gradient: Vector::zeros(),
                        });
                        pinned.push(false);
                    }
                    let v = vertex_of[v as usize];
                    pinned[v as usize] |= rim;
                    v
                });
                let shape = Shape::Interior { unknown: if rim { NONE } else { 0 } };
                edges.push(LocalEdge {
                    global: e,
                    vertices: ends,
                    shape,
                    moves: false,
                    straight: chords || straightness.holds(mesh, e),
                    sampled: false,
                    urgency: 1.0,
                });
            }
        }
        let mut problem = Problem {
            boundary,
            reference,
            tolerance,
            vertices,
            edges,
            elements: Vec::with_capacity(active.len()),
            samples: Vec::new(),
            adjoint: Vec::new(),
            nodes: Vec::new(),
            unknowns: Vec::new(),
            scales: Default::default(),
            grid: DECISION_GRID,
            measure: Measure::Shape(2),
            inverted: 0,
            scaled_jacobian: 0.0,
            mean_scaled_jacobian: 0.0,
            error_ratio: 0.0,
            least: 0.0,
            waves: None,
        };
        problem.place_unknowns(mesh, &pinned, slide);
        for q in active {
            let quad = mesh.quads[*q as usize];
            let global = mesh.quad_edges[*q as usize];
            let edges = global.map(|e| edge_of[e as usize]);
            if !edges.iter().any(|e| problem.edges[*e as usize].moves) {
                continue;
            }
            let starts = [quad[0], quad[1], quad[3], quad[0]];
            let flips = [0, 1, 2, 3].map(|i| mesh.edges[global[i] as usize].vertices[0] != starts[i]);
            let target = Target { ratio: 1.0, area: 1.0, evenness: EVENNESS };
            let corners = quad.map(|v| vertex_of[v as usize]);
            let plain = !reference.samples_all && edges.iter().all(|e| problem.edges[*e as usize].straight);
            if !plain {
                edges.iter().for_each(|e| problem.edges[*e as usize].sampled = true);
            }
            problem.elements.push(LocalElement {
                edges,
                flips,
                corners,
                plain,
                target,
                thinness: 1.0,
                energy: 1.0,
            });
        }
        problem.samples = vec![0.0; problem.edges.len() * 4 * reference.lanes];
        problem.adjoint = problem.samples.clone();
        let unknowns = std::mem::take(&mut problem.unknowns);
        problem.sample_all(&unknowns, true, Some(mesh));
        problem.unknowns = unknowns;
        problem.refresh();
        problem
    }

    /// Numbers the unknowns and sets their values.
    fn place_unknowns(&mut self, mesh: &QuadMesh, pinned: &[bool], slide: bool) {
        for (vertex, pinned) in self.vertices.iter_mut().zip(pinned) {
            let unknown = self.unknowns.len() as u32;
            match mesh.vertices[vertex.global as usize].place {
                _ if *pinned => {}
                Place::Interior => {
                    vertex.freedom = Freedom::Free(unknown);
                    self.unknowns.extend([vertex.point.x, vertex.point.y]);
                }
                Place::Boundary(BoundaryPoint { chain, s }) if slide => {
                    vertex.freedom = Freedom::Slide { unknown, chain };
                    self.unknowns.push(s);
                }
                _ => {}
            }
        }
        let bubbles = self.reference.bubbles;
        let moving = |v: &LocalVertex| v.freedom != Freedom::Fixed;
        for edge in &mut self.edges {
            let own = &mesh.edges[edge.global as usize];
            let ends = edge.vertices.map(|v| self.vertices[v as usize]);
            edge.moves = ends.iter().any(moving);
            if let Some(Span { chain, start, end }) = own.span {
                let closed = self.boundary.chains[chain as usize].ends.is_none();
                let mut offsets = [start, end];
                let mut unknowns = [NONE; 2];
                for k in 0..2 {
                    if let Freedom::Slide { unknown, .. } = ends[k].freedom {
                        unknowns[k] = unknown;
                        offsets[k] -= self.unknowns[unknown as usize];
                        if !closed {
                            offsets[k] = 0.0;
                        }
                    }
                }
                let nodes = self.nodes.len() as u32;
                self.nodes.resize(self.nodes.len() + self.reference.nodes.len(), [Vector::zeros(); 2]);
                let length = end - start;
                edge.shape = Shape::Boundary {
                    chain,
                    unknowns,
                    offsets,
                    nodes,
                    limit: f64::INFINITY,
                    weight: 0.0,
                    length,
                };
            } else if let Shape::Interior { unknown } = &mut edge.shape {
                if *unknown != NONE && bubbles > 0 && !edge.straight {
                    edge.moves = true;
                    *unknown = self.unknowns.len() as u32;
                    for m in 0..bubbles {
                        let b = own.bubbles.get(m).copied().unwrap_or_else(Vector::zeros);
                        self.unknowns.extend([b.x, b.y]);
                    }
                } else {
                    *unknown = NONE;
                }
            }
        }
    }
}
