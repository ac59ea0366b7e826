//! Closed walks of negative cost.

use super::prices::COARSE;
use super::{BidirectedFlow, Step};
use crate::numerics::NONE;
use std::collections::BTreeSet;

/// Refused walks after which a descent bans more at a time.
const PATIENCE: usize = 8;
/// Most label changes between two looks for cycles. In a large program few cycles are left after the first sweeps, and
/// labels go round each of them until somebody looks.
const SCAN_AFTER: usize = 1024;

/// Most steps of the descent, for each variable: far more than a small program takes ...
const STEPS: u64 = 4_000;
/// ... and where prices have brought a large one near the least cost: ten times as many gained 0.02 % on one of 45,000
/// variables.
const STEPS_BY_LABELS: u64 = 20;

impl BidirectedFlow {
    /// Whether lowering `variable` by one is allowed.
    pub(super) fn can_lower(&self, variable: usize) -> bool {
        self.values[variable] > self.variables[variable].lower
            && self.rows_of[variable]
                .iter()
                .all(|&r| self.row_sums[r as usize] > self.rows[r as usize].at_least)
    }

    /// Takes the closed walk `steps` as often as it lowers the true cost and breaks nothing.
    /// Returns whether it did so at all.
    fn take(&mut self, steps: &[Step]) -> bool {
        let sum = Self::summed(steps);
        let mut taken = false;
        loop {
            // A variable passed twice changes by two, which costs more than twice one.
            let change = |&(a, step): &Step| {
                let (a, n) = (a as usize, self.values[a as usize]);
                self.cost_at(a, n + step) - self.cost_at(a, n)
            };
            if sum.iter().map(change).sum::<i64>() >= 0 || !self.too_low(&sum).is_empty() {
                return taken;
            }
            self.apply(&sum);
            let rows = sum.iter().flat_map(|s| &self.rows_of[s.0 as usize]);
            if rows.into_iter().any(|&r| self.row_sums[r as usize] < self.rows[r as usize].at_least) {
                let back: Vec<Step> = sum.iter().map(|s| (s.0, -s.1)).collect();
                self.apply(&back);
                return taken;
            }
            taken = true;
        }
    }

    /// Adds closed walks of negative cost until none is left (or a step limit): label correction over the
    /// double cover from the states in the queue on, with a look for cycles in the parent links now and then.
    pub(super) fn improve(&mut self) {
        // In a large program cycles that gain less than that for each of their steps are left: it takes most of the
        // time to find them, and they are worth a few parts in 10,000 of the cost.
        let slack = if self.by_labels { COARSE } else { 0 };
        let states = self.labels.len();
        let mut parent = vec![(NONE, NONE, 0i32); states];
        let mut banned: BTreeSet<(u32, Step)> = BTreeSet::new();
        let scan_after = states / 8 + 32;
        // Every cycle of parent links runs through one that is new since the last look.
        let mut changed: Vec<u32> = Vec::new();
        let mut cycles = Cycles::new(states);
        let steps = if self.by_labels { STEPS_BY_LABELS } else { STEPS };
        let mut left = steps * (self.variables.len() as u64 + 100);
        let mut leaving = Vec::new();
        let mut taken = BTreeSet::new();
        let mut refusals = 0;
        while let Some(s) = self.queue.pop_front() {
            self.queued[s as usize] = false;
            leaving.clear();
            self.transitions(s, |a, step, t| leaving.push((a, step, t)));
            left = left.saturating_sub(leaving.len() as u64);
            if left == 0 {
                break;
            }
            for &(a, step, t) in &leaving {
                let label = self.labels[s as usize] + self.marginal(a, step);
                if label + slack >= self.labels[t as usize]
                    || (step < 0 && !self.can_lower(a))
                    || banned.contains(&(s, (a as u32, step)))
                {
                    continue;
                }
                self.labels[t as usize] = label;
                parent[t as usize] = (s, a as u32, step);
                changed.push(t);
                if !self.queued[t as usize] {
                    self.queued[t as usize] = true;
                    self.queue.push_back(t);
                }
            }
            let enough = scan_after.min(SCAN_AFTER.max(cycles.visited));
            if changed.is_empty() || (changed.len() < enough && !self.queue.is_empty()) {
                continue;
            }
            let found = if scan_after <= SCAN_AFTER {
                cycles.find(&parent, 0..states as u32)
            } else {
                changed.sort_unstable();
                cycles.find(&parent, changed.iter().copied())
            };
            changed.clear();
            taken.clear();
            for walk in found {
                let steps: Vec<Step> = walk.iter().map(|w| w.1).collect();
                // The mirror image of a walk just taken is refused for good reason: no cause to ban.
                let mirrored = steps.iter().any(|s| taken.contains(&s.0));
                if self.take(&steps) {
                    taken.extend(steps.iter().map(|s| s.0));
                } else if !mirrored {
                    refusals += 1;
                    Self::ban(walk, refusals > PATIENCE, &mut banned);
                }
                // Labels that rest on a changed or banned step are worth nothing any more.
                for &(a, _) in &steps {
                    for end in self.variables[a as usize].ends {
                        for t in [self.state(end, 1), self.state(end, -1)] {
                            if parent[t as usize].1 == a {
                                parent[t as usize] = (NONE, NONE, 0);
                            }
                        }
                    }
                    self.touch(a as usize);
                }
            }
        }
        // The next descent may try again what was banned in this one.
        banned.into_iter().for_each(|(_, (a, _))| self.touch(a as usize));
    }

    /// A refused walk went through a variable twice: bans one of the two passages, so that walks which pass once
    /// remain possible (from the other side), or `both`. All of its steps if there is none.
    fn ban(mut walk: Vec<(u32, Step)>, both: bool, banned: &mut BTreeSet<(u32, Step)>) {
        walk.sort_unstable_by_key(|&(state, step)| (step, state));
        let kept = if both { 0 } else { 1 };
        let twice: Vec<_> =
            walk.windows(2).filter(|p| p[0].1 == p[1].1).flat_map(|p| p[kept..].to_vec()).collect();
        banned.extend(if twice.is_empty() { walk } else { twice });
    }
}

/// Looks for cycles of parent links.
struct Cycles {
    /// The walk that came by each state last; walks are numbered through all looks.
    walk: Vec<u64>,
    walks: u64,
    /// States passed in the last look.
    visited: usize,
}

impl Cycles {
    fn new(states: usize) -> Self {
        Cycles { walk: vec![0; states], walks: 0, visited: 0 }
    }

    /// The disjoint cycles that the links lead to from `starts`, each as its steps with the states that they leave.
    fn find(
        &mut self,
        parent: &[(u32, u32, i32)],
        starts: impl Iterator<Item = u32>,
    ) -> Vec<Vec<(u32, Step)>> {
        let mut found = Vec::new();
        let before = self.walks;
        self.visited = 0;
        for start in starts {
            self.walks += 1;
            let mut s = start;
            while s != NONE && self.walk[s as usize] <= before {
                self.walk[s as usize] = self.walks;
                self.visited += 1;
                s = parent[s as usize].0;
            }
            if s != NONE && self.walk[s as usize] == self.walks {
                let mut steps = Vec::new();
                let mut t = s;
                loop {
                    let (p, a, step) = parent[t as usize];
                    steps.push((p, (a, step)));
                    t = p;
                    if t == s {
                        break;
                    }
                }
                found.push(steps);
            }
        }
        found
    }
}
