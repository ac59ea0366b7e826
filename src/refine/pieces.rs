//! The least number of order-N edges with which a chain keeps the tolerance.

use crate::domain::Chain;
use crate::error::{Error, Result};
use crate::mesh::BoundaryError;
use crate::numerics::tolerances::{LEAST_TOLERANCE, LONGEST_LOOP_SHARE, SHORTEST_EDGE};
use crate::options::Norm;

/// Most edges looked for on one chain: a tolerance that takes more is below the rounding of the curve.
const MOST_PIECES: usize = 100_000;
/// Most steps of one search for the end of an edge: 0.7^60 is below the shortest edge.
const SEARCH_STEPS: usize = 60;
/// The search for a piece's end stops when the bracket is this share of the piece.
const SEARCH_WIDTH: f64 = 2e-3;

/// Exponent p of the error's growth with an edge's length on a smooth curve: error ~ length^p.
pub(super) fn growth(error: &BoundaryError) -> f64 {
    let order = error.tolerance.order as f64;
    match error.tolerance.norm {
        Norm::L2 | Norm::H1 => order + 1.5,
        Norm::Max => order + 1.0,
    }
}

/// Longest edge allowed on a chain: a closed chain has at least three.
pub(super) fn longest_edge(chain: &Chain) -> f64 {
    if chain.ends.is_none() {
        chain.length * LONGEST_LOOP_SHARE
    } else {
        chain.length
    }
}

/// End of the longest edge from `from` whose error is at most `level`, at most `limit`; `guess` is
/// the expected length. `None`: not even the shortest edge is good enough.
pub(super) fn longest_piece(
    chain: &Chain,
    error: &BoundaryError,
    from: f64,
    limit: f64,
    level: f64,
    guess: f64,
) -> Option<f64> {
    let exponent = 1.0 / growth(error);
    // (length, error) of the longest good and the shortest bad edge so far.
    let mut good: Option<(f64, f64)> = None;
    let mut bad: Option<(f64, f64)> = None;
    let whole = limit - from;
    let mut length = guess.min(whole);
    for step in 0..SEARCH_STEPS {
        let end = if length >= whole { limit } else { from + length };
        let e = error.of_chain(chain, from, end);
        if e <= level {
            if end >= limit {
                return Some(limit);
            }
            good = Some((length, e));
        } else {
            bad = Some((length, e));
        }
        // Off a smooth curve the power law is only a guess: every step is kept within bounds.
        let power_law = |(l, e): (f64, f64)| l * (level / e).powf(exponent);
        length = match (good, bad) {
            (Some(g), None) => power_law(g).clamp(1.05 * g.0, 2.0 * g.0),
            (None, Some(b)) if b.0 > SHORTEST_EDGE => power_law(b).clamp(0.125 * b.0, 0.7 * b.0),
            (Some(g), Some(b)) if b.0 - g.0 > SEARCH_WIDTH * b.0 => {
                // The secant in logarithms, and now and then a bisection.
                let share = (level / g.1).ln() / (b.1 / g.1).ln();
                let share = if step % 3 == 2 || !share.is_finite() { 0.5 } else { share.clamp(0.0, 1.0) };
                let margin = 0.4 * SEARCH_WIDTH * b.0;
                (g.0 * (b.0 / g.0).powf(share)).clamp(g.0 + margin, b.0 - margin)
            }
            _ => break,
        };
    }
    good.map(|g| from + g.0)
}

/// Positions of greedily longest edges from `start` to `end`, both included; `None` when an edge fails
/// or there would be more than `most` edges.
pub(super) fn greedy(
    chain: &Chain,
    error: &BoundaryError,
    start: f64,
    end: f64,
    level: f64,
    most: usize,
) -> Option<Vec<f64>> {
    let longest = longest_edge(chain);
    let mut positions = vec![start];
    let (mut at, mut guess) = (start, longest.min(end - start));
    while at < end {
        if positions.len() > most {
            return None;
        }
        let limit = if at + longest >= end * (1.0 - f64::EPSILON) { end } else { at + longest };
        let next = longest_piece(chain, error, at, limit, level, guess)?;
        guess = next - at;
        positions.push(next);
        at = next;
    }
    Some(positions)
}

/// Least number of edges with which the whole `chain` keeps the tolerance of `error` (3 or more
/// on a closed chain). Greedy: each edge as long as the tolerance allows.
///
/// # Errors
/// [`Error::Tolerance`] when the tolerance cannot be reached (it is below rounding).
pub fn least_pieces(chain: &Chain, error: &BoundaryError) -> Result<usize> {
    Ok(fewest(chain, error, error.tolerance.value)?.len() - 1)
}

/// The greedy positions behind [`least_pieces`] at error `level`; on a closed chain the best of a few starts.
pub(super) fn fewest(chain: &Chain, error: &BoundaryError, level: f64) -> Result<Vec<f64>> {
    let failed = || Error::Tolerance {
        error: error.of_chain(chain, 0.0, SHORTEST_EDGE.min(chain.length)),
        tolerance: level,
        at: chain.point(0.0),
    };
    if level < LEAST_TOLERANCE {
        // Whatever an edge's own error is measured as, rounding is more.
        return Err(Error::Tolerance { error: LEAST_TOLERANCE, tolerance: level, at: chain.point(0.0) });
    }
    let from = |start: f64| greedy(chain, error, start, start + chain.length, level, MOST_PIECES);
    if chain.ends.is_some() {
        return greedy(chain, error, 0.0, chain.length, level, MOST_PIECES).ok_or_else(failed);
    }
    let mut best = from(0.0).ok_or_else(failed)?;
    // The last edge is a remainder; another start can save it.
    for share in [0.25, 0.5, 0.75, 1.0] {
        let start = chain.wrap(best[1] * share);
        if let Some(other) = from(start) {
            if other.len() < best.len() {
                best = other;
                break;
            }
        }
    }
    Ok(best)
}
