//! The one optimiser: untangles if it must, then raises the power of the shape energy.

use super::kernel::Measure;
use super::local::untangle_locally;
use super::minimiser::{Lbfgs, Limits};
use super::problem::Problem;
use super::quality::{self, ElementQuality, Quality};
use super::reference::Reference;
use super::untangle::untangle;
use crate::domain::Boundary;
use crate::mesh::{BoundaryError, BoundaryTolerance, QuadMesh};

/// How much work an optimisation may cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// For a trial that may be rolled back: valid and fair.
    Quick,
    /// For a mesh to be kept.
    Full,
}

/// What an optimisation left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outcome {
    /// No sample of the optimised elements is inverted.
    pub valid: bool,
    /// Least det J at the samples, divided by the element's area: how far an invalid result is from valid.
    pub least_jacobian: f64,
    /// Least scaled Jacobian of the optimised elements, by sampling.
    pub min_scaled_jacobian: f64,
    /// Largest error of the boundary edges that moved, divided by the tolerance.
    pub error_ratio: f64,
    /// Energy evaluations used.
    pub evaluations: usize,
}

/// Step bound of the minimiser, in natural lengths.
const REACH: f64 = 0.5;

/// Extra rounds for boundary edges that are still above the tolerance.
const RESCUES: usize = 3;
/// Sweeps of the relaxation that restarts a hopeless mesh.
const FLATTEN_SWEEPS: usize = 200;

pub(super) struct Schedule {
    powers: &'static [u32],
    steps: usize,
    progress: f64,
    pub untangle_rounds: usize,
    pub untangle_steps: usize,
}

/// Quads up to which an optimisation may take all its steps; on larger meshes steps are fewer, so that
/// the work grows no faster than the mesh.
const FULL_STEPS: usize = 1200;
/// Fewest steps of a round.
const LEAST_STEPS: usize = 12;

impl Effort {
    /// The schedule for so many quads.
    fn schedule_for(self, quads: usize) -> Schedule {
        let schedule = self.schedule();
        let scaled = |steps: usize| (steps * FULL_STEPS / quads.max(FULL_STEPS)).max(LEAST_STEPS.min(steps));
        Schedule {
            steps: scaled(schedule.steps),
            untangle_steps: scaled(schedule.untangle_steps),
            untangle_rounds: scaled(schedule.untangle_rounds),
            ..schedule
        }
    }

    fn schedule(self) -> Schedule {
        match self {
            Effort::Quick => Schedule {
                powers: &[2, 8],
                steps: 20,
                progress: 1e-2,
                untangle_rounds: 6,
                untangle_steps: 25,
            },
            Effort::Full => Schedule {
                powers: &[2, 4, 8, 8],
                steps: 60,
                progress: 1e-4,
                untangle_rounds: 20,
                untangle_steps: 50,
            },
        }
    }
}

/// Optimises and measures meshes of one domain at one order.
#[derive(Debug, Clone)]
pub struct Optimiser<'a> {
    boundary: &'a Boundary,
    error: Option<BoundaryError>,
    energy: Reference,
    measuring: Reference,
}

impl<'a> Optimiser<'a> {
    /// For elements of order `order` (at least 1). With a tolerance, boundary edges that meet it keep
    /// meeting it, and others are drawn towards it.
    pub fn new(boundary: &'a Boundary, order: usize, tolerance: Option<BoundaryTolerance>) -> Self {
        let order = order.max(1);
        Optimiser {
            boundary,
            error: tolerance.map(BoundaryError::new),
            energy: Reference::for_energy(order),
            measuring: Reference::for_quality(order),
        }
    }

