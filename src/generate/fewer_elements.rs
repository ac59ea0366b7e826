//! After step 9: coarsened as far as validity, tolerance, quality and sizes allow, then smoothed for good.

use super::rounds::{note, TOO_LARGE};
use super::watch::Watch;
use crate::error::Result;
use crate::mesh::QuadMesh;
use crate::progress::Stage;
use crate::refine::{self, Limits, SizeLimit};
use crate::smooth::{Effort, Optimiser};
use crate::stages::Stages;

/// `mesh`, which is valid, with as few elements as keep the scaled Jacobian at `floor` and the sizes within `limit`.
pub(super) fn fewer_elements(
    mesh: QuadMesh,
    optimiser: &Optimiser,
    floor: f64,
    limit: Option<SizeLimit>,
    watch: &mut Watch,
    stages: &mut Stages,
) -> Result<QuadMesh> {
    let boundary = optimiser.boundary();
    let limits = Limits { sizes: limit, ..Limits::new(floor) };
    let progress = watch.coarsening();
    let mut mesh = watch
        .run(stages, Stage::Refine, |_| refine::coarsen(mesh, boundary, optimiser, limits, &progress))?;
    note(stages, optimiser, &mesh, "coarsen");
    let mut before = optimiser.quality(&mesh);
    if before.min_scaled_jacobian < floor {
        watch.work += watch.run(stages, Stage::Smooth, |_| Ok(optimiser.lift(&mut mesh, floor)))?;
        note(stages, optimiser, &mesh, "lift");
        before = optimiser.quality(&mesh);
    }
    // Kept only if nothing that holds is lost.
    let mut smoother = mesh.clone();
    watch.run(stages, Stage::Smooth, |_| Ok(optimiser.optimise(&mut smoother, None, Effort::Final)))?;
    let after = optimiser.quality(&smoother);
    let too_large =
        |mesh: &QuadMesh| limit.is_some_and(|limit| limit.too_long(mesh, TOO_LARGE).contains(&true));
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
