//! Step 9 of the paper: the meshes, their quality and the proof that they are valid.
//!
//! *In:* a [`QuadMesh`], the mesh that refinement and smoothing work on: vertices, quads, and one
//! polynomial curve for each edge, shared by both sides; the boundary and the tolerance.
//! *Out:* a [`HighOrderMesh`]: order-N elements with all their nodes, in the caller's frame.
//!
//! *Method:* boundary edges interpolate the exact curves at the Gauss-Lobatto points in arc length
//! ([`ExactCurve`]); insides are Coons maps ([`Geometry`]). Nothing is returned that is not
//! conforming ([`QuadMesh::check`]), proven to have a positive Jacobian over every whole element
//! ([`JacobianProof`]: Johnen, Remacle, Geuzaine 2013) and within the tolerance on every boundary edge
//! ([`BoundaryError`]).
//!
//! *Norms.* With s the arc length along an edge of length L, x(s) the exact curve and x_N the order-N edge:
//! L2 is (∫ |x − x_N|² ds)^½, H1 is (∫ |x − x_N|² + L² |x′ − x_N′|² ds)^½, Max is max |x − x_N|. A
//! relative tolerance E stands for E · D^{3/2} (Max: E · D), D the diagonal of the domain's bounding box.
//!
//! *Quality* is the scaled Jacobian, the minimum over an element of det J / (|x_ξ| |x_η|)
//! ([`Quality`]), to be compared with what the domain's corners allow ([`scaled_jacobian_ceiling`]).

mod bernstein_proof;
mod boundary_error;
mod bubbles;
mod ceiling;
mod chain_error;
mod conformity;
mod connectivity;
mod dense;
mod exact_curve;
mod geometry;
mod high_order_mesh;
mod measures;
mod quad_mesh;
mod unproven;

pub use bernstein_proof::{JacobianProof, Verdict};
pub use boundary_error::{BoundaryError, BoundaryTolerance};
pub use bubbles::{bubble_shape, fit_bubbles, part_of_bubbles, reversed_bubbles};
pub use ceiling::{
    irregular, irregularity_bound, quads_by_table, scaled_jacobian_ceiling, Irregular, IrregularityBound,
};
pub use exact_curve::{CallerPlace, DomainCurve, ExactCurve, TableCurve};
pub use geometry::Geometry;
pub use measures::{ElementMeasures, Quality};
pub use quad_mesh::{Edge, QuadMesh, Vertex};
pub use unproven::unproven;

use crate::numerics::Point;

/// An edge of the finished mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshEdge {
    pub vertices: [u32; 2],
    /// The elements to its left and right; `NONE` outside the domain.
    pub elements: [u32; 2],
    /// The boundary's name, an index into [`HighOrderMesh::boundary_names`]; `NONE` inside.
    pub boundary: u32,
    /// Boundary edges: the loop they lie on; `NONE` inside.
    pub loop_index: u32,
    /// Boundary edges: the loop's segment and its parameter at each end, as the caller has them (the
    /// parameter falls where the caller walked the loop the other way).
    pub segments: [u32; 2],
    pub parameters: [f64; 2],
    /// Boundary edges: the error in the chosen norm, in the caller's unit; else 0.
    pub error: f64,
}

/// The finished mesh, immutable, in the caller's frame.
#[derive(Debug, Clone, PartialEq)]
pub struct HighOrderMesh {
    pub order: usize,
    /// Gauss-Lobatto points in [-1, 1], N + 1 of them.
    pub reference_nodes: Vec<f64>,
    pub vertices: Vec<Point>,
    /// Corners counter-clockwise; side s joins corner s to corner (s + 1) % 4.
    pub elements: Vec<[u32; 4]>,
    /// `[element][j][i]`, (N + 1)² points each, i along side 0.
    pub nodes: Vec<Point>,
    /// Which layout region each element comes from.
    pub blocks: Vec<u32>,
    pub edges: Vec<MeshEdge>,
    pub element_edges: Vec<[u32; 4]>,
    pub boundary_names: Vec<String>,
    /// Minimum over each element of det J / (|x_ξ| |x_η|).
    pub scaled_jacobian: Vec<f64>,
}
