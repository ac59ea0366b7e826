//! How well elements follow waves, as a term beside the shape energy.
//!
//! Waves of one wave number κ from all directions alike are, round any point, the circular waves
//! F_n = J_n(κr) e^{inφ}, n = 0, ±1, …, whose squares add up to 1 (Graf). Along a line of an element, what polynomials
//! of the element's order N leave of them is to leading order their Legendre coefficients of degrees N + 1 and N + 2.
//! Summed over n and over the lines through the samples, in both directions, that is the elements' mean square error S,
//! and the term is ln S. Angles and sizes beyond what is asked for cost steeply.
//!
//! (∂x + i∂y) F_n = −κ F_{n+1} and (∂x − i∂y) F_n = κ F_{n−1} give the gradient.

// Several arrays run in step in every loop here; zipping them would hide the formulas.
#![allow(clippy::needless_range_loop)]

use super::{Freedom, LocalVertex, Problem};
use crate::numerics::tolerances::LEAST_WAVE_ERROR;
use crate::numerics::{cross, legendre, GaussLobatto, Vector};
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
/// Weight of a squared shortfall of the scaled Jacobian, at each sample: a hundredth is worth a tenth of S.
const ANGLE_WEIGHT: f64 = 5e3;
/// Weight of a squared excess of the size: a thousandth is worth as much.
const SIZE_WEIGHT: f64 = 1e5;

/// What is asked for.
#[derive(Debug, Clone, Copy)]
pub(in crate::smooth) struct Demands {
    pub wave_number: f64,
    /// Scaled Jacobian and size to be kept.
    pub scaled_jacobian: f64,
    pub size: f64,
}

/// Tables and what changes from element to element.
#[derive(Debug, Clone)]
pub(super) struct WaveTerm {
    demands: Demands,
    /// Weights of the samples, sum 1.
    weights: Vec<f64>,
    /// What gives the Legendre coefficients of degrees N + 1 and N + 2 from values at the samples.
    modes: [Vec<f64>; 2],
    /// Highest order n.
    waves: usize,
    /// Unknowns that stay.
    pinned: Vec<u32>,
    /// Gradients of the elements' errors, by element, side, axis and lane.
    gradients: Vec<f64>,
}

impl WaveTerm {
    pub fn new(order: usize, demands: Demands, pinned: Vec<u32>) -> Self {
        let rule = GaussLobatto::new(order + MORE_SAMPLES - 1);
        let mode = |m: usize| -> Vec<f64> {
            let p: Vec<f64> = rule.nodes.iter().map(|x| legendre(m, *x).0).collect();
            let square: f64 = p.iter().zip(&rule.weights).map(|(p, w)| 0.5 * w * p * p).sum();
            let mut mode: Vec<f64> =
                p.iter().zip(&rule.weights).map(|(p, w)| 0.5 * w * p / square.sqrt()).collect();
            // Lanes left over have no weight.
            mode.resize(MOST_LANES, 0.0);
            mode
        };
        WaveTerm {
            demands,
            weights: rule.weights.iter().map(|w| 0.5 * w).collect(),
            modes: [mode(order + 1), mode(order + 2)],
            waves: order + MORE_WAVES,
            pinned,
            gradients: Vec::new(),
        }
    }

    /// Mean square of what is left along a line through `points`; `share` times its gradient is added to `gradient`.
    #[inline(always)]
    fn line<const L: usize>(&self, points: &[[f64; L]; 2], share: f64, gradient: &mut [[f64; L]; 2]) -> f64 {
        let kappa = self.demands.wave_number;
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
        // Orders −1 to `top`, real and imaginary parts.
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
        let mut error = 0.0;
        for n in 1..=top {
            let weight = if n == 1 { 1.0 } else { 2.0 };
            let (mut ax, mut ay) = ([0.0; L], [0.0; L]);
            for mode in &self.modes {
                let mut q = [0.0; L];
                q.copy_from_slice(&mode[..L]);
                let (mut x, mut y) = ([0.0; L], [0.0; L]);
                for k in 0..L {
                    (x[k], y[k]) = (q[k] * re[n][k], q[k] * im[n][k]);
                }
                let (x, y) = (sum(x), sum(y));
                error += weight * (x * x + y * y);
                for k in 0..L {
                    ax[k] += q[k] * x;
                    ay[k] -= q[k] * y;
                }
            }
            let factor = share * weight * kappa;
            for k in 0..L {
                let (dx, dy) = (re[n - 1][k] - re[n + 1][k], im[n - 1][k] - im[n + 1][k]);
                let (sx, sy) = (re[n - 1][k] + re[n + 1][k], im[n - 1][k] + im[n + 1][k]);
                gradient[0][k] += factor * (ax[k] * dx - ay[k] * dy);
                gradient[1][k] -= factor * (ax[k] * sy + ay[k] * sx);
            }
        }
        error
    }

