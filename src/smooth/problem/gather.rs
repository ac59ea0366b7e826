//! From the gradient to samples back to the unknowns, with the boundary's own terms.

use super::sampling::arc_lengths;
use super::{Freedom, Problem, Shape};
use crate::numerics::{Vector, NONE};
use crate::smooth::edge_error::{barrier, squared_error};

/// Weight of −log of each boundary edge's length: keeps sliding vertices apart.
const LENGTH_WEIGHT: f64 = 1e-3;

impl Problem<'_> {
    /// Brings the adjoint of the edges' samples back to the unknowns, and adds the boundary's terms.
    pub(super) fn gather(&mut self, x: &[f64], gradient: &mut [f64]) -> f64 {
        let k = self.reference.samples.len();
        let n = self.reference.nodes.len();
        let mut extra = 0.0;
        gradient.fill(0.0);
        for (edge, g) in self.edges.iter().zip(self.adjoint.chunks_exact(4 * k)) {
            if !edge.moves {
                continue;
            }
            match edge.shape {
                Shape::Interior { .. } if !edge.sampled => {}
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
                    // Unsampled, it belongs to plain elements, which move its vertices themselves.
                    for (i, [_, tangent]) in own.iter().enumerate().filter(|_| edge.sampled) {
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
                    if self.tolerance.is_some() && weight > 0.0 {
                        let chain = &self.boundary.chains[chain as usize];
                        let e2 = squared_error(self.reference, chain, start, now, own);
                        let Some((b, slope)) = barrier(self.reference.order, e2.value, limit) else {
                            return f64::INFINITY;
                        };
                        let weight = weight * edge.urgency;
                        extra += weight * b;
                        for (end, e2) in ends.iter_mut().zip(e2.slope) {
                            *end += weight * slope * e2;
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
