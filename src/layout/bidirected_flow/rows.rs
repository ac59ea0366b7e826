//! General rows: satisfied one after the other, then chosen better.

use super::balance::{Walk, TOO_DEAR};
use super::{BidirectedFlow, Obstruction, Step, COST_UNITS};

/// Costs up to which walks are looked for, in turn until there is one.
const REACHES: [i64; 3] = [4 * COST_UNITS as i64, 16 * COST_UNITS as i64, TOO_DEAR];

/// Rows times states up to which every row of a large program gets the cheapest walk there is, by searches.
const AFFORDABLE: usize = 3_000_000;
/// Rows raised together else.
const GROUP: usize = 32;

/// Most work of [`BidirectedFlow::polish`]: trials times variables.
const POLISH_WORK: usize = 30_000;

impl BidirectedFlow {
    /// Cheapest closed walk that raises variable `a` by one, if it costs less than `too_dear`.
    fn raising(&mut self, a: u32, too_dear: i64) -> Walk {
        let [tail, head] = self.variables[a as usize].ends;
        let (start, goal) = (self.state(head, head.sign), self.state(tail, -tail.sign));
        let mut own = self.marginal(a as usize, 1);
        if self.by_labels {
            own = (own - self.rise(goal, start)).max(0);
        }
        if start == goal {
            return Ok((own, vec![(a, 1)]));
        }
        // Lowering the variable again would undo the walk.
        let mut banned = vec![a];
        loop {
            let left = too_dear.saturating_sub(own);
            let (cost, mut steps) = match self.by_labels {
                true => self.meet(start, goal, &banned, left)?,
                false => self.search(start, |_, s| s == goal, &banned, left)?,
            };
            if cost == TOO_DEAR {
                return Ok((TOO_DEAR, Vec::new()));
            }
            steps.push((a, 1));
            let sum = Self::summed(&steps);
            let low = self.too_low(&sum);
            if low.is_empty() {
                return Ok((cost + own, sum));
            }
            banned.extend(low);
        }
    }

    /// Applies a walk and makes the rows that it robs dearer.
    fn apply_counting(&mut self, steps: &[Step]) {
        let mut concerned: Vec<u32> =
            steps.iter().flat_map(|s| &self.rows_of[s.0 as usize]).copied().collect();
        concerned.sort_unstable();
        concerned.dedup();
        let before: Vec<i32> = concerned.iter().map(|q| self.row_sums[*q as usize]).collect();
        self.apply(steps);
        for (q, sum_before) in concerned.iter().map(|q| *q as usize).zip(before) {
            if self.row_sums[q] < sum_before && self.row_sums[q] < self.rows[q].at_least {
                self.robbed[q] += 1;
            }
        }
    }

    /// Raises the short rows of a large program, unless they are few: in each the variable that the labels tell to be
    /// cheapest, and what that unbalances is settled for many rows together. What it leaves short is left to searches.
    pub(super) fn raise_rows(&mut self) {
        let is_short = |flow: &Self, r: usize| flow.row_sums[r] < flow.rows[r].at_least;
        let short: Vec<usize> = (0..self.rows.len()).filter(|&r| is_short(self, r)).collect();
        if short.len() * self.labels.len() <= AFFORDABLE {
            return;
        }
        // Rows of one group are spread over all: they hardly meet, and later groups know what the earlier ones cost.
        let groups = short.len().div_ceil(GROUP);
        for group in 0..groups {
            let start = self.point();
            for &r in short.iter().skip(group).step_by(groups) {
                // No closed walk that raises a variable costs less.
                let least = |a: &&u32| {
                    let [tail, head] = self.variables[**a as usize].ends;
                    let [from, to] = [self.state(tail, -tail.sign), self.state(head, head.sign)];
                    self.marginal(**a as usize, 1) - self.rise(from, to)
                };
                let cheapest = self.rows[r].variables.iter().min_by_key(least).copied();
                if let Some(a) = cheapest.filter(|_| is_short(self, r)) {
                    self.apply(&[(a, 1)]);
                }
            }
            self.settle_by_prices();
            if self.balance().is_err() {
                self.restore(&start);
            }
        }
    }

