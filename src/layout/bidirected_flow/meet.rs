//! Cheapest walks between two states, searched from both ends: two small regions instead of a large one.

use super::balance::{Walk, TOO_DEAR};
use super::BidirectedFlow;
use crate::numerics::NONE;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

impl BidirectedFlow {
    /// Cheapest walk from `start` to `goal`, at the costs of [`search`](Self::search) and with its results. Walks to the
    /// goal are those from its opposite, mirrored.
    pub(super) fn meet(&mut self, start: u32, goal: u32, banned: &[u32], too_dear: i64) -> Walk {
        let ground = self.ground();
        // The ground is its own opposite.
        let across = |s: u32| if s == ground { s } else { s ^ 1 };
        let mut sides = [std::mem::take(&mut self.scratch), std::mem::take(&mut self.opposite)];
        let mut heap = BinaryHeap::new();
        let mut reached = vec![start];
        for (k, source) in [start, across(goal)].into_iter().enumerate() {
            sides[k].round += 1;
            sides[k].reach(source, 0, (NONE, NONE, 0));
            heap.push(Reverse((0i64, k, source)));
        }
        // Cost of the best walk so far, and where its halves meet.
        let mut best = (too_dear, NONE);
        while let Some(Reverse((d, k, s))) = heap.peek().copied() {
            // What is not reached yet is as far from both ends.
            if d.saturating_mul(2) >= best.0 {
                break;
            }
            heap.pop();
            if std::mem::replace(&mut sides[k].done[s as usize], true) {
                continue;
            }
            self.allowed(s, banned, |cost, (a, step), t| {
                let (next, known) = (d + cost, sides[k].is_reached(t));
                if known && sides[k].distance[t as usize] <= next {
                    return;
                }
                if !known && k == 0 {
                    reached.push(t);
                }
                sides[k].reach(t, next, (s, a, step));
                heap.push(Reverse((next, k, t)));
                if sides[1 - k].is_reached(across(t)) {
                    let total = next + sides[1 - k].distance[across(t) as usize];
                    if total < best.0 {
                        best = (total, if k == 0 { t } else { across(t) });
                    }
                }
            });
        }
        let mut steps = Vec::new();
        if best.1 != NONE {
            for (side, end) in sides.iter().zip([best.1, across(best.1)]) {
                let mut s = end;
                while side.parent[s as usize].0 != NONE {
                    let (before, a, step) = side.parent[s as usize];
                    steps.push((a, step));
                    s = before;
                }
            }
        }
        [self.scratch, self.opposite] = sides;
        match best.1 {
            NONE if heap.is_empty() => Err(reached),
            NONE => Ok((TOO_DEAR, Vec::new())),
            _ => Ok((best.0, steps)),
        }
    }
}
