//! From unknowns to sampled edges: forward.

use super::{Freedom, Problem, Shape};
use crate::domain::walk::{walk, Four, FOUR};
use crate::mesh::QuadMesh;
use crate::numerics::{Vector, NONE};
use crate::smooth::kernel::Lanes;

impl Problem<'_> {
    /// Samples all moving edges at the unknowns `x`; with `fixed` also the others, whose bubbles are
    /// read from `mesh`. `false` if a boundary edge has no length left.
    #[inline(always)]
    pub(super) fn sample<const L: usize>(&mut self, x: &[f64], fixed: bool, mesh: Option<&QuadMesh>) -> bool {
        let reference = self.reference;
        let Lanes { t, .. } = Lanes::<L>::new(&reference.samples);
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
        let samples = self.samples.chunks_exact_mut(4 * L);
        for (edge, out) in self.edges.iter().zip(samples) {
            if !((edge.moves || fixed) && edge.sampled) {
                if let Shape::Boundary { unknowns, offsets, .. } = edge.shape {
                    let [start, end] = arc_lengths(x, unknowns, offsets);
                    if end <= start {
                        return false;
                    }
                }
                continue;
            }
            // Values and slopes: x, y, dx, dy.
            let mut own = [[0.0; L]; 4];
            match edge.shape {
                Shape::Interior { unknown } => {
                    let [a, b] = edge.vertices.map(|v| self.vertices[v as usize].point);
                    let d = b - a;
                    for k in 0..L {
                        (own[0][k], own[1][k]) = (a.x + t[k] * d.x, a.y + t[k] * d.y);
                    }
                    (own[2], own[3]) = ([d.x; L], [d.y; L]);
                    let given =
                        mesh.filter(|_| unknown == NONE).map(|m| &m.edges[edge.global as usize].bubbles);
                    for m in 0..reference.bubbles {
                        let c = match (unknown, given) {
                            (NONE, None) => continue,
                            (NONE, Some(list)) => list.get(m).copied().unwrap_or_else(Vector::zeros),
                            (u, _) => Vector::new(x[u as usize + 2 * m], x[u as usize + 2 * m + 1]),
                        };
                        add(&mut own, c, &reference.bubble[m * L..], &reference.bubble_slope[m * L..]);
                    }
                }
                Shape::Boundary { chain, unknowns, offsets, nodes, .. } => {
                    let [start, end] = arc_lengths(x, unknowns, offsets);
                    if end <= start {
                        return false;
                    }
                    let chain = &self.boundary.chains[chain as usize];
                    let n = reference.nodes.len();
                    let list = &mut self.nodes[nodes as usize..nodes as usize + n];
                    walk(
                        chain,
                        [start, end - start],
                        &reference.nodes,
                        #[inline(always)]
                        |first, four: Four| {
                            for (k, node) in list[first..].iter_mut().take(FOUR).enumerate() {
                                let Four { point: p, slope: t } = &four;
                                *node = [Vector::new(p[0][k], p[1][k]), Vector::new(t[0][k], t[1][k])];
                            }
                        },
                    );
                    for (i, [p, _]) in list.iter().enumerate() {
                        add(&mut own, *p, &reference.lagrange[i * L..], &reference.lagrange_slope[i * L..]);
                    }
                }
            }
            for (out, own) in out.chunks_exact_mut(L).zip(&own) {
                out.copy_from_slice(own);
            }
        }
        true
    }
}

/// Adds a shape of value `c` to values and slopes.
#[inline(always)]
fn add<const L: usize>(own: &mut [[f64; L]; 4], c: Vector, value: &[f64], slope: &[f64]) {
    for ((k, v), s) in (0..L).zip(&value[..L]).zip(&slope[..L]) {
        own[0][k] += c.x * v;
        own[1][k] += c.y * v;
        own[2][k] += c.x * s;
        own[3][k] += c.y * s;
    }
}

/// Arc lengths of a boundary edge's ends.
#[inline(always)]
pub(super) fn arc_lengths(x: &[f64], unknowns: [u32; 2], offsets: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|i| if unknowns[i] == NONE { offsets[i] } else { offsets[i] + x[unknowns[i] as usize] })
}
