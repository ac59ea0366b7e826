//! Writing files whole or not at all.

use crate::error::{Error, Result};
use std::fs;
use std::path::{Path, PathBuf};

/// Writes every file, or, where that fails, none: each goes to a temporary file beside its
/// place first, and only when all are on the disk are they renamed. What is no regular
/// file (a pipe, a device) is written to directly.
///
/// # Errors
/// [`Error::Io`] naming the path.
pub fn write_files(files: &[(PathBuf, Vec<u8>)]) -> Result<()> {
    let mut waiting = Waiting::default();
    for (path, bytes) in files {
        // A link is followed, so that its target is replaced and not the link.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.clone());
        if target.is_dir() {
            return Err(failure(path, "is a folder; give a file name"));
        }
        if target.exists() && !target.is_file() {
            fs::write(&target, bytes).map_err(|e| failure(path, e))?;
            continue;
        }
        let name = target.file_name().ok_or_else(|| failure(path, "has no file name"))?;
        let temporary = target.with_file_name(format!(
            ".{}.{}-{}",
            name.to_string_lossy(),
            std::process::id(),
            waiting.0.len()
        ));
        waiting.0.push((temporary.clone(), target));
        fs::write(&temporary, bytes).map_err(|e| failure(path, e))?;
    }
    while let Some((temporary, target)) = waiting.0.pop() {
        fs::rename(&temporary, &target).map_err(|e| {
            waiting.0.push((temporary, target.clone()));
            failure(&target, e)
        })?;
    }
    Ok(())
}

/// Temporary files with the paths they are meant for; those left over are removed.
#[derive(Default)]
struct Waiting(Vec<(PathBuf, PathBuf)>);

impl Drop for Waiting {
    fn drop(&mut self) {
        for (temporary, _) in &self.0 {
            // It may never have come to exist.
            let _ = fs::remove_file(temporary);
        }
    }
}

fn failure(path: &Path, reason: impl ToString) -> Error {
    Error::Io {
        path: path.display().to_string(),
        reason: format!("cannot be written: {}", reason.to_string()),
    }
}
