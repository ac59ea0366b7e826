//! A mesh, or a few of its quads, as a function of unknowns: interior vertices, arc lengths of boundary
//! vertices, bubbles of interior edges.

use super::edge_error::{barrier, squared_error};
use super::kernel::{self, Measure, Sampled, Sides, Target};
use super::minimiser::Objective;
use super::reference::{Reference, MAX_SAMPLES};
use super::walk::walk;
use crate::domain::{Boundary, BoundaryPoint, Place, Span};
use crate::mesh::{BoundaryError, QuadMesh};
use crate::numerics::{Point, Vector, NONE};

/// Weight of the tolerance's barrier against the shape energy, whose optimum is 1/p an element.
const TOLERANCE_WEIGHT: f64 = 2e-2;
/// Weight of −log of each boundary edge's length: keeps sliding vertices apart.
const LENGTH_WEIGHT: f64 = 1e-3;
/// The barrier stands this much before the tolerance.
const MARGIN: f64 = 0.98;
/// Errors closer to a limit than this share are taken as above it.
const CLOSE: f64 = 0.995;
/// Room given to an edge whose error is above the tolerance.
const ROOM: f64 = 1.05;
/// Weight of the barrier on such edges, which are to come back below.
const RESCUE_WEIGHT: f64 = 0.2;
/// Weight of an even Jacobian against angles in the shape energy ...
const EVENNESS: f64 = 0.1;
/// ... which grows where its least value falls below this share of its largest, ...
const UNEVEN: f64 = 0.15;
/// ... up to this.
const MOST_EVENNESS: f64 = 0.5;
/// Aspect ratios up to this are left alone; beyond, elements are drawn back to it gently.
const FREE_ASPECT: f64 = 6.0;

