//! The formats that a mesh can be written in: names, extensions, what they can hold.

use super::hohqmesh::Version;
use super::{gmsh, hohqmesh, mfem, svg, vtu};
use crate::error::{Error, Result};
use crate::mesh::HighOrderMesh;
use std::path::Path;

/// A file format that a mesh can be written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// VTK XML unstructured grid of Lagrange quadrilaterals, for ParaView, VTK and MFEM.
    Vtu,
    /// Gmsh 4.1, text, orders 1 to 10.
    Msh,
    /// HOHQMesh's ISM: corners and curved sides.
    Ism,
    /// HOHQMesh's ISM-v2: the same with a list of edges, for Trixi.jl and others.
    IsmV2,
    /// HOHQMesh's ISM-MM: the same with a material for each element.
    IsmMm,
    /// Abaqus with HOHQMesh's curves in comments, for Trixi.jl.
    Inp,
    /// MFEM mesh v1.0 with nodes at the Gauss-Lobatto points.
    Mfem,
    /// A picture.
    Svg,
}

/// The extension `.mesh` is both HOHQMesh's and MFEM's; domains come from HOHQMesh's control files, so a file
/// that ends so is what its readers take.
const MESH_EXTENSION: (&str, Format) = ("mesh", Format::IsmV2);

impl Format {
    /// All formats.
    pub const ALL: [Format; 8] = [
        Format::Vtu,
        Format::Msh,
        Format::Ism,
        Format::IsmV2,
        Format::IsmMm,
        Format::Inp,
        Format::Mfem,
        Format::Svg,
    ];

    /// Its name, which is also a file name extension.
    pub fn name(self) -> &'static str {
        match self {
            Format::Vtu => "vtu",
            Format::Msh => "msh",
            Format::Ism => "ism",
            Format::IsmV2 => "ism-v2",
            Format::IsmMm => "ism-mm",
            Format::Inp => "inp",
            Format::Mfem => "mfem",
            Format::Svg => "svg",
        }
    }

    /// The format of that name (`vtu`), in any case.
    ///
    /// # Errors
    /// [`Error::Unsupported`], naming the formats that exist.
    pub fn from_name(name: &str) -> Result<Format> {
        Self::ALL.into_iter().find(|f| f.name().eq_ignore_ascii_case(name)).ok_or_else(|| {
            let known = Self::ALL.map(Format::name).join(", ");
            Error::Unsupported {
                what: format!("the mesh format `{name}` is not known; choose one of {known}"),
            }
        })
    }

    /// The format that the extension of `path` stands for: a format's name, or `mesh` for ISM-v2.
    ///
    /// # Errors
    /// [`Error::Unsupported`], naming the formats that exist.
    pub fn from_path(path: &Path) -> Result<Format> {
        match path.extension().and_then(|e| e.to_str()) {
            Some(extension) if extension.eq_ignore_ascii_case(MESH_EXTENSION.0) => Ok(MESH_EXTENSION.1),
            Some(extension) => Self::from_name(extension),
            None => Err(Error::Unsupported {
                what: format!(
                    "{} has no extension to tell the mesh format by; end it in one of .{} (.{} is {}), or name \
                     the format",
                    path.display(),
                    Self::ALL.map(Format::name).join(", ."),
                    MESH_EXTENSION.0,
                    MESH_EXTENSION.1.name()
                ),
            }),
        }
    }

    /// Checks that the format can hold meshes of order `order`.
    ///
    /// # Errors
    /// [`Error::Unsupported`], with what to do instead.
    pub fn check_order(self, order: usize) -> Result<()> {
        if self == Format::Msh && !(1..=gmsh::HIGHEST_ORDER).contains(&order) {
            return Err(Error::Unsupported {
                what: format!(
                    "Gmsh's format has quadrilaterals of order 1 to {}, not {order}; choose another order, or \
                     vtu, mfem, ism-v2 or inp, which hold all orders",
                    gmsh::HIGHEST_ORDER
                ),
            });
        }
        Ok(())
    }

    /// The file's content for `mesh`.
    ///
    /// # Errors
    /// As [`Format::check_order`].
    pub fn render(self, mesh: &HighOrderMesh) -> Result<Vec<u8>> {
        self.check_order(mesh.order)?;
        Ok(match self {
            Format::Vtu => vtu::render(mesh),
            Format::Msh => gmsh::render(mesh),
            Format::Ism => hohqmesh::render_ism(mesh, Version::Ism),
            Format::IsmV2 => hohqmesh::render_ism(mesh, Version::V2),
            Format::IsmMm => hohqmesh::render_ism(mesh, Version::MultipleMaterials),
            Format::Inp => hohqmesh::render_abaqus(mesh),
            Format::Mfem => mfem::render(mesh),
            Format::Svg => svg::mesh(mesh).into_bytes(),
        })
    }
}
