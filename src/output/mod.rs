//! Files: what a mesh or a run is written as.
//!
//! *In:* a [`HighOrderMesh`], or the [`Stages`](crate::stages::Stages) of a run.
//! *Out:* the bytes of a file, the same for the same mesh; [`Format`] knows the mesh formats by
//! name and extension, [`svg`] draws the stages, [`write_files`] writes files whole or not at all.

mod files;
pub mod svg;
pub mod vtu;

pub use files::write_files;

use crate::error::{Error, Result};
use crate::mesh::HighOrderMesh;
use std::path::Path;

/// A file format that a mesh can be written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Format {
    /// VTK XML unstructured grid of Lagrange quadrilaterals, for ParaView and MFEM.
    Vtu,
    /// A picture.
    Svg,
}

impl Format {
    /// All formats.
    pub const ALL: [Format; 2] = [Format::Vtu, Format::Svg];

    /// Its name, which is also the file name extension.
    pub fn name(self) -> &'static str {
        match self {
            Format::Vtu => "vtu",
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

    /// The format that the extension of `path` stands for.
    ///
    /// # Errors
    /// [`Error::Unsupported`], naming the formats that exist.
    pub fn from_path(path: &Path) -> Result<Format> {
        match path.extension().and_then(|e| e.to_str()) {
            Some(extension) => Self::from_name(extension),
            None => Err(Error::Unsupported {
                what: format!(
                    "{} has no extension to tell the mesh format by; end it in one of .{}, or name the format",
                    path.display(),
                    Self::ALL.map(Format::name).join(", .")
                ),
            }),
        }
    }

    /// The file's content for `mesh`.
    pub fn render(self, mesh: &HighOrderMesh) -> Vec<u8> {
        match self {
            Format::Vtu => vtu::render(mesh),
            Format::Svg => svg::mesh(mesh).into_bytes(),
        }
    }
}

/// Writes `mesh` to `path` in `format`, whole or not at all.
///
/// # Errors
/// [`Error::Io`] naming the path.
pub fn write(mesh: &HighOrderMesh, format: Format, path: &Path) -> Result<()> {
    write_files(&[(path.to_path_buf(), format.render(mesh))])
}
