//! How far each unknown naturally moves, and what the boundary's barriers weigh.

use super::{Freedom, Problem, Shape};
use crate::numerics::NONE;
use crate::smooth::kernel::Measure;
use crate::smooth::minimiser::grid_cell;

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
        // Stiffness, and the same with the energies left out: grids do not shrink where an element is bad.
        let mut at_vertex = vec![[0.0; 2]; self.vertices.len()];
        let mut at_edge = vec![[0.0; 2]; self.edges.len()];
        for element in &self.elements {
            let energy = if finite { element.energy.max(1.0) } else { 1.0 };
            let stiffness = [energy * element.thinness, element.thinness];
            let add = |sum: &mut [f64; 2], share: f64| (0..2).for_each(|i| sum[i] += share * stiffness[i]);
            for e in element.edges {
                let edge = &mut self.edges[e as usize];
                edge.urgency = energy;
                add(&mut at_edge[e as usize], BUBBLE_STIFFNESS);
                for v in edge.vertices {
                    add(&mut at_vertex[v as usize], CORNER_STIFFNESS);
                }
            }
        }
        let (n, grid) = (self.unknowns.len(), self.grid);
        let (metric, cells) = (&mut self.scales.metric, &mut self.scales.cells);
        metric.clear();
        metric.resize(n, 1.0);
        cells.clear();
        cells.resize(n, 0.0);
        let mut set = |unknown: u32, count: usize, [stiffness, plain]: [f64; 2]| {
            let range = unknown as usize..unknown as usize + count;
            metric[range.clone()].fill(1.0 / stiffness);
            cells[range].fill(grid_cell(1.0 / plain, grid));
        };
        for (vertex, stiffness) in self.vertices.iter().zip(at_vertex) {
            match vertex.freedom {
                Freedom::Fixed => {}
                Freedom::Free(unknown) => set(unknown, 2, stiffness),
                Freedom::Slide { unknown, .. } => set(unknown, 1, stiffness),
            }
        }
        for (edge, stiffness) in self.edges.iter().zip(at_edge) {
            match edge.shape {
                Shape::Interior { unknown } if unknown != NONE => {
                    set(unknown, 2 * self.reference.bubbles, stiffness);
                }
                _ => {}
            }
        }
    }
}
