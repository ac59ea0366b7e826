//! Vertices on a chain, placed where all edges have the same error.

use super::pieces::{fewest, greedy, growth};
use crate::domain::Chain;
use crate::mesh::BoundaryError;
use crate::numerics::tolerances::PLACEMENT_MARGIN;

/// Where the vertices of a chain lie.
#[derive(Debug, Clone, PartialEq)]
pub struct Placement {
    /// Arc lengths of the edges' ends, ascending, one more than there are edges. On a closed chain the
    /// last is the first plus the length, and both are the same vertex.
    pub positions: Vec<f64>,
    /// Largest error of an edge, divided by the tolerance.
    pub largest: f64,
}

/// Rounds of equidistribution; it converges in 3 to 6 on smooth chains, and the best round is kept.
const ROUNDS: usize = 12;
/// Equidistribution has converged when no vertex moves by more than this share of its edge.
const SETTLED: f64 = 0.02;
/// The bisection on the common error stops at this ratio of its brackets ...
const LEVEL_RATIO: f64 = 1.02;
/// ... and when the margin is kept anyway at this one.
const SPARE_RATIO: f64 = 2.0;
/// Share of the edges that is always spread evenly, so that straight parts get vertices as well.
const EVEN_SHARE: f64 = 0.03;

/// Places the ends of `pieces` edges on the whole of `chain`: as many as the tolerance needs where the
/// errors are equal, the spare ones evenly in arc length. On a closed chain the first vertex is at
/// `start` unless only another start keeps the tolerance; else `start` is not used.
///
/// Edges aim at 0.9 of the tolerance, so that later sliding does not spoil it. With
/// [`least_pieces`](super::least_pieces) edges or more, `largest` ≤ 1 comes out; with fewer it is
/// near the least possible.
pub fn place_equal_error(chain: &Chain, error: &BoundaryError, pieces: usize, start: f64) -> Placement {
    let pieces = pieces.max(1);
    let closed = chain.ends.is_none();
    let start = if closed { chain.wrap(start) } else { 0.0 };
    let spread = equidistribute(chain, error, start, pieces);
    if spread.largest <= PLACEMENT_MARGIN {
        return spread;
    }
    let mut best = better(spread, common_level(chain, error, start, pieces));
    if best.largest > 1.0 && closed {
        if let Ok(other) = fewest(chain, error, error.tolerance.value) {
            best = better(best, common_level(chain, error, other[0], pieces));
        }
    }
    best
}

fn better(a: Placement, b: Option<Placement>) -> Placement {
    match b {
        Some(b) if b.largest < a.largest => b,
        _ => a,
    }
}

/// The edges' errors divided by the tolerance.
fn ratios(chain: &Chain, error: &BoundaryError, positions: &[f64]) -> Vec<f64> {
    positions.windows(2).map(|w| error.of_chain(chain, w[0], w[1]) / error.tolerance.value).collect()
}

fn largest(ratios: &[f64]) -> f64 {
    ratios.iter().copied().fold(0.0, f64::max)
}

