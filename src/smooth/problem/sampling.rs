//! From unknowns to sampled edges: forward.

use super::{Freedom, Problem, Shape};
use crate::mesh::QuadMesh;
use crate::numerics::{Vector, NONE};
use crate::smooth::walk::walk;

impl Problem<'_> {
    /// Samples all moving edges at the unknowns `x`; with `fixed` also the others, whose bubbles are
    /// read from `mesh`. `false` if a boundary edge has no length left.
    pub(super) fn sample(&mut self, x: &[f64], fixed: bool, mesh: Option<&QuadMesh>) -> bool {
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
            if !((edge.moves || fixed) && edge.sampled) {
                if let Shape::Boundary { unknowns, offsets, .. } = edge.shape {
                    let [start, end] = arc_lengths(x, unknowns, offsets);
                    if end <= start {
                        return false;
                    }
                }
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
}

/// Arc lengths of a boundary edge's ends.
pub(super) fn arc_lengths(x: &[f64], unknowns: [u32; 2], offsets: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|i| if unknowns[i] == NONE { offsets[i] } else { offsets[i] + x[unknowns[i] as usize] })
}
