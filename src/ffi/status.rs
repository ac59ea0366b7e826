//! Library and errors

use super::guard::{answer, copy_out, last_error_location, last_error_text, Failure};
use crate::error::Error;
use libc::{c_char, c_int};

/// What a call ended with. Numbers are never used again for something else; new ones may appear.
pub type quadrel_status = i32;

pub const QUADREL_OK: quadrel_status = 0;
/// a required pointer is NULL
pub const QUADREL_ERROR_NULL: quadrel_status = 1;
/// a value out of range, not finite or unknown, text that is not UTF-8, or a call out of order
pub const QUADREL_ERROR_INVALID_ARGUMENT: quadrel_status = 2;
/// a curve or size callback returned non-zero or a value that is not finite (a size: not above 0)
pub const QUADREL_ERROR_CALLBACK: quadrel_status = 3;
/// the progress callback, or the one that takes a file's bytes, asked to stop
pub const QUADREL_ERROR_CANCELLED: quadrel_status = 4;
/// consecutive segments do not join
pub const QUADREL_ERROR_OPEN_LOOP: quadrel_status = 10;
/// boundary curves cross or touch, or one crosses itself
pub const QUADREL_ERROR_INTERSECTION: quadrel_status = 11;
/// no outer loop, several, or a hole outside it or inside another hole
pub const QUADREL_ERROR_NESTING: quadrel_status = 12;
/// an interior corner angle of 0
pub const QUADREL_ERROR_CUSP: quadrel_status = 13;
/// a segment or loop without extent, or the same twice
pub const QUADREL_ERROR_DEGENERATE: quadrel_status = 14;
/// the domain could not be triangulated, or the caller's base triangulation is none of this domain
pub const QUADREL_ERROR_BASE_MESH: quadrel_status = 20;
/// no cross field that fits the domain was found
pub const QUADREL_ERROR_CROSS_FIELD: quadrel_status = 21;
/// tracing separatrices failed at every resolution tried
pub const QUADREL_ERROR_SEPARATRIX: quadrel_status = 22;
/// no conforming layout at every resolution tried, or more elements than allowed
pub const QUADREL_ERROR_LAYOUT: quadrel_status = 23;
/// the boundary tolerance could not be met
pub const QUADREL_ERROR_TOLERANCE: quadrel_status = 24;
/// an element whose Jacobian could not be proven positive
pub const QUADREL_ERROR_INVALID_ELEMENT: quadrel_status = 25;
/// a file could not be read or written
pub const QUADREL_ERROR_IO: quadrel_status = 30;
/// a kind of file or a feature that quadrel does not handle
pub const QUADREL_ERROR_UNSUPPORTED: quadrel_status = 31;
/// a file or expression that cannot be understood, with line and column
pub const QUADREL_ERROR_PARSE: quadrel_status = 32;
/// a defect of quadrel (a caught panic): please report it
pub const QUADREL_ERROR_INTERNAL: quadrel_status = 99;

/// All statuses with their names, each ended by a zero byte.
const NAMES: [(quadrel_status, &str); 20] = [
    (QUADREL_OK, "QUADREL_OK\0"),
    (QUADREL_ERROR_NULL, "QUADREL_ERROR_NULL\0"),
    (QUADREL_ERROR_INVALID_ARGUMENT, "QUADREL_ERROR_INVALID_ARGUMENT\0"),
    (QUADREL_ERROR_CALLBACK, "QUADREL_ERROR_CALLBACK\0"),
    (QUADREL_ERROR_CANCELLED, "QUADREL_ERROR_CANCELLED\0"),
    (QUADREL_ERROR_OPEN_LOOP, "QUADREL_ERROR_OPEN_LOOP\0"),
    (QUADREL_ERROR_INTERSECTION, "QUADREL_ERROR_INTERSECTION\0"),
    (QUADREL_ERROR_NESTING, "QUADREL_ERROR_NESTING\0"),
    (QUADREL_ERROR_CUSP, "QUADREL_ERROR_CUSP\0"),
    (QUADREL_ERROR_DEGENERATE, "QUADREL_ERROR_DEGENERATE\0"),
    (QUADREL_ERROR_BASE_MESH, "QUADREL_ERROR_BASE_MESH\0"),
    (QUADREL_ERROR_CROSS_FIELD, "QUADREL_ERROR_CROSS_FIELD\0"),
    (QUADREL_ERROR_SEPARATRIX, "QUADREL_ERROR_SEPARATRIX\0"),
    (QUADREL_ERROR_LAYOUT, "QUADREL_ERROR_LAYOUT\0"),
    (QUADREL_ERROR_TOLERANCE, "QUADREL_ERROR_TOLERANCE\0"),
    (QUADREL_ERROR_INVALID_ELEMENT, "QUADREL_ERROR_INVALID_ELEMENT\0"),
    (QUADREL_ERROR_IO, "QUADREL_ERROR_IO\0"),
    (QUADREL_ERROR_UNSUPPORTED, "QUADREL_ERROR_UNSUPPORTED\0"),
    (QUADREL_ERROR_PARSE, "QUADREL_ERROR_PARSE\0"),
    (QUADREL_ERROR_INTERNAL, "QUADREL_ERROR_INTERNAL\0"),
];

