//! The table on standard output.

use quadrel::options::{Norm, Tolerance};
use quadrel::progress::Stage;
use quadrel::stages::{Stages, SymmetryCount};
use quadrel::statistics::Statistics;
use quadrel::Options;
use std::fmt::Write;

/// The first line: what is meshed, and how.
pub fn title(name: &str, options: &Options) -> String {
    let norm = match options.norm {
        Norm::L2 => "L2",
        Norm::H1 => "H1",
        Norm::Max => "max",
    };
    let tolerance = match options.tolerance {
        Tolerance::Absolute(e) => format!("{norm} tolerance {e:.3e}"),
        Tolerance::Relative(e) => format!("{norm} tolerance {e:.3e} (relative)"),
    };
    format!("{name}: order {}, {tolerance}", options.order)
}

/// Stages, quality, boundary errors, rounds and warnings.
pub fn table(title: &str, stages: &Stages, statistics: &Statistics) -> String {
    let mut text = format!("{title}\n\n");
    let _ = writeln!(text, "{:<15} {:>9}  result", "stage", "seconds");
    for (stage, seconds) in statistics.stage_seconds {
        if stages.reached.is_some_and(|reached| stage <= reached) || seconds > 0.0 {
            let result = stage_result(stage, stages, statistics);
            let _ = writeln!(text, "{:<15} {seconds:>9.3}  {result}", stage.name());
        }
    }
    let _ = writeln!(text, "{:<15} {:>9.3}", "total", statistics.total_seconds);
    rounds(&mut text, statistics);
    quality(&mut text, statistics);
    for warning in &statistics.warnings {
        let _ = writeln!(text, "warning: {warning}");
    }
    text
}

/// What a stage found, in a few words.
fn stage_result(stage: Stage, stages: &Stages, statistics: &Statistics) -> String {
    let found = |value: Option<usize>, what: &str| value.map(|n| format!("{n} {what}"));
    let result = match stage {
        Stage::Domain => stages.boundary.as_ref().map(|b| {
            format!("{}, {}", counted(b.loops.len(), "loop"), counted(b.junctions.len(), "junction"))
        }),
        Stage::BaseMesh => found(statistics.triangles, "triangles"),
        Stage::CrossField => None,
        Stage::Singularities => statistics.singularities.map(|n| {
            let valence = |v: u8| stages.singularities.iter().filter(|s| s.valence == v).count();
            format!(
                "{} inside ({} of valence 3, {} of valence 5), {}",
                n,
                valence(3),
                valence(5),
                counted(stages.corners.len(), "corner")
            )
        }),
        Stage::Separatrices => found(statistics.separatrices, "separatrices"),
        Stage::Layout => statistics.blocks.map(|n| {
            let quads = stages.quad_layout.as_ref().map(|l| format!(", {} quads", l.quads.len()));
            format!("{n} regions{}", quads.unwrap_or_default())
        }),
        Stage::Refine => (!statistics.rounds.is_empty()).then(|| counted(statistics.rounds.len(), "round")),
        Stage::Smooth => None,
        Stage::Mesh => {
            statistics.elements.zip(statistics.nodes).map(|(e, n)| format!("{e} elements, {n} nodes"))
        }
    };
    result.unwrap_or_default()
}

fn counted(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn rounds(text: &mut String, statistics: &Statistics) {
    if statistics.rounds.is_empty() {
        return;
    }
    let _ = writeln!(text, "\nsteps 7 to 9     elements  scaled Jacobian  boundary error / tolerance");
    for round in &statistics.rounds {
        let _ = writeln!(
            text,
            "{:<16} {:>8}  {:>15.3}  {:>26.3}",
            round.action, round.elements, round.scaled_jacobian, round.boundary_error
        );
    }
}

fn quality(text: &mut String, statistics: &Statistics) {
    let ceiling = statistics.scaled_jacobian_ceiling.map(|c| format!(" (the domain allows {c:.3})"));
    if let Some(d) = statistics.scaled_jacobian {
        let _ = writeln!(
            text,
            "\nscaled Jacobian  min {:.3}{}, first percentile {:.3}, mean {:.3}",
            d.min,
            ceiling.unwrap_or_default(),
            d.p1,
            d.mean
        );
    }
    if let Some(irregular) = statistics.irregular {
        let expected = statistics.irregular_expected.map(|n| format!(" (the shape lets expect about {n})"));
        let _ = writeln!(
            text,
            "irregular        {} inside, {} on the boundary{}",
            irregular.interior,
            irregular.boundary,
            expected.unwrap_or_default()
        );
    }
    if let Some(error) = &statistics.boundary_error {
        let _ = write!(text, "boundary error   max {:.3e}", error.max);
        for (k, e) in error.loops.iter().enumerate().take(MOST_LOOPS).filter(|_| error.loops.len() > 1) {
            let _ = write!(text, "{}loop {k} {e:.3e}", if k == 0 { "; " } else { ", " });
        }
        let more = error.loops.len().saturating_sub(MOST_LOOPS);
        let _ = writeln!(text, "{}", if more > 0 { format!(" and {more} more") } else { String::new() });
    }
    if let Some(symmetry) = statistics.symmetry.filter(|s| s.domain.order() > 1) {
        let why = symmetry.asymmetry.map(|a| format!(" (because of {})", a.name()));
        let (domain, mesh) = (symmetries(symmetry.domain), symmetries(symmetry.mesh));
        let _ = writeln!(
            text,
            "symmetry         the domain has {domain}, the mesh {mesh}{}",
            why.unwrap_or_default()
        );
    }
    if statistics.attempts > 1 {
        let _ = writeln!(text, "attempts         {} base mesh sizes were tried", statistics.attempts);
    }
    if statistics.fallback > 0 {
        let by = ["", "the paper's rules", "patterns", "centroid stars"];
        let by = by.get(usize::from(statistics.fallback)).unwrap_or(&"other means");
        let _ = writeln!(text, "fallback         some regions were repaired by {by}");
    }
}

/// Symmetries in words.
fn symmetries(count: SymmetryCount) -> String {
    let number = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    format!("{} and {}", number(count.rotations, "rotation"), number(count.mirrors, "mirror"))
}

/// Loops whose boundary error is shown one by one.
const MOST_LOOPS: usize = 12;
