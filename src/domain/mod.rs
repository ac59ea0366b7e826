//! Step 0 of the paper: the domain.
//!
//! *In:* loops of named curve segments, from callbacks, native segments or files.
//! *Out:* a checked [`Domain`] (loops closed, disjoint, nested; outer counter-clockwise, holes
//! clockwise: the domain lies to the left) and its [`Boundary`], the arc-length tables in the
//! canonical frame that every later stage works with.

mod arc;
mod bezier;
mod boundary;
mod boundary_check;
mod boundary_loop;
mod bounds;
mod box_tree;
mod builder;
mod callback;
mod canonical;
mod chain_table;
mod corners_inside;
mod crossing;
mod curve;
mod differences;
mod domain_check;
mod exact;
mod frame;
mod gauss;
mod given_place;
mod junction;
mod line;
mod nesting;
mod piece;
mod planar_domain;
mod segment;
mod segment_table;
mod spline;
mod tables;
pub(crate) mod walk;

pub use arc::EllipticArc;
pub use bezier::Bezier;
pub use boundary::{Boundary, BoundaryPoint, Chain, Junction, Place, Sample, Span};
pub use boundary_loop::{BoundaryLoop, LoopKind};
pub use bounds::Bounds;
pub use builder::DomainBuilder;
pub use callback::{CallbackCurve, CurveFn};
pub use chain_table::ChainTable;
pub use curve::{Curve, CurveFailure};
pub use exact::CurvePlace;
pub use frame::Frame;
pub use line::Line;
pub use planar_domain::Domain;
pub use segment::CurveSegment;
pub use spline::CubicSpline;
