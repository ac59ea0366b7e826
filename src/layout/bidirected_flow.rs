//! Integer programs in which every variable occurs in at most two equations with coefficient ±1.
//!
//! minimise Σ w |n − ℓ| over integers n ≥ lower, with Σ ± n = 0 in every equation: a minimum-cost
//! *bidirected* flow. A change of one variable by ±1 moves a unit of imbalance from one equation to another,
//! so feasible changes are closed walks in the *double cover*, whose states are (equation, sign of the
//! unit that it has too much); equations' free ends share one state, the ground. Imbalances are removed along
//! cheapest walks, then walks of negative cost are added until there is none. From the first
//! balanced point on the point stays feasible. A walk that uses a variable twice has its true (convex) cost
//! checked before it is taken; where that check fails the solution may miss the optimum, by little.
//!
//! Campen, Bommes, Kobbelt: Quantized global parametrization (2015). Heistermann, Warnett, Bommes:
//! Min-deviation-flow in bi-directed graphs for T-mesh quantization (2023).

use crate::numerics::NONE;
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap, VecDeque};

/// Cost units per unit of weighted deviation: costs are integers, so that comparisons are exact.
const COST_UNITS: f64 = 1e6;
/// Share of a quadratic term in the cost: spreads a deviation over several variables that the
/// absolute value alone would leave to chance.
const SPREAD: f64 = 1e-3;
/// Cost of taking a unit from a general row that has none to spare.
const ROW_PENALTY: i64 = 1_000_000_000;

/// One occurrence of a variable: the equation (`NONE`: a free end) and its coefficient, +1 or −1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct End {
    pub equation: u32,
    pub sign: i32,
}

impl End {
    /// An end in no equation.
    pub const FREE: End = End { equation: NONE, sign: 1 };
}

/// An integer ≥ `lower`, wanted near `target`, at the cost `weight` · |n − target|.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variable {
    pub target: f64,
    pub weight: f64,
    pub lower: i32,
    pub ends: [End; 2],
}

/// A general row: the sum of some variables is at least `at_least`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    pub variables: Vec<u32>,
    pub at_least: i32,
}

/// Why there is no solution: the equations that contradict each other, as far as the search
/// could tell.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Obstruction {
    pub equations: Vec<u32>,
}

/// A step of a walk: variable, and its change ±1.
type Step = (u32, i32);

/// The program and its current point.
#[derive(Debug, Clone)]
pub struct BidirectedFlow {
    equations: usize,
    variables: Vec<Variable>,
    values: Vec<i32>,
    /// Σ ± n of each equation.
    excess: Vec<i32>,
    /// Occurrences (variable, which end) of equation e: `occurrences[first[e]..first[e + 1]]`; the last
    /// "equation" is the ground.
    first: Vec<u32>,
    occurrences: Vec<(u32, u8)>,
    rows: Vec<Row>,
    row_sums: Vec<i32>,
    /// How often each row was robbed: makes it dearer, so that rows cannot rob each other forever.
    robbed: Vec<i64>,
    rows_of: Vec<Vec<u32>>,
    scratch: Scratch,
}

/// Work arrays of the shortest-walk search, valid where `stamp` is current.
#[derive(Debug, Clone, Default)]
struct Scratch {
    round: u32,
    stamp: Vec<u32>,
    distance: Vec<i64>,
    parent: Vec<(u32, u32, i32)>,
    done: Vec<bool>,
}

impl BidirectedFlow {
    /// Starts from every variable at its rounded target. Equations are 0..`equations`.
    pub fn new(equations: usize, variables: Vec<Variable>) -> Self {
        let values: Vec<i32> =
            variables.iter().map(|v| v.lower.max(v.target.round().min(1e6) as i32)).collect();
        let ground = equations;
        let slot = |end: End| if end.equation == NONE { ground } else { end.equation as usize };
        let mut first = vec![0u32; equations + 2];
        let mut excess = vec![0; equations];
        for (variable, &n) in variables.iter().zip(&values) {
            for end in variable.ends {
                first[slot(end) + 1] += 1;
                if end.equation != NONE {
                    excess[end.equation as usize] += end.sign * n;
                }
            }
        }
        for e in 0..=equations {
            first[e + 1] += first[e];
        }
        let mut next = first.clone();
        let mut occurrences = vec![(0, 0); 2 * variables.len()];
        for (a, variable) in variables.iter().enumerate() {
            for (k, &end) in variable.ends.iter().enumerate() {
                occurrences[next[slot(end)] as usize] = (a as u32, k as u8);
                next[slot(end)] += 1;
            }
        }
        let states = 2 * equations + 1;
        let scratch = Scratch {
            round: 0,
            stamp: vec![0; states],
            distance: vec![0; states],
            parent: vec![(NONE, NONE, 0); states],
            done: vec![false; states],
        };
        let rows_of = vec![Vec::new(); variables.len()];
        BidirectedFlow {
            equations,
            variables,
            values,
            excess,
            first,
            occurrences,
            rows: Vec::new(),
            row_sums: Vec::new(),
            robbed: Vec::new(),
            rows_of,
            scratch,
        }
    }

