//! Tables on the reference edge: what turns an edge's unknowns into samples of its curve.

use crate::domain::walk::FOUR;
use crate::numerics::{GaussLegendre, GaussLobatto, Interpolation};

/// Most samples per direction: at high order the shapes that the optimiser can give an interior edge
/// stay of low degree, so a denser grid would only cost time.
pub(super) const MAX_SAMPLES: usize = 12;
/// The same for the usual energy.
const MOST_USUAL_SAMPLES: usize = 8;

/// The same where errors of waves are measured.
pub(super) const MOST_LANES: usize = 16;

/// Most bubbles of an interior edge, which is a cubic then: four gained nothing measurable on 71 domains.
pub(super) const MAX_BUBBLES: usize = 2;

/// Quadrature points for the boundary error of one edge beyond its order. Few, for the barrier only: what it
/// misses at small kinks the final measure, which is another, sees.
const MORE_ERROR_POINTS: usize = 5;

/// Samples, bubbles, Gauss-Lobatto nodes and quadrature on [0, 1]. Matrices are stored by columns:
/// all samples of one unknown after another.
#[derive(Debug, Clone)]
pub(super) struct Reference {
    pub order: usize,
    /// Elements with straight sides are sampled like all others.
    pub samples_all: bool,
    /// Sample parameters, ascending with both ends, exactly symmetric.
    pub samples: Vec<f64>,
    /// Length L of the tables' columns: samples rounded up to whole vectors; the last sample is repeated.
    pub lanes: usize,
    /// Number of bubbles of an interior edge.
    pub bubbles: usize,
    /// `bubble[m * L + k]`: bubble m at sample k, and its derivative.
    pub bubble: Vec<f64>,
    pub bubble_slope: Vec<f64>,
    /// The N + 1 nodes of a boundary edge.
    pub nodes: Vec<f64>,
    /// `lagrange[i * L + k]`: the Lagrange polynomial of node i at sample k, and its derivative.
    pub lagrange: Vec<f64>,
    pub lagrange_slope: Vec<f64>,
    /// Quadrature of the boundary error, filled up to whole fours with points of no weight.
    pub error_points: Vec<f64>,
    pub error_weights: Vec<f64>,
    /// By fours of points: `error_lagrange[q / 4 * 4 * (N + 1) + 4 * i + q % 4]`, and the same times node i.
    pub error_lagrange: Vec<f64>,
    pub error_shifted: Vec<f64>,
}

/// Bubble 4 τ (1 − τ) P_m(2τ − 1) and its derivative in τ.
pub(super) fn bubble(m: usize, tau: f64) -> (f64, f64) {
    let x = 2.0 * tau - 1.0;
    let (mut p, mut before, mut slope) = (1.0, 0.0, 0.0);
    // P'_{k+1} = x P'_k + (k + 1) P_k, beside the three-term recurrence.
    for k in 0..m {
        let kf = k as f64;
        let next = ((2.0 * kf + 1.0) * x * p - kf * before) / (kf + 1.0);
        slope = x * slope + (kf + 1.0) * p;
        (p, before) = (next, p);
    }
    let q = 4.0 * tau * (1.0 - tau);
    (q * p, 4.0 * (1.0 - 2.0 * tau) * p + 2.0 * q * slope)
}

impl Reference {
    /// Tables for elements of order `order` with `samples` samples along an edge.
    pub fn new(order: usize, samples: usize) -> Self {
        let unit = |x: &[f64]| -> Vec<f64> { x.iter().map(|x| 0.5 * (1.0 + x)).collect() };
        let lobatto = GaussLobatto::new(order);
        let at = GaussLobatto::new(samples - 1).nodes;
        let interpolation = Interpolation::new(lobatto.nodes.clone());
        let gauss = GaussLegendre::new(order + MORE_ERROR_POINTS);
        let samples = unit(&at);
        let lanes = samples.len().next_multiple_of(FOUR);
        // Targets of the tables: the samples, the last as often as there are lanes left.
        let at: Vec<f64> = (0..lanes).map(|k| at[k.min(samples.len() - 1)]).collect();
        let bubbles = (order - 1).min(MAX_BUBBLES);
        let table: Vec<(f64, f64)> =
            (0..bubbles).flat_map(|m| unit(&at).into_iter().map(move |t| bubble(m, t))).collect();
        // nalgebra stores by columns: rows are targets, columns nodes. Slopes are per unit of [0, 1].
        let slope = interpolation.derivative_matrix(&at) * 2.0;
        let nodes = unit(&lobatto.nodes);
        let points = gauss.nodes.len().next_multiple_of(FOUR);
        let gauss_nodes: Vec<f64> = (0..points).map(|q| gauss.nodes[q.min(gauss.nodes.len() - 1)]).collect();
        let error = interpolation.matrix(&gauss_nodes);
        let by_fours = |value: &dyn Fn(usize, usize) -> f64| -> Vec<f64> {
            let mut list = Vec::with_capacity(points * (order + 1));
            for first in (0..points).step_by(FOUR) {
                for i in 0..=order {
                    list.extend((first..first + FOUR).map(|q| value(q, i)));
                }
            }
            list
        };
        Reference {
            order,
            samples_all: false,
            lanes,
            bubbles,
            bubble: table.iter().map(|b| b.0).collect(),
            bubble_slope: table.iter().map(|b| b.1).collect(),
            lagrange: interpolation.matrix(&at).as_slice().to_vec(),
            lagrange_slope: slope.as_slice().to_vec(),
            error_points: unit(&gauss_nodes),
            error_weights: (0..points).map(|q| gauss.weights.get(q).map_or(0.0, |w| 0.5 * w)).collect(),
            error_lagrange: by_fours(&|q, i| error[(q, i)]),
            error_shifted: by_fours(&|q, i| error[(q, i)] * nodes[i]),
            nodes,
            samples,
        }
    }

    /// Tables for the optimiser: det J has degree 2N − 1, N + 2 samples with the ends see its sign
    /// well enough; the proof of validity is made elsewhere.
    pub fn for_energy(order: usize) -> Self {
        Reference::new(order, (order + 2).clamp(3, MOST_USUAL_SAMPLES))
    }

    /// Tables for errors of waves, which see elements with straight sides, too.
    pub fn for_waves(order: usize, samples: usize) -> Self {
        Reference { samples_all: true, ..Self::new(order, samples) }
    }

    /// The same as the first with more samples, for elements that are inverted between the usual ones.
    pub fn for_dense_energy(order: usize) -> Self {
        Reference::new(order, (2 * order + 1).clamp(4, MAX_SAMPLES))
    }

    /// Tables for measuring quality, about twice as dense.
    pub fn for_quality(order: usize) -> Self {
        Reference::new(order, (2 * order + 3).clamp(5, 2 * MAX_SAMPLES + 1))
    }
}
