//! Symmetric domains: the direct mesh averaged over its symmetries, or a sector's mesh and its images.

mod bar;
mod part;

use super::blocks::Wanted;
use super::finish::{follow_waves, MOST_FOLLOWING};
use super::rounds::{note, Refined};
use super::smooth_edges::smooth_edges;
use super::tighten::{tightened, Tolerances};
use super::watch::Watch;
use crate::domain::{Boundary, Domain};
use crate::error::{Error, Result};
use crate::mesh::{scaled_jacobian_ceiling, DomainCurve, ExactCurve, HighOrderMesh, QuadMesh};
use crate::numerics::tolerances::ORDER_TIE;
use crate::numerics::Point;
use crate::options::{Options, Subdivision};
use crate::progress::Stage;
use crate::refine::{Limits, SizeLimit, StripRemoval};
use crate::smooth::Optimiser;
use crate::stages::{Asymmetry, Stages, SymmetryCount, SymmetryReport};
use crate::symmetry::{average, mesh_symmetries, strip_orbits, Group, Sector, SymmetricCurve};
use bar::{floor, Bar};
use part::{cuts, part_mesh};

/// Most rotations of a sector with a corner at the centroid: with more its elements there are thin.
const MOST_AT_CENTRE: usize = 3;
/// Quads of sectors' meshes before coarsening, as a share of the direct one's, after which no other cut is tried.
const MOST_WORK: f64 = 0.6;
/// So many more are soon done.
const SMALL_WORK: f64 = 24.0;
/// Most quads of a mesh not coarsened yet that is coarsened again, all images of a strip at once.
const MOST_FINE: usize = 400;
/// Multiple of the least scaled Jacobian to which poor elements are optimised: what is averaged loses a little.
const AMPLE: f64 = 1.02;
/// Sets of strips that are looked at in one mesh.
const MOST_STRIPS: usize = 500;

/// A mesh, and the symmetries (indices into [`Group::elements`]) that it has to rounding.
#[derive(Debug, Clone)]
pub(super) struct Symmetrised {
    pub mesh: QuadMesh,
    pub elements: Vec<usize>,
}

/// What is the same for all meshes of a run.
#[derive(Clone, Copy)]
pub(super) struct Setting<'a> {
    pub options: &'a Options,
    pub tolerances: &'a Tolerances,
    pub wanted: &'a Wanted,
}

/// The symmetries of `boundary` that a mesh shall have. Sizes and base meshes of the caller's know nothing of them.
pub(super) fn wanted(
    boundary: &Boundary,
    exact: &dyn ExactCurve,
    options: &Options,
    stages: &mut Stages,
) -> Result<Group> {
    let given = options.element_size.is_some() || options.base_triangulation.is_some();
    if !options.symmetry || given {
        return Ok(Group::trivial(boundary));
    }
    let group = Group::of(boundary, exact)?;
    stages.symmetry = Some(SymmetryReport {
        domain: SymmetryCount { rotations: group.rotations, mirrors: group.mirrors() },
        mesh: SymmetryCount { rotations: 1, mirrors: 0 },
        asymmetry: None,
    });
    Ok(group)
}

/// Notes in `stages` which symmetries the mesh has.
pub(super) fn report(stages: &mut Stages, group: &Group, elements: &[usize], asymmetry: Option<Asymmetry>) {
    if let Some(report) = &mut stages.symmetry {
        let rotations = elements.iter().filter(|e| **e < group.rotations).count();
        report.mesh = SymmetryCount { rotations, mirrors: elements.len() - rotations };
        report.asymmetry = asymmetry.filter(|_| elements.len() < group.elements.len());
    }
}

