//! Border vertices blown up to arcs: their angle, number of quads, and the cross on each spoke.

use crate::base_mesh::Triangulation;
use crate::domain::{Boundary, Place};
use crate::error::{Error, Result};
use crate::numerics::tolerances::{CORNER_TIE, TIP_ANGLE, TIP_DOUBT};
use crate::numerics::{cross, NONE};
use std::f64::consts::FRAC_PI_2;

/// Number of quads the field puts at a corner of interior angle `angle` (Table 1, ties downwards), 1 to
/// 4; 0 below 45°.
pub fn quads_at_corner(angle: f64) -> u8 {
    let quarters = angle / FRAC_PI_2;
    if quarters < TIP_ANGLE / FRAC_PI_2 - CORNER_TIE {
        return 0;
    }
    (quarters - 0.5 - CORNER_TIE).ceil().clamp(1.0, 4.0) as u8
}

/// How many quads corners between about 32° and 45° get, which the field likes none and one alike.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Tips {
    /// None, but one where that saves a five-valent singularity.
    #[default]
    Balanced,
    /// One: for a second try, when lines ran into a tip.
    OneQuad,
    /// One at sharper tips too: when a five-valent singularity sits right before a tip without a quad, the two
    /// together are a tip with one.
    AllOneQuad,
}

/// The border polygon as the field sees it.
pub(super) struct Border {
    /// Interior angle at border vertices, else 0.
    pub angle: Vec<f64>,
    /// Quads at border vertices, else 0.
    pub quads: Vec<u8>,
    /// Direction of the outgoing border edge at border vertices, else 0.
    pub direction: Vec<f64>,
    /// Lengths of the outgoing and the incoming border edge at border vertices, else 0.
    lengths: Vec<[f64; 2]>,
    /// Border vertices where two segments meet.
    corner: Vec<bool>,
    /// For each triangle and corner at a border vertex the polar angles at which its wedge starts
    /// (on the triangle's edge that leaves the corner) and ends.
    pub wedges: Vec<[[f64; 2]; 3]>,
}

impl Border {
    pub fn new(mesh: &Triangulation, boundary: &Boundary, tips: Tips) -> Result<Border> {
        let n = mesh.vertices.len();
        let mut border = Border {
            angle: vec![0.0; n],
            quads: vec![0; n],
            direction: vec![0.0; n],
            lengths: vec![[0.0; 2]; n],
            corner: vec![false; n],
            wedges: vec![[[0.0; 2]; 3]; mesh.triangles.len()],
        };
        for (t, corners) in mesh.triangles.iter().enumerate() {
            for i in (0..3).filter(|&i| mesh.neighbors[t][i] == NONE) {
                let v = corners[i];
                border.quads[v as usize] = match mesh.vertices[v as usize].place {
                    Place::Junction(j) => quads_at_corner(boundary.junctions[j as usize].angle),
                    _ => 2,
                };
                border.corner[v as usize] = matches!(mesh.vertices[v as usize].place, Place::Junction(_));
                border.turn_about(mesh, t, i)?;
            }
        }
        border.raise_tips(mesh, boundary, tips);
        Ok(border)
    }

    /// Near 45° none and one quad cost the field the same. Where the corners ask for more five-valent
    /// singularities than three-valent ones a tip's missing quad would bring another: it gets its one,
    /// the widest tips first.
    fn raise_tips(&mut self, mesh: &Triangulation, boundary: &Boundary, rule: Tips) {
        let euler = 2 - boundary.loops.len() as i64;
        let corners: i64 = mesh.loops.iter().flatten().map(|&v| 2 - i64::from(self.quads[v as usize])).sum();
        let mut tips: Vec<(f64, u32)> = (mesh.loops.iter().flatten())
            .filter(|&&v| self.quads[v as usize] == 0)
            .filter_map(|&v| match mesh.vertices[v as usize].place {
                Place::Junction(j) => Some((boundary.junctions[j as usize].angle, v)),
                _ => None,
            })
            .filter(|tip| tip.0 > TIP_DOUBT[0] || rule == Tips::AllOneQuad)
            .collect();
        tips.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let missing = match rule {
            Tips::Balanced => (corners - 4 * euler).max(0) as usize,
            Tips::OneQuad | Tips::AllOneQuad => tips.len(),
        };
        for (_, v) in tips.into_iter().take(missing) {
            self.quads[v as usize] = 1;
        }
    }

