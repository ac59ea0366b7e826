//! Step 3 of the paper: singularities, inside and at corners.
//!
//! *In:* the [`CrossField`].
//! *Out:* interior [`Singularity`]s, with the directions of their separatrices, and the [`CornerFan`]s.
//! The index theorem 4χ = Σ (4 − valence) + Σ (2 − quads at the corner) is a hard gate.
//!
//! *Method:* a triangle around which the cross turns by a quarter is singular (Kowalski, Ledoux,
//! Frey 2013). Its separatrices leave where the cross points away from the singular point ([`ports`]).
//! What the base mesh does not resolve is found by [`gate`], which asks for smaller triangles there.

mod gate;
mod ports;
mod resolve;

pub use gate::gate;
pub use resolve::{resolve, Resolved};

use crate::base_mesh::Triangulation;
use crate::cross_field::CrossField;
use crate::domain::{Boundary, Place};
use crate::error::{Error, Result};
use crate::numerics::tolerances::{PORT_TURN, SINGULAR_BARYCENTRIC};
use crate::numerics::{cross, Point, Vector};
use std::f64::consts::PI;

/// An interior singularity: in triangle `triangle`, at `point`.
#[derive(Debug, Clone, PartialEq)]
pub struct Singularity {
    pub triangle: u32,
    pub point: Point,
    /// 3 or 5: the number of separatrices.
    pub valence: u8,
    /// Where each separatrix leaves the triangle: (edge, share of it from its start in (0, 1)),
    /// counter-clockwise; as many as the valence.
    pub ports: Vec<(u8, f64)>,
}

/// A corner of the border that is no smooth vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CornerFan {
    pub vertex: u32,
    /// The junction of the boundary.
    pub junction: u32,
    /// Interior angle in radians.
    pub angle: f64,
    /// Number of quads n that meet there (Table 1: n − 1 separatrices, at angles k θ / n);
    /// 0 below 45°: the region at the tip is a triangle, repaired by the paper's rule.
    pub quads: u8,
}

/// Finds all interior singularities of `field` and the corners of the border.
///
/// Corners are the junctions that turn by more than [`PORT_TURN`] or whose number of quads is not 2.
/// [`Error::CrossField`] with its place where a triangle's winding is beyond ±1 or the index theorem
/// fails: the base mesh is too coarse there ([`gate`] tells how fine it should be).
pub fn find(
    mesh: &Triangulation,
    boundary: &Boundary,
    field: &CrossField,
) -> Result<(Vec<Singularity>, Vec<CornerFan>)> {
    let mut singularities = Vec::new();
    for (t, own) in field.triangles.iter().enumerate().filter(|(_, own)| own.winding != 0) {
        let corners = mesh.triangles[t].map(|v| mesh.vertices[v as usize].point);
        if own.winding.abs() > 1 {
            let reason = format!("the cross winds {} times around a base triangle", own.winding);
            return Err(Error::CrossField { reason, at: Some(corners[0]) });
        }
        let valence = (4 - own.winding) as u8;
        let zero = zero(corners, mesh.triangles[t].map(|v| field.u[v as usize]));
        let (point, ports) = ports::ports(corners, own, zero, valence);
        singularities.push(Singularity { triangle: t as u32, point, valence, ports });
    }

    let mut corners = Vec::new();
    for &vertex in mesh.loops.iter().flatten() {
        let Place::Junction(junction) = mesh.vertices[vertex as usize].place else { continue };
        let (angle, quads) = (boundary.junctions[junction as usize].angle, field.quads_at[vertex as usize]);
        if quads != 2 || (angle - PI).abs() > PORT_TURN {
            corners.push(CornerFan { vertex, junction, angle, quads });
        }
    }
    check(mesh, &singularities, &corners)
        .map_err(|(reason, at)| Error::CrossField { reason, at: Some(at) })?;
    Ok((singularities, corners))
}

/// Checks the index theorem 4χ = Σ (4 − valence) + Σ (2 − quads) and that each singularity has as many
/// ports as its valence. `Err`: the defect in words and where it is.
pub fn check(
    mesh: &Triangulation,
    singularities: &[Singularity],
    corners: &[CornerFan],
) -> std::result::Result<(), (String, Point)> {
    for s in singularities {
        if s.ports.len() != s.valence as usize {
            return Err((
                format!("{} ports at a singularity of valence {}", s.ports.len(), s.valence),
                s.point,
            ));
        }
    }
    let inside: i64 = singularities.iter().map(|s| 4 - i64::from(s.valence)).sum();
    let border: i64 = corners.iter().map(|c| 2 - i64::from(c.quads)).sum();
    let euler = 2 - mesh.loops.len() as i64;
    if inside + border != 4 * euler {
        let at = singularities.first().map_or(mesh.vertices[0].point, |s| s.point);
        return Err((
            format!("index theorem: {inside} inside and {border} at corners for 4χ = {}", 4 * euler),
            at,
        ));
    }
    Ok(())
}

/// The zero of the linear u in a triangle, kept away from its sides.
fn zero(corners: [Point; 3], u: [[f64; 2]; 3]) -> Point {
    let [a, b, c] = u.map(|u| Vector::new(u[0], u[1]));
    let areas = [cross(b, c), cross(c, a), cross(a, b)];
    let total: f64 = areas.iter().sum();
    // At border vertices u is one value of many, so the zero may lie outside.
    let share = |x: f64| if total != 0.0 { (x / total).clamp(SINGULAR_BARYCENTRIC, 1.0) } else { 1.0 };
    let shares = areas.map(share);
    let sum: f64 = shares.iter().sum();
    Point::from(
        (corners[0].coords * shares[0] + corners[1].coords * shares[1] + corners[2].coords * shares[2]) / sum,
    )
}
