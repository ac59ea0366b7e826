//! Boundary vertices moved along their chains, as little as the tolerance allows.

use super::stretch::Stretch;
use super::{place_equal_error, split_chords, subdivide};
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::error::{Error, Result};
use crate::mesh::{BoundaryError, QuadMesh};
use crate::numerics::tolerances::PLACEMENT_MARGIN;
use crate::options::{Options, Subdivision};

/// Steps from the present places (0) to those of equal error (1).
const BLENDS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Moves the boundary vertices of every chain towards places of equal error until each edge keeps the
/// tolerance, no farther than needed. Returns the boundary edges of chains that have too few.
fn slide_to_tolerance(mesh: &mut QuadMesh, boundary: &Boundary, error: &BoundaryError) -> Vec<u32> {
    let mut short = Vec::new();
    // (chain, arc length of its start, edge), in order along the chains.
    let mut edges: Vec<(u32, f64, u32)> = Vec::new();
    for (e, edge) in mesh.edges.iter().enumerate() {
        if let Some(span) = edge.span {
            edges.push((span.chain, boundary.chains[span.chain as usize].wrap(span.start), e as u32));
        }
    }
    edges.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    for own in edges.chunk_by(|a, b| a.0 == b.0) {
        let id = own[0].0;
        let chain = &boundary.chains[id as usize];
        let k = own.len();
        let mut now: Vec<f64> = own.iter().map(|e| e.1).collect();
        now.push(if chain.ends.is_none() { now[0] + chain.length } else { chain.length });
        let largest = |s: &[f64]| {
            s.windows(2).map(|w| error.of_chain(chain, w[0], w[1])).fold(0.0, f64::max)
                / error.tolerance.value
        };
        if largest(&now) <= PLACEMENT_MARGIN {
            continue;
        }
        let mut stretch = Stretch { curve: chain, error, ends: now.clone(), whole: true };
        if stretch.relax() {
            write(mesh, boundary, own, &stretch.ends);
            continue;
        }
        let wanted = aligned(&place_equal_error(chain, error, k, now[0]).positions, &now, chain.length);
        let blended =
            |x: f64| -> Vec<f64> { now.iter().zip(&wanted).map(|(a, b)| a + x * (b - a)).collect() };
        let best = BLENDS.iter().map(|&x| blended(x)).find(|s| largest(s) <= PLACEMENT_MARGIN);
        let places = best.unwrap_or_else(|| {
            let last = blended(1.0);
            if largest(&last) > 1.0 {
                short.extend(own.iter().map(|e| e.2));
            }
            last
        });
        write(mesh, boundary, own, &places);
    }
    short
}

/// Moves the starts of a chain's edges, as (chain, arc length before, edge) in order, to `places`.
fn write(mesh: &mut QuadMesh, boundary: &Boundary, own: &[(u32, f64, u32)], places: &[f64]) {
    for (&(id, _, e), place) in own.iter().zip(places) {
        let chain = &boundary.chains[id as usize];
        let v = mesh.edges[e as usize].vertices[0] as usize;
        if let Place::Boundary(_) = mesh.vertices[v].place {
            let s = chain.wrap(*place);
            mesh.vertices[v].place = Place::Boundary(BoundaryPoint { chain: id, s });
            mesh.vertices[v].point = chain.point(s);
        }
    }
    for &(_, _, e) in own {
        let edge = &mut mesh.edges[e as usize];
        let [a, b] = edge.vertices.map(|v| mesh.vertices[v as usize].place);
        edge.span = boundary.span(a, b);
    }
}

/// On a closed chain the shift of `wanted` (by whole edges and laps) that lies nearest to `now`.
fn aligned(wanted: &[f64], now: &[f64], length: f64) -> Vec<f64> {
    let k = now.len() - 1;
    if (wanted[0] - now[0]).abs() <= f64::EPSILON * length {
        return wanted.to_vec();
    }
    let at = |i: i64| {
        let lap = i.div_euclid(k as i64);
        wanted[i.rem_euclid(k as i64) as usize] + lap as f64 * length
    };
    let shifted = |j: i64| -> Vec<f64> { (0..=k as i64).map(|i| at(i + j)).collect() };
    let distance = |s: &[f64]| s.iter().zip(now).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
    let reach = 2 * k as i64;
    (-reach..=reach)
        .map(shifted)
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
        .unwrap_or_else(|| wanted.to_vec())
}

/// Most rounds of division in [`meet_tolerance`]; each doubles the edges of a chain that has too few.
const ROUNDS: usize = 12;

/// Step 7: slides boundary vertices, and divides edges where that is not enough, until every boundary
/// edge keeps the tolerance. With [`Subdivision::Halving`] vertices stay where they are and edges are
/// halved at the middle, as in the paper.
///
/// # Errors
/// [`Error::Tolerance`] with the place if the element limit is reached first.
pub fn meet_tolerance(
    mut mesh: QuadMesh,
    boundary: &Boundary,
    error: &BoundaryError,
    options: &Options,
) -> Result<QuadMesh> {
    if options.subdivision == Subdivision::Halving {
        return subdivide(mesh, boundary, error, options.max_elements);
    }
    for _ in 0..ROUNDS {
        let short = slide_to_tolerance(&mut mesh, boundary, error);
        let mut failing = vec![false; mesh.edges.len()];
        for e in short {
            let ratio = mesh.edges[e as usize].span.map_or(0.0, |span| error.ratio(boundary, span));
            failing[e as usize] = ratio > 1.0;
        }
        if !failing.contains(&true) {
            return Ok(mesh);
        }
        mesh = split_chords(&mesh, boundary, &failing, options.order)
            .map_err(|(reason, at)| Error::Layout { reason, at: Some(at) })?;
        if mesh.quads.len() > options.max_elements {
            break;
        }
    }
    let worst = mesh
        .edges
        .iter()
        .filter_map(|e| e.span)
        .map(|span| (error.of_span(boundary, span), span))
        .max_by(|a, b| a.0.total_cmp(&b.0));
    match worst {
        Some((e, span)) if e > error.tolerance.value => Err(Error::Tolerance {
            error: e,
            tolerance: error.tolerance.value,
            at: boundary.chains[span.chain as usize].point(span.start),
        }),
        _ => Ok(mesh),
    }
}
