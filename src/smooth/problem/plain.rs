//! Elements with four straight sides: bilinear, det J linear, so that four corners say everything.

use super::{LocalElement, LocalVertex, Problem};
use crate::numerics::Vector;
use crate::smooth::kernel::{self, Lanes, Measure, Sampled, Sides};

/// Cost of an evaluation, in samples of a curved element.
pub(super) const COST_IN_SAMPLES: usize = 6;
/// First and last corner of each side, in the element's directions.
const SIDES: [[usize; 2]; 4] = [[0, 1], [1, 2], [3, 2], [0, 3]];

impl LocalElement {
    fn corner_points(&self, vertices: &[LocalVertex]) -> [Vector; 4] {
        self.corners.map(|v| vertices[v as usize].point)
    }

    /// Signed area inside the corners.
    pub(super) fn plain_area(&self, vertices: &[LocalVertex]) -> f64 {
        let p = self.corner_points(vertices);
        0.5 * (p[2] - p[0]).perp(&(p[3] - p[1]))
    }

    #[inline(always)]
    fn plain_sides(&self, vertices: &[LocalVertex], sides: &mut Sides<2>) {
        let p = self.corner_points(vertices);
        for (side, [a, b]) in SIDES.into_iter().enumerate() {
            let d = p[b] - p[a];
            for axis in 0..2 {
                sides.c[side][axis] = [p[a][axis], p[b][axis]];
                sides.d[side][axis] = [d[axis]; 2];
            }
        }
    }

    /// What the corners say without an energy.
    pub(super) fn plain_jacobians(&self, vertices: &[LocalVertex]) -> Sampled {
        let mut sides = Sides::<2>::ZERO;
        self.plain_sides(vertices, &mut sides);
        kernel::jacobians(&Lanes::ENDS, &sides)
    }
}

impl Problem<'_> {
    /// Energy of the plain elements; clears the vertices' gradients and adds theirs. Infinite where a shape energy is.
    #[inline(always)]
    pub(super) fn evaluate_plain(&mut self) -> f64 {
        self.vertices.iter_mut().for_each(|v| v.gradient = Vector::zeros());
        let (mut sides, mut gradient) = (Sides::<2>::ZERO, Sides::<2>::ZERO);
        let power = if let Measure::Shape(p) = self.measure { p as f64 } else { 1.0 };
        let mut sum = 0.0;
        for element in self.elements.iter_mut().filter(|e| e.plain) {
            element.plain_sides(&self.vertices, &mut sides);
            let out = kernel::element::<2>(self.measure, &Lanes::ENDS, &sides, element.target, &mut gradient);
            let Some((energy, jacobian)) = out else { return f64::INFINITY };
            sum += energy;
            element.energy = power * energy;
            self.least = self.least.min(jacobian);
            for (side, [a, b]) in SIDES.into_iter().enumerate() {
                for axis in 0..2 {
                    let [c, d] = [gradient.c[side][axis], gradient.d[side][axis]];
                    let slope = d[0] + d[1];
                    self.vertices[element.corners[a] as usize].gradient[axis] += c[0] - slope;
                    self.vertices[element.corners[b] as usize].gradient[axis] += c[1] + slope;
                }
            }
        }
        sum
    }
}
