//! The proof that an element's Jacobian is positive everywhere in it.
//!
//! det J of an order-N element is a polynomial of degree n = 2N − 1 in each direction, so its
//! Bernstein coefficients bound it on any rectangle of the reference square. A rectangle on which all of
//! them exceed a bound on their rounding error is done; one with a sample ≤ 0 settles the matter;
//! any other is quartered. Bernstein coefficients of high degree amplify rounding by 2^n in each
//! direction, so only the low part of the Chebyshev expansion is converted and the rest, from degree
//! 10 on, is bounded by the sum of its absolute values.
//!
//! Every rectangle is evaluated from the nodes afresh: rounding does not add up over the depth.
//!
//! Reference: A. Johnen, J.-F. Remacle, C. Geuzaine, *Geometrical validity of curvilinear finite
//! elements*, J. Comput. Phys. 233 (2013).

use super::dense::{multiply, row_major, row_major_transposed, transpose};
use crate::numerics::bernstein::{bernstein_from_chebyshev, chebyshev_from_values, row_sum_norm};
use crate::numerics::interpolation::chebyshev_lobatto;
use crate::numerics::{GaussLobatto, Interpolation, Point};
use nalgebra::DMatrix;

/// What was found out about an element's Jacobian determinant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Verdict {
    /// Positive on the whole closed element, and at least this (with respect to the reference square
    /// [-1, 1]²).
    Proven(f64),
    /// The value ≤ 0 at reference point (ξ, η).
    Negative { value: f64, at: [f64; 2] },
    /// Neither could be shown near reference point (ξ, η): positive by less than the rounding error.
    Undecided { at: [f64; 2] },
}

/// Highest degree converted to Bernstein form: on large rectangles at orders up to 10 and at higher
/// ones, and on small rectangles. The bound on the rounding error is 1e-5 of the largest value or
/// less (at order 32: 2e-4), on small rectangles a hundredth of that.
const KEPT_DEGREE: [usize; 3] = [9, 7, 5];
/// Depth from which rectangles are small: high degrees have faded there.
const SMALL_DEPTH: u32 = 2;
/// Rectangles of side 2 · 2^−10 are no longer quartered.
const MAX_DEPTH: u32 = 10;
/// Most rectangles for one element; each is one evaluation.
const MAX_RECTANGLES: usize = 4000;

/// Tables for elements of one order, and room to work in; build once, use for many elements.
#[derive(Debug, Clone)]
pub struct JacobianProof {
    nodes: Interpolation,
    /// Derivatives at the nodes, `[i][k]` row by row.
    differentiation: Vec<f64>,
    /// Chebyshev-Lobatto points of degree n.
    points: Vec<f64>,
    /// Values to Chebyshev coefficients, (n + 1)² row by row.
    chebyshev: Vec<f64>,
    chebyshev_t: Vec<f64>,
    /// For large and for small rectangles.
    conversions: [Conversion; 2],
    /// Values and derivatives on the whole interval, the first rectangle's.
    whole: Rows,
    rounding: Rounding,
    work: Work,
}

/// Matrices from the N + 1 nodes to the n + 1 points of an interval, row by row.
#[derive(Debug, Clone, Default)]
struct Rows {
    value: Vec<f64>,
    slope: Vec<f64>,
    /// Their transposes: products run along rows.
    value_t: Vec<f64>,
    slope_t: Vec<f64>,
}

/// The change from Chebyshev coefficients below a cut to Bernstein coefficients.
#[derive(Debug, Clone)]
struct Conversion {
    /// Number of coefficients in each direction.
    kept: usize,
    /// `kept`² entries, row by row, and the transpose.
    matrix: Vec<f64>,
    matrix_t: Vec<f64>,
    /// Rounding error of a Bernstein coefficient and the tail, relative to the error of the values.
    amplification: f64,
    /// The same, relative to the largest value.
    summation: f64,
}

/// Factors of the a-priori rounding bounds of the values.
#[derive(Debug, Clone, Copy)]
struct Rounding {
    /// Of a derivative, relative to the largest coordinate.
    derivative: f64,
    /// Of det J because the points are rounded, relative to the square of the largest derivative: a
    /// polynomial's slope is at most n² times its largest value (Markov).
    position: f64,
}

#[derive(Debug, Clone, Default)]
struct Work {
    rows: [Rows; 2],
    /// x and y of the nodes, relative to the element's first node.
    x: [Vec<f64>; 2],
    by_value: Vec<f64>,
    by_slope: Vec<f64>,
    /// x_ξ, y_ξ, x_η, y_η at the points.
    slopes: [Vec<f64>; 4],
    det: Vec<f64>,
    half: Vec<f64>,
    coefficients: Vec<f64>,
    control: Vec<f64>,
    /// Largest derivative of a coordinate met so far (the whole element comes first).
    steepest: f64,
}

