//! Steps 7 to 9: subdivide, smooth, coarsen; repeat until every boundary edge meets the tolerance.

use super::fewer_elements::fewer_elements;
use super::watch::Watch;
use crate::base_mesh::ElementSize;
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::error::{Error, Result};
use crate::layout::QuadLayout;
use crate::mesh::{scaled_jacobian_ceiling, BoundaryError, BoundaryTolerance, QuadMesh, Vertex};
use crate::numerics::tolerances::{LEAST_JACOBIAN, OFF_POWERS, START_GRID};
use crate::numerics::Point;
use crate::options::{Options, Subdivision};
use crate::progress::Stage;
use crate::refine::{self, SizeLimit};
use crate::smooth::{Aim, Care, Optimiser};
use crate::stages::{Round, Stages};
use std::collections::HashMap;

/// Most rounds of subdivision and smoothing.
const ROUNDS: usize = 5;
/// Element evaluations (some microseconds each at order 5) after which no further round or attempt begins.
pub(super) const MOST_WORK: u64 = 8_000_000;
/// The same for each quad, where that is more: of meshes so large a few elements stay inverted to the end.
const WORK_PER_QUAD: u64 = 300;
/// Edge lengths in wanted sizes above which a chord is divided.
const TOO_LONG: f64 = 2.5;
/// Quads above which strips finer than wanted are ended before anything is optimised, ...
const LARGE: usize = 1500;
/// ... if no more than this share of the quads is left.
const WORTH: f64 = 0.7;
/// Multiple of coarsening's floor to which a mesh is smoothed before it.
const AMPLE: f64 = 1.05;
/// Share of inverted elements up to which the edges of a large mesh's are divided, too: chords are long there.
const FEW: f64 = 1e-3;
/// Sizes in those that the caller's function allows above which elements are divided once more after smoothing,
/// and after coarsening.
pub(super) const TOO_LARGE: f64 = 1.1;
/// Most elements, as a multiple of the first round's, before another layout is tried.
const MOST_GROWTH: usize = 3;

/// A valid mesh that keeps the tolerance.
pub(super) struct Refined {
    pub coarse: QuadMesh,
    /// The same before it was coarsened.
    pub fine: QuadMesh,
}

/// Makes the layout's quads curved elements that keep the tolerance.
pub(super) fn refine_and_smooth(
    boundary: &Boundary,
    options: &Options,
    tolerance: &BoundaryTolerance,
    layout: &QuadLayout,
    sizes: &ElementSize,
    watch: &mut Watch,
    stages: &mut Stages,
) -> Result<Refined> {
    let error = BoundaryError::new(*tolerance);
    let optimiser = Optimiser::new(boundary, options.order, Some(*tolerance));
    let mut mesh = start(boundary, layout)?;
    note(stages, &optimiser, &mesh, "layout");
    if mesh.quads.len() > LARGE {
        mesh = thinner(mesh, boundary, sizes);
        note(stages, &optimiser, &mesh, "thin");
    }
    if stages.attempts > 1 {
        mesh = watch.run(stages, Stage::Refine, |_| divide_long(mesh, boundary, sizes, options.order))?;
    }
    let allowed = |p| sizes.allowed(p);
    // A size that varies shapes the mesh from here on; one number divides the finished mesh (below).
    let limit = options.element_size.as_ref().map(|_| SizeLimit::new(&allowed));
    if let Some(limit) = &limit {
        mesh = watch.run(stages, Stage::Refine, |_| {
            limit.divide(mesh, boundary, 1.0, options.order, options.max_elements)
        })?;
        note(stages, &optimiser, &mesh, "divide");
        mesh = thinner(mesh, boundary, sizes);
        note(stages, &optimiser, &mesh, "thin");
    }
    let too_large = |mesh: &QuadMesh| limit.map(|limit| limit.too_long(mesh, TOO_LARGE)).unwrap_or_default();

    // Step 7: boundary vertices where the tolerance wants them, edges divided where that is not enough.
    mesh = watch.run(stages, Stage::Refine, |_| refine::meet_tolerance(mesh, boundary, &error, options))?;
    note(stages, &optimiser, &mesh, "subdivide");
    let most = MOST_GROWTH * mesh.quads.len();
    let floor = options.quality_floor * scaled_jacobian_ceiling(boundary);
    // What coarsening changes again need not be better than it asks for.
    let coarsens = options.subdivision == Subdivision::EqualError;
    let aim = coarsens.then(|| Aim::at(AMPLE * floor));
    for round in 0..ROUNDS {
        // Step 8: smooth, and untangle if need be.
        let holds = |mesh: &QuadMesh| {
            let quality = optimiser.quality(mesh);
            quality.valid() && quality.error_ratio <= 1.0 && !too_large(mesh).contains(&true)
        };
        if round > 0 && holds(&mesh) {
            break;
        }
        let outcome = watch
            .run(stages, Stage::Smooth, |_| Ok(optimiser.optimise_until(&mut mesh, None, Care::Full, aim)))?;
        watch.work += outcome.work;
        note(stages, &optimiser, &mesh, "smooth");
        // Step 9: again where it does not hold yet. Divided edges keep their shape, so what is valid stays so.
        let quality = optimiser.quality(&mesh);
        let mut marked = vec![false; mesh.edges.len()];
        if quality.valid() {
            for (e, marked) in marked.iter_mut().enumerate() {
                *marked = optimiser.error_ratio(&mesh, e as u32) > 1.0;
            }
            marked.iter_mut().zip(too_large(&mesh)).for_each(|(marked, large)| *marked |= large);
        } else {
            let inverted = |q: &usize| quality.elements[*q].jacobian_ratio <= LEAST_JACOBIAN;
            let inverted: Vec<usize> = (0..mesh.quads.len()).filter(inverted).collect();
            if mesh.quads.len() <= LARGE || (inverted.len() as f64) < FEW * mesh.quads.len() as f64 {
                for e in inverted.iter().flat_map(|q| mesh.quad_edges[*q]) {
                    marked[e as usize] = true;
                }
            }
        }
        if !marked.contains(&true) || mesh.quads.len() > most || watch.work > most_work(&mesh) {
            break;
        }
        mesh = watch.run(stages, Stage::Refine, |_| {
            refine::split_chords(&mesh, boundary, &marked, options.order)
                .map_err(|(reason, at)| Error::Layout { reason, at: Some(at) })
        })?;
        note(stages, &optimiser, &mesh, "subdivide");
    }
    let quality = optimiser.quality(&mesh);
    if !quality.valid() {
        let worst = (0..mesh.quads.len())
            .min_by(|&a, &b| {
                quality.elements[a].scaled_jacobian.total_cmp(&quality.elements[b].scaled_jacobian)
            })
            .unwrap_or(0);
        let at = mesh.vertices[mesh.quads[worst][0] as usize].point;
        return Err(Error::InvalidElement { jacobian: quality.min_scaled_jacobian, at });
    }
    let fine = mesh.clone();
    if coarsens && watch.work <= most_work(&mesh) {
        mesh = fewer_elements(mesh, &optimiser, floor, limit, options.effort, watch, stages)?;
    }
    Ok(Refined { coarse: mesh, fine })
}

