//! Wanted lengths: how many elements each arc should carry.

use super::polyline::Measured;
use super::{BlockLayout, NodeKind};
use crate::domain::Boundary;
use crate::numerics::Point;

/// How a region of five sides becomes quads.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PentagonRule {
    /// Lines from the centre to the five sides: one five-valent vertex.
    #[default]
    Star,
    /// The paper's: a cut from the vertex with the largest inner angle, then the triangle rule.
    Cut,
}

/// What the layout is to be sized for.
#[derive(Clone, Copy)]
pub struct Targets<'a> {
    /// Wanted element size at a point, in the canonical frame, above 0.
    pub size: &'a dyn Fn(Point) -> f64,
    /// Least number of edges on each chain that the boundary tolerance needs (about 1.3 times the least
    /// count); chains it does not tell of, and zeros, count as 1.
    pub chain_minimum: &'a [u32],
    /// Least number of edges of a whole loop; at least 3.
    pub loop_minimum: u32,
    /// How five-sided regions are repaired.
    pub pentagon: PentagonRule,
}

impl<'a> Targets<'a> {
    /// Loops of at least four edges, five-sided regions as stars.
    pub fn new(size: &'a dyn Fn(Point) -> f64, chain_minimum: &'a [u32]) -> Self {
        Targets { size, chain_minimum, loop_minimum: 4, pentagon: PentagonRule::Star }
    }
}

/// Wanted and least lengths of a layout's arcs, chains and loops.
#[derive(Debug, Clone, PartialEq)]
pub struct LengthTargets {
    /// ∫ ds / h of each arc, on the boundary at least its share of the chain's minimum.
    pub wanted: Vec<f64>,
    /// Least length of each arc, 0 or 1.
    pub least: Vec<u32>,
    /// Least total of each chain, at least 1: junctions never merge.
    pub chain_least: Vec<u32>,
    /// Least total of each loop.
    pub loop_least: Vec<u32>,
}

impl LengthTargets {
    /// Measures every arc of `layout`.
    pub fn new(layout: &BlockLayout, boundary: &Boundary, targets: &Targets) -> Self {
        let mut wanted: Vec<f64> =
            layout.arcs.iter().map(|a| Measured::new(&a.points, targets.size).total()).collect();
        let chain_least: Vec<u32> = (0..boundary.chains.len())
            .map(|c| targets.chain_minimum.get(c).copied().unwrap_or(1).max(1))
            .collect();
        let mut chain_wanted = vec![0.0; boundary.chains.len()];
        for (arc, &l) in layout.arcs.iter().zip(&wanted) {
            if let Some(span) = arc.span {
                chain_wanted[span.chain as usize] += l;
            }
        }
        for (arc, l) in layout.arcs.iter().zip(&mut wanted) {
            if let Some(span) = arc.span {
                let c = span.chain as usize;
                *l *= f64::max(1.0, chain_least[c] as f64 / chain_wanted[c].max(f64::MIN_POSITIVE));
            }
        }
        let least = layout.arcs.iter().map(|arc| least_length(layout, arc)).collect();
        let loop_least = vec![targets.loop_minimum.max(3); boundary.loops.len()];
        LengthTargets { wanted, least, chain_least, loop_least }
    }
}

/// 1 for an interior arc whose ends must never merge: both on the boundary, a singularity and the
/// boundary, or two singularities of equal sign; else 0.
fn least_length(layout: &BlockLayout, arc: &super::Arc) -> u32 {
    if arc.span.is_some() {
        return 0;
    }
    let [a, b] = arc.nodes.map(|v| layout.nodes[v as usize].kind);
    let border = |k| matches!(k, NodeKind::Boundary | NodeKind::Junction);
    let apart = match (a, b) {
        (NodeKind::Singularity(x), NodeKind::Singularity(y)) => (x < 4) == (y < 4),
        (NodeKind::Singularity(_), k) | (k, NodeKind::Singularity(_)) => border(k),
        (x, y) => border(x) && border(y),
    };
    apart as u32
}
