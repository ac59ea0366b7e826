//! The domain that comes with the library.
//!
//! GingerbreadMan.control is an example of HOHQMesh (<https://github.com/trixi-framework/HOHQMesh>,
//! MIT licence, copyright David A. Kopriva), unchanged.

use crate::error::Result;
use crate::input::{control, Model};

/// The Gingerbread man, the subject of Fig. 4 of the paper.
pub fn gingerbread_man() -> Result<Model> {
    control::read("GingerbreadMan", include_str!("GingerbreadMan.control"), None)
}
