//! Angles where segments join.

use crate::domain::segment::CurveSegment;
use crate::error::Result;
use crate::numerics::tolerances::REVERSAL;
use crate::numerics::{cross, Point};
use std::f64::consts::PI;

/// Change of direction from the end of `a` to the start of `b`, in (−π, π], left positive.
pub(crate) fn turn(a: &CurveSegment, b: &CurveSegment) -> Result<f64> {
    let (u, v) = (a.end_tangent(true)?, b.end_tangent(false)?);
    Ok(cross(u, v).atan2(u.dot(&v)))
}

/// Angle through the domain (to the left) where `a` ends and `b` starts, in [0, 2π].
///
/// Where the direction is reversed, 0 and 2π are told apart by the side on which the outgoing
/// branch lies near the tip.
pub(crate) fn interior_angle(a: &CurveSegment, b: &CurveSegment) -> Result<f64> {
    let turn = turn(a, b)?;
    if PI - turn.abs() > REVERSAL {
        return Ok(PI - turn);
    }
    let direction = a.end_tangent(true)?;
    let tip = b.start()?;
    let reach = a.size()?.min(b.size()?);
    let mut side = 0.0;
    for share in [1e-3, 1e-2, 5e-2, 0.1, 0.2] {
        let before = point_at_distance(a, true, tip, share * reach)?;
        let after = point_at_distance(b, false, tip, share * reach)?;
        if let (Some(before), Some(after)) = (before, after) {
            side = cross(direction, after - before);
            if side.abs() > 1e-12 * reach {
                break;
            }
        }
    }
    Ok(if side >= 0.0 { 0.0 } else { 2.0 * PI })
}

/// The first point of `segment`, walked from its end (`from_end`) or start, at `distance` from `tip`.
fn point_at_distance(
    segment: &CurveSegment,
    from_end: bool,
    tip: Point,
    distance: f64,
) -> Result<Option<Point>> {
    let at = |share: f64| segment.point(if from_end { 1.0 - share } else { share });
    let steps = 64;
    for k in 1..=steps {
        let mut high = k as f64 / steps as f64;
        if (at(high)? - tip).norm() < distance {
            continue;
        }
        let mut low = (k - 1) as f64 / steps as f64;
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if (at(middle)? - tip).norm() < distance {
                low = middle;
            } else {
                high = middle;
            }
        }
        return at(high).map(Some);
    }
    Ok(None)
}
