//! How well elements follow waves, as a term beside the shape energy.
//!
//! Waves of one wave number κ from all directions alike are, round any point, the circular waves
//! F_n = J_n(κr) e^{inφ}, n = 0, ±1, …, whose squares add up to 1 (Graf). Along a line of an element, what polynomials
//! of degree d leave of them is to leading order their Legendre coefficients of degrees d + 1 and d + 2. Summed over n
//! and over the lines through the samples, in both directions, that is the elements' mean square error S_d, and the term
//! is the mean of ln S_d over some degrees d up to the elements' order: solutions of lower degree see modes of the maps
//! that the order itself does not. Angles and sizes beyond what is asked for cost steeply.
//!
//! (∂x + i∂y) F_n = −κ F_{n+1} and (∂x − i∂y) F_n = κ F_{n−1} give the gradient.

// Several arrays run in step in every loop here; zipping them would hide the formulas.
#![allow(clippy::needless_range_loop)]

use super::demands::{corner_shares, corners, give, give_corners, Demands};
use super::{Freedom, LocalVertex, Problem};
use crate::numerics::solution_degrees::{solution_degrees, PerDegree, DEGREES};
use crate::numerics::tolerances::LEAST_WAVE_ERROR;
use crate::numerics::{legendre, GaussLobatto, Vector};
use crate::smooth::kernel::{sum, Lanes, Sides};
use crate::smooth::reference::MOST_LANES;

/// Samples beyond the order: one more than needed to see degree N + 1.
pub(in crate::smooth) const MORE_SAMPLES: usize = 3;
/// Circular waves beyond the order.
const MORE_WAVES: usize = 4;
/// Room for those of the highest order, and three more.
const MOST_WAVES: usize = 24;
/// Terms of the Bessel functions' series of the two highest orders.
const TERMS: usize = 10;
/// Weight of ln S against the shape energy, which is about 1/2 an element: it only keeps order.
const WEIGHT: f64 = 10.0;
/// Tables and what changes from element to element.
#[derive(Debug, Clone)]
pub(super) struct WaveTerm {
    wave_number: f64,
    demands: Demands,
    /// Weights of the samples, sum 1.
    weights: Vec<f64>,
    /// For each degree what gives the two next Legendre coefficients from values at the samples.
    modes: [[[f64; MOST_LANES]; 2]; DEGREES],
    /// Highest order n.
    waves: usize,
    /// Unknowns that stay.
    pinned: Vec<u32>,
}

impl WaveTerm {
    pub fn new(order: usize, wave_number: f64, demands: Demands, pinned: Vec<u32>) -> Self {
        let rule = GaussLobatto::new(order + MORE_SAMPLES - 1);
        // Lanes left over have no weight.
        let mode = |m: usize| {
            let p: Vec<f64> = rule.nodes.iter().map(|x| legendre(m, *x).0).collect();
            let square: f64 = p.iter().zip(&rule.weights).map(|(p, w)| 0.5 * w * p * p).sum();
            let mut mode = [0.0; MOST_LANES];
            for (mode, (p, w)) in mode.iter_mut().zip(p.iter().zip(&rule.weights)) {
                *mode = 0.5 * w * p / square.sqrt();
            }
            mode
        };
        WaveTerm {
            wave_number,
            demands,
            weights: rule.weights.iter().map(|w| 0.5 * w).collect(),
            modes: solution_degrees(order).map(|degree| [mode(degree + 1), mode(degree + 2)]),
            waves: order + MORE_WAVES,
            pinned,
        }
    }

    /// J_n(κr) e^{inφ} for n from −1 up on the points of a line round its middle: real and imaginary parts.
    #[inline(always)]
    fn circular<const L: usize>(&self, points: &[[f64; L]; 2]) -> [[[f64; L]; MOST_WAVES]; 2] {
        let kappa = self.wave_number;
        let (last, top) = (self.weights.len() - 1, self.waves + 1);
        let [px, py] = points;
        let (mx, my) = (0.5 * (px[0] + px[last]), 0.5 * (py[0] + py[last]));
        let (mut zx, mut zy, mut t) = ([0.0; L], [0.0; L], [0.0; L]);
        for k in 0..L {
            (zx[k], zy[k]) = (0.5 * kappa * (px[k] - mx), 0.5 * kappa * (py[k] - my));
            t[k] = zx[k] * zx[k] + zy[k] * zy[k];
        }
        // J_n = |z|ⁿ G_n with G_{n−1} = n G_n − t G_{n+1}, stable downwards.
        let mut bessel = [[0.0; L]; MOST_WAVES];
        for n in [top, top + 1] {
            let mut term = [1.0 / (1..=n).map(|i| i as f64).product::<f64>(); L];
            for s in 1..=TERMS {
                let factor = -1.0 / (s * (n + s)) as f64;
                for k in 0..L {
                    bessel[n][k] += term[k];
                    term[k] *= factor * t[k];
                }
            }
        }
        for n in (1..=top).rev() {
            for k in 0..L {
                bessel[n - 1][k] = n as f64 * bessel[n][k] - t[k] * bessel[n + 1][k];
            }
        }
        let (mut re, mut im) = ([[0.0; L]; MOST_WAVES], [[0.0; L]; MOST_WAVES]);
        let (mut x, mut y) = ([1.0; L], [0.0; L]);
        for n in 0..=top {
            for k in 0..L {
                (re[n + 1][k], im[n + 1][k]) = (x[k] * bessel[n][k], y[k] * bessel[n][k]);
                (x[k], y[k]) = (x[k] * zx[k] - y[k] * zy[k], x[k] * zy[k] + y[k] * zx[k]);
            }
        }
        for k in 0..L {
            (re[0][k], im[0][k]) = (-re[2][k], im[2][k]);
        }
        [re, im]
    }

