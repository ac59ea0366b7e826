//! VTK XML unstructured grids (`.vtu`), one `VTK_LAGRANGE_QUADRILATERAL` an element.
//!
//! Nodes are equispaced in VTK, so the mesh's Gauss-Lobatto nodes are interpolated anew; that
//! changes the curves by rounding only. A node that elements share is written once:
//! vertices first, then edges, then insides; so the mesh is conforming by index. Arrays:
//!
//! | cell data | type | meaning |
//! |---|---|---|
//! | `scaled_jacobian` | Float64 | minimum over the element of det J / (\|x_ξ\| \|x_η\|) |
//! | `jacobian_ratio` | Float64 | min / max of det J over the element |
//! | `block` | Int32 | the region of the layout that the element comes from |
//! | `boundary` | Int32 × 4 | for each side the boundary's number, −1 inside |
//! | `boundary_name` | String × 4 | for each side the boundary's name, empty inside |
//!
//! Arrays of numbers are zlib-compressed and base64-coded, each in its place (VTK file format 2.2; see the
//! VTK file formats documentation). None is appended at the end: Debian 12's ParaView 5.11 cannot read such files,
//! not even its own, since its expat is 2.5.0-1+deb12u2. There is no field data: MFEM refuses files with it.

mod encoding;
mod nodes;

pub use nodes::lagrange_index;

use super::equispaced::EquispacedNodes;
use crate::mesh::{HighOrderMesh, Quality};
use crate::numerics::NONE;
use nodes::in_lagrange_order;
use std::fmt::Write;

/// VTK's cell type number of an arbitrary-order Lagrange quadrilateral.
const VTK_LAGRANGE_QUADRILATERAL: u8 = 70;

/// The file's content.
pub fn render(mesh: &HighOrderMesh) -> Vec<u8> {
    let shared = EquispacedNodes::new(mesh);
    let cells = mesh.elements.len();
    let per_cell = (mesh.order + 1) * (mesh.order + 1);
    let mut xml = String::new();
    xml.push_str(concat!(
        "<?xml version=\"1.0\"?>\n",
        "<VTKFile type=\"UnstructuredGrid\" version=\"2.2\" byte_order=\"LittleEndian\" ",
        "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n",
        "<UnstructuredGrid>\n"
    ));
    let _ = writeln!(xml, "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{cells}\">", shared.points.len());

    xml.push_str("<CellData Scalars=\"scaled_jacobian\">\n");
    let array = |xml: &mut String, kind: Kind, name: &str, components: usize, bytes: Vec<u8>| {
        let components = match components {
            1 => String::new(),
            n => format!(" NumberOfComponents=\"{n}\""),
        };
        let kind = kind.name();
        let _ = writeln!(xml, "<DataArray type=\"{kind}\" Name=\"{name}\"{components} format=\"binary\">");
        encoding::push(xml, &bytes);
        xml.push_str("\n</DataArray>\n");
    };
    array(&mut xml, Kind::F64, "scaled_jacobian", 1, doubles(mesh.scaled_jacobian.iter().copied()));
    let quality = Quality::new(mesh.order);
    let ratios = mesh.nodes.chunks_exact(per_cell).map(|nodes| quality.jacobian_ratio(nodes));
    array(&mut xml, Kind::F64, "jacobian_ratio", 1, doubles(ratios));
    array(&mut xml, Kind::I32, "block", 1, integers(mesh.blocks.iter().copied()));
    let sides = mesh.element_edges.iter().flatten().map(|&e| mesh.edges[e as usize].boundary);
    array(&mut xml, Kind::I32, "boundary", 4, integers(sides));
    boundary_names(&mut xml, mesh);
    xml.push_str("</CellData>\n<Points>\n");
    let coordinates = shared.points.iter().flat_map(|p| [p.x, p.y, 0.0]);
    array(&mut xml, Kind::F64, "Points", 3, doubles(coordinates));
    xml.push_str("</Points>\n<Cells>\n");
    let connectivity =
        shared.numbers.chunks_exact(per_cell).flat_map(|numbers| in_lagrange_order(mesh.order, numbers));
    array(&mut xml, Kind::I64, "connectivity", 1, longs(connectivity.map(i64::from)));
    array(&mut xml, Kind::I64, "offsets", 1, longs((1..=cells).map(|c| (c * per_cell) as i64)));
    array(&mut xml, Kind::U8, "types", 1, vec![VTK_LAGRANGE_QUADRILATERAL; cells]);
    xml.push_str("</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n");
    xml.into_bytes()
}

/// Element types of arrays, by VTK's names.
#[derive(Clone, Copy)]
enum Kind {
    F64,
    I32,
    I64,
    U8,
}

impl Kind {
    fn name(self) -> &'static str {
        match self {
            Kind::F64 => "Float64",
            Kind::I32 => "Int32",
            Kind::I64 => "Int64",
            Kind::U8 => "UInt8",
        }
    }
}

/// VTK string arrays in XML are character codes, each string ended by a 0; one line an element.
fn boundary_names(xml: &mut String, mesh: &HighOrderMesh) {
    let coded = |name: &String| name.bytes().filter(|&b| b != 0).map(|b| format!("{b} ")).collect::<String>();
    let codes: Vec<String> = mesh.boundary_names.iter().map(coded).collect();
    xml.push_str(
        "<Array type=\"String\" Name=\"boundary_name\" NumberOfComponents=\"4\" format=\"ascii\">\n",
    );
    for sides in &mesh.element_edges {
        let code =
            |edge: u32| codes.get(mesh.edges[edge as usize].boundary as usize).map_or("", String::as_str);
        let [a, b, c, d] = sides.map(code);
        let _ = writeln!(xml, "{a}0 {b}0 {c}0 {d}0");
    }
    xml.push_str("</Array>\n");
}

fn doubles(values: impl Iterator<Item = f64>) -> Vec<u8> {
    values.flat_map(f64::to_le_bytes).collect()
}

fn longs(values: impl Iterator<Item = i64>) -> Vec<u8> {
    values.flat_map(i64::to_le_bytes).collect()
}

/// Indices as signed numbers, "none" as −1.
fn integers(values: impl Iterator<Item = u32>) -> Vec<u8> {
    values.flat_map(|v| (if v == NONE { -1 } else { v as i32 }).to_le_bytes()).collect()
}