/// The status that stands for an error.
pub fn status_of(error: &Error) -> quadrel_status {
    match error {
        Error::InvalidArgument { .. } => QUADREL_ERROR_INVALID_ARGUMENT,
        Error::Callback { .. } | Error::SizeFunction { .. } => QUADREL_ERROR_CALLBACK,
        Error::Cancelled => QUADREL_ERROR_CANCELLED,
        Error::OpenLoop { .. } => QUADREL_ERROR_OPEN_LOOP,
        Error::Intersection { .. } => QUADREL_ERROR_INTERSECTION,
        Error::Nesting { .. } => QUADREL_ERROR_NESTING,
        Error::Cusp { .. } => QUADREL_ERROR_CUSP,
        Error::Degenerate { .. } => QUADREL_ERROR_DEGENERATE,
        Error::BaseMesh { .. } => QUADREL_ERROR_BASE_MESH,
        Error::CrossField { .. } => QUADREL_ERROR_CROSS_FIELD,
        Error::Separatrix { .. } => QUADREL_ERROR_SEPARATRIX,
        Error::Layout { .. } => QUADREL_ERROR_LAYOUT,
        Error::Tolerance { .. } => QUADREL_ERROR_TOLERANCE,
        Error::InvalidElement { .. } => QUADREL_ERROR_INVALID_ELEMENT,
        Error::Io { .. } => QUADREL_ERROR_IO,
        Error::Unsupported { .. } => QUADREL_ERROR_UNSUPPORTED,
        Error::Parse { .. } => QUADREL_ERROR_PARSE,
        Error::Internal { .. } => QUADREL_ERROR_INTERNAL,
    }
}

pub const QUADREL_VERSION_MAJOR: u32 = 0;
pub const QUADREL_VERSION_MINOR: u32 = 1;
pub const QUADREL_VERSION_PATCH: u32 = 0;

/// Version of the linked library: major * 10000 + minor * 100 + patch. Compare it with the header's
/// QUADREL_VERSION_MAJOR, _MINOR and _PATCH.
#[no_mangle]
pub extern "C" fn quadrel_version_number() -> u32 {
    QUADREL_VERSION_MAJOR * 10_000 + QUADREL_VERSION_MINOR * 100 + QUADREL_VERSION_PATCH
}

/// Version of the linked library as text, "0.1.0". Lives for ever.
#[no_mangle]
pub extern "C" fn quadrel_version_string() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// Name of a status, "QUADREL_ERROR_LAYOUT"; "unknown status" for other numbers. Lives for ever.
#[no_mangle]
pub extern "C" fn quadrel_status_name(status: quadrel_status) -> *const c_char {
    let known = NAMES.iter().find(|(code, _)| *code == status);
    known.map_or("unknown status\0", |(_, name)| name).as_ptr().cast()
}

/// What failed last on this thread, in one sentence: cause, place, and what to do about it. Empty if nothing
/// has failed yet; never NULL. The pointer stays good while the thread lives; the text changes at the
/// next failure on this thread.
#[no_mangle]
pub extern "C" fn quadrel_last_error_message() -> *const c_char {
    last_error_text()
}

/// Where in the domain the last failure of this thread lies: writes the point to xy and returns 1, or
/// returns 0 if it has no place. xy may be NULL.
///
/// cbindgen:ptrs-as-arrays=[[xy;2]]
#[no_mangle]
pub unsafe extern "C" fn quadrel_last_error_location(xy: *mut f64) -> c_int {
    answer(0, || match last_error_location() {
        Some(place) => {
            // SAFETY: the caller gives NULL or room for two numbers.
            unsafe { copy_out(xy, &place) };
            1
        }
        None => 0,
    })
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        let place = error.place().map(|p| [p.x, p.y]);
        Failure { status: status_of(&error), text: error.to_string(), place }
    }
}
