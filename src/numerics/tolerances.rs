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

/// Largest difference between the layout regions' areas and the domain's, relative to the domain's area:
/// traces and base mesh are polygons, so areas agree only roughly; a region counted twice or missing
/// differs by more.
pub const LAYOUT_AREA: f64 = 0.05;
