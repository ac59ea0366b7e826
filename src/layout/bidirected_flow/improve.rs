//! Closed walks of negative cost.

use super::{BidirectedFlow, Step};
use crate::numerics::NONE;
use std::collections::{BTreeSet, VecDeque};

impl BidirectedFlow {
    /// Whether lowering `variable` by one is allowed.
    fn can_lower(&self, variable: usize) -> bool {
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
            let gain: i64 = sum.iter().map(|&(a, step)| self.marginal(a as usize, step)).sum();
            if gain >= 0 || !self.too_low(&sum).is_empty() {
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

    /// Adds closed walks of negative cost until none is left (or a step limit): label correction over
    /// the whole double cover, with a look for cycles in the parent links now and then.
    pub(super) fn improve(&mut self) {
        let states = 2 * self.equations + 1;
        let ground = self.ground() as usize;
        let mut distance = vec![0i64; states];
        let mut parent = vec![(NONE, NONE, 0i32); states];
        let mut queue: VecDeque<u32> = (0..states as u32).collect();
        let mut queued = vec![true; states];
        let mut banned = vec![[false; 2]; self.variables.len()];
        let scan_after = states / 8 + 32;
        let mut changes = 0;
        let mut left = 4_000 * (self.variables.len() as u64 + 100);
        let mut leaving = Vec::new();
        let mut touched = BTreeSet::new();
        while let Some(s) = queue.pop_front() {
            queued[s as usize] = false;
            leaving.clear();
            self.transitions(s, |a, step, t| leaving.push((a, step, t)));
            left = left.saturating_sub(leaving.len() as u64);
            if left == 0 {
                return;
            }
            for &(a, step, t) in &leaving {
                if banned[a][(step > 0) as usize] || (step < 0 && !self.can_lower(a)) {
                    continue;
                }
                let d = distance[s as usize] + self.marginal(a, step);
                if d < distance[t as usize] {
                    distance[t as usize] = d;
                    parent[t as usize] = (s, a as u32, step);
                    changes += 1;
                    if !queued[t as usize] {
                        queued[t as usize] = true;
                        queue.push_back(t);
                    }
                }
            }
            if changes < scan_after && !queue.is_empty() {
                continue;
            }
            changes = 0;
            touched.clear();
            for steps in cycles(&parent) {
                // The mirror image of a walk just taken is refused for good reason: no cause to ban.
                let mirrored = steps.iter().any(|s| touched.contains(&s.0));
                if self.take(&steps) {
                    touched.extend(steps.iter().map(|s| s.0));
                } else if !mirrored {
                    Self::ban(&steps, &mut banned);
                }
                // Labels that rest on a changed variable are worth nothing any more; what
                // leaves the states at its ends, or at those of its rows, has new costs.
                for &(a, _) in &steps {
                    let siblings =
                        self.rows_of[a as usize].iter().flat_map(|&r| &self.rows[r as usize].variables);
                    for &b in siblings.chain([&a]) {
                        for end in self.variables[b as usize].ends {
                            let at = if end.equation == NONE { ground } else { 2 * end.equation as usize };
                            for s in at..(at + 2).min(states) {
                                if parent[s].1 == a {
                                    parent[s] = (NONE, NONE, 0);
                                }
                                if !queued[s] {
                                    queued[s] = true;
                                    queue.push_back(s as u32);
                                }
                            }
                        }
                    }
                }
            }
        }
    }

    /// Bans the steps by which a refused walk went through a variable twice; all of them if there is none.
    fn ban(steps: &[Step], banned: &mut [[bool; 2]]) {
        let mut sorted = steps.to_vec();
        sorted.sort_unstable();
        let mut any = false;
        for pair in sorted.windows(2).filter(|p| p[0] == p[1]) {
            banned[pair[0].0 as usize][(pair[0].1 > 0) as usize] = true;
            any = true;
        }
        if !any {
            for (a, step) in sorted {
                banned[a as usize][(step > 0) as usize] = true;
            }
        }
    }
}

/// The disjoint cycles of the parent links, each as its steps.
fn cycles(parent: &[(u32, u32, i32)]) -> Vec<Vec<Step>> {
    let mut colour = vec![NONE; parent.len()];
    let mut found = Vec::new();
    for start in 0..parent.len() {
        let mut s = start as u32;
        while s != NONE && colour[s as usize] == NONE {
            colour[s as usize] = start as u32;
            s = parent[s as usize].0;
        }
        if s != NONE && colour[s as usize] == start as u32 {
            let mut steps = Vec::new();
            let mut t = s;
            loop {
                let (p, a, step) = parent[t as usize];
                steps.push((a, step));
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
