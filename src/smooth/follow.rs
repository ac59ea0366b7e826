//! A valid mesh whose vertices and edges move so that its elements follow waves best.
//!
//! Shape energies make angles right and leave sizes alone. A solver's error depends on what an element's map makes of
//! the solution: it is held by the largest elements, and by those whose sides run unevenly. Both get even here, with as
//! many elements as before: the sum of the squared errors of waves is minimised, with no angle and size beyond what is
//! asked for.

use super::kernel::Measure;
use super::minimiser::{Lbfgs, Limits};
use super::problem::{Demands, Problem, MORE_SAMPLES};
use super::reference::Reference;
use super::straightness::Straightness;
use super::Optimiser;
use crate::mesh::QuadMesh;
use crate::numerics::tolerances::ON_BREAK;

/// Minimisations, each with the areas and aspect ratios that the one before left.
const ROUNDS: usize = 4;
/// Iterations of one, fewer on meshes of more than so many quads, ...
const STEPS: usize = 60;
const FULL_STEPS: usize = 100;
const LEAST_STEPS: usize = 15;
/// ... and the share of the value below which five together are the last.
const PROGRESS: f64 = 2e-4;
/// Longest move in one step, in edge lengths.
const REACH: f64 = 0.2;
/// What the scaled Jacobian and the size are aimed at before their limits: the minimum is a little beyond.
const ANGLE_AIM: f64 = 0.02;
const SIZE_AIM: f64 = 0.997;
/// Shares of the way to the minimum that are tried until everything holds.
const SHARES: [f64; 5] = [1.0, 0.8, 0.6, 0.4, 0.2];
/// Grid on which unknowns stay, in edge lengths: the errors of waves feel much less than a final shape does.
const GRID: f64 = 1.0 / 67_108_864.0;
/// Highest order whose samples the optimiser's lanes hold.
const HIGHEST_ORDER: usize = 13;
/// Least ratio of smallest to largest Jacobian inside an element.
const JACOBIAN_RATIO: f64 = 0.05;

impl Optimiser<'_> {
    /// Moves `mesh`, which is valid, so that its elements follow waves of `wave_number` better. The scaled Jacobian
    /// stays at least `floor`, or what it was, mean lengths of opposite sides at most `size` as `holds` measures
    /// them, vertices at breaks of the boundary stay there. Whether anything moved.
    pub fn follow(
        &self,
        mesh: &mut QuadMesh,
        wave_number: f64,
        floor: f64,
        size: f64,
        holds: &dyn Fn(&QuadMesh) -> bool,
    ) -> bool {
        let order = self.order();
        if !(2..=HIGHEST_ORDER).contains(&order) {
            return false;
        }
        let before = self.quality(mesh);
        let floor = floor.min(before.min_scaled_jacobian);
        let reference = Reference::for_waves(order, order + MORE_SAMPLES);
        let boundary = self.boundary();
        let straightness = Straightness::new(boundary);
        let everywhere = straightness.everywhere();
        let mut problem =
            Problem::new(boundary, &reference, self.boundary_error(), mesh, None, true, &everywhere);
        problem.grid = GRID;
        let at_break = |chain: u32, s: f64| {
            let chain = &boundary.chains[chain as usize];
            let s = chain.wrap(s);
            // A closed chain with breaks has one at its seam.
            let seam = (chain.ends.is_none() && !chain.breaks.is_empty()).then_some([0.0, chain.length]);
            chain.breaks.iter().chain(seam.iter().flatten()).any(|b| (b - s).abs() <= ON_BREAK)
        };
        let pinned = problem.sliding(&at_break);
        let demands = Demands { scaled_jacobian: floor + ANGLE_AIM, size: SIZE_AIM * size };
        problem.follow(wave_number, demands, pinned);
        let start = problem.unknowns.clone();
        let steps = (STEPS * FULL_STEPS / mesh.quads.len().max(FULL_STEPS)).max(LEAST_STEPS);
        let limits = Limits { steps, progress: PROGRESS };
        let (mut lbfgs, mut work) = (Lbfgs::default(), 0);
        for _ in 0..ROUNDS {
            problem.minimise(&mut lbfgs, Measure::Shape(2), REACH, limits, &mut work);
            problem.refresh();
        }
        let end = problem.unknowns.clone();
        for share in SHARES {
            let between = start.iter().zip(&end).map(|(a, b)| a + share * (b - a));
            problem.unknowns = between.collect();
            let mut moved = mesh.clone();
            problem.store(&mut moved);
            let after = self.quality(&moved);
            if after.valid()
                && after.min_scaled_jacobian >= floor
                && after.min_jacobian_ratio >= before.min_jacobian_ratio.min(JACOBIAN_RATIO)
                && after.error_ratio <= before.error_ratio.max(1.0)
                && holds(&moved)
            {
                *mesh = moved;
                return true;
            }
        }
        false
    }
}
