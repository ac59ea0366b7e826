//! Splitting a chord: every edge across it is halved, every quad along it becomes two.
//!
//! The paper's step 7 divides boundary edges; the mesh stays conforming because the division is carried
//! along the chord to its other end. New edges between the halves start straight or along
//! the middle of their quads; the optimiser gives them their shape.

use super::chords::{chord_through, side_of};
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::mesh::{QuadMesh, Vertex};
use crate::numerics::{Point, Vector};
use std::collections::HashMap;

/// Splits the chord through `edge` at share `share` (in (0, 1), of each rung from the chord's side
/// on which the edge's first vertex lies). The new mesh keeps the numbers of old vertices; `None` if the
/// chord crosses itself (split another one first) or has no interior to split.
pub fn split_chord(boundary: &Boundary, mesh: &QuadMesh, edge: u32, share: f64) -> Option<QuadMesh> {
    let chord = chord_through(mesh, edge);
    let mut of_quad: HashMap<u32, u32> = HashMap::new();
    for (k, q) in chord.quads.iter().enumerate() {
        if of_quad.insert(*q, k as u32).is_some() {
            return None;
        }
    }
    // Which end of each rung is on the side of `edge`'s first vertex: carried along from quad to quad.
    let from = chord.rungs.iter().position(|e| *e == edge)?;
    let mut first = vec![0u32; chord.rungs.len()];
    first[from] = mesh.edges[edge as usize].vertices[0];
    let carry = |k: usize, next: usize, quad: u32, first: &mut [u32]| {
        let (i, corners) = (side_of(mesh, quad, chord.rungs[k]), mesh.quads[quad as usize]);
        // Side i runs from corner i to i + 1; the opposite one from i + 3 to i + 2 on the same sides.
        first[next] = if corners[i] == first[k] { corners[(i + 3) % 4] } else { corners[(i + 2) % 4] };
    };
    for k in from..chord.rungs.len() - 1 {
        carry(k, k + 1, chord.quads[k], &mut first);
    }
    for k in (0..from).rev() {
        carry(k + 1, k, chord.quads[k], &mut first);
    }
    let mut vertices = mesh.vertices.clone();
    let mut middle: HashMap<u32, u32> = HashMap::new();
    let mut shapes: HashMap<[u32; 2], Vec<Vector>> = HashMap::with_capacity(mesh.edges.len());
    for e in mesh.edges.iter().filter(|e| e.span.is_none()) {
        shapes.insert(e.vertices, e.bubbles.clone());
    }
    for (rung, first) in chord.rungs.iter().zip(&first) {
        let own = &mesh.edges[*rung as usize];
        let t = if own.vertices[0] == *first { share } else { 1.0 - share };
        let new = vertices.len() as u32;
        middle.insert(*rung, new);
        if let Some(span) = own.span {
            let curve = &boundary.chains[span.chain as usize];
            let s = curve.wrap(span.start + t * (span.end - span.start));
            let place = Place::Boundary(BoundaryPoint { chain: span.chain, s });
            vertices.push(Vertex { point: curve.point(s), place });
        } else {
            let ends = own.vertices.map(|v| mesh.vertices[v as usize].point.coords);
            vertices.push(Vertex {
                point: Point::from(curve_point(ends, &own.bubbles, t)),
                place: Place::Interior,
            });
            shapes.insert([own.vertices[0], new], part(&own.bubbles, 0.0, t));
            shapes.insert([new, own.vertices[1]], part(&own.bubbles, t, 1.0));
        }
    }
    let (mut quads, mut region) = (mesh.quads.clone(), mesh.region.clone());
    for (k, q) in chord.quads.iter().enumerate() {
        let (a, b) = (chord.rungs[k], chord.rungs[(k + 1) % chord.rungs.len()]);
        let i = side_of(mesh, *q, a);
        let c = mesh.quads[*q as usize];
        let (m, n) = (middle[&a], middle[&b]);
        quads[*q as usize] = [c[i], m, n, c[(i + 3) % 4]];
        quads.push([m, c[(i + 1) % 4], c[(i + 2) % 4], n]);
        region.push(mesh.region[*q as usize]);
        // The new edge bends as the two sides along the chord do, on average.
        let toward = |side: usize, start: u32| {
            let own = &mesh.edges[mesh.quad_edges[*q as usize][side] as usize];
            let flip = own.vertices[0] != start;
            let sign = |m: usize| if flip && m % 2 == 1 { -1.0 } else { 1.0 };
            own.bubbles.iter().enumerate().map(|(m, c)| c * sign(m)).collect::<Vec<_>>()
        };
        let (left, right) = (toward((i + 1) % 4, c[(i + 1) % 4]), toward((i + 3) % 4, c[i]));
        let at = |list: &[Vector], m: usize| list.get(m).copied().unwrap_or_else(Vector::zeros);
        let mean = (0..left.len().max(right.len())).map(|m| (at(&left, m) + at(&right, m)) * 0.5).collect();
        shapes.insert([m, n], mean);
    }
    QuadMesh::new(boundary, vertices, quads, region, &shapes).ok()
}

