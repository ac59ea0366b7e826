//! Re-spacing part of a chain until every edge keeps the tolerance again, moving as little as possible.

use super::pieces::growth;
use super::placement::place_equal_error;
use crate::domain::{Boundary, BoundaryPoint, Place, Span};
use crate::mesh::{BoundaryError, QuadMesh};
use crate::numerics::tolerances::ORDER_TIE;

/// Share of the tolerance that re-spaced edges aim at: room for the optimiser to slide.
const AIM: f64 = 0.9;
/// An edge is left alone up to this share.
const ALLOWED: f64 = 0.97;
/// An edge takes over at most this multiple of its length in one round.
const STRETCH: f64 = 1.6;
/// Rounds for one window, and in all.
const ROUNDS: usize = 8;

/// Makes the edges of `chain` keep the tolerance by moving vertices along it, near the offending
/// edges first, along the whole chain at worst. The vertices moved; `None` if it cannot be done.
pub(super) fn respace(
    boundary: &Boundary,
    error: &BoundaryError,
    mesh: &mut QuadMesh,
    chain: u32,
) -> Option<Vec<u32>> {
    let mut edges: Vec<u32> = (0..mesh.edges.len() as u32)
        .filter(|e| mesh.edges[*e as usize].span.is_some_and(|s| s.chain == chain))
        .collect();
    let span = |mesh: &QuadMesh, e: u32| mesh.edges[e as usize].span;
    let start = |mesh: &QuadMesh, e: u32| span(mesh, e).map_or(0.0, |s| s.start);
    edges.sort_by(|a, b| start(mesh, *a).total_cmp(&start(mesh, *b)));
    let first = start(mesh, *edges.first()?);
    let curve = &boundary.chains[chain as usize];
    let closed = curve.ends.is_none();
    let n = edges.len();
    // Ends of the edges along the chain, from the first edge on, unwrapped.
    let mut ends = vec![first];
    for e in &edges {
        let s = span(mesh, *e)?;
        ends.push(ends[ends.len() - 1] + (s.end - s.start));
    }
    let ratio = |ends: &[f64], i: usize| {
        // Twice around, so that windows may run over the seam.
        let (a, b) = (ends[i % n] + curve.length * (i / n) as f64, ends[i % n + 1] - ends[i % n]);
        error.of_chain(curve, a, a + b) / error.tolerance.value
    };
    let mut ratios: Vec<f64> = (0..n).map(|i| ratio(&ends, i)).collect();
    let before = ends.clone();
    let rank = |ratio: f64| (ratio / ORDER_TIE).round();
    let mut budget = 4 * n + 16;
    while let Some(worst) =
        (0..n).filter(|i| ratios[*i] > ALLOWED).max_by(|a, b| rank(ratios[*a]).total_cmp(&rank(ratios[*b])))
    {
        let mut reach = 1;
        loop {
            if budget == 0 {
                return whole_chain(boundary, error, mesh, chain, &edges, &ends);
            }
            budget -= 1;
            let width = (2 * reach + 1).min(n);
            let low = if closed {
                (worst + n - reach.min(n / 2)) % n
            } else {
                worst.saturating_sub(reach).min(n - width)
            };
            // A closed chain's window of all edges would have to keep one vertex anyway.
            if width == n && reach > n {
                return whole_chain(boundary, error, mesh, chain, &edges, &ends);
            }
            if let Some(lengths) = share_out(curve.length, error, &ends, low, width, n, &ratio) {
                apply(&mut ends, low, &lengths, n, curve.length);
                for i in low..low + width {
                    ratios[i % n] = ratio(&ends, i % n);
                }
                break;
            }
            reach += 1;
        }
    }
    Some(write(boundary, mesh, chain, &edges, &before, &ends))
}

/// New lengths of the `width` edges from `low` on, all within the tolerance; `None` if they have no room.
fn share_out(
    whole: f64,
    error: &BoundaryError,
    ends: &[f64],
    low: usize,
    width: usize,
    n: usize,
    ratio: &dyn Fn(&[f64], usize) -> f64,
) -> Option<Vec<f64>> {
    let exponent = 1.0 / growth(error);
    let mut trial = ends.to_vec();
    let mut lengths: Vec<f64> = (low..low + width).map(|i| ends[i % n + 1] - ends[i % n]).collect();
    let total: f64 = lengths.iter().sum();
    for _ in 0..ROUNDS {
        let ratios: Vec<f64> = (low..low + width).map(|i| ratio(&trial, i % n)).collect();
        if ratios.iter().all(|r| *r <= ALLOWED) {
            return Some(lengths);
        }
        let room: Vec<f64> =
            ratios.iter().map(|r| (AIM / r.max(1e-9)).powf(exponent).clamp(0.3, STRETCH)).collect();
        let shrunk: f64 = lengths.iter().zip(&room).map(|(l, r)| l * r.min(1.0)).sum();
        let slack: f64 = lengths.iter().zip(&room).map(|(l, r)| l * (r - 1.0).max(0.0)).sum();
        let missing = total - shrunk;
        if missing > slack {
            return None;
        }
        let share = missing / slack;
        for (l, r) in lengths.iter_mut().zip(&room) {
            *l *= if *r > 1.0 { 1.0 + share * (r - 1.0) } else { *r };
        }
        apply(&mut trial, low, &lengths, n, whole);
    }
    None
}

/// Sets the edges from `low` on to `lengths`, whose sum is what it was.
fn apply(ends: &mut [f64], low: usize, lengths: &[f64], n: usize, whole: f64) {
    let mut at = ends[low];
    for (k, length) in lengths.iter().enumerate().take(lengths.len() - 1) {
        at += length;
        let i = low + k + 1;
        if i < n {
            ends[i] = at;
        } else {
            // Over the seam: the first entry and the last are the same vertex.
            ends[i - n] = at - whole;
            if i == n {
                ends[n] = at;
            }
        }
    }
}

/// The last resort: all vertices of the chain by equal error.
fn whole_chain(
    boundary: &Boundary,
    error: &BoundaryError,
    mesh: &mut QuadMesh,
    chain: u32,
    edges: &[u32],
    ends: &[f64],
) -> Option<Vec<u32>> {
    let curve = &boundary.chains[chain as usize];
    let placement = place_equal_error(curve, error, edges.len(), ends[0]);
    if placement.largest > 1.0 {
        return None;
    }
    Some(write(boundary, mesh, chain, edges, &[], &placement.positions))
}

/// Moves the vertices of the chain's edges to `ends`; those that were elsewhere `before` (all, if empty).
fn write(
    boundary: &Boundary,
    mesh: &mut QuadMesh,
    chain: u32,
    edges: &[u32],
    before: &[f64],
    ends: &[f64],
) -> Vec<u32> {
    let curve = &boundary.chains[chain as usize];
    let mut moved = Vec::new();
    for (i, e) in edges.iter().enumerate() {
        if before.get(i) == Some(&ends[i]) && before.get(i + 1) == Some(&ends[i + 1]) {
            continue;
        }
        let start = if curve.ends.is_none() { curve.wrap(ends[i]) } else { ends[i] };
        mesh.edges[*e as usize].span = Some(Span { chain, start, end: start + (ends[i + 1] - ends[i]) });
        let v = mesh.edges[*e as usize].vertices[0];
        let vertex = &mut mesh.vertices[v as usize];
        if let Place::Boundary(p) = &mut vertex.place {
            if p.s != start {
                *p = BoundaryPoint { chain, s: start };
                vertex.point = curve.point(start);
                moved.push(v);
            }
        }
    }
    moved
}
