//! Chords of the boundary: how finely each chain is cut.

use super::size_field::SizeField;
use super::tips::doubtful_reach;
use crate::domain::{Boundary, BoundaryPoint, Chain, Place};
use crate::numerics::tolerances::{
    CHORD_RATIO, CHORD_TURN, CORNER_CHORD_TURN, SHARP_TIP, SNAP_GRID, SNAP_LEAST_CHORD,
};
use crate::numerics::{cross, Point};
use std::f64::consts::PI;

/// Most rounds of halving in one pass; 2^-48 of a chain is below any feature that doubles can hold.
const ROUNDS: usize = 48;

/// A piece of a chain that the base mesh replaces by its chord.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Chord {
    pub chain: u32,
    pub start: f64,
    pub end: f64,
    /// Total turning of the tangent along it, in radians.
    pub turn: f64,
}

impl Chord {
    /// Length of its arc.
    pub fn length(&self) -> f64 {
        self.end - self.start
    }

    /// Height of the arc over the chord, for a circular arc of the same turn.
    pub fn sagitta(&self) -> f64 {
        self.length() * self.turn / 8.0
    }
}

/// The chords of every loop, in order.
#[derive(Debug, Clone)]
pub(super) struct Sampling<'a> {
    boundary: &'a Boundary,
    /// For each chain the turning from its start to each entry of its table.
    turning: Vec<Vec<f64>>,
    pub loops: Vec<Vec<Chord>>,
}

/// Turning of the tangent accumulated along the chain's table.
fn accumulate_turning(chain: &Chain) -> Vec<f64> {
    let mut sum = 0.0;
    let mut turning = vec![0.0];
    for pair in chain.samples.windows(2) {
        sum += cross(pair[0].tangent, pair[1].tangent).atan2(pair[0].tangent.dot(&pair[1].tangent)).abs();
        turning.push(sum);
    }
    turning
}

impl<'a> Sampling<'a> {
    /// Cuts the boundary: chords no longer than wanted, turning little, graded.
    pub fn new(boundary: &'a Boundary, sizes: &SizeField) -> Self {
        let turning: Vec<_> = boundary.chains.iter().map(accumulate_turning).collect();
        let mut sampling = Sampling { boundary, turning, loops: Vec::with_capacity(boundary.loops.len()) };
        for chains in &boundary.loops {
            let mut chords = Vec::new();
            for &c in chains {
                sampling.partition(c, sizes.usual(), chains.len(), &mut chords);
            }
            sampling.loops.push(chords);
        }
        sampling.halve_while(|s, chord| {
            let middle = s.chain(chord).point(0.5 * (chord.start + chord.end));
            chord.turn > s.most_turn(chord) || chord.length() > sizes.at(middle).min(s.most_length(chord))
        });
        sampling.balance();
        sampling
    }

