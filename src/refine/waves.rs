//! How well polynomials along a line follow waves that come from all directions.
//!
//! *In:* points of a line at quadrature nodes. *Out:* the mean square, over all waves of one wave number, of what is
//! left when a wave is projected on polynomials in the line's parameter.
//!
//! Waves of wave number k and amplitude 1 that come from all directions alike have the covariance J₀(k |x − y|), by
//! Graf's theorem the sum of the products of J_n(kr) cos nφ and J_n(kr) sin nφ at x and y, polar coordinates round any
//! point. So the mean over the directions is a sum over n, the same however the line is turned or moved.

use crate::numerics::solution_degrees::{solution_degrees, PerDegree, DEGREES};
use crate::numerics::{legendre, GaussLegendre, Point, Vector};

/// Quadrature points beyond the order's own: a wave along a line is no polynomial.
const MORE_POINTS: usize = 4;
/// Circular waves beyond the order: higher ones are below rounding on lines shorter than half a wave.
const MORE_WAVES: usize = 4;
/// Terms of the Bessel functions' series, to rounding on such lines.
const TERMS: usize = 8;

/// Mean squares for each of the degrees.
pub(super) type Errors = PerDegree;

/// Tables for elements of one order and waves of one length.
#[derive(Debug)]
pub(super) struct Waves {
    /// Where [`Waves::unresolved`] wants points.
    pub rule: GaussLegendre,
    wave_number: f64,
    /// Orthonormal Legendre polynomials at the nodes, times the weights' square roots: `[degree][node]`.
    polynomials: Vec<Vec<f64>>,
    degrees: [usize; DEGREES],
}

impl Waves {
    pub fn new(order: usize, wave_number: f64) -> Self {
        let rule = GaussLegendre::new(order + 1 + MORE_POINTS);
        let polynomial = |m: usize| {
            let value = |(x, w): (&f64, &f64)| legendre(m, *x).0 * ((m as f64 + 0.5) * w).sqrt();
            rule.nodes.iter().zip(&rule.weights).map(value).collect()
        };
        Waves {
            polynomials: (0..=order).map(polynomial).collect(),
            degrees: solution_degrees(order),
            wave_number,
            rule,
        }
    }

    /// Adds to `errors` the mean squares of what is left on a line, integrated with `density`. The line is taken as
    /// the polynomial of the elements' order that is nearest to `points`, which are at the rule's nodes: what it is
    /// off them is the boundary's error and not the waves'.
    pub fn unresolved(&self, points: &[Point], density: &[f64], errors: &mut Errors) {
        let roots: Vec<f64> = self.rule.weights.iter().map(|w| w.sqrt()).collect();
        let mut line: Vec<Vector> = vec![Vector::zeros(); points.len()];
        // Round the line's middle, where the circular waves of high n are small.
        let middle = nalgebra::center(&points[0], &points[points.len() - 1]);
        let scaled: Vec<Vector> =
            points.iter().zip(&roots).map(|(p, w)| (p - middle) * (0.5 * self.wave_number * w)).collect();
        for polynomial in &self.polynomials {
            let share: Vector = scaled.iter().zip(polynomial).map(|(z, p)| z * *p).sum();
            line.iter_mut().zip(polynomial).for_each(|(z, p)| *z += share * *p);
        }
        line.iter_mut().zip(&roots).for_each(|(z, w)| *z /= *w);
        // (kz / 2)^n / n! at each point.
        let mut power = vec![Vector::new(1.0, 0.0); points.len()];
        let mut wave = power.clone();
        for n in 0..=self.polynomials.len() - 1 + MORE_WAVES {
            for (i, z) in line.iter().enumerate() {
                if n > 0 {
                    let p = power[i];
                    power[i] = Vector::new(p.x * z.x - p.y * z.y, p.x * z.y + p.y * z.x) / n as f64;
                }
                let square = -z.norm_squared();
                let (mut term, mut series) = (1.0, 1.0);
                for s in 1..TERMS {
                    term *= square / (s * (s + n)) as f64;
                    series += term;
                }
                wave[i] = power[i] * (series * roots[i]);
            }
            let both_signs = if n == 0 { 1.0 } else { 2.0 };
            for (m, polynomial) in self.polynomials.iter().enumerate() {
                let share: Vector = wave.iter().zip(polynomial).map(|(w, p)| w * *p).sum();
                wave.iter_mut().zip(polynomial).for_each(|(w, p)| *w -= share * *p);
                for (error, _) in errors.iter_mut().zip(self.degrees).filter(|(_, degree)| *degree == m) {
                    let left: f64 = wave.iter().zip(density).map(|(w, d)| w.norm_squared() * d).sum();
                    *error += both_signs * left;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn errors(order: usize, line: impl Fn(f64) -> Point) -> Errors {
        let waves = Waves::new(order, 1.0);
        let points: Vec<Point> = waves.rule.nodes.iter().map(|x| line(*x)).collect();
        let mut errors = Errors::default();
        waves.unresolved(&points, &vec![0.5; points.len()], &mut errors);
        errors
    }

    #[test]
    fn on_a_straight_line_errors_are_those_of_plane_waves() {
        // Mean over directions of the projection error of sin and cos on [-1/2, 1/2], by brute force.
        let order = 5;
        let rule = GaussLegendre::new(40);
        let mut wanted = 0.0;
        let count = 64;
        for k in 0..count {
            let slope = 0.5 * (std::f64::consts::PI * (k as f64 + 0.5) / count as f64).cos();
            for wave in [f64::sin as fn(f64) -> f64, f64::cos] {
                let integral = |f: &dyn Fn(f64) -> f64| rule.integrate(-1.0, 1.0, f);
                let mut left: Vec<f64> = rule.nodes.iter().map(|x| wave(slope * x)).collect();
                for m in 0..=order {
                    let share = integral(&|x| wave(slope * x) * legendre(m, x).0) * (m as f64 + 0.5);
                    left.iter_mut().zip(&rule.nodes).for_each(|(l, x)| *l -= share * legendre(m, *x).0);
                }
                wanted +=
                    left.iter().zip(&rule.weights).map(|(l, w)| 0.5 * l * l * w).sum::<f64>() / count as f64;
            }
        }
        let found = errors(order, |x| Point::new(0.3 * x + 7.0, 0.4 * x - 2.0))[0];
        assert!((found / wanted - 1.0).abs() < 1e-6, "{found} {wanted}");
    }

    #[test]
    fn high_modes_cost_and_turning_does_not() {
        let straight = errors(5, |x| Point::new(0.5 * x, 0.0));
        let wavy = |x: f64| Vector::new(0.5 * x, 0.01 * legendre(5, x).0);
        let flat = errors(5, |x| Point::from(wavy(x)));
        let turned = errors(5, |x| Point::from(nalgebra::Rotation2::new(1.1) * wavy(x)));
        assert!(flat[0] > 4.0 * straight[0] && flat[1] > 4.0 * straight[1], "{flat:?} {straight:?}");
        for i in 0..3 {
            assert!((turned[i] / flat[i] - 1.0).abs() < 1e-9, "{turned:?} {flat:?}");
        }
    }
}
