//! A mesh, or a few of its quads, as a function of unknowns: interior vertices, arc lengths of boundary
//! vertices, bubbles of interior edges.

mod demands;
mod gather;
mod limits;
mod metric;
mod plain;
mod restart;
mod sampling;
mod unknowns;
mod waves;

use super::kernel::{self, Lanes, Measure, Sides, Target};
use super::minimiser::{Lbfgs, Limits, Objective, Scales};
use super::reference::{Reference, MAX_SAMPLES, MOST_LANES};
use crate::domain::{Boundary, BoundaryPoint, Place, Span};
use crate::mesh::{BoundaryError, QuadMesh};
use crate::numerics::{Point, Vector, NONE};
use pulp::NullaryFnOnce;
use sampling::arc_lengths;
use waves::WaveTerm;

pub(super) use demands::Demands;
pub(super) use waves::MORE_SAMPLES;

/// Weight of an even Jacobian against angles in the shape energy; uneven elements get more.
const EVENNESS: f64 = 0.1;

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
    /// It has no bubbles, and follows a straight chain if any: whatever moves, it is the segment between its ends.
    straight: bool,
    /// An element that is not plain reads its samples.
    sampled: bool,
    /// Energy of the element beside, at least 1: what the barriers of a boundary edge have to match.
    urgency: f64,
}

#[derive(Debug, Clone, Copy)]
struct LocalElement {
    /// Edges along ξ, η, ξ, η (sides 0, 1, 2, 3), and whether each is read backwards.
    edges: [u32; 4],
    flips: [bool; 4],
    /// Counter-clockwise from ξ = η = 0.
    corners: [u32; 4],
    /// All its edges are straight: the corners alone are looked at.
    plain: bool,
    target: Target,
    /// 1/ℓ₁² + 1/ℓ₂².
    thinness: f64,
    /// p times the energy at the last evaluation.
    energy: f64,
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
    /// Per edge 4 L numbers: x, y and slopes of x, y at the samples; and the gradient to them.
    samples: Vec<f64>,
    adjoint: Vec<f64>,
    /// Point and derivative at the nodes of boundary edges.
    nodes: Vec<[Vector; 2]>,
    pub unknowns: Vec<f64>,
    pub scales: Scales,
    /// Spacing of the grid that unknowns stay on, in edge lengths.
    pub grid: f64,
    pub measure: Measure,
    /// Inverted elements at the last refresh.
    pub inverted: usize,
    /// Least scaled Jacobian at the last refresh, and the mean of the elements'.
    pub scaled_jacobian: f64,
    pub mean_scaled_jacobian: f64,
    /// Largest boundary error at the last refresh, divided by the tolerance.
    pub error_ratio: f64,
    /// Least d/A of the last evaluation.
    pub least: f64,
    /// A term for the elements' errors beside their shape.
    waves: Option<WaveTerm>,
}

/// What is done with the sampled elements, compiled for the widest registers that the processor has. The order
/// of additions is fixed by the lanes, and nothing is fused: the results are the same on any.
enum Task<'t> {
    Sample { x: &'t [f64], fixed: bool, mesh: Option<&'t QuadMesh> },
    Weigh,
    Evaluate { x: &'t [f64], gradient: &'t mut [f64] },
}

/// A task for a problem; its value, for sampling whether it succeeded.
struct Wide<'p, 'a, 't> {
    problem: &'p mut Problem<'a>,
    task: Task<'t>,
}

impl Wide<'_, '_, '_> {
    #[inline(always)]
    fn run<const L: usize>(self) -> f64 {
        let problem = self.problem;
        match self.task {
            Task::Sample { x, fixed, mesh } => f64::from(u8::from(problem.sample::<L>(x, fixed, mesh))),
            Task::Weigh => {
                problem.weigh_elements::<L>();
                0.0
            }
            Task::Evaluate { x, gradient } => problem.evaluate_lanes::<L>(x, gradient),
        }
    }
}

impl NullaryFnOnce for Wide<'_, '_, '_> {
    type Output = f64;

    #[inline(always)]
    fn call(self) -> f64 {
        match self.problem.reference.lanes {
            4 => self.run::<4>(),
            8 => self.run::<8>(),
            MAX_SAMPLES => self.run::<MAX_SAMPLES>(),
            _ => self.run::<MOST_LANES>(),
        }
    }
}

impl<'a> Problem<'a> {
    /// Minimises `measure` from the present unknowns: the value before and after. Adds to `work`.
    pub fn minimise(
        &mut self,
        lbfgs: &mut Lbfgs,
        measure: Measure,
        reach: f64,
        limits: Limits,
        work: &mut u64,
    ) -> [f64; 2] {
        self.prepare(measure);
        let mut x = std::mem::take(&mut self.unknowns);
        let scales = std::mem::take(&mut self.scales);
        let minimum = lbfgs.minimise(self, &mut x, &scales, reach, limits);
        *work += self.cost(minimum.evaluations + 1);
        (self.unknowns, self.scales) = (x, scales);
        [minimum.before, minimum.value]
    }

