//! Tolerances that take many more edges than the shape does: met by division, at the boundary only, of a mesh that
//! keeps a looser one.

use super::aim;
use super::rounds::note;
use super::watch::Watch;
use crate::domain::Boundary;
use crate::error::{Error, Result};
use crate::mesh::{scaled_jacobian_ceiling, BoundaryError, BoundaryTolerance, QuadMesh};
use crate::options::{Options, Subdivision};
use crate::progress::Stage;
use crate::refine::{divide_boundary, divide_wide, first_tolerance, layered};
use crate::smooth::{Care, Optimiser};
use crate::stages::Stages;

/// What a division is called in [`Round::action`](crate::stages::Round::action).
pub(super) const DIVIDED: &str = "tighten";

/// Divisions in three after which an edge is shorter than any that makes sense.
const MOST_DIVISIONS: usize = 30;
/// Share of a stretch's edges to be divided above which a row comes first, so that no vertex gets many elements.
const MANY: f64 = 0.3;
/// Share of the best possible scaled Jacobian below which elements are seen to at last.
const POOR: f64 = 0.65;

/// What a mesh keeps first, and what was asked for.
pub(super) struct Tolerances {
    /// The one that blocks and elements are made for.
    pub first: BoundaryTolerance,
    pub asked: BoundaryTolerance,
}

impl Tolerances {
    /// `sooner` as for [`first_tolerance`].
    ///
    /// # Errors
    /// [`Error::Tolerance`] where an edge of no length would not keep it.
    pub fn new(options: &Options, boundary: &Boundary, sooner: bool) -> Result<Self> {
        let asked = BoundaryTolerance::new(options, boundary);
        let first = match options.subdivision {
            Subdivision::EqualError => first_tolerance(boundary, &asked, sooner)?,
            // The paper's rule divides from the layout on.
            Subdivision::Halving => asked,
        };
        Ok(Tolerances { first, asked })
    }
}

/// `mesh`, which keeps the first tolerance, divided at the boundary until it keeps the one asked for. `even` as for
/// [`divide_boundary`].
pub(super) fn tightened(
    mesh: &QuadMesh,
    boundary: &Boundary,
    options: &Options,
    tolerances: &Tolerances,
    even: bool,
    watch: &mut Watch,
    stages: &mut Stages,
) -> Result<QuadMesh> {
    let mut finer = mesh.clone();
    if tolerances.first == tolerances.asked {
        return Ok(finer);
    }
    let order = options.order;
    let aim = aim(&tolerances.asked);
    let error = BoundaryError::new(aim);
    let optimiser = Optimiser::new(boundary, order, Some(aim));
    // Where the parts of edges end is known before: they stay there until all are made.
    let fixed = Optimiser::new(boundary, order, None).with_fixed_boundary();
    finer = watch.run(stages, Stage::Refine, |_| divide_wide(finer, boundary, &error, order))?;
    for division in 0..MOST_DIVISIONS {
        let share = if division == 0 { 0.0 } else { MANY };
        let before = finer.quads.len();
        finer = watch.run(stages, Stage::Refine, |_| layered(&finer, boundary, &error, share, order))?;
        if finer.quads.len() > before {
            note(stages, &optimiser, &finer, "row");
            watch.run(stages, Stage::Smooth, |_| Ok(fixed.optimise(&mut finer, None, Care::Quick)))?;
        }
        let divide = |_: &mut Stages| divide_boundary(&finer, boundary, &error, even, order);
        let Some(next) = watch.run(stages, Stage::Refine, divide)? else { break };
        finer = next;
        note(stages, &optimiser, &finer, DIVIDED);
        if finer.quads.len() > options.max_elements {
            return Err(refusal(&finer, &error, boundary));
        }
        watch.run(stages, Stage::Smooth, |_| Ok(fixed.optimise(&mut finer, None, Care::Quick)))?;
    }
    let poor = POOR * scaled_jacobian_ceiling(boundary);
    watch.run(stages, Stage::Smooth, |_| Ok(fixed.lift(&mut finer, poor)))?;
    watch.run(stages, Stage::Smooth, |_| Ok(optimiser.optimise(&mut finer, None, Care::Final)))?;
    note(stages, &optimiser, &finer, "smooth");
    Ok(finer)
}

/// That the elements allowed are too few, at the worst edge of `mesh`.
fn refusal(mesh: &QuadMesh, error: &BoundaryError, boundary: &Boundary) -> Error {
    let ratio = |e: &usize| mesh.edges[*e].span.map_or(0.0, |span| error.ratio(boundary, span));
    let worst = (0..mesh.edges.len()).max_by(|a, b| ratio(a).total_cmp(&ratio(b))).unwrap_or(0);
    Error::Tolerance {
        error: ratio(&worst) * error.tolerance.value,
        tolerance: error.tolerance.value,
        at: mesh.edge_middle(boundary, worst),
    }
}