/// The mesh with as many symmetries of the domain as one was found for, proven; `None` if the direct one has to do.
pub(super) fn proven(
    setting: Setting,
    boundary: &Boundary,
    domain: &Domain,
    group: &Group,
    direct: &Refined,
    watch: &mut Watch,
    stages: &mut Stages,
) -> Result<Option<HighOrderMesh>> {
    let (before, rounds) = (stages.quad_mesh.clone(), stages.rounds.len());
    let (found, asymmetry) = symmetrise(setting, boundary, group, direct, watch, stages)?;
    report(stages, group, &found.elements, asymmetry);
    if found.elements.len() < 2 {
        return Ok(None);
    }
    let curve = SymmetricCurve {
        exact: &DomainCurve { boundary, domain },
        boundary,
        symmetries: found.elements.iter().map(|e| &group.elements[*e]).collect(),
    };
    let Setting { options, tolerances, .. } = setting;
    let average_of = |mesh: QuadMesh| {
        averaged(&mesh, boundary, group).filter(|own| own.elements == found.elements).map(|own| own.mesh)
    };
    let proven =
        tightened(&found.mesh, boundary, options, tolerances, true, watch, stages).and_then(|mesh| {
            // Smoothing moves images alike, but for rounding that it makes more of.
            let even = if tolerances.first == tolerances.asked { Some(mesh) } else { average_of(mesh) };
            let mesh = even.ok_or(Error::Layout { reason: "division lost a symmetry".into(), at: None })?;
            let prove =
                |_: &mut Stages| HighOrderMesh::with_curve(&mesh, boundary, &curve, &tolerances.asked);
            watch.run(stages, Stage::Mesh, prove)
        });
    match proven {
        Ok(mesh) => Ok(Some(mesh)),
        Err(error) if error.ends_a_run() => Err(error),
        Err(_) => {
            stages.quad_mesh = before;
            stages.rounds.truncate(rounds);
            report(stages, group, &[0], Some(Asymmetry::Quality));
            Ok(None)
        }
    }
}

/// `direct`, a valid mesh of `boundary`, or one in its place that has more of the symmetries `group`; and why it
/// has not all.
///
/// # Errors
/// Only what ends a run: [`Cancelled`](crate::error::Error::Cancelled), and what a callback reports.
pub(super) fn symmetrise(
    setting: Setting,
    boundary: &Boundary,
    group: &Group,
    direct: &Refined,
    watch: &mut Watch,
    stages: &mut Stages,
) -> Result<(Symmetrised, Option<Asymmetry>)> {
    let optimiser = Optimiser::new(boundary, setting.options.order, Some(setting.wanted.tolerance));
    let quality = optimiser.quality(&direct.coarse);
    let bar = Bar::of(&quality, setting.options, boundary);
    let mut best = Symmetrised { mesh: direct.coarse.clone(), elements: vec![0] };
    let mut asymmetry = Asymmetry::Connectivity;
    let mut second_choice = Vec::new();
    if let Some(own) = averaged(&best.mesh, boundary, group) {
        match bar.objection(&optimiser.quality(&own.mesh)) {
            None => best = own,
            Some(reason) => {
                asymmetry = reason;
                second_choice.push(own);
            }
        }
    }
    // Quads that were optimised for sectors: what a sector costs is about its share of the whole mesh.
    let mut spent = 0;
    let most = MOST_WORK * direct.fine.quads.len() as f64 + SMALL_WORK;
    for cut in cuts(group) {
        if spent as f64 > most {
            break;
        }
        let all = group.elements.len();
        if best.elements.len() == all || 2 * cut.rotations <= best.elements.len() {
            continue;
        }
        let Some(sector) = Sector::new(boundary, group, cut) else { continue };
        if sector.has_centre && cut.rotations > MOST_AT_CENTRE {
            continue;
        }
        if scaled_jacobian_ceiling(&sector.boundary) < bar.scaled_jacobian {
            asymmetry = Asymmetry::Quality;
            continue;
        }
        let part = match part_mesh(setting, &sector, group, floor(setting.options, boundary), watch, stages) {
            Ok(part) => part,
            Err(error) if error.ends_a_run() => return Err(error),
            // The direct mesh stays.
            Err(_) => continue,
        };
        spent += part.spent;
        let welded = sector.weld(&part.mesh, boundary, group).ok();
        let candidate = welded.and_then(|whole| averaged(&whole, boundary, group));
        second_choice.extend(candidate.clone());
        asymmetry = better(&mut best, candidate, &optimiser, group, &bar).unwrap_or(asymmetry);
    }
    // Coarsening removes one strip after the other; what was there before may have been more symmetric.
    let few = direct.fine.quads.len() <= MOST_FINE;
    if best.elements.len() < group.elements.len() && few {
        let candidate = averaged(&direct.fine, boundary, group);
        asymmetry = better(&mut best, candidate, &optimiser, group, &bar).unwrap_or(asymmetry);
    }
    let lowered = bar.lowered(&quality);
    for candidate in second_choice {
        if best.elements.len() < group.elements.len() {
            asymmetry = better(&mut best, Some(candidate), &optimiser, group, &lowered).unwrap_or(asymmetry);
        }
    }
    if best.elements.len() > 1 {
        best = with_smooth_edges(best, setting.options, &optimiser, group, &lowered);
        note(stages, &optimiser, &best.mesh, "symmetrise");
        if let Some(size) = setting.options.max_element_size {
            let size = size / boundary.frame.scale;
            match divided(&best, size, setting.options, &optimiser, group, &lowered) {
                Some(finer) => {
                    best = finer;
                    note(stages, &optimiser, &best.mesh, "divide");
                }
                None => {
                    best.elements.truncate(1);
                    asymmetry = Asymmetry::Elements;
                }
            }
        }
    }
    Ok((best, Some(asymmetry)))
}

