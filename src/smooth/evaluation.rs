//! Evaluation of a [`Problem`]: from the unknowns to the edges' samples, to the elements' energies, and the
//! gradient back the same way.

use super::edge_error::{barrier, squared_error};
use super::kernel::{self, Measure, Sides};
use super::minimiser::Objective;
use super::problem::{arc_lengths, Freedom, Problem, Shape};
use super::reference::MAX_SAMPLES;
use super::walk::walk;
use crate::mesh::QuadMesh;
use crate::numerics::{Vector, NONE};

/// Weight of −log of each boundary edge's length: keeps sliding vertices apart.
const LENGTH_WEIGHT: f64 = 1e-3;

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

pub(super) use for_samples;

impl Problem<'_> {
    /// Samples all moving edges at the unknowns `x`; with `fixed` also the others, whose bubbles are
    /// read from `mesh`. `false` if a boundary edge has no length left.
    pub fn sample(&mut self, x: &[f64], fixed: bool, mesh: Option<&QuadMesh>) -> bool {
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

    fn evaluate_elements<const K: usize, const H: usize>(&mut self) -> f64 {
        let mut t = [0.0; K];
        t.copy_from_slice(&self.reference.samples);
        let (mut sides, mut gradient) = (Sides::<K>::ZERO, Sides::<K>::ZERO);
        let (mut sum, mut least) = (0.0, f64::INFINITY);
        let power = if let Measure::Shape(p) = self.measure { p as f64 } else { 1.0 };
        for element in &mut self.elements {
            for side in 0..4 {
                let at = element.edges[side] as usize * 4 * K;
                sides.read(side, &self.samples[at..at + 4 * K], element.flips[side]);
            }
            match kernel::element::<K, H>(self.measure, &t, &sides, element.target, &mut gradient) {
                None => return f64::INFINITY,
                Some((energy, jacobian)) => {
                    sum += energy;
                    element.energy = energy * power;
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
                    let length_weight = LENGTH_WEIGHT * edge.urgency;
                    extra -= length_weight * (now / length).ln();
                    ends[0] += length_weight / now;
                    ends[1] -= length_weight / now;
                    if self.tolerance.is_some() {
                        let chain = &self.boundary.chains[chain as usize];
                        let e2 = squared_error(self.reference, chain, start, now, own);
                        let Some((b, slope)) = barrier(self.reference.order, e2.value, limit) else {
                            return f64::INFINITY;
                        };
                        let weight = weight * edge.urgency;
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
