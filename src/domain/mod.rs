//! Step 0 of the paper: the domain.
//!
//! *In:* loops of named curve segments, from callbacks, native segments or files.
//! *Out:* a checked [`Domain`] (loops closed, disjoint, nested; outer counter-clockwise, holes
//! clockwise: the domain lies to the left) and its [`Boundary`], the arc-length tables in the
//! canonical frame that every later stage works with.

mod boundary;
mod curve;
mod frame;

pub use boundary::{Boundary, BoundaryPoint, Chain, Junction, Place, Sample, Span};
pub use curve::{Curve, CurveFailure};
pub use frame::Frame;
