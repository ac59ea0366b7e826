//! The one error type: a variant a cause, each with its place and numbers.

use crate::numerics::Point;
use std::fmt;

/// Why no mesh was made. `Display` says what is wrong, where, and what to do about it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// An option or argument is out of its range.
    InvalidArgument { what: &'static str, value: String, allowed: &'static str },
    /// A curve callback reported failure, or gave a value that is not finite.
    Callback { loop_index: usize, segment: usize, t: f64, reason: String },
    /// The function for the element size gave up, or a value that is not finite and above 0.
    SizeFunction { reason: String, at: Point },
    /// The progress callback asked to stop.
    Cancelled,
    /// Consecutive segments do not join.
    OpenLoop { loop_index: usize, segment: usize, gap: f64, at: Point },
    /// Boundary curves cross or touch, or one crosses itself.
    Intersection { loops: [usize; 2], segments: [usize; 2], at: Point },
    /// No outer loop, several, a hole outside it or inside another hole.
    Nesting { reason: NestingError, at: Option<Point> },
    /// An interior corner angle of 0: every quadrilateral there has a vanishing Jacobian.
    Cusp { loop_index: usize, segment: usize, angle: f64, at: Point },
    /// A segment or loop without extent, or the same loop twice.
    Degenerate { loop_index: usize, segment: usize, reason: &'static str, at: Point },
    /// The domain could not be triangulated.
    BaseMesh { reason: String, at: Option<Point> },
    /// The linear solve of the cross field failed.
    CrossField { reason: String, at: Option<Point> },
    /// Tracing failed at every resolution tried.
    Separatrix { reason: String, at: Option<Point> },
    /// No conforming layout at every resolution tried.
    Layout { reason: String, at: Option<Point> },
    /// The tolerance is not met within the element limit.
    Tolerance { error: f64, tolerance: f64, at: Point },
    /// A curved element's Jacobian could not be proven positive.
    InvalidElement { jacobian: f64, at: Point },
    /// Reading or writing a file failed.
    Io { path: String, reason: String },
    /// A file or feature that cannot be handled, with what can be done instead.
    Unsupported { what: String },
    /// A file or expression cannot be understood; line and column count from 1.
    Parse { what: String, line: usize, column: usize },
    /// A defect of the library itself.
    Internal { reason: String },
}

/// What is wrong with the arrangement of the loops.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum NestingError {
    /// There is no outer loop.
    NoOuterLoop,
    /// More than one loop is an outer one; the number of components.
    SeveralComponents(usize),
    /// A hole lies outside the outer loop.
    HoleOutside(usize),
    /// A hole lies inside another hole.
    HoleInHole(usize),
}

/// Result of everything in quadrel that can fail.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// The error's name in snake case, as in the statistics file.
    pub fn name(&self) -> &'static str {
        match self {
            Error::InvalidArgument { .. } => "invalid_argument",
            // One name, one status of the C interface.
            Error::Callback { .. } | Error::SizeFunction { .. } => "callback",
            Error::Cancelled => "cancelled",
            Error::OpenLoop { .. } => "open_loop",
            Error::Intersection { .. } => "intersection",
            Error::Nesting { .. } => "nesting",
            Error::Cusp { .. } => "cusp",
            Error::Degenerate { .. } => "degenerate",
            Error::BaseMesh { .. } => "base_mesh",
            Error::CrossField { .. } => "cross_field",
            Error::Separatrix { .. } => "separatrix",
            Error::Layout { .. } => "layout",
            Error::Tolerance { .. } => "tolerance",
            Error::InvalidElement { .. } => "invalid_element",
            Error::Io { .. } => "io",
            Error::Unsupported { .. } => "unsupported",
            Error::Parse { .. } => "parse",
            Error::Internal { .. } => "internal",
        }
    }

    /// Whether it is the caller who ends the run, or a callback: another attempt would end the same way.
    pub(crate) fn ends_a_run(&self) -> bool {
        matches!(self, Error::Cancelled | Error::Callback { .. } | Error::SizeFunction { .. })
    }

    /// Where in the domain (in the caller's coordinates), if the cause has a place.
    pub fn place(&self) -> Option<Point> {
        match self {
            Error::SizeFunction { at, .. }
            | Error::OpenLoop { at, .. }
            | Error::Intersection { at, .. }
            | Error::Cusp { at, .. }
            | Error::Degenerate { at, .. }
            | Error::Tolerance { at, .. }
            | Error::InvalidElement { at, .. } => Some(*at),
            Error::Nesting { at, .. }
            | Error::BaseMesh { at, .. }
            | Error::CrossField { at, .. }
            | Error::Separatrix { at, .. }
            | Error::Layout { at, .. } => *at,
            _ => None,
        }
    }

    /// The same error with its place mapped by `f`, from the canonical frame to the caller's.
    pub(crate) fn map_place(mut self, f: impl Fn(Point) -> Point) -> Self {
        match &mut self {
            Error::Tolerance { at, .. } | Error::InvalidElement { at, .. } => *at = f(*at),
            Error::BaseMesh { at: Some(p), .. }
            | Error::CrossField { at: Some(p), .. }
            | Error::Separatrix { at: Some(p), .. }
            | Error::Layout { at: Some(p), .. } => *p = f(*p),
            _ => {}
        }
        self
    }
}