/// A rectangle of the reference square: centre and half width in each direction.
#[derive(Debug, Clone, Copy)]
struct Rectangle {
    center: [f64; 2],
    half: f64,
    depth: u32,
}

/// What one rectangle showed.
enum Finding {
    Positive(f64),
    Negative { value: f64, at: [f64; 2] },
    Open,
}

impl Conversion {
    fn new(degree: usize, chebyshev: &DMatrix<f64>) -> Self {
        let (size, kept) = (chebyshev.nrows(), degree + 1);
        let bernstein = bernstein_from_chebyshev(degree);
        let low = chebyshev.rows(0, kept).map(f64::abs);
        let convert = row_sum_norm(&(bernstein.map(f64::abs) * low));
        // The tail is a sum over all coefficients with one index at or above the cut.
        let row = row_sum_norm(chebyshev);
        let tail = 2.0 * (row * (size - kept) as f64) * (row * size as f64);
        let amplification = convert * convert + tail;
        let summation = f64::EPSILON * (4 * size + 32) as f64 * amplification;
        let (matrix, matrix_t) = (row_major(&bernstein), row_major_transposed(&bernstein));
        Conversion { kept, matrix, matrix_t, amplification, summation }
    }
}

impl JacobianProof {
    /// Tables for elements of order `order` (1 to 32).
    pub fn new(order: usize) -> Self {
        let order = order.max(1);
        let n = 2 * order - 1;
        let nodes = Interpolation::new(GaussLobatto::new(order).nodes);
        let d = nodes.differentiation();
        let points = chebyshev_lobatto(n);
        let chebyshev = chebyshev_from_values(n);
        let large = KEPT_DEGREE[usize::from(order > 10)];
        let conversions = [large, KEPT_DEGREE[2]].map(|degree| Conversion::new(n.min(degree), &chebyshev));
        let values = nodes.matrix(&points);
        // Norms on the whole interval hold on every part of it: the Lebesgue constants are taken
        // over points dense enough, with a tenth added.
        let dense: Vec<f64> = (0..=16 * n).map(|i| i as f64 / (8 * n) as f64 - 1.0).collect();
        let lebesgue = 1.1 * row_sum_norm(&nodes.matrix(&dense));
        let slope_norm = 1.1 * row_sum_norm(&nodes.derivative_matrix(&dense));
        let rounding = Rounding {
            // Entries of the two tables are right to about 3 N and 6 N roundings, the sums add N each.
            derivative: f64::EPSILON * (12 * order + 24) as f64 * lebesgue * slope_norm,
            position: f64::EPSILON * (n * n) as f64,
        };
        let slopes = &values * &d;
        JacobianProof {
            differentiation: row_major(&d),
            whole: Rows {
                value: row_major(&values),
                slope: row_major(&slopes),
                value_t: row_major_transposed(&values),
                slope_t: row_major_transposed(&slopes),
            },
            chebyshev: row_major(&chebyshev),
            chebyshev_t: row_major_transposed(&chebyshev),
            nodes,
            points,
            conversions,
            rounding,
            work: Work::default(),
        }
    }

    /// Examines the element with nodes `[j][i]`, (N + 1)² of them at the Gauss-Lobatto points.
    pub fn examine(&mut self, nodes: &[Point]) -> Verdict {
        let mut work = std::mem::take(&mut self.work);
        let verdict = self.examine_with(nodes, &mut work);
        self.work = work;
        verdict
    }

    fn examine_with(&self, nodes: &[Point], work: &mut Work) -> Verdict {
        // Coordinates relative to a node of the element: its distance from the origin must not
        // enter the rounding error.
        let first = nodes[0];
        for c in 0..2 {
            work.x[c].clear();
            work.x[c].extend(nodes.iter().map(|p| p[c] - first[c]));
        }
        let finite = work.x.iter().flatten().all(|x| x.is_finite());
        let extent = work.x.iter().flatten().fold(0.0, |m: f64, x| m.max(x.abs()));
        if !finite || nodes.len() != self.nodes.nodes.len().pow(2) {
            return Verdict::Undecided { at: [0.0, 0.0] };
        }
        let mut open = vec![Rectangle { center: [0.0, 0.0], half: 1.0, depth: 0 }];
        let (mut lowest, mut examined) = (f64::INFINITY, 0);
        work.steepest = 0.0;
        while let Some(r) = open.pop() {
            examined += 1;
            match self.rectangle(r, extent, work) {
                Finding::Positive(bound) => lowest = lowest.min(bound),
                Finding::Negative { value, at } => return Verdict::Negative { value, at },
                Finding::Open => {
                    if r.depth == MAX_DEPTH || examined + open.len() > MAX_RECTANGLES {
                        return Verdict::Undecided { at: r.center };
                    }
                    let half = 0.5 * r.half;
                    for (dx, dy) in [(half, half), (-half, half), (half, -half), (-half, -half)] {
                        let center = [r.center[0] + dx, r.center[1] + dy];
                        open.push(Rectangle { center, half, depth: r.depth + 1 });
                    }
                }
            }
        }
        Verdict::Proven(lowest)
    }

