//! From the triangles inside to a [`Triangulation`]: border loops, places, numbering.

use super::sampling::Chord;
use super::{BaseVertex, Triangulation};
use crate::domain::{BoundaryPoint, Place};
use crate::error::{Error, Result};
use crate::numerics::{Point, NONE};

/// The triangles of the domain, with the triangulator's numbers of vertices.
pub(super) struct RawMesh {
    /// May hold points outside the domain.
    pub points: Vec<Point>,
    pub triangles: Vec<[u32; 3]>,
    pub neighbors: Vec<[u32; 3]>,
}

/// Numbers the vertices (border loops first, in order, then the inner ones) and gives each border
/// vertex its place. `starts` holds vertex and place of each chord's start.
pub(super) fn assemble(
    raw: &RawMesh,
    starts: &[Vec<(u32, Place)>],
    chords: &[Vec<Chord>],
) -> Result<Triangulation> {
    let fail = |reason: &str, v: u32| {
        Err(Error::BaseMesh { reason: reason.into(), at: raw.points.get(v as usize).copied() })
    };
    let mut next = vec![NONE; raw.points.len()];
    let mut border_edges = 0;
    for (corners, neighbors) in raw.triangles.iter().zip(&raw.neighbors) {
        for i in (0..3).filter(|&i| neighbors[i] == NONE) {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            if next[a as usize] != NONE {
                return fail("two border loops touch", a);
            }
            next[a as usize] = b;
            border_edges += 1;
        }
    }

    let mut number = vec![NONE; raw.points.len()];
    let mut vertices = Vec::with_capacity(raw.triangles.len() / 2 + border_edges);
    let mut loops = Vec::with_capacity(starts.len());
    for (starts, chords) in starts.iter().zip(chords) {
        let mut own = Vec::with_capacity(starts.len());
        for (i, &(from, place)) in starts.iter().enumerate() {
            let to = starts[(i + 1) % starts.len()].0;
            let (a, b) = (raw.points[from as usize], raw.points[to as usize]);
            let chord = &chords[i];
            let mut v = from;
            // Refinement has put the vertices between on the chord.
            while v != to || v == from {
                if v == NONE || number[v as usize] != NONE {
                    return fail("the border does not follow the boundary", from);
                }
                number[v as usize] = vertices.len() as u32;
                own.push(vertices.len() as u32);
                let point = raw.points[v as usize];
                let place = if v == from {
                    place
                } else {
                    let share = ((point - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
                    Place::Boundary(BoundaryPoint {
                        chain: chord.chain,
                        s: chord.start + share * chord.length(),
                    })
                };
                vertices.push(BaseVertex { point, place });
                v = next[v as usize];
            }
        }
        loops.push(own);
    }
    if vertices.len() != border_edges {
        return Err(Error::BaseMesh {
            reason: "the border has a part that is not of the boundary".into(),
            at: None,
        });
    }

    let mut triangles = raw.triangles.clone();
    for v in triangles.iter_mut().flatten() {
        let old = *v as usize;
        if number[old] == NONE {
            number[old] = vertices.len() as u32;
            vertices.push(BaseVertex { point: raw.points[old], place: Place::Interior });
        }
        *v = number[old];
    }
    Ok(Triangulation { vertices, triangles, neighbors: raw.neighbors.clone(), loops })
}
