//! Files

use super::generate::{quadrel_mesh, quadrel_stages};
use super::guard::{guard, required, text, Failure};
use super::status::quadrel_status;
use crate::error::Error;
use crate::output::{self, svg, Format};
use libc::{c_char, c_int, c_void};
use std::path::Path;

/// A file format.
pub type quadrel_format = i32;

/// VTK XML unstructured grid of Lagrange quadrilaterals (nodes equispaced), for ParaView and MFEM
pub const QUADREL_FORMAT_VTU: quadrel_format = 0;
/// Gmsh 4.1 (nodes equispaced), orders 1 to 10
pub const QUADREL_FORMAT_MSH: quadrel_format = 1;
/// HOHQMesh's ISM-v2: corners, edges, curved sides
pub const QUADREL_FORMAT_ISM_V2: quadrel_format = 2;
/// HOHQMesh's ISM-MM: corners, curved sides, a material for each element
pub const QUADREL_FORMAT_ISM_MM: quadrel_format = 3;
/// Abaqus with HOHQMesh's curved sides in comments, for Trixi.jl
pub const QUADREL_FORMAT_INP: quadrel_format = 4;
/// MFEM mesh v1.0, nodes at the Gauss-Lobatto points
pub const QUADREL_FORMAT_MFEM: quadrel_format = 5;
/// a picture
pub const QUADREL_FORMAT_SVG: quadrel_format = 6;
/// HOHQMesh's ISM: corners, curved sides
pub const QUADREL_FORMAT_ISM: quadrel_format = 7;

/// Takes count bytes of a file. Returns 0, or non-zero to stop.
pub type quadrel_write_fn =
    Option<unsafe extern "C" fn(user: *mut c_void, bytes: *const c_void, count: usize) -> c_int>;

/// What a picture of the stages shows.
pub type quadrel_picture = i32;

/// the boundary and its junctions
pub const QUADREL_PICTURE_BOUNDARY: quadrel_picture = 0;
/// the base mesh
pub const QUADREL_PICTURE_TRIANGLES: quadrel_picture = 1;
/// the cross field
pub const QUADREL_PICTURE_CROSSES: quadrel_picture = 2;
/// interior singularities and corners
pub const QUADREL_PICTURE_SINGULARITIES: quadrel_picture = 3;
/// separatrices
pub const QUADREL_PICTURE_SEPARATRICES: quadrel_picture = 4;
/// regions between the separatrices
pub const QUADREL_PICTURE_REGIONS: quadrel_picture = 5;
/// blocks of the conforming layout
pub const QUADREL_PICTURE_BLOCKS: quadrel_picture = 6;
/// all stages reached side by side, and the mesh
pub const QUADREL_PICTURE_ALL: quadrel_picture = 100;

/// Bytes handed to a callback at a time.
const PIECE: usize = 1 << 16;

fn format_of(format: quadrel_format) -> Result<Format, Failure> {
    match format {
        QUADREL_FORMAT_VTU => Ok(Format::Vtu),
        QUADREL_FORMAT_MSH => Ok(Format::Msh),
        QUADREL_FORMAT_ISM_V2 => Ok(Format::IsmV2),
        QUADREL_FORMAT_ISM_MM => Ok(Format::IsmMm),
        QUADREL_FORMAT_INP => Ok(Format::Inp),
        QUADREL_FORMAT_MFEM => Ok(Format::Mfem),
        QUADREL_FORMAT_SVG => Ok(Format::Svg),
        QUADREL_FORMAT_ISM => Ok(Format::Ism),
        _ => Err(Failure::argument("the format", format, "a QUADREL_FORMAT number")),
    }
}

/// Writes the mesh to a file, whole or not at all; format is a QUADREL_FORMAT number.
/// QUADREL_ERROR_UNSUPPORTED where the format cannot hold the mesh's order.
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_write(
    mesh: *const quadrel_mesh,
    format: quadrel_format,
    path: *const c_char,
) -> quadrel_status {
    guard(|| {
        // SAFETY: the caller's promise (first comment of the header).
        let (mesh, path) = unsafe { (required(mesh, "the mesh")?, text(path, "the path")?) };
        Ok(output::write(&mesh.mesh, format_of(format)?, Path::new(path))?)
    })
}

/// Hands the bytes of that file to a function, piece by piece, until it has all or returns non-zero
/// (QUADREL_ERROR_CANCELLED).
#[no_mangle]
pub unsafe extern "C" fn quadrel_mesh_write_to(
    mesh: *const quadrel_mesh,
    format: quadrel_format,
    write: quadrel_write_fn,
    user: *mut c_void,
) -> quadrel_status {
    guard(|| {
        // SAFETY: the caller's promise (first comment of the header).
        let mesh = unsafe { required(mesh, "the mesh") }?;
        let write = write.ok_or_else(|| Failure::null("the function"))?;
        for piece in format_of(format)?.render(&mesh.mesh)?.chunks(PIECE) {
            // SAFETY: the function and its user pointer came together from the caller.
            let answer = unsafe { write(user, piece.as_ptr().cast(), piece.len()) };
            if answer != 0 {
                let text =
                    format!("stopped by the function that takes the file's bytes (it returned {answer})");
                return Err(Failure { text, ..Error::Cancelled.into() });
            }
        }
        Ok(())
    })
}

/// Writes a picture (SVG) of what a stage made; picture is a QUADREL_PICTURE number. The place of a failure is
/// circled. QUADREL_ERROR_UNSUPPORTED where generation did not come that far.
#[no_mangle]
pub unsafe extern "C" fn quadrel_stages_write_svg(
    stages: *const quadrel_stages,
    picture: quadrel_picture,
    path: *const c_char,
) -> quadrel_status {
    guard(|| {
        // SAFETY: the caller's promise (first comment of the header).
        let (stages, path) = unsafe { (required(stages, "the stages")?, text(path, "the path")?) };
        let known = usize::try_from(picture).ok().and_then(|k| svg::Picture::ALL.get(k));
        let drawn = match (picture, known) {
            (QUADREL_PICTURE_ALL, _) if stages.stages.boundary.is_some() => {
                Some(svg::overview(&stages.stages, stages.mesh.as_deref(), stages.failure))
            }
            (QUADREL_PICTURE_ALL, _) => None,
            (_, Some(known)) => svg::stage(&stages.stages, *known, stages.failure),
            _ => return Err(Failure::argument("the picture", picture, "a QUADREL_PICTURE number")),
        };
        let what = "generation did not come as far as this picture; choose an earlier one".to_string();
        let drawn = drawn.ok_or(Error::Unsupported { what })?;
        Ok(output::write_files(&[(Path::new(path).to_path_buf(), drawn.into_bytes())])?)
    })
}
