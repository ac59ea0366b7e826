//! Quality
//!
//! Measures of whole elements: minima and maxima are over the curved element, not at its corners.

use super::generate::quadrel_mesh;
use super::guard::{guard, required, Failure};
use super::status::quadrel_status;
use crate::mesh::{ElementMeasures, HighOrderMesh, Quality};

/// What is measured.
pub type quadrel_measure = i32;

/// minimum of det J / (|x_xi| |x_eta|); 1 where the grid is square
pub const QUADREL_MEASURE_SCALED_JACOBIAN: quadrel_measure = 0;
/// least angle between the grid directions, in radians
pub const QUADREL_MEASURE_MIN_ANGLE: quadrel_measure = 1;
/// largest angle between the grid directions, in radians
pub const QUADREL_MEASURE_MAX_ANGLE: quadrel_measure = 2;
/// mean length of the longer pair of opposite sides by that of the shorter
pub const QUADREL_MEASURE_ASPECT_RATIO: quadrel_measure = 3;
/// length of the longest side by that of the shortest
pub const QUADREL_MEASURE_EDGE_RATIO: quadrel_measure = 4;
/// maximum of (|x_xi|^2 + |x_eta|^2) / (2 det J); 1 where the grid is square and equally spaced
pub const QUADREL_MEASURE_CONDITION: quadrel_measure = 5;
/// area, in the unit of length squared
pub const QUADREL_MEASURE_AREA: quadrel_measure = 6;
/// largest error of the element's boundary edges, in the norm of the tolerance; 0 without boundary edges
pub const QUADREL_MEASURE_BOUNDARY_ERROR: quadrel_measure = 7;
/// least det J by the largest
pub const QUADREL_MEASURE_JACOBIAN_RATIO: quadrel_measure = 8;

/// A measure of every element.
fn measured(mesh: &HighOrderMesh, measure: quadrel_measure) -> Result<Vec<f64>, Failure> {
    let get: fn(ElementMeasures) -> f64 = match measure {
        QUADREL_MEASURE_SCALED_JACOBIAN => return Ok(mesh.scaled_jacobian.clone()),
        QUADREL_MEASURE_BOUNDARY_ERROR => return Ok(mesh.element_boundary_errors()),
        QUADREL_MEASURE_MIN_ANGLE => |m| m.min_angle,
        QUADREL_MEASURE_MAX_ANGLE => |m| m.max_angle,
        QUADREL_MEASURE_ASPECT_RATIO => |m| m.aspect_ratio,
        QUADREL_MEASURE_EDGE_RATIO => |m| m.edge_ratio,
        QUADREL_MEASURE_CONDITION => |m| m.condition,
        QUADREL_MEASURE_AREA => |m| m.area,
        QUADREL_MEASURE_JACOBIAN_RATIO => |m| m.jacobian_ratio,
        _ => return Err(Failure::argument("the measure", measure, "a QUADREL_MEASURE number")),
    };
    let quality = Quality::new(mesh.order);
    Ok((0..mesh.elements.len()).map(|e| get(quality.measure(mesh.element_nodes(e)))).collect())
}

/// Writes a measure (a QUADREL_MEASURE number) of every element to out [element]; count is the room there and
/// has to be the number of elements.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_quality(
    mesh: *const quadrel_mesh,
    measure: quadrel_measure,
    out: *mut f64,
    count: usize,
) -> quadrel_status {
    guard(|| {
        // SAFETY: the caller's promise (first comment of the header).
        let mesh = &unsafe { required(mesh, "the mesh") }?.mesh;
        if out.is_null() {
            return Err(Failure::null("out"));
        }
        if count != mesh.elements.len() {
            return Err(Failure::argument("count", count, "the number of elements"));
        }
        let values = measured(mesh, measure)?;
        // SAFETY: as above; the values are as many as count says.
        unsafe { super::guard::copy_out(out, &values) };
        Ok(())
    })
}

/// Least, largest and mean value of a measure over all elements; min, max and mean may be NULL.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_quality_range(
    mesh: *const quadrel_mesh,
    measure: quadrel_measure,
    min: *mut f64,
    max: *mut f64,
    mean: *mut f64,
) -> quadrel_status {
    guard(|| {
        // SAFETY: the caller's promise (first comment of the header).
        let values = measured(&unsafe { required(mesh, "the mesh") }?.mesh, measure)?;
        let results = [
            (min, values.iter().copied().fold(f64::INFINITY, f64::min)),
            (max, values.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
            (mean, values.iter().sum::<f64>() / values.len() as f64),
        ];
        for (to, value) in results {
            // SAFETY: as above.
            unsafe { super::guard::copy_out(to, &[value]) };
        }
        Ok(())
    })
}
