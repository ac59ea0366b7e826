//! What the base mesh does not resolve.

use super::Singularity;
use crate::base_mesh::{doubtful_corners, Triangulation};
use crate::cross_field::CrossField;
use crate::domain::Boundary;
use crate::numerics::tolerances::{BORDER_EDGE_TURN, LIKE_SIGN_EDGES};
use crate::numerics::{Point, NONE};

/// Checks that the base mesh resolves the field: `Err` lists places with the edge length wanted there.
///
/// Asked for are smaller triangles where the cross winds more than once around one, where two
/// singularities of equal sign are closer than two edges, and where the cross turns so much along an edge
/// at the border that its sense is doubtful. No length below `least` is asked for; places that are as fine
/// already count as resolved, except for windings beyond ±1.
pub fn gate(
    mesh: &Triangulation,
    boundary: &Boundary,
    field: &CrossField,
    singularities: &[Singularity],
    least: f64,
) -> Result<(), Vec<(Point, f64)>> {
    let corners = |t: usize| mesh.triangles[t].map(|v| mesh.vertices[v as usize].point);
    let center = |t: usize| {
        let [a, b, c] = corners(t);
        Point::from((a.coords + b.coords + c.coords) / 3.0)
    };
    let longest = |t: usize| {
        let [a, b, c] = corners(t);
        (b - a).norm().max((c - b).norm()).max((a - c).norm())
    };
    let mut wanted = Vec::new();
    let mut refine = |at: Point, h: f64, always: bool| {
        if always || h > least {
            wanted.push((at, h));
        }
    };

    // At doubtful corners the turn is known, however large.
    let known = doubtful_corners(boundary);
    let mut border = vec![false; mesh.vertices.len()];
    mesh.loops.iter().flatten().for_each(|&v| border[v as usize] = true);
    for (t, own) in field.triangles.iter().enumerate() {
        if own.winding.abs() > 1 {
            refine(center(t), 0.5 * longest(t), true);
        }
        // The edges at a singularity have to turn.
        let near = mesh.neighbors[t].iter().any(|&n| n != NONE && field.triangles[n as usize].winding != 0);
        if own.winding != 0 || near {
            continue;
        }
        let doubtful = |i: usize| {
            let ends = [mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]];
            own.edge_turn[i].abs() > BORDER_EDGE_TURN && ends.iter().any(|&v| border[v as usize])
        };
        let at = center(t);
        if (0..3).any(doubtful) && !known.iter().any(|&(q, reach)| (at - q).norm() < reach) {
            refine(at, 0.5 * longest(t), false);
        }
    }

    // Sorted by x, so that only neighbours are compared.
    let mut order: Vec<usize> = (0..singularities.len()).collect();
    order.sort_by(|&a, &b| singularities[a].point.x.total_cmp(&singularities[b].point.x));
    let size = |s: &Singularity| longest(s.triangle as usize);
    let reach = LIKE_SIGN_EDGES * singularities.iter().map(size).fold(0.0, f64::max);
    for (k, &i) in order.iter().enumerate() {
        let a = &singularities[i];
        for &j in &order[k + 1..] {
            let b = &singularities[j];
            if b.point.x - a.point.x > reach {
                break;
            }
            let (distance, h) = ((b.point - a.point).norm(), size(a).max(size(b)));
            if a.valence == b.valence && distance < LIKE_SIGN_EDGES * h {
                // Four edges between them afterwards, at most halved.
                refine(nalgebra::center(&a.point, &b.point), (0.25 * distance).max(0.5 * h), false);
            }
        }
    }
    match wanted.is_empty() {
        true => Ok(()),
        false => Err(wanted),
    }
}
