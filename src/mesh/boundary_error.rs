//! How far a boundary edge of order N is from the exact curve.
//!
//! With s the arc length along the edge, x(s) the exact curve and x_N the order-N polynomial edge
//! that interpolates it at the Gauss-Lobatto points in s, over an edge of length L:
//! L2 = (∫ |x − x_N|² ds)^½, H1 = (∫ |x − x_N|² + L² |x′ − x_N′|² ds)^½, Max = max |x − x_N|.
//! Integrals stop at the curve's breaks and use at least 24 points an edge: fewer underestimate the
//! error at a small kink by a fifth.

use super::chain_error::SquaredError;
use crate::domain::{Boundary, Chain, Frame, Span};
use crate::numerics::interpolation::unit_parameters;
use crate::numerics::{GaussLegendre, GaussLobatto, Interpolation, Modal, Point, Vector};
use crate::options::{Norm, Options};
use nalgebra::DMatrix;

/// The tolerance every boundary edge has to keep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundaryTolerance {
    pub norm: Norm,
    /// Polynomial order N of the edges.
    pub order: usize,
    /// Largest allowed error, in the frame the edges are measured in.
    pub value: f64,
}

impl BoundaryTolerance {
    /// The options' tolerance in the canonical frame. A relative one, E, means E · D^{3/2} (E · D for the
    /// maximum), D the diagonal of the domain's bounding box.
    pub fn new(options: &Options, boundary: &Boundary) -> Self {
        let value = boundary.canonical_tolerance(options.tolerance, options.norm);
        BoundaryTolerance { norm: options.norm, order: options.order, value }
    }

    /// The same tolerance for edges in the caller's frame.
    pub fn in_caller_frame(&self, frame: &Frame) -> Self {
        BoundaryTolerance { value: self.value * norm_unit(self.norm, frame.scale), ..*self }
    }
}

/// What an error of 1 in the canonical frame is in the caller's: L2 and H1 scale with
/// length^{3/2}, the maximum with length.
fn norm_unit(norm: Norm, scale: f64) -> f64 {
    match norm {
        Norm::L2 | Norm::H1 => scale * scale.sqrt(),
        Norm::Max => scale,
    }
}

/// Least number of quadrature points of an edge.
const EDGE_POINTS: usize = 24;
/// Points a smooth piece gets beyond its share of the edge's.
const PIECE_POINTS: usize = 4;
/// Most nodes an edge can have.
pub(super) const MAX_NODES: usize = Options::MAX_ORDER + 1;

/// Measures boundary edges of one order in one norm; build once, use for many edges.
#[derive(Debug, Clone)]
pub struct BoundaryError {
    pub tolerance: BoundaryTolerance,
    /// Gauss-Lobatto nodes of an edge, also as parameters in [0, 1].
    lobatto: GaussLobatto,
    parameters: Vec<f64>,
    modal: Modal,
    /// Gauss rules, by number of points.
    rules: Vec<GaussLegendre>,
    differentiation: DMatrix<f64>,
}

impl BoundaryError {
    /// Tables for edges under `tolerance` (its order in 1..=32).
    pub fn new(tolerance: BoundaryTolerance) -> Self {
        let order = tolerance.order.clamp(1, Options::MAX_ORDER);
        let lobatto = GaussLobatto::new(order);
        // The squared error is about of degree 2N + 2 on a smooth edge.
        let most = EDGE_POINTS.max(order + 4) + PIECE_POINTS;
        let rules: Vec<_> = (0..=most).map(GaussLegendre::new).collect();
        let differentiation = Interpolation::new(lobatto.nodes.clone()).differentiation();
        let parameters = unit_parameters(&lobatto.nodes);
        BoundaryError { tolerance, modal: Modal::new(&lobatto), lobatto, parameters, rules, differentiation }
    }

    /// Gauss-Lobatto nodes in [-1, 1] of an edge.
    pub fn reference_nodes(&self) -> &[f64] {
        &self.lobatto.nodes
    }

