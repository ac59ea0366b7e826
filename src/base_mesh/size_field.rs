//! A size field read off the base mesh: it already knows curvature, gaps and grading.

use super::Triangulation;
use crate::numerics::Point;

/// Local size anywhere in the plane: that of the nearest base vertex (a k-d tree).
#[derive(Debug, Clone)]
pub struct SizeField {
    /// (point, size), arranged as an implicit balanced tree.
    nodes: Vec<(Point, f64)>,
}

impl SizeField {
    /// The mean length of the edges at each base vertex, as its size.
    pub fn new(mesh: &Triangulation) -> Self {
        let mut sum = vec![(0.0, 0.0); mesh.vertices.len()];
        for t in &mesh.triangles {
            for i in 0..3 {
                let (a, b) = (t[i] as usize, t[(i + 1) % 3] as usize);
                let length = (mesh.vertices[a].point - mesh.vertices[b].point).norm();
                for v in [a, b] {
                    sum[v].0 += length;
                    sum[v].1 += 1.0;
                }
            }
        }
        let mut nodes: Vec<(Point, f64)> = mesh
            .vertices
            .iter()
            .zip(&sum)
            .filter(|(_, s)| s.1 > 0.0)
            .map(|(v, s)| (v.point, s.0 / s.1))
            .collect();
        arrange(&mut nodes, 0);
        SizeField { nodes }
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
