//! A mesh, or a few of its quads, as a function of unknowns: interior vertices, arc lengths of boundary
//! vertices, bubbles of interior edges.

use super::kernel::{Measure, Target};
use super::reference::Reference;
use super::scales::EVENNESS;
use crate::domain::{Boundary, BoundaryPoint, Place, Span};
use crate::mesh::{BoundaryError, QuadMesh};
use crate::numerics::{Point, Vector, NONE};

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Freedom {
    Fixed,
    /// First of two unknowns, x and y.
    Free(u32),
    /// The unknown arc length along the chain.
    Slide {
        unknown: u32,
        chain: u32,
    },
}

#[derive(Debug, Clone, Copy)]
pub(super) struct LocalVertex {
    pub global: u32,
    pub freedom: Freedom,
    pub point: Vector,
    /// dx/ds where the vertex slides.
    pub tangent: Vector,
    pub gradient: Vector,
}

#[derive(Debug, Clone, Copy)]
pub(super) enum Shape {
    /// First of the bubbles' unknowns, x then y each; `NONE`: the shape is fixed.
    Interior { unknown: u32 },
    /// Arc length of each end: an unknown plus an offset, or (with `NONE`) the offset.
    Boundary {
        chain: u32,
        unknowns: [u32; 2],
        offsets: [f64; 2],
        /// First of its nodes.
        nodes: u32,
        /// Limit of the error as the barrier measures it, and the barrier's weight.
        limit: f64,
        weight: f64,
        /// Length at the last refresh.
        length: f64,
    },
}

#[derive(Debug, Clone, Copy)]
pub(super) struct LocalEdge {
    pub global: u32,
    pub vertices: [u32; 2],
    pub shape: Shape,
    pub moves: bool,
    /// Energy of the element beside (boundary edges), at least 1: what its barriers have to match.
    pub urgency: f64,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct LocalElement {
    /// Edges along ξ, η, ξ, η (sides 0, 1, 2, 3), and whether each is read backwards.
    pub edges: [u32; 4],
    pub flips: [bool; 4],
    pub target: Target,
    /// 1/ℓ₁² + 1/ℓ₂².
    pub thinness: f64,
    /// p times the energy at the last evaluation.
    pub energy: f64,
}

/// See the module. Arrays are filled once; evaluation allocates nothing.
#[derive(Debug, Clone)]
pub(super) struct Problem<'a> {
    pub boundary: &'a Boundary,
    pub reference: &'a Reference,
    pub tolerance: Option<&'a BoundaryError>,
    pub vertices: Vec<LocalVertex>,
    pub edges: Vec<LocalEdge>,
    pub elements: Vec<LocalElement>,
    /// Per edge 4 K numbers: x, y and slopes of x, y at the samples; and the gradient to them.
    pub samples: Vec<f64>,
    pub adjoint: Vec<f64>,
    /// Point and derivative at the nodes of boundary edges.
    pub nodes: Vec<[Vector; 2]>,
    pub unknowns: Vec<f64>,
    /// Squares of natural lengths of the unknowns.
    pub metric: Vec<f64>,
    pub measure: Measure,
    /// Least scaled Jacobian at the last refresh.
    pub scaled_jacobian: f64,
    /// Largest boundary error at the last refresh, divided by the tolerance.
    pub error_ratio: f64,
    /// Least d/A of the last evaluation.
    pub least: f64,
}

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
                edges.push(LocalEdge { global: e, vertices: ends, shape, moves: false, urgency: 1.0 });
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
            metric: Vec::new(),
            measure: Measure::Shape(2),
            scaled_jacobian: 0.0,
            error_ratio: 0.0,
            least: 0.0,
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
            problem.elements.push(LocalElement { edges, flips, target, thinness: 1.0, energy: 1.0 });
        }
        let k4 = 4 * reference.samples.len();
        problem.samples = vec![0.0; problem.edges.len() * k4];
        problem.adjoint = problem.samples.clone();
        let unknowns = std::mem::take(&mut problem.unknowns);
        problem.sample(&unknowns, true, Some(mesh));
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
                if *unknown != NONE && bubbles > 0 {
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

    /// Writes the unknowns back.
    pub fn store(&self, mesh: &mut QuadMesh) {
        let x = &self.unknowns;
        for vertex in &self.vertices {
            let target = &mut mesh.vertices[vertex.global as usize];
            match vertex.freedom {
                Freedom::Fixed => {}
                Freedom::Free(u) => target.point = Point::new(x[u as usize], x[u as usize + 1]),
                Freedom::Slide { unknown, chain } => {
                    let s = self.boundary.chains[chain as usize].wrap(x[unknown as usize]);
                    target.place = Place::Boundary(BoundaryPoint { chain, s });
                    target.point = self.boundary.chains[chain as usize].point(s);
                }
            }
        }
        for edge in self.edges.iter().filter(|e| e.moves) {
            let target = &mut mesh.edges[edge.global as usize];
            match edge.shape {
                Shape::Interior { unknown: NONE } => {}
                Shape::Interior { unknown } => {
                    let u = unknown as usize;
                    target.bubbles.clear();
                    target.bubbles.extend(
                        x[u..u + 2 * self.reference.bubbles].chunks_exact(2).map(|c| Vector::new(c[0], c[1])),
                    );
                }
                Shape::Boundary { chain, unknowns, offsets, .. } => {
                    let [start, end] = arc_lengths(x, unknowns, offsets);
                    let from = self.boundary.chains[chain as usize].wrap(start);
                    target.span = Some(Span { chain, start: from, end: from + (end - start) });
                }
            }
        }
    }
}

