//! Room for boundary edges that break the tolerance: vertices of a stretch of one chain are moved,
//! as few as possible.

use super::pieces::growth;
use super::placement::place_equal_error;
use crate::domain::Chain;
use crate::mesh::BoundaryError;
use crate::numerics::tolerances::ORDER_TIE;

/// Share of the tolerance that re-spaced edges aim at: room for the optimiser to slide.
const AIM: f64 = 0.9;
/// An edge is left alone up to this share.
pub(super) const ALLOWED: f64 = 0.97;
/// An edge takes over at most this multiple of its length in one round.
const STRETCH: f64 = 1.6;
/// Rounds for one window.
const ROUNDS: usize = 8;

/// Consecutive edges of one chain.
#[derive(Debug, Clone)]
pub(super) struct Stretch<'a> {
    pub curve: &'a Chain,
    pub error: &'a BoundaryError,
    /// Arc lengths of the ends of the edges, unwrapped.
    pub ends: Vec<f64>,
    /// Whether these are all edges of the chain; then a closed chain's last vertex is the first.
    pub whole: bool,
}

/// New ends of a stretch's edges.
pub(super) struct Room {
    pub ends: Vec<f64>,
    /// The whole chain was placed anew: every edge keeps the tolerance, maybe with less room than usual.
    pub all: bool,
}

/// The largest of `ratios` above what is allowed; of those that differ by rounding the last.
pub(super) fn worst_of(ratios: &[f64]) -> Option<usize> {
    let rank = |i: &usize| (ratios[*i] / ORDER_TIE).round();
    (0..ratios.len()).filter(|i| ratios[*i] > ALLOWED).max_by(|a, b| rank(a).total_cmp(&rank(b)))
}

impl Stretch<'_> {
    /// Moves vertices until all edges keep the tolerance, near the offending ones first; `false` if it
    /// cannot be done.
    pub fn relax(&mut self) -> bool {
        let mut ratios: Vec<f64> = (0..self.len()).map(|i| self.ratio(&self.ends, i)).collect();
        while let Some(worst) = worst_of(&ratios) {
            let Some(Room { ends, all }) = self.make_room(worst) else { return false };
            for i in 0..self.len() {
                if ends[i] != self.ends[i] || ends[i + 1] != self.ends[i + 1] {
                    ratios[i] = self.ratio(&ends, i);
                }
            }
            self.ends = ends;
            if all {
                return true;
            }
        }
        true
    }

    fn len(&self) -> usize {
        self.ends.len() - 1
    }

    /// Whether the last vertex is the first and may move; a loop from a junction back to it is open.
    fn closed(&self) -> bool {
        self.whole && self.curve.ends.is_none()
    }

    /// Error of edge `i` for such `ends`, divided by the tolerance; indices go on past a closed stretch's end.
    fn ratio(&self, ends: &[f64], i: usize) -> f64 {
        let n = self.len();
        self.error.of_chain(self.curve, ends[i % n], ends[i % n + 1]) / self.error.tolerance.value
    }

    /// New ends with which edge `at` keeps the tolerance, and no edge near it breaks it.
    pub fn make_room(&self, at: usize) -> Option<Room> {
        let n = self.len();
        let mut reach = 1;
        // Errors of the edges as they are: each window begins with those of the windows in it.
        let mut known = vec![None; n];
        loop {
            let width = (2 * reach + 1).min(n);
            let low = if self.closed() {
                (at + n - reach.min(n / 2)) % n
            } else {
                at.saturating_sub(reach).min(n - width)
            };
            if let Some(lengths) = self.share_out(low, width, &mut known) {
                let mut ends = self.ends.clone();
                self.apply(&mut ends, low, &lengths);
                return Some(Room { ends, all: false });
            }
            if width == n {
                return self.whole_chain().map(|ends| Room { ends, all: true });
            }
            // Wide windows grow by a quarter each: all together cost some times the last.
            reach += 1 + reach / 4;
        }
    }

    /// New lengths of the `width` edges from `low` on, all within the tolerance; `None` if they have no
    /// room. `known`: the errors of edges as they are, as far as they were asked for.
    fn share_out(&self, low: usize, width: usize, known: &mut [Option<f64>]) -> Option<Vec<f64>> {
        let n = self.len();
        let exponent = 1.0 / growth(self.error);
        let mut trial = self.ends.clone();
        let mut lengths: Vec<f64> =
            (low..low + width).map(|i| self.ends[i % n + 1] - self.ends[i % n]).collect();
        let total: f64 = lengths.iter().sum();
        let mut ratios: Vec<f64> = (low..low + width)
            .map(|i| *known[i % n].get_or_insert_with(|| self.ratio(&self.ends, i)))
            .collect();
        for _ in 0..ROUNDS {
            if ratios.iter().all(|r| *r <= ALLOWED) {
                return Some(lengths);
            }
            let room: Vec<f64> =
                ratios.iter().map(|r| (AIM / r.max(1e-9)).powf(exponent).clamp(0.3, STRETCH)).collect();
            let shrunk: f64 = lengths.iter().zip(&room).map(|(l, r)| l * r.min(1.0)).sum();
            let slack: f64 = lengths.iter().zip(&room).map(|(l, r)| l * (r - 1.0).max(0.0)).sum();
            let missing = total - shrunk;
            if missing > slack {
                return None;
            }
            let share = missing / slack;
            for (l, r) in lengths.iter_mut().zip(&room) {
                *l *= if *r > 1.0 { 1.0 + share * (r - 1.0) } else { *r };
            }
            self.apply(&mut trial, low, &lengths);
            ratios = (low..low + width).map(|i| self.ratio(&trial, i)).collect();
        }
        None
    }

    /// Sets the edges from `low` on to `lengths`, whose sum is what it was.
    fn apply(&self, ends: &mut [f64], low: usize, lengths: &[f64]) {
        let n = self.len();
        let mut at = ends[low];
        for (k, length) in lengths.iter().enumerate().take(lengths.len() - 1) {
            at += length;
            let i = low + k + 1;
            if i < n {
                ends[i] = at;
            } else {
                // Over the seam: the first entry and the last are the same vertex.
                ends[i - n] = at - self.curve.length;
                if i == n {
                    ends[n] = at;
                }
            }
        }
    }

    /// The last resort: all vertices of the chain by equal error.
    fn whole_chain(&self) -> Option<Vec<f64>> {
        if !self.whole {
            return None;
        }
        let placement = place_equal_error(self.curve, self.error, self.len(), self.ends[0]);
        (placement.largest <= 1.0).then_some(placement.positions)
    }
}
