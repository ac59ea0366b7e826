//! `quadrel corpus`: every domain of some folders, each in a process of its own, so that a crash, a
//! hang or lack of memory cannot take the others down.

mod child;
mod files;
mod reduce;
mod summary;

use crate::arguments::CorpusArguments;
use crate::columns::flatten;
use crate::Outcome;
use child::{Child, Scratch};
use files::Case;
use quadrel::output::write_files;
use serde_json::Value;
use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::Mutex;

/// A domain and the statistics of its run.
struct Row {
    case: Case,
    statistics: Value,
}

/// Runs the command. Done: every domain was meshed; refused: some were not.
pub fn run(arguments: &CorpusArguments) -> Outcome {
    match try_run(arguments) {
        Ok(outcome) => outcome,
        Err(reason) => {
            eprintln!("quadrel: {reason}");
            Outcome::Unusable
        }
    }
}

fn try_run(arguments: &CorpusArguments) -> Result<Outcome, String> {
    let scratch = Scratch::new().map_err(|e| format!("no folder for temporary files: {e}"))?;
    let child = Child::new(arguments, &scratch)?;
    if let Some(file) = &arguments.reduce {
        return reduce::run(file, &child);
    }
    let cases = files::find(&arguments.folders)?;
    if cases.is_empty() {
        return Err("no .control or .svg file in these folders".into());
    }
    let wide = cases.iter().map(|c| c.shown().chars().count()).max().unwrap_or(0).min(60);
    say(&summary::heading(wide));
    let next = AtomicUsize::new(0);
    let rows: Mutex<Vec<Row>> = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..arguments.jobs {
            scope.spawn(|| {
                while let Some(case) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let statistics = child.mesh(&case.path, &case.relative);
                    let row = Row { case: case.clone(), statistics };
                    if let Ok(mut rows) = rows.lock() {
                        say(&summary::row(&row, wide));
                        rows.push(row);
                    }
                }
            });
        }
    });
    let mut rows = rows.into_inner().map_err(|_| "a worker failed".to_string())?;
    rows.sort_by(|a, b| a.case.path.cmp(&b.case.path));
    say(&summary::summary(&rows));
    if let Some(path) = &arguments.csv {
        write_files(&[(path.clone(), csv(&rows).into_bytes())]).map_err(|e| e.to_string())?;
        say(&format!("wrote {}\n", path.display()));
    }
    let all = rows.iter().all(|row| row.status() == "ok");
    Ok(if all { Outcome::Done } else { Outcome::Refused })
}

/// Standard output; that nobody reads it is no reason to stop.
fn say(text: &str) {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}

impl Row {
    fn status(&self) -> &str {
        self.statistics["status"].as_str().unwrap_or("crash")
    }

    /// The number under `pointer` (`/scaled_jacobian/min`).
    fn number(&self, pointer: &str) -> Option<f64> {
        self.statistics.pointer(pointer).and_then(Value::as_f64)
    }

    /// Irregular vertices inside and on the boundary.
    fn irregular(&self) -> Option<f64> {
        Some(self.number("/irregular/interior")? + self.number("/irregular/boundary")?)
    }

    /// Least scaled Jacobian by the domain's ceiling.
    fn quality(&self) -> Option<f64> {
        Some(self.number("/scaled_jacobian/min")? / self.number("/scaled_jacobian_ceiling")?)
    }
}

/// A row a domain: file, family and the flattened statistics.
fn csv(rows: &[Row]) -> String {
    let mut text = String::new();
    for (k, row) in rows.iter().enumerate() {
        let columns = flatten(&row.statistics);
        if k == 0 {
            text.push_str("file,family");
            columns.iter().for_each(|(name, _)| text.push_str(&format!(",{name}")));
            text.push('\n');
        }
        text.push_str(&format!("{},{}", quoted(&row.case.shown()), quoted(&row.case.family)));
        columns.iter().for_each(|(_, value)| text.push_str(&format!(",{}", quoted(value))));
        text.push('\n');
    }
    text
}

/// A CSV field (RFC 4180).
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_string()
    }
}

/// The file's name without its extension, then `suffix` and the extension.
fn beside(path: &Path, suffix: &str) -> std::path::PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}{suffix}.{extension}"))
}
