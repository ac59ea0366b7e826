//! From inverted to valid: the regularised energy, made less regular step by step.
//!
//! Reference: V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray, D. Sokolov, *Foldover-free
//! maps in 50 lines of code*, ACM Transactions on Graphics 40(4), 2021 (the rule for ε).

use super::kernel::Measure;
use super::minimiser::{Lbfgs, Limits};
use super::optimiser::Schedule;
use super::problem::Problem;
use crate::numerics::tolerances::LEAST_JACOBIAN;

/// Least d/A at which a mesh counts as untangled: the shape energy takes over there.
const UNTANGLED: f64 = 1e-3;
/// Least d/A below which a round's progress is watched ...
const FAR: f64 = -0.5;
/// ... and the share of it by which progress may fall short of what the remaining rounds need.
const PATIENCE: f64 = 1.3;
/// Least decrease of the bound by round: elements thin at one end need a far smaller ε than the others.
const HURRY: f64 = 0.05;
/// Largest decrease that is forced.
const MOST_DECREASE: f64 = 0.9;
/// Step bound of the minimiser, in natural lengths.
const REACH: f64 = 1.0;

/// As many rounds and steps as the schedule allows; `true` when no sample is inverted any more. Adds to
/// `work`.
pub(super) fn untangle(
    problem: &mut Problem,
    lbfgs: &mut Lbfgs,
    schedule: &Schedule,
    work: &mut u64,
) -> bool {
    let (rounds, steps) = (schedule.untangle_rounds, schedule.untangle_steps);
    let mut least = problem.least_jacobian();
    let mut epsilon = 1.0f64;
    let mut first = least;
    for round in 0..rounds {
        if least > UNTANGLED {
            break;
        }
        let limits = Limits { steps, progress: 1e-3 };
        let [before, after] = problem.minimise(lbfgs, Measure::Regularised { epsilon }, REACH, limits, work);
        least = problem.least_jacobian();
        if !(before.is_finite() && after.is_finite()) {
            break;
        }
        // Far from valid and not getting there in time: what a merge inverts for good.
        if round == 0 {
            first = least;
        } else if !schedule.patient && round >= 2 && least < FAR {
            let rate = (least - first) / round as f64;
            if -least > PATIENCE * rate * (rounds - round - 1) as f64 {
                break;
            }
        }
        // The paper's rule: ε so small that the barrier χ stands just below the present least d.
        let share = (1.0 - after / before)
            .max(schedule.untangle_decrease.max(HURRY * round as f64).min(MOST_DECREASE));
        let chi = 0.5 * (least + (least * least + epsilon * epsilon).sqrt());
        let bound = (1.0 - share) * chi;
        epsilon = if least < bound { 2.0 * (bound * (bound - least)).sqrt() } else { 1e-9 };
    }
    least > LEAST_JACOBIAN
}
