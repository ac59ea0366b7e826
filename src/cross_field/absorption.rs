//! Corners near a tie of Table 1 that take up the singularity beside them.
//!
//! At about 135°, 225° or 315° one quad more or less costs the field the same. A five-valent singularity at such a
//! corner is a quad more there, a three-valent one a quad less; left as it is it has no room, and its separatrices
//! none to the corner's.

use super::border::Border;
use super::TriangleCross;
use crate::base_mesh::Triangulation;
use crate::domain::{Boundary, Place};
use crate::numerics::tolerances::{ABSORBING_ANGLES, ABSORBING_REACH, CORNER_DOUBT, CROWDED_SIDE};
use std::f64::consts::FRAC_PI_2;

/// Changes the number of quads at corners of `border` that take up a singularity: one that is close to the corner
/// for the domain's size there, and one in a triangle at a corner whose shorter side is no longer than a few such
/// triangles; with `in_triangles_too` at every corner, for a second try when lines found no way. Whether there was
/// one.
pub(super) fn absorb(
    mesh: &Triangulation,
    boundary: &Boundary,
    thickness: &[f64],
    triangles: &[TriangleCross],
    in_triangles_too: bool,
    border: &mut Border,
) -> bool {
    let doubtful = doubtful(mesh, boundary, thickness, border);
    let mut changed = Vec::new();
    for (t, own) in triangles.iter().enumerate().filter(|(_, own)| own.winding.abs() == 1) {
        let corners = mesh.triangles[t];
        let points = corners.map(|v| mesh.vertices[v as usize].point);
        let centre = nalgebra::center(&nalgebra::center(&points[0], &points[1]), &points[2]);
        let longest = (0..3).map(|i| (points[(i + 1) % 3] - points[i]).norm()).fold(0.0, f64::max);
        let nearest = doubtful
            .iter()
            .filter(|corner| corner.winding == own.winding)
            .map(|corner| (corner, (mesh.vertices[corner.vertex as usize].point - centre).norm()))
            .filter(|(corner, distance)| {
                let crowded = in_triangles_too || corner.side < CROWDED_SIDE * longest;
                *distance < corner.reach || crowded && corners.contains(&corner.vertex)
            })
            .min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((corner, _)) = nearest else { continue };
        if !changed.contains(&corner.vertex) {
            let quads = i32::from(border.quads[corner.vertex as usize]) - own.winding;
            border.quads[corner.vertex as usize] = quads as u8;
            changed.push(corner.vertex);
        }
    }
    !changed.is_empty()
}

/// A corner that may take up a singularity of this winding, at this distance or less.
struct Doubtful {
    vertex: u32,
    winding: i32,
    reach: f64,
    /// Length of the corner's shorter side.
    side: f64,
}

/// The corners near a tie: not those whose quads would get much worse angles.
fn doubtful(mesh: &Triangulation, boundary: &Boundary, thickness: &[f64], border: &Border) -> Vec<Doubtful> {
    let mut found = Vec::new();
    for &vertex in mesh.loops.iter().flatten() {
        let v = vertex as usize;
        let Place::Junction(j) = mesh.vertices[v].place else { continue };
        let junction = &boundary.junctions[j as usize];
        let sides = [junction.chain_in, junction.chain_out].map(|c| boundary.chains[c as usize].length);
        let side = sides[0].min(sides[1]);
        let reach = ABSORBING_REACH * thickness[v].min(side);
        let (angle, quads) = (border.angle[v], i32::from(border.quads[v]));
        for winding in [-1, 1] {
            let after = quads - winding;
            let tie = (f64::from(quads.max(after)) - 0.5) * FRAC_PI_2;
            let [least, most] = ABSORBING_ANGLES.map(|a| a * f64::from(after));
            if (1..=4).contains(&after)
                && (angle - tie).abs() < CORNER_DOUBT
                && least <= angle
                && angle <= most
            {
                found.push(Doubtful { vertex, winding, reach, side });
            }
        }
    }
    found
}
