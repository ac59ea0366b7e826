//! Options
//!
//! A new object holds the defaults; quadrel_generate takes NULL for them. A value out of range fails at once
//! and changes nothing.

use super::guard::{free, guard, required_mut, Failure};
use super::status::quadrel_status;
use crate::options::{Effort, FieldMethod, Norm, Options, Subdivision, Tolerance};

/// What steers the generation.
#[derive(Default)]
pub struct quadrel_options {
    pub(super) options: Options,
}

/// The norm of the boundary error e(s) of an edge, s the arc length.
pub type quadrel_norm = i32;

/// (integral of |e|^2 ds)^(1/2); unit length^(3/2)
pub const QUADREL_NORM_L2: quadrel_norm = 0;
/// (integral of |e|^2 + L^2 |e'|^2 ds)^(1/2), L the edge's length; unit length^(3/2)
pub const QUADREL_NORM_H1: quadrel_norm = 1;
/// max |e|; unit length
pub const QUADREL_NORM_MAX: quadrel_norm = 2;

/// Which cross field.
pub type quadrel_field = i32;

/// Laplace, then steps that keep singularities apart
pub const QUADREL_FIELD_DIFFUSED: quadrel_field = 0;
/// Laplace alone
pub const QUADREL_FIELD_HARMONIC: quadrel_field = 1;

/// How boundary edges are divided until the tolerance holds.
pub type quadrel_subdivision = i32;

/// where the error is the same on all edges of a chain; few elements
pub const QUADREL_SUBDIVISION_EQUAL_ERROR: quadrel_subdivision = 0;
/// at the middle; nothing is coarsened afterwards
pub const QUADREL_SUBDIVISION_HALVING: quadrel_subdivision = 1;

/// What becomes of a domain's mirrors and rotations.
pub type quadrel_symmetry = i32;

/// they count for nothing
pub const QUADREL_SYMMETRY_IGNORED: quadrel_symmetry = 0;
/// the mesh has them, to rounding, if such a mesh is found that is not clearly worse
pub const QUADREL_SYMMETRY_KEPT: quadrel_symmetry = 1;

/// How much work fewer elements are worth: a QUADREL_EFFORT number.
pub type quadrel_effort = i32;

/// About two thirds of the time, for about 5 % more elements.
pub const QUADREL_EFFORT_FAST: quadrel_effort = 0;
/// The default.
pub const QUADREL_EFFORT_DEFAULT: quadrel_effort = 1;
/// The best of four meshes: about four times the time, for about 6 % fewer elements.
pub const QUADREL_EFFORT_BEST: quadrel_effort = 2;

/// Options with their defaults.
#[no_mangle]
pub extern "C" fn quadrel_options_new() -> *mut quadrel_options {
    Box::into_raw(Box::default())
}

/// Frees options.
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_free(options: *mut quadrel_options) {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { free(options) }
}

/// Makes a change, unless it leaves a value out of range.
pub(super) unsafe fn set(
    options: *mut quadrel_options,
    change: impl FnOnce(&mut Options) -> Result<(), Failure>,
) -> quadrel_status {
    guard(|| {
        // SAFETY: the caller's promise (first comment of the header).
        let own = unsafe { required_mut(options, "the options") }?;
        let mut changed = own.options.clone();
        change(&mut changed)?;
        changed.check()?;
        own.options = changed;
        Ok(())
    })
}

/// Polynomial order N of the elements, 1 to 32; default 5.
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_set_order(
    options: *mut quadrel_options,
    order: i32,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        set(options, |o| {
            o.order = usize::try_from(order)
                .map_err(|_| Failure::argument("the polynomial order", order, "1 to 32"))?;
            Ok(())
        })
    }
}

fn norm_of(norm: quadrel_norm) -> Result<Norm, Failure> {
    match norm {
        QUADREL_NORM_L2 => Ok(Norm::L2),
        QUADREL_NORM_H1 => Ok(Norm::H1),
        QUADREL_NORM_MAX => Ok(Norm::Max),
        _ => Err(Failure::argument("the norm", norm, "a QUADREL_NORM number")),
    }
}

/// Largest error of each boundary edge against the exact curve, in the unit of norm (a QUADREL_NORM number).
/// Default: relative 1e-5 in L2.
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_set_tolerance(
    options: *mut quadrel_options,
    tolerance: f64,
    norm: quadrel_norm,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        set(options, |o| {
            (o.tolerance, o.norm) = (Tolerance::Absolute(tolerance), norm_of(norm)?);
            Ok(())
        })
    }
}