    fn chain(&self, chord: &Chord) -> &'a Chain {
        &self.boundary.chains[chord.chain as usize]
    }

    /// Equal pieces of chain `c` no longer than `size`, at least 4 a loop. Two pieces keep the ends of a
    /// chain apart where a corner is; between slight kinks (coastlines) one is enough.
    fn partition(&self, c: u32, size: f64, chains: usize, chords: &mut Vec<Chord>) {
        let chain = &self.boundary.chains[c as usize];
        let kink = |j: u32| (self.boundary.junctions[j as usize].angle - PI).abs() < 2.0 * CHORD_TURN;
        let least = match chain.ends {
            None => 4,
            Some(_) if chains < 3 => 4,
            Some(ends) if ends.iter().all(|&j| kink(j)) => 1,
            Some(_) => 2,
        };
        let pieces = ((chain.length / size).ceil() as usize).clamp(least, 1 << 22);
        let at =
            |i: usize| if i == pieces { chain.length } else { chain.length * (i as f64 / pieces as f64) };
        chords.extend((0..pieces).map(|i| self.chord(c, at(i), at(i + 1))));
    }

    fn chord(&self, chain: u32, start: f64, end: f64) -> Chord {
        let turn = self.turning_at(chain, end) - self.turning_at(chain, start);
        Chord { chain, start, end, turn }
    }

    fn turning_at(&self, chain: u32, s: f64) -> f64 {
        let samples = &self.boundary.chains[chain as usize].samples;
        let turning = &self.turning[chain as usize];
        let i = samples.partition_point(|x| x.s <= s).clamp(1, samples.len() - 1);
        let h = samples[i].s - samples[i - 1].s;
        let share = if h > 0.0 { ((s - samples[i - 1].s) / h).clamp(0.0, 1.0) } else { 1.0 };
        turning[i - 1] + share * (turning[i] - turning[i - 1])
    }

    /// The junctions that `chord` touches.
    fn touched(&self, chord: &Chord) -> impl Iterator<Item = u32> {
        let chain = self.chain(chord);
        let at_ends = [chord.start <= 0.0, chord.end >= chain.length];
        chain.ends.into_iter().flatten().zip(at_ends).filter(|&(_, touches)| touches).map(|(j, _)| j)
    }

    /// The most that `chord` may turn: less beside a sharp corner.
    fn most_turn(&self, chord: &Chord) -> f64 {
        let at_corner = |j: u32| CORNER_CHORD_TURN * self.boundary.junctions[j as usize].angle;
        self.touched(chord).map(at_corner).fold(CHORD_TURN, f64::min)
    }

    /// The most that `chord` may measure for the sake of the corners it touches: their reach is to
    /// hold a few vertices.
    fn most_length(&self, chord: &Chord) -> f64 {
        let at_corner = |j: u32| doubtful_reach(self.boundary, j).map(|reach| 0.4 * reach);
        self.touched(chord).filter_map(at_corner).fold(f64::INFINITY, f64::min)
    }

    /// Halves every chord for which `too_large` holds, again and again.
    fn halve_while(&mut self, too_large: impl Fn(&Self, &Chord) -> bool) {
        for _ in 0..ROUNDS {
            let marks: Vec<Vec<bool>> =
                self.loops.iter().map(|l| l.iter().map(|c| too_large(self, c)).collect()).collect();
            if !self.halve(&marks) {
                return;
            }
        }
    }

    /// Halves chords that are much longer than a neighbour, until none is.
    pub fn balance(&mut self) {
        for _ in 0..ROUNDS {
            let marks: Vec<Vec<bool>> = self
                .loops
                .iter()
                .map(|chords| {
                    let n = chords.len();
                    (0..n)
                        .map(|i| {
                            let shorter = chords[(i + n - 1) % n].length().min(chords[(i + 1) % n].length());
                            chords[i].length() > CHORD_RATIO * shorter
                        })
                        .collect()
                })
                .collect();
            if !self.halve(&marks) {
                return;
            }
        }
    }

    /// Halves the marked chords; whether there was any.
    pub fn halve(&mut self, marks: &[Vec<bool>]) -> bool {
        let mut any = false;
        for (l, marks) in marks.iter().enumerate().filter(|(_, marks)| marks.contains(&true)) {
            let old = std::mem::take(&mut self.loops[l]);
            let mut new = Vec::with_capacity(old.len() + old.len() / 2);
            for (chord, &marked) in old.iter().zip(marks) {
                let middle = 0.5 * (chord.start + chord.end);
                // A chord without a number between its ends cannot be halved.
                if marked && middle > chord.start && middle < chord.end {
                    new.push(self.chord(chord.chain, chord.start, middle));
                    new.push(self.chord(chord.chain, middle, chord.end));
                    any = true;
                } else {
                    new.push(*chord);
                }
            }
            self.loops[l] = new;
        }
        any
    }

    /// Sharp corners, each with the length of the longer chord there: inside it the two chords alone
    /// decide the triangles.
    pub fn sharp_tips(&self, starts: &[Point]) -> Vec<(Point, f64)> {
        let mut tips = Vec::new();
        let mut first = 0;
        for chords in &self.loops {
            let n = chords.len();
            for i in 0..n {
                let Some([j, _]) = self.chain(&chords[i]).ends else { continue };
                if chords[i].start <= 0.0 && self.boundary.junctions[j as usize].angle < SHARP_TIP {
                    tips.push((starts[first + i], chords[i].length().max(chords[(i + n - 1) % n].length())));
                }
            }
            first += n;
        }
        tips
    }

    /// Place and point where each chord starts, loop by loop; on the grid if `snap`.
    pub fn starts(&self, snap: bool) -> Vec<Vec<(Place, Point)>> {
        let starts_of = |chords: &Vec<Chord>| {
            let n = chords.len();
            (0..n)
                .map(|i| {
                    let chord = &chords[i];
                    let chain = self.chain(chord);
                    let (place, point) = match chain.ends {
                        Some([j, _]) if chord.start <= 0.0 => {
                            (Place::Junction(j), self.boundary.junctions[j as usize].point)
                        }
                        _ => (
                            Place::Boundary(BoundaryPoint { chain: chord.chain, s: chord.start }),
                            chain.point(chord.start),
                        ),
                    };
                    let spacing = chord.length().min(chords[(i + n - 1) % n].length());
                    // No negative zero: that is another number to total orders.
                    let on_grid = |x: f64| (x / SNAP_GRID).round() * SNAP_GRID + 0.0;
                    match snap && spacing >= SNAP_LEAST_CHORD {
                        true => (place, Point::new(on_grid(point.x), on_grid(point.y))),
                        false => (place, point),
                    }
                })
                .collect()
        };
        self.loops.iter().map(starts_of).collect()
    }
}