/// De Boor's equidistribution from equal spacing. On an edge of length h and error e the density
/// (e/tolerance)^{1/p} / h is the number of edges wanted per length; its integral is about the number
/// the chain needs, and what is spare is added as a constant density.
fn equidistribute(chain: &Chain, error: &BoundaryError, start: f64, pieces: usize) -> Placement {
    let (length, closed) = (chain.length, chain.ends.is_none());
    let exponent = 1.0 / growth(error);
    let mut positions: Vec<f64> = (0..=pieces).map(|i| start + length * i as f64 / pieces as f64).collect();
    positions[pieces] = start + length;
    let mut best: Option<Placement> = None;
    for _ in 0..ROUNDS {
        let ratios = ratios(chain, error, &positions);
        let now = largest(&ratios);
        if best.as_ref().is_none_or(|b| now < b.largest || now <= PLACEMENT_MARGIN) {
            best = Some(Placement { positions: positions.clone(), largest: now });
        }
        let width = |i: usize| positions[i + 1] - positions[i];
        let raw: Vec<f64> = ratios
            .iter()
            .enumerate()
            .map(|(i, r)| (r / PLACEMENT_MARGIN).powf(exponent).min(1e6) / width(i))
            .collect();
        // Neighbours are averaged: without it the iteration jumps to and fro at kinks.
        let smooth: Vec<f64> = (0..pieces)
            .map(|i| {
                let before = if i > 0 {
                    i - 1
                } else if closed {
                    pieces - 1
                } else {
                    0
                };
                let after = if i + 1 < pieces {
                    i + 1
                } else if closed {
                    0
                } else {
                    i
                };
                (0.25 * (raw[before] + raw[after]) + 0.5 * raw[i]).max(0.9 * raw[i])
            })
            .collect();
        let needed: f64 = smooth.iter().enumerate().map(|(i, d)| d * width(i)).sum();
        let even = (pieces as f64 - needed).max(EVEN_SHARE * pieces as f64) / length;
        let total = needed + even * length;
        // Invert the cumulative density.
        let mut next = Vec::with_capacity(pieces + 1);
        next.push(start);
        let (mut cell, mut below) = (0, 0.0);
        for k in 1..pieces {
            let wanted = total * k as f64 / pieces as f64;
            let mut mass = (smooth[cell] + even) * width(cell);
            while below + mass < wanted && cell + 1 < pieces {
                below += mass;
                cell += 1;
                mass = (smooth[cell] + even) * width(cell);
            }
            next.push(positions[cell] + width(cell) * ((wanted - below) / mass).clamp(0.0, 1.0));
        }
        next.push(start + length);
        let moved = (1..pieces).map(|i| (next[i] - positions[i]).abs() / width(i).min(width(i - 1)));
        let settled = moved.fold(0.0, f64::max) < SETTLED;
        if next.windows(2).any(|w| w[1] <= w[0]) || settled {
            break;
        }
        positions = next;
    }
    best.unwrap_or(Placement { positions, largest: f64::INFINITY })
}

/// Greedily longest edges of a common error for which `pieces` are enough, found by bisection on the error;
/// edges left over halve the longest ones. Always finds what [`greedy`] finds at the tolerance.
fn common_level(chain: &Chain, error: &BoundaryError, start: f64, pieces: usize) -> Option<Placement> {
    let end = start + chain.length;
    let at = |level: f64| greedy(chain, error, start, end, level, pieces);
    let mut high = PLACEMENT_MARGIN * error.tolerance.value;
    let mut found = at(high);
    // Only as exact as the use: with the margin any level will do that leaves few edges over,
    // without it the least one is wanted.
    let (mut low, ratio) = if found.is_some() { (high / 1024.0, SPARE_RATIO) } else { (high, LEVEL_RATIO) };
    if found.is_none() {
        high = error.tolerance.value;
        found = at(high);
    }
    // Fewer edges than the tolerance needs: the level that they can have lies above it.
    for _ in 0..40 {
        if found.is_some() {
            break;
        }
        (low, high) = (high, high * 8.0);
        found = at(high);
    }
    let mut found = found?;
    while high / low > ratio && !(high <= PLACEMENT_MARGIN * error.tolerance.value && found.len() > pieces) {
        let middle = (high * low).sqrt();
        match at(middle) {
            Some(positions) => (high, found) = (middle, positions),
            None => low = middle,
        }
    }
    while found.len() <= pieces {
        let longest = (0..found.len() - 1).max_by(|a, b| {
            (found[a + 1] - found[*a]).total_cmp(&(found[b + 1] - found[*b])).then(b.cmp(a))
        })?;
        found.insert(longest + 1, 0.5 * (found[longest] + found[longest + 1]));
    }
    let largest = largest(&ratios(chain, error, &found));
    Some(Placement { positions: found, largest })
}
