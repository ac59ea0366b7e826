//! After coarsening: the tolerance asked for, vertices at joints and knots, and elements of the sizes asked for.

use super::aim;
use super::rounds::{note, Refined, TOO_LARGE};
use super::smooth_edges::smooth_edges;
use super::tighten::{tightened, Tolerances};
use super::watch::Watch;
use crate::base_mesh::ElementSize;
use crate::domain::Boundary;
use crate::error::{Error, Result};
use crate::mesh::{scaled_jacobian_ceiling, QuadMesh};
use crate::numerics::tolerances::ORDER_TIE;
use crate::numerics::Point;
use crate::options::{Options, Subdivision};
use crate::progress::Stage;
use crate::refine::SizeLimit;
use crate::smooth::Optimiser;
use crate::stages::Stages;

/// Most quads of a mesh whose elements are moved to follow waves: of more each has little to gain.
pub(super) const MOST_FOLLOWING: usize = 400;

/// Valid elements, and the sizes that they were made for.
pub(super) struct Elements {
    pub refined: Refined,
    pub sizes: ElementSize,
}

/// The direct mesh of `elements`, which keep the first of `tolerances`, as it is proven.
pub(super) fn finished(
    elements: &Elements,
    boundary: &Boundary,
    options: &Options,
    tolerances: &Tolerances,
    watch: &mut Watch,
    stages: &mut Stages,
) -> Result<QuadMesh> {
    let Elements { refined, sizes } = elements;
    let mut mesh = tightened(&refined.coarse, boundary, options, tolerances, false, watch, stages)?;
    let optimiser = Optimiser::new(boundary, options.order, Some(aim(&tolerances.asked)));
    let floor = options.quality_floor * scaled_jacobian_ceiling(boundary);
    let coarsens = options.subdivision == Subdivision::EqualError;
    let allowed = |p| sizes.allowed(p);
    let varies = options.element_size.is_some();
    let onto_breaks = |mesh: &mut QuadMesh, stages: &mut Stages, watch: &mut Watch| -> Result<()> {
        let moved = coarsens
            && watch.run(stages, Stage::Refine, |_| Ok(smooth_edges(mesh, boundary, &optimiser, floor)))?;
        if moved {
            note(stages, &optimiser, mesh, "joints");
        }
        Ok(())
    };
    onto_breaks(&mut mesh, stages, watch)?;
    // Parts of valid elements are valid, parts of edges nearer to the curve, and a solver's error falls with their
    // size as the order promises: no shape is smoothed any more.
    let slack = if varies { TOO_LARGE } else { 1.0 };
    if varies || options.max_element_size.is_some() {
        let whole = SizeLimit::new(&allowed);
        let even = coarsens && !varies;
        let size = options.max_element_size.filter(|_| even).map(|size| size / boundary.frame.scale);
        // New vertices, too, go to breaks; where that made an element too large or worse it is divided once more.
        // First for the size alone: what vertices at breaks and elsewhere mend takes no elements.
        for (pass, parts_for) in [None, size, size].into_iter().enumerate() {
            let before = mesh.quads.len();
            mesh = watch.run(stages, Stage::Refine, |_| {
                whole.divide_evenly(mesh, boundary, slack, options.order, options.max_elements, parts_for)
            })?;
            if mesh.quads.len() > before {
                note(stages, &optimiser, &mesh, "divide");
                onto_breaks(&mut mesh, stages, watch)?;
            } else if pass > 0 {
                continue;
            }
            if let Some(size) = size.filter(|_| mesh.quads.len() <= MOST_FOLLOWING) {
                let follow = |_: &mut Stages| Ok(follow_waves(&mut mesh, size, &optimiser, floor));
                if watch.run(stages, Stage::Smooth, follow)? {
                    note(stages, &optimiser, &mesh, "follow");
                }
            }
        }
    }
    if mesh.quads.len() > options.max_elements {
        let reason =
            format!("{} elements, more than the limit of {}", mesh.quads.len(), options.max_elements);
        return Err(Error::Layout { reason, at: None });
    }
    Ok(mesh)
}

/// Moves `mesh`, divided for `size`, so that its elements follow waves of 2πh, or of the diagonal if that is less: longer
/// ones the domain does not see. Whether anything moved.
pub(super) fn follow_waves(mesh: &mut QuadMesh, size: f64, optimiser: &Optimiser, floor: f64) -> bool {
    let allowed = |_: Point| size;
    let limit = SizeLimit::new(&allowed);
    let small = |mesh: &QuadMesh| !limit.too_long(mesh, 1.0 + ORDER_TIE).contains(&true);
    optimiser.follow(mesh, (1.0 / size).max(std::f64::consts::TAU), floor, size, &small)
}
