//! Every tolerance of the library, each relative to a stated length, with its reason.
//! Stages work in the canonical frame, where the domain's bounding-box diagonal is 1
//! ([`crate::domain::Frame`]), so "relative to the diagonal" is the plain number there.

/// Largest gap between the end of a segment and the start of the next that is closed silently,
/// relative to the domain's diagonal. Files written with six digits need 1e-6; 1e-4 takes
/// the worst of HOHQMesh's examples.
pub const JOIN: f64 = 1e-4;

/// Least change of direction, in radians, that makes a boundary point a mesh vertex for good
/// (a polynomial edge across it would converge algebraically only).
pub const CORNER_TURN: f64 = 1e-3;

/// Least change of direction, in radians, at which a boundary point launches separatrices of its
/// own: below, the lines that pass by are aligned well enough.
pub const PORT_TURN: f64 = 0.05;

/// Shortest boundary edge that subdivision makes, relative to the domain's diagonal: the exact
/// curves' own rounding (1e-16) is still a millionth of it.
pub const SHORTEST_EDGE: f64 = 1e-10;

/// Largest share of a closed chain that one edge may cover: a loop has at least three edges.
pub const LONGEST_LOOP_SHARE: f64 = 1.0 / 3.0;

/// Share of the boundary tolerance that placement aims at, so that vertices may still slide.
pub const PLACEMENT_MARGIN: f64 = 0.9;

/// Largest distance of a boundary vertex from the point of its place, relative to the domain's
/// diagonal: both are evaluations of the same table, or of the exact curve beside it.
pub const PLACE_DISTANCE: f64 = 1e-9;

/// Largest difference of arc lengths that are the same place, relative to the domain's diagonal.
pub const SPAN_GAP: f64 = 1e-12;

/// Gap at a joint, relative to the domain's diagonal, that is mere rounding: which of the two ends
/// moves is then decided in the normalised orientation, so that loops given backwards agree.
pub const JOIN_ROUNDING: f64 = 1e-12;

/// Distance, relative to the domain's diagonal, below which boundary curves touch. Gaps of 1e-5
/// occur in real outlines and are meshed; below this no element has a sensible shape.
pub const TOUCH: f64 = 1e-9;

/// Size, relative to the domain's diagonal, of a segment or loop without extent.
pub const NO_EXTENT: f64 = 1e-9;

/// Interior angle, in radians, below which a corner is a cusp and refused (0.1°): the scaled Jacobian
/// there cannot exceed its sine.
pub const CUSP_ANGLE: f64 = 1.7e-3;

/// A reversal of direction that is exact up to this, in radians: the sign of the turn then says
/// nothing about the side.
pub const REVERSAL: f64 = 1e-7;

/// Difference of canonical lengths that is rounding when poses are compared.
pub const POSE_TIE: f64 = 1e-9;

/// Largest distance of the boundary tables' interpolant from a smooth curve, relative to the canonical
/// diagonal: far below any tolerance a caller can ask for in double precision.
pub const TABLE_ERROR: f64 = 1e-11;

/// Table intervals shorter than this, relative to the canonical diagonal, are not divided further: a
/// singular parametrisation ends somewhere.
pub const TABLE_SHORTEST: f64 = 1e-9;

/// Distance from the tip of a cusp, relative to the smaller of its two segments, within which its branches may
/// come closer than the touching distance: with any visible difference of curvature they are further apart beyond.
pub const CUSP_REACH: f64 = 1e-2;

/// Arc length, relative to the canonical diagonal, to which a curve's parameter is found for a given arc length.
pub const ARC_LENGTH_MATCH: f64 = 1e-13;

/// Relative difference of area and of its moments below which two loops that meet are the same.
pub const SAME_MOMENTS: f64 = 1e-6;
