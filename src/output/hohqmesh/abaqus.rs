//! Abaqus meshes (`.inp`): corners and straight-sided `CPS4` elements for every reader, then the curves and
//! boundary names in HOHQMesh's comment section, which Trixi.jl reads.
//!
//! The heading says that HOHQMesh created the file: Trixi.jl looks for these very words before it reads
//! the curves. Names follow all curves, a line an element, its sides in p4est's order −x +x −y +y (4, 2, 1, 3).

use super::sides::Sides;
use crate::mesh::HighOrderMesh;
use std::fmt::Write;

/// What makes a line a comment to Abaqus.
const COMMENT: &str = "**  ";

/// The file's content.
pub fn render(mesh: &HighOrderMesh) -> Vec<u8> {
    let sides = Sides::new(mesh);
    let mut text = String::from("*Heading\n File created by HOHQMesh\n*NODE\n");
    for (k, p) in (1..).zip(&mesh.vertices) {
        let _ = writeln!(text, "{k}, {:?}, {:?}, 0.0", p.x, p.y);
    }
    text.push_str("*ELEMENT, type=CPS4, ELSET=Surface1\n");
    let corners = || mesh.elements.iter().map(|c| c.map(|v| v + 1));
    for (k, [a, b, c, d]) in (1..).zip(corners()) {
        let _ = writeln!(text, "{k}, {a}, {b}, {c}, {d}");
    }
    text.push_str("** ***** HOHQMesh boundary information ***** **\n");
    let _ = writeln!(text, "** mesh polynomial degree = {}", mesh.order);
    for (e, [a, b, c, d]) in corners().enumerate() {
        let _ = writeln!(text, "{COMMENT}{a} {b} {c} {d}");
        sides.write(&mut text, e, COMMENT);
    }
    for e in 0..mesh.elements.len() {
        let names = [3, 1, 0, 2].map(|s| sides.name(e, s));
        let _ = writeln!(text, "{COMMENT}{}", names.join(" "));
    }
    text.into_bytes()
}
