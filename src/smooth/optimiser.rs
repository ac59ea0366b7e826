//! The one optimiser: untangles if it must, then raises the power of the shape energy.

use super::kernel::Measure;
use super::lift::lift;
use super::local::{few_of_many, untangle_locally, Elements, Saved};
use super::mend::mend;
use super::minimiser::{Lbfgs, Limits};
use super::problem::Problem;
use super::quality::{self, ElementQuality, Quality};
use super::reference::Reference;
use super::straight::untangle_straight;
use super::straightness::Straightness;
use super::untangle::untangle;
use crate::domain::Boundary;
use crate::mesh::{BoundaryError, BoundaryTolerance, QuadMesh};
use crate::numerics::tolerances::{DECISION_GRID, FINAL_GRID, LEAST_JACOBIAN, WHOLE_GRID};

/// How much work an optimisation may cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Care {
    /// For a trial that may be rolled back: valid and fair.
    Quick,
    /// For a mesh that is worked on. Here, too, straight interior edges away from curved boundaries stay straight:
    /// elements without curved edges cost a tenth.
    Full,
    /// For a mesh to be kept, from a valid one: the same on a finer grid, and all interior edges may bend.
    Final,
}

/// What an optimisation left.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome {
    /// No sample of the optimised elements is inverted.
    pub valid: bool,
    /// Least det J at the samples, divided by the element's area: how far an invalid result is from valid.
    pub least_jacobian: f64,
    /// Least scaled Jacobian of the optimised elements, by sampling.
    pub min_scaled_jacobian: f64,
    /// Largest error of the boundary edges that moved, divided by the tolerance.
    pub error_ratio: f64,
    /// Evaluations of elements, those of order 5 counting 1.
    pub work: u64,
    /// Quality of the optimised elements, in their order, and of the boundary edges on them.
    pub quality: Quality,
}

/// When a trial may end early, by what the optimiser's samples see.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Aim {
    /// A least scaled Jacobian that is, with the tolerance, well enough.
    pub enough: f64,
    /// Those that have to be reached by the first power, the second, the third: they bring most of what there
    /// is to gain.
    pub hopeless: [f64; 3],
    /// Inverted elements at the start up to which it is tried at all; up to twice as many if none is inverted by far.
    pub most_inverted: usize,
}

impl Aim {
    /// Nothing is given up.
    pub fn at(enough: f64) -> Self {
        Aim { enough, hopeless: [f64::NEG_INFINITY; 3], most_inverted: NO_LIMIT }
    }
}

/// More elements than any mesh has inverted, twice.
const NO_LIMIT: usize = usize::MAX / 2;
/// Scaled Jacobian below which elements are inverted by far: several of them mostly stay so.
const FAR_INVERTED: f64 = -0.8;

/// Step bound of the minimiser, in natural lengths.
const REACH: f64 = 0.5;

/// Extra rounds for boundary edges that are still above the tolerance.
const RESCUES: usize = 3;
/// Share of its energy that a round leaves when the power is worked off.
const WORKED_OFF: f64 = 0.9;
/// Weight of the mean scaled Jacobian against the least when rounds are compared.
const MEAN_WEIGHT: f64 = 0.2;
/// Work after which no further way of untangling is tried, and for improving.
pub(super) const MOST_WORK: u64 = 4_000_000;
/// Scaled Jacobian below which elements of a whole mesh are seen to first, with their surroundings only.
const POOR: f64 = 0.2;
/// Work after which that ends.
const MOST_POOR_WORK: u64 = 400_000;
/// Sweeps of the relaxation that restarts a hopeless mesh.
pub(super) const FLATTEN_SWEEPS: usize = 200;

/// What is done to an inverted mesh before it is untangled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Prepare {
    Nothing,
    /// Straight edges, vertices at the means of their neighbours.
    Flatten,
    /// The same with boundary vertices spread along their chains.
    Spread,
}

pub(super) struct Schedule {
    powers: &'static [u32],
    steps: usize,
    progress: f64,
    /// Most rounds of one power.
    repeats: usize,
    /// Ways to untangle, in turn until one works; `true`: boundary vertices slide.
    ways: &'static [(Prepare, bool)],
    pub untangle_rounds: usize,
    pub untangle_steps: usize,
    /// Least share by which untangling lowers its bound in a round: less is surer, more is faster.
    pub untangle_decrease: f64,
    /// Whether untangling goes on where it is slow: it mostly gets there.
    pub patient: bool,
    /// Spacing of the grid that unknowns stay on, in edge lengths.
    grid: f64,
}