/// `found` with boundary vertices at joints and knots, as the direct mesh has them, where that keeps its symmetries.
fn with_smooth_edges(
    found: Symmetrised,
    options: &Options,
    optimiser: &Optimiser,
    group: &Group,
    bar: &Bar,
) -> Symmetrised {
    let boundary = optimiser.boundary();
    let mut mesh = found.mesh.clone();
    let moved = options.subdivision == Subdivision::EqualError
        && smooth_edges(&mut mesh, boundary, optimiser, floor(options, boundary));
    let better = moved.then(|| averaged(&mesh, boundary, group)).flatten();
    let kept = |mesh: &Symmetrised| {
        mesh.elements.len() >= found.elements.len()
            && bar.shape_objection(&optimiser.quality(&mesh.mesh)).is_none()
    };
    better.filter(kept).unwrap_or(found)
}

/// `found` divided into parts of at most `size`, as the direct mesh is; `None` where that loses symmetries.
fn divided(
    found: &Symmetrised,
    size: f64,
    options: &Options,
    optimiser: &Optimiser,
    group: &Group,
    bar: &Bar,
) -> Option<Symmetrised> {
    let boundary = optimiser.boundary();
    let allowed = |_: Point| size;
    let limit = SizeLimit::new(&allowed);
    let (order, most) = (options.order, options.max_elements);
    let once = |found: &Symmetrised, even: Option<f64>| {
        let mesh = limit.divide_evenly(found.mesh.clone(), boundary, 1.0, order, most, even).ok()?;
        let finer = with_smooth_edges(averaged(&mesh, boundary, group)?, options, optimiser, group, bar);
        let small = !limit.too_long(&finer.mesh, 1.0 + 2.0 * ORDER_TIE).contains(&true);
        (small && finer.elements.len() >= found.elements.len()).then_some(finer)
    };
    let even = (options.subdivision == Subdivision::EqualError).then_some(size);
    let followed = |divided: Symmetrised| {
        if even.is_none() || divided.mesh.quads.len() > MOST_FOLLOWING {
            return divided;
        }
        let mut mesh = divided.mesh.clone();
        let moved = follow_waves(&mut mesh, size, optimiser, floor(options, boundary));
        let better = moved.then(|| averaged(&mesh, boundary, group)).flatten();
        let kept = |better: &Symmetrised| {
            let quality = optimiser.quality(&better.mesh);
            better.elements.len() >= divided.elements.len()
                && quality.valid()
                && quality.min_scaled_jacobian >= floor(options, boundary).min(bar.scaled_jacobian)
                && quality.error_ratio <= bar.error_ratio
                && !limit.too_long(&better.mesh, 1.0 + 2.0 * ORDER_TIE).contains(&true)
        };
        better.filter(kept).unwrap_or(divided)
    };
    // First for the size alone, as the direct mesh.
    let mut divided = followed(once(found, None)?);
    for _ in 0..2 {
        if let Some(finer) = even.and_then(|_| once(&divided, even)) {
            let same = finer.mesh.quads.len() == divided.mesh.quads.len();
            divided = if same { divided } else { followed(finer) };
        }
    }
    Some(divided)
}