/// Arc lengths of a boundary edge's ends.
pub(super) fn arc_lengths(x: &[f64], unknowns: [u32; 2], offsets: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|i| if unknowns[i] == NONE { offsets[i] } else { offsets[i] + x[unknowns[i] as usize] })
}

#[cfg(test)]
mod tests {
    use super::super::minimiser::Objective;
    use super::*;
    use crate::domain::{Chain, Frame, Sample};
    use crate::mesh::{BoundaryTolerance, Vertex};
    use crate::options::Norm;
    use std::collections::HashMap;

    /// An ellipse of five quads: no symmetry left, bubbles on all interior edges.
    fn example() -> (Boundary, QuadMesh) {
        let n = 400;
        let place = |i: usize| {
            let a = std::f64::consts::TAU * i as f64 / n as f64;
            (Point::new(0.4 * a.cos(), 0.3 * a.sin()), Vector::new(-0.4 * a.sin(), 0.3 * a.cos()).normalize())
        };
        let mut s = 0.0;
        let samples: Vec<Sample> = (0..=n)
            .map(|i| {
                let (point, tangent) = place(i);
                s += if i > 0 { (point - place(i - 1).0).norm() } else { 0.0 };
                Sample { s, point, tangent, curvature: 0.0, segment: 0, t: i as f64 / n as f64 }
            })
            .collect();
        let chain = Chain { loop_index: 0, name: 0, ends: None, length: s, samples, breaks: vec![] };
        let boundary = Boundary {
            frame: Frame::identity(),
            diagonal: 1.0,
            loop_sources: vec![],
            names: vec!["outer".into()],
            chains: vec![chain],
            junctions: vec![],
            loops: vec![vec![0]],
            area: 0.377,
        };
        let on = |share: f64| {
            let place = Place::Boundary(BoundaryPoint { chain: 0, s: share * s });
            Vertex { point: boundary.point(place).unwrap(), place }
        };
        let inner = |x, y| Vertex { point: Point::new(x, y), place: Place::Interior };
        let vertices = vec![
            on(0.62),
            on(0.86),
            on(0.11),
            on(0.38),
            inner(-0.15, -0.12),
            inner(0.2, -0.13),
            inner(0.15, 0.1),
            inner(-0.17, 0.11),
        ];
        let quads = vec![[4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
        let mut mesh =
            QuadMesh::new(&boundary, vertices, quads, vec![0; 5], &HashMap::new()).expect("a mesh");
        for (i, edge) in mesh.edges.iter_mut().enumerate().filter(|(_, e)| e.span.is_none()) {
            edge.bubbles = (0..4).map(|m| Vector::new(0.004, -0.003) * ((i + m) as f64).sin()).collect();
        }
        (boundary, mesh)
    }

    #[test]
    fn gradients_agree_with_differences() {
        let (boundary, mesh) = example();
        let reference = Reference::for_energy(5);
        let error = BoundaryError::new(BoundaryTolerance { norm: Norm::L2, order: 5, value: 1e-3 });
        let mut problem = Problem::new(&boundary, &reference, Some(&error), &mesh, None, true);
        let x = problem.unknowns.clone();
        let mut gradient = vec![0.0; x.len()];
        let mut scrap = gradient.clone();
        let measures =
            [1, 2, 4, 8].map(Measure::Shape).into_iter().chain([Measure::Regularised { epsilon: 0.4 }]);
        for measure in measures {
            problem.prepare(measure);
            assert!(problem.evaluate(&x, &mut gradient).is_finite());
            for i in 0..x.len() {
                let step = 1e-6 * problem.metric[i].sqrt();
                let mut at = |t: f64| {
                    let mut y = x.clone();
                    y[i] += t * step;
                    problem.evaluate(&y, &mut scrap)
                };
                // Fourth order, so that the step can be large enough for rounding.
                let slope = (8.0 * (at(100.0) - at(-100.0)) - (at(200.0) - at(-200.0))) / (1200.0 * step);
                let scale = gradient.iter().fold(1.0f64, |m, g| m.max(g.abs()));
                assert!(
                    (slope - gradient[i]).abs() < 1e-6 * scale,
                    "{measure:?} {i}: {slope} {}",
                    gradient[i]
                );
            }
        }
    }
}