/// Quads up to which an optimisation may take all its steps; on larger meshes steps are fewer, so that
/// the work grows no faster than the mesh.
const FULL_STEPS: usize = 1200;
/// How much cheaper an evaluation of straight-sided elements is: so much larger meshes may take all steps.
const CHEAPER: usize = 8;
/// Steps of an untangling round for them.
const STRAIGHT_STEPS: usize = 200;
/// Fewest steps of a round.
const LEAST_STEPS: usize = 12;

impl Care {
    /// The schedule for so many quads; plain ones count as the less that they cost.
    pub(super) fn schedule_for(self, quads: usize) -> Schedule {
        let schedule = self.schedule();
        let scaled = |steps: usize| (steps * FULL_STEPS / quads.max(FULL_STEPS)).max(LEAST_STEPS.min(steps));
        Schedule {
            steps: scaled(schedule.steps),
            untangle_steps: scaled(schedule.untangle_steps),
            untangle_rounds: scaled(schedule.untangle_rounds),
            ..schedule
        }
    }

    /// The schedule for so many straight-sided quads, which cost little: patient.
    pub(super) fn schedule_for_straight(self, quads: usize) -> Schedule {
        let plain = self.schedule();
        let scaled =
            (STRAIGHT_STEPS * FULL_STEPS * CHEAPER / quads.max(FULL_STEPS * CHEAPER)).max(LEAST_STEPS);
        Schedule { untangle_steps: scaled, untangle_rounds: plain.untangle_rounds, patient: true, ..plain }
    }

    fn schedule(self) -> Schedule {
        match self {
            Care::Quick => Schedule {
                powers: &[2, 8],
                steps: 20,
                progress: 1e-2,
                repeats: 1,
                ways: &[(Prepare::Nothing, true)],
                untangle_rounds: 3,
                untangle_steps: 25,
                untangle_decrease: 0.5,
                patient: false,
                grid: DECISION_GRID,
            },
            Care::Full | Care::Final => Schedule {
                powers: &[2, 4, 8, 8],
                steps: 60,
                progress: 1e-4,
                repeats: 6,
                // First with the boundary fixed: sliding vertices would rather pile up than let go.
                ways: &[
                    (Prepare::Nothing, false),
                    (Prepare::Nothing, true),
                    (Prepare::Flatten, false),
                    (Prepare::Nothing, true),
                    (Prepare::Spread, false),
                    (Prepare::Nothing, true),
                ],
                untangle_rounds: 20,
                untangle_steps: 50,
                untangle_decrease: 0.1,
                patient: false,
                grid: if self == Care::Final { FINAL_GRID } else { WHOLE_GRID },
            },
        }
    }
}

/// Where an optimisation arrived, as its own samples see it.
#[derive(Debug, Clone, Copy)]
struct State {
    valid: bool,
    least_jacobian: f64,
    error_ratio: f64,
}

impl State {
    fn of(problem: &mut Problem, valid: bool) -> Self {
        State { valid, least_jacobian: problem.least_jacobian(), error_ratio: problem.error_ratio }
    }
}

/// Optimises and measures meshes of one domain at one order.
#[derive(Debug, Clone)]
pub struct Optimiser<'a> {
    boundary: &'a Boundary,
    error: Option<BoundaryError>,
    /// Whether boundary vertices may move along their chains.
    slides: bool,
    linear: Reference,
    energy: Reference,
    dense: Reference,
    measuring: Reference,
    straightness: Straightness<'static>,
}

/// Curved elements, their boundary vertices fixed.
struct Curved<'a> {
    optimiser: &'a Optimiser<'a>,
    reference: &'a Reference,
    care: Care,
}

impl Elements for Curved<'_> {
    fn problem<'b>(&'b self, mesh: &QuadMesh, active: &[u32]) -> Problem<'b> {
        self.optimiser.problem(self.reference, mesh, Some(active), false, self.care)
    }

    fn schedule(&self, care: Care, quads: usize) -> Schedule {
        care.schedule_for(quads)
    }

    fn inverted(&self, mesh: &QuadMesh, quad: u32) -> bool {
        self.optimiser.element_quality(mesh, quad).jacobian_ratio <= LEAST_JACOBIAN
    }
}

impl<'a> Optimiser<'a> {
    /// For elements of order `order` (at least 1). With a tolerance, boundary edges that meet it keep
    /// meeting it, and others are drawn towards it.
    pub fn new(boundary: &'a Boundary, order: usize, tolerance: Option<BoundaryTolerance>) -> Self {
        let order = order.max(1);
        Optimiser {
            boundary,
            error: tolerance.map(BoundaryError::new),
            slides: true,
            linear: Reference::for_energy(1),
            energy: Reference::for_energy(order),
            dense: Reference::for_dense_energy(order),
            measuring: Reference::for_quality(order),
            straightness: Straightness::new(boundary),
        }
    }

