//! Tolerances that take many more edges than the shape does: met by division of a mesh that keeps a looser one.

use super::aim;
use super::fewer_elements::{fewer_elements, Search};
use super::rounds::note;
use super::watch::Watch;
use crate::base_mesh::ElementSize;
use crate::domain::Boundary;
use crate::error::Result;
use crate::mesh::{scaled_jacobian_ceiling, BoundaryError, BoundaryTolerance, QuadMesh};
use crate::options::{Effort, Options, Subdivision};
use crate::progress::Stage;
use crate::refine::{divide_to_tolerance, tolerance_steps, SizeLimit};
use crate::smooth::Optimiser;
use crate::stages::Stages;

/// What division for a tolerance is called in [`Round::action`](crate::stages::Round::action).
pub(super) const TIGHTEN: &str = "tighten";

/// Times that a divided mesh is coarsened at most: the limit of the work ends the first ones.
const PASSES: usize = 4;
/// Quads above which it is coarsened once only.
const MOST_AGAIN: usize = 10_000;
/// Quads above which it is not coarsened at all: the limit of the work ends before one in twenty is gone.
const MOST_COARSENED: usize = 25_000;

/// The tolerances that a mesh keeps one after the other, each a multiple of the next.
pub(super) struct Tolerances {
    steps: Vec<BoundaryTolerance>,
}

impl Tolerances {
    /// # Errors
    /// [`Error::Tolerance`](crate::error::Error::Tolerance) where an edge of no length would not keep it.
    pub fn new(options: &Options, boundary: &Boundary) -> Result<Self> {
        let asked = BoundaryTolerance::new(options, boundary);
        let steps = match options.subdivision {
            Subdivision::EqualError => tolerance_steps(boundary, &asked)?,
            // The paper's rule divides from the layout on.
            Subdivision::Halving => vec![asked],
        };
        Ok(Tolerances { steps })
    }

    /// The one that blocks and elements are made for.
    pub fn first(&self) -> &BoundaryTolerance {
        &self.steps[0]
    }

    /// The one that was asked for.
    pub fn asked(&self) -> &BoundaryTolerance {
        &self.steps[self.steps.len() - 1]
    }
}

/// `mesh`, which keeps the first tolerance, divided until it keeps the one asked for, and coarsened within `sizes`;
/// without them (it has symmetries to lose) it is only divided.
pub(super) fn tightened(
    mesh: &QuadMesh,
    boundary: &Boundary,
    options: &Options,
    tolerances: &Tolerances,
    sizes: Option<&ElementSize>,
    watch: &mut Watch,
    stages: &mut Stages,
) -> Result<QuadMesh> {
    let mut finer = mesh.clone();
    let floor = options.quality_floor * scaled_jacobian_ceiling(boundary);
    let allowed = |p| sizes.map_or(f64::INFINITY, |sizes| sizes.allowed(p));
    // One size for all divides the finished mesh.
    let limit = options.element_size.as_ref().map(|_| SizeLimit::new(&allowed));
    for step in &tolerances.steps[1..] {
        let aim = aim(step);
        let optimiser = Optimiser::new(boundary, options.order, Some(aim));
        let error = BoundaryError::new(aim);
        finer = watch.run(stages, Stage::Refine, |_| {
            divide_to_tolerance(finer, boundary, &error, options.order, options.max_elements)
        })?;
        note(stages, &optimiser, &finer, TIGHTEN);
        if sizes.is_some() && finer.quads.len() <= MOST_COARSENED {
            let effort = if step == tolerances.asked() { options.effort } else { Effort::Fast };
            let search = Search { effort, most_again: MOST_AGAIN, passes: PASSES };
            finer = fewer_elements(finer, &optimiser, floor, limit, search, watch, stages)?;
        }
    }
    Ok(finer)
}
