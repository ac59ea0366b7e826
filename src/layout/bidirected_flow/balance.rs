//! Cheapest walks in the double cover, and the first feasible point.

use super::{BidirectedFlow, Obstruction, Step};
use crate::numerics::NONE;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Cost of taking a unit from a general row that has none to spare.
const ROW_PENALTY: i64 = 1_000_000_000;

/// Searches from all imbalances at once go on while one settles this share, 1 in so many, of them.
const TOGETHER_WORTH: u64 = 64;

/// Cost of a walk that nobody looked for to the end.
pub(super) const TOO_DEAR: i64 = i64::MAX;

/// Cost and steps of a walk; or, if there is none, the states that were reached.
pub(super) type Walk = Result<(i64, Vec<Step>), Vec<u32>>;

impl BidirectedFlow {
    /// Cheapest walk from `start` to a state that `is_goal` accepts; marginal costs below 0 count as 0, and where
    /// labels are known those below what these allow for.
    /// `banned` variables are not lowered, and rows that have nothing to spare at a high price
    /// only (they are satisfied anew afterwards). A walk that costs `too_dear` or more is none: it comes as
    /// [`TOO_DEAR`] without steps. `Err`: the states that were reached.
    pub(super) fn search(
        &mut self,
        start: u32,
        is_goal: impl Fn(&Self, u32) -> bool,
        banned: &[u32],
        too_dear: i64,
    ) -> Walk {
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.round += 1;
        let round = scratch.round;
        let mut heap = BinaryHeap::new();
        let mut reached = vec![start];
        scratch.stamp[start as usize] = round;
        scratch.distance[start as usize] = 0;
        scratch.done[start as usize] = false;
        scratch.parent[start as usize] = (NONE, NONE, 0);
        heap.push(Reverse((0i64, start)));
        let mut found = None;
        while let Some(Reverse((d, s))) = heap.pop() {
            if scratch.done[s as usize] {
                continue;
            }
            if d >= too_dear {
                found = Some((TOO_DEAR, start));
                break;
            }
            scratch.done[s as usize] = true;
            if s != start && is_goal(self, s) {
                found = Some((d, s));
                break;
            }
            self.allowed(s, banned, |cost, (a, step), t| {
                let i = t as usize;
                let fresh = scratch.stamp[i] != round;
                if fresh || d + cost < scratch.distance[i] {
                    if fresh {
                        reached.push(t);
                        scratch.done[i] = false;
                    } else if scratch.done[i] {
                        return;
                    }
                    scratch.stamp[i] = round;
                    scratch.distance[i] = d + cost;
                    scratch.parent[i] = (s, a, step);
                    heap.push(Reverse((d + cost, t)));
                }
            });
        }
        let result = match found {
            None => Err(reached),
            Some((d, goal)) => {
                let mut steps = Vec::new();
                let mut s = goal;
                while s != start {
                    let (p, a, step) = scratch.parent[s as usize];
                    steps.push((a, step));
                    s = p;
                }
                Ok((d, steps))
            }
        };
        self.scratch = scratch;
        result
    }

    /// By how much the label of `to` is above that of `from`: what a step between them has to cost at least.
    pub(super) fn rise(&self, from: u32, to: u32) -> i64 {
        self.labels[to as usize] - self.labels[from as usize]
    }

    /// Calls `f(cost, step, next state)` for every way to leave `state` that is allowed.
    pub(super) fn allowed(&self, state: u32, banned: &[u32], mut f: impl FnMut(i64, Step, u32)) {
        self.transitions(state, |a, step, t| {
            let rise = if self.by_labels { self.rise(state, t) } else { 0 };
            let mut cost = (self.marginal(a, step) - rise).max(0) + 1;
            if step < 0 {
                if self.values[a] <= self.variables[a].lower || banned.contains(&(a as u32)) {
                    return;
                }
                for &r in &self.rows_of[a] {
                    if self.row_sums[r as usize] <= self.rows[r as usize].at_least {
                        cost += ROW_PENALTY * (1 + self.robbed[r as usize]);
                    }
                }
            }
            f(cost, (a as u32, step), t);
        });
    }

