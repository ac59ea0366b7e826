//! The paper's algorithm, steps 0 to 9.
//!
//! B. Yuan and D. A. Kopriva, *Automatic quad mesh generation for spectral methods*: a cross field
//! gives the blocks of a few large curved quadrilaterals; their boundary edges are divided until order-N
//! interpolation meets the tolerance.

mod blocks;
mod fewer_elements;
mod finish;
mod proof;
mod rounds;
mod smooth_edges;
mod starts;
mod symmetric;
mod tighten;
mod watch;

use crate::base_mesh::{self, Triangulation};
use crate::domain::{Boundary, Domain};
use crate::error::{Error, Result};
use crate::mesh::{BoundaryTolerance, DomainCurve, HighOrderMesh};
use crate::options::Options;
use crate::progress::Stage;
use crate::stages::Stages;
use blocks::Wanted;
use finish::Elements;
use starts::Start;
use std::sync::Arc;
use tighten::Tolerances;
use watch::Watch;

/// Base meshes tried, each finer than the one before, until blocks and elements come out right.
const ATTEMPTS: usize = 4;

/// The same for a base mesh that the caller brings: it stays, but the second attempt treats tips otherwise.
const GIVEN_ATTEMPTS: usize = 2;

/// Share of the tolerance that the stages aim at: they measure on the boundary's tables, at their
/// quadrature points, and the last optimisation may use all of what they allow.
const TOLERANCE_AIM: f64 = 0.97;

/// The same at orders from [`HIGH_ORDER`] on. Their edges span several knots of a spline, where a quadrature
/// that does not stop at knots (the user's) is up to 15 % off.
const HIGH_ORDER_AIM: f64 = 0.85;
const HIGH_ORDER: usize = 8;

/// Share of the tolerance that the stages aim at for elements of `order`.
fn share_aimed_at(order: usize) -> f64 {
    if order < HIGH_ORDER {
        TOLERANCE_AIM
    } else {
        HIGH_ORDER_AIM
    }
}

/// What the stages aim at for `tolerance`; the final mesh is measured against the tolerance itself.
fn aim(tolerance: &BoundaryTolerance) -> BoundaryTolerance {
    BoundaryTolerance { value: share_aimed_at(tolerance.order) * tolerance.value, ..*tolerance }
}

/// Meshes `domain`. `stages` keeps what every stage made, also on failure.
///
/// # Errors
/// A variant of [`Error`] for each cause, with the place in the caller's coordinates.
///
/// # Example
/// ```
/// use quadrel::{domain::Domain, generate, stages::Stages, Options};
/// let mut builder = Domain::builder();
/// builder.begin_loop(quadrel::domain::LoopKind::Outer, "wall")?;
/// builder.add_arc([0.0, 0.0], 1.0, 0.0, 2.0 * std::f64::consts::PI, "")?;
/// builder.end_loop()?;
/// let disc = builder.build()?;
/// let mesh = generate(&disc, &Options::default(), &mut Stages::default())?;
/// assert!(mesh.elements.len() <= 12);
/// # Ok::<(), quadrel::Error>(())
/// ```
pub fn generate(domain: &Domain, options: &Options, stages: &mut Stages) -> Result<HighOrderMesh> {
    options.check()?;
    starts::best_of_starts(domain, options, stages)
}

/// One mesh, begun as `start` says.
fn one_mesh(domain: &Domain, options: &Options, start: Start, stages: &mut Stages) -> Result<HighOrderMesh> {
    *stages = Stages::default();
    let mut watch = Watch::new(options);

    // Step 0: boundary, order, tolerance.
    let boundary = watch.run(stages, Stage::Domain, |stages| {
        stages.warnings.extend(domain.warnings.iter().cloned());
        Boundary::new(domain).map(Arc::new)
    })?;
    stages.boundary = Some(Arc::clone(&boundary));
    let tolerances = watch.run(stages, Stage::Domain, |_| {
        Tolerances::new(options, &boundary, start.sooner)
            .map_err(|error| error.map_place(|p| boundary.frame.to_caller(p)))
    })?;
    let group = watch.run(stages, Stage::Domain, |stages| {
        symmetric::wanted(&boundary, &DomainCurve { boundary: &boundary, domain }, options, stages)
    })?;

    let mut given = None;
    if let Some(own) = &options.base_triangulation {
        let adopt = |_: &mut Stages| base_mesh::adopt(own, domain, &boundary).map(Arc::new);
        given = Some(watch.run(stages, Stage::BaseMesh, adopt)?);
    }
    let attempts = if given.is_some() { GIVEN_ATTEMPTS } else { ATTEMPTS };

    let wanted = Wanted { tolerance: aim(&tolerances.first), size: start.size };
    let mut failure = None;
    let mut request = blocks::first_request(options, &boundary);
    for _ in 0..start.finer {
        blocks::refine(&mut request, &boundary);
    }
    for attempt in 1..=attempts {
        stages.begin_attempt(attempt);
        // The stages speak of places in the canonical frame.
        let given = given.as_ref();
        let elements = steps_1_to_9(&boundary, given, options, &wanted, &mut request, &mut watch, stages)
            .map_err(|error| error.map_place(|p| boundary.frame.to_caller(p)));
        // The proof: curved elements of order N with positive Jacobians, on the exact curves.
        let result = elements.and_then(|elements| {
            if !group.is_trivial() {
                let setting = symmetric::Setting { options, tolerances: &tolerances, wanted: &wanted };
                let made = symmetric::proven(
                    setting,
                    &boundary,
                    domain,
                    &group,
                    &elements.refined,
                    &mut watch,
                    stages,
                )?;
                if let Some(mesh) = made {
                    return Ok(mesh);
                }
            }
            let finished = finish::finished(&elements, &boundary, options, &tolerances, &mut watch, stages);
            let mesh = finished.map_err(|error| error.map_place(|p| boundary.frame.to_caller(p)))?;
            proof::proven(&mesh, &boundary, domain, options, &tolerances.asked, &mut watch, stages)
        });
        match result {
            Ok(mesh) => return Ok(mesh),
            Err(error) if error.ends_a_run() => return Err(error),
            Err(error) => {
                failure.get_or_insert(error);
            }
        }
        if watch.work > rounds::MOST_WORK {
            break;
        }
        blocks::refine(&mut request, &boundary);
    }
    Err(failure.unwrap_or(Error::Cancelled))
}

fn steps_1_to_9(
    boundary: &Boundary,
    given: Option<&Arc<Triangulation>>,
    options: &Options,
    wanted: &Wanted,
    request: &mut base_mesh::Request,
    watch: &mut Watch,
    stages: &mut Stages,
) -> Result<Elements> {
    // Steps 1 to 3: base mesh, cross field, singularities; refined until the index theorem holds.
    let field = blocks::field(boundary, given, options, false, request, watch, stages)?;

    // Steps 4 to 6: separatrices, quad-dominant regions, repair.
    let mut blocks = blocks::layout(boundary, options, wanted, &field, watch, stages);
    if matches!(blocks, Err(Error::Separatrix { .. })) {
        // A line found no way: without the singularities that lie at corners it may.
        let field = blocks::field(boundary, given, options, true, request, watch, stages)?;
        blocks = blocks::layout(boundary, options, wanted, &field, watch, stages);
    }
    let (layout, sizes) = blocks?;

    // Steps 7 to 9: subdivide and smooth until every boundary edge meets the tolerance.
    let refined =
        rounds::refine_and_smooth(boundary, options, &wanted.tolerance, &layout, &sizes, watch, stages)?;
    Ok(Elements { refined, sizes })
}
