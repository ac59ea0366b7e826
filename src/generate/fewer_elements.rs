//! After step 9: coarsened as far as validity, tolerance, quality and sizes allow, then smoothed for good.

use super::rounds::{note, TOO_LARGE};
use super::watch::Watch;
use crate::error::Result;
use crate::mesh::QuadMesh;
use crate::options::Effort;
use crate::progress::Stage;
use crate::refine::{self, Limits, Reach, Refusals, SizeLimit};
use crate::smooth::{Care, Optimiser};
use crate::stages::Stages;

/// Quads above which a few elements that smoothing made worse are seen to before its result is judged.
const MANY: usize = 10_000;

/// Times that a mesh is coarsened at most: once smoothed as a whole it may allow what it did not before. A third time
/// brings nothing.
const PASSES: usize = 2;
/// Quads above which a mesh is coarsened once only: again takes as long as the first time and brings a percent.
const MOST_AGAIN: usize = 1500;

/// `mesh`, which is valid, with as few elements as keep the scaled Jacobian at `floor` and the sizes within `limit`.
pub(super) fn fewer_elements(
    mut mesh: QuadMesh,
    optimiser: &Optimiser,
    floor: f64,
    limit: Option<SizeLimit>,
    effort: Effort,
    watch: &mut Watch,
    stages: &mut Stages,
) -> Result<QuadMesh> {
    let limits = Limits { sizes: limit, ..Limits::new(floor) };
    let mut refusals = Refusals::default();
    let (passes, reach) = if effort == Effort::Fast { (1, Reach::Near) } else { (PASSES, Reach::Far) };
    for pass in 0..passes {
        if pass > 0 && mesh.quads.len() > MOST_AGAIN {
            break;
        }
        let progress = watch.coarsening();
        let fewer = watch.run(stages, Stage::Refine, |_| {
            refine::coarsen(mesh.clone(), optimiser, limits, reach, &mut refusals, &progress)
        })?;
        if pass > 0 && fewer.quads.len() == mesh.quads.len() {
            break;
        }
        mesh = fewer;
        note(stages, optimiser, &mesh, "coarsen");
        mesh = smoothed(mesh, optimiser, limits, watch, stages)?;
    }
    Ok(mesh)
}

/// `mesh` with its poor places seen to and then smoothed as a whole, as far as nothing that holds is lost.
fn smoothed(
    mut mesh: QuadMesh,
    optimiser: &Optimiser,
    limits: Limits,
    watch: &mut Watch,
    stages: &mut Stages,
) -> Result<QuadMesh> {
    let mut before = optimiser.quality(&mesh);
    if before.min_scaled_jacobian < limits.scaled_jacobian {
        watch.work +=
            watch.run(stages, Stage::Smooth, |_| Ok(optimiser.lift(&mut mesh, limits.scaled_jacobian)))?;
        note(stages, optimiser, &mesh, "lift");
        before = optimiser.quality(&mesh);
    }
    let mut smoother = mesh.clone();
    watch.run(stages, Stage::Smooth, |_| Ok(optimiser.optimise(&mut smoother, None, Care::Final)))?;
    let mut after = optimiser.quality(&smoother);
    if smoother.quads.len() > MANY && after.min_scaled_jacobian < before.min_scaled_jacobian {
        // A few elements may not decide for all.
        watch.work += watch
            .run(stages, Stage::Smooth, |_| Ok(optimiser.lift(&mut smoother, before.min_scaled_jacobian)))?;
        after = optimiser.quality(&smoother);
    }
    let too_large =
        |mesh: &QuadMesh| limits.sizes.is_some_and(|sizes| sizes.too_long(mesh, TOO_LARGE).contains(&true));
    if after.valid()
        && after.error_ratio <= before.error_ratio.max(1.0)
        && after.min_scaled_jacobian >= before.min_scaled_jacobian
        && (!too_large(&smoother) || too_large(&mesh))
    {
        mesh = smoother;
        note(stages, optimiser, &mesh, "smooth");
    }
    Ok(mesh)
}
