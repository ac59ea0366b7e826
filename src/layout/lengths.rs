//! Integer lengths: one for each arc, so that every region can be filled with quads.
//!
//! A four-sided region needs equal sums on opposite sides. A region of k = 3, 5, 6 sides is filled as a
//! star: spokes of length rᵢ ≥ 1 from a centre to each side leave sideᵢ = rᵢ₋₁ + rᵢ₊₁ (the
//! paper's triangle rule is k = 3), so parity and the triangle inequality come by themselves. A chain's
//! total Cₖ is the sum of its arcs, a loop's total the sum of its chains. Then every variable
//! occurs in at most two equations: a [bidirected flow](super::bidirected_flow).

use super::bidirected_flow::{BidirectedFlow, End, Row, Variable};
use super::targets::LengthTargets;
use super::BlockLayout;
use crate::domain::Boundary;
use crate::numerics::NONE;

/// Weight of a spoke's deviation against an arc's: spokes only settle what the arcs leave open.
const SPOKE_WEIGHT: f64 = 0.05;

/// Chains of a loop above which its own total is left out if they imply it.
const MANY_CHAINS: usize = 5000;

/// The lengths of a layout.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lengths {
    pub arcs: Vec<u32>,
    /// Spokes rᵢ of each star region, one a side; empty for four-sided regions.
    pub spokes: Vec<Vec<u32>>,
}

/// The length program of a layout: arcs are the first variables, in order.
#[derive(Debug, Clone)]
pub struct LengthProgram {
    pub flow: BidirectedFlow,
    /// The region that each equation belongs to; `NONE` for chains and loops.
    pub region_of: Vec<u32>,
    arcs: usize,
    /// First spoke variable of each region; `NONE` for four-sided ones.
    spokes: Vec<u32>,
}

impl LengthProgram {
    /// Sets up the program; regions have 3 or more sides.
    pub fn new(layout: &BlockLayout, boundary: &Boundary, targets: &LengthTargets) -> Self {
        let mut ends = vec![Vec::new(); layout.arcs.len()];
        let mut region_of = Vec::new();
        let mut variables: Vec<Variable> = Vec::new();
        let mut spoke_variables = Vec::new();
        let mut spokes = vec![NONE; layout.regions.len()];
        for (r, region) in layout.regions.iter().enumerate() {
            let k = region.sides.len();
            let first = region_of.len() as u32;
            if k == 4 {
                for (s, side) in region.sides.iter().enumerate() {
                    let end = End { equation: first + (s % 2) as u32, sign: if s < 2 { 1 } else { -1 } };
                    side.iter().for_each(|a| ends[a.arc as usize].push(end));
                }
                region_of.extend([r as u32; 2]);
                continue;
            }
            spokes[r] = (layout.arcs.len() + spoke_variables.len()) as u32;
            let mut wanted = vec![0.0; k];
            for (s, side) in region.sides.iter().enumerate() {
                for a in side {
                    ends[a.arc as usize].push(End { equation: first + s as u32, sign: 1 });
                    wanted[s] += targets.wanted[a.arc as usize];
                }
            }
            for i in 0..k {
                let sides = [(i + k - 1) % k, (i + 1) % k];
                spoke_variables.push(Variable {
                    target: (wanted[sides[0]] + wanted[sides[1]]) / 4.0,
                    weight: SPOKE_WEIGHT,
                    lower: 1,
                    ends: sides.map(|s| End { equation: first + s as u32, sign: -1 }),
                });
            }
            region_of.extend(std::iter::repeat_n(r as u32, k));
        }
        let first_chain = region_of.len() as u32;
        let first_loop = first_chain + boundary.chains.len() as u32;
        region_of.extend(std::iter::repeat_n(NONE, boundary.chains.len() + boundary.loops.len()));
        let mut chain_wanted = vec![0.0; boundary.chains.len()];
        for (a, arc) in layout.arcs.iter().enumerate() {
            if let Some(span) = arc.span {
                ends[a].push(End { equation: first_chain + span.chain, sign: 1 });
                chain_wanted[span.chain as usize] += targets.wanted[a];
            }
            ends[a].resize(2, End::FREE);
            let ends = cancelled([ends[a][0], ends[a][1]]);
            let lower = targets.least[a] as i32;
            variables.push(Variable { target: targets.wanted[a], weight: 1.0, lower, ends });
        }
        variables.extend(spoke_variables);
        let mut loop_wanted = vec![0.0; boundary.loops.len()];
        // Where a loop's many chains have that total anyway its equation would only join everything to everything.
        let is_implied = |l: usize| {
            let chains = &boundary.loops[l];
            let total: u32 = chains.iter().map(|c| targets.chain_least[*c as usize]).sum();
            chains.len() > MANY_CHAINS && total >= targets.loop_least[l]
        };
        let implied: Vec<bool> = (0..boundary.loops.len()).map(is_implied).collect();
        for (c, chain) in boundary.chains.iter().enumerate() {
            loop_wanted[chain.loop_index as usize] += chain_wanted[c];
            let in_loop = End { equation: first_loop + chain.loop_index, sign: 1 };
            variables.push(Variable {
                target: chain_wanted[c],
                weight: 0.0,
                lower: targets.chain_least[c] as i32,
                ends: [
                    End { equation: first_chain + c as u32, sign: -1 },
                    if implied[chain.loop_index as usize] { End::FREE } else { in_loop },
                ],
            });
        }
        for (l, &wanted) in loop_wanted.iter().enumerate().filter(|(l, _)| !implied[*l]) {
            let own = End { equation: first_loop + l as u32, sign: -1 };
            let lower = targets.loop_least[l] as i32;
            variables.push(Variable { target: wanted, weight: 0.0, lower, ends: [own, End::FREE] });
        }
        let flow = BidirectedFlow::new(region_of.len(), variables);
        LengthProgram { flow, region_of, arcs: layout.arcs.len(), spokes }
    }

    /// Adds the demand that some arcs have a total length of at least `at_least`.
    pub fn demand(&mut self, arcs: Vec<u32>, at_least: u32) {
        self.flow.add_row(Row { variables: arcs, at_least: at_least as i32 });
    }

    /// Solves, or tells the regions whose equations contradict each other.
    pub fn solve(&mut self) -> Result<(), Vec<u32>> {
        self.flow.solve().map_err(|obstruction| {
            let mut regions: Vec<u32> = obstruction
                .equations
                .iter()
                .filter_map(|&e| self.region_of.get(e as usize).copied())
                .filter(|&r| r != NONE)
                .collect();
            regions.sort_unstable();
            regions.dedup();
            regions
        })
    }

    /// The current lengths.
    pub fn lengths(&self, layout: &BlockLayout) -> Lengths {
        let value = |v: usize| self.flow.values()[v].max(0) as u32;
        let spokes = layout
            .regions
            .iter()
            .zip(&self.spokes)
            .map(|(region, &first)| match first {
                NONE => Vec::new(),
                _ => (0..region.sides.len()).map(|i| value(first as usize + i)).collect(),
            })
            .collect();
        Lengths { arcs: (0..self.arcs).map(value).collect(), spokes }
    }
}

/// An arc that is on opposite sides of one region drops out of its equation.
fn cancelled(ends: [End; 2]) -> [End; 2] {
    let [a, b] = ends;
    if a.equation == b.equation && a.sign == -b.sign {
        [End::FREE; 2]
    } else {
        ends
    }
}