    /// The same with all boundary vertices fixed, and so the edges' errors.
    pub fn with_fixed_boundary(self) -> Self {
        Optimiser { error: None, slides: false, ..self }
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
    pub fn optimise(&self, mesh: &mut QuadMesh, active: Option<&[u32]>, care: Care) -> Outcome {
        self.optimise_until(mesh, active, care, None)
    }

    /// The same, ending as soon as `aim` says so: for trials, of which most are clear early.
    pub fn optimise_until(
        &self,
        mesh: &mut QuadMesh,
        active: Option<&[u32]>,
        care: Care,
        aim: Option<Aim>,
    ) -> Outcome {
        let all: Vec<u32>;
        let own = match active {
            Some(list) => list,
            None => {
                all = (0..mesh.quads.len() as u32).collect();
                &all
            }
        };
        let before = Saved::of(mesh, own);
        let mut work = 0;
        let mut state = self.run(&self.energy, mesh, active, care, aim, &mut work);
        let mut quality = self.quality_of(mesh, active);
        if state.valid && !quality.valid() {
            // Inverted between the samples: denser ones.
            let inverted = self.inverted_among(mesh, own);
            if active.is_none() && few_of_many(inverted.len(), own.len()) {
                mend(self, mesh, &inverted, &|mesh, quads| self.inverted_among(mesh, quads), care, &mut work);
            } else {
                state = self.run(&self.dense, mesh, active, care, aim, &mut work);
            }
            quality = self.quality_of(mesh, active);
        }
        if !quality.valid() {
            // What was valid stays so.
            let after = Saved::of(mesh, own);
            before.restore(mesh);
            let held = self.quality_of(mesh, active);
            if held.valid() {
                state = State::of(&mut self.problem(&self.energy, mesh, active, true, care), true);
                quality = held;
            } else {
                after.restore(mesh);
            }
        }
        Outcome {
            valid: quality.valid(),
            least_jacobian: state.least_jacobian,
            min_scaled_jacobian: quality.min_scaled_jacobian,
            error_ratio: state.error_ratio,
            work,
            quality,
        }
    }

    /// Optimises around the elements whose scaled Jacobian is below `floor`, each group with some rings by
    /// itself, as often as that helps: one poor place needs steps that all others would waste. What gets worse is
    /// undone. The work spent.
    pub fn lift(&self, mesh: &mut QuadMesh, floor: f64) -> u64 {
        lift(self, mesh, floor, Care::Final, MOST_WORK)
    }

    /// Optimises around the quads `refused` with denser samples, each group with some rings by itself, until `refuses`
    /// lists none of them any more; what does not help is undone. The quads that are left, and the work spent.
    pub fn mend(
        &self,
        mesh: &mut QuadMesh,
        refused: &[u32],
        refuses: &dyn Fn(&QuadMesh, &[u32]) -> Vec<u32>,
    ) -> (Vec<u32>, u64) {
        let mut work = 0;
        let left = mend(self, mesh, refused, refuses, Care::Final, &mut work);
        (left, work)
    }

    /// Those of `quads` that have an inverted sample.
    fn inverted_among(&self, mesh: &QuadMesh, quads: &[u32]) -> Vec<u32> {
        quads
            .iter()
            .copied()
            .filter(|q| self.element_quality(mesh, *q).jacobian_ratio <= LEAST_JACOBIAN)
            .collect()
    }

    /// The quads `active` of `mesh` untangled if need be, and improved, with dense samples.
    pub(super) fn run_dense(&self, mesh: &mut QuadMesh, active: &[u32], care: Care, work: &mut u64) {
        self.run(&self.dense, mesh, Some(active), care, None, work);
    }

    /// `mesh` as a function of what may move.
    pub(super) fn problem<'b>(
        &'b self,
        reference: &'b Reference,
        mesh: &QuadMesh,
        active: Option<&[u32]>,
        slide: bool,
        care: Care,
    ) -> Problem<'b> {
        let tolerance = self.error.as_ref();
        let straightness = match care {
            Care::Quick | Care::Full => &self.straightness,
            Care::Final => &self.straightness.everywhere(),
        };
        let slide = slide && self.slides;
        Problem::new(self.boundary, reference, tolerance, mesh, active, slide, straightness)
    }

    /// Untangles if need be, then improves.
    fn run(
        &self,
        reference: &Reference,
        mesh: &mut QuadMesh,
        active: Option<&[u32]>,
        care: Care,
        aim: Option<Aim>,
        work: &mut u64,
    ) -> State {
        let mut lbfgs = Lbfgs::default();
        let mut problem = self.problem(reference, mesh, active, true, care);
        let schedule = care.schedule_for(problem.cost(1) as usize);
        if aim.is_some_and(|aim| {
            let most = if problem.scaled_jacobian < FAR_INVERTED { 1 } else { 2 } * aim.most_inverted;
            problem.inverted > most
        }) {
            return State::of(&mut problem, false);
        }
        let mut valid = problem.least_jacobian() > LEAST_JACOBIAN;
        let mut few = false;
        if !valid && active.is_none() {
            untangle_straight(self.boundary, &self.linear, &self.straightness, mesh, care, work);
            let left = untangle_locally(&Curved { optimiser: self, reference, care }, mesh, care, work);
            few = few_of_many(left, mesh.quads.len());
            problem = self.problem(reference, mesh, active, true, care);
            valid = problem.least_jacobian() > LEAST_JACOBIAN;
        }
        if !valid && !few {
            for (prepare, slide) in schedule.ways.iter().copied() {
                if *work > MOST_WORK {
                    break;
                }
                // Boundary vertices are only prepared where they can slide.
                problem = self.problem(reference, mesh, active, slide || prepare == Prepare::Spread, care);
                match prepare {
                    Prepare::Nothing => {}
                    Prepare::Flatten => problem.flatten(FLATTEN_SWEEPS),
                    Prepare::Spread => {
                        problem.spread();
                        problem.flatten(FLATTEN_SWEEPS);
                        if !slide {
                            problem.store(mesh);
                            problem = self.problem(reference, mesh, active, false, care);
                        }
                    }
                }
                valid = untangle(&mut problem, &mut lbfgs, &schedule, work);
                problem.store(mesh);
                if valid {
                    break;
                }
            }
            problem = self.problem(reference, mesh, active, true, care);
            valid = problem.least_jacobian() > LEAST_JACOBIAN;
        }
        if valid && active.is_none() && problem.scaled_jacobian < POOR {
            // One element that is hardly valid would stop all others: its energy outweighs theirs.
            problem.store(mesh);
            *work += lift(self, mesh, POOR, care, MOST_POOR_WORK);
            problem = self.problem(reference, mesh, active, true, care);
        }
        if valid {
            problem.grid = schedule.grid;
            self.improve(&mut problem, &mut lbfgs, &schedule, aim, work);
        }
        problem.store(mesh);
        State::of(&mut problem, valid)
    }

    /// Raises the power of the shape energy from a valid state. What comes out keeps the tolerance if
    /// the start or any round did, and has the best quality among those that do.
    fn improve(
        &self,
        problem: &mut Problem,
        lbfgs: &mut Lbfgs,
        schedule: &Schedule,
        aim: Option<Aim>,
        work: &mut u64,
    ) {
        // Better: closer to the tolerance while above it, then the quality.
        let rank =
            |p: &Problem| (p.error_ratio.max(1.0), -p.scaled_jacobian - MEAN_WEIGHT * p.mean_scaled_jacobian);
        let mut best = (rank(problem), problem.unknowns.clone());
        let start = *work;
        let limits = Limits { steps: schedule.steps, progress: schedule.progress };
        let rescue = std::iter::repeat_n(&8, RESCUES);
        'powers: for (round, power) in schedule.powers.iter().chain(rescue).enumerate() {
            if round >= schedule.powers.len() && problem.error_ratio <= 1.0 {
                break;
            }
            // A power is worked off before the next, or its worst elements hide all others.
            for _ in 0..schedule.repeats {
                if *work > start + MOST_WORK {
                    break;
                }
                let [before, after] = problem.minimise(lbfgs, Measure::Shape(*power), REACH, limits, work);
                problem.refresh();
                let now = rank(problem);
                if now < best.0 {
                    best.0 = now;
                    best.1.clone_from(&problem.unknowns);
                }
                if aim.is_some_and(|aim| problem.error_ratio <= 1.0 && problem.scaled_jacobian >= aim.enough)
                {
                    break 'powers;
                }
                if after > WORKED_OFF * before {
                    break;
                }
            }
            let needed = aim.and_then(|aim| aim.hopeless.get(round).copied());
            if needed.is_some_and(|needed| problem.scaled_jacobian < needed) {
                break;
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
        quality::element(self.boundary, &self.measuring, &self.straightness, mesh, quad)
    }

    /// Error of an edge divided by the tolerance; 0 inside or without a tolerance.
    pub fn error_ratio(&self, mesh: &QuadMesh, edge: u32) -> f64 {
        match (&self.error, mesh.edges[edge as usize].span) {
            (Some(error), Some(span)) => error.ratio(self.boundary, span),
            _ => 0.0,
        }
    }
}