    /// The current values.
    pub fn values(&self) -> &[i32] {
        &self.values
    }

    /// Σ w |n − ℓ| of the current values.
    pub fn cost(&self) -> f64 {
        self.variables.iter().zip(&self.values).map(|(v, &n)| v.weight * (n as f64 - v.target).abs()).sum()
    }

    /// Whether all equations, bounds and rows hold.
    pub fn is_feasible(&self) -> bool {
        self.excess.iter().all(|&e| e == 0)
            && self.variables.iter().zip(&self.values).all(|(v, &n)| n >= v.lower)
            && self.rows.iter().zip(&self.row_sums).all(|(r, &s)| s >= r.at_least)
    }

    /// Adds a general row; the next [`solve`](Self::solve) goes on from the current point.
    pub fn add_row(&mut self, row: Row) {
        let index = self.rows.len() as u32;
        for &a in &row.variables {
            self.rows_of[a as usize].push(index);
        }
        self.row_sums.push(row.variables.iter().map(|&a| self.values[a as usize]).sum());
        self.robbed.push(0);
        self.rows.push(row);
    }

    /// Balances the equations, satisfies the rows, then lowers the cost.
    pub fn solve(&mut self) -> Result<(), Obstruction> {
        self.balance()?;
        self.improve();
        if self.rows.iter().zip(&self.row_sums).any(|(r, &s)| s < r.at_least) {
            self.satisfy_rows()?;
            self.improve();
        }
        Ok(())
    }

    fn cost_at(&self, variable: usize, n: i32) -> i64 {
        let v = &self.variables[variable];
        let d = (n as f64 - v.target).abs();
        (COST_UNITS * v.weight * d * (1.0 + SPREAD * d)).round() as i64
    }

    /// Cost of changing `variable` by `step`.
    fn marginal(&self, variable: usize, step: i32) -> i64 {
        let n = self.values[variable];
        self.cost_at(variable, n + step) - self.cost_at(variable, n)
    }

    fn ground(&self) -> u32 {
        2 * self.equations as u32
    }

    /// The state in which `end`'s equation has `unit` (±1) too much; the ground at a free end.
    fn state(&self, end: End, unit: i32) -> u32 {
        if end.equation == NONE {
            self.ground()
        } else {
            2 * end.equation + (unit < 0) as u32
        }
    }

    /// Calls `f(variable, step, next state)` for every way to leave `state`, whether allowed or not.
    fn transitions(&self, state: u32, mut f: impl FnMut(usize, i32, u32)) {
        let slot = (state / 2) as usize;
        let range = self.first[slot] as usize..self.first[slot + 1] as usize;
        for &(a, k) in &self.occurrences[range] {
            let ends = &self.variables[a as usize].ends;
            let (near, far) = (ends[k as usize], ends[1 - k as usize]);
            if near.equation == NONE {
                if far.equation != NONE {
                    for step in [-1, 1] {
                        f(a as usize, step, self.state(far, far.sign * step));
                    }
                }
            } else {
                let unit = if state % 2 == 0 { 1 } else { -1 };
                let step = -unit * near.sign;
                f(a as usize, step, self.state(far, far.sign * step));
            }
        }
    }

    fn apply(&mut self, steps: &[Step]) {
        for &(a, step) in steps {
            let a = a as usize;
            self.values[a] += step;
            for end in self.variables[a].ends {
                if end.equation != NONE {
                    self.excess[end.equation as usize] += end.sign * step;
                }
            }
            for &r in &self.rows_of[a] {
                self.row_sums[r as usize] += step;
            }
        }
    }

    /// A walk's steps summed by variable.
    fn summed(steps: &[Step]) -> Vec<Step> {
        let mut sum = steps.to_vec();
        sum.sort_unstable();
        sum.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        sum.retain(|s| s.1 != 0);
        sum
    }

