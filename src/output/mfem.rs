//! MFEM meshes, version 1.0, curved: nodes as a grid function on `H1_2D_PN`, whose basis MFEM takes at
//! the Gauss-Lobatto points: the mesh's own nodes, to the last bit.
//!
//! Elements have attribute 1; boundary edges the number of their boundary from 1, listed with the names
//! in comments, for the format has no place for names. The grid function's values are those at the
//! vertices, then those inside the edges (each from its lower vertex to its higher one), then those
//! inside the elements. MFEM numbers edges in the order in which the elements' sides name them first.
//!
//! Reference: MFEM's documentation, *Mesh formats*, *MFEM mesh v1.0*; *Curvilinear VTK and MFEM meshes*.

use super::labels;
use crate::mesh::HighOrderMesh;
use crate::numerics::{Point, NONE};
use std::fmt::Write;

/// MFEM's geometry numbers.
const SEGMENT: u32 = 1;
const SQUARE: u32 = 3;
/// No boundary has more bytes in its name than this in the comments.
const LONGEST_NAME: usize = 255;

/// The file's content.
pub fn render(mesh: &HighOrderMesh) -> Vec<u8> {
    let mut text = String::from("MFEM mesh v1.0\n\n# Boundary attributes:\n");
    for (k, name) in (1..).zip(labels::quotable(&mesh.boundary_names, LONGEST_NAME)) {
        let _ = writeln!(text, "# {k} \"{name}\"");
    }
    let _ = writeln!(text, "\ndimension\n2\n\nelements\n{}", mesh.elements.len());
    for [a, b, c, d] in &mesh.elements {
        let _ = writeln!(text, "1 {SQUARE} {a} {b} {c} {d}");
    }
    let border = || mesh.edges.iter().filter(|e| e.elements[1] == NONE);
    let _ = writeln!(text, "\nboundary\n{}", border().count());
    for edge in border() {
        // Attributes are positive; an edge without a name gets the one after all names.
        let attribute = (edge.boundary as usize).min(mesh.boundary_names.len()) + 1;
        let [a, b] = edge.vertices;
        let _ = writeln!(text, "{attribute} {SEGMENT} {a} {b}");
    }
    let _ = writeln!(
        text,
        "\nvertices\n{}\n\nnodes\nFiniteElementSpace\nFiniteElementCollection: H1_2D_P{}\nVDim: 2\nOrdering: 1\n",
        mesh.vertices.len(),
        mesh.order
    );
    for p in grid_function(mesh) {
        let _ = writeln!(text, "{:?} {:?}", p.x, p.y);
    }
    text.into_bytes()
}

/// The nodes in MFEM's order.
fn grid_function(mesh: &HighOrderMesh) -> Vec<Point> {
    let n = mesh.order;
    let mut points = mesh.vertices.clone();
    let mut seen = vec![false; mesh.edges.len()];
    for (e, sides) in mesh.element_edges.iter().enumerate() {
        for (s, &edge) in sides.iter().enumerate() {
            if !std::mem::replace(&mut seen[edge as usize], true) {
                let upwards = mesh.elements[e][s] < mesh.elements[e][(s + 1) % 4];
                points.extend((1..n).map(|k| mesh.side_node(e, s, if upwards { k } else { n - k })));
            }
        }
    }
    for e in 0..mesh.elements.len() {
        let own = mesh.element_nodes(e);
        points.extend((1..n).flat_map(|j| (1..n).map(move |i| own[j * (n + 1) + i])));
    }
    points
}