    /// Walks counter-clockwise about the vertex at corner `i` of triangle `t`, whose outgoing border edge
    /// is that corner's edge.
    fn turn_about(&mut self, mesh: &Triangulation, t: usize, i: usize) -> Result<()> {
        let v = mesh.triangles[t][i] as usize;
        let at = mesh.vertices[v].point;
        let (mut t, mut i) = (t, i);
        let mut phi = 0.0;
        for _ in 0..mesh.triangles.len() {
            let [a, b] =
                [(i + 1) % 3, (i + 2) % 3].map(|k| mesh.vertices[mesh.triangles[t][k] as usize].point - at);
            if phi == 0.0 {
                self.direction[v] = a.y.atan2(a.x);
                self.lengths[v][0] = a.norm();
            }
            let end = phi + cross(a, b).atan2(a.dot(&b));
            self.wedges[t][i] = [phi, end];
            phi = end;
            match mesh.neighbors[t][(i + 2) % 3] {
                NONE => {
                    self.angle[v] = phi;
                    self.lengths[v][1] = b.norm();
                    return Ok(());
                }
                next => {
                    t = next as usize;
                    i = mesh.triangles[t].iter().position(|&w| w as usize == v).unwrap_or(i);
                }
            }
        }
        Err(Error::CrossField {
            reason: "the triangles about a border vertex do not end".into(),
            at: Some(at),
        })
    }

    /// Whether `v` is a border vertex.
    pub fn holds(&self, v: u32) -> bool {
        self.angle[v as usize] > 0.0
    }

    /// How much the cross turns with the polar angle at border vertex `v`.
    fn rate(&self, v: usize) -> f64 {
        1.0 - f64::from(self.quads[v]) * FRAC_PI_2 / self.angle[v]
    }

    /// The cross on the ray at polar angle `phi` of border vertex `v`.
    pub fn cross_at(&self, v: u32, phi: f64) -> f64 {
        self.direction[v as usize] + phi * self.rate(v as usize)
    }

    /// How much the cross turns across a wedge of border vertex `v`, from its end to its start.
    pub fn sweep(&self, v: u32, wedge: [f64; 2]) -> f64 {
        (wedge[0] - wedge[1]) * self.rate(v as usize)
    }

    fn u_at(&self, v: u32, share: f64) -> [f64; 2] {
        let four = 4.0 * self.cross_at(v, share * self.angle[v as usize]);
        [four.cos(), four.sin()]
    }

    /// u at border vertex `v`, of length 1: that of the curve's tangent where smooth, that in the middle of
    /// the arc at corners.
    pub fn middle(&self, v: u32) -> [f64; 2] {
        let [leaving, arriving] = self.lengths[v as usize];
        // Of two chords the shorter is closer to the tangent, in proportion.
        let share = if self.corner[v as usize] { 0.5 } else { leaving / (leaving + arriving) };
        self.u_at(v, share)
    }

    /// The value of the harmonic u at border vertex `v`. At a corner, where u jumps from one side's value to
    /// the other's, it is such that linear interpolation along the two edges has the jump's mean: any other
    /// value shifts zeros of u by as much as an edge is long.
    pub fn mean(&self, v: u32) -> [f64; 2] {
        if !self.corner[v as usize] {
            return self.middle(v);
        }
        let [leaving, arriving] = self.lengths[v as usize];
        let [a, b] = [0.0, 1.0].map(|share| self.u_at(v, share));
        [0, 1].map(|k| (leaving * a[k] + arriving * b[k]) / (leaving + arriving))
    }
}

/// `x` modulo π/2, in [−π/4, π/4].
pub(super) fn wrap_quarter(x: f64) -> f64 {
    x - (x / FRAC_PI_2).round() * FRAC_PI_2
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn table_1_with_ties_downwards() {
        let degrees = [
            (1.0, 0),
            (44.9, 0),
            (45.0, 1),
            (90.0, 1),
            (135.0, 1),
            (135.1, 2),
            (180.0, 2),
            (225.0, 2),
            (226.0, 3),
            (270.0, 3),
            (315.0, 3),
            (316.0, 4),
            (360.0, 4),
        ];
        for (angle, quads) in degrees {
            for noise in [-1e-9, 1e-9] {
                assert_eq!(quads_at_corner(angle * PI / 180.0 + noise), quads, "{angle}°");
            }
        }
    }
}
