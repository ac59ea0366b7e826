//! Mesh
//!
//! Arrays are read-only and live as long as the mesh. A node that elements share is there once.

use super::generate::quadrel_mesh;
use super::guard::answer;
use libc::c_char;
use std::ptr::null;

/// What `get` finds in the mesh; `otherwise` for NULL.
unsafe fn of<T: Copy>(mesh: *const quadrel_mesh, otherwise: T, get: impl FnOnce(&quadrel_mesh) -> T) -> T {
    // SAFETY: the caller's promise (first comment of the header).
    answer(otherwise, || unsafe { mesh.as_ref() }.map_or(otherwise, get))
}

/// Polynomial order N of the elements.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_order(mesh: *const quadrel_mesh) -> i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, 0, |m| m.mesh.order as i32) }
}

/// Number of vertices.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_vertex_count(mesh: *const quadrel_mesh) -> usize {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, 0, |m| m.mesh.vertices.len()) }
}

/// Number of elements.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_element_count(mesh: *const quadrel_mesh) -> usize {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, 0, |m| m.mesh.elements.len()) }
}

/// Number of edges.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_edge_count(mesh: *const quadrel_mesh) -> usize {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, 0, |m| m.mesh.edges.len()) }
}

/// Number of nodes, shared ones counted once.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_node_count(mesh: *const quadrel_mesh) -> usize {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, 0, |m| m.mesh.node_count()) }
}

/// The vertices, [vertex][2].
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_vertices(mesh: *const quadrel_mesh) -> *const f64 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.vertices.as_ptr()) }
}

/// The corners of each element, [element][4] vertices, counter-clockwise.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_elements(mesh: *const quadrel_mesh) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.elements.as_ptr()) }
}

/// The element across each side, [element][4] elements; -1 at the boundary.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_element_neighbors(mesh: *const quadrel_mesh) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.element_neighbors.as_ptr()) }
}

/// The edge at each side, [element][4] edges.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_element_edges(mesh: *const quadrel_mesh) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.element_edges.as_ptr()) }
}

/// The boundary at each side, [element][4] boundaries; -1 inside.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_element_boundaries(mesh: *const quadrel_mesh) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.element_boundaries.as_ptr()) }
}

/// The region of the block layout that each element comes from, [element].
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_element_blocks(mesh: *const quadrel_mesh) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.element_blocks.as_ptr()) }
}

/// The ends of each edge, [edge][2] vertices; on the boundary with the domain to the left.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_edge_vertices(mesh: *const quadrel_mesh) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.edge_vertices.as_ptr()) }
}

/// The elements to the left and to the right of each edge, [edge][2]; -1 outside the domain.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_edge_elements(mesh: *const quadrel_mesh) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.edge_elements.as_ptr()) }
}

/// Which side the edge is in each of these two, [edge][2], 0 to 3; -1 outside.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_edge_sides(mesh: *const quadrel_mesh) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.edge_sides.as_ptr()) }
}

/// The boundary of each edge, [edge]; -1 inside.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_edge_boundaries(mesh: *const quadrel_mesh) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.edge_boundaries.as_ptr()) }
}

/// The loop that each boundary edge lies on, [edge], counted as the loops were begun; -1 inside.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_edge_loops(mesh: *const quadrel_mesh) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.edge_loops.as_ptr()) }
}

/// The segment of that loop at each end of a boundary edge, [edge][2], counted in each loop as the segments
/// were added; -1 inside. They differ where an edge runs over a joint of segments.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_edge_segments(mesh: *const quadrel_mesh) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.edge_segments.as_ptr()) }
}

/// The parameter t on these segments at each end, [edge][2]: where the exact curve meets the vertex. It
/// falls along the edge where the loop was given with the domain to its right.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_edge_parameters(mesh: *const quadrel_mesh) -> *const f64 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.edge_parameters.as_ptr()) }
}

/// The nodes, [node][2]: the vertices first, then N - 1 of each edge from its first vertex to its second,
/// then (N - 1)^2 inside each element.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_nodes(mesh: *const quadrel_mesh) -> *const f64 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.nodes.as_ptr()) }
}

/// The nodes of each element, [element][j][i] with N + 1 of j and of i, i fastest.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_element_nodes(mesh: *const quadrel_mesh) -> *const i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.arrays.element_nodes.as_ptr()) }
}

/// The Gauss-Lobatto points in [-1, 1] that the nodes are the images of, [N + 1].
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_reference_nodes(mesh: *const quadrel_mesh) -> *const f64 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.mesh.reference_nodes.as_ptr()) }
}

/// Number of boundaries: of different names.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_boundary_count(mesh: *const quadrel_mesh) -> usize {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, 0, |m| m.names.len()) }
}

/// Name of a boundary; NULL if there is none of that number.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_boundary_name(
    mesh: *const quadrel_mesh,
    boundary: i32,
) -> *const c_char {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        of(mesh, null(), |m| {
            let name = usize::try_from(boundary).ok().and_then(|b| m.names.get(b));
            name.map_or(null(), |name| name.as_ptr())
        })
    }
}

/// The statistics of the run that made the mesh, as a JSON object: status, message, place, seconds (by stage,
/// and total), triangles, singularities, separatrices, blocks, elements, order, nodes, irregular (interior,
/// boundary), irregular_expected, scaled_jacobian (min, p1, mean), scaled_jacobian_ceiling, boundary_error
/// (max, loops), symmetry (domain, mesh: rotations, mirrors each; asymmetry), fallback, attempts, rounds,
/// warnings. The times are all in it that differs from run to run.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_statistics_json(mesh: *const quadrel_mesh) -> *const c_char {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { of(mesh, null(), |m| m.statistics.as_ptr()) }
}