    /// Mean square error on an element with `sides`, and its gradient to their values.
    #[inline(always)]
    fn error<const L: usize>(&self, t: &[f64; L], sides: &Sides<L>, gradient: &mut Sides<L>) -> f64 {
        let count = self.weights.len();
        let corners = corners(sides, count);
        // By η, axis, ξ.
        let mut place = [[[0.0; L]; 2]; L];
        let mut pull = [[[0.0; L]; 2]; L];
        for j in 0..count {
            let v = t[j];
            for axis in 0..2 {
                let [a, b, c, d] = corners.map(|corner| corner[axis]);
                let [low, right, high, left] = [0, 1, 2, 3].map(|side| &sides.c[side][axis]);
                let (start, end) = (left[j] - a - v * (d - a), right[j] - b - v * (c - b));
                for i in 0..L {
                    place[j][axis][i] = low[i] * (1.0 - v) + high[i] * v + start * (1.0 - t[i]) + end * t[i];
                }
            }
        }
        let mut error = 0.0;
        for (j, weight) in self.weights.iter().enumerate() {
            error += weight * self.line(&place[j], *weight, &mut pull[j]);
        }
        for (i, weight) in self.weights.iter().enumerate() {
            let (mut column, mut own) = ([[0.0; L]; 2], [[0.0; L]; 2]);
            for axis in 0..2 {
                for j in 0..L {
                    column[axis][j] = place[j.min(count - 1)][axis][i];
                }
            }
            error += weight * self.line(&column, *weight, &mut own);
            for j in 0..count {
                for axis in 0..2 {
                    pull[j][axis][i] += own[axis][j];
                }
            }
        }
        for j in 0..count {
            for i in 0..count {
                let g = Vector::new(pull[j][0][i], pull[j][1][i]);
                give(gradient, 0, i, g * (1.0 - t[j]));
                give(gradient, 2, i, g * t[j]);
                give(gradient, 3, j, g * (1.0 - t[i]));
                give(gradient, 1, j, g * t[i]);
                give_corners(gradient, count, corner_shares(t[i], t[j]).map(|s| -s), g);
            }
        }
        error
    }

    /// The cost of angles and sizes beyond what is asked for; its gradient is added.
    #[inline(always)]
    fn penalty<const L: usize>(&self, t: &[f64; L], sides: &Sides<L>, gradient: &mut Sides<L>) -> f64 {
        let count = self.weights.len();
        let corner = corners(sides, count);
        let slope = |side: usize, k: usize| Vector::new(sides.d[side][0][k], sides.d[side][1][k]);
        let mut sum = 0.0;
        for j in 0..count {
            for i in 0..count {
                let (u, v) = (t[i], t[j]);
                let a = slope(0, i) * (1.0 - v) + slope(2, i) * v + at(sides, 1, j)
                    - at(sides, 3, j)
                    - (corner[1] - corner[0]) * (1.0 - v)
                    - (corner[2] - corner[3]) * v;
                let b = slope(3, j) * (1.0 - u) + slope(1, j) * u + at(sides, 2, i)
                    - at(sides, 0, i)
                    - (corner[3] - corner[0]) * (1.0 - u)
                    - (corner[2] - corner[1]) * u;
                let lengths = a.norm() * b.norm();
                let scaled = cross(a, b) / lengths;
                let short = self.demands.scaled_jacobian - scaled;
                if short <= 0.0 {
                    continue;
                }
                sum += ANGLE_WEIGHT * short * short;
                let factor = -2.0 * ANGLE_WEIGHT * short;
                let ga = (Vector::new(b.y, -b.x) / lengths - a * (scaled / a.norm_squared())) * factor;
                let gb = (Vector::new(-a.y, a.x) / lengths - b * (scaled / b.norm_squared())) * factor;
                for axis in 0..2 {
                    gradient.d[0][axis][i] += (1.0 - v) * ga[axis];
                    gradient.d[2][axis][i] += v * ga[axis];
                    gradient.d[3][axis][j] += (1.0 - u) * gb[axis];
                    gradient.d[1][axis][j] += u * gb[axis];
                }
                give(gradient, 1, j, ga);
                give(gradient, 3, j, -ga);
                give(gradient, 2, i, gb);
                give(gradient, 0, i, -gb);
                give_corners(gradient, count, [1.0 - v, v - 1.0, -v, v], ga);
                give_corners(gradient, count, [1.0 - u, u, -u, u - 1.0], gb);
            }
        }
        for pair in [[0, 2], [1, 3]] {
            let steps = |side: usize| (1..count).map(move |k| at(sides, side, k) - at(sides, side, k - 1));
            let length: f64 = pair.iter().flat_map(|side| steps(*side)).map(|step| step.norm()).sum();
            let over = 0.5 * length / self.demands.size - 1.0;
            if over > 0.0 {
                sum += SIZE_WEIGHT * over * over;
                let factor = SIZE_WEIGHT * over / self.demands.size;
                for side in pair {
                    for (k, step) in steps(side).enumerate() {
                        let g = step * (factor / step.norm());
                        give(gradient, side, k + 1, g);
                        give(gradient, side, k, -g);
                    }
                }
            }
        }
        sum
    }
}