    /// The domain's boundary.
    pub fn boundary(&self) -> &'a Boundary {
        self.boundary
    }

    /// The boundary tolerance.
    pub fn tolerance(&self) -> Option<BoundaryTolerance> {
        self.error.as_ref().map(|e| e.tolerance)
    }

    /// What measures boundary edges against it.
    pub fn boundary_error(&self) -> Option<&BoundaryError> {
        self.error.as_ref()
    }

    /// The polynomial order N.
    pub fn order(&self) -> usize {
        self.energy.order
    }

    /// Optimises `mesh` in place: all of it, or the quads `active`, whose vertices and edges move unless
    /// a quad outside shares them. Once all samples are positive they stay so. If nothing valid is
    /// found the mesh is left at the last try.
    pub fn optimise(&self, mesh: &mut QuadMesh, active: Option<&[u32]>, effort: Effort) -> Outcome {
        let schedule = effort.schedule_for(active.map_or(mesh.quads.len(), <[u32]>::len));
        let mut lbfgs = Lbfgs::default();
        let mut evaluations = 0;
        let new = |mesh: &QuadMesh, slide| self.problem(mesh, active, slide);
        let mut problem = new(mesh, true);
        let mut valid = problem.least_jacobian() > 0.0;
        if !valid && active.is_none() {
            untangle_locally(self, mesh, &schedule, &mut evaluations);
            problem = new(mesh, true);
            valid = problem.least_jacobian() > 0.0;
        }
        if !valid {
            // First with the boundary fixed: sliding vertices would rather pile up than let go. If
            // both fail, the start was worthless: the same from straight edges and mean positions.
            let ways: &[(bool, bool)] = match effort {
                Effort::Quick => &[(true, false)],
                Effort::Full => &[(false, false), (true, false), (false, true), (true, false)],
            };
            for (slide, flatten) in ways.iter().copied() {
                problem = new(mesh, slide);
                if flatten {
                    problem.flatten(FLATTEN_SWEEPS);
                }
                let (rounds, steps) = (schedule.untangle_rounds, schedule.untangle_steps);
                valid = untangle(&mut problem, &mut lbfgs, rounds, steps, &mut evaluations);
                problem.store(mesh);
                if valid {
                    break;
                }
            }
            problem = new(mesh, true);
            valid = problem.least_jacobian() > 0.0;
        }
        if valid {
            self.improve(&mut problem, &mut lbfgs, &schedule, &mut evaluations);
        }
        let error_ratio = problem.error_ratio;
        let least_jacobian = problem.least_jacobian();
        problem.store(mesh);
        let quality = self.quality_of(mesh, active);
        Outcome {
            valid: valid && quality.valid(),
            least_jacobian,
            min_scaled_jacobian: quality.min_scaled_jacobian,
            error_ratio,
            evaluations,
        }
    }

    /// `mesh` as a function of what may move.
    pub(super) fn problem(&self, mesh: &QuadMesh, active: Option<&[u32]>, slide: bool) -> Problem<'_> {
        Problem::new(self.boundary, &self.energy, self.error.as_ref(), mesh, active, slide)
    }

    /// Raises the power of the shape energy from a valid state. What comes out keeps the tolerance if
    /// the start or any round did, and has the best scaled Jacobian among those that do.
    fn improve(
        &self,
        problem: &mut Problem,
        lbfgs: &mut Lbfgs,
        schedule: &Schedule,
        evaluations: &mut usize,
    ) {
        // Better: closer to the tolerance while above it, then the scaled Jacobian.
        let rank = |p: &Problem| (p.error_ratio.max(1.0), -p.scaled_jacobian);
        let mut best = (rank(problem), problem.unknowns.clone());
        let limits = Limits { steps: schedule.steps, progress: schedule.progress };
        let rescue = std::iter::repeat_n(&8, RESCUES);
        for (round, power) in schedule.powers.iter().chain(rescue).enumerate() {
            if round >= schedule.powers.len() && problem.error_ratio <= 1.0 {
                break;
            }
            problem.measure = Measure::Shape(*power);
            let mut x = std::mem::take(&mut problem.unknowns);
            let metric = std::mem::take(&mut problem.metric);
            *evaluations += lbfgs.minimise(problem, &mut x, &metric, REACH, limits).evaluations;
            (problem.unknowns, problem.metric) = (x, metric);
            problem.refresh();
            let now = rank(problem);
            if now < best.0 {
                best.0 = now;
                best.1.clone_from(&problem.unknowns);
            }
        }
        if best.0 < rank(problem) {
            problem.unknowns = best.1;
            problem.refresh();
        }
    }

    /// Quality of the whole mesh.
    pub fn quality(&self, mesh: &QuadMesh) -> Quality {
        self.quality_of(mesh, None)
    }

    /// Quality of the quads `of` (all if `None`) and the boundary edges on them.
    pub fn quality_of(&self, mesh: &QuadMesh, of: Option<&[u32]>) -> Quality {
        let mut elements = Vec::new();
        let mut error = 0.0f64;
        let mut add = |q: u32| {
            elements.push(self.element_quality(mesh, q));
            for e in mesh.quad_edges[q as usize] {
                error = error.max(self.error_ratio(mesh, e));
            }
        };
        match of {
            Some(list) => list.iter().for_each(|q| add(*q)),
            None => (0..mesh.quads.len() as u32).for_each(add),
        }
        Quality::new(elements, error)
    }

    /// Quality of one quad.
    pub fn element_quality(&self, mesh: &QuadMesh, quad: u32) -> ElementQuality {
        quality::element(self.boundary, &self.measuring, mesh, quad)
    }

    /// Error of an edge divided by the tolerance; 0 inside or without a tolerance.
    pub fn error_ratio(&self, mesh: &QuadMesh, edge: u32) -> f64 {
        match (&self.error, mesh.edges[edge as usize].span) {
            (Some(error), Some(span)) => error.ratio(self.boundary, span),
            _ => 0.0,
        }
    }
}
