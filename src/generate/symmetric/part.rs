//! Meshes of sectors.

use super::{symmetrise, Setting};
use crate::error::{Error, Result};
use crate::generate::finish::Elements;
use crate::generate::watch::Watch;
use crate::generate::{blocks, steps_1_to_9};
use crate::mesh::{scaled_jacobian_ceiling, QuadMesh};
use crate::options::Options;
use crate::stages::Stages;
use crate::symmetry::{Cut, Group, Sector};

/// Base meshes tried for a sector.
const PART_ATTEMPTS: usize = 2;
/// Largest quality floor for a sector's mesh.
const MOST_FLOOR: f64 = 0.95;

/// Ways to cut, the smallest sectors first. Mirrors that a rotation makes one another give the same sectors.
pub(super) fn cuts(group: &Group) -> Vec<Cut> {
    let n = group.rotations;
    let mut cuts = Vec::new();
    if group.mirrors() > 0 {
        for rotations in (1..=n).rev().filter(|r| n % r == 0) {
            let classes = if (n / rotations) % 2 == 0 { 2 } else { 1 };
            cuts.extend((0..classes).map(|mirror| Cut { rotations, mirror }));
        }
    }
    cuts
}

/// A sector's mesh, and the quads that were optimised for it.
pub(super) struct Part {
    pub mesh: QuadMesh,
    pub spent: usize,
}

/// A mesh of `sector` whose scaled Jacobian coarsening keeps at `floor`, with the mirror between its axes if the domain has that.
pub(super) fn part_mesh(
    setting: Setting,
    sector: &Sector,
    group: &Group,
    floor: f64,
    watch: &mut Watch,
    stages: &mut Stages,
) -> Result<Part> {
    let boundary = &sector.boundary;
    let mut watch = watch.of_part();
    let mut own = Stages::default();
    // Corners on an axis are halved; the other elements shall not be the worse for it.
    let share =
        (floor / scaled_jacobian_ceiling(boundary)).min(MOST_FLOOR).max(setting.options.quality_floor);
    let options = &Options { quality_floor: share, max_element_size: None, ..setting.options.clone() };
    let setting = Setting { options, ..setting };
    let mut request = blocks::first_request(options, boundary);
    let mut result = Err(Error::Cancelled);
    for attempt in 1..=PART_ATTEMPTS {
        own.begin_attempt(attempt);
        result = steps_1_to_9(boundary, None, options, setting.wanted, &mut request, &mut watch, &mut own);
        if !matches!(result, Err(Error::Layout { .. } | Error::InvalidElement { .. })) {
            break;
        }
        blocks::refine(&mut request, boundary);
    }
    let result = result.and_then(|Elements { refined, .. }| {
        let spent = refined.fine.quads.len();
        let mesh = match sector.bisector(group) {
            Some(own_group) => {
                symmetrise(setting, boundary, &own_group, &refined, &mut watch, &mut own)?.0.mesh
            }
            None => refined.coarse,
        };
        Ok(Part { mesh, spent })
    });
    stages.seconds.iter_mut().zip(own.seconds).for_each(|(all, own)| *all += own);
    result
}
