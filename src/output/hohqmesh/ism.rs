//! ISM meshes (`.mesh`) in HOHQMesh's three versions.
//!
//! | | first line | after the corners | an element's first line |
//! |---|---|---|---|
//! | ISM | sizes and order | | its corners |
//! | ISM-v2 | `ISM-V2` | the edges | its corners |
//! | ISM-MM | `ISM-MM` | | its corners and its material |
//!
//! An edge of ISM-v2 is its first and last corner, the elements to its left and right (0: none), and the
//! side of each, the right one negative where the two sides run against each other. ISM-MM counts the
//! edges in its second line without listing them, as HOHQMesh's own files do.

use super::sides::{side_corners, Sides};
use crate::mesh::HighOrderMesh;
use crate::numerics::NONE;
use std::fmt::Write;

/// The material of all elements.
const MATERIAL: &str = "base";

/// Which ISM.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Version {
    /// Without edges.
    Ism,
    /// With edges.
    V2,
    /// With materials.
    MultipleMaterials,
}

/// The file's content.
pub fn render(mesh: &HighOrderMesh, version: Version) -> Vec<u8> {
    let sides = Sides::new(mesh);
    let (vertices, edges, elements) = (mesh.vertices.len(), mesh.edges.len(), mesh.elements.len());
    let mut text = match version {
        Version::Ism => format!("{vertices} {elements} {}\n", mesh.order),
        Version::V2 => format!("ISM-V2\n{vertices} {edges} {elements} {}\n", mesh.order),
        Version::MultipleMaterials => format!("ISM-MM\n{vertices} {edges} {elements} {}\n", mesh.order),
    };
    for p in &mesh.vertices {
        let _ = writeln!(text, "{:?} {:?} 0.0", p.x, p.y);
    }
    if version == Version::V2 {
        write_edges(&mut text, mesh);
    }
    for (e, [a, b, c, d]) in mesh.elements.iter().map(|c| c.map(|v| v + 1)).enumerate() {
        let _ = match version {
            Version::MultipleMaterials => writeln!(text, "{a} {b} {c} {d} {MATERIAL}"),
            _ => writeln!(text, "{a} {b} {c} {d}"),
        };
        sides.write(&mut text, e, "");
        let names = [0, 1, 2, 3].map(|s| sides.name(e, s));
        let _ = writeln!(text, "{}", names.join(" "));
    }
    text.into_bytes()
}

fn write_edges(text: &mut String, mesh: &HighOrderMesh) {
    for (edge, [left, right]) in mesh.edges.iter().zip(mesh.edge_sides()) {
        let corners = |k: usize, side: u32| {
            side_corners(side as usize).map(|c| mesh.elements[edge.elements[k] as usize][c])
        };
        let ends = corners(0, left);
        let (element, side) = match right {
            NONE => (0, 0),
            _ if corners(1, right) == ends => (edge.elements[1] + 1, right as i32 + 1),
            _ => (edge.elements[1] + 1, -(right as i32 + 1)),
        };
        let [a, b] = ends.map(|v| v + 1);
        let _ = writeln!(text, "{a} {b} {} {element} {} {side}", edge.elements[0] + 1, left + 1);
    }
}
