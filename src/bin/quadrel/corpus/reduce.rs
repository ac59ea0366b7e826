//! Making a failing domain small: parts are taken out as long as it fails in the same way.

use super::child::Child;
use super::{beside, say};
use crate::Outcome;
use quadrel::output::write_files;
use std::ops::Range;
use std::path::Path;

/// Reduces the domain of `file` and writes the result beside it (`name.reduced.control`).
pub fn run(file: &Path, child: &Child) -> Result<Outcome, String> {
    let text = std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    let extension = file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let parts = match extension.as_str() {
        "control" => inner_boundaries(&text),
        "svg" => subpaths(&text),
        _ => return Err(format!("{}: neither a .control nor a .svg file", file.display())),
    };
    // Beside the original, so that the data files it names are found.
    let trial = beside(file, &format!(".trial-{}", std::process::id()));
    let status_of = |text: &str| -> Result<String, String> {
        std::fs::write(&trial, text).map_err(|e| format!("{}: {e}", trial.display()))?;
        let statistics = child.mesh(&trial, Path::new("trial"));
        std::fs::remove_file(&trial).map_err(|e| format!("{}: {e}", trial.display()))?;
        Ok(statistics["status"].as_str().unwrap_or("crash").to_string())
    };
    let wanted = status_of(&text)?;
    say(&format!("{}: {wanted}, {} parts that can be left out\n", file.display(), parts.len()));
    if wanted == "ok" {
        return Err(format!("{} is meshed: there is nothing to reduce", file.display()));
    }
    // Large groups first, then ever smaller ones, down to single parts.
    let mut kept: Vec<bool> = vec![true; parts.len()];
    let mut group = parts.len().div_ceil(2);
    while group > 0 && !parts.is_empty() {
        for start in (0..parts.len()).step_by(group) {
            let mut trial = kept.clone();
            trial[start..(start + group).min(parts.len())].fill(false);
            if trial != kept && status_of(&without(&text, &parts, &trial))? == wanted {
                kept = trial;
                let left = kept.iter().filter(|k| **k).count();
                say(&format!("{left} of {} parts left\n", parts.len()));
            }
        }
        group = if group == 1 { 0 } else { group.div_ceil(2) };
    }
    let result = beside(file, ".reduced");
    let bytes = without(&text, &parts, &kept).into_bytes();
    write_files(&[(result.clone(), bytes)]).map_err(|e| e.to_string())?;
    say(&format!("wrote {}\n", result.display()));
    Ok(Outcome::Done)
}

/// `text` without the parts that are not kept.
fn without(text: &str, parts: &[Range<usize>], kept: &[bool]) -> String {
    let (mut result, mut at) = (String::new(), 0);
    for (part, _) in parts.iter().zip(kept).filter(|(_, kept)| !**kept) {
        result.push_str(&text[at..part.start]);
        at = part.end;
    }
    result.push_str(&text[at..]);
    result
}

/// The blocks directly inside `INNER_BOUNDARIES` of a control file.
fn inner_boundaries(text: &str) -> Vec<Range<usize>> {
    let mut parts = Vec::new();
    let (mut depth, mut start) = (0, 0);
    let mut offset = 0;
    for line in text.split_inclusive('\n') {
        let word = line.trim_start();
        if word.starts_with("\\begin{INNER_BOUNDARIES}") {
            depth = 1;
        } else if word.starts_with("\\begin{") && depth > 0 {
            if depth == 1 {
                start = offset;
            }
            depth += 1;
        } else if word.starts_with("\\end{") && depth > 0 {
            depth -= 1;
            if depth == 1 {
                parts.push(start..offset + line.len());
            }
        }
        offset += line.len();
    }
    parts
}

/// The subpaths of an SVG file's path data, except the first of each path, which positions that follow
/// may be relative to; and only those that begin with an absolute `M`.
fn subpaths(text: &str) -> Vec<Range<usize>> {
    let mut parts = Vec::new();
    for (i, _) in text.match_indices(" d=") {
        let Some(quote) = text[i + 3..].chars().next().filter(|c| "\"'".contains(*c)) else { continue };
        let start = i + 4;
        let end = text[start..].find(quote).map_or(text.len(), |k| start + k);
        let moves: Vec<usize> = text[start..end].match_indices(['M', 'm']).map(|(k, _)| start + k).collect();
        for (k, &from) in moves.iter().enumerate().skip(1) {
            let to = moves.get(k + 1).copied().unwrap_or(end);
            // What follows must not be relative to what is taken out.
            let follows = to == end || text[to..].starts_with('M');
            if text[from..].starts_with('M') && follows {
                parts.push(from..to);
            }
        }
    }
    parts
}
