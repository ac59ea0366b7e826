//! How far each unknown naturally moves, and what the boundary's barriers weigh.

use super::{Freedom, Problem, Shape};
use crate::numerics::NONE;
use crate::smooth::kernel::Measure;

/// Curvature of an element's energy (per unit of p · energy · thinness) in a corner that moves, seen from each
/// of the two edges there, and in a bubble: means of the squared shape functions' slopes.
const CORNER_STIFFNESS: f64 = 1.0 / 6.0;
const BUBBLE_STIFFNESS: f64 = 1.5;

impl Problem<'_> {
    /// Sets the measure, and from the energies at the present state the metric and the barriers' weights:
    /// with high powers a bad element is stiffer than the others by many orders of magnitude.
    pub fn prepare(&mut self, measure: Measure) {
        self.measure = measure;
        let x = std::mem::take(&mut self.unknowns);
        let finite = self.energy(&x).is_finite();
        self.unknowns = x;
        let mut at_vertex = vec![0.0; self.vertices.len()];
        let mut at_edge = vec![0.0; self.edges.len()];
        for element in &self.elements {
            let energy = if finite { element.energy.max(1.0) } else { 1.0 };
            let stiffness = energy * element.thinness;
            for e in element.edges {
                let edge = &mut self.edges[e as usize];
                edge.urgency = energy;
                at_edge[e as usize] += BUBBLE_STIFFNESS * stiffness;
                for v in edge.vertices {
                    at_vertex[v as usize] += CORNER_STIFFNESS * stiffness;
                }
            }
        }
        self.metric.clear();
        self.metric.resize(self.unknowns.len(), 1.0);
        for (vertex, stiffness) in self.vertices.iter().zip(at_vertex) {
            match vertex.freedom {
                Freedom::Fixed => {}
                Freedom::Free(u) => self.metric[u as usize..u as usize + 2].fill(1.0 / stiffness),
                Freedom::Slide { unknown, .. } => self.metric[unknown as usize] = 1.0 / stiffness,
            }
        }
        for (edge, stiffness) in self.edges.iter().zip(at_edge) {
            if let Shape::Interior { unknown } = edge.shape {
                if unknown != NONE {
                    let u = unknown as usize;
                    self.metric[u..u + 2 * self.reference.bubbles].fill(1.0 / stiffness);
                }
            }
        }
    }
}