    /// Bounds det J on one rectangle.
    fn rectangle(&self, r: Rectangle, extent: f64, work: &mut Work) -> Finding {
        let nodes = self.nodes.nodes.len();
        let m = self.points.len();
        if r.depth > 0 {
            for c in 0..2 {
                self.interval(r.center[c], r.half, &mut work.rows[c]);
            }
        }
        let [along, across] = if r.depth == 0 { [&self.whole; 2] } else { [&work.rows[0], &work.rows[1]] };
        for c in 0..2 {
            // Across first: rows stay contiguous. by_value[b][i] = Σ_j L[b][j] x[j][i].
            multiply(&across.value, &work.x[c], m, nodes, nodes, &mut work.by_value);
            multiply(&across.slope, &work.x[c], m, nodes, nodes, &mut work.by_slope);
            multiply(&work.by_value, &along.slope_t, m, nodes, m, &mut work.slopes[c]);
            multiply(&work.by_slope, &along.value_t, m, nodes, m, &mut work.slopes[2 + c]);
        }
        let [xu, yu, xv, yv] = &work.slopes;
        work.det.clear();
        work.det.extend((0..m * m).map(|k| xu[k] * yv[k] - yu[k] * xv[k]));
        let (mut largest, mut least, mut place) = (0.0f64, f64::INFINITY, 0);
        for (k, d) in work.det.iter().enumerate() {
            largest = largest.max(d.abs());
            if *d < least {
                (least, place) = (*d, k);
            }
        }
        let at = [0, 1].map(|c| {
            let index = if c == 0 { place % m } else { place / m };
            r.center[c] + r.half * self.points[index]
        });
        if least <= 0.0 || least.is_nan() {
            return Finding::Negative { value: least, at };
        }
        // Values → Chebyshev coefficients → control values of the kept part.
        multiply(&self.chebyshev, &work.det, m, m, m, &mut work.half);
        multiply(&work.half, &self.chebyshev_t, m, m, m, &mut work.coefficients);
        let conversion = &self.conversions[usize::from(r.depth >= SMALL_DEPTH)];
        let kept = conversion.kept;
        let mut tail = 0.0;
        for (k, row) in work.coefficients.chunks_exact(m).enumerate() {
            let from = if k < kept { kept } else { 0 };
            tail += row[from..].iter().map(|c| c.abs()).sum::<f64>();
        }
        if kept < m {
            // Pack the low part.
            for k in 1..kept {
                work.coefficients.copy_within(k * m..k * m + kept, k * kept);
            }
        }
        multiply(&conversion.matrix, &work.coefficients, kept, kept, kept, &mut work.half);
        multiply(&work.half, &conversion.matrix_t, kept, kept, kept, &mut work.control);
        let lowest = work.control.iter().copied().fold(f64::INFINITY, f64::min);
        let steepest = work.slopes.iter().flatten().fold(work.steepest, |g: f64, x| g.max(x.abs()));
        work.steepest = steepest;
        let slope_error = self.rounding.derivative * extent;
        let value_error = 4.0 * slope_error * (steepest + slope_error)
            + 4.0 * (self.rounding.position + f64::EPSILON) * steepest * steepest;
        let error = conversion.amplification * value_error + conversion.summation * largest;
        let bound = lowest - tail - error;
        if bound > 0.0 {
            Finding::Positive(bound.min(least))
        } else {
            Finding::Open
        }
    }

    /// Values and derivatives (with respect to the whole reference square) at the points of an interval.
    fn interval(&self, center: f64, half: f64, rows: &mut Rows) {
        let nodes = self.nodes.nodes.len();
        rows.value.clear();
        rows.value.resize(self.points.len() * nodes, 0.0);
        for (p, row) in self.points.iter().zip(rows.value.chunks_exact_mut(nodes)) {
            self.nodes.basis(center + half * p, row);
        }
        multiply(&rows.value, &self.differentiation, self.points.len(), nodes, nodes, &mut rows.slope);
        transpose(&rows.value, self.points.len(), &mut rows.value_t);
        transpose(&rows.slope, self.points.len(), &mut rows.slope_t);
    }
}