/// Work after which no further round begins on `mesh`, nor its coarsening.
fn most_work(mesh: &QuadMesh) -> u64 {
    MOST_WORK.max(WORK_PER_QUAD * mesh.quads.len() as u64)
}

/// The mesh with strips ended that are much finer than wanted, if that pays: it costs irregular vertices.
fn thinner(mesh: QuadMesh, boundary: &Boundary, sizes: &ElementSize) -> QuadMesh {
    let thin = refine::thin(mesh.clone(), boundary, &|p| sizes.at(p));
    if (thin.quads.len() as f64) < WORTH * mesh.quads.len() as f64 {
        thin
    } else {
        mesh
    }
}

/// For later attempts: where the integer lengths left edges of many times the wanted size, divides their
/// chords. An element from a small part straight to the far field could not be untangled.
fn divide_long(
    mut mesh: QuadMesh,
    boundary: &Boundary,
    sizes: &ElementSize,
    order: usize,
) -> Result<QuadMesh> {
    let most = MOST_GROWTH * mesh.quads.len();
    for _ in 0..ROUNDS {
        let wanted = |e: &crate::mesh::Edge| {
            let [a, b] = e.vertices.map(|v| mesh.vertices[v as usize].point);
            let length = e.span.map_or((b - a).norm(), |s| s.end - s.start);
            let points = [0.1, 0.3, 0.5, 0.7, 0.9].map(|t| a + (b - a) * t);
            points.iter().map(|p| 0.2 * length / sizes.at(*p)).sum::<f64>()
        };
        let marked: Vec<bool> = mesh.edges.iter().map(|e| wanted(e) > TOO_LONG).collect();
        if !marked.contains(&true) {
            break;
        }
        let finer = refine::split_chords(&mesh, boundary, &marked, order)
            .map_err(|(reason, at)| Error::Layout { reason, at: Some(at) })?;
        if finer.quads.len() > most {
            break;
        }
        mesh = finer;
    }
    Ok(mesh)
}

/// The layout as a mesh with straight interior edges. Its vertices are put on grids fine against the edges
/// there: where they lie exactly does not matter yet, and the rounding errors of the input, which the
/// streamlines made a thousand times as much, end here.
fn start(boundary: &Boundary, layout: &QuadLayout) -> Result<QuadMesh> {
    let mut shortest = vec![f64::INFINITY; layout.vertices.len()];
    for quad in &layout.quads {
        for i in 0..4 {
            let ends = [quad[i] as usize, quad[(i + 1) % 4] as usize];
            let [a, b] = ends.map(|v| layout.vertices[v].point);
            ends.iter().for_each(|v| shortest[*v] = shortest[*v].min((b - a).norm()));
        }
    }
    let snap = |x: f64, cell: f64| if cell > 0.0 { (x / cell).round() * cell } else { x };
    let vertices = layout.vertices.iter().zip(shortest).map(|(v, shortest)| {
        let cell = START_GRID * (OFF_POWERS * shortest).log2().floor().exp2();
        match v.place {
            Place::Interior => {
                let point = Point::new(snap(v.point.x, cell), snap(v.point.y, cell));
                Vertex { point, place: v.place }
            }
            Place::Boundary(p) => {
                let s = boundary.chains[p.chain as usize].wrap(snap(p.s, cell));
                let place = Place::Boundary(BoundaryPoint { s, ..p });
                Vertex { point: boundary.point(place).unwrap_or(v.point), place }
            }
            Place::Junction(_) => {
                Vertex { point: boundary.point(v.place).unwrap_or(v.point), place: v.place }
            }
        }
    });
    let vertices = vertices.collect();
    QuadMesh::new(boundary, vertices, layout.quads.clone(), layout.region.clone(), &HashMap::new())
        .map_err(|(reason, at)| Error::Layout { reason, at: Some(at) })
}

/// Notes what a round left.
pub(super) fn note(stages: &mut Stages, optimiser: &Optimiser, mesh: &QuadMesh, action: &'static str) {
    let quality = optimiser.quality(mesh);
    stages.quad_mesh = Some(mesh.clone());
    stages.rounds.push(Round {
        action,
        elements: mesh.quads.len(),
        scaled_jacobian: quality.min_scaled_jacobian,
        boundary_error: quality.error_ratio,
    });
}
