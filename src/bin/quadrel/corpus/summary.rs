//! Rows and sums of a corpus run as text.

use super::Row;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Share of the ceiling that the scaled Jacobian is to reach, and the one it is never to fall below.
const GOOD: f64 = 0.8;
const POOR: f64 = 0.3;
/// Irregular vertices above what the domain lets expect that still count as few.
const FEW: f64 = 4.0;

/// The names of the columns; `wide` is the width of the first.
pub fn heading(wide: usize) -> String {
    format!(
        "{:<wide$} {:<16} {:>8} {:>9} {:>6} {:>7} {:>8}\n",
        "file", "status", "elements", "irregular", "SJ", "ceiling", "seconds"
    )
}

/// One domain.
pub fn row(row: &Row, wide: usize) -> String {
    let shown = row.case.shown();
    let count = shown.chars().count();
    // The end of a path tells more than its beginning.
    let file: String = shown.chars().skip(count.saturating_sub(wide)).collect();
    format!(
        "{file:<wide$} {:<16} {:>8} {:>9} {:>6} {:>7} {:>8}\n",
        row.status(),
        cell(row.number("/elements"), 0),
        cell(row.irregular(), 0),
        cell(row.number("/scaled_jacobian/min"), 3),
        cell(row.number("/scaled_jacobian_ceiling"), 3),
        cell(row.number("/seconds/total"), 3),
    )
}

fn cell(value: Option<f64>, decimals: usize) -> String {
    value.map_or("-".into(), |v| format!("{v:.decimals$}"))
}

/// Sums by family and by status.
pub fn summary(rows: &[Row]) -> String {
    let mut families: BTreeMap<&str, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        families.entry(&row.case.family).or_default().push(row);
    }
    let wide = families.keys().map(|f| f.chars().count()).max().unwrap_or(0).max(6);
    let mut text = format!(
        "\n{:<wide$} {:>7} {:>5} {:>6} {:>9} {:>9} {:>10} {:>9} {:>8} {:>8}\n",
        "family",
        "domains",
        "ok",
        "ok %",
        "SJ good %",
        "SJ poor %",
        "irr. few %",
        "elements",
        "s median",
        "s max"
    );
    for (family, rows) in &families {
        sums(&mut text, family, rows, wide);
    }
    if families.len() > 1 {
        sums(&mut text, "all", &rows.iter().collect::<Vec<_>>(), wide);
    }
    let _ = writeln!(
        text,
        "SJ good: scaled Jacobian at least {GOOD} of the domain's ceiling; poor: below {POOR} of it; \
         irr. few: at most {FEW} above the expected; % of those meshed"
    );
    statuses(&mut text, rows);
    text
}

fn sums(text: &mut String, family: &str, rows: &[&Row], wide: usize) {
    let meshed: Vec<&&Row> = rows.iter().filter(|r| r.status() == "ok").collect();
    let percent = |count: usize, of: usize| {
        if of == 0 {
            "-".into()
        } else {
            format!("{:.1}", 100.0 * count as f64 / of as f64)
        }
    };
    let share =
        |holds: &dyn Fn(&Row) -> bool| percent(meshed.iter().filter(|r| holds(r)).count(), meshed.len());
    let few = |row: &Row| match (row.irregular(), row.number("/irregular_expected")) {
        (Some(found), Some(expected)) => found <= expected + FEW,
        _ => false,
    };
    let elements = meshed.iter().filter_map(|r| r.number("/elements")).fold(0.0, |a, b| a + b);
    let mut seconds: Vec<f64> = rows.iter().filter_map(|r| r.number("/seconds/total")).collect();
    seconds.sort_by(f64::total_cmp);
    let _ = writeln!(
        text,
        "{family:<wide$} {:>7} {:>5} {:>6} {:>9} {:>9} {:>10} {:>9} {:>8} {:>8}",
        rows.len(),
        meshed.len(),
        percent(meshed.len(), rows.len()),
        share(&|r| r.quality().is_some_and(|q| q >= GOOD)),
        share(&|r| r.quality().is_some_and(|q| q < POOR)),
        share(&few),
        format!("{elements:.0}"),
        cell(seconds.get(seconds.len() / 2).copied(), 3),
        cell(seconds.last().copied(), 3),
    );
}

/// The status; of runs that had to be ended with the stage they were in (other errors name theirs).
fn kind(row: &Row) -> String {
    let stage = row.statistics["message"].as_str().and_then(|m| m.split_once(" in stage "));
    match stage {
        Some((_, stage)) if row.status() == "timeout" => format!("timeout in {stage}"),
        _ => row.status().to_string(),
    }
}

/// How often each status occurred, with the first files.
fn statuses(text: &mut String, rows: &[Row]) {
    let mut by_status: BTreeMap<String, Vec<&Row>> = BTreeMap::new();
    for row in rows {
        by_status.entry(kind(row)).or_default().push(row);
    }
    let mut sorted: Vec<_> = by_status.into_iter().collect();
    sorted.sort_by_key(|(_, rows)| std::cmp::Reverse(rows.len()));
    let _ = writeln!(text, "\n{:<26} {:>6}", "status", "count");
    for (status, rows) in sorted {
        let names: Vec<String> = rows
            .iter()
            .take(if status == "ok" { 0 } else { 3 })
            .map(|r| r.case.path.file_name().unwrap_or_default().to_string_lossy().into_owned())
            .collect();
        let more = if names.is_empty() { String::new() } else { format!("  {}", names.join(", ")) };
        let dots = if rows.len() > names.len() && !names.is_empty() { ", …" } else { "" };
        let _ = writeln!(text, "{status:<26} {:>6}{more}{dots}", rows.len());
    }
}
