//! Polynomial interpolation in barycentric form: evaluation, differentiation, change of nodes.
//!
//! Reference: J.-P. Berrut, L. N. Trefethen, *Barycentric Lagrange interpolation*, SIAM Review 46 (2004).

use super::{Point, Vector};
use nalgebra::DMatrix;

/// Lagrange interpolation on fixed nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Interpolation {
    /// The nodes, all different.
    pub nodes: Vec<f64>,
    /// Barycentric weights, up to a common factor.
    pub weights: Vec<f64>,
}

impl Interpolation {
    /// Interpolation on `nodes`, which lie in [-1, 1] and are all different.
    pub fn new(nodes: Vec<f64>) -> Self {
        // Differences times 2 keep the products near 1 on an interval of length 2 (its capacity is 1/2).
        let weights = nodes
            .iter()
            .enumerate()
            .map(|(i, x)| {
                let others = nodes.iter().enumerate().filter(|(j, _)| *j != i);
                1.0 / others.map(|(_, y)| 2.0 * (x - y)).product::<f64>()
            })
            .collect();
        Interpolation { nodes, weights }
    }

    /// Values at `x` of all Lagrange polynomials, written to `out` (one for each node).
    pub fn basis(&self, x: f64, out: &mut [f64]) {
        if let Some(hit) = self.nodes.iter().position(|n| *n == x) {
            out.fill(0.0);
            out[hit] = 1.0;
            return;
        }
        let mut sum = 0.0;
        for ((o, n), w) in out.iter_mut().zip(&self.nodes).zip(&self.weights) {
            *o = w / (x - n);
            sum += *o;
        }
        for o in out {
            *o /= sum;
        }
    }

    /// Matrix of values: row r takes values at the nodes to the value at `targets[r]`.
    pub fn matrix(&self, targets: &[f64]) -> DMatrix<f64> {
        let n = self.nodes.len();
        let mut m = DMatrix::zeros(targets.len(), n);
        let mut row = vec![0.0; n];
        for (r, x) in targets.iter().enumerate() {
            self.basis(*x, &mut row);
            m.row_mut(r).copy_from_slice(&row);
        }
        m
    }

    /// Matrix that takes values at the nodes to derivatives at the nodes.
    pub fn differentiation(&self) -> DMatrix<f64> {
        let n = self.nodes.len();
        let mut d = DMatrix::zeros(n, n);
        for i in 0..n {
            let mut sum = 0.0;
            for j in (0..n).filter(|j| *j != i) {
                d[(i, j)] = self.weights[j] / self.weights[i] / (self.nodes[i] - self.nodes[j]);
                sum += d[(i, j)];
            }
            // Negative sums make the derivative of a constant exactly 0, which is what keeps the
            // error small (Baltensperger, Trummer 2003).
            d[(i, i)] = -sum;
        }
        d
    }

    /// Matrix that takes values at the nodes to derivatives at `targets`.
    pub fn derivative_matrix(&self, targets: &[f64]) -> DMatrix<f64> {
        self.matrix(targets) * self.differentiation()
    }

    /// The interpolant of `points` (one for each node) at `x`.
    pub fn point(&self, points: &[Point], x: f64) -> Point {
        if let Some(hit) = self.nodes.iter().position(|n| *n == x) {
            return points[hit];
        }
        let (mut sum, mut value) = (0.0, Vector::zeros());
        for ((n, w), p) in self.nodes.iter().zip(&self.weights).zip(points) {
            let c = w / (x - n);
            sum += c;
            value += p.coords * c;
        }
        Point::from(value / sum)
    }
}

/// N + 1 equispaced points in [-1, 1], the node family of VTK and Gmsh files.
pub fn equispaced(order: usize) -> Vec<f64> {
    let n = order.max(1);
    (0..=n).map(|i| (2.0 * i as f64 - n as f64) / n as f64).collect()
}

/// N + 1 Chebyshev-Lobatto points in [-1, 1], ascending and exactly symmetric: the node family of
/// HOHQMesh's files.
pub fn chebyshev_lobatto(order: usize) -> Vec<f64> {
    let n = order.max(1);
    // sin keeps the symmetry that cos loses to rounding.
    (0..=n).map(|i| (std::f64::consts::FRAC_PI_2 * (2.0 * i as f64 - n as f64) / n as f64).sin()).collect()
}

/// Reference nodes in [-1, 1] as parameters in [0, 1].
pub fn unit_parameters(nodes: &[f64]) -> Vec<f64> {
    nodes.iter().map(|x| 0.5 * (1.0 + x)).collect()
}