    pub(super) fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    pub(super) fn modal(&self) -> &Modal {
        &self.modal
    }

    /// The quadrature of a piece of an edge, this share of it.
    #[inline(always)]
    pub(super) fn rule(&self, share: f64) -> &GaussLegendre {
        let most = self.rules.len() - 1;
        let points = ((share * (most - PIECE_POINTS) as f64).ceil() as usize + PIECE_POINTS).min(most);
        &self.rules[points]
    }

    /// Error of the edge over `span`, in the norm's unit in the canonical frame.
    pub fn of_span(&self, boundary: &Boundary, span: Span) -> f64 {
        self.of_chain(&boundary.chains[span.chain as usize], span.start, span.end)
    }

    /// Error of the edge over `span`, divided by the tolerance: at most 1 where it holds.
    pub fn ratio(&self, boundary: &Boundary, span: Span) -> f64 {
        self.of_span(boundary, span) / self.tolerance.value
    }

    /// Error of the edge from arc length `start` to `end` of `chain`.
    pub fn of_chain(&self, chain: &Chain, start: f64, end: f64) -> f64 {
        let length = end - start;
        let mut breaks = Vec::new();
        breaks_within(chain, start, end, &mut breaks);
        if self.tolerance.norm == Norm::L2 {
            // Not so for an edge without extent or with a NaN.
            let positive = length > 0.0;
            let squared = SquaredError { error: self, chain, start, length, breaks: &breaks };
            return if positive { squared.value().sqrt() } else { f64::INFINITY };
        }
        let mut nodes = [Point::origin(); MAX_NODES];
        let nodes = &mut nodes[..self.lobatto.nodes.len()];
        for (node, t) in nodes.iter_mut().zip(&self.parameters) {
            *node = chain.point(start + t * length);
        }
        let curve = |s: f64| Ok::<_, std::convert::Infallible>(chain.evaluate(start + s));
        match self.measure(nodes, length, &breaks, curve) {
            Ok(e) => e,
            Err(never) => match never {},
        }
    }

    /// Error of the edge with the given `nodes` against `curve`: point and d/ds at arc length s
    /// from the edge's start, s in [0, length]. `breaks`: arc lengths in (0, length), ascending,
    /// at which the curve is less smooth.
    ///
    /// # Errors
    /// The first failure of `curve`.
    pub fn measure<E>(
        &self,
        nodes: &[Point],
        length: f64,
        breaks: &[f64],
        mut curve: impl FnMut(f64) -> Result<(Point, Vector), E>,
    ) -> Result<f64, E> {
        // Not so for an edge without extent or with a NaN.
        let positive = length > 0.0;
        if !positive {
            return Ok(f64::INFINITY);
        }
        let mut accumulated = Accumulated::new(self.tolerance.norm, length);
        let edge = self.edge(nodes, length);
        let mut from = 0.0;
        for to in breaks.iter().copied().chain([length]) {
            let rule = self.rule((to - from) / length);
            for (xi, weight) in rule.nodes.iter().zip(&rule.weights) {
                let s = from + 0.5 * (1.0 + xi) * (to - from);
                let (x, slope) = edge.at(2.0 * s / length - 1.0);
                let (p, d) = curve(s)?;
                accumulated.add(s, 0.5 * weight * (to - from), p.coords - x, d - slope);
            }
            from = to;
        }
        if self.tolerance.norm == Norm::Max {
            return refine_maximum(accumulated, &edge, length, curve);
        }
        Ok(accumulated.sum.sqrt())
    }

    /// The polynomial edge through `nodes`; its slope only where the norm looks at it.
    fn edge(&self, nodes: &[Point], length: f64) -> PolynomialEdge<'_> {
        let n = nodes.len();
        let mut edge =
            PolynomialEdge { modal: &self.modal, n, value: [Vector::zeros(); MAX_NODES], slope: None };
        self.modal.modes(nodes, &mut edge.value[..n]);
        if self.tolerance.norm == Norm::H1 {
            let mut slopes = [Point::origin(); MAX_NODES];
            for (i, slope) in slopes.iter_mut().enumerate().take(n) {
                for (j, node) in nodes.iter().enumerate() {
                    *slope += node.coords * (self.differentiation[(i, j)] * 2.0 / length);
                }
            }
            let mut modes = [Vector::zeros(); MAX_NODES];
            self.modal.modes(&slopes[..n], &mut modes[..n]);
            edge.slope = Some(modes);
        }
        edge
    }
}

