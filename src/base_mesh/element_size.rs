//! How large elements should be before coarsening, anywhere in the domain.
//!
//! At the boundary an element may turn with the curve by about a radian, and reach from junction to
//! junction; inwards the size grows with the distance, along the base mesh's edges. The base mesh
//! knows the gaps: an element is at most so many base edges long.

use super::Triangulation;
use crate::domain::{Boundary, Place};
use crate::numerics::Point;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Most that a boundary edge should turn, in radians, while it is not yet coarsened.
const EDGE_TURN: f64 = 0.9;
/// Size of an element at a chain that is one edge, relative to the chain's length.
const CHAIN_SHARE: f64 = 1.0;
/// Growth of the size with the distance from the boundary.
const GROWTH: f64 = 0.5;
/// Largest size, relative to the square root of the domain's area.
const LARGEST: f64 = 0.28;
/// Longest element in base edges: bounds the aspect ratio in gaps.
const MOST_BASE_EDGES: f64 = 16.0;
/// Shortest element in base edges, where the boundary turns sharply.
const LEAST_BASE_EDGES: f64 = 2.0;

/// Local size anywhere in the plane: that of the nearest base vertex (a k-d tree).
#[derive(Debug, Clone)]
pub struct ElementSize {
    /// (point, size), arranged as an implicit balanced tree.
    nodes: Vec<(Point, f64)>,
}

impl ElementSize {
    /// Sizes for the domain of `boundary` on its base mesh, in the canonical frame; none above `most`.
    pub fn new(mesh: &Triangulation, boundary: &Boundary, most: f64) -> Self {
        let largest = (LARGEST * boundary.area.max(0.0).sqrt()).min(most);
        let n = mesh.vertices.len();
        let mut edges = vec![(0.0f64, 0.0f64); n];
        let mut neighbors: Vec<Vec<(u32, f64)>> = vec![Vec::new(); n];
        for t in &mesh.triangles {
            for i in 0..3 {
                let (a, b) = (t[i] as usize, t[(i + 1) % 3] as usize);
                let length = (mesh.vertices[a].point - mesh.vertices[b].point).norm();
                for (v, w) in [(a, b), (b, a)] {
                    edges[v].0 += length;
                    edges[v].1 += 1.0;
                    neighbors[v].push((w as u32, length));
                }
            }
        }
        // Non-negative numbers order as their bits do.
        let mut size = vec![f64::INFINITY; n];
        let mut queue = BinaryHeap::new();
        for (v, vertex) in mesh.vertices.iter().enumerate() {
            let chains = match vertex.place {
                Place::Interior => continue,
                Place::Boundary(p) => [(p.chain, p.s), (p.chain, p.s)],
                Place::Junction(j) => {
                    let junction = &boundary.junctions[j as usize];
                    let end = boundary.chains[junction.chain_in as usize].length;
                    [(junction.chain_in, end), (junction.chain_out, 0.0)]
                }
            };
            for (c, s) in chains {
                let chain = &boundary.chains[c as usize];
                let turn = EDGE_TURN / chain.curvature(s).abs().max(f64::MIN_POSITIVE);
                let base = edges[v].0 / edges[v].1.max(1.0);
                size[v] = size[v].min(turn.max(LEAST_BASE_EDGES * base).min(CHAIN_SHARE * chain.length));
            }
            size[v] = size[v].min(largest);
            queue.push(Reverse((size[v].to_bits(), v as u32)));
        }
        while let Some(Reverse((bits, v))) = queue.pop() {
            if f64::from_bits(bits) > size[v as usize] {
                continue;
            }
            for &(w, length) in &neighbors[v as usize] {
                let grown = (size[v as usize] + GROWTH * length).min(largest);
                if grown < size[w as usize] {
                    size[w as usize] = grown;
                    queue.push(Reverse((grown.to_bits(), w)));
                }
            }
        }
        let mut nodes: Vec<(Point, f64)> = (mesh.vertices.iter().zip(&size).zip(&edges))
            .filter(|(_, e)| e.1 > 0.0)
            .map(|((v, s), e)| (v.point, s.min(MOST_BASE_EDGES * e.0 / e.1)))
            .collect();
        arrange(&mut nodes, 0);
        ElementSize { nodes }
    }

    /// The size at `p`.
    pub fn at(&self, p: Point) -> f64 {
        let mut best = (f64::INFINITY, 1.0);
        nearest(&self.nodes, p, 0, &mut best);
        best.1
    }
}

fn coordinate(p: Point, axis: usize) -> f64 {
    if axis == 0 {
        p.x
    } else {
        p.y
    }
}

/// Puts the median of alternating coordinates in the middle of every part.
fn arrange(nodes: &mut [(Point, f64)], axis: usize) {
    if nodes.len() < 2 {
        return;
    }
    let middle = nodes.len() / 2;
    nodes.select_nth_unstable_by(middle, |a, b| {
        coordinate(a.0, axis)
            .total_cmp(&coordinate(b.0, axis))
            .then(coordinate(a.0, 1 - axis).total_cmp(&coordinate(b.0, 1 - axis)))
    });
    let (low, high) = nodes.split_at_mut(middle);
    arrange(low, 1 - axis);
    arrange(&mut high[1..], 1 - axis);
}

/// Depth is the logarithm of the number of nodes.
fn nearest(nodes: &[(Point, f64)], p: Point, axis: usize, best: &mut (f64, f64)) {
    if nodes.is_empty() {
        return;
    }
    let middle = nodes.len() / 2;
    let (q, size) = nodes[middle];
    let d = (p - q).norm_squared();
    if d < best.0 {
        *best = (d, size);
    }
    let offset = coordinate(p, axis) - coordinate(q, axis);
    let (low, high) = (&nodes[..middle], &nodes[middle + 1..]);
    let (near, far) = if offset < 0.0 { (low, high) } else { (high, low) };
    nearest(near, p, 1 - axis, best);
    if offset * offset < best.0 {
        nearest(far, p, 1 - axis, best);
    }
}
