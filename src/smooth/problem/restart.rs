//! A fresh start for a hopelessly tangled [`Problem`].

use super::sampling::arc_lengths;
use super::{Freedom, Problem, Shape};
use crate::numerics::{Vector, NONE};

impl Problem<'_> {
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
            for (v, near) in neighbours.iter().enumerate() {
                let Freedom::Free(u) = self.vertices[v].freedom else { continue };
                let point = |v: &u32| self.vertices[*v as usize].point;
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
}
