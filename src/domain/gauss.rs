//! Gauss-Legendre quadrature along curve segments.

use std::sync::OnceLock;

/// Nodes and weights on [0, 1].
pub(crate) struct GaussRule {
    pub nodes: Vec<f64>,
    pub weights: Vec<f64>,
}

impl GaussRule {
    fn new(n: usize) -> Self {
        let (mut nodes, mut weights) = (vec![0.5; n], vec![0.0; n]);
        for i in 0..n.div_ceil(2) {
            // Newton from Tricomi's estimate converges quadratically; eight steps are plenty.
            let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..8 {
                let (mut p, mut q) = (1.0, 0.0);
                for k in 0..n {
                    (p, q) = (((2 * k + 1) as f64 * x * p - k as f64 * q) / (k + 1) as f64, p);
                }
                slope = n as f64 * (x * p - q) / (x * x - 1.0);
                x -= p / slope;
            }
            let w = 1.0 / ((1.0 - x * x) * slope * slope);
            (nodes[i], nodes[n - 1 - i]) = (0.5 * (1.0 - x), 0.5 * (1.0 + x));
            (weights[i], weights[n - 1 - i]) = (w, w);
        }
        GaussRule { nodes, weights }
    }

    /// The rule exact for straight and quadratic pieces.
    pub fn two() -> &'static GaussRule {
        static RULE: OnceLock<GaussRule> = OnceLock::new();
        RULE.get_or_init(|| GaussRule::new(2))
    }

    /// The rule for a quarter of a short smooth piece.
    pub fn four() -> &'static GaussRule {
        static RULE: OnceLock<GaussRule> = OnceLock::new();
        RULE.get_or_init(|| GaussRule::new(4))
    }

    /// The rule for short smooth pieces.
    pub fn eight() -> &'static GaussRule {
        static RULE: OnceLock<GaussRule> = OnceLock::new();
        RULE.get_or_init(|| GaussRule::new(8))
    }

    /// The rule for long smooth pieces.
    pub fn sixteen() -> &'static GaussRule {
        static RULE: OnceLock<GaussRule> = OnceLock::new();
        RULE.get_or_init(|| GaussRule::new(16))
    }
}

/// `t` rounded to a multiple of 2⁻⁵², so that 1 − t is exact and a segment walked backwards is
/// evaluated at the very same parameters.
pub(crate) fn snap(t: f64) -> f64 {
    (1.0 + t) - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_to_their_degree() {
        for (rule, n) in [
            (GaussRule::two(), 2),
            (GaussRule::four(), 4),
            (GaussRule::eight(), 8),
            (GaussRule::sixteen(), 16),
        ] {
            for degree in 0..2 * n {
                let sum: f64 = rule.nodes.iter().zip(&rule.weights).map(|(x, w)| w * x.powi(degree)).sum();
                assert!((sum - 1.0 / (degree + 1) as f64).abs() < 1e-14, "{n} points, degree {degree}");
            }
        }
    }
}
