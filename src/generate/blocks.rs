//! Steps 1 to 6: from the boundary to conforming blocks.

use super::watch::Watch;
use crate::base_mesh::{self, ElementSize, Request, Triangulation};
use crate::cross_field::{self, CornerRule, CrossField, Tips};
use crate::domain::Boundary;
use crate::error::{Error, Result};
use crate::layout::{self, t_mesh, QuadLayout, Targets};
use crate::mesh::{BoundaryError, BoundaryTolerance};
use crate::numerics::tolerances::LEAST_REFINEMENT;
use crate::options::Options;
use crate::progress::Stage;
use crate::refine::least_pieces;
use crate::separatrices;
use crate::singularities::{self, CornerFan, Singularity};
use crate::stages::Stages;
use std::sync::Arc;

/// Rounds of local refinement that the gate may ask for on one base mesh size.
const GATE_ROUNDS: usize = 6;
/// The same on base meshes of more than so many triangles, where a round for a few places takes as long as for all: of a
/// plate with 400 holes each round mends two thirds of what is left, and the meshes are no better for it.
const GATE_ROUNDS_OF_MANY: usize = 1;
const MANY: usize = 50_000;
/// Rounds of seed rays for regions with two tips.
const SEED_ROUNDS: usize = 6;
/// Edges a chain gets for each one that the tolerance needs: room for vertices that slide.
const CHAIN_MARGIN: f64 = 1.2;
/// Least size, relative to the domain's diagonal, that the lengths in whole numbers aim at: a caller's spot of
/// almost nothing, met by a sample, must not count for a whole arc. Division does the rest.
const LEAST_SIZE: f64 = 5e-5;
/// Base size of the next attempt relative to the last.
const FINER: f64 = 0.72;

/// Steps 1 to 3.
pub(super) struct Field {
    pub mesh: Arc<Triangulation>,
    pub cross: Arc<CrossField>,
    pub singularities: Vec<Singularity>,
    pub corners: Vec<CornerFan>,
}

/// What blocks are made for.
pub(super) struct Wanted {
    /// The tolerance that their edges are divided for.
    pub tolerance: BoundaryTolerance,
    /// Size of a block's elements before coarsening, relative to the usual one.
    pub size: f64,
}

pub(super) fn first_request(options: &Options, boundary: &Boundary) -> Request {
    Request { size: options.base_mesh_size.map(|h| h / boundary.frame.scale), refine: Vec::new() }
}

/// Asks for a finer base mesh everywhere.
pub(super) fn refine(request: &mut Request, boundary: &Boundary) {
    let size = request.size.unwrap_or_else(|| base_mesh::usual_size(boundary));
    request.size = Some(size * FINER);
}

/// Base mesh, cross field and singularities, refined locally until the index theorem holds; on the `given`
/// mesh, if there is one, without refinement. `absorbing`: see [`CornerRule`].
pub(super) fn field(
    boundary: &Boundary,
    given: Option<&Arc<Triangulation>>,
    options: &Options,
    absorbing: bool,
    request: &mut Request,
    watch: &mut Watch,
    stages: &mut Stages,
) -> Result<Field> {
    let usual = base_mesh::usual_size(boundary);
    let least = LEAST_REFINEMENT * request.size.map_or(usual, |h| h.min(usual));
    let tips = match stages.attempts {
        0 | 1 => Tips::Balanced,
        2 => Tips::OneQuad,
        _ => Tips::AllOneQuad,
    };
    let rule = CornerRule { tips, absorbing };
    let mut round = 0;
    loop {
        let mesh = watch.run(stages, Stage::BaseMesh, |_| match given {
            Some(mesh) => Ok(Arc::clone(mesh)),
            None => base_mesh::triangulate(boundary, request).map(Arc::new),
        })?;
        stages.triangulation = Some(Arc::clone(&mesh));
        let cross = watch.run(stages, Stage::CrossField, |_| {
            cross_field::solve_with_corners(&mesh, boundary, options.field, rule).map(Arc::new)
        })?;
        stages.cross_field = Some(Arc::clone(&cross));
        let found = singularities::find(&mesh, boundary, &cross);
        let known = found.as_ref().map_or(&[][..], |(singularities, _)| singularities);
        let rounds = if mesh.triangles.len() > MANY { GATE_ROUNDS_OF_MANY } else { GATE_ROUNDS };
        let may_refine = given.is_none() && round < rounds;
        if let (Err(places), true) = (singularities::gate(&mesh, boundary, &cross, known, least), may_refine)
        {
            request.refine.extend(places);
            round += 1;
            continue;
        }
        let (singularities, corners) = watch.run(stages, Stage::Singularities, |_| found)?;
        stages.singularities = singularities.clone();
        stages.corners = corners.clone();
        return Ok(Field { mesh, cross, singularities, corners });
    }
}

/// Separatrices, the T-mesh of regions, and its repair to conforming blocks; with the wanted sizes.
pub(super) fn layout(
    boundary: &Boundary,
    options: &Options,
    wanted: &Wanted,
    field: &Field,
    watch: &mut Watch,
    stages: &mut Stages,
) -> Result<(QuadLayout, ElementSize)> {
    let Field { mesh, cross, singularities, corners } = field;
    let mut seeds = Vec::new();
    let mut regions = None;
    for _ in 0..SEED_ROUNDS {
        let traces = watch.run(stages, Stage::Separatrices, |_| {
            separatrices::trace(mesh, cross, boundary, singularities, corners, &seeds)
        })?;
        stages.separatrices = traces;
        match t_mesh::build(boundary, singularities, corners, &stages.separatrices)? {
            t_mesh::Traced::Layout(layout) => {
                regions = Some(layout);
                break;
            }
            t_mesh::Traced::Seeds(more) => seeds.extend(more),
        }
    }
    let regions = regions
        .ok_or_else(|| Error::Layout { reason: "a region between two sharp corners".into(), at: None })?;
    stages.block_layout = Some(regions.clone());
    let sizes = ElementSize::new(mesh, boundary, options)?;
    if sizes.least_elements > options.max_elements as f64 {
        let least = sizes.least_elements;
        let reason = format!("the sizes asked for take {least:.0} elements, above {}", options.max_elements);
        return Err(Error::Layout { reason, at: None });
    }
    let conforming = watch.run(stages, Stage::Layout, |_| {
        let error = BoundaryError::new(wanted.tolerance);
        let mut minimum = Vec::with_capacity(boundary.chains.len());
        for chain in &boundary.chains {
            let least = least_pieces(chain, &error)?;
            minimum.push(if least > 1 { (least as f64 * CHAIN_MARGIN).ceil() as u32 } else { 1 });
        }
        let size = |p| (wanted.size * sizes.at(p)).max(LEAST_SIZE);
        layout::conform(&regions, boundary, &Targets::new(&size, &minimum))
    })?;
    stages.block_layout = Some(conforming.repaired);
    stages.fallback = stages.fallback.max(conforming.fallback);
    stages.quad_layout = Some(conforming.layout.clone());
    Ok((conforming.layout, sizes))
}