/// The same for the domain scaled to a bounding-box diagonal of 1 (of its least bounding box, so that turning
/// the domain changes nothing).
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_set_relative_tolerance(
    options: *mut quadrel_options,
    tolerance: f64,
    norm: quadrel_norm,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        set(options, |o| {
            (o.tolerance, o.norm) = (Tolerance::Relative(tolerance), norm_of(norm)?);
            Ok(())
        })
    }
}

/// Which cross field, a QUADREL_FIELD number; default QUADREL_FIELD_DIFFUSED. Where the mesh that comes of it has an
/// element below 0.6 of the best possible scaled Jacobian, or there is none, the other one is tried, too.
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_set_field(
    options: *mut quadrel_options,
    field: quadrel_field,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        set(options, |o| {
            o.field = match field {
                QUADREL_FIELD_DIFFUSED => FieldMethod::Diffused,
                QUADREL_FIELD_HARMONIC => FieldMethod::Harmonic,
                _ => return Err(Failure::argument("the field", field, "a QUADREL_FIELD number")),
            };
            Ok(())
        })
    }
}

/// How boundary edges are divided, a QUADREL_SUBDIVISION number; default QUADREL_SUBDIVISION_EQUAL_ERROR.
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_set_subdivision(
    options: *mut quadrel_options,
    subdivision: quadrel_subdivision,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        set(options, |o| {
            o.subdivision = match subdivision {
                QUADREL_SUBDIVISION_EQUAL_ERROR => Subdivision::EqualError,
                QUADREL_SUBDIVISION_HALVING => Subdivision::Halving,
                _ => {
                    let allowed = "a QUADREL_SUBDIVISION number";
                    return Err(Failure::argument("the subdivision", subdivision, allowed));
                }
            };
            Ok(())
        })
    }
}

/// What becomes of the domain's mirrors and rotations; default QUADREL_SYMMETRY_KEPT. A size function or a base
/// triangulation, which know nothing of them, switch it off. The statistics tell which the domain and the mesh have.
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_set_symmetry(
    options: *mut quadrel_options,
    symmetry: quadrel_symmetry,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        set(options, |o| {
            o.symmetry = match symmetry {
                QUADREL_SYMMETRY_IGNORED => false,
                QUADREL_SYMMETRY_KEPT => true,
                _ => return Err(Failure::argument("the symmetry", symmetry, "a QUADREL_SYMMETRY number")),
            };
            Ok(())
        })
    }
}

/// How much work fewer elements are worth, a QUADREL_EFFORT number; default QUADREL_EFFORT_DEFAULT. Validity, tolerance,
/// quality floor and sizes hold with any.
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_set_effort(
    options: *mut quadrel_options,
    effort: quadrel_effort,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        set(options, |o| {
            o.effort = match effort {
                QUADREL_EFFORT_FAST => Effort::Fast,
                QUADREL_EFFORT_DEFAULT => Effort::Default,
                QUADREL_EFFORT_BEST => Effort::Best,
                _ => return Err(Failure::argument("the effort", effort, "a QUADREL_EFFORT number")),
            };
            Ok(())
        })
    }
}

/// A length, 0 for none.
fn length(value: f64) -> Option<f64> {
    (value != 0.0).then_some(value)
}

/// Largest wanted size of the elements: the longer of the mean lengths of opposite sides; default 0: no limit.
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_set_max_element_size(
    options: *mut quadrel_options,
    size: f64,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        set(options, |o| {
            o.max_element_size = length(size);
            Ok(())
        })
    }
}

/// Wanted size of the base mesh's triangles; default 0: automatic.
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_set_base_mesh_size(
    options: *mut quadrel_options,
    size: f64,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        set(options, |o| {
            o.base_mesh_size = length(size);
            Ok(())
        })
    }
}

/// Share in (0, 1) of the best possible scaled Jacobian that coarsening takes no element below; default 0.8.
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_set_quality_floor(
    options: *mut quadrel_options,
    floor: f64,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        set(options, |o| {
            o.quality_floor = floor;
            Ok(())
        })
    }
}

/// Most elements allowed, at least 1; default 1000000. A mesh that needs more is QUADREL_ERROR_LAYOUT.
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_set_max_elements(
    options: *mut quadrel_options,
    limit: usize,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        set(options, |o| {
            o.max_elements = limit;
            Ok(())
        })
    }
}