/// Bubbles as a polynomial: coefficients in powers of τ of the offset from the straight edge.
fn powers(bubbles: &[Vector]) -> Vec<Vector> {
    let mut sum = vec![Vector::zeros(); bubbles.len() + 2];
    // Shifted Legendre polynomials P_m(2τ − 1) in powers of τ, by the three-term recurrence.
    let (mut p, mut before) = (vec![1.0], Vec::new());
    for (m, c) in bubbles.iter().enumerate() {
        for (k, a) in p.iter().enumerate() {
            sum[k + 1] += c * (4.0 * a);
            sum[k + 2] -= c * (4.0 * a);
        }
        let mf = m as f64;
        let mut next = vec![0.0; p.len() + 1];
        for (k, a) in p.iter().enumerate() {
            next[k + 1] += 2.0 * (2.0 * mf + 1.0) / (mf + 1.0) * a;
            next[k] -= (2.0 * mf + 1.0) / (mf + 1.0) * a;
        }
        for (k, a) in before.iter().enumerate() {
            next[k] -= mf / (mf + 1.0) * a;
        }
        before = std::mem::replace(&mut p, next);
    }
    sum
}

fn curve_point([a, b]: [Vector; 2], bubbles: &[Vector], t: f64) -> Vector {
    let offset = powers(bubbles).iter().rev().fold(Vector::zeros(), |sum, c| sum * t + c);
    a + (b - a) * t + offset
}

/// Bubbles of the part [from, to] of an edge with `bubbles`: exact, since the space of bubbles is that
/// of all polynomials that vanish at both ends.
fn part(bubbles: &[Vector], from: f64, to: f64) -> Vec<Vector> {
    let n = bubbles.len();
    if n == 0 {
        return Vec::new();
    }
    let p = powers(bubbles);
    let offset = |t: f64| p.iter().rev().fold(Vector::zeros(), |sum, c| sum * t + c);
    let (first, last) = (offset(from), offset(to));
    // Collocation at n inner points.
    let points: Vec<f64> =
        (0..n).map(|k| 0.5 - 0.5 * (std::f64::consts::PI * (k as f64 + 0.5) / n as f64).cos()).collect();
    let legendre = |m: usize, x: f64| crate::numerics::legendre(m, x).0;
    let matrix = nalgebra::DMatrix::from_fn(n, n, |k, m| {
        4.0 * points[k] * (1.0 - points[k]) * legendre(m, 2.0 * points[k] - 1.0)
    });
    let right = nalgebra::DMatrix::from_fn(n, 2, |k, axis| {
        let t = points[k];
        let straight = first[axis] * (1.0 - t) + last[axis] * t;
        offset(from + (to - from) * t)[axis] - straight
    });
    match matrix.lu().solve(&right) {
        Some(x) => (0..n).map(|m| Vector::new(x[(m, 0)], x[(m, 1)])).collect(),
        None => Vec::new(),
    }
}
