//! Domains from files
//!
//! HOHQMesh control files (.control) and SVG paths (.svg: M L H V Q C S T A Z; the y axis is turned up, loops
//! are outer or holes by the even-odd rule). A domain that was read is complete: it takes no more loops.

use super::domain::{quadrel_domain, Source};
use super::guard::{answer, copy_out, guard, optional_text, text, Failure};
use super::status::quadrel_status;
use crate::error::Result as CoreResult;
use crate::input::{self, Model};
use libc::c_char;
use std::path::Path;

/// What a text is.
pub type quadrel_input_format = i32;

/// a HOHQMesh control file
pub const QUADREL_INPUT_CONTROL: quadrel_input_format = 0;
/// an SVG file
pub const QUADREL_INPUT_SVG: quadrel_input_format = 1;

/// Hands a read domain to the caller.
unsafe fn hand_out(
    domain_out: *mut *mut quadrel_domain,
    component: i32,
    read: impl FnOnce(Option<usize>) -> Result<CoreResult<Model>, Failure>,
) -> quadrel_status {
    guard(|| {
        if domain_out.is_null() {
            return Err(Failure::null("domain_out"));
        }
        let component = match component {
            -1 => None,
            k => Some(
                usize::try_from(k)
                    .map_err(|_| Failure::argument("the component", k, "-1, or a number counted from 0"))?,
            ),
        };
        let source = Source::Read(Box::new(read(component)??));
        // SAFETY: the caller's promise (first comment of the header).
        unsafe { copy_out(domain_out, &[Box::into_raw(Box::new(quadrel_domain { source }))]) };
        Ok(())
    })
}

/// Reads a .control or .svg file. component chooses one of the domains of a file that holds several,
/// counted from 0 by descending area; with -1 such a file is refused.
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_read(
    path: *const c_char,
    component: i32,
    domain_out: *mut *mut quadrel_domain,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        hand_out(domain_out, component, |component| {
            Ok(input::read(Path::new(text(path, "the path")?), component))
        })
    }
}

/// Reads the text of such a file; format is a QUADREL_INPUT number. Data files that a control file names are
/// looked for in folder and the ones above it; folder may be NULL.
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_read_string(
    content: *const c_char,
    format: quadrel_input_format,
    folder: *const c_char,
    component: i32,
    domain_out: *mut *mut quadrel_domain,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        hand_out(domain_out, component, |component| {
            let (content, folder) = (text(content, "the content")?, optional_text(folder, "the folder")?);
            match format {
                QUADREL_INPUT_CONTROL => Ok(input::read_control_str(content, folder.map(Path::new))),
                QUADREL_INPUT_SVG => Ok(input::read_svg_str(content, component)),
                _ => Err(Failure::argument("the input format", format, "a QUADREL_INPUT number")),
            }
        })
    }
}

/// What the file of `domain` asks for, if it was read from one.
unsafe fn asked<T>(domain: *const quadrel_domain, otherwise: T, of: impl FnOnce(&Model) -> Option<T>) -> T
where
    T: Copy,
{
    // SAFETY: the caller's promise (first comment of the header).
    answer(otherwise, || match unsafe { domain.as_ref() }.map(|d| &d.source) {
        Some(Source::Read(model)) => of(model).unwrap_or(otherwise),
        _ => otherwise,
    })
}

/// The polynomial order that the file asks for, or 0. It is not used unless it is set as an option.
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_file_order(domain: *const quadrel_domain) -> i32 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { asked(domain, 0, |model| model.order.and_then(|n| i32::try_from(n).ok())) }
}

/// The boundary tolerance that the file asks for, or 0. It is not used unless it is set as an option.
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_file_tolerance(domain: *const quadrel_domain) -> f64 {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { asked(domain, 0.0, |model| model.tolerance) }
}