fn place(at: &Option<Point>) -> String {
    at.map_or(String::new(), |p| format!(" near ({:.9}, {:.9})", p.x, p.y))
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Error::InvalidArgument { what, value, allowed } => {
                write!(f, "{what} is {value}; give {allowed}")
            }
            Error::Callback { loop_index, segment, t, reason } => write!(
                f,
                "the curve of loop {loop_index}, segment {segment} failed at t = {t}: {reason}; \
                 it must give finite coordinates for every t in [0, 1]"
            ),
            Error::SizeFunction { reason, at } => write!(
                f,
                "the function for the element size failed at ({:.9}, {:.9}): {reason}; it must give a finite \
                 length above 0 everywhere in the domain",
                at.x, at.y
            ),
            Error::Cancelled => write!(f, "cancelled by the progress callback"),
            Error::OpenLoop { loop_index, segment, gap, at } => write!(
                f,
                "loop {loop_index} is open by {gap:.6e} before segment {segment} at ({:.9}, {:.9}); \
                 make the segments join or raise the join tolerance",
                at.x, at.y
            ),
            Error::Intersection { loops, segments, at } => write!(
                f,
                "boundary curves cross or touch at ({:.9}, {:.9}): loop {} segment {} and loop {} \
                 segment {}; boundary curves must be disjoint and simple",
                at.x, at.y, loops[0], segments[0], loops[1], segments[1]
            ),
            Error::Nesting { reason, at } => {
                match reason {
                    NestingError::NoOuterLoop => {
                        write!(f, "there is no outer loop; add one loop that encloses the others")?
                    }
                    NestingError::SeveralComponents(n) => {
                        write!(f, "the domain has {n} separate components; choose one (--component K)")?
                    }
                    NestingError::HoleOutside(k) => {
                        write!(f, "hole {k} lies outside the outer loop; move it inside or leave it out")?
                    }
                    NestingError::HoleInHole(k) => write!(
                        f,
                        "hole {k} lies inside another hole; mesh the island as a domain of its own"
                    )?,
                }
                write!(f, "{}", place(at))
            }
            Error::Cusp { loop_index, segment, angle, at } => write!(
                f,
                "a cusp (interior angle {:.3}°) at ({:.9}, {:.9}), start of loop {loop_index} segment \
                 {segment}: no quadrilateral is valid there; cut the tip off",
                angle.to_degrees(),
                at.x,
                at.y
            ),
            Error::Degenerate { loop_index, segment, reason, at } => write!(
                f,
                "loop {loop_index} segment {segment} at ({:.9}, {:.9}): {reason}; remove it",
                at.x, at.y
            ),
            Error::BaseMesh { reason, at } => write!(f, "base mesh: {reason}{}", place(at)),
            Error::CrossField { reason, at } => write!(f, "cross field: {reason}{}", place(at)),
            Error::Separatrix { reason, at } => write!(f, "separatrices: {reason}{}", place(at)),
            Error::Layout { reason, at } => write!(f, "layout: {reason}{}", place(at)),
            Error::Tolerance { error, tolerance, at } => write!(
                f,
                "the boundary error {error:.3e} near ({:.9}, {:.9}) exceeds the tolerance \
                 {tolerance:.3e}; raise the tolerance or the order",
                at.x, at.y
            ),
            Error::InvalidElement { jacobian, at } => write!(
                f,
                "an element near ({:.9}, {:.9}) has a Jacobian that is not proven positive \
                 (scaled {jacobian:.3e}); raise the tolerance's resolution or simplify the boundary there",
                at.x, at.y
            ),
            Error::Io { path, reason } => write!(f, "{path}: {reason}"),
            Error::Unsupported { what } => write!(f, "{what}"),
            Error::Parse { what, line, column } => {
                write!(f, "line {line}, column {column}: {what}")
            }
            Error::Internal { reason } => {
                write!(
                    f,
                    "internal error: {reason}; this is a defect of quadrel, please report it with the domain"
                )
            }
        }
    }
}

impl std::error::Error for Error {}
