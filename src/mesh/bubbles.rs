//! Shapes of edges as bubbles: evaluation, fitting, halves.
//!
//! An edge is its chord plus Σ c_m (1 − x²) P_m(x), x = 2τ − 1 in [-1, 1].

use super::QuadMesh;
use crate::domain::Boundary;
use crate::numerics::{legendre, GaussLegendre, Point, Vector};

/// What the bubbles add to the chord at `x` in [-1, 1].
pub fn bubble_shape(bubbles: &[Vector], x: f64) -> Vector {
    let sum: Vector = bubbles.iter().enumerate().map(|(m, c)| c * legendre(m, x).0).sum();
    sum * (1.0 - x * x)
}

/// The `count` bubbles that are nearest to `offset` from the chord, which vanishes at ±1: exact when it
/// is a polynomial of degree at most `count` + 1.
pub fn fit_bubbles(count: usize, offset: impl Fn(f64) -> Vector) -> Vec<Vector> {
    let rule = GaussLegendre::new(count + 1);
    let mut bubbles = vec![Vector::zeros(); count];
    for (x, weight) in rule.nodes.iter().zip(&rule.weights) {
        let value = offset(*x) * (weight / (1.0 - x * x));
        for (m, c) in bubbles.iter_mut().enumerate() {
            *c += value * (legendre(m, *x).0 * (m as f64 + 0.5));
        }
    }
    bubbles
}

/// Bubbles of the edge walked the other way: the bubble of degree m has the parity of m.
pub fn reversed_bubbles(bubbles: &[Vector]) -> Vec<Vector> {
    bubbles.iter().enumerate().map(|(m, c)| if m % 2 == 0 { *c } else { -*c }).collect()
}

/// Bubbles of the part of an edge from `a` to `b` in [-1, 1].
pub fn part_of_bubbles(bubbles: &[Vector], a: f64, b: f64) -> Vec<Vector> {
    let [start, end] = [a, b].map(|x| bubble_shape(bubbles, x));
    fit_bubbles(bubbles.len(), |x| {
        let share = 0.5 * (1.0 + x);
        bubble_shape(bubbles, a + (b - a) * share) - start * (1.0 - share) - end * share
    })
}

impl QuadMesh {
    /// The shape of edge `e`, from its first vertex to its second, as bubbles: its own, or for a
    /// boundary edge `count` of them fitted to the chain.
    pub fn shape(&self, boundary: &Boundary, e: usize, count: usize) -> Vec<Vector> {
        let edge = &self.edges[e];
        let Some(span) = edge.span else { return edge.bubbles.clone() };
        let chain = &boundary.chains[span.chain as usize];
        let [a, b] = edge.vertices.map(|v| self.vertices[v as usize].point);
        fit_bubbles(count, |x| {
            let share = 0.5 * (1.0 + x);
            chain.point(span.start + share * (span.end - span.start)) - (a + (b - a) * share)
        })
    }

    /// The point in the middle of edge `e` (of its arc on the boundary).
    pub fn edge_middle(&self, boundary: &Boundary, e: usize) -> Point {
        let edge = &self.edges[e];
        match edge.span {
            Some(span) => boundary.chains[span.chain as usize].point(0.5 * (span.start + span.end)),
            None => {
                let [a, b] = edge.vertices.map(|v| self.vertices[v as usize].point);
                nalgebra::center(&a, &b) + bubble_shape(&edge.bubbles, 0.0)
            }
        }
    }
}
