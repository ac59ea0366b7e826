//! Several chords removed at once, as a symmetric mesh needs it.

use super::chords::chord_through;
use super::live::LiveMesh;
use super::merge::Merge;
use super::patch::Patch;
use super::pieces::least_pieces;
use super::trial::{settle, Limits, Reach};
use crate::domain::{Boundary, Place};
use crate::error::Result;
use crate::mesh::QuadMesh;
use crate::smooth::Optimiser;

/// Removes sets of chords from meshes of one domain, within the same limits.
pub struct StripRemoval<'a> {
    boundary: &'a Boundary,
    optimiser: &'a Optimiser<'a>,
    limits: Limits<'a>,
    /// Least number of edges of each chain.
    least: Vec<usize>,
}

impl<'a> StripRemoval<'a> {
    /// # Errors
    /// As [`least_pieces`].
    pub fn new(boundary: &'a Boundary, optimiser: &'a Optimiser<'a>, limits: Limits<'a>) -> Result<Self> {
        let pieces = |chain| match optimiser.boundary_error() {
            Some(error) => least_pieces(chain, error),
            None => Ok(1),
        };
        let least = boundary.chains.iter().map(pieces).collect::<Result<Vec<_>>>()?;
        Ok(StripRemoval { boundary, optimiser, limits, least })
    }

    /// `mesh` without the chords through `edges`, its surroundings optimised; `None` if that is impossible, breaks a
    /// limit, or if the connectivity without them is not `wanted`, which is asked before anything is optimised.
    pub fn without(
        &self,
        mesh: &QuadMesh,
        edges: &[u32],
        wanted: impl Fn(&QuadMesh) -> bool,
    ) -> Option<QuadMesh> {
        let on_boundary = |v: u32| mesh.vertices[v as usize].place != Place::Interior;
        let (mut pairs, mut quads) = (Vec::new(), Vec::new());
        for edge in edges {
            let chord = chord_through(mesh, *edge);
            for e in chord.rungs {
                let edge = &mesh.edges[e as usize];
                if edge.span.is_none() && edge.vertices.iter().all(|v| on_boundary(*v)) {
                    return None;
                }
                pairs.push((edge.vertices, edge.span.is_some()));
            }
            quads.extend(chord.quads);
        }
        quads.sort_unstable();
        quads.dedup();
        let mut live = LiveMesh::new(mesh.clone(), self.boundary.chains.len());
        let merge = Merge::new(self.boundary, &live, &pairs, &quads, &self.least).ok()?;
        let mut merged = live.clone();
        let patch = Patch::new(self.boundary, &merge, &merge.touched, 1)?;
        merged.splice(&patch, merge.clone().into_removal());
        if !wanted(&merged.compact()) {
            return None;
        }
        let floor = self.limits.scaled_jacobian;
        let settled = settle(self.optimiser, merge, floor, &|_| self.limits, Reach::Far, &mut 0).ok()?;
        live.splice(&settled.patch, settled.removal);
        Some(live.compact())
    }
}
