//! Finding the domains of a corpus.

use std::fs;
use std::path::{Path, PathBuf};

/// A domain's file.
#[derive(Debug, Clone)]
pub struct Case {
    pub path: PathBuf,
    /// Its path below the folder that was given.
    pub relative: PathBuf,
    /// The first folder below the one that was given, or that one's own name.
    pub family: String,
}

impl Case {
    /// Its path as text.
    pub fn shown(&self) -> String {
        self.path.display().to_string()
    }
}

/// All `.control` and `.svg` files below `folders`, sorted. Links to folders are not followed.
pub fn find(folders: &[PathBuf]) -> Result<Vec<Case>, String> {
    let mut cases = Vec::new();
    for folder in folders {
        let mut waiting = vec![folder.clone()];
        while let Some(dir) = waiting.pop() {
            let failure = |e: std::io::Error| format!("{}: {e}", dir.display());
            for entry in fs::read_dir(&dir).map_err(failure)? {
                let entry = entry.map_err(failure)?;
                let path = entry.path();
                if entry.file_type().map_err(failure)?.is_dir() {
                    waiting.push(path);
                } else if is_domain(&path) {
                    cases.push(case(folder, path));
                }
            }
        }
    }
    cases.sort_by(|a, b| a.path.cmp(&b.path));
    cases.dedup_by(|a, b| a.path == b.path);
    Ok(cases)
}

fn is_domain(path: &Path) -> bool {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    matches!(extension.as_deref(), Some("control" | "svg"))
}

fn case(folder: &Path, path: PathBuf) -> Case {
    let relative = path.strip_prefix(folder).unwrap_or(&path).to_path_buf();
    let first = relative.components().next().filter(|_| relative.components().count() > 1);
    let family = match first {
        Some(name) => name.as_os_str().to_string_lossy().into_owned(),
        None => {
            let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_path_buf());
            folder.file_name().map_or(".".into(), |n| n.to_string_lossy().into_owned())
        }
    };
    Case { path, relative, family }
}
