//! Progress

use super::callback::User;
use super::domain::quadrel_destroy_fn;
use super::options::{quadrel_options, set};
use super::status::quadrel_status;
use crate::progress::{Progress, Stage};
use libc::{c_int, c_void};

/// The stages, in running order.
pub type quadrel_stage = i32;

/// before the first
pub const QUADREL_STAGE_NONE: quadrel_stage = 0;
/// boundary curves are checked and measured
pub const QUADREL_STAGE_DOMAIN: quadrel_stage = 1;
/// the domain is triangulated
pub const QUADREL_STAGE_BASE_MESH: quadrel_stage = 2;
/// crosses that follow the boundary are spread over the domain
pub const QUADREL_STAGE_CROSS_FIELD: quadrel_stage = 3;
/// its singularities are found
pub const QUADREL_STAGE_SINGULARITIES: quadrel_stage = 4;
/// separatrices are traced from singularities and corners
pub const QUADREL_STAGE_SEPARATRICES: quadrel_stage = 5;
/// the regions between them become conforming blocks
pub const QUADREL_STAGE_LAYOUT: quadrel_stage = 6;
/// edges are divided, and elements joined, as the tolerance allows
pub const QUADREL_STAGE_REFINE: quadrel_stage = 7;
/// elements are smoothed
pub const QUADREL_STAGE_SMOOTH: quadrel_stage = 8;
/// the curved elements are made and proven valid
pub const QUADREL_STAGE_MESH: quadrel_stage = 9;

/// Called now and then with the stage that runs and the share of the whole run that is done, which grows from
/// 0 to 1. Returns 0, or non-zero to stop: quadrel_generate then returns QUADREL_ERROR_CANCELLED.
pub type quadrel_progress_fn =
    Option<unsafe extern "C" fn(user: *mut c_void, stage: quadrel_stage, fraction: f64) -> c_int>;

/// The number of a stage.
pub(super) fn number_of(stage: Stage) -> quadrel_stage {
    stage as quadrel_stage + QUADREL_STAGE_DOMAIN
}

/// Who is told how far the run is and may stop it; NULL: nobody (then too user is destroyed).
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_set_progress(
    options: *mut quadrel_options,
    progress: quadrel_progress_fn,
    user: *mut c_void,
    destroy: quadrel_destroy_fn,
) -> quadrel_status {
    let user = User::new(user, destroy);
    let progress = progress.map_or_else(Progress::default, |report| {
        Progress::new(move |stage, fraction| {
            // SAFETY: the function and its user pointer came together from the caller.
            unsafe { report(user.pointer(), number_of(stage), fraction) == 0 }
        })
    });
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        set(options, |o| {
            o.progress = progress;
            Ok(())
        })
    }
}
