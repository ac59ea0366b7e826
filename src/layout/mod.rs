//! Steps 5 and 6 of the paper: from separatrices to conforming blocks.
//!
//! *In:* a [`BlockLayout`]: a T-mesh of regions, traced or drawn by hand.
//! *Out:* a [`QuadLayout`]: conforming, every region four-sided.
//!
//! *Method:* regions that are not four-sided are repaired ([`conform`] calls the rules of the paper, and
//! patterns beyond them); one integer length is chosen for every arc, zero allowed, so that the
//! regions can be filled with quads ([`lengths`], an own solver of [`bidirected_flow`]s after Campen,
//! Bommes, Kobbelt 2015 and Heistermann, Warnett, Bommes 2023); points that zero lengths merge are
//! identified and the regions filled by grids ([`extract`]). Where lengths contradict each
//! other a region is cut into a triangle and a pentagon.

pub mod bidirected_flow;
mod check;
mod conform;
mod cut;
pub mod extract;
mod grids;
mod identify;
pub mod lengths;
mod polyline;
mod repair;
mod skew;
mod targets;

pub use conform::{conform, Conforming};
pub use cut::BorderNode;
pub use targets::{LengthTargets, PentagonRule, Targets};

pub mod t_mesh;

use crate::domain::{Place, Span};
use crate::numerics::Point;

/// What a node of the T-mesh is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NodeKind {
    /// An interior singularity of this valence; it is never merged with one of equal sign.
    Singularity(u8),
    /// A junction that has to stay a vertex.
    Junction,
    /// Another boundary point (the end or start of a separatrix).
    Boundary,
    /// A point where one separatrix ends on another, or any other interior point.
    Interior,
}

/// A node of the T-mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    pub point: Point,
    pub kind: NodeKind,
    pub place: Place,
}

/// An arc of the T-mesh between two nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Arc {
    pub nodes: [u32; 2],
    /// Its shape from the first node to the second, both ends included; at least two points.
    pub points: Vec<Point>,
    /// The piece of boundary it is, in its own direction (`nodes[0]` at `start`); else `None`.
    pub span: Option<Span>,
}

/// A side's arc: its index, and whether it is walked from its first node to its second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SideArc {
    pub arc: u32,
    pub forward: bool,
}

/// A region: its sides counter-clockwise, each one or more arcs; the corners lie between sides.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Region {
    pub sides: Vec<Vec<SideArc>>,
}

/// The T-mesh: regions of (mostly) four sides with T-junctions on them.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BlockLayout {
    pub nodes: Vec<Node>,
    pub arcs: Vec<Arc>,
    pub regions: Vec<Region>,
}

/// A vertex of the conforming layout.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayoutVertex {
    pub point: Point,
    pub place: Place,
}

/// The conforming layout: all regions four-sided (another type, so that the compiler knows).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct QuadLayout {
    pub vertices: Vec<LayoutVertex>,
    /// Corners of each quad, counter-clockwise.
    pub quads: Vec<[u32; 4]>,
    /// The region of the T-mesh that each quad comes from.
    pub region: Vec<u32>,
}