#[derive(Debug, Clone, Copy, PartialEq)]
enum Freedom {
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
struct LocalVertex {
    global: u32,
    freedom: Freedom,
    point: Vector,
    /// dx/ds where the vertex slides.
    tangent: Vector,
    gradient: Vector,
}

#[derive(Debug, Clone, Copy)]
enum Shape {
    /// First of the bubbles' unknowns, x then y each; `NONE`: the shape is fixed.
    Interior { unknown: u32 },
    /// Arc length of each end: an unknown plus an offset, or (with `NONE`) the offset.
    Boundary {
        chain: u32,
        unknowns: [u32; 2],
        offsets: [f64; 2],
        nodes: u32,
        limit: f64,
        weight: f64,
        length: f64,
    },
}

#[derive(Debug, Clone, Copy)]
struct LocalEdge {
    global: u32,
    vertices: [u32; 2],
    shape: Shape,
    moves: bool,
}

#[derive(Debug, Clone, Copy)]
struct LocalElement {
    /// Edges along ξ, η, ξ, η (sides 0, 1, 2, 3), and whether each is read backwards.
    edges: [u32; 4],
    flips: [bool; 4],
    target: Target,
}

/// See the module. Arrays are filled once; evaluation allocates nothing.
#[derive(Debug, Clone)]
pub(super) struct Problem<'a> {
    boundary: &'a Boundary,
    reference: &'a Reference,
    tolerance: Option<&'a BoundaryError>,
    vertices: Vec<LocalVertex>,
    edges: Vec<LocalEdge>,
    elements: Vec<LocalElement>,
    /// Per edge 4 K numbers: x, y and slopes of x, y at the samples; and the gradient to them.
    samples: Vec<f64>,
    adjoint: Vec<f64>,
    /// Point and derivative at the nodes of boundary edges.
    nodes: Vec<[Vector; 2]>,
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

/// Calls a method that is generic in the number of samples and of pairs of them.
macro_rules! for_samples {
    ($problem:expr, $method:ident) => {
        match $problem.reference.samples.len() {
            3 => $problem.$method::<3, 2>(),
            4 => $problem.$method::<4, 2>(),
            5 => $problem.$method::<5, 3>(),
            6 => $problem.$method::<6, 3>(),
            7 => $problem.$method::<7, 4>(),
            8 => $problem.$method::<8, 4>(),
            9 => $problem.$method::<9, 5>(),
            10 => $problem.$method::<10, 5>(),
            11 => $problem.$method::<11, 6>(),
            _ => $problem.$method::<MAX_SAMPLES, { MAX_SAMPLES / 2 }>(),
        }
    };
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
                edges.push(LocalEdge { global: e, vertices: ends, shape, moves: false });
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
            problem.elements.push(LocalElement {
                edges,
                flips,
                target: Target { ratio: 1.0, area: 1.0, evenness: EVENNESS },
            });
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

    /// Samples all moving edges at the unknowns `x`; with `fixed` also the others, whose bubbles are
    /// read from `mesh`. `false` if a boundary edge has no length left.
    fn sample(&mut self, x: &[f64], fixed: bool, mesh: Option<&QuadMesh>) -> bool {
        let k = self.reference.samples.len();
        for vertex in &mut self.vertices {
            match vertex.freedom {
                Freedom::Fixed => {}
                Freedom::Free(u) => vertex.point = Vector::new(x[u as usize], x[u as usize + 1]),
                Freedom::Slide { unknown, chain } => {
                    let (p, t) = self.boundary.chains[chain as usize].evaluate(x[unknown as usize]);
                    (vertex.point, vertex.tangent) = (p.coords, t);
                }
            }
        }
        for (edge, out) in self.edges.iter().zip(self.samples.chunks_exact_mut(4 * k)) {
            if !(edge.moves || fixed) {
                continue;
            }
            let (cx, rest) = out.split_at_mut(k);
            let (cy, rest) = rest.split_at_mut(k);
            let (dx, dy) = rest.split_at_mut(k);
            match edge.shape {
                Shape::Interior { unknown } => {
                    let [a, b] = edge.vertices.map(|v| self.vertices[v as usize].point);
                    let d = b - a;
                    for (i, t) in self.reference.samples.iter().enumerate() {
                        (cx[i], cy[i], dx[i], dy[i]) = (a.x + t * d.x, a.y + t * d.y, d.x, d.y);
                    }
                    let own =
                        mesh.filter(|_| unknown == NONE).map(|m| &m.edges[edge.global as usize].bubbles);
                    for m in 0..self.reference.bubbles {
                        let c = match (unknown, own) {
                            (NONE, None) => continue,
                            (NONE, Some(list)) => list.get(m).copied().unwrap_or_else(Vector::zeros),
                            (u, _) => Vector::new(x[u as usize + 2 * m], x[u as usize + 2 * m + 1]),
                        };
                        let (v, s) = (&self.reference.bubble[m * k..], &self.reference.bubble_slope[m * k..]);
                        for i in 0..k {
                            cx[i] += c.x * v[i];
                            cy[i] += c.y * v[i];
                            dx[i] += c.x * s[i];
                            dy[i] += c.y * s[i];
                        }
                    }
                }
                Shape::Boundary { chain, unknowns, offsets, nodes, .. } => {
                    let [start, end] = arc_lengths(x, unknowns, offsets);
                    if end <= start {
                        return false;
                    }
                    let chain = &self.boundary.chains[chain as usize];
                    let n = self.reference.nodes.len();
                    let own = &mut self.nodes[nodes as usize..nodes as usize + n];
                    walk(chain, start, end - start, &self.reference.nodes, |i, p, t| own[i] = [p, t]);
                    out.fill(0.0);
                    for (i, [p, _]) in own.iter().enumerate() {
                        let v = &self.reference.lagrange[i * k..(i + 1) * k];
                        let s = &self.reference.lagrange_slope[i * k..(i + 1) * k];
                        for j in 0..k {
                            out[j] += p.x * v[j];
                            out[k + j] += p.y * v[j];
                            out[2 * k + j] += p.x * s[j];
                            out[3 * k + j] += p.y * s[j];
                        }
                    }
                }
            }
        }
        true
    }

    /// Forgets the shape: free edges become straight, free vertices go to the means of their neighbours
    /// (Gauss-Seidel with over-relaxation, at most `sweeps` sweeps).
    pub fn flatten(&mut self, sweeps: usize) {
        const OVER: f64 = 1.6;
        const STILL: f64 = 1e-3;
        let mut neighbours = vec![Vec::new(); self.vertices.len()];
        let mut x = std::mem::take(&mut self.unknowns);
        for edge in &self.edges {
            let [a, b] = edge.vertices;
            neighbours[a as usize].push(b);
            neighbours[b as usize].push(a);
            if let Shape::Interior { unknown } = edge.shape {
                if unknown != NONE {
                    x[unknown as usize..unknown as usize + 2 * self.reference.bubbles].fill(0.0);
                }
            }
        }
        for vertex in &mut self.vertices {
            if let Freedom::Slide { unknown, chain } = vertex.freedom {
                vertex.point = self.boundary.chains[chain as usize].point(x[unknown as usize]).coords;
            }
        }
        for _ in 0..sweeps {
            let (mut moved, mut size) = (0.0f64, 0.0f64);
            for v in 0..self.vertices.len() {
                let Freedom::Free(u) = self.vertices[v].freedom else { continue };
                let point = |v: &u32| self.vertices[*v as usize].point;
                let near = &neighbours[v];
                let mean = near.iter().map(point).sum::<Vector>() / near.len() as f64;
                let step = (mean - self.vertices[v].point) * OVER;
                moved = moved.max(step.norm());
                size = size.max((point(&near[0]) - mean).norm());
                self.vertices[v].point += step;
                let p = self.vertices[v].point;
                (x[u as usize], x[u as usize + 1]) = (p.x, p.y);
            }
            if moved <= STILL * size {
                break;
            }
        }
        self.unknowns = x;
        self.refresh();
    }

    /// Moves sliding vertices towards the middle between their neighbours on the chain: where a layout
    /// piled them up, nothing else gets them apart. The tolerance is not looked at.
    pub fn spread(&mut self) {
        const PASSES: usize = 30;
        for _ in 0..PASSES {
            let mut shift = vec![0.0; self.unknowns.len()];
            for edge in &self.edges {
                if let Shape::Boundary { unknowns, offsets, .. } = edge.shape {
                    let [start, end] = arc_lengths(&self.unknowns, unknowns, offsets);
                    for (unknown, sign) in unknowns.into_iter().zip([1.0, -1.0]) {
                        if unknown != NONE {
                            shift[unknown as usize] += sign * 0.25 * (end - start);
                        }
                    }
                }
            }
            for (x, s) in self.unknowns.iter_mut().zip(shift) {
                *x += s;
            }
        }
    }

    /// Length of each local edge as sampled last.
    fn lengths(&self) -> Vec<f64> {
        let k = self.reference.samples.len();
        let length = |s: &[f64]| (1..k).map(|i| (s[i] - s[i - 1]).hypot(s[k + i] - s[k + i - 1])).sum();
        self.samples.chunks_exact(4 * k).map(length).collect()
    }

    /// Takes aspect ratios, natural lengths and error limits from the present state: they stay
    /// constant during a minimisation.
    pub fn refresh(&mut self) {
        let x = std::mem::take(&mut self.unknowns);
        self.sample(&x, false, None);
        self.unknowns = x;
        let lengths = self.lengths();
        let mut widths = vec![0.0; self.edges.len()]; // Σ 1/width² of the elements beside
        let mut floor = vec![0.0f64; self.elements.len()];
        for (element, floor) in self.elements.iter_mut().zip(&mut floor) {
            let l = element.edges.map(|e| lengths[e as usize]);
            // Edges without length must not make a target of no size.
            *floor = 1e-3 * l.iter().fold(0.0, |a: f64, b| a.max(*b)) + f64::MIN_POSITIVE;
            let (l1, l2) = ((0.5 * (l[0] + l[2])).max(*floor), (0.5 * (l[1] + l[3])).max(*floor));
            let area = area(element, &self.samples, self.reference.samples.len());
            // Inverted elements have no area worth keeping.
            let area = if area > 0.2 * l1 * l2 { area } else { l1 * l2 };
            element.target = Target { ratio: tame(l2 / l1), area, evenness: EVENNESS };
            for (i, e) in element.edges.iter().enumerate() {
                let width = if i % 2 == 0 { l2 } else { l1 };
                widths[*e as usize] += 1.0 / (width * width);
            }
        }
        // Natural lengths: harmonic means of the squares, so that the shortest neighbour rules.
        let mut at_vertex = vec![[0.0; 2]; self.vertices.len()];
        for (e, edge) in self.edges.iter().enumerate() {
            let inverse = 1.0 / (lengths[e] * lengths[e]).max(f64::MIN_POSITIVE);
            for v in edge.vertices {
                let [sum, count] = &mut at_vertex[v as usize];
                *sum += inverse;
                *count += 1.0;
            }
        }
        self.metric.clear();
        self.metric.resize(self.unknowns.len(), 1.0);
        for (vertex, [sum, count]) in self.vertices.iter().zip(at_vertex) {
            match vertex.freedom {
                Freedom::Fixed => {}
                Freedom::Free(u) => self.metric[u as usize..u as usize + 2].fill(count / sum),
                Freedom::Slide { unknown, .. } => self.metric[unknown as usize] = count / sum,
            }
        }
        for (e, edge) in self.edges.iter().enumerate() {
            if let Shape::Interior { unknown } = edge.shape {
                if unknown != NONE {
                    let own = 1.0 / (lengths[e] * lengths[e]).max(f64::MIN_POSITIVE);
                    let u = unknown as usize;
                    self.metric[u..u + 2 * self.reference.bubbles].fill(0.5 / (own + widths[e]));
                }
            }
        }
        self.refresh_evenness();
        self.refresh_limits();
    }

    /// Limits of the boundary errors. The barrier's own error is of the L2 norm and by few points;
    /// its limit is scaled by the present ratio of that to the true one.
    fn refresh_limits(&mut self) {
        self.error_ratio = 0.0;
        let Some(tolerance) = self.tolerance else { return };
        let (x, n) = (&self.unknowns, self.reference.nodes.len());
        for edge in self.edges.iter_mut().filter(|e| e.moves) {
            if let Shape::Boundary { chain, unknowns, offsets, nodes, limit, weight, length } =
                &mut edge.shape
            {
                let [start, end] = arc_lengths(x, *unknowns, *offsets);
                *length = end - start;
                let own = &self.nodes[*nodes as usize..*nodes as usize + n];
                let chain = &self.boundary.chains[*chain as usize];
                let now = tolerance.of_chain(chain, start, end);
                let value = tolerance.tolerance.value;
                self.error_ratio = self.error_ratio.max(now / value);
                let wanted = MARGIN * value;
                (*limit, *weight) = if now < CLOSE * wanted {
                    (wanted, TOLERANCE_WEIGHT)
                } else if now < CLOSE * value {
                    (value, RESCUE_WEIGHT)
                } else {
                    (ROOM * now, RESCUE_WEIGHT)
                };
                if now > 1e-3 * wanted {
                    let seen = squared_error(self.reference, chain, start, *length, own).value.sqrt();
                    *limit *= seen / now;
                }
            }
        }
    }

    /// The value at `x`, alone.
    pub fn energy(&mut self, x: &[f64]) -> f64 {
        let mut gradient = vec![0.0; x.len()];
        self.evaluate(x, &mut gradient)
    }

    /// The least d/A over all samples at the present unknowns: positive if nothing is inverted there.
    pub fn least_jacobian(&mut self) -> f64 {
        let measure = std::mem::replace(&mut self.measure, Measure::Regularised { epsilon: 1.0 });
        let x = std::mem::take(&mut self.unknowns);
        let mut gradient = vec![0.0; x.len()];
        let value = self.evaluate(&x, &mut gradient);
        self.unknowns = x;
        self.measure = measure;
        if value.is_finite() && !self.elements.is_empty() {
            self.least
        } else if self.elements.is_empty() {
            f64::INFINITY
        } else {
            f64::NEG_INFINITY
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

    fn refresh_evenness(&mut self) {
        for_samples!(self, weigh_elements)
    }

    /// Gives uneven elements more weight on evenness.
    fn weigh_elements<const K: usize, const H: usize>(&mut self) {
        let mut t = [0.0; K];
        t.copy_from_slice(&self.reference.samples);
        let mut sides = Sides::<K>::ZERO;
        self.scaled_jacobian = f64::INFINITY;
        for element in &mut self.elements {
            for side in 0..4 {
                let at = element.edges[side] as usize * 4 * K;
                sides.read(side, &self.samples[at..at + 4 * K], element.flips[side]);
            }
            let Sampled { least, most, scaled } = kernel::jacobians(&t, &sides);
            self.scaled_jacobian = self.scaled_jacobian.min(scaled);
            let wanted = EVENNESS * UNEVEN * most / least;
            // Inverted elements have other worries.
            let wanted = if least > 0.0 { wanted } else { EVENNESS };
            element.target.evenness = wanted.clamp(EVENNESS, MOST_EVENNESS);
        }
    }

    fn evaluate_elements<const K: usize, const H: usize>(&mut self) -> f64 {
        let mut t = [0.0; K];
        t.copy_from_slice(&self.reference.samples);
        let (mut sides, mut gradient) = (Sides::<K>::ZERO, Sides::<K>::ZERO);
        let (mut sum, mut least) = (0.0, f64::INFINITY);
        for element in &self.elements {
            for side in 0..4 {
                let at = element.edges[side] as usize * 4 * K;
                sides.read(side, &self.samples[at..at + 4 * K], element.flips[side]);
            }
            match kernel::element::<K, H>(self.measure, &t, &sides, element.target, &mut gradient) {
                None => return f64::INFINITY,
                Some((energy, jacobian)) => {
                    sum += energy;
                    least = least.min(jacobian);
                }
            }
            for side in 0..4 {
                let at = element.edges[side] as usize * 4 * K;
                gradient.add_to(side, &mut self.adjoint[at..at + 4 * K], element.flips[side]);
            }
        }
        self.least = least;
        sum
    }

    /// Brings the adjoint of the edges' samples back to the unknowns, and adds the boundary's terms.
    fn gather(&mut self, x: &[f64], gradient: &mut [f64]) -> f64 {
        let k = self.reference.samples.len();
        let n = self.reference.nodes.len();
        let mut extra = 0.0;
        gradient.fill(0.0);
        self.vertices.iter_mut().for_each(|v| v.gradient = Vector::zeros());
        for (edge, g) in self.edges.iter().zip(self.adjoint.chunks_exact(4 * k)) {
            if !edge.moves {
                continue;
            }
            match edge.shape {
                Shape::Interior { unknown } => {
                    let (mut at_a, mut at_b) = (Vector::zeros(), Vector::zeros());
                    for (i, t) in self.reference.samples.iter().enumerate() {
                        let (c, d) = (Vector::new(g[i], g[k + i]), Vector::new(g[2 * k + i], g[3 * k + i]));
                        at_a += c * (1.0 - t) - d;
                        at_b += c * *t + d;
                    }
                    self.vertices[edge.vertices[0] as usize].gradient += at_a;
                    self.vertices[edge.vertices[1] as usize].gradient += at_b;
                    if unknown == NONE {
                        continue;
                    }
                    for m in 0..self.reference.bubbles {
                        let (v, s) = (&self.reference.bubble[m * k..], &self.reference.bubble_slope[m * k..]);
                        for axis in 0..2 {
                            let (c, d) = (&g[axis * k..], &g[(axis + 2) * k..]);
                            let sum: f64 = (0..k).map(|i| c[i] * v[i] + d[i] * s[i]).sum();
                            gradient[unknown as usize + 2 * m + axis] = sum;
                        }
                    }
                }
                Shape::Boundary { chain, unknowns, offsets, nodes, limit, weight, length } => {
                    let [start, end] = arc_lengths(x, unknowns, offsets);
                    let own = &self.nodes[nodes as usize..nodes as usize + n];
                    let mut ends = [0.0; 2];
                    for (i, [_, tangent]) in own.iter().enumerate() {
                        let v = &self.reference.lagrange[i * k..(i + 1) * k];
                        let s = &self.reference.lagrange_slope[i * k..(i + 1) * k];
                        let mut at = Vector::zeros();
                        for j in 0..k {
                            at.x += g[j] * v[j] + g[2 * k + j] * s[j];
                            at.y += g[k + j] * v[j] + g[3 * k + j] * s[j];
                        }
                        let along = at.dot(tangent);
                        ends[0] += along * (1.0 - self.reference.nodes[i]);
                        ends[1] += along * self.reference.nodes[i];
                    }
                    let now = end - start;
                    extra -= LENGTH_WEIGHT * (now / length).ln();
                    ends[0] += LENGTH_WEIGHT / now;
                    ends[1] -= LENGTH_WEIGHT / now;
                    if self.tolerance.is_some() {
                        let chain = &self.boundary.chains[chain as usize];
                        let e2 = squared_error(self.reference, chain, start, now, own);
                        let Some((b, slope)) = barrier(self.reference.order, e2.value, limit) else {
                            return f64::INFINITY;
                        };
                        extra += weight * b;
                        for i in 0..2 {
                            ends[i] += weight * slope * e2.slope[i];
                        }
                    }
                    for i in 0..2 {
                        if unknowns[i] != NONE {
                            gradient[unknowns[i] as usize] += ends[i];
                        }
                    }
                }
            }
        }
        for vertex in &self.vertices {
            match vertex.freedom {
                Freedom::Fixed => {}
                Freedom::Free(u) => {
                    gradient[u as usize] += vertex.gradient.x;
                    gradient[u as usize + 1] += vertex.gradient.y;
                }
                Freedom::Slide { unknown, .. } => {
                    gradient[unknown as usize] += vertex.gradient.dot(&vertex.tangent);
                }
            }
        }
        extra
    }
}

/// Signed area inside an element's sampled sides.
fn area(element: &LocalElement, samples: &[f64], k: usize) -> f64 {
    let mut twice = 0.0;
    for side in 0..4 {
        let c = &samples[element.edges[side] as usize * 4 * k..];
        let sum: f64 = (1..k).map(|i| c[i - 1] * c[k + i] - c[i] * c[k + i - 1]).sum();
        // Sides 2 and 3 run clockwise.
        twice += if element.flips[side] == (side < 2) { -sum } else { sum };
    }
    0.5 * twice
}

/// Arc lengths of a boundary edge's ends.
fn arc_lengths(x: &[f64], unknowns: [u32; 2], offsets: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|i| if unknowns[i] == NONE { offsets[i] } else { offsets[i] + x[unknowns[i] as usize] })
}

/// The aspect ratio to aim at where the present one is `ratio`.
fn tame(ratio: f64) -> f64 {
    if ratio > FREE_ASPECT {
        FREE_ASPECT * (ratio / FREE_ASPECT).sqrt()
    } else if ratio < 1.0 / FREE_ASPECT {
        1.0 / tame(1.0 / ratio)
    } else {
        ratio
    }
}

impl Objective for Problem<'_> {
    fn evaluate(&mut self, x: &[f64], gradient: &mut [f64]) -> f64 {
        if !self.sample(x, false, None) {
            return f64::INFINITY;
        }
        self.adjoint.fill(0.0);
        let energy = for_samples!(self, evaluate_elements);
        if !energy.is_finite() {
            return f64::INFINITY;
        }
        let total = energy + self.gather(x, gradient);
        if total.is_nan() {
            f64::INFINITY
        } else {
            total
        }
    }
}

#[cfg(test)]
mod tests {
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
            problem.measure = measure;
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
