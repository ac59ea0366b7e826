//! The cross around the border of every triangle, lifted to the real line.

use super::border::{wrap_quarter, Border};
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
    u: &[[f64; 2]],
) -> Result<Vec<TriangleCross>> {
    (0..mesh.triangles.len()).map(|t| triangle_cross(mesh, border, u, t)).collect()
}

/// The cross at both ends of edge `i` of triangle `t`.
fn ends(mesh: &Triangulation, border: &Border, u: &[[f64; 2]], t: usize, i: usize) -> [f64; 2] {
    [(i, 0), ((i + 1) % 3, 1)].map(|(corner, side)| {
        let v = mesh.triangles[t][corner];
        match border.holds(v) {
            true => border.cross_at(v, border.wedges[t][corner][side]),
            false => 0.25 * u[v as usize][1].atan2(u[v as usize][0]),
        }
    })
}

/// The border vertex of `t` between two border edges, if there is exactly one.
fn ear(mesh: &Triangulation, t: usize) -> Option<usize> {
    let mut tips = (0..3).filter(|&i| mesh.neighbors[t][i] == NONE && mesh.neighbors[t][(i + 2) % 3] == NONE);
    tips.next().filter(|_| tips.next().is_none())
}

/// How much the cross turns along edge `i` of `t`; exactly the opposite in the neighbour.
fn edge_turn(mesh: &Triangulation, border: &Border, u: &[[f64; 2]], t: usize, i: usize) -> f64 {
    let other = mesh.neighbors[t][i];
    if other == NONE {
        return 0.0;
    }
    let other = other as usize;
    let across = |t: usize, i: usize| ear(mesh, t).is_some_and(|tip| (tip + 1) % 3 == i);
    let j = (0..3).find(|&j| mesh.neighbors[other][j] as usize == t).unwrap_or(0);
    // Across a corner that is cut off by one triangle the cross turns as in the corner itself: at angles
    // near 45° the shortest turn would be a tie that puts a singularity into the ear.
    match (across(t, i), across(other, j)) {
        (true, false) => -corner_turns(mesh, border, t).iter().sum::<f64>(),
        (false, true) => corner_turns(mesh, border, other).iter().sum::<f64>(),
        _ => {
            // The tie at 45° must fall the same way from both sides: ask it in one direction only.
            let [a, b] = ends(mesh, border, u, t, i);
            match mesh.triangles[t][i] < mesh.triangles[t][(i + 1) % 3] {
                true => wrap_quarter(b - a),
                false => -wrap_quarter(a - b),
            }
        }
    }
}

fn corner_turns(mesh: &Triangulation, border: &Border, t: usize) -> [f64; 3] {
    std::array::from_fn(|i| {
        let v = mesh.triangles[t][i];
        if border.holds(v) {
            border.sweep(v, border.wedges[t][i])
        } else {
            0.0
        }
    })
}

fn triangle_cross(mesh: &Triangulation, border: &Border, u: &[[f64; 2]], t: usize) -> Result<TriangleCross> {
    let edge_turn: [f64; 3] = std::array::from_fn(|i| edge_turn(mesh, border, u, t, i));
    let corner_turn = corner_turns(mesh, border, t);
    let sum = edge_turn.iter().chain(&corner_turn).sum::<f64>();
    let winding = (sum / FRAC_PI_2).round();
    if !((sum - winding * FRAC_PI_2).abs() < WINDING_ROUNDING) {
        let p = mesh.triangles[t].map(|v| mesh.vertices[v as usize].point);
        let at = Point::from((p[0].coords + p[1].coords + p[2].coords) / 3.0);
        let reason = format!("the cross turns by {sum} around a triangle");
        return Err(Error::CrossField { reason, at: Some(at) });
    }
    let start = ends(mesh, border, u, t, 0)[0];
    Ok(TriangleCross { start, edge_turn, corner_turn, winding: winding as i32 })
}
