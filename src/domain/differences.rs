//! The derivative of a curve that cannot tell it: extrapolated differences (Ridders 1982).

use crate::numerics::{Point, Vector};

/// Levels of halved steps.
const LEVELS: usize = 9;
/// Largest step.
const FIRST_STEP: f64 = 1.0 / 16.0;
/// Below this much room to a side, differences are taken to the other side only.
const LEAST_CENTRAL_STEP: f64 = 1.0 / 1024.0;

/// d/dt at `t` of `f` on [0, 1]. Steps are powers of two, so that a curve walked backwards gives
/// the opposite bits.
pub(crate) fn derivative<E>(f: impl Fn(f64) -> Result<Point, E>, t: f64) -> Result<Vector, E> {
    let room = t.min(1.0 - t);
    let central = room >= LEAST_CENTRAL_STEP;
    let mut step = FIRST_STEP;
    while central && step > room {
        step *= 0.5;
    }
    let at = f(t)?;
    let sign = if t <= 0.5 { 1.0 } else { -1.0 };
    let mut row: Vec<Vector> = Vec::with_capacity(LEVELS);
    let (mut best, mut least) = (Vector::zeros(), f64::INFINITY);
    for level in 0..LEVELS {
        let mut value = if central {
            (f(t + step)? - f(t - step)?) / (2.0 * step)
        } else {
            (f(t + sign * step)? - at) * (sign / step)
        };
        // Neville: central differences have an error in even powers, one-sided ones in all.
        let mut factor = 1.0;
        for old in row.iter_mut() {
            factor *= if central { 4.0 } else { 2.0 };
            let next = value + (value - *old) / (factor - 1.0);
            let error = (next - value).norm().max((next - *old).norm());
            if error < least {
                (best, least) = (next, error);
            }
            *old = std::mem::replace(&mut value, next);
        }
        if level == 0 {
            best = value;
        }
        row.push(value);
        step *= 0.5;
    }
    Ok(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivative_is_accurate_inside_and_at_the_ends() {
        let f = |t: f64| Ok::<_, ()>(Point::new((9.0 * t).sin(), (3.0 * t).exp()));
        for t in [0.0, 1e-6, 0.01, 0.3, 0.5, 0.9999, 1.0] {
            let d = derivative(f, t).unwrap();
            let exact = Vector::new(9.0 * (9.0 * t).cos(), 3.0 * (3.0 * t).exp());
            assert!((d - exact).norm() < 1e-8 * exact.norm(), "t = {t}: {d} not {exact}");
        }
    }
}
