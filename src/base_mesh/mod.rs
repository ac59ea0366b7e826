//! Step 1 of the paper: the triangle base mesh.
//!
//! *In:* the [`Boundary`] and, after a failed check, places to refine.
//! *Out:* a [`Triangulation`] whose border is a polygon inscribed in the boundary.
//!
//! *Method:* the boundary is cut into chords by bisection until none is too long, turns too
//! much, or is much longer than its neighbours (`sampling`). A constrained Delaunay triangulation
//! of the chords tells which cross or run closer to the boundary across than their arcs are high;
//! these are halved and the triangulation is made anew. Then Delaunay refinement (Ruppert 1995, with
//! the small-angle rule of Miller, Pav and Walkington 2005) bounds angles and areas; it resolves narrow
//! parts by itself because it splits chords that are long for the gap. Or the caller brings one ([`adopt`]).

mod adjacency;
mod check;
mod delaunay;
mod element_size;
mod given;
mod locate;
mod place_tree;
mod sampling;
mod size_field;
mod size_samples;
mod tips;

pub use tips::{doubtful_corners, doubtful_reach};

pub use element_size::ElementSize;
pub use given::adopt;

use crate::domain::{Boundary, Place};
use crate::error::{Error, Result};
use crate::numerics::tolerances::{BASE_EDGE_AREA, BASE_EDGE_DIAGONAL};
use crate::numerics::Point;

/// A vertex of the base mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BaseVertex {
    pub point: Point,
    /// On a border vertex the boundary place it stands for. A vertex that lies on the chord
    /// between two samples stands for the place at the same share of the arc.
    pub place: Place,
}

/// A constrained Delaunay triangulation of the domain.
#[derive(Debug, Clone, PartialEq)]
pub struct Triangulation {
    pub vertices: Vec<BaseVertex>,
    /// Counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
    /// `neighbors[t][i]` lies across the edge from corner i to corner i + 1; `NONE` at the border.
    pub neighbors: Vec<[u32; 3]>,
    /// For each loop of the boundary its border vertices in order, the domain to the left.
    pub loops: Vec<Vec<u32>>,
}

/// How fine the base mesh should be; the default is the usual size everywhere.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Request {
    /// Wanted length of the base edges, in the canonical frame; `None`: [`usual_size`].
    pub size: Option<f64>,
    /// Places with a wanted smaller length of the edges there.
    pub refine: Vec<(Point, f64)>,
}

/// The length of the base edges if the caller has no wish.
pub fn usual_size(boundary: &Boundary) -> f64 {
    BASE_EDGE_DIAGONAL.min(boundary.area.max(0.0).sqrt() * BASE_EDGE_AREA)
}

/// Triangulates the domain inside `boundary`.
///
/// [`Error::BaseMesh`] with its place where the chords cross however fine they are.
pub fn triangulate(boundary: &Boundary, request: &Request) -> Result<Triangulation> {
    let size = request.size.unwrap_or_else(|| usual_size(boundary));
    if !(size > 0.0 && size.is_finite()) {
        return Err(Error::InvalidArgument {
            what: "the size of the base triangles",
            value: size.to_string(),
            allowed: "a finite length above 0",
        });
    }
    delaunay::triangulate(boundary, &size_field::SizeField::new(request, size))
}