#[inline(always)]
fn at<const L: usize>(sides: &Sides<L>, side: usize, k: usize) -> Vector {
    Vector::new(sides.c[side][0][k], sides.c[side][1][k])
}

/// Counter-clockwise from ξ = η = 0.
#[inline(always)]
fn corners<const L: usize>(sides: &Sides<L>, count: usize) -> [Vector; 4] {
    [at(sides, 0, 0), at(sides, 0, count - 1), at(sides, 2, count - 1), at(sides, 2, 0)]
}

/// What each corner has in the bilinear map.
#[inline(always)]
fn corner_shares(u: f64, v: f64) -> [f64; 4] {
    [(1.0 - u) * (1.0 - v), u * (1.0 - v), u * v, (1.0 - u) * v]
}

#[inline(always)]
fn give<const L: usize>(gradient: &mut Sides<L>, side: usize, k: usize, g: Vector) {
    gradient.c[side][0][k] += g.x;
    gradient.c[side][1][k] += g.y;
}

#[inline(always)]
fn give_corners<const L: usize>(gradient: &mut Sides<L>, count: usize, shares: [f64; 4], g: Vector) {
    for ((side, k), share) in [(0, 0), (0, count - 1), (2, count - 1), (2, 0)].into_iter().zip(shares) {
        give(gradient, side, k, g * share);
    }
}

impl Problem<'_> {
    /// Adds the term to what is minimised from now on; the unknowns `pinned` stay.
    pub fn follow(&mut self, demands: Demands, pinned: Vec<u32>) {
        self.waves = Some(WaveTerm::new(self.reference.order, demands, pinned));
    }

    /// The term's value if there is one; adds its gradient to the adjoint of the edges' samples.
    #[inline(always)]
    pub(super) fn evaluate_waves<const L: usize>(&mut self) -> f64 {
        let Some(mut term) = self.waves.take() else { return 0.0 };
        let lanes = Lanes::<L>::new(&self.reference.samples);
        let mut sides = Sides::<L>::ZERO;
        let (mut sum, mut penalty, mut total_area) = (0.0, 0.0, 0.0);
        let mut gradients = std::mem::take(&mut term.gradients);
        gradients.resize(self.elements.len() * 8 * L, 0.0);
        let places = gradients.chunks_exact_mut(8 * L);
        for (element, own) in self.elements.iter().zip(places) {
            for side in 0..4 {
                let at = element.edges[side] as usize * 4 * L;
                sides.read(side, &self.samples[at..at + 4 * L], &lanes, element.flips[side]);
            }
            let mut gradient = Sides::<L>::ZERO;
            sum += element.target.area * term.error(&lanes.t, &sides, &mut gradient);
            for (own, g) in own.chunks_exact_mut(L).zip(gradient.c.iter().flatten()) {
                own.copy_from_slice(g);
            }
            total_area += element.target.area;
            let mut gradient = Sides::<L>::ZERO;
            penalty += term.penalty(&lanes.t, &sides, &mut gradient);
            for side in 0..4 {
                let at = element.edges[side] as usize * 4 * L;
                gradient.add_to(side, &mut self.adjoint[at..at + 4 * L], &lanes, element.flips[side]);
            }
        }
        let sum = sum + LEAST_WAVE_ERROR * LEAST_WAVE_ERROR * total_area;
        for (element, own) in self.elements.iter().zip(gradients.chunks_exact(8 * L)) {
            let factor = WEIGHT * element.target.area / sum;
            let mut gradient = Sides::<L>::ZERO;
            for (to, g) in gradient.c.iter_mut().flatten().zip(own.chunks_exact(L)) {
                to.iter_mut().zip(g).for_each(|(to, g)| *to = factor * g);
            }
            for side in 0..4 {
                let at = element.edges[side] as usize * 4 * L;
                gradient.add_to(side, &mut self.adjoint[at..at + 4 * L], &lanes, element.flips[side]);
            }
        }
        term.gradients = gradients;
        self.waves = Some(term);
        WEIGHT * sum.ln() + penalty
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