/// Puts `candidate`, coarsened and smoothed, in the place of `best`, if it has more symmetries and is good enough; what
/// is to be said against it, if that is so.
fn better(
    best: &mut Symmetrised,
    candidate: Option<Symmetrised>,
    optimiser: &Optimiser,
    group: &Group,
    bar: &Bar,
) -> Option<Asymmetry> {
    let candidate = candidate.filter(|c| c.elements.len() > best.elements.len())?;
    let candidate = lifted(candidate, optimiser, group, bar);
    if let Some(objection) = bar.shape_objection(&optimiser.quality(&candidate.mesh)) {
        return Some(objection);
    }
    let candidate = fewer_strips(candidate, optimiser, group, bar);
    let objection = bar.objection(&optimiser.quality(&candidate.mesh));
    if objection.is_none() {
        *best = candidate;
    }
    objection
}

/// `mesh` averaged over the symmetries that its connectivity has; `None` if there are none.
fn averaged(mesh: &QuadMesh, boundary: &Boundary, group: &Group) -> Option<Symmetrised> {
    let own = mesh_symmetries(mesh, boundary, group);
    if own.elements.len() < 2 {
        return None;
    }
    Some(Symmetrised { mesh: average(mesh, boundary, group, &own)?, elements: own.elements })
}

/// `found` with its poor elements optimised, if that makes it good enough.
fn lifted(found: Symmetrised, optimiser: &Optimiser, group: &Group, bar: &Bar) -> Symmetrised {
    if bar.shape_objection(&optimiser.quality(&found.mesh)) != Some(Asymmetry::Quality) {
        return found;
    }
    let mut mesh = found.mesh.clone();
    optimiser.lift(&mut mesh, AMPLE * bar.scaled_jacobian);
    let better = averaged(&mesh, optimiser.boundary(), group).filter(|better| {
        better.elements.len() >= found.elements.len()
            && bar.shape_objection(&optimiser.quality(&better.mesh)).is_none()
    });
    better.unwrap_or(found)
}

/// `found` with one strip in the place of two that are each other's images, where it holds as well as before; and, as
/// long as it has more elements than the direct mesh, without any strip and its images.
fn fewer_strips(found: Symmetrised, optimiser: &Optimiser, group: &Group, bar: &Bar) -> Symmetrised {
    let boundary = optimiser.boundary();
    let Ok(removal) = StripRemoval::new(boundary, optimiser, Limits::new(bar.scaled_jacobian)) else {
        return found;
    };
    let mut best = found;
    let mut trials = 0;
    'again: loop {
        let own = mesh_symmetries(&best.mesh, boundary, group);
        let as_many = |elements: &[usize]| elements.len() >= own.elements.len();
        let as_symmetric = |mesh: &QuadMesh| as_many(&mesh_symmetries(mesh, boundary, group).elements);
        let whole = best.mesh.quads.len() > bar.direct;
        for set in strip_orbits(&best.mesh, group, &own, whole) {
            trials += 1;
            if trials > MOST_STRIPS {
                break;
            }
            let fewer = removal.without(&best.mesh, &set, as_symmetric);
            let Some(fewer) = fewer.and_then(|mesh| averaged(&mesh, boundary, group)) else { continue };
            if as_many(&fewer.elements) && bar.shape_objection(&optimiser.quality(&fewer.mesh)).is_none() {
                best = fewer;
                continue 'again;
            }
        }
        return best;
    }
}
