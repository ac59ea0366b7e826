//! The cross around the border of every triangle, lifted to the real line.

use super::border::{wrap_quarter, Border};
use super::tips::Held;
use super::TriangleCross;
use crate::base_mesh::Triangulation;
use crate::error::{Error, Result};
use crate::numerics::tolerances::WINDING_ROUNDING;
use crate::numerics::{Point, NONE};
use std::f64::consts::FRAC_PI_2;

/// The cross around each triangle, from u at inner vertices and exactly from the polygon at the border.
pub(super) fn triangle_crosses(
    mesh: &Triangulation,
    border: &Border,
    held: &[Option<Held>],
    u: &[[f64; 2]],
) -> Result<Vec<TriangleCross>> {
    let view = View { mesh, border, held, u };
    (0..mesh.triangles.len()).map(|t| view.triangle_cross(t)).collect()
}

/// Everything the turns depend on.
struct View<'a> {
    mesh: &'a Triangulation,
    border: &'a Border,
    held: &'a [Option<Held>],
    u: &'a [[f64; 2]],
}

impl View<'_> {
    /// The cross at both ends of edge `i` of triangle `t`.
    fn ends(&self, t: usize, i: usize) -> [f64; 2] {
        [(i, 0), ((i + 1) % 3, 1)].map(|(corner, side)| {
            let v = self.mesh.triangles[t][corner];
            match self.border.holds(v) {
                true => self.border.cross_at(v, self.border.wedges[t][corner][side]),
                false => 0.25 * self.u[v as usize][1].atan2(self.u[v as usize][0]),
            }
        })
    }

    /// Whether edge `i` of `t` cuts off a single corner, whose two border edges are the others of `t`.
    fn cuts_corner(&self, t: usize, i: usize) -> bool {
        let at_border = |k: usize| self.mesh.neighbors[t][k % 3] == NONE;
        at_border(i + 1) && at_border(i + 2) && !at_border(i)
    }

    /// How much the cross should turn along edge `i` of `t` if it is known beforehand, else 0.
    ///
    /// At corners near 45° the shortest turn would be a tie that puts a pair of singularities there.
    fn expected_turn(&self, t: usize, i: usize) -> f64 {
        let ends = [self.mesh.triangles[t][i], self.mesh.triangles[t][(i + 1) % 3]];
        if let [Some(a), Some(b)] = ends.map(|v| self.held[v as usize]) {
            if a.tip == b.tip {
                return b.cross - a.cross;
            }
        }
        let other = self.mesh.neighbors[t][i] as usize;
        let j = (0..3).find(|&j| self.mesh.neighbors[other][j] as usize == t).unwrap_or(0);
        match (self.cuts_corner(t, i), self.cuts_corner(other, j)) {
            (true, false) => -self.corner_turns(t).iter().sum::<f64>(),
            (false, true) => self.corner_turns(other).iter().sum::<f64>(),
            _ => 0.0,
        }
    }

    /// How much the cross turns along edge `i` of `t`; exactly the opposite in the neighbour.
    fn edge_turn(&self, t: usize, i: usize) -> f64 {
        if self.mesh.neighbors[t][i] == NONE {
            return 0.0;
        }
        // The tie at 45° must fall the same way from both sides: ask it in one direction only.
        let [a, b] = self.ends(t, i);
        let expected = self.expected_turn(t, i);
        match self.mesh.triangles[t][i] < self.mesh.triangles[t][(i + 1) % 3] {
            true => expected + wrap_quarter(b - a - expected),
            false => -(-expected + wrap_quarter(a - b + expected)),
        }
    }

    fn corner_turns(&self, t: usize) -> [f64; 3] {
        std::array::from_fn(|i| {
            let v = self.mesh.triangles[t][i];
            match self.border.holds(v) {
                true => self.border.sweep(v, self.border.wedges[t][i]),
                false => 0.0,
            }
        })
    }

    fn triangle_cross(&self, t: usize) -> Result<TriangleCross> {
        let edge_turn: [f64; 3] = std::array::from_fn(|i| self.edge_turn(t, i));
        let corner_turn = self.corner_turns(t);
        let sum = edge_turn.iter().chain(&corner_turn).sum::<f64>();
        let winding = (sum / FRAC_PI_2).round();
        // A degenerate triangle gives NaN.
        if !sum.is_finite() || (sum - winding * FRAC_PI_2).abs() > WINDING_ROUNDING {
            let p = self.mesh.triangles[t].map(|v| self.mesh.vertices[v as usize].point);
            let at = Point::from((p[0].coords + p[1].coords + p[2].coords) / 3.0);
            let reason = format!("the cross turns by {sum} around a triangle");
            return Err(Error::CrossField { reason, at: Some(at) });
        }
        let start = self.ends(t, 0)[0];
        Ok(TriangleCross { start, edge_turn, corner_turn, winding: winding as i32 })
    }
}
