//! Quality measures of a curved element.

use super::dense::{multiply, row_major, row_major_transposed};
use crate::numerics::interpolation::chebyshev_lobatto;
use crate::numerics::{GaussLobatto, Interpolation, Point, Vector};
use crate::options::Options;

/// Measures of one element; minima and maxima are over the whole element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementMeasures {
    /// Minimum of det J / (|x_ξ| |x_η|), in [-1, 1].
    pub scaled_jacobian: f64,
    /// Least and largest angle between the grid directions, in radians in (−π, π].
    pub min_angle: f64,
    pub max_angle: f64,
    /// Mean length of the longer pair of opposite sides by that of the shorter, at least 1.
    pub aspect_ratio: f64,
    /// Length of the longest side by that of the shortest, at least 1.
    pub edge_ratio: f64,
    /// Maximum of (|x_ξ|² + |x_η|²) / (2 det J), the condition number of J in the Frobenius norm: 1 where
    /// the grid is square and equally spaced, infinite where it is inverted.
    pub condition: f64,
    /// Area (exact up to rounding).
    pub area: f64,
    /// Minimum by maximum of det J; at most 1, negative where inverted.
    pub jacobian_ratio: f64,
}

/// Tables to measure elements of one order; build once.
#[derive(Debug, Clone)]
pub struct Quality {
    lobatto: GaussLobatto,
    nodes: Interpolation,
    /// Derivatives at the nodes, `[i][k]` row by row.
    differentiation: Vec<f64>,
    /// Sample points along one direction, ends included.
    points: Vec<f64>,
    /// From the nodes to values and derivatives at the sample points, row by row, and the transposes.
    value: Vec<f64>,
    slope: Vec<f64>,
    value_t: Vec<f64>,
    slope_t: Vec<f64>,
}

/// Most nodes along one direction.
const MAX_NODES: usize = Options::MAX_ORDER + 1;

/// Halvings of the step around the least sample.
const REFINEMENTS: usize = 8;

impl Quality {
    /// Tables for elements of order `order` (1 to 32).
    pub fn new(order: usize) -> Self {
        let lobatto = GaussLobatto::new(order.min(Options::MAX_ORDER));
        let nodes = Interpolation::new(lobatto.nodes.clone());
        // Odd degree + 1 points have no centre, so the degree is even.
        let points = chebyshev_lobatto((2 * lobatto.order() + 4).max(12));
        let (value, slope) = (nodes.matrix(&points), nodes.derivative_matrix(&points));
        Quality {
            differentiation: row_major(&nodes.differentiation()),
            value: row_major(&value),
            slope: row_major(&slope),
            value_t: row_major_transposed(&value),
            slope_t: row_major_transposed(&slope),
            lobatto,
            nodes,
            points,
        }
    }

    /// x_ξ, y_ξ, x_η, y_η at every sample point, `[η][ξ]`.
    fn slopes(&self, nodes: &[Point]) -> [Vec<f64>; 4] {
        let (n, m) = (self.nodes.nodes.len(), self.points.len());
        let mut result: [Vec<f64>; 4] = Default::default();
        let mut rows = Vec::new();
        for c in 0..2 {
            let x: Vec<f64> = nodes.iter().map(|p| p[c]).collect();
            multiply(&self.value, &x, m, n, n, &mut rows);
            multiply(&rows, &self.slope_t, m, n, m, &mut result[c]);
            multiply(&self.slope, &x, m, n, n, &mut rows);
            multiply(&rows, &self.value_t, m, n, m, &mut result[2 + c]);
        }
        result
    }

    /// Minimum of det J / (|x_ξ| |x_η|) over the element with nodes `[j][i]`: samples, corners
    /// included, then a search around the least.
    pub fn scaled_jacobian(&self, nodes: &[Point]) -> f64 {
        let [xu, yu, xv, yv] = self.slopes(nodes);
        let (mut least, mut place) = (f64::INFINITY, 0);
        for k in 0..xu.len() {
            let s = scaled(Vector::new(xu[k], yu[k]), Vector::new(xv[k], yv[k]));
            if s < least {
                (least, place) = (s, k);
            }
        }
        let m = self.points.len();
        self.descend(nodes, [self.points[place % m], self.points[place / m]], least)
    }

