//! Stages
//!
//! What each stage of a run made, for plots and diagnosis; filled also where generation fails.

use super::generate::quadrel_stages;
use super::guard::answer;
use super::progress::{number_of, quadrel_stage, QUADREL_STAGE_DOMAIN, QUADREL_STAGE_NONE};
use libc::c_char;
use std::ptr::null;

/// What `get` finds in the stages; `otherwise` for NULL.
unsafe fn of<T: Copy>(
    stages: *const quadrel_stages,
    otherwise: T,
    get: impl FnOnce(&quadrel_stages) -> T,
) -> T {
    // SAFETY: the caller's promise (first comment of the header).
    answer(otherwise, || unsafe { stages.as_ref() }.map_or(otherwise, get))
}

/// Address of an array; NULL where the stage was not reached and there is nothing.
fn lent<T>(values: &[T]) -> *const T {
    if values.is_empty() {
        null()
    } else {
        values.as_ptr()
    }
}

/// The last stage that finished.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_reached(stages: *const quadrel_stages) -> quadrel_stage {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, QUADREL_STAGE_NONE, |s| s.stages.reached.map_or(QUADREL_STAGE_NONE, number_of)) }
}

/// Seconds spent in a stage; 0 for an unknown one.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_seconds(stages: *const quadrel_stages, stage: quadrel_stage) -> f64 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        of(stages, 0.0, |s| {
            let index = usize::try_from(stage.saturating_sub(QUADREL_STAGE_DOMAIN)).ok();
            index.and_then(|k| s.stages.seconds.get(k).copied()).unwrap_or(0.0)
        })
    }
}

/// The statistics of the run, with the keys of quadrel_mesh_statistics_json: what was not reached is null,
/// and status, message and place tell the failure. NULL before the first run.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_statistics_json(stages: *const quadrel_stages) -> *const c_char {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, null(), |s| s.statistics.as_ref().map_or(null(), |text| text.as_ptr())) }
}

/// Number of vertices of the base mesh.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_base_vertex_count(stages: *const quadrel_stages) -> usize {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, 0, |s| s.arrays.base_vertices.len() / 2) }
}

/// Number of triangles of the base mesh.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_base_triangle_count(stages: *const quadrel_stages) -> usize {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, 0, |s| s.arrays.base_triangles.len() / 3) }
}

/// Vertices of the base mesh, [vertex][2].
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_base_vertices(stages: *const quadrel_stages) -> *const f64 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, null(), |s| lent(&s.arrays.base_vertices)) }
}

/// Triangles of the base mesh, [triangle][3] vertices, counter-clockwise.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_base_triangles(stages: *const quadrel_stages) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, null(), |s| lent(&s.arrays.base_triangles)) }
}

/// The cross field at the base vertices, [vertex][2]: (cos 4a, sin 4a) of the angle a of an arm, as solved.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_cross_field(stages: *const quadrel_stages) -> *const f64 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, null(), |s| lent(&s.arrays.cross_field)) }
}

/// Number of interior singularities.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_singularity_count(stages: *const quadrel_stages) -> usize {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, 0, |s| s.arrays.singularity_valences.len()) }
}

/// Where they are, [singularity][2].
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_singularity_points(stages: *const quadrel_stages) -> *const f64 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, null(), |s| lent(&s.arrays.singularity_points)) }
}

/// Their valences, [singularity]: how many elements meet there, 3 or 5.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_singularity_valences(stages: *const quadrel_stages) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, null(), |s| lent(&s.arrays.singularity_valences)) }
}

/// Number of corners of the boundary.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_corner_count(stages: *const quadrel_stages) -> usize {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, 0, |s| s.arrays.corner_quads.len()) }
}

/// Where they are, [corner][2].
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_corner_points(stages: *const quadrel_stages) -> *const f64 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, null(), |s| lent(&s.arrays.corner_points)) }
}

/// Their angles through the domain, [corner].
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_corner_angles(stages: *const quadrel_stages) -> *const f64 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, null(), |s| lent(&s.arrays.corner_angles)) }
}

/// How many elements the field wants at each corner, [corner]; 0 where it is so sharp that a triangle is left to
/// be repaired.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_corner_quads(stages: *const quadrel_stages) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, null(), |s| lent(&s.arrays.corner_quads)) }
}

/// Number of separatrices.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_separatrix_count(stages: *const quadrel_stages) -> usize {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, 0, |s| s.arrays.separatrices.count()) }
}

/// Where each separatrix begins among the points, [separatrix + 1]; the last entry is their number.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_separatrix_offsets(stages: *const quadrel_stages) -> *const usize {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, null(), |s| lent(&s.arrays.separatrices.offsets)) }
}

/// The polylines of the separatrices, [point][2].
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_separatrix_points(stages: *const quadrel_stages) -> *const f64 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, null(), |s| lent(&s.arrays.separatrices.points)) }
}

/// Number of regions between the separatrices.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_block_count(stages: *const quadrel_stages) -> usize {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, 0, |s| s.arrays.blocks.count()) }
}

/// Where the outline of each region begins among the points, [block + 1].
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_block_offsets(stages: *const quadrel_stages) -> *const usize {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, null(), |s| lent(&s.arrays.blocks.offsets)) }
}

/// The outlines, counter-clockwise, [point][2]; the last point of each is its first.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_block_points(stages: *const quadrel_stages) -> *const f64 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, null(), |s| lent(&s.arrays.blocks.points)) }
}

/// Number of sides of each region, [block]; T-junctions are no corners.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_block_sides(stages: *const quadrel_stages) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(stages, null(), |s| lent(&s.arrays.block_sides)) }
}
