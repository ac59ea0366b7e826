//! Several meshes of one domain, of which the best is kept: four for
//! [`Effort::Best`](crate::options::Effort::Best), else more than one only where the first has a poor element or
//! failed. What a mesh comes to hangs on decisions that are nearly ties; poor elements mostly on the layout, which
//! another field lays out anew, and on blocks that are too long for their bends.

use super::one_mesh;
use super::tighten::{Tolerances, DIVIDED};
use crate::domain::Domain;
use crate::error::{Error, Result};
use crate::mesh::{scaled_jacobian_ceiling, HighOrderMesh};
use crate::numerics::tolerances::ORDER_TIE;
use crate::options::{Effort, FieldMethod, Options};
use crate::progress::Progress;
use crate::stages::Stages;

/// Share of the domain's best possible scaled Jacobian below which an element is poor: 4 meshes of 538 have one.
const POOR: f64 = 0.6;
/// The same below which it is bad.
const BAD: f64 = 0.3;
/// Most times the elements of a fair mesh that one may have which was divided at the boundary.
const WORTH: f64 = 2.5;
/// Elements above which a mesh is kept for its poor element: another takes as long again.
const MOST_AGAIN: usize = 1500;

/// Size of blocks' elements before coarsening, relative to the usual one, for a start with finer blocks: a bend of many
/// short elements is smoothed where one of a few long ones folds.
const FINER_BLOCKS: f64 = 0.6;

/// How a mesh is begun.
#[derive(Debug, Clone, Copy)]
pub(super) struct Start {
    field: FieldMethod,
    /// Times that the base mesh is refined before anything is tried.
    pub finer: usize,
    /// Size of blocks' elements before coarsening, relative to the usual one.
    pub size: f64,
    /// Whether edges are divided at the boundary where another mesh would have them from the layout on.
    pub sooner: bool,
}

/// Starts that [`Effort::Best`] compares; what comes after them is for domains where none of them is good.
const COMPARED: usize = 4;

/// Starts tried: the field asked for and the other one, each with usual and with finer blocks; elements for fewer edges,
/// divided at the boundary; and both fields with finer blocks on the next finer base mesh.
fn starts(options: &Options) -> Vec<Start> {
    let other = match options.field {
        FieldMethod::Diffused => FieldMethod::Harmonic,
        FieldMethod::Harmonic => FieldMethod::Diffused,
    };
    let [own, other] =
        [options.field, other].map(|field| Start { field, finer: 0, size: 1.0, sooner: false });
    let finer_blocks = |start| Start { size: FINER_BLOCKS, ..start };
    let finer_base = |start| Start { finer: 1, ..finer_blocks(start) };
    let mut starts = vec![own, finer_blocks(own), other, finer_blocks(other), Start { sooner: true, ..own }];
    if options.base_triangulation.is_none() {
        starts.extend([own, other].map(finer_base));
    }
    starts
}

/// What meshes are compared by. Better is less, in this order; shapes that differ by rounding are equal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Rank {
    /// How far the poorest element is below what counts as bad.
    bad: i64,
    /// Symmetries of the domain that the mesh has not.
    missing: usize,
    /// How far the poorest element is below what counts as poor.
    poor: i64,
    elements: usize,
    shape: i64,
}

impl Rank {
    fn of(mesh: &HighOrderMesh, stages: &Stages) -> Self {
        let in_ties = |x: f64| (x / ORDER_TIE).round() as i64;
        let [least, ceiling] = shape(mesh, stages);
        Rank {
            bad: in_ties(BAD * ceiling - least).max(0),
            missing: stages.symmetry.map_or(0, |s| s.domain.order().saturating_sub(s.mesh.order())),
            poor: in_ties(POOR * ceiling - least).max(0),
            elements: mesh.elements.len(),
            shape: in_ties(-least),
        }
    }
}

/// A mesh of a start, its rank and what led to it.
struct Made {
    mesh: HighOrderMesh,
    rank: Rank,
    stages: Stages,
}

