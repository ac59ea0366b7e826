//! Gauss-Lobatto-Legendre points and weights: the nodes of a spectral element of order N.
//!
//! Reference: C. Canuto, M. Hussaini, A. Quarteroni, T. Zang, *Spectral Methods*, 2006, §2.3.

/// The order-N Gauss-Lobatto rule on [-1, 1]: N + 1 points with both ends, exact to degree 2N − 1.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussLobatto {
    /// Ascending, exactly symmetric, `nodes[0] = −1`, `nodes[N] = 1`.
    pub nodes: Vec<f64>,
    /// Positive, sum 2.
    pub weights: Vec<f64>,
}

impl GaussLobatto {
    /// The rule of order `order` (at least 1; 0 is taken as 1).
    pub fn new(order: usize) -> Self {
        let n = order.max(1);
        let mut nodes = vec![0.0; n + 1];
        let mut weights = vec![0.0; n + 1];
        for k in 0..=n / 2 {
            // Inner points are the zeros of P'_N; Newton on x P_N − P_{N−1}, which has the same ones
            // and the ends, starts close enough at the Chebyshev points for every order.
            let mut x = if k == 0 { -1.0 } else { -(std::f64::consts::PI * k as f64 / n as f64).cos() };
            if 2 * k == n {
                x = 0.0;
            } else if k > 0 {
                for _ in 0..NEWTON_STEPS {
                    let (p, q) = legendre(n, x);
                    let step = (x * p - q) / ((n + 1) as f64 * p);
                    x -= step;
                    if step.abs() < f64::EPSILON {
                        break;
                    }
                }
            }
            let p = legendre(n, x).0;
            let w = 2.0 / ((n * (n + 1)) as f64 * p * p);
            (nodes[k], nodes[n - k]) = (x, -x);
            (weights[k], weights[n - k]) = (w, w);
        }
        if n % 2 == 0 {
            nodes[n / 2] = 0.0;
        }
        GaussLobatto { nodes, weights }
    }

    /// The order N.
    pub fn order(&self) -> usize {
        self.nodes.len() - 1
    }
}

/// Newton converges quadratically: 5 steps reach rounding at every order; the rest is margin.
pub(super) const NEWTON_STEPS: usize = 20;

/// Legendre polynomials (P_n(x), P_{n−1}(x)), P_{−1} = 0.
pub fn legendre(n: usize, x: f64) -> (f64, f64) {
    let (mut p, mut q) = (1.0, 0.0);
    for k in 0..n {
        let k = k as f64;
        (p, q) = (((2.0 * k + 1.0) * x * p - k * q) / (k + 1.0), p);
    }
    (p, q)
}
