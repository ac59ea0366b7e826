//! Interpolating cubic splines: natural, periodic, and with the end conditions of Forsythe, Malcolm
//! and Moler (Computer Methods for Mathematical Computations, 1977), which HOHQMesh uses.

use crate::domain::curve::{Curve, CurveFailure};
use crate::numerics::{Point, Vector};

/// What closes the system for the second derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ends {
    Natural,
    Periodic,
    /// The third derivative at each end is that of the cubic through the four knots next to it.
    ForsytheMalcolmMoler,
}

/// A C² cubic spline through points at given knots.
#[derive(Debug, Clone, PartialEq)]
pub struct CubicSpline {
    knots: Vec<f64>,
    points: Vec<Point>,
    /// For each interval the coefficients of x, x², x³, x the distance from its first knot.
    coefficients: Vec<[Vector; 3]>,
    /// The curve is this spline walked backwards.
    backwards: bool,
    breaks: Vec<f64>,
}

impl CubicSpline {
    /// The spline through `points` with knots at the share of the chord length: periodic if the last
    /// point equals the first, else natural. `Err` says what is wrong.
    pub fn through(points: &[Point]) -> Result<Self, String> {
        let n = points.len();
        if n < 2 {
            return Err("a spline needs at least 2 points".into());
        }
        let periodic = points[0] == points[n - 1];
        if periodic && n < 4 {
            return Err("a closed spline needs at least 3 different points".into());
        }
        // One of the two directions is preferred by the points alone, so that the same points given
        // backwards make the same curve bit by bit.
        let (first, last) = if periodic { (points[1], points[n - 2]) } else { (points[0], points[n - 1]) };
        let backwards = (last.x, last.y) < (first.x, first.y);
        let mut points = points.to_vec();
        if backwards {
            points.reverse();
        }
        let mut knots = vec![0.0];
        for w in points.windows(2) {
            let chord = (w[1] - w[0]).norm();
            if !(chord > 0.0 && chord.is_finite()) {
                return Err("consecutive spline points must differ and be finite".into());
            }
            knots.push(knots[knots.len() - 1] + chord);
        }
        let total = knots[n - 1];
        knots.iter_mut().for_each(|k| *k /= total);
        knots[n - 1] = 1.0;
        Self::new(knots, points, if periodic { Ends::Periodic } else { Ends::Natural }, backwards)
    }

    /// HOHQMesh's spline: given knots from 0 to 1, at least four.
    pub fn with_knots(knots: &[f64], points: &[Point]) -> Result<Self, String> {
        if knots.len() != points.len() || knots.len() < 4 {
            return Err("a spline curve must have at least 4 points".into());
        }
        let last = knots[knots.len() - 1];
        if !(knots[0].abs() <= 1e-12 && (last - 1.0).abs() <= 1e-12) {
            return Err("spline parameters must run from 0 to 1".into());
        }
        Self::new(knots.to_vec(), points.to_vec(), Ends::ForsytheMalcolmMoler, false)
    }

    fn new(knots: Vec<f64>, points: Vec<Point>, ends: Ends, backwards: bool) -> Result<Self, String> {
        if !knots.windows(2).all(|w| w[1] > w[0]) {
            return Err("spline parameters must increase strictly".into());
        }
        let n = points.len();
        let h: Vec<f64> = knots.windows(2).map(|w| w[1] - w[0]).collect();
        let slope: Vec<Vector> = (0..n - 1).map(|i| (points[i + 1] - points[i]) / h[i]).collect();
        let sixths = match ends {
            Ends::Periodic => periodic_sixths(&h, &slope),
            _ => open_sixths(&knots, &h, &slope, ends),
        };
        let coefficients = (0..n - 1)
            .map(|i| {
                let (s, s1) = (sixths[i], sixths[i + 1]);
                [slope[i] - (s1 + s * 2.0) * h[i], s * 3.0, (s1 - s) / h[i]]
            })
            .collect();
        let mut breaks = knots[1..n - 1].to_vec();
        if backwards {
            breaks.reverse();
            breaks.iter_mut().for_each(|k| *k = 1.0 - *k);
        }
        Ok(CubicSpline { knots, points, coefficients, backwards, breaks })
    }

    fn locate(&self, t: f64) -> (usize, f64) {
        let t = if self.backwards { 1.0 - t } else { t };
        let i = self.knots.partition_point(|&k| k <= t).clamp(1, self.coefficients.len()) - 1;
        (i, t - self.knots[i])
    }
}