    /// Cheapest walk from `start` to a state that `is_goal` accepts; marginal costs below 0 count as 0.
    /// `banned` variables are not lowered. `Err`: the states that were reached.
    fn search(
        &mut self,
        start: u32,
        is_goal: impl Fn(&Self, u32) -> bool,
        banned: &[u32],
        rob_rows: bool,
    ) -> Result<(i64, Vec<Step>), Vec<u32>> {
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
            scratch.done[s as usize] = true;
            if s != start && is_goal(self, s) {
                found = Some((d, s));
                break;
            }
            self.transitions(s, |a, step, t| {
                let mut cost = self.marginal(a, step).max(0) + 1;
                if step < 0 {
                    if self.values[a] <= self.variables[a].lower || banned.contains(&(a as u32)) {
                        return;
                    }
                    for &r in &self.rows_of[a] {
                        if self.row_sums[r as usize] <= self.rows[r as usize].at_least {
                            if !rob_rows {
                                return;
                            }
                            cost += ROW_PENALTY * (1 + self.robbed[r as usize]);
                        }
                    }
                }
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
                    scratch.parent[i] = (s, a as u32, step);
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

    /// The equations among `states` that occur with one sign only: these sum to the contradiction.
    fn obstruction(states: &[u32]) -> Obstruction {
        let mut sorted = states.to_vec();
        sorted.sort_unstable();
        let single: Vec<u32> =
            sorted.iter().filter(|&&s| sorted.binary_search(&(s ^ 1)).is_err()).map(|&s| s / 2).collect();
        let mut equations = if single.is_empty() { sorted.iter().map(|s| s / 2).collect() } else { single };
        equations.dedup();
        Obstruction { equations }
    }

    /// The variables that the summed steps would take below their lower bound.
    fn too_low(&self, sum: &[Step]) -> Vec<u32> {
        sum.iter()
            .filter(|&&(a, step)| {
                step < 0 && self.values[a as usize] + step < self.variables[a as usize].lower
            })
            .map(|s| s.0)
            .collect()
    }

    /// Makes every equation hold by walks from an imbalance to an opposite one or to the ground.
    fn balance(&mut self) -> Result<(), Obstruction> {
        for e in 0..self.equations {
            while self.excess[e] != 0 {
                let start = 2 * e as u32 + (self.excess[e] < 0) as u32;
                let goal = |flow: &Self, s: u32| {
                    if s == flow.ground() {
                        return true;
                    }
                    let unit = if s % 2 == 0 { 1 } else { -1 };
                    let other = (s / 2) as usize;
                    // The walk's own start has already lost one unit.
                    flow.excess[other] * unit < 0 && (other != e || flow.excess[e].abs() >= 2)
                };
                let mut banned = Vec::new();
                loop {
                    match self.search(start, goal, &banned, false) {
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

    /// Raises the cheapest variable of every row that is short, by a closed walk through it.
    fn satisfy_rows(&mut self) -> Result<(), Obstruction> {
        let mut left = 200 + 20 * self.rows.len();
        while let Some(r) = (0..self.rows.len()).find(|&r| self.row_sums[r] < self.rows[r].at_least) {
            let mut best: Option<(i64, Vec<Step>)> = None;
            let mut seen = Vec::new();
            for a in self.rows[r].variables.clone() {
                let [tail, head] = self.variables[a as usize].ends;
                let (start, goal) = (self.state(head, head.sign), self.state(tail, -tail.sign));
                let own = self.marginal(a as usize, 1);
                if start == goal {
                    if best.as_ref().is_none_or(|b| own < b.0) {
                        best = Some((own, vec![(a, 1)]));
                    }
                    continue;
                }
                // Lowering the variable again would undo the walk.
                let mut banned = vec![a];
                for _ in 0..20 {
                    match self.search(start, |_, s| s == goal, &banned, true) {
                        Err(states) => {
                            seen.extend(states);
                            break;
                        }
                        Ok((cost, mut steps)) => {
                            steps.push((a, 1));
                            let sum = Self::summed(&steps);
                            let low = self.too_low(&sum);
                            if low.is_empty() {
                                if best.as_ref().is_none_or(|b| cost + own < b.0) {
                                    best = Some((cost + own, sum));
                                }
                                break;
                            }
                            banned.extend(low);
                        }
                    }
                }
            }
            left -= 1;
            match best {
                Some((_, sum)) if left > 0 => {
                    let before = self.row_sums.clone();
                    self.apply(&sum);
                    for (q, &sum_before) in before.iter().enumerate() {
                        if self.row_sums[q] < sum_before && self.row_sums[q] < self.rows[q].at_least {
                            self.robbed[q] += 1;
                        }
                    }
                }
                _ => {
                    seen.sort_unstable();
                    seen.dedup();
                    return Err(Self::obstruction(&seen));
                }
            }
        }
        Ok(())
    }

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
    fn improve(&mut self) {
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
