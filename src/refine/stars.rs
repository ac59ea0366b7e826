//! Which quads meet at each vertex, and how many ought to.

use crate::domain::{Boundary, Place};
use crate::mesh::QuadMesh;
use std::f64::consts::PI;

/// The quads at each vertex, in one array.
#[derive(Debug, Clone)]
pub(super) struct Stars {
    start: Vec<u32>,
    quads: Vec<u32>,
}

impl Stars {
    pub fn new(vertices: usize, quads: &[[u32; 4]]) -> Self {
        let mut start = vec![0u32; vertices + 1];
        quads.iter().flatten().for_each(|v| start[*v as usize + 1] += 1);
        for v in 0..vertices {
            start[v + 1] += start[v];
        }
        let mut next = start.clone();
        let mut list = vec![0; 4 * quads.len()];
        for (q, quad) in quads.iter().enumerate() {
            for v in quad {
                list[next[*v as usize] as usize] = q as u32;
                next[*v as usize] += 1;
            }
        }
        Stars { start, quads: list }
    }

    /// Quads at vertex `v`.
    pub fn of(&self, v: u32) -> &[u32] {
        &self.quads[self.start[v as usize] as usize..self.start[v as usize + 1] as usize]
    }

    /// Number of quads at `v`.
    pub fn valence(&self, v: u32) -> usize {
        self.of(v).len()
    }

    /// The quads at the vertices `seeds`, and `rings` rings of quads around them, ascending.
    pub fn rings(&self, mesh: &QuadMesh, seeds: &[u32], rings: usize) -> Vec<u32> {
        let mut seen = vec![false; mesh.quads.len()];
        let mut front: Vec<u32> = seeds.to_vec();
        let mut done = vec![false; mesh.vertices.len()];
        let mut list = Vec::new();
        for _ in 0..=rings {
            let mut next = Vec::new();
            for v in front {
                if std::mem::replace(&mut done[v as usize], true) {
                    continue;
                }
                for q in self.of(v) {
                    if !std::mem::replace(&mut seen[*q as usize], true) {
                        list.push(*q);
                        next.extend(mesh.quads[*q as usize]);
                    }
                }
            }
            front = next;
        }
        list.sort_unstable();
        list
    }
}

/// Number of quads that ought to meet at a place: 4 inside, 2 on a smooth boundary, Table 1 of the paper
/// at a corner (with ties downwards).
pub(super) fn ideal_valence(boundary: &Boundary, place: Place) -> usize {
    match place {
        Place::Interior => 4,
        Place::Boundary(_) => 2,
        Place::Junction(j) => {
            let quarters = boundary.junctions[j as usize].angle / (0.5 * PI);
            ((quarters - 0.5 - 1e-6).ceil().max(1.0) as usize).min(4)
        }
    }
}

/// How far `valence` quads are from the ideal at a place, squared.
pub(super) fn irregularity(boundary: &Boundary, place: Place, valence: usize) -> usize {
    let ideal = ideal_valence(boundary, place);
    ideal.abs_diff(valence).pow(2)
}