    /// Mean squares of what polynomials of each degree leave along a line through `points`.
    #[inline(always)]
    fn line_errors<const L: usize>(&self, points: &[[f64; L]; 2]) -> PerDegree {
        let [re, im] = self.circular(points);
        let mut errors = PerDegree::default();
        for n in 1..=self.waves + 2 {
            let weight = if n == 1 { 1.0 } else { 2.0 };
            for (error, modes) in errors.iter_mut().zip(&self.modes) {
                for mode in modes {
                    let (mut x, mut y) = ([0.0; L], [0.0; L]);
                    for k in 0..L {
                        (x[k], y[k]) = (mode[k] * re[n][k], mode[k] * im[n][k]);
                    }
                    *error += weight * (sum(x).powi(2) + sum(y).powi(2));
                }
            }
        }
        errors
    }

    /// Adds to `gradient` that of the mean squares, each times its factor.
    #[inline(always)]
    fn line_gradient<const L: usize>(
        &self,
        points: &[[f64; L]; 2],
        factors: PerDegree,
        gradient: &mut [[f64; L]; 2],
    ) {
        let [re, im] = self.circular(points);
        for n in 1..=self.waves + 2 {
            let weight = if n == 1 { 1.0 } else { 2.0 };
            let (mut ax, mut ay) = ([0.0; L], [0.0; L]);
            for (factor, modes) in factors.iter().zip(&self.modes) {
                let factor = factor * weight * self.wave_number;
                for mode in modes {
                    let (mut x, mut y) = ([0.0; L], [0.0; L]);
                    for k in 0..L {
                        (x[k], y[k]) = (mode[k] * re[n][k], mode[k] * im[n][k]);
                    }
                    let (x, y) = (factor * sum(x), factor * sum(y));
                    for k in 0..L {
                        ax[k] += mode[k] * x;
                        ay[k] -= mode[k] * y;
                    }
                }
            }
            for k in 0..L {
                let (dx, dy) = (re[n - 1][k] - re[n + 1][k], im[n - 1][k] - im[n + 1][k]);
                let (sx, sy) = (re[n - 1][k] + re[n + 1][k], im[n - 1][k] + im[n + 1][k]);
                gradient[0][k] += ax[k] * dx - ay[k] * dy;
                gradient[1][k] -= ax[k] * sy + ay[k] * sx;
            }
        }
    }

    /// The samples of an element with `sides`: by η, axis, ξ.
    #[inline(always)]
    fn places<const L: usize>(&self, t: &[f64; L], sides: &Sides<L>) -> [[[f64; L]; 2]; L] {
        let count = self.weights.len();
        let corners = corners(sides, count);
        let mut places = [[[0.0; L]; 2]; L];
        for j in 0..count {
            let v = t[j];
            for axis in 0..2 {
                let [a, b, c, d] = corners.map(|corner| corner[axis]);
                let [low, right, high, left] = [0, 1, 2, 3].map(|side| &sides.c[side][axis]);
                let (start, end) = (left[j] - a - v * (d - a), right[j] - b - v * (c - b));
                for i in 0..L {
                    places[j][axis][i] = low[i] * (1.0 - v) + high[i] * v + start * (1.0 - t[i]) + end * t[i];
                }
            }
        }
        places
    }

    /// The line along η at sample `i`.
    #[inline(always)]
    fn column<const L: usize>(&self, places: &[[[f64; L]; 2]; L], i: usize) -> [[f64; L]; 2] {
        let mut column = [[0.0; L]; 2];
        for axis in 0..2 {
            for j in 0..L {
                column[axis][j] = places[j.min(self.weights.len() - 1)][axis][i];
            }
        }
        column
    }