    /// Whether a unit that left the imbalance of equation `from` is of use in state `s`.
    fn settles(&self, from: usize, s: u32) -> bool {
        if s == self.ground() {
            return true;
        }
        let unit = if s % 2 == 0 { 1 } else { -1 };
        let other = (s / 2) as usize;
        // The walk's own start has already lost one unit.
        self.excess[other] * unit < 0 && (other != from || self.excess[from].abs() >= 2)
    }

    /// One search from all imbalances at once; walks are applied as they arrive. Their number. A dozen of these
    /// settle some two thirds of the imbalances of a large program; each further one settles few.
    fn balance_together(&mut self) -> usize {
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.round += 1;
        let round = scratch.round;
        // (distance, state, state that the walk started from, the state before, variable and step)
        let mut heap = BinaryHeap::new();
        for e in (0..self.equations).filter(|e| self.excess[*e] != 0) {
            let start = 2 * e as u32 + (self.excess[e] < 0) as u32;
            heap.push(Reverse((0i64, start, start, NONE, NONE, 0i32)));
        }
        let mut walks = 0;
        while let Some(Reverse((d, s, from, before, a, step))) = heap.pop() {
            let ground = s == self.ground();
            let unit = if from % 2 == 0 { 1 } else { -1 };
            let settled = self.excess[(from / 2) as usize] * unit <= 0;
            if settled || (scratch.stamp[s as usize] == round && !ground) {
                continue;
            }
            if !ground {
                scratch.stamp[s as usize] = round;
                scratch.parent[s as usize] = (before, a, step);
            }
            if before != NONE && self.settles((from / 2) as usize, s) {
                let mut steps = vec![(a, step)];
                let mut t = before;
                while scratch.parent[t as usize].0 != NONE {
                    let (p, a, step) = scratch.parent[t as usize];
                    steps.push((a, step));
                    t = p;
                }
                let sum = Self::summed(&steps);
                if self.too_low(&sum).is_empty() {
                    self.apply(&sum);
                    walks += 1;
                }
                continue;
            }
            self.allowed(s, &[], |cost, (a, step), t| {
                if scratch.stamp[t as usize] != round || t == self.ground() {
                    heap.push(Reverse((d + cost, t, from, s, a, step)));
                }
            });
        }
        self.scratch = scratch;
        walks
    }

    /// The equations among `states` that occur with one sign only: these sum to the contradiction.
    pub(super) fn obstruction(states: &[u32]) -> Obstruction {
        let mut sorted = states.to_vec();
        sorted.sort_unstable();
        let single: Vec<u32> =
            sorted.iter().filter(|&&s| sorted.binary_search(&(s ^ 1)).is_err()).map(|&s| s / 2).collect();
        let mut equations = if single.is_empty() { sorted.iter().map(|s| s / 2).collect() } else { single };
        equations.dedup();
        Obstruction { equations }
    }

    /// The variables that the summed steps would take below their lower bound.
    pub(super) fn too_low(&self, sum: &[Step]) -> Vec<u32> {
        sum.iter()
            .filter(|&&(a, step)| {
                step < 0 && self.values[a as usize] + step < self.variables[a as usize].lower
            })
            .map(|s| s.0)
            .collect()
    }

    /// Makes every equation hold by walks from an imbalance to an opposite one or to the ground.
    pub(super) fn balance(&mut self) -> Result<(), Obstruction> {
        loop {
            let left: u64 = self.excess.iter().map(|e| e.unsigned_abs() as u64).sum();
            let walks = self.balance_together() as u64;
            if walks == 0 || walks * TOGETHER_WORTH < left {
                break;
            }
        }
        for e in 0..self.equations {
            while self.excess[e] != 0 {
                let start = 2 * e as u32 + (self.excess[e] < 0) as u32;
                let goal = |flow: &Self, s: u32| flow.settles(e, s);
                let mut banned = Vec::new();
                loop {
                    match self.search(start, goal, &banned, TOO_DEAR) {
                        Err(states) => return Err(Self::obstruction(&states)),
                        Ok((_, steps)) => {
                            let sum = Self::summed(&steps);
                            let low = self.too_low(&sum);
                            if low.is_empty() {
                                self.apply(&sum);
                                break;
                            }
                            banned.extend(low);
                        }
                    }
                }
            }
        }
        Ok(())
    }
}
