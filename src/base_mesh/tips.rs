//! Sharp corners where the base mesh has to be fine for the sake of the cross field.

use crate::domain::Boundary;
use crate::numerics::cross;
use crate::numerics::tolerances::{TIP_DOUBT, TIP_SHARE, TIP_TURN};
use crate::numerics::Point;

/// How far from junction `j` the walls are straight enough for the corner's own solution; `None` if
/// the sense in which the cross turns there is not in doubt.
///
/// Across a corner near 45° the cross turns by about 45°, one way with one quad there and the other
/// way with none: linear elements cannot tell which.
pub fn doubtful_reach(boundary: &Boundary, j: u32) -> Option<f64> {
    let junction = &boundary.junctions[j as usize];
    if !(TIP_DOUBT[0]..TIP_DOUBT[1]).contains(&junction.angle) {
        return None;
    }
    let along = |chain: u32, forward: bool| {
        let chain = &boundary.chains[chain as usize];
        let from = chain.tangent(if forward { 0.0 } else { chain.length });
        let mut reach = TIP_SHARE * chain.length;
        // Halved until the wall turns little; curvature is finite, so few halvings do.
        for _ in 0..24 {
            let tangent = chain.tangent(if forward { reach } else { chain.length - reach });
            if cross(from, tangent).atan2(from.dot(&tangent)).abs() < TIP_TURN {
                break;
            }
            reach *= 0.5;
        }
        reach
    };
    Some(along(junction.chain_out, true).min(along(junction.chain_in, false)))
}

/// The doubtful corners, each with its reach.
pub fn doubtful_corners(boundary: &Boundary) -> Vec<(Point, f64)> {
    (0u32..)
        .zip(&boundary.junctions)
        .filter_map(|(j, junction)| Some((junction.point, doubtful_reach(boundary, j)?)))
        .collect()
}
