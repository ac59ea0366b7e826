//! Which quads the proof refuses, so that they can be mended before the whole mesh is given up.

use super::high_order_mesh::{exact_nodes, exact_vertex};
use super::{ExactCurve, Geometry, JacobianProof, QuadMesh, Verdict};
use crate::domain::Boundary;
use crate::error::Result;
use crate::numerics::Point;

/// Those of `quads` whose Jacobian is not proven positive with boundary nodes on `curve`, at order `order`.
///
/// # Errors
/// What `curve` reports.
pub fn unproven(
    mesh: &QuadMesh,
    quads: impl IntoIterator<Item = u32>,
    boundary: &Boundary,
    curve: &dyn ExactCurve,
    order: usize,
) -> Result<Vec<u32>> {
    let geometry = Geometry::new(order);
    let len = geometry.edge_len();
    let mut edge_nodes = vec![Point::origin(); len * mesh.edges.len()];
    let mut known = vec![false; mesh.edges.len()];
    let mut proof = JacobianProof::new(order);
    let mut nodes = Vec::new();
    let mut refused = Vec::new();
    for q in quads {
        for e in mesh.quad_edges[q as usize].map(|e| e as usize) {
            if std::mem::replace(&mut known[e], true) {
                continue;
            }
            let edge = &mesh.edges[e];
            let [a, b] = edge.vertices.map(|v| exact_vertex(&mesh.vertices[v as usize], boundary, curve));
            let out = &mut edge_nodes[e * len..(e + 1) * len];
            exact_nodes(edge, [a?, b?], boundary, curve, &geometry, out)?;
        }
        geometry.element_nodes(mesh, &edge_nodes, q as usize, &mut nodes);
        if !matches!(proof.examine(&nodes), Verdict::Proven(_)) {
            refused.push(q);
        }
    }
    Ok(refused)
}
