//! Large programs: imbalances settled all together, by prices.
//!
//! *In:* a point with imbalances. *Out:* one with few left, near the least cost, and labels for the searches and the
//! descent. Searches for cheapest walks, one for each imbalance, would each go through much of the program.
//!
//! *Method:* every equation has a price, the label of a unit too much there; a unit too little has the opposite. A unit
//! moves along steps that cost less than the labels rise; where there is none its label is lowered. So all
//! steps cost at least what the labels rise but for [`COARSE`] (A. V. Goldberg, R. E. Tarjan, *Finding minimum-cost
//! circulations by successive approximation*, 1990, with one ε).

use super::{BidirectedFlow, COST_UNITS};
use std::collections::VecDeque;

/// What a label is lowered by beyond need, a 16th of a unit of length: less takes longer and gains nothing.
pub(super) const COARSE: i64 = COST_UNITS as i64 / 16;
/// Imbalances left to the searches: the last ones, of which some have no way but through a variable twice, wander about.
const FEW: u64 = 8;
/// Labels below which an imbalance is left to a search: it may have no way out.
const DEEPEST: i64 = -64 * COST_UNITS as i64;
/// Most steps looked at, for each variable.
const MOST_WORK: u64 = 2_000;

/// Prices of the equations, and those out of balance.
struct Market {
    prices: Vec<i64>,
    active: VecDeque<u32>,
    waiting: Vec<bool>,
    /// Occurrence at which each equation goes on.
    cursor: Vec<u32>,
    /// Sum of the imbalances.
    open: u64,
    /// Steps that may still be looked at.
    left: u64,
}

impl Market {
    fn label(&self, state: u32) -> i64 {
        // The ground has no price.
        let price = self.prices.get((state / 2) as usize).copied().unwrap_or(0);
        if state % 2 == 0 {
            price
        } else {
            -price
        }
    }

    /// To be settled.
    fn enqueue(&mut self, equation: u32) {
        if !std::mem::replace(&mut self.waiting[equation as usize], true) {
            self.active.push_back(equation);
        }
    }
}

impl BidirectedFlow {
    /// Settles what imbalances it can.
    pub(super) fn settle_by_prices(&mut self) {
        let price = |e: usize| (self.labels[2 * e] - self.labels[2 * e + 1]) / 2;
        let mut market = Market {
            prices: (0..self.equations).map(price).collect(),
            active: VecDeque::new(),
            waiting: vec![false; self.equations],
            cursor: vec![0; self.equations],
            open: self.excess.iter().map(|e| u64::from(e.unsigned_abs())).sum(),
            left: MOST_WORK * (self.variables.len() as u64 + 100),
        };
        if market.open == 0 {
            return;
        }
        (0..self.equations).filter(|e| self.excess[*e] != 0).for_each(|e| market.enqueue(e as u32));
        while let Some(e) = market.active.pop_front() {
            market.waiting[e as usize] = false;
            if market.open <= FEW {
                break;
            }
            self.settle(e, &mut market);
        }
        // The descent is to look at every state again.
        for s in 0..self.labels.len() as u32 {
            self.labels[s as usize] = market.label(s);
            if !std::mem::replace(&mut self.queued[s as usize], true) {
                self.queue.push_back(s);
            }
        }
    }

    /// Moves the imbalance of equation `e` on.
    fn settle(&mut self, e: u32, market: &mut Market) {
        let own = e as usize;
        let occurrences = self.first[own]..self.first[own + 1];
        // An equation of many variables is not gone through from the start for every unit.
        let mut next = market.cursor[own].max(occurrences.start);
        while self.excess[own] != 0 && market.left > 0 {
            let unit = self.excess[own].signum();
            let s = 2 * e + u32::from(unit < 0);
            let whole = next == occurrences.start;
            // The label with which the best step left would just pay.
            let mut best = i64::MIN;
            while next < occurrences.end && self.excess[own] * unit > 0 {
                market.left = market.left.saturating_sub(1);
                let (a, k) = self.occurrences[next as usize];
                let (near, far) = (self.variables[a as usize].ends[k as usize], 1 - k as usize);
                let far = self.variables[a as usize].ends[far];
                let step = -unit * near.sign;
                let t = self.state(far, far.sign * step);
                let (a, allowed) = (a as usize, step > 0 || self.can_lower(a as usize));
                let cost = self.marginal(a, step);
                if t == s || !allowed || cost + market.label(s) >= market.label(t) {
                    if t != s && allowed {
                        // Lowering the label raises the opposite one.
                        best = best.max(if t == s ^ 1 { -cost / 2 } else { market.label(t) - cost });
                    }
                    next += 1;
                    continue;
                }
                market.open -= self.imbalance(e, t);
                self.apply(&[(a as u32, step)]);
                market.open += self.imbalance(e, t);
                if t != self.ground() {
                    market.enqueue(t / 2);
                }
            }
            if self.excess[own] * unit > 0 {
                next = occurrences.start;
                if whole {
                    if best < DEEPEST {
                        break;
                    }
                    market.prices[own] = (best - COARSE) * i64::from(unit);
                }
            }
        }
        market.cursor[own] = next;
    }

    /// Imbalance of equation `e` and of that of state `t` together.
    fn imbalance(&self, e: u32, t: u32) -> u64 {
        let other = if t == self.ground() || t / 2 == e { 0 } else { self.excess[(t / 2) as usize] };
        u64::from(self.excess[e as usize].unsigned_abs()) + u64::from(other.unsigned_abs())
    }
}
