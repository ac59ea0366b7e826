//! Step 1 of the paper: the triangle base mesh.
//!
//! *In:* the [`Boundary`](crate::domain::Boundary) and, after a failed check, places to refine.
//! *Out:* a [`Triangulation`] whose border is a polygon inscribed in the boundary.

mod size_field;

pub use size_field::SizeField;

use crate::domain::Place;
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