    /// Mean square errors on an element with `sides`.
    #[inline(always)]
    fn errors<const L: usize>(&self, t: &[f64; L], sides: &Sides<L>) -> PerDegree {
        let places = self.places(t, sides);
        let mut errors = PerDegree::default();
        for (i, weight) in self.weights.iter().enumerate() {
            for line in [places[i], self.column(&places, i)] {
                errors.iter_mut().zip(self.line_errors(&line)).for_each(|(sum, e)| *sum += weight * e);
            }
        }
        errors
    }

    /// The gradient of the sum of an element's errors, each times its factor, to the values of its sides.
    #[inline(always)]
    fn gradient<const L: usize>(&self, t: &[f64; L], sides: &Sides<L>, factors: PerDegree) -> Sides<L> {
        let count = self.weights.len();
        let places = self.places(t, sides);
        let mut pull = [[[0.0; L]; 2]; L];
        for (i, weight) in self.weights.iter().enumerate() {
            let factors = factors.map(|f| f * weight);
            self.line_gradient(&places[i], factors, &mut pull[i]);
            let mut own = [[0.0; L]; 2];
            self.line_gradient(&self.column(&places, i), factors, &mut own);
            for j in 0..count {
                for axis in 0..2 {
                    pull[j][axis][i] += own[axis][j];
                }
            }
        }
        let mut gradient = Sides::<L>::ZERO;
        for j in 0..count {
            for i in 0..count {
                let g = Vector::new(pull[j][0][i], pull[j][1][i]);
                give(&mut gradient, 0, i, g * (1.0 - t[j]));
                give(&mut gradient, 2, i, g * t[j]);
                give(&mut gradient, 3, j, g * (1.0 - t[i]));
                give(&mut gradient, 1, j, g * t[i]);
                give_corners(&mut gradient, count, corner_shares(t[i], t[j]).map(|s| -s), g);
            }
        }
        gradient
    }
}

impl Problem<'_> {
    /// Adds the term to what is minimised from now on; the unknowns `pinned` stay.
    pub fn follow(&mut self, wave_number: f64, demands: Demands, pinned: Vec<u32>) {
        self.waves = Some(WaveTerm::new(self.reference.order, wave_number, demands, pinned));
    }

    /// The term's value if there is one; adds its gradient to the adjoint of the edges' samples.
    #[inline(always)]
    pub(super) fn evaluate_waves<const L: usize>(&mut self) -> f64 {
        let Some(term) = self.waves.take() else { return 0.0 };
        let lanes = Lanes::<L>::new(&self.reference.samples);
        // The factors of the gradients need the sums over all elements first.
        let (mut totals, mut area) = (PerDegree::default(), 0.0);
        for e in 0..self.elements.len() {
            let own = term.errors(&lanes.t, &self.sides(e, &lanes));
            let target = self.elements[e].target.area;
            totals.iter_mut().zip(own).for_each(|(sum, e)| *sum += target * e);
            area += target;
        }
        let totals = totals.map(|t| t + LEAST_WAVE_ERROR * LEAST_WAVE_ERROR * area);
        let weight = WEIGHT / totals.len() as f64;
        let mut penalty = 0.0;
        for e in 0..self.elements.len() {
            let sides = self.sides(e, &lanes);
            let element = &self.elements[e];
            let mut gradient =
                term.gradient(&lanes.t, &sides, totals.map(|t| weight * element.target.area / t));
            penalty += term.demands.penalty(term.weights.len(), &lanes.t, &sides, &mut gradient);
            for side in 0..4 {
                let at = element.edges[side] as usize * 4 * L;
                gradient.add_to(side, &mut self.adjoint[at..at + 4 * L], &lanes, element.flips[side]);
            }
        }
        self.waves = Some(term);
        weight * totals.iter().map(|t| t.ln()).sum::<f64>() + penalty
    }

    /// The samples of an element's sides.
    #[inline(always)]
    fn sides<const L: usize>(&self, element: usize, lanes: &Lanes<L>) -> Sides<L> {
        let element = &self.elements[element];
        let mut sides = Sides::<L>::ZERO;
        for side in 0..4 {
            let at = element.edges[side] as usize * 4 * L;
            sides.read(side, &self.samples[at..at + 4 * L], lanes, element.flips[side]);
        }
        sides
    }

    /// Forgets the gradient to what is pinned.
    pub(super) fn keep_pinned(&self, gradient: &mut [f64]) {
        for unknown in self.waves.iter().flat_map(|term| &term.pinned) {
            gradient[*unknown as usize] = 0.0;
        }
    }

    /// Sliding vertices' unknowns for which `stays` says so of their chain and arc length.
    pub fn sliding(&self, stays: &dyn Fn(u32, f64) -> bool) -> Vec<u32> {
        let slides = |v: &LocalVertex| match v.freedom {
            Freedom::Slide { unknown, chain } => {
                stays(chain, self.unknowns[unknown as usize]).then_some(unknown)
            }
            _ => None,
        };
        self.vertices.iter().filter_map(slides).collect()
    }
}
