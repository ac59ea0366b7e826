//! Corners inside a caller's curve: found by bisection of its turn, they divide the curve into segments.

use crate::domain::gauss::snap;
use crate::domain::junction;
use crate::domain::segment::CurveSegment;
use crate::error::Result;
use crate::numerics::tolerances::{CORNER_TURN, NO_EXTENT};
use crate::numerics::{cross, Vector};

/// Intervals looked at in each segment, and the most corners taken from one curve.
const INTERVALS: usize = 64;
const MOST_CORNERS: usize = 256;

/// Directions are those of chords over twice this much of the parameter, so that a missing derivative does not
/// matter; where a turn is still within that much, there is a corner.
const STEP: f64 = 1.0 / (1 << 30) as f64;

/// The segments between the corners of `segment`, in order.
pub(crate) fn split_at_corners(segment: CurveSegment) -> Result<Vec<CurveSegment>> {
    if !segment.may_have_corners() {
        return Ok(vec![segment]);
    }
    let mut open = vec![segment];
    let mut parts = Vec::new();
    while let Some(segment) = open.pop() {
        let corner = if open.len() + parts.len() < MOST_CORNERS { corner_inside(&segment)? } else { None };
        match corner {
            Some([before, after]) => open.extend([after, before]),
            None => parts.push(segment),
        }
    }
    Ok(parts)
}

/// The parts before and after a corner of the segment, if it has one.
fn corner_inside(segment: &CurveSegment) -> Result<Option<[CurveSegment; 2]>> {
    let at = |k: usize| (k as f64 + 0.5) / (INTERVALS + 1) as f64;
    let mut before = direction(segment, at(0))?;
    for k in 1..=INTERVALS {
        let after = direction(segment, at(k))?;
        let t = narrowed(segment, [at(k - 1), at(k)], [before, after])?;
        before = after;
        let Some(t) = t else { continue };
        let parts = segment.split(located(segment, t)?);
        let least = NO_EXTENT.sqrt() * segment.size()?;
        // Where the parametrisation stands still tangents are noisy; those of the parts are not.
        if parts[0].size()? > least
            && parts[1].size()? > least
            && junction::turn(&parts[0], &parts[1])?.abs() > CORNER_TURN
        {
            return Ok(Some(parts));
        }
    }
    Ok(None)
}

/// Direction of the curve at `t`, not normalised.
fn direction(segment: &CurveSegment, t: f64) -> Result<Vector> {
    Ok(segment.point(t + STEP)? - segment.point(t - STEP)?)
}

/// The corner's parameter more precisely than `t`: where straight continuations from both sides come closest.
fn located(segment: &CurveSegment, t: f64) -> Result<f64> {
    let reach = 16.0 * STEP;
    let side = |sign: f64| -> Result<(Vector, Vector)> {
        let (near, far) = (t + sign * reach, t + 2.0 * sign * reach);
        let (p, q) = (segment.point(near)?, segment.point(far)?);
        let speed = (q - p) / (sign * reach);
        Ok((p.coords - speed * (sign * reach), speed))
    };
    let ((left, u), (right, v)) = (side(-1.0)?, side(1.0)?);
    let change = v - u;
    let shift = (left - right).dot(&change) / change.norm_squared();
    Ok(if shift.abs() <= reach { snap(t + shift) } else { t })
}

fn turn_between(u: Vector, v: Vector) -> f64 {
    cross(u, v).atan2(u.dot(&v)).abs()
}

/// The parameter at which the direction jumps between two parameters: a smooth curve's turn falls below the
/// threshold as the interval is halved.
fn narrowed(segment: &CurveSegment, mut t: [f64; 2], mut tangent: [Vector; 2]) -> Result<Option<f64>> {
    while turn_between(tangent[0], tangent[1]) > CORNER_TURN {
        let middle = snap(0.5 * (t[0] + t[1]));
        if t[1] - t[0] <= 4.0 * STEP {
            return Ok(Some(middle));
        }
        let here = direction(segment, middle)?;
        if turn_between(tangent[0], here) >= turn_between(here, tangent[1]) {
            (t[1], tangent[1]) = (middle, here);
        } else {
            (t[0], tangent[0]) = (middle, here);
        }
    }
    Ok(None)
}
