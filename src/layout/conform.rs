//! The stage's one entry: repair, lengths, extraction, and back while demands remain.

use super::extract::{extract, Extraction};
use super::lengths::LengthProgram;
use super::repair::PATTERN;
use super::skew;
use super::targets::{LengthTargets, Targets};
use super::{polyline, BlockLayout, QuadLayout};
use crate::domain::Boundary;
use crate::error::{Error, Result};
use crate::numerics::Point;
use std::collections::BTreeSet;

/// Most rounds of lengths and extraction.
const ROUNDS: usize = 200;
/// Most times that a conforming result is improved further.
const POLISHES: usize = 2;
/// Most times that lines aslant are asked to be less so.
const STRAIGHTENINGS: usize = 4;
/// Most regions relaxed to a 3-5 pair.
const RELAXATIONS: usize = 64;

/// A conforming layout and where it comes from.
#[derive(Debug, Clone, PartialEq)]
pub struct Conforming {
    pub layout: QuadLayout,
    /// The T-mesh with its repaired and relaxed regions; [`QuadLayout::region`] counts its regions.
    pub repaired: BlockLayout,
    /// Length of each arc of `repaired`.
    pub lengths: Vec<u32>,
    /// The strongest rule used: 0 none, 1 the paper's, 2 a pattern (six sides and more, a 3-5 pair).
    pub fallback: u8,
    /// Σ |n − ℓ| over the arcs.
    pub cost: f64,
    /// Rounds of lengths and extraction, and regions relaxed.
    pub rounds: usize,
    pub relaxed: usize,
}

fn refused(reason: impl Into<String>, at: Point) -> Error {
    Error::Layout { reason: reason.into(), at: Some(at) }
}

/// Makes a T-mesh conforming: all its regions four-sided, no T-junctions left.
pub fn conform(layout: &BlockLayout, boundary: &Boundary, targets: &Targets) -> Result<Conforming> {
    layout.check(boundary).map_err(|(reason, at)| refused(reason, at))?;
    let mut work = layout.clone();
    let mut fallback = work.repair(boundary, targets);
    let mut relaxed = 0;
    let mut rounds = 0;
    loop {
        let wanted = LengthTargets::new(&work, boundary, targets);
        let blamed = match settle(&work, boundary, targets, &wanted, &mut rounds)? {
            Ok(settled) => {
                let Settled { layout, lengths, cost, .. } = settled;
                return Ok(Conforming { layout, repaired: work, lengths, fallback, cost, rounds, relaxed });
            }
            Err(blamed) => blamed,
        };
        let at = blamed.first().map_or(Point::origin(), |&r| polyline::mean(&work.polygon(r)));
        if relaxed >= RELAXATIONS || !work.relax(&blamed, &wanted.wanted, boundary, targets) {
            return Err(refused("the regions' lengths contradict each other", at));
        }
        relaxed += 1;
        fallback = fallback.max(PATTERN);
    }
}

/// Lengths that extraction accepts.
struct Settled {
    layout: QuadLayout,
    lengths: Vec<u32>,
    /// Demands for lines that are less aslant.
    aslant: usize,
    cost: f64,
}

impl Settled {
    fn is_better_than(&self, other: &Settled) -> bool {
        (self.aslant, self.cost) < (other.aslant, other.cost)
    }
}

/// Solves and extracts until no demand is left, then looks for cheaper lengths. The inner `Err` names regions
/// that contradict each other.
fn settle(
    work: &BlockLayout,
    boundary: &Boundary,
    targets: &Targets,
    wanted: &LengthTargets,
    rounds: &mut usize,
) -> Result<std::result::Result<Settled, Vec<u32>>> {
    let mut program = LengthProgram::new(work, boundary, wanted);
    let mut made: BTreeSet<(Vec<u32>, u32)> = BTreeSet::new();
    let mut best: Option<Settled> = None;
    let (mut polishes, mut straightenings) = (0, 0);
    loop {
        let lengths = match (program.solve(), best.take()) {
            (Ok(()), b) => {
                best = b;
                program.lengths(work)
            }
            (Err(_), Some(settled)) => return Ok(Ok(settled)),
            (Err(regions), None) => return Ok(Err(regions)),
        };
        *rounds += 1;
        let demands = match extract(work, &lengths, boundary, targets.size) {
            Ok(Extraction::Done(layout)) => {
                let cost = program.flow.cost();
                let straighter = skew::aslant(work, &lengths);
                let settled = Settled { layout, lengths: lengths.arcs, aslant: straighter.len(), cost };
                if best.as_ref().is_none_or(|best| settled.is_better_than(best)) {
                    best = Some(settled);
                }
                polishes += 1;
                program.flow.polish();
                if program.flow.cost() < cost && polishes <= POLISHES {
                    continue;
                }
                straightenings += 1;
                if straightenings <= STRAIGHTENINGS {
                    straighter
                } else {
                    Vec::new()
                }
            }
            Ok(Extraction::Demands(demands)) => demands,
            Err((reason, at)) if best.is_none() => return Err(refused(reason, at)),
            Err(_) => Vec::new(),
        };
        let first = demands.first().map(|d| (d.why, d.at));
        let mut new = false;
        for demand in demands {
            if made.insert((demand.arcs.clone(), demand.at_least)) {
                program.demand(demand.arcs, demand.at_least);
                new = true;
            }
        }
        if !new || *rounds >= ROUNDS {
            return match (best, first) {
                (Some(settled), _) => Ok(Ok(settled)),
                (None, Some((why, at))) => Err(refused(format!("{why}, after {rounds} rounds"), at)),
                (None, None) => Err(refused("no lengths were found", Point::origin())),
            };
        }
    }
}
