//! The invariants of a [`CrossField`].

use super::CrossField;
use crate::base_mesh::Triangulation;
use crate::numerics::tolerances::WINDING_ROUNDING;
use crate::numerics::{Point, NONE};
use std::f64::consts::FRAC_PI_2;

impl CrossField {
    /// Checks on `mesh` that the cross is tangent to border edges, neighbours see the same cross on
    /// their edge, turns add up to the windings, and the windings obey the index theorem
    /// Σ winding = 4χ − Σ (2 − quads) over the border. `Err`: the defect in words and where it is.
    pub fn check(&self, mesh: &Triangulation) -> Result<(), (String, Point)> {
        let off_quarter = |x: f64| (x - (x / FRAC_PI_2).round() * FRAC_PI_2).abs() > WINDING_ROUNDING;
        let mut total = 0;
        for (t, own) in self.triangles.iter().enumerate() {
            let corners = mesh.triangles[t].map(|v| mesh.vertices[v as usize].point);
            let sum: f64 = own.edge_turn.iter().chain(&own.corner_turn).sum();
            if (sum - f64::from(own.winding) * FRAC_PI_2).abs() > WINDING_ROUNDING {
                return Err((format!("the turns of triangle {t} add up to {sum}"), corners[0]));
            }
            total += i64::from(own.winding);
            for i in 0..3 {
                let (a, b) = (corners[i], corners[(i + 1) % 3]);
                let other = mesh.neighbors[t][i];
                if other == NONE {
                    let direction = (b - a).y.atan2((b - a).x);
                    if own.edge_turn[i] != 0.0 || off_quarter(own.start_of_edge(i) - direction) {
                        return Err((
                            format!("the cross is not tangent to border edge {i} of triangle {t}"),
                            a,
                        ));
                    }
                    continue;
                }
                let theirs = &self.triangles[other as usize];
                let Some(j) = (0..3).find(|&j| mesh.neighbors[other as usize][j] == t as u32) else {
                    return Err((format!("triangles {t} and {other} are not mutual neighbours"), a));
                };
                if own.edge_turn[i] != -theirs.edge_turn[j] {
                    return Err((format!("triangles {t} and {other} turn differently along their edge"), a));
                }
                if off_quarter(own.start_of_edge(i) - theirs.start_of_edge(j) - theirs.edge_turn[j]) {
                    return Err((format!("triangles {t} and {other} see different crosses"), a));
                }
            }
        }
        let euler = 2 - mesh.loops.len() as i64;
        let missing: i64 =
            mesh.loops.iter().flatten().map(|&v| 2 - i64::from(self.quads_at[v as usize])).sum();
        if total != 4 * euler - missing {
            let start = mesh.vertices[0].point;
            return Err((
                format!("index theorem: windings {total}, expected {}", 4 * euler - missing),
                start,
            ));
        }
        Ok(())
    }
}
