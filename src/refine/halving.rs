//! The paper's subdivision of boundary edges: halve at the middle until the norm holds.

use super::placement::Placement;
use crate::domain::Chain;
use crate::error::{Error, Result};
use crate::mesh::BoundaryError;
use crate::numerics::tolerances::SHORTEST_EDGE;

/// Halves, in arc length, every edge between consecutive `positions` of `chain` until each keeps
/// the tolerance (Algorithm 1 of the paper). `positions` are ascending; on a closed chain the last is
/// the first plus the length.
///
/// # Errors
/// [`Error::Tolerance`] with the place when an edge is too short to be halved further.
pub fn place_by_halving(chain: &Chain, error: &BoundaryError, positions: &[f64]) -> Result<Placement> {
    let mut result = Placement { positions: positions[..positions.len().min(1)].to_vec(), largest: 0.0 };
    for pair in positions.windows(2) {
        // Ends of edges still to be tested, the nearest last.
        let mut ends = vec![pair[1]];
        let mut start = pair[0];
        while let Some(&end) = ends.last() {
            let ratio = error.of_chain(chain, start, end) / error.tolerance.value;
            if ratio <= 1.0 {
                result.positions.push(end);
                result.largest = result.largest.max(ratio);
                start = end;
                ends.pop();
            } else if end - start > SHORTEST_EDGE {
                ends.push(0.5 * (start + end));
            } else {
                return Err(Error::Tolerance {
                    error: ratio * error.tolerance.value,
                    tolerance: error.tolerance.value,
                    at: chain.point(start),
                });
            }
        }
    }
    Ok(result)
}
