//! Limited-memory BFGS with a diagonal metric and a line search that never leaves the feasible set.
//!
//! Reference: J. Nocedal, S. Wright, *Numerical Optimization*, 2006, §7.2 (two-loop recursion).

use crate::numerics::tolerances::OFF_POWERS;

/// Pairs kept.
const MEMORY: usize = 10;
/// Sufficient decrease (Armijo).
const DECREASE: f64 = 1e-4;
/// Halvings of one line search.
const HALVINGS: usize = 20;

/// A function to minimise; infinite where infeasible.
pub(super) trait Objective {
    /// The value at `x`; its gradient is written to `gradient` if the value is finite.
    fn evaluate(&mut self, x: &[f64], gradient: &mut [f64]) -> f64;
}

/// What is natural to each variable.
#[derive(Debug, Clone, Default)]
pub(super) struct Scales {
    /// The square of a length: the first inverse Hessian up to a factor.
    pub metric: Vec<f64>,
    /// Spacing of the grid that the variable stays on.
    pub cells: Vec<f64>,
}

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Limits {
    /// Most iterations.
    pub steps: usize,
    /// Stop when five steps together decrease the value by less than this share.
    pub progress: f64,
}

/// What came out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Minimum {
    /// The value at the start, ...
    pub before: f64,
    /// ... and at the end.
    pub value: f64,
    pub evaluations: usize,
}

/// Work space, kept between runs so that nothing is allocated inside.
#[derive(Debug, Clone, Default)]
pub(super) struct Lbfgs {
    s: Vec<Vec<f64>>,
    y: Vec<Vec<f64>>,
    sy: [f64; MEMORY],
    gradient: Vec<f64>,
    next_gradient: Vec<f64>,
    next: Vec<f64>,
    direction: Vec<f64>,
}

/// Four partial sums, so that additions need not wait for each other.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours_a, fours_b) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = fours_a.remainder().iter().zip(fours_b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in fours_a.zip(fours_b) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// Spacing of the grid for a variable that moves along edges whose squared length is `squared`, about `grid` of
/// their length: a power of two, so that noise in the length leaves it the same.
pub(super) fn grid_cell(squared: f64, grid: f64) -> f64 {
    grid * (0.5 * (OFF_POWERS * squared).log2()).floor().exp2()
}

/// Rounded to the grid. Without it the rounding errors of the input, about doubled by every iteration, would
/// decide what the minimum looks like.
fn on_grid(x: f64, cell: f64) -> f64 {
    let snapped = (x / cell).round() * cell;
    if snapped.is_finite() {
        snapped
    } else {
        x
    }
}

impl Lbfgs {
    fn resize(&mut self, n: usize) {
        self.s.resize_with(MEMORY, Vec::new);
        self.y.resize_with(MEMORY, Vec::new);
        for v in self.s.iter_mut().chain(&mut self.y).chain([
            &mut self.gradient,
            &mut self.next_gradient,
            &mut self.next,
            &mut self.direction,
        ]) {
            v.resize(n, 0.0);
        }
    }

    /// Minimises from `x`, which must be feasible, and leaves the best point there. No variable moves further
    /// than `reach` · √metric in one step; all stay on their grids.
    pub fn minimise(
        &mut self,
        objective: &mut impl Objective,
        x: &mut [f64],
        scales: &Scales,
        reach: f64,
        limits: Limits,
    ) -> Minimum {
        let n = x.len();
        self.resize(n);
        let Scales { metric, cells } = scales;
        for k in 0..n {
            self.next[k] = on_grid(x[k], cells[k]);
        }
        let mut value = objective.evaluate(&self.next, &mut self.gradient);
        let mut evaluations = 1;
        if value.is_finite() {
            x.copy_from_slice(&self.next);
        } else {
            value = objective.evaluate(x, &mut self.gradient);
            evaluations += 1;
        }
        let before = value;
        let (mut kept, mut head) = (0, 0);
        let mut history = [f64::INFINITY; 5];
        for step in 0..limits.steps {
            if n == 0 || !value.is_finite() {
                break;
            }
            self.descent(metric, kept, head);
            let mut slope = dot(&self.direction, &self.gradient);
            if slope >= 0.0 {
                (kept, head) = (0, 0);
                self.descent(metric, kept, head);
                slope = dot(&self.direction, &self.gradient);
                if slope >= 0.0 {
                    break;
                }
            }
            // The longest move in units of the variables' own lengths.
            let longest = self.direction.iter().zip(metric).fold(0.0f64, |m, (d, h)| m.max(d * d / h)).sqrt();
            let mut t = if longest > reach { reach / longest } else { 1.0 };
            let mut found = None;
            for _ in 0..HALVINGS {
                for (k, next) in self.next.iter_mut().enumerate() {
                    *next = on_grid(x[k] + t * self.direction[k], cells[k]);
                }
                let trial = objective.evaluate(&self.next, &mut self.next_gradient);
                evaluations += 1;
                if trial <= value + DECREASE * t * slope {
                    found = Some(trial);
                    break;
                }
                // A parabola through the values where there are any, else plain halving.
                let parabola = -0.5 * slope * t * t / (trial - value - slope * t);
                t = if parabola.is_finite() { parabola.clamp(0.1 * t, 0.5 * t) } else { 0.4 * t };
            }
            let Some(trial) = found else {
                if kept == 0 {
                    break;
                }
                (kept, head) = (0, 0);
                continue;
            };
            let (s, y) = (&mut self.s[head], &mut self.y[head]);
            for k in 0..n {
                s[k] = self.next[k] - x[k];
                y[k] = self.next_gradient[k] - self.gradient[k];
                x[k] = self.next[k];
            }
            let sy = dot(s, y);
            if sy > 1e-10 * (dot(s, s) * dot(y, y)).sqrt() {
                self.sy[head] = sy;
                head = (head + 1) % MEMORY;
                kept = (kept + 1).min(MEMORY);
            }
            std::mem::swap(&mut self.gradient, &mut self.next_gradient);
            value = trial;
            let earlier = std::mem::replace(&mut history[step % 5], value);
            if earlier - value < limits.progress * value.abs() {
                break;
            }
        }
        Minimum { before, value, evaluations }
    }

    /// Two-loop recursion: the descent direction for the present gradient.
    fn descent(&mut self, metric: &[f64], kept: usize, head: usize) {
        let d = &mut self.direction;
        for (d, g) in d.iter_mut().zip(&self.gradient) {
            *d = -g;
        }
        let mut alpha = [0.0; MEMORY];
        for age in 1..=kept {
            let i = (head + MEMORY - age) % MEMORY;
            alpha[i] = dot(&self.s[i], d) / self.sy[i];
            for (d, y) in d.iter_mut().zip(&self.y[i]) {
                *d -= alpha[i] * y;
            }
        }
        let gamma = if kept == 0 {
            1.0
        } else {
            let i = (head + MEMORY - 1) % MEMORY;
            let weighted: f64 = self.y[i].iter().zip(metric).map(|(y, h)| y * y * h).sum();
            self.sy[i] / weighted
        };
        for (d, h) in d.iter_mut().zip(metric) {
            *d *= gamma * h;
        }
        for age in (1..=kept).rev() {
            let i = (head + MEMORY - age) % MEMORY;
            let beta = dot(&self.y[i], d) / self.sy[i];
            for (d, s) in d.iter_mut().zip(&self.s[i]) {
                *d += (alpha[i] - beta) * s;
            }
        }
    }
}
