//! Untangling with straight edges first.
//!
//! Elements with straight sides have two unknowns a vertex and four corners to look at, against some
//! twenty unknowns and dozens of samples for curved ones, and are far better conditioned. So a
//! tangled mesh is untangled so, boundary edges taken as chords, and gets its curves back where the
//! vertices already are in the right order. What the curves invert again is mended locally.

use super::kernel::Measure;
use super::local::{few_of_many, untangle_locally, Elements};
use super::minimiser::{Lbfgs, Limits};
use super::optimiser::{Care, Schedule};
use super::problem::Problem;
use super::reference::Reference;
use super::straightness::Straightness;
use super::untangle::untangle;
use crate::domain::Boundary;
use crate::mesh::QuadMesh;
use crate::numerics::cross;

/// Powers of the shape energy after untangling: room for the curves.
const POWERS: [u32; 2] = [2, 4];
/// Step bound of the minimiser, in natural lengths.
const REACH: f64 = 0.5;

/// Straight-sided elements; the boundary does not slide.
struct Straight<'a> {
    boundary: &'a Boundary,
    reference: &'a Reference,
    straightness: &'a Straightness<'a>,
}

impl Elements for Straight<'_> {
    fn problem<'a>(&'a self, mesh: &QuadMesh, active: &[u32]) -> Problem<'a> {
        let straightness = self.straightness;
        Problem::new(self.boundary, self.reference, None, mesh, Some(active), false, straightness)
    }

    fn schedule(&self, care: Care, quads: usize) -> Schedule {
        care.schedule_for_straight(quads)
    }

    fn inverted(&self, mesh: &QuadMesh, quad: u32) -> bool {
        let p = mesh.quads[quad as usize].map(|v| mesh.vertices[v as usize].point);
        (0..4).any(|i| cross(p[(i + 1) % 4] - p[i], p[(i + 3) % 4] - p[i]) <= 0.0)
    }
}

/// Moves the interior vertices of a mesh whose straight-sided elements are inverted somewhere until none is,
/// and straightens its interior edges. The mesh is left as it was if that fails; of a large one a few inverted
/// elements may be left: between fixed vertices only a curve, or one vertex more, cures them.
pub(super) fn untangle_straight(
    boundary: &Boundary,
    linear: &Reference,
    straightness: &Straightness,
    mesh: &mut QuadMesh,
    care: Care,
    work: &mut u64,
) {
    let elements = Straight { boundary, reference: linear, straightness };
    if !(0..mesh.quads.len() as u32).any(|q| elements.inverted(mesh, q)) {
        return;
    }
    let mut straight = mesh.clone();
    straight.edges.iter_mut().for_each(|e| e.bubbles.clear());
    let left = untangle_locally(&elements, &mut straight, care, work);
    if left > 0 && few_of_many(left, mesh.quads.len()) {
        *mesh = straight;
        return;
    }
    let schedule = care.schedule_for_straight(mesh.quads.len());
    let mut problem = Problem::new(boundary, linear, None, &straight, None, false, straightness);
    let mut lbfgs = Lbfgs::default();
    if left > 0 && !untangle(&mut problem, &mut lbfgs, &schedule, work) {
        return;
    }
    for power in POWERS {
        problem.refresh();
        let limits = Limits { steps: schedule.untangle_steps, progress: 1e-3 };
        problem.minimise(&mut lbfgs, Measure::Shape(power), REACH, limits, work);
    }
    problem.store(&mut straight);
    *mesh = straight;
}