impl Curve for CubicSpline {
    fn point(&self, t: f64) -> Result<Point, CurveFailure> {
        let (i, x) = self.locate(t);
        let [b, c, d] = self.coefficients[i];
        // The last knot is met exactly: a polynomial would miss it by its rounding.
        if i + 1 == self.coefficients.len() && self.knots[i] + x >= 1.0 {
            return Ok(self.points[i + 1]);
        }
        Ok(self.points[i] + (b + (c + d * x) * x) * x)
    }

    fn derivative(&self, t: f64) -> Option<Result<Vector, CurveFailure>> {
        let (i, x) = self.locate(t);
        let [b, c, d] = self.coefficients[i];
        let v = b + (c * 2.0 + d * (3.0 * x)) * x;
        Some(Ok(if self.backwards { -v } else { v }))
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn may_have_corners(&self) -> bool {
        false
    }
}

/// Second derivatives / 6 at the knots of an open spline, by elimination in the tridiagonal system.
fn open_sixths(t: &[f64], h: &[f64], slope: &[Vector], ends: Ends) -> Vec<Vector> {
    let n = t.len();
    if n == 2 {
        return vec![Vector::zeros(); 2];
    }
    let mut diagonal = vec![0.0; n];
    let mut right = vec![Vector::zeros(); n];
    for i in 1..n - 1 {
        diagonal[i] = 2.0 * (h[i - 1] + h[i]);
        right[i] = slope[i] - slope[i - 1];
    }
    // Off-diagonals are h but for the first and last row of a natural spline.
    let coupled = ends == Ends::ForsytheMalcolmMoler;
    if coupled {
        let third = |i: usize| {
            let a = (slope[i + 1] - slope[i]) / (t[i + 2] - t[i]);
            let b = (slope[i + 2] - slope[i + 1]) / (t[i + 3] - t[i + 1]);
            (b - a) / (t[i + 3] - t[i])
        };
        diagonal[0] = -h[0];
        diagonal[n - 1] = -h[n - 2];
        right[0] = third(0) * (h[0] * h[0]);
        right[n - 1] = third(n - 4) * (-h[n - 2] * h[n - 2]);
    } else {
        diagonal[0] = 1.0;
        diagonal[n - 1] = 1.0;
    }
    let upper = |i: usize| if i == 0 && !coupled { 0.0 } else { h[i] };
    let lower = |i: usize| if i == n - 1 && !coupled { 0.0 } else { h[i - 1] };
    for i in 1..n {
        let f = lower(i) / diagonal[i - 1];
        diagonal[i] -= f * upper(i - 1);
        right[i] = right[i] - right[i - 1] * f;
    }
    right[n - 1] /= diagonal[n - 1];
    for i in (0..n - 1).rev() {
        right[i] = (right[i] - right[i + 1] * upper(i)) / diagonal[i];
    }
    right
}

/// The same for a periodic spline: the cyclic system by the Sherman-Morrison formula.
fn periodic_sixths(h: &[f64], slope: &[Vector]) -> Vec<Vector> {
    let m = h.len();
    let before = |i: usize| if i == 0 { m - 1 } else { i - 1 };
    let corner = h[m - 1];
    // A = T + w wᵀ · corner with w = e₀ + e_{m−1}: T stays diagonally dominant.
    let mut diagonal: Vec<f64> = (0..m).map(|i| 2.0 * (h[before(i)] + h[i])).collect();
    diagonal[0] -= corner;
    diagonal[m - 1] -= corner;
    let mut right: Vec<Vector> = (0..m).map(|i| slope[i] - slope[before(i)]).collect();
    let mut w = vec![0.0; m];
    w[0] = 1.0;
    w[m - 1] = 1.0;
    for i in 1..m {
        let f = h[i - 1] / diagonal[i - 1];
        diagonal[i] -= f * h[i - 1];
        right[i] = right[i] - right[i - 1] * f;
        w[i] -= w[i - 1] * f;
    }
    right[m - 1] /= diagonal[m - 1];
    w[m - 1] /= diagonal[m - 1];
    for i in (0..m - 1).rev() {
        right[i] = (right[i] - right[i + 1] * h[i]) / diagonal[i];
        w[i] = (w[i] - w[i + 1] * h[i]) / diagonal[i];
    }
    let factor = corner / (1.0 + corner * (w[0] + w[m - 1]));
    let along = (right[0] + right[m - 1]) * factor;
    let mut sixths: Vec<Vector> = (0..m).map(|i| right[i] - along * w[i]).collect();
    sixths.push(sixths[0]);
    sixths
}
