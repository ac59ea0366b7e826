//! A base triangulation of the caller's own

use super::guard::array;
use super::options::{quadrel_options, set};
use super::status::quadrel_status;
use crate::options::{BaseTriangulation, BoundaryVertex};
use std::sync::Arc;

/// Sets the base mesh that generation starts from, instead of making one; it is copied. Triangles are
/// counter-clockwise. Each border vertex has a place on the domain's boundary: boundary holds its number, its
/// loop and its segment in that loop (counted as they were added), parameters holds t in [0, 1]; a vertex
/// between two segments may be there once or for both. Every corner and every change of name needs a vertex,
/// and border edges should turn with the boundary by less than 0.3 rad: the mesh is not refined.
///
/// It is checked against the domain by quadrel_generate: QUADREL_ERROR_BASE_MESH, with the place, if it does
/// not triangulate it. With three counts of 0 quadrel makes its own base mesh again (the default).
///
/// Shapes: vertices [vertex_count][2], triangles [triangle_count][3] vertices, boundary
/// [boundary_count][3] vertex, loop, segment, and parameters [boundary_count].
#[no_mangle]
pub unsafe extern "C" fn quadrel_options_set_base_triangulation(
    options: *mut quadrel_options,
    vertices: *const f64,
    vertex_count: usize,
    triangles: *const i32,
    triangle_count: usize,
    boundary: *const i32,
    parameters: *const f64,
    boundary_count: usize,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        set(options, |o| {
            let vertices: &[[f64; 2]] = array(vertices.cast(), vertex_count, "the vertices")?;
            let triangles: &[[i32; 3]] = array(triangles.cast(), triangle_count, "the triangles")?;
            let boundary: &[[i32; 3]] = array(boundary.cast(), boundary_count, "the boundary vertices")?;
            let parameters: &[f64] = array(parameters, boundary_count, "the parameters")?;
            // A negative number becomes one that no mesh has, and is refused with the others out of range.
            let unsigned = |row: &[i32; 3]| row.map(|i| i as u32);
            let place = |(row, t): (&[i32; 3], &f64)| {
                let [vertex, loop_index, segment] = unsigned(row);
                BoundaryVertex { vertex, loop_index, segment, t: *t }
            };
            let own = BaseTriangulation {
                vertices: vertices.to_vec(),
                triangles: triangles.iter().map(unsigned).collect(),
                boundary: boundary.iter().zip(parameters).map(place).collect(),
            };
            o.base_triangulation = (own != BaseTriangulation::default()).then(|| Arc::new(own));
            Ok(())
        })
    }
}
