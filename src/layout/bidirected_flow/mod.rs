//! Integer programs in which every variable occurs in at most two equations with coefficient ±1.
//!
//! minimise Σ w |n − ℓ| over integers n ≥ lower, with Σ ± n = 0 in every equation: a minimum-cost
//! *bidirected* flow. A change of one variable by ±1 moves a unit of imbalance from one equation to another,
//! so feasible changes are closed walks in the *double cover*, whose states are (equation, sign of the
//! unit that it has too much); equations' free ends share one state, the ground. Imbalances are removed along
//! cheapest walks, then walks of negative cost are added until there is none. From the first
//! balanced point on the point stays feasible. A walk that uses a variable twice has its true (convex) cost
//! checked before it is taken; where that check fails the solution may miss the optimum, by little. Large programs
//! are balanced by prices first, which leaves few walks to be searched.
//!
//! Campen, Bommes, Kobbelt: Quantized global parametrization (2015). Heistermann, Warnett, Bommes:
//! Min-deviation-flow in bi-directed graphs for T-mesh quantization (2023).

mod balance;
mod improve;
mod meet;
mod prices;
mod rows;

use crate::numerics::NONE;
use std::collections::VecDeque;

/// Cost units per unit of weighted deviation: costs are integers, so that comparisons are exact.
const COST_UNITS: f64 = 1e6;
/// Share of a quadratic term in the cost: spreads a deviation over several variables that the
/// absolute value alone would leave to chance.
const SPREAD: f64 = 1e-3;
/// States above which a program is settled by prices first: searches alone take quadratic time.
const LARGE: usize = 8192;

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
    /// Cost of lowering and of raising each variable by one.
    marginals: Vec<[i64; 2]>,
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
    /// The same for the search from the other end.
    opposite: Scratch,
    /// Whether the labels tell the searches what steps are worth.
    by_labels: bool,
    /// Labels of the states that the descent left behind: no allowed step lowers one, but for steps
    /// out of the states in the queue.
    labels: Vec<i64>,
    queue: VecDeque<u32>,
    queued: Vec<bool>,
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

impl Scratch {
    fn new(states: usize) -> Self {
        Scratch {
            round: 0,
            stamp: vec![0; states],
            distance: vec![0; states],
            parent: vec![(NONE, NONE, 0); states],
            done: vec![false; states],
        }
    }

    fn is_reached(&self, state: u32) -> bool {
        self.stamp[state as usize] == self.round
    }

    fn reach(&mut self, state: u32, distance: i64, parent: (u32, u32, i32)) {
        let s = state as usize;
        self.stamp[s] = self.round;
        self.distance[s] = distance;
        self.parent[s] = parent;
        self.done[s] = false;
    }
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
        let rows_of = vec![Vec::new(); variables.len()];
        let mut flow = BidirectedFlow {
            equations,
            marginals: vec![[0; 2]; variables.len()],
            variables,
            values,
            excess,
            first,
            occurrences,
            rows: Vec::new(),
            row_sums: Vec::new(),
            robbed: Vec::new(),
            rows_of,
            scratch: Scratch::new(states),
            opposite: Scratch::new(states),
            by_labels: false,
            labels: vec![0; states],
            queue: (0..states as u32).collect(),
            queued: vec![true; states],
        };
        for a in 0..flow.variables.len() {
            flow.set(a, flow.values[a]);
        }
        flow
    }

    /// The current values.
    pub fn values(&self) -> &[i32] {
        &self.values
    }

    /// The variables.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// The general rows.
    pub fn rows(&self) -> &[Row] {
        &self.rows
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
        let sharing = row.variables.first().map_or(Vec::new(), |a| self.rows_of[*a as usize].clone());
        for r in sharing.into_iter().map(|r| r as usize) {
            let old = &mut self.rows[r];
            let contains = row.variables.iter().all(|a| old.variables.contains(a));
            if contains && row.at_least >= old.at_least {
                // Implied by the new row from now on; no longer in the way of any change.
                old.at_least = 0;
                self.touch_row(r);
            }
        }
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
        self.by_labels = self.labels.len() > LARGE;
        if self.by_labels {
            self.settle_by_prices();
        }
        self.balance()?;
        self.improve();
        if self.rows.iter().zip(&self.row_sums).any(|(r, &s)| s < r.at_least) {
            if self.by_labels {
                self.raise_rows();
            }
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

    /// Cost of changing `variable` by `step`, +1 or -1.
    fn marginal(&self, variable: usize, step: i32) -> i64 {
        self.marginals[variable][(step > 0) as usize]
    }

    fn marginals_at(&self, variable: usize, n: i32) -> [i64; 2] {
        [-1, 1].map(|step| self.cost_at(variable, n + step) - self.cost_at(variable, n))
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
            self.set(a, self.values[a] + step);
            for end in self.variables[a].ends {
                if end.equation != NONE {
                    self.excess[end.equation as usize] += end.sign * step;
                }
            }
            for k in 0..self.rows_of[a].len() {
                let r = self.rows_of[a][k];
                self.row_sums[r as usize] += step;
                self.touch_row(r as usize);
            }
        }
    }

    /// Gives a variable a value, without regard to equations and rows.
    fn set(&mut self, a: usize, n: i32) {
        self.values[a] = n;
        self.marginals[a] = self.marginals_at(a, n);
        self.touch(a);
    }

    /// What leaves the states at a variable's ends is to be looked at again.
    fn touch(&mut self, a: usize) {
        for end in self.variables[a].ends {
            for s in [self.state(end, 1), self.state(end, -1)] {
                if !self.queued[s as usize] {
                    self.queued[s as usize] = true;
                    self.queue.push_back(s);
                }
            }
        }
    }

    /// The same for all variables of a row.
    fn touch_row(&mut self, r: usize) {
        for k in 0..self.rows[r].variables.len() {
            self.touch(self.rows[r].variables[k] as usize);
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
}
