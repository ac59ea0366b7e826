//! Reading domains from files: HOHQMesh control files and SVG paths.
//!
//! *In:* a file or its text. *Out:* a [`Model`]: the checked domain and what else the file asks for.

mod blocks;
mod control;
mod embedded;
mod equation;
mod expression;
mod refinement;
mod svg;
mod svg_arc;

pub use embedded::gingerbread_man;
pub use equation::EquationCurve;
pub use expression::Expression;

use crate::domain::Domain;
use crate::error::{Error, Result};
use crate::options::SizeFunction;
use std::path::Path;

/// What a file describes.
#[derive(Debug, Clone)]
pub struct Model {
    /// The file's name without folder and extension.
    pub name: String,
    pub domain: Domain,
    /// The polynomial order the file asks for.
    pub order: Option<usize>,
    /// The boundary tolerance the file asks for, as the file has it.
    pub tolerance: Option<f64>,
    /// The element size that the file's refinement regions ask for. It holds if it is made an option.
    pub size: Option<SizeFunction>,
    /// The size of the file's background grid, the larger of the two directions.
    pub background_size: Option<f64>,
    /// What was repaired or left out.
    pub warnings: Vec<String>,
}

/// Reads a `.control` or `.svg` file; `component` chooses one of several components, counted from 0 by
/// descending area.
pub fn read(path: &Path, component: Option<usize>) -> Result<Model> {
    let shown = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|e| Error::Io { path: shown.clone(), reason: e.to_string() })?;
    let name = path.file_stem().map_or(String::new(), |s| s.to_string_lossy().into_owned());
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    if bytes.is_empty() {
        return Err(Error::Parse { what: "the file is empty".into(), line: 1, column: 1 });
    }
    let text = decode(bytes)?;
    match extension.as_deref() {
        Some("control") => control::read(&name, &text, path.parent()),
        Some("svg") => svg::read(&name, &text, component),
        _ => Err(Error::Unsupported { what: format!("{shown}: neither a .control nor a .svg file") }),
    }
}

/// The text of a control file; data files it names are looked for in `base_dir` and above.
pub fn read_control_str(text: &str, base_dir: Option<&Path>) -> Result<Model> {
    control::read("model", text, base_dir)
}

/// The text of an SVG file; `component` as for [`read`].
pub fn read_svg_str(text: &str, component: Option<usize>) -> Result<Model> {
    svg::read("model", text, component)
}

/// The bytes as text. Control files may hold names in other encodings; zero bytes mean it is no text.
fn decode(bytes: Vec<u8>) -> Result<String> {
    if let Some(at) = bytes.iter().position(|&b| b == 0) {
        let line = 1 + bytes[..at].iter().filter(|&&b| b == b'\n').count();
        let column = at - bytes[..at].iter().rposition(|&b| b == b'\n').map_or(0, |p| p + 1) + 1;
        return Err(Error::Parse { what: "a zero byte: not a text file".into(), line, column });
    }
    Ok(match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(e) => String::from_utf8_lossy(e.as_bytes()).into_owned(),
    })
}