    /// The work of so many evaluations, in evaluations of an element of order 5.
    pub fn cost(&self, evaluations: usize) -> u64 {
        const STANDARD_SAMPLES: usize = 49;
        let curved = self.elements.iter().filter(|e| !e.plain).count();
        let samples = self.reference.samples.len().pow(2) * curved
            + plain::COST_IN_SAMPLES * (self.elements.len() - curved);
        (evaluations * samples / STANDARD_SAMPLES) as u64
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

    /// See [`Task`].
    fn wide(&mut self, task: Task) -> f64 {
        pulp::Arch::new().dispatch(Wide { problem: self, task })
    }

    /// Samples all moving edges at the unknowns `x`; with `fixed` also the others, whose bubbles are
    /// read from `mesh`. `false` if a boundary edge has no length left.
    fn sample_all(&mut self, x: &[f64], fixed: bool, mesh: Option<&QuadMesh>) -> bool {
        self.wide(Task::Sample { x, fixed, mesh }) > 0.0
    }

    #[inline(always)]
    fn evaluate_elements<const L: usize>(&mut self) -> f64 {
        let lanes = Lanes::<L>::new(&self.reference.samples);
        let (mut sides, mut gradient) = (Sides::<L>::ZERO, Sides::<L>::ZERO);
        let (mut sum, mut least) = (0.0, f64::INFINITY);
        let power = if let Measure::Shape(p) = self.measure { p as f64 } else { 1.0 };
        for element in self.elements.iter_mut().filter(|e| !e.plain) {
            for side in 0..4 {
                let at = element.edges[side] as usize * 4 * L;
                sides.read(side, &self.samples[at..at + 4 * L], &lanes, element.flips[side]);
            }
            match kernel::element::<L>(self.measure, &lanes, &sides, element.target, &mut gradient) {
                None => return f64::INFINITY,
                Some((energy, jacobian)) => {
                    sum += energy;
                    element.energy = power * energy;
                    least = least.min(jacobian);
                }
            }
            for side in 0..4 {
                let at = element.edges[side] as usize * 4 * L;
                gradient.add_to(side, &mut self.adjoint[at..at + 4 * L], &lanes, element.flips[side]);
            }
        }
        self.least = self.least.min(least);
        sum
    }

    #[inline(always)]
    fn evaluate_lanes<const L: usize>(&mut self, x: &[f64], gradient: &mut [f64]) -> f64 {
        if !self.sample::<L>(x, false, None) {
            return f64::INFINITY;
        }
        for (edge, adjoint) in self.edges.iter().zip(self.adjoint.chunks_exact_mut(4 * L)) {
            if edge.sampled {
                adjoint.fill(0.0);
            }
        }
        self.least = f64::INFINITY;
        let plain = self.evaluate_plain();
        if !plain.is_finite() {
            return f64::INFINITY;
        }
        let energy = plain + self.evaluate_elements::<L>();
        if !energy.is_finite() {
            return f64::INFINITY;
        }
        let energy = energy + self.evaluate_waves::<L>();
        if !energy.is_finite() {
            return f64::INFINITY;
        }
        let total = energy + self.gather::<L>(x, gradient);
        self.keep_pinned(gradient);
        if total.is_nan() {
            f64::INFINITY
        } else {
            total
        }
    }
}

impl Objective for Problem<'_> {
    fn evaluate(&mut self, x: &[f64], gradient: &mut [f64]) -> f64 {
        self.wide(Task::Evaluate { x, gradient })
    }
}

#[cfg(test)]
mod tests {
    use super::super::straightness::Straightness;
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
        let chain =
            Chain { loop_index: 0, name: 0, ends: None, length: s, samples: samples.into(), breaks: vec![] };
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
            edge.bubbles = (0..4).map(|m| Vector::new(0.001, -0.00075) * ((i + m) as f64).sin()).collect();
        }
        (boundary, mesh)
    }

    #[test]
    fn gradients_agree_with_differences() {
        let (boundary, mesh) = example();
        let error = BoundaryError::new(BoundaryTolerance { norm: Norm::L2, order: 5, value: 1e-3 });
        let straightness = Straightness::new(&boundary);
        let (curved, plain) = (Reference::for_energy(5), Reference::for_energy(1));
        let everywhere = straightness.everywhere();
        for (reference, tolerance) in [(&curved, Some(&error)), (&plain, None)] {
            let problem = Problem::new(&boundary, reference, tolerance, &mesh, None, true, &everywhere);
            assert!(problem.elements.iter().all(|e| e.plain == tolerance.is_none()));
            check_gradients(problem);
        }
    }

    #[test]
    fn gradients_of_waves_agree_with_differences() {
        let (boundary, mesh) = example();
        let reference = Reference::for_waves(5, 5 + MORE_SAMPLES);
        let straightness = Straightness::new(&boundary);
        let mut problem =
            Problem::new(&boundary, &reference, None, &mesh, None, true, &straightness.everywhere());
        // Angles and sizes beyond them, too.
        problem.follow(9.0, Demands { scaled_jacobian: 0.7, size: 0.3 }, Vec::new());
        check_gradients(problem);
    }

    fn check_gradients(mut problem: Problem) {
        let x = problem.unknowns.clone();
        let mut gradient = vec![0.0; x.len()];
        let mut scrap = gradient.clone();
        let measures =
            [1, 2, 4, 8].map(Measure::Shape).into_iter().chain([Measure::Regularised { epsilon: 0.4 }]);
        for measure in measures {
            problem.prepare(measure);
            assert!(problem.evaluate(&x, &mut gradient).is_finite(), "{measure:?} {}", problem.least);
            for i in 0..x.len() {
                let step = 1e-6 * problem.scales.metric[i].sqrt();
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
