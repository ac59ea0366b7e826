//! From the gradient to samples back to the unknowns, with the boundary's own terms.

use super::sampling::arc_lengths;
use super::{Freedom, Problem, Shape};
use crate::numerics::{Vector, NONE};
use crate::smooth::edge_error::{barrier, squared_error};
use crate::smooth::kernel::{sum, Lanes};

/// Weight of −log of each boundary edge's length: keeps sliding vertices apart.
const LENGTH_WEIGHT: f64 = 1e-3;

impl Problem<'_> {
    /// Brings the adjoint of the edges' samples back to the unknowns, and adds the boundary's terms.
    #[inline(always)]
    pub(super) fn gather<const L: usize>(&mut self, x: &[f64], gradient: &mut [f64]) -> f64 {
        let reference = self.reference;
        let Lanes { t, .. } = Lanes::<L>::new(&reference.samples);
        let n = self.reference.nodes.len();
        let mut extra = 0.0;
        gradient.fill(0.0);
        let adjoint = self.adjoint.chunks_exact(4 * L);
        for (edge, g) in self.edges.iter().zip(adjoint) {
            if !edge.moves {
                continue;
            }
            match edge.shape {
                Shape::Interior { .. } if !edge.sampled => {}
                Shape::Interior { unknown } => {
                    let g = lanes::<L>(g);
                    let ahead = Vector::new(dot(&t, &g[0]), dot(&t, &g[1]));
                    let values = Vector::new(sum(g[0]), sum(g[1]));
                    let at_b = ahead + Vector::new(sum(g[2]), sum(g[3]));
                    self.vertices[edge.vertices[0] as usize].gradient += values - at_b;
                    self.vertices[edge.vertices[1] as usize].gradient += at_b;
                    if unknown == NONE {
                        continue;
                    }
                    for m in 0..reference.bubbles {
                        let at = pull(&g, &reference.bubble[m * L..], &reference.bubble_slope[m * L..]);
                        let first = unknown as usize + 2 * m;
                        (gradient[first], gradient[first + 1]) = (at.x, at.y);
                    }
                }
                Shape::Boundary { chain, unknowns, offsets, nodes, limit, weight, length } => {
                    let [start, end] = arc_lengths(x, unknowns, offsets);
                    let own = &self.nodes[nodes as usize..nodes as usize + n];
                    let mut ends = [0.0; 2];
                    // Unsampled, it belongs to plain elements, which move its vertices themselves.
                    if edge.sampled {
                        let g = lanes::<L>(g);
                        for ((i, [_, tangent]), node) in own.iter().enumerate().zip(&reference.nodes) {
                            let at =
                                pull(&g, &reference.lagrange[i * L..], &reference.lagrange_slope[i * L..]);
                            let along = at.dot(tangent);
                            ends[0] += along * (1.0 - node);
                            ends[1] += along * node;
                        }
                    }
                    let now = end - start;
                    let length_weight = LENGTH_WEIGHT * edge.urgency;
                    extra -= length_weight * (now / length).ln();
                    ends[0] += length_weight / now;
                    ends[1] -= length_weight / now;
                    if self.tolerance.is_some() && weight > 0.0 {
                        let chain = &self.boundary.chains[chain as usize];
                        let e2 = squared_error(reference, chain, [start, now], own);
                        let Some((b, slope)) = barrier(reference.order, e2.value, limit) else {
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

/// An edge's lanes: to x, y, dx, dy.
#[inline(always)]
fn lanes<const L: usize>(g: &[f64]) -> [[f64; L]; 4] {
    let mut own = [[0.0; L]; 4];
    for (own, g) in own.iter_mut().zip(g.chunks_exact(L)) {
        own.copy_from_slice(g);
    }
    own
}

#[inline(always)]
fn dot<const L: usize>(a: &[f64; L], b: &[f64; L]) -> f64 {
    let mut products = *a;
    for k in 0..L {
        products[k] *= b[k];
    }
    sum(products)
}

/// The gradient to the coefficient of a shape with these values and slopes.
#[inline(always)]
fn pull<const L: usize>(g: &[[f64; L]; 4], value: &[f64], slope: &[f64]) -> Vector {
    let (mut v, mut s) = ([0.0; L], [0.0; L]);
    v.copy_from_slice(&value[..L]);
    s.copy_from_slice(&slope[..L]);
    let (mut x, mut y) = ([0.0; L], [0.0; L]);
    for k in 0..L {
        x[k] = g[0][k] * v[k] + g[2][k] * s[k];
        y[k] = g[1][k] * v[k] + g[3][k] * s[k];
    }
    Vector::new(sum(x), sum(y))
}
