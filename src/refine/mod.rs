//! Step 7 of the paper: boundary edges short enough for the tolerance, and no shorter.
//!
//! *In:* the chains of the [`Boundary`](crate::domain::Boundary), the tolerance, and how many edges
//! each chain has. *Out:* where on the chains the vertices lie.
//!
//! The tolerance belongs to a chain, not to an edge: a chain needs at least [`least_pieces`] edges, and
//! [`place_equal_error`] puts the vertices of any larger number where all edges have the same
//! error (de Boor's equidistribution, *Good approximation by splines with variable knots*, 1973).
//! [`place_by_halving`] is the paper's own rule (Algorithm 1), [`subdivide`] the same on a mesh.
//!
//! Where the tolerance takes many more edges than the shape, elements are made for a looser [`first_tolerance`], get a
//! row along the boundary ([`insert_layer`]), and are divided there only ([`divide_inside`]).
//!
//! [`coarsen`] takes a valid mesh that is finer than it need be and removes chords and diagonals,
//! re-optimising round each, while the tolerance and the quality hold. [`OnChain`] moves boundary vertices to where
//! the curve is less smooth. [`SizeLimit`] divides what is larger than asked for, and further where elements' maps
//! follow waves worse than their size promises.

mod chords;
mod coarsen;
mod coons;
mod divide;
mod halving;
mod inside;
mod layer;
mod live;
mod meet;
mod merge;
mod patch;
mod pieces;
mod placement;
mod refusals;
mod resolve;
mod respace;
mod size_limit;
mod split;
mod stretch;
mod strips;
mod subdivide;
#[cfg(test)]
mod tests;
mod thin;
mod tighten;
mod to_breaks;
mod trial;
mod valence;
mod waves;

pub use coarsen::coarsen;
pub use divide::divide_chords;
pub use halving::place_by_halving;
pub use inside::divide_inside;
pub use layer::insert_layer;
pub use meet::meet_tolerance;
pub use pieces::least_pieces;
pub use placement::{place_equal_error, Placement};
pub use refusals::Refusals;
pub use size_limit::SizeLimit;
pub use split::split_chords;
pub use strips::StripRemoval;
pub use subdivide::subdivide;
pub use thin::thin;
pub use tighten::{divide_boundary, divide_wide, first_tolerance, layered};
pub use to_breaks::{OnChain, ToBreak, Undo};
pub use trial::{Limits, Reach};