    fn short_row(&self) -> Option<usize> {
        (0..self.rows.len()).find(|&r| self.row_sums[r] < self.rows[r].at_least)
    }

    /// Raises the cheapest variable of every row that is short, by a closed walk through it.
    pub(super) fn satisfy_rows(&mut self) -> Result<(), Obstruction> {
        let mut left = 200 + 20 * self.rows.len();
        while let Some(r) = self.short_row() {
            // Near walks first: the search for one of a variable that has only dear ones goes through everything.
            let mut best: Option<(i64, Vec<Step>)> = None;
            let mut seen = Vec::new();
            for limit in REACHES {
                for a in self.rows[r].variables.clone() {
                    let known = best.as_ref().map_or(limit, |b| b.0);
                    match self.raising(a, known) {
                        Err(states) if limit == TOO_DEAR => seen.extend(states),
                        Ok(walk) if walk.0 < known => best = Some(walk),
                        _ => {}
                    }
                }
                if best.is_some() {
                    break;
                }
            }
            left -= 1;
            match best {
                Some((_, sum)) if left > 0 => self.apply_counting(&sum),
                _ => {
                    seen.sort_unstable();
                    seen.dedup();
                    return Err(Self::obstruction(&seen));
                }
            }
        }
        Ok(())
    }

    /// Looks for a cheaper way to satisfy the rows, which the descent cannot leave once it has taken one: each
    /// row in turn is dropped and satisfied anew by each of its variables. Within a work limit.
    pub fn polish(&mut self) {
        if !self.is_feasible() {
            return;
        }
        let mut trials = POLISH_WORK / self.variables.len().max(1);
        let mut unchanged = 0;
        let mut r = 0;
        while unchanged < self.rows.len() && trials > 0 {
            let row = self.rows[r].clone();
            unchanged += 1;
            // A row with room to spare does not matter.
            if self.row_sums[r] == row.at_least && row.at_least > 0 {
                let start = self.point();
                let mut best = (start.cost, start.clone());
                self.rows[r].at_least = 0;
                self.touch_row(r);
                self.improve();
                let free = self.point();
                self.rows[r].at_least = row.at_least;
                self.touch_row(r);
                if free.cost < start.cost {
                    for &a in row.variables.iter().take(trials) {
                        trials -= 1;
                        self.restore(&free);
                        let mut found = true;
                        while found && self.row_sums[r] < row.at_least {
                            found =
                                self.raising(a, TOO_DEAR).map(|walk| self.apply_counting(&walk.1)).is_ok();
                        }
                        if found && self.satisfy_rows().is_ok() {
                            self.improve();
                            let point = self.point();
                            if point.cost < best.0 {
                                best = (point.cost, point);
                            }
                        }
                    }
                } else {
                    trials -= 1;
                }
                if best.0 < start.cost {
                    unchanged = 0;
                }
                self.restore(&best.1);
            }
            r = (r + 1) % self.rows.len();
        }
    }

    fn point(&self) -> PointOf {
        let cost = (0..self.variables.len()).map(|a| self.cost_at(a, self.values[a])).sum();
        PointOf {
            cost,
            values: self.values.clone(),
            excess: self.excess.clone(),
            rows: self.row_sums.clone(),
        }
    }

    fn restore(&mut self, point: &PointOf) {
        for a in 0..self.values.len() {
            if self.values[a] != point.values[a] {
                self.set(a, point.values[a]);
                for k in 0..self.rows_of[a].len() {
                    self.touch_row(self.rows_of[a][k] as usize);
                }
            }
        }
        self.excess.clone_from(&point.excess);
        self.row_sums.clone_from(&point.rows);
    }
}

/// A point to come back to.
#[derive(Debug, Clone)]
struct PointOf {
    cost: i64,
    values: Vec<i32>,
    excess: Vec<i32>,
    rows: Vec<i32>,
}
