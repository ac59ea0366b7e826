//! Gauss-Legendre quadrature.

use super::gauss_lobatto::{legendre, NEWTON_STEPS};

/// The Gauss-Legendre rule of n points on [-1, 1], exact to degree 2n − 1.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussLegendre {
    /// Ascending, exactly symmetric, strictly inside.
    pub nodes: Vec<f64>,
    /// Positive, sum 2.
    pub weights: Vec<f64>,
}

impl GaussLegendre {
    /// The rule of `points` points (at least 1; 0 is taken as 1).
    pub fn new(points: usize) -> Self {
        let n = points.max(1);
        let mut nodes = vec![0.0; n];
        let mut weights = vec![0.0; n];
        for k in 0..n.div_ceil(2) {
            let derivative = |x: f64, p: f64, q: f64| n as f64 * (q - x * p) / (1.0 - x * x);
            // Tricomi's estimate of the zero, then Newton.
            let mut x = -(std::f64::consts::PI * (k as f64 + 0.75) / (n as f64 + 0.5)).cos();
            if 2 * k + 1 == n {
                x = 0.0;
            } else {
                for _ in 0..NEWTON_STEPS {
                    let (p, q) = legendre(n, x);
                    let step = p / derivative(x, p, q);
                    x -= step;
                    if step.abs() < f64::EPSILON {
                        break;
                    }
                }
            }
            let (p, q) = legendre(n, x);
            let d = derivative(x, p, q);
            let w = 2.0 / ((1.0 - x * x) * d * d);
            (nodes[k], nodes[n - 1 - k]) = (x, -x);
            (weights[k], weights[n - 1 - k]) = (w, w);
        }
        if n % 2 == 1 {
            nodes[n / 2] = 0.0;
        }
        GaussLegendre { nodes, weights }
    }

    /// ∫ f over [a, b].
    pub fn integrate(&self, a: f64, b: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        let (center, half) = (0.5 * (a + b), 0.5 * (b - a));
        self.nodes.iter().zip(&self.weights).map(|(x, w)| w * f(center + half * x)).sum::<f64>() * half
    }
}