    /// Pattern search for the minimum of the scaled Jacobian from a sample.
    fn descend(&self, nodes: &[Point], from: [f64; 2], value: f64) -> f64 {
        let (mut at, mut least) = (from, value);
        // The widest gap between samples is π / m.
        let mut step = 0.5 * std::f64::consts::PI / self.points.len() as f64;
        for _ in 0..REFINEMENTS {
            let center = at;
            for (dx, dy) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
                let p = [center[0] + dx * step, center[1] + dy * step].map(|x: f64| x.clamp(-1.0, 1.0));
                let (u, v) = self.derivatives(nodes, p);
                let s = scaled(u, v);
                if s < least {
                    (least, at) = (s, p);
                }
            }
            if at == center {
                step *= 0.5;
            }
        }
        least
    }

    /// x_ξ and x_η at reference point `at`.
    pub fn derivatives(&self, nodes: &[Point], at: [f64; 2]) -> (Vector, Vector) {
        let n = self.nodes.nodes.len();
        let mut basis = [[0.0; MAX_NODES]; 2];
        let mut slopes = [[0.0; MAX_NODES]; 2];
        for c in 0..2 {
            self.nodes.basis(at[c], &mut basis[c][..n]);
            for (b, row) in basis[c].iter().zip(self.differentiation.chunks_exact(n)) {
                slopes[c].iter_mut().zip(row).for_each(|(s, d)| *s += b * d);
            }
        }
        let (mut u, mut v) = (Vector::zeros(), Vector::zeros());
        for (j, row) in nodes.chunks_exact(n).enumerate() {
            let (mut along, mut value) = (Vector::zeros(), Vector::zeros());
            for (i, p) in row.iter().enumerate() {
                along += p.coords * slopes[0][i];
                value += p.coords * basis[0][i];
            }
            u += along * basis[1][j];
            v += value * slopes[1][j];
        }
        (u, v)
    }

    /// The point at reference point `at`.
    pub fn point(&self, nodes: &[Point], at: [f64; 2]) -> Point {
        let n = self.nodes.nodes.len();
        let rows: Vec<Point> = nodes.chunks_exact(n).map(|row| self.nodes.point(row, at[0])).collect();
        self.nodes.point(&rows, at[1])
    }

    /// Minimum by maximum of det J over the element with nodes `[j][i]`, at the samples.
    pub fn jacobian_ratio(&self, nodes: &[Point]) -> f64 {
        ratio(&self.slopes(nodes))
    }

    /// All measures of the element with nodes `[j][i]`.
    pub fn measure(&self, nodes: &[Point]) -> ElementMeasures {
        let slopes = self.slopes(nodes);
        let [xu, yu, xv, yv] = &slopes;
        let mut result = ElementMeasures {
            scaled_jacobian: self.scaled_jacobian(nodes),
            min_angle: f64::INFINITY,
            max_angle: f64::NEG_INFINITY,
            aspect_ratio: 1.0,
            edge_ratio: 1.0,
            condition: 1.0,
            area: self.area(nodes),
            jacobian_ratio: 0.0,
        };
        for k in 0..xu.len() {
            let det = xu[k] * yv[k] - yu[k] * xv[k];
            let angle = det.atan2(xu[k] * xv[k] + yu[k] * yv[k]);
            result.min_angle = result.min_angle.min(angle);
            result.max_angle = result.max_angle.max(angle);
            let squares = xu[k] * xu[k] + yu[k] * yu[k] + xv[k] * xv[k] + yv[k] * yv[k];
            let condition = if det > 0.0 { squares / (2.0 * det) } else { f64::INFINITY };
            result.condition = result.condition.max(condition);
        }
        result.jacobian_ratio = ratio(&slopes);
        let lengths = self.side_lengths(nodes);
        let (a, b) = (lengths[0] + lengths[2], lengths[1] + lengths[3]);
        result.aspect_ratio = a.max(b) / a.min(b);
        let (short, long) = lengths.iter().fold((f64::INFINITY, 0.0f64), |(s, l), x| (x.min(s), x.max(l)));
        result.edge_ratio = long / short;
        result
    }

    /// ∫ det J: the Gauss-Lobatto rule is exact for its degree 2N − 1.
    pub fn area(&self, nodes: &[Point]) -> f64 {
        let n = self.nodes.nodes.len();
        let d = &self.differentiation;
        let mut area = 0.0;
        // Relative to a node, so that the element's distance from the origin costs no digits.
        let origin = nodes[0];
        for j in 0..n {
            for i in 0..n {
                let (mut u, mut v) = (Vector::zeros(), Vector::zeros());
                for k in 0..n {
                    u += (nodes[j * n + k] - origin) * d[i * n + k];
                    v += (nodes[k * n + i] - origin) * d[j * n + k];
                }
                area += self.lobatto.weights[i] * self.lobatto.weights[j] * (u.x * v.y - u.y * v.x);
            }
        }
        area
    }

    /// Lengths of the four sides (Gauss-Lobatto quadrature).
    pub fn side_lengths(&self, nodes: &[Point]) -> [f64; 4] {
        let n = self.nodes.nodes.len();
        let last = n - 1;
        [0, 1, 2, 3].map(|s| {
            let node = |k: usize| match s {
                0 => nodes[k],
                1 => nodes[k * n + last],
                2 => nodes[last * n + k],
                _ => nodes[k * n],
            };
            (0..n)
                .map(|i| {
                    let d: Vector =
                        (0..n).map(|k| (node(k) - node(0)) * self.differentiation[i * n + k]).sum();
                    self.lobatto.weights[i] * d.norm()
                })
                .sum()
        })
    }
}

/// Least by largest of det(u, v); -1 where none is positive.
fn ratio([xu, yu, xv, yv]: &[Vec<f64>; 4]) -> f64 {
    let dets = (0..xu.len()).map(|k| xu[k] * yv[k] - yu[k] * xv[k]);
    let (low, high) = dets.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), d| (d.min(l), d.max(h)));
    if high > 0.0 {
        low / high
    } else {
        -1.0
    }
}

/// det(u, v) / (|u| |v|); 0 where a derivative vanishes.
fn scaled(u: Vector, v: Vector) -> f64 {
    let product = (u.norm_squared() * v.norm_squared()).sqrt();
    if product > 0.0 {
        (u.x * v.y - u.y * v.x) / product
    } else {
        0.0
    }
}
