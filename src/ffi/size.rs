//! Element size

use super::callback::User;
use super::domain::quadrel_destroy_fn;
use super::options::{quadrel_options, set};
use super::status::quadrel_status;
use crate::options::SizeFunction;
use libc::{c_int, c_void};

/// Writes the largest wanted element size at the point xy to size: a finite length above 0. Returns 0, or
/// non-zero to give up: quadrel_generate then returns QUADREL_ERROR_CALLBACK, as it does for other values.
///
/// cbindgen:ptrs-as-arrays=[[xy;2]]
pub type quadrel_size_fn =
    Option<unsafe extern "C" fn(user: *mut c_void, xy: *const f64, size: *mut f64) -> c_int>;

/// Element size as a function of the place; where quadrel_options_set_max_element_size or the domain ask for
/// less, that holds. NULL: no limit (then too user is destroyed). It is called for points of the domain only.
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_set_size_function(
    options: *mut quadrel_options,
    size: quadrel_size_fn,
    user: *mut c_void,
    destroy: quadrel_destroy_fn,
) -> quadrel_status {
    let user = User::new(user, destroy);
    let function = size.map(|ask| {
        SizeFunction::fallible(move |xy| {
            let mut size = f64::NAN;
            // SAFETY: the function and its user pointer came together from the caller.
            match unsafe { ask(user.pointer(), xy.as_ptr(), &mut size) } {
                0 => Ok(size),
                code => Err(format!("the callback returned {code}")),
            }
        })
    });
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        set(options, |o| {
            o.element_size = function;
            Ok(())
        })
    }
}
