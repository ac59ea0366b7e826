//! Which triangle holds a point.

use super::Triangulation;
use crate::numerics::{cross, Point, NONE};

impl Triangulation {
    /// The triangle that holds `point`, borders included, found by a walk from triangle `hint` and, if
    /// that runs into the border, by looking at all triangles; `None` outside.
    pub fn locate(&self, point: Point, hint: u32) -> Option<u32> {
        let mut t = if (hint as usize) < self.triangles.len() { hint } else { 0 };
        // In a Delaunay triangulation the walk ends; the bound guards against rounding.
        for _ in 0..self.triangles.len() {
            match self.exit_towards(t, point) {
                None => return Some(t),
                Some(i) if self.neighbors[t as usize][i] != NONE => t = self.neighbors[t as usize][i],
                Some(_) => break,
            }
        }
        (0..self.triangles.len() as u32).find(|&t| self.exit_towards(t, point).is_none())
    }

    /// The edge of triangle `t` that has `point` farthest outside; `None` if it is inside.
    fn exit_towards(&self, t: u32, point: Point) -> Option<usize> {
        let corners = self.triangles.get(t as usize)?.map(|v| self.vertices[v as usize].point);
        let height = |i: usize| {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            cross(b - a, point - a) / (b - a).norm()
        };
        let (i, h) = (0..3).map(|i| (i, height(i))).min_by(|a, b| a.1.total_cmp(&b.1))?;
        (h < 0.0).then_some(i)
    }
}
