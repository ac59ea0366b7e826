//! Files: what a mesh or a run is written as.
//!
//! *In:* a [`HighOrderMesh`], or the [`Stages`](crate::stages::Stages) of a run.
//! *Out:* the bytes of a file, the same for the same mesh; [`Format`] knows the mesh formats by
//! name and extension, [`svg`] draws the stages, [`write_files`] writes files whole or not at all.
//!
//! Numbers in text formats are the shortest that read back as the same bits.

mod equispaced;
mod files;
mod format;
pub mod gmsh;
pub mod hohqmesh;
mod labels;
pub mod mfem;
pub mod svg;
pub mod vtu;

pub use files::write_files;
pub use format::Format;

use crate::error::Result;
use crate::mesh::HighOrderMesh;
use std::path::Path;

/// Writes `mesh` to `path` in `format`, whole or not at all.
///
/// # Errors
/// [`Error::Io`](crate::Error::Io) naming the path; as [`Format::check_order`].
pub fn write(mesh: &HighOrderMesh, format: Format, path: &Path) -> Result<()> {
    write_files(&[(path.to_path_buf(), format.render(mesh)?)])
}