impl Made {
    /// Whether the poorest element is not bad.
    fn is_fair(&self) -> bool {
        self.rank.bad == 0
    }

    /// Whether no other start is worth its time.
    fn will_do(&self, effort: Effort) -> bool {
        // Where edges had to be divided at the boundary, another layout does not make their elements better.
        let divided = self.stages.rounds.iter().any(|round| round.action == DIVIDED);
        let enough = self.rank.poor == 0 || divided && self.is_fair();
        effort != Effort::Best && (enough || self.rank.elements > MOST_AGAIN)
    }
}

/// The least scaled Jacobian of a run's mesh, and the domain's best possible one. Where the rounds took samples, the
/// finished mesh was searched.
fn shape(mesh: &HighOrderMesh, stages: &Stages) -> [f64; 2] {
    let least = mesh.scaled_jacobian.iter().copied().fold(f64::INFINITY, f64::min);
    [least, stages.boundary.as_deref().map_or(1.0, scaled_jacobian_ceiling)]
}

/// Whether a start that divides edges sooner is another one than what led to `stages`.
fn is_another(options: &Options, stages: &Stages) -> bool {
    let tolerances =
        |sooner| stages.boundary.as_ref().and_then(|own| Tolerances::new(options, own, sooner).ok());
    tolerances(true).zip(tolerances(false)).is_some_and(|(own, before)| own.first != before.first)
}

/// The best mesh of the starts that the effort allows; `stages` has what led to it, and the seconds of all. Where no
/// start gives a mesh, what the first one left.
pub(super) fn best_of_starts(
    domain: &Domain,
    options: &Options,
    stages: &mut Stages,
) -> Result<HighOrderMesh> {
    let starts = starts(options);
    let count = if options.effort == Effort::Best { COMPARED as f64 } else { 1.0 };
    let mut best: Option<Made> = None;
    let mut failed: Option<(Error, Stages)> = None;
    let mut seconds = [0.0; 9];
    for (k, start) in starts.into_iter().enumerate() {
        if k >= COMPARED && best.as_ref().is_some_and(|best| best.rank.poor == 0) {
            break;
        }
        if start.sooner {
            let known = best.as_ref().map(|best| &best.stages).or(failed.as_ref().map(|failed| &failed.1));
            if !known.is_some_and(|stages| is_another(options, stages)) {
                continue;
            }
        }
        let whole = options.progress.clone();
        // Starts that nobody expected begin at the end.
        let share_of = move |share: f64| ((k as f64 + share) / count).min(1.0);
        let progress = Progress::new(move |stage, share| whole.report(stage, share_of(share)).is_ok());
        let mut own = Stages::default();
        let own_options = Options { field: start.field, progress, ..options.clone() };
        let made = one_mesh(domain, &own_options, start, &mut own);
        seconds.iter_mut().zip(own.seconds).for_each(|(all, own)| *all += own);
        match made {
            Ok(mesh) => {
                let rank = Rank::of(&mesh, &own);
                let better = best.as_ref().is_none_or(|best| {
                    let costs = rank.elements as f64 > WORTH * best.rank.elements as f64;
                    rank < best.rank && !(start.sooner && costs && best.is_fair())
                });
                if better {
                    best = Some(Made { mesh, rank, stages: own });
                }
            }
            Err(error) if error.ends_a_run() => {
                (best, failed) = (None, Some((error, own)));
                break;
            }
            Err(error) => {
                failed.get_or_insert((error, own));
            }
        }
        let enough = match &best {
            Some(best) => best.will_do(options.effort),
            // What two fields on four base meshes each did not make possible hardly is.
            None => options.effort != Effort::Best && k > 1,
        };
        if enough {
            break;
        }
    }
    let (result, own) = match (best, failed) {
        (Some(best), _) => (Ok(best.mesh), best.stages),
        (None, Some((error, own))) => (Err(error), own),
        (None, None) => (Err(Error::Cancelled), Stages::default()),
    };
    *stages = Stages { seconds, ..own };
    result
}
