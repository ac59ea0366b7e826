//! Corners near a tie of Table 1 that take up the singularity beside them.
//!
//! At about 135°, 225° or 315° one quad more or less costs the field the same. A five-valent singularity in a
//! triangle at such a corner is a quad more there, a three-valent one a quad less; left as it is its separatrices
//! may find no way past the corner.

use super::border::Border;
use super::TriangleCross;
use crate::base_mesh::Triangulation;
use crate::domain::Place;
use crate::numerics::tolerances::{ABSORBING_ANGLES, CORNER_DOUBT};
use std::f64::consts::FRAC_PI_2;

/// Changes the number of quads at corners of `border` that take up a singularity. Whether there was one.
pub(super) fn absorb(mesh: &Triangulation, triangles: &[TriangleCross], border: &mut Border) -> bool {
    let mut changed = Vec::new();
    for (t, own) in triangles.iter().enumerate().filter(|(_, own)| own.winding.abs() == 1) {
        let corners = mesh.triangles[t].into_iter().filter_map(|v| {
            let junction = matches!(mesh.vertices[v as usize].place, Place::Junction(_));
            junction.then(|| off_tie(border, v, own.winding)).flatten().map(|off| (v, off))
        });
        let Some((v, _)) = corners.min_by(|a, b| a.1.total_cmp(&b.1)) else { continue };
        if !changed.contains(&v) {
            let quads = i32::from(border.quads[v as usize]) - own.winding;
            border.quads[v as usize] = quads as u8;
            changed.push(v);
        }
    }
    !changed.is_empty()
}

/// How far the angle of corner `v` is from the tie between its number of quads and that with a singularity of this
/// winding taken up; `None` if it is too far, or the quads' angles would be bad.
fn off_tie(border: &Border, v: u32, winding: i32) -> Option<f64> {
    let (angle, quads) = (border.angle[v as usize], i32::from(border.quads[v as usize]));
    let after = quads - winding;
    let off = (angle - (f64::from(quads.max(after)) - 0.5) * FRAC_PI_2).abs();
    let [least, most] = ABSORBING_ANGLES.map(|a| a * f64::from(after));
    ((1..=4).contains(&after) && off < CORNER_DOUBT && least <= angle && angle <= most).then_some(off)
}
