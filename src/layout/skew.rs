//! Lines that would cross a region much aslant because both their ends are junctions, which cannot slide.

use super::extract::Demand;
use super::lengths::Lengths;
use super::{BlockLayout, NodeKind, Region, SideArc};
use crate::numerics::Point;

/// Distance of a line's ends along the region, by the region's width there, above which it is aslant: about 27° off.
const ASLANT: f64 = 0.5;

/// Farthest that a junction's foot on the other side is looked for, by share of the sides' lengths: around a ring the
/// nearest point of one shortly after the start may lie shortly before the end.
const FARTHEST: f64 = 0.5;

/// A junction inside a side: its place in edges and in length from the side's start, and the number of the side's
/// arcs before it.
struct Pinned {
    index: u32,
    run: f64,
    /// The same length by the side's.
    share: f64,
    arcs: usize,
    point: Point,
}

/// Demands of one more edge before, and one more behind, wherever a junction would be joined with one far along on
/// the other side of its region.
pub(super) fn aslant(layout: &BlockLayout, lengths: &Lengths) -> Vec<Demand> {
    let four_sided = layout.regions.iter().filter(|r| r.sides.len() == 4);
    four_sided
        .flat_map(|region| [0, 1].into_iter().flat_map(|s| across(layout, lengths, region, s)))
        .collect()
}

/// Those between sides `s` and `s` + 2.
fn across(layout: &BlockLayout, lengths: &Lengths, region: &Region, s: usize) -> Vec<Demand> {
    let side = |s: usize| &region.sides[s % 4];
    let one = side(s).clone();
    let mut other: Vec<SideArc> = side(s + 2).clone();
    other.reverse();
    other.iter_mut().for_each(|a| a.forward = !a.forward);
    let [ours, theirs] = [&one, &other].map(|arcs| pinned(layout, lengths, arcs));
    if ours.is_empty() || theirs.is_empty() {
        return Vec::new();
    }
    let [our_line, their_line] = [&one, &other].map(|arcs| line(layout, arcs));
    let mut demands = Vec::new();
    for a in &ours {
        let (foot_a, wide_a) = foot(&their_line, a);
        for b in &theirs {
            let (foot_b, wide_b) = foot(&our_line, b);
            let apart = 0.5 * (a.run - foot_b + foot_a - b.run);
            let wide = 0.5 * (wide_a + wide_b);
            // The one further on has to come later in edges as well.
            let (early, early_arcs, late, late_arcs) = match () {
                _ if apart > ASLANT * wide => (b, &other, a, &one),
                _ if -apart > ASLANT * wide => (a, &one, b, &other),
                _ => continue,
            };
            if early.index < late.index {
                continue;
            }
            let behind: u32 = early_arcs[early.arcs..].iter().map(|x| lengths.arcs[x.arc as usize]).sum();
            let why = "a line between two boundary corners would be too much aslant";
            let arcs = |arcs: &[SideArc]| {
                let mut list: Vec<u32> = arcs.iter().map(|a| a.arc).collect();
                list.sort_unstable();
                list.dedup();
                list
            };
            let before = Demand {
                arcs: arcs(&late_arcs[..late.arcs]),
                at_least: early.index + 1,
                why,
                at: late.point,
            };
            let after =
                Demand { arcs: arcs(&early_arcs[early.arcs..]), at_least: behind + 1, why, at: early.point };
            demands.extend([before, after]);
        }
    }
    demands
}

/// The junctions strictly inside a side.
fn pinned(layout: &BlockLayout, lengths: &Lengths, side: &[SideArc]) -> Vec<Pinned> {
    let whole = length(&line(layout, side));
    let (mut index, mut run) = (0, 0.0);
    let mut found = Vec::new();
    for (k, arc) in side.iter().enumerate().take(side.len().saturating_sub(1)) {
        index += lengths.arcs[arc.arc as usize];
        run += length(&layout.arcs[arc.arc as usize].points);
        let head = layout.arcs[arc.arc as usize].nodes[usize::from(arc.forward)];
        let node = &layout.nodes[head as usize];
        if node.kind == NodeKind::Junction {
            found.push(Pinned { index, run, share: run / whole, arcs: k + 1, point: node.point });
        }
    }
    found
}

/// A side's points in order.
fn line(layout: &BlockLayout, side: &[SideArc]) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    for arc in side {
        let own = &layout.arcs[arc.arc as usize].points;
        match arc.forward {
            true => points.extend(own),
            false => points.extend(own.iter().rev()),
        }
    }
    points
}

fn length(line: &[Point]) -> f64 {
    line.windows(2).map(|p| (p[1] - p[0]).norm()).sum()
}

/// The place, in length from the start, of a polyline's point nearest to `own`, and how far it is.
fn foot(line: &[Point], own: &Pinned) -> (f64, f64) {
    let whole = length(line);
    let [first, last] = [-1.0, 1.0].map(|side| (own.share + side * FARTHEST) * whole);
    let (mut run, mut best) = (0.0, (0.0, f64::INFINITY));
    for ends in line.windows(2) {
        let d = ends[1] - ends[0];
        let long = d.norm();
        if run + long >= first && run <= last {
            let share = if long > 0.0 { (own.point - ends[0]).dot(&d) / (long * long) } else { 0.0 };
            let share = share.clamp(0.0, 1.0);
            let far = (own.point - (ends[0] + d * share)).norm();
            if far < best.1 {
                best = (run + share * long, far);
            }
        }
        run += long;
    }
    best
}