/// The polynomial edge and its d/ds by Legendre coefficients.
struct PolynomialEdge<'a> {
    modal: &'a Modal,
    n: usize,
    value: [Vector; MAX_NODES],
    slope: Option<[Vector; MAX_NODES]>,
}

impl PolynomialEdge<'_> {
    /// Point and slope (if it is known, else 0) at reference parameter `xi`.
    fn at(&self, xi: f64) -> (Vector, Vector) {
        let slope = self.slope.as_ref().map_or_else(Vector::zeros, |s| self.modal.value(&s[..self.n], xi));
        (self.modal.value(&self.value[..self.n], xi), slope)
    }
}

/// The largest distance, by a ternary search between the neighbours of the largest sample.
fn refine_maximum<E>(
    found: Accumulated,
    edge: &PolynomialEdge,
    length: f64,
    mut curve: impl FnMut(f64) -> Result<(Point, Vector), E>,
) -> Result<f64, E> {
    let mut distance =
        |s: f64| -> Result<f64, E> { Ok((curve(s)?.0.coords - edge.at(2.0 * s / length - 1.0).0).norm()) };
    let reach = length / EDGE_POINTS as f64;
    let (mut a, mut b) = ((found.place - reach).max(0.0), (found.place + reach).min(length));
    let mut largest = found.sum;
    for _ in 0..MAXIMUM_STEPS {
        let (l, r) = (a + (b - a) / 3.0, b - (b - a) / 3.0);
        let (fl, fr) = (distance(l)?, distance(r)?);
        largest = largest.max(fl).max(fr);
        if fl > fr {
            b = r;
        } else {
            a = l;
        }
    }
    Ok(largest)
}

/// Each step leaves 2/3 of the interval; the maximum is flat, so 6 steps leave an error below 1 %.
const MAXIMUM_STEPS: usize = 6;

/// The norm as it is summed up (its square, or the maximum and where it is).
struct Accumulated {
    norm: Norm,
    length: f64,
    sum: f64,
    place: f64,
}

impl Accumulated {
    fn new(norm: Norm, length: f64) -> Self {
        Accumulated { norm, length, sum: 0.0, place: 0.0 }
    }

    fn add(&mut self, s: f64, weight: f64, error: Vector, slope_error: Vector) {
        match self.norm {
            Norm::L2 => self.sum += weight * error.norm_squared(),
            Norm::H1 => {
                let slope = self.length * self.length * slope_error.norm_squared();
                self.sum += weight * (error.norm_squared() + slope);
            }
            Norm::Max => {
                let distance = error.norm();
                if distance > self.sum || distance.is_nan() {
                    (self.sum, self.place) = (distance, s);
                }
            }
        }
    }
}

/// Arc lengths from `start`, inside the piece from `start` to `end`, at which the chain is less
/// smooth: its breaks and, on a closed chain, its seam.
pub(crate) fn breaks_within(chain: &Chain, start: f64, end: f64, out: &mut Vec<f64>) {
    out.clear();
    let closed = chain.ends.is_none();
    // A span over the seam holds breaks of the next turn too.
    let turns = if closed { 0..=1 } else { 0..=0 };
    for turn in turns {
        let offset = turn as f64 * chain.length;
        if closed && offset > start && offset < end {
            out.push(offset - start);
        }
        let first = chain.breaks.partition_point(|b| b + offset <= start);
        out.extend(
            chain.breaks[first..].iter().map(|b| b + offset).take_while(|b| *b < end).map(|b| b - start),
        );
    }
}
