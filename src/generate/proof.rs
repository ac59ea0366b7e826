//! The proof of the direct mesh, and another try where it fails for a few elements.
//!
//! The optimiser looks at samples of the Jacobian, with boundary nodes from tables; the proof looks at all of it, on the
//! exact curves. A few elements that are valid by so little that the two disagree are optimised where they are, or their
//! chords divided, rather than that the mesh is given up.

use super::aim;
use super::rounds::note;
use super::watch::Watch;
use crate::domain::{Boundary, Domain};
use crate::error::{Error, Result};
use crate::mesh::{unproven, BoundaryTolerance, DomainCurve, HighOrderMesh, QuadMesh};
use crate::options::Options;
use crate::progress::Stage;
use crate::refine;
use crate::smooth::Optimiser;
use crate::stages::Stages;

/// Tries: as the mesh is, and with the chords of refused elements divided once and twice.
const TRIES: usize = 3;
/// Refused elements that are still a few.
const FEW: usize = 64;

/// The order-N mesh of `mesh`, proven.
///
/// # Errors
/// As [`HighOrderMesh::new`], and [`Error::Cancelled`].
pub(super) fn proven(
    mesh: &QuadMesh,
    boundary: &Boundary,
    domain: &Domain,
    options: &Options,
    tolerance: &BoundaryTolerance,
    watch: &mut Watch,
    stages: &mut Stages,
) -> Result<HighOrderMesh> {
    let prove = |mesh: &QuadMesh| HighOrderMesh::new(mesh, boundary, domain, tolerance);
    let first = watch.run(stages, Stage::Mesh, |_| prove(mesh));
    if !matches!(first, Err(Error::InvalidElement { .. })) {
        return first;
    }
    let optimiser = Optimiser::new(boundary, options.order, Some(aim(tolerance)));
    let curve = DomainCurve { boundary, domain };
    let all = |mesh: &QuadMesh| 0..mesh.quads.len() as u32;
    let mut mesh = mesh.clone();
    for tried in 1..=TRIES {
        let refused = unproven(&mesh, all(&mesh), boundary, &curve, options.order)?;
        if refused.len() > FEW {
            break;
        }
        let refuses = |mesh: &QuadMesh, quads: &[u32]| {
            unproven(mesh, quads.iter().copied(), boundary, &curve, options.order)
                // A callback that fails is heard when the mesh is proven.
                .unwrap_or_else(|_| quads.to_vec())
        };
        let (left, work) =
            watch.run(stages, Stage::Smooth, |_| Ok(optimiser.mend(&mut mesh, &refused, &refuses)))?;
        watch.work += work;
        note(stages, &optimiser, &mesh, "mend");
        if left.is_empty() {
            return watch.run(stages, Stage::Mesh, |_| prove(&mesh));
        }
        if tried == TRIES {
            break;
        }
        // Vertices more give what lies between fixed ones another shape.
        let mut marked = vec![false; mesh.edges.len()];
        left.iter().flat_map(|q| mesh.quad_edges[*q as usize]).for_each(|e| marked[e as usize] = true);
        mesh = watch.run(stages, Stage::Refine, |_| {
            refine::split_chords(&mesh, boundary, &marked, options.order)
                .map_err(|(reason, at)| Error::Layout { reason, at: Some(boundary.frame.to_caller(at)) })
        })?;
        note(stages, &optimiser, &mesh, "subdivide");
    }
    first
}
