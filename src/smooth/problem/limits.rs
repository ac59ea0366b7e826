//! What stays constant during a minimisation: aspect ratios, weights, error limits.

use super::sampling::arc_lengths;
use super::{LocalEdge, LocalElement, Problem, Shape, Task, EVENNESS};
use crate::numerics::Vector;
use crate::smooth::edge_error::{squared_error, NEGLIGIBLE};
use crate::smooth::kernel::{self, Lanes, Sampled, Sides, Target};
use crate::smooth::reference::Reference;

/// The barrier stands this much before the tolerance.
const MARGIN: f64 = 0.98;
/// Errors closer to a limit than this share are taken as above it.
const CLOSE: f64 = 0.995;
/// Room given to an edge whose error is above the tolerance.
const ROOM: f64 = 1.002;
/// Weight of the barrier on such edges, which are to come back below.
const RESCUE_WEIGHT: f64 = 0.2;
/// Weight of the tolerance's barrier against the shape energy, whose optimum is 1/p an element.
const TOLERANCE_WEIGHT: f64 = 2e-2;
/// The weight of evenness grows where an element's Jacobian is uneven: its least value falls below this share of its largest, ...
const UNEVEN: f64 = 0.15;
/// ... up to this.
const MOST_EVENNESS: f64 = 0.5;
/// Aspect ratios up to this are left alone; beyond, elements are drawn back to it gently.
const FREE_ASPECT: f64 = 6.0;

impl Problem<'_> {
    /// Length of each local edge as sampled last.
    fn lengths(&self) -> Vec<f64> {
        let (k, lanes) = (self.reference.samples.len(), self.reference.lanes);
        let step = |s: &[f64], i: usize| Vector::new(s[i] - s[i - 1], s[lanes + i] - s[lanes + i - 1]);
        let along = |s: &[f64]| (1..k).map(|i| step(s, i).norm()).sum();
        let length = |(edge, samples): (&LocalEdge, &[f64])| match edge.sampled {
            true => along(samples),
            false => {
                let [a, b] = edge.vertices.map(|v| self.vertices[v as usize].point);
                (b - a).norm()
            }
        };
        self.edges.iter().zip(self.samples.chunks_exact(4 * lanes)).map(length).collect()
    }

    /// Takes aspect ratios, weights and error limits from the present state: they stay
    /// constant during a minimisation.
    pub fn refresh(&mut self) {
        let x = std::mem::take(&mut self.unknowns);
        self.sample_all(&x, false, None);
        self.unknowns = x;
        let lengths = self.lengths();
        for element in &mut self.elements {
            let l = element.edges.map(|e| lengths[e as usize]);
            // Edges without length must not make a target of no size.
            let floor = 1e-3 * l.iter().fold(0.0, |a: f64, b| a.max(*b)) + f64::MIN_POSITIVE;
            let (l1, l2) = ((0.5 * (l[0] + l[2])).max(floor), (0.5 * (l[1] + l[3])).max(floor));
            let area = match element.plain {
                true => element.plain_area(&self.vertices),
                false => area(element, &self.samples, self.reference),
            };
            // Inverted elements have no area worth keeping.
            let area = if area > 0.2 * l1 * l2 { area } else { l1 * l2 };
            element.target = Target { ratio: tame(l2 / l1), area, evenness: EVENNESS };
            element.thinness = 1.0 / (l1 * l1) + 1.0 / (l2 * l2);
        }
        self.wide(Task::Weigh);
        self.refresh_limits();
    }

    /// Limits of the boundary errors. The barrier's own error is of the L2 norm and by few points;
    /// its limit is scaled by the present ratio of that to the true one.
    fn refresh_limits(&mut self) {
        self.error_ratio = 0.0;
        let Some(tolerance) = self.tolerance else { return };
        let (x, n) = (&self.unknowns, self.reference.nodes.len());
        for edge in self.edges.iter_mut().filter(|e| e.moves) {
            let straight = edge.straight;
            if let Shape::Boundary { chain, unknowns, offsets, nodes, limit, weight, length } =
                &mut edge.shape
            {
                let [start, end] = arc_lengths(x, *unknowns, *offsets);
                *length = end - start;
                if straight {
                    // No error, no barrier. A curved edge has one however small its error: it would grow.
                    continue;
                }
                let own = &self.nodes[*nodes as usize..*nodes as usize + n];
                let chain = &self.boundary.chains[*chain as usize];
                let now = tolerance.of_chain(chain, start, end);
                let value = tolerance.tolerance.value;
                self.error_ratio = self.error_ratio.max(now / value);
                let wanted = MARGIN * value;
                (*limit, *weight) = if now < CLOSE * wanted {
                    (wanted, TOLERANCE_WEIGHT)
                } else if now < CLOSE * value {
                    (value, RESCUE_WEIGHT)
                } else {
                    (ROOM * now, RESCUE_WEIGHT)
                };
                if now > NEGLIGIBLE * wanted {
                    let seen = squared_error(self.reference, chain, [start, *length], own).value.sqrt();
                    *limit *= seen / now;
                }
            }
        }
    }

    /// Gives uneven elements more weight on evenness.
    #[inline(always)]
    pub(super) fn weigh_elements<const L: usize>(&mut self) {
        let lanes = Lanes::<L>::new(&self.reference.samples);
        let mut sides = Sides::<L>::ZERO;
        (self.scaled_jacobian, self.mean_scaled_jacobian) = (f64::INFINITY, 0.0);
        self.inverted = 0;
        let share = 1.0 / self.elements.len().max(1) as f64;
        for element in &mut self.elements {
            let Sampled { least, most, scaled } = if element.plain {
                element.plain_jacobians(&self.vertices)
            } else {
                for side in 0..4 {
                    let at = element.edges[side] as usize * 4 * L;
                    sides.read(side, &self.samples[at..at + 4 * L], &lanes, element.flips[side]);
                }
                kernel::jacobians(&lanes, &sides)
            };
            self.inverted += usize::from(least <= 0.0);
            self.scaled_jacobian = self.scaled_jacobian.min(scaled);
            self.mean_scaled_jacobian += share * scaled;
            let wanted = EVENNESS * UNEVEN * most / least;
            // Inverted elements have other worries.
            let wanted = if least > 0.0 { wanted } else { EVENNESS };
            element.target.evenness = wanted.clamp(EVENNESS, MOST_EVENNESS);
        }
    }
}

/// Signed area inside an element's sampled sides.
fn area(element: &LocalElement, samples: &[f64], reference: &Reference) -> f64 {
    let (k, lanes) = (reference.samples.len(), reference.lanes);
    let mut twice = 0.0;
    for side in 0..4 {
        let c = &samples[element.edges[side] as usize * 4 * lanes..];
        let sum: f64 = (1..k).map(|i| c[i - 1] * c[lanes + i] - c[i] * c[lanes + i - 1]).sum();
        // Sides 2 and 3 run clockwise.
        twice += if element.flips[side] == (side < 2) { -sum } else { sum };
    }
    0.5 * twice
}

/// The aspect ratio to aim at where the present one is `ratio`.
fn tame(ratio: f64) -> f64 {
    if ratio > FREE_ASPECT {
        FREE_ASPECT * (ratio / FREE_ASPECT).sqrt()
    } else if ratio < 1.0 / FREE_ASPECT {
        1.0 / tame(1.0 / ratio)
    } else {
        ratio
    }
}
