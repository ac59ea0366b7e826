//! Step 4 of the paper: separatrices, all traced together.
//!
//! *In:* the base mesh, the cross field, singularities and corners.
//! *Out:* [`Separatrix`]s: a motorcycle graph. All grow together by arc length; each ends at the
//! border or at the first earlier one that it crosses, which becomes a T-junction. A loop that no trace
//! connects with the others gets a seed ray, so that every region is a disc.
//!
//! *Method:* a trace is a sequence of positions on the triangles' edges; the map through a triangle is
//! monotone, so that traces of one family never cross or merge, and which traces cross is
//! decided by the order of positions, not by geometry (Ray & Sokolov 2014; Myles, Pietroni & Zorin 2014).

mod stream;
mod tracer;

use crate::base_mesh::Triangulation;
use crate::cross_field::CrossField;
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::error::Result;
use crate::numerics::Point;
use crate::singularities::{CornerFan, Singularity};

/// Traces all separatrices, and after them a ray from each of the boundary points `seeds`.
///
/// # Errors
/// [`Error::Separatrix`](crate::Error::Separatrix) with the place, if a trace cannot go on or winds without end.
pub fn trace(
    mesh: &Triangulation,
    field: &CrossField,
    boundary: &Boundary,
    singularities: &[Singularity],
    corners: &[CornerFan],
    seeds: &[BoundaryPoint],
) -> Result<Vec<Separatrix>> {
    let mut tracer = tracer::Tracer::new(mesh, field, boundary, singularities, corners);
    tracer.cut_tips()?;
    tracer.launch_all()?;
    tracer.run()?;
    tracer.connect_loops()?;
    for &seed in seeds {
        tracer.launch_seed_at(seed)?;
        tracer.run()?;
    }
    Ok(tracer.finish())
}

/// What an end of a separatrix lies on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TraceEnd {
    /// Port `port` of interior singularity `singularity`.
    Singularity { singularity: u32, port: u8 },
    /// Ray `ray` (from 1) of corner fan `corner`.
    Corner { corner: u32, ray: u8 },
    /// A border point: `share` in (0, 1) of border edge `edge` of loop `loop_index`.
    Border { loop_index: u32, edge: u32, share: f64, place: Place },
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
    /// The T-junctions on it, in order.
    pub stops: Vec<Stop>,
}

/// A T-junction: another separatrix ends here.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// It lies on the segment from `points[segment]` to the next point.
    pub segment: u32,
    pub point: Point,
    /// The separatrix that ends here, and whether it comes from the left.
    pub stem: u32,
    pub left: bool,
}
