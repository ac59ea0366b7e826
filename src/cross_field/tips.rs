//! Corners near 45°, where the linear elements alone could not tell which way the cross turns.
//!
//! Between the walls of a corner of exactly 45° u runs from (1, 0) to (−1, 0): straight through 0, unless
//! something says on which side. So u is held on the corner's own solution near it.

use super::border::Border;
use crate::base_mesh::{doubtful_reach, Triangulation};
use crate::domain::{Boundary, Place};
use crate::numerics::{cross, NONE};

/// What a corner's own solution says of a vertex near it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Held {
    /// The corner.
    pub tip: u32,
    /// The cross at the vertex, lifted: differences between vertices of one corner are true turns.
    pub cross: f64,
}

/// For each vertex, border vertices included, what a doubtful corner near it says.
pub(super) fn held(mesh: &Triangulation, boundary: &Boundary, border: &Border) -> Vec<Option<Held>> {
    let mut held = vec![None; mesh.vertices.len()];
    let mut seen = vec![NONE; mesh.triangles.len()];
    for (t, corners) in mesh.triangles.iter().enumerate() {
        // Once for each corner: at the triangle on its outgoing border edge.
        for i in (0..3).filter(|&i| mesh.neighbors[t][i] == NONE) {
            let tip = corners[i];
            let Place::Junction(j) = mesh.vertices[tip as usize].place else { continue };
            let Some(reach) = doubtful_reach(boundary, j) else { continue };
            for v in vertices_near(mesh, boundary, (t, j, tip), reach, &mut seen) {
                let phi = polar_angle(mesh, boundary, border, (t, i), j, v);
                held[v as usize] = Some(Held { tip, cross: border.cross_at(tip, phi) });
            }
        }
    }
    held
}

/// The polar angle of vertex `v` about corner `i` of triangle `t`; 0 or the whole angle on its walls.
fn polar_angle(
    mesh: &Triangulation,
    boundary: &Boundary,
    border: &Border,
    (t, i): (usize, usize),
    j: u32,
    v: u32,
) -> f64 {
    let junction = &boundary.junctions[j as usize];
    let [tip, next] = [mesh.triangles[t][i], mesh.triangles[t][(i + 1) % 3]];
    let whole = border.angle[tip as usize];
    match mesh.vertices[v as usize].place {
        Place::Boundary(p) if p.chain == junction.chain_out => 0.0,
        Place::Boundary(_) => whole,
        _ => {
            let at = mesh.vertices[tip as usize].point;
            let [a, b] = [next, v].map(|v| mesh.vertices[v as usize].point - at);
            cross(a, b).atan2(a.dot(&b)).clamp(0.0, whole)
        }
    }
}

/// The vertices near corner `tip` (junction `j`, first triangle `t`): within its reach, and nearer
/// than half way to other parts of the boundary. Walks across triangles, so that what lies behind a wall
/// is not found.
fn vertices_near(
    mesh: &Triangulation,
    boundary: &Boundary,
    (t, j, tip): (usize, u32, u32),
    reach: f64,
    seen: &mut [u32],
) -> Vec<u32> {
    let junction = &boundary.junctions[j as usize];
    // A chain that is both walls of its corner has its middle beyond the reach.
    let walls = [junction.chain_in, junction.chain_out];
    let at = mesh.vertices[tip as usize].point;
    let distance = |v: u32| (mesh.vertices[v as usize].point - at).norm();
    let mut front = vec![t];
    seen[t] = tip;
    let mut found = Vec::new();
    let mut free = reach;
    while let Some(t) = front.pop() {
        for k in 0..3 {
            let v = mesh.triangles[t][k];
            match mesh.vertices[v as usize].place {
                Place::Interior => found.push(v),
                Place::Boundary(p) if walls.contains(&p.chain) => found.push(v),
                _ if v == tip => {}
                _ => free = free.min(0.5 * distance(v)),
            }
            let next = mesh.neighbors[t][k];
            let near = distance(v).min(distance(mesh.triangles[t][(k + 1) % 3])) < reach;
            if next != NONE && near && seen[next as usize] != tip {
                seen[next as usize] = tip;
                front.push(next as usize);
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    found.retain(|&v| distance(v) < free);
    found
}
