//! Boundary vertices moved along their chains, as little as the tolerance allows.

use super::place_equal_error;
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::mesh::{BoundaryError, QuadMesh};
use crate::numerics::tolerances::PLACEMENT_MARGIN;

/// Steps from the present places (0) to those of equal error (1).
const BLENDS: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Moves the boundary vertices of every chain towards places of equal error until each edge keeps the
/// tolerance, no farther than needed. Returns the boundary edges of chains that have too few.
pub fn slide_to_tolerance(mesh: &mut QuadMesh, boundary: &Boundary, error: &BoundaryError) -> Vec<u32> {
    let mut short = Vec::new();
    let mut edges: Vec<u32> =
        (0..mesh.edges.len() as u32).filter(|&e| mesh.edges[e as usize].span.is_some()).collect();
    let key = |mesh: &QuadMesh, e: u32| {
        mesh.edges[e as usize].span.map_or((u32::MAX, 0.0), |span| {
            (span.chain, boundary.chains[span.chain as usize].wrap(span.start))
        })
    };
    edges.sort_by(|&a, &b| {
        let (x, y) = (key(mesh, a), key(mesh, b));
        x.0.cmp(&y.0).then(x.1.total_cmp(&y.1))
    });
    for own in edges.chunk_by(|&a, &b| key(mesh, a).0 == key(mesh, b).0) {
        let id = key(mesh, own[0]).0;
        let chain = &boundary.chains[id as usize];
        let k = own.len();
        let mut now: Vec<f64> = own.iter().map(|&e| key(mesh, e).1).collect();
        now.push(if chain.ends.is_none() { now[0] + chain.length } else { chain.length });
        let largest = |s: &[f64]| {
            s.windows(2).map(|w| error.of_chain(chain, w[0], w[1])).fold(0.0, f64::max) / error.tolerance.value
        };
        if largest(&now) <= PLACEMENT_MARGIN {
            continue;
        }
        let wanted = aligned(&place_equal_error(chain, error, k, now[0]).positions, &now, chain.length);
        let blended = |x: f64| -> Vec<f64> { now.iter().zip(&wanted).map(|(a, b)| a + x * (b - a)).collect() };
        let best = BLENDS.iter().map(|&x| blended(x)).find(|s| largest(s) <= PLACEMENT_MARGIN);
        let places = best.unwrap_or_else(|| {
            let last = blended(1.0);
            if largest(&last) > 1.0 {
                short.extend_from_slice(own);
            }
            last
        });
        for (i, &e) in own.iter().enumerate() {
            let v = mesh.edges[e as usize].vertices[0] as usize;
            if let Place::Boundary(_) = mesh.vertices[v].place {
                let s = chain.wrap(places[i]);
                mesh.vertices[v].place = Place::Boundary(BoundaryPoint { chain: id, s });
                mesh.vertices[v].point = chain.point(s);
            }
        }
        for &e in own {
            let edge = &mut mesh.edges[e as usize];
            let [a, b] = edge.vertices.map(|v| mesh.vertices[v as usize].place);
            edge.span = boundary.span(a, b);
        }
    }
    short
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
