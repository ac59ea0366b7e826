//! Boundary curves must not cross or touch, themselves or each other.
//!
//! Curves are cut into pieces bounded by fat chords; pairs of pieces that may meet are found with a box
//! tree and halved until their fat chords are apart or both as thin as the touching distance, and
//! then the chords decide. Pieces that share a joint leave it in disjoint cones, or are halved; at
//! cusps, where the cones never part, the last bit before the tip is exempt.

use crate::domain::boundary_loop::BoundaryLoop;
use crate::domain::box_tree::BoxTree;
use crate::domain::piece::{pieces_of, segment_distance, Piece};
use crate::error::{Error, Result};
use crate::numerics::cross;
use crate::numerics::tolerances::{CUSP_REACH, TOUCH};

/// Most halvings of one pair of pieces, all branches together: curves closer to each other than can be
/// resolved with them count as touching.
const MOST_STEPS: usize = 2_000_000;

/// How two pieces of one loop follow each other.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Adjacency {
    Apart,
    /// The first ends where the second starts.
    FirstThenSecond,
    SecondThenFirst,
}

struct Checker<'a> {
    loops: Vec<&'a BoundaryLoop>,
    touch: f64,
}

/// Refuses loops that cross or touch themselves or each other.
pub(crate) fn check<'a>(loops: impl IntoIterator<Item = &'a BoundaryLoop>, diagonal: f64) -> Result<()> {
    let checker = Checker { loops: loops.into_iter().collect(), touch: TOUCH * diagonal };
    let mut pieces = Vec::new();
    for (k, l) in checker.loops.iter().enumerate() {
        for (i, s) in l.segments().iter().enumerate() {
            pieces.append(&mut pieces_of(s, k as u32, i as u32)?);
        }
    }
    let boxes = pieces.iter().map(|p| p.bounds(checker.touch)).collect();
    for (i, j) in BoxTree::new(boxes).meeting_pairs() {
        checker.check_pair(pieces[i as usize], pieces[j as usize])?;
    }
    Ok(())
}

impl Checker<'_> {
    fn adjacency(&self, a: &Piece, b: &Piece) -> Adjacency {
        if a.loop_at != b.loop_at {
            return Adjacency::Apart;
        }
        let n = self.loops[a.loop_at as usize].segments().len() as u32;
        let follows = |p: &Piece, q: &Piece| {
            let inside = p.segment == q.segment && p.t[1] == q.t[0];
            inside || (p.t[1] == 1.0 && q.t[0] == 0.0 && (p.segment + 1) % n == q.segment)
        };
        match (follows(a, b), follows(b, a)) {
            (true, _) => Adjacency::FirstThenSecond,
            (_, true) => Adjacency::SecondThenFirst,
            _ => Adjacency::Apart,
        }
    }

    fn check_pair(&self, a: Piece, b: Piece) -> Result<()> {
        let mut open = vec![(a, b)];
        let mut steps = 0;
        while let Some((a, b)) = open.pop() {
            let fat = a.deviation + b.deviation;
            let adjacency = self.adjacency(&a, &b);
            match adjacency {
                Adjacency::FirstThenSecond if leaves_joint(&a, &b) => continue,
                Adjacency::SecondThenFirst if leaves_joint(&b, &a) => continue,
                _ => {}
            }
            let (distance, at) = segment_distance(&a.ends, &b.ends);
            if distance > fat + self.touch || self.near_cusp(&a, &b)? {
                continue;
            }
            steps += 1;
            let segments = [&a, &b].map(|p| &self.loops[p.loop_at as usize].segments()[p.segment as usize]);
            // Straight pieces never change by halving; the thicker one is halved, or the longer of neighbours.
            let first_is_worse =
                if adjacency == Adjacency::Apart { a.deviation >= b.deviation } else { a.spread >= b.spread };
            let thin = fat <= 0.25 * self.touch;
            let (worse, segment) = if first_is_worse { (&a, segments[0]) } else { (&b, segments[1]) };
            let bottom = adjacency == Adjacency::Apart && thin;
            if bottom || steps > MOST_STEPS || !worse.is_divisible() || segment.is_line() {
                let loops = [&a, &b].map(|p| self.loops[p.loop_at as usize].index());
                let segments = segments.map(|s| s.index());
                return Err(Error::Intersection { loops, segments, at });
            }
            let [p, q] = worse.halves(segment)?;
            if first_is_worse {
                open.extend([(p, b), (q, b)]);
            } else {
                open.extend([(a, p), (a, q)]);
            }
        }
        Ok(())
    }

    /// Whether both pieces lie in the last bit before a joint of reversed direction, one on each side: there
    /// they come arbitrarily close without fault. On which side of each other they lie is
    /// decided by the angle there.
    fn near_cusp(&self, a: &Piece, b: &Piece) -> Result<bool> {
        if a.loop_at != b.loop_at {
            return Ok(false);
        }
        let l = self.loops[a.loop_at as usize];
        let n = l.segments().len() as u32;
        for (p, q) in [(a, b), (b, a)] {
            if (p.segment + 1) % n != q.segment || (n == 1 && p.t[0] <= q.t[0]) {
                continue;
            }
            let (before, after) = (&l.segments()[p.segment as usize], &l.segments()[q.segment as usize]);
            let reach = CUSP_REACH * before.size()?.min(after.size()?);
            let tip = after.start()?;
            let within = |piece: &Piece| piece.ends.iter().all(|e| (e - tip).norm() <= reach);
            if within(p) && within(q) && p.t[1] > 0.5 && q.t[0] < 0.5 {
                let (u, v) = (before.end_tangent(true)?, after.end_tangent(false)?);
                return Ok(u.dot(&v) < 0.0 && cross(u, v).abs() < 1e-3);
            }
        }
        Ok(false)
    }
}

/// Whether two pieces, the first ending where the second starts, meet only there: seen from the joint they
/// lie in cones around their chords that have no direction in common.
fn leaves_joint(first: &Piece, second: &Piece) -> bool {
    let (back, ahead) = (-first.chord(), second.chord());
    let between = cross(back, ahead).atan2(back.dot(&ahead)).abs();
    between > first.spread + second.spread
}
