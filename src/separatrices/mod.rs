//! Step 4 of the paper: separatrices, all traced together.
//!
//! *In:* the base mesh, the cross field, singularities and corners.
//! *Out:* [`Separatrix`]s (a motorcycle graph).

use crate::numerics::Point;

/// What an end of a separatrix lies on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TraceEnd {
    /// Port `port` of interior singularity `singularity`.
    Singularity { singularity: u32, port: u8 },
    /// Ray `ray` (from 1) of corner fan `corner`.
    Corner { corner: u32, ray: u8 },
    /// A border point: border vertex `from` begins the border edge, `share` of it in [0, 1].
    Border { from: u32, share: f64 },
    /// On separatrix `on`: a T-junction.
    Separatrix { on: u32 },
}

/// A separatrix, from the singularity or corner that launched it to where it ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Separatrix {
    pub from: TraceEnd,
    pub to: TraceEnd,
    /// Its polyline, both ends included.
    pub points: Vec<Point>,
}
