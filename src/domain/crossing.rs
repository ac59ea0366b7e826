//! Boundary curves must not cross or touch, themselves or each other.
//!
//! Curves are cut into pieces bounded by fat chords; pairs of pieces that may meet are found with a box
//! tree and halved until their fat chords are apart or both as thin as the touching distance, and
//! then the chords decide. Pieces that share a joint leave it in disjoint cones, or are halved; at
//! cusps, where the cones never part, the last bit before the tip is exempt.

use crate::domain::boundary_loop::BoundaryLoop;
use crate::domain::box_tree::BoxTree;
use crate::domain::piece::{distance_to_segment, pieces_of, segment_distance, Piece};
use crate::error::{Error, Result};
use crate::numerics::tolerances::{CUSP_ANGLE, CUSP_REACH, SAME_MOMENTS, TOUCH};
use crate::numerics::{cross, Point};
use std::f64::consts::PI;

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
    /// For each loop the cusps at the starts of its segments.
    cusps: Vec<Vec<Option<Cusp>>>,
    touch: f64,
}

/// Refuses loops that cross or touch themselves or each other.
pub(crate) fn check<'a>(loops: impl IntoIterator<Item = &'a BoundaryLoop>, diagonal: f64) -> Result<()> {
    let loops: Vec<_> = loops.into_iter().collect();
    let cusps = loops.iter().map(|l| Cusp::all(l)).collect::<Result<Vec<_>>>()?;
    let checker = Checker { loops, cusps, touch: TOUCH * diagonal };
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
            let cusp = self.cusp_between(&a, &b);
            if distance > fat + self.touch || cusp.is_some_and(|c| c.exempts(&a) && c.exempts(&b)) {
                continue;
            }
            steps += 1;
            let segments = [&a, &b].map(|p| &self.loops[p.loop_at as usize].segments()[p.segment as usize]);
            let longer = a.chord().norm() >= b.chord().norm();
            // Pieces at a cusp are cut until they lie within its reach or beyond; else the thicker one is
            // halved, or of neighbours the one that turns more.
            let cut = cusp.is_some_and(|c| c.divides(if longer { &a } else { &b }));
            let first_is_worse = match adjacency {
                _ if cut => longer,
                Adjacency::Apart => a.deviation >= b.deviation,
                _ => a.spread >= b.spread,
            };
            let thin = fat <= 0.25 * self.touch;
            let (worse, segment) = if first_is_worse { (&a, segments[0]) } else { (&b, segments[1]) };
            let bottom = !cut && (segment.is_line() || (adjacency == Adjacency::Apart && thin));
            if bottom || steps > MOST_STEPS || !worse.is_divisible() {
                let loops = [&a, &b].map(|p| self.loops[p.loop_at as usize].index());
                let segments = segments.map(|s| s.index());
                if a.loop_at != b.loop_at && self.are_equal(a.loop_at, b.loop_at)? {
                    let (loop_index, segment) =
                        (loops[0].max(loops[1]), segments[usize::from(loops[1] > loops[0])]);
                    let reason = "the same loop twice";
                    return Err(Error::Degenerate { loop_index, segment, reason, at });
                }
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

    /// Whether two loops that meet are the same curve: equal moments of area, whatever their start, direction
    /// and segments.
    fn are_equal(&self, a: u32, b: u32) -> Result<bool> {
        let [a, b] = [a, b].map(|k| self.loops[k as usize]);
        let origin = a.segments()[0].start()?;
        let (p, q) = (a.moments(origin)?, b.moments(origin)?);
        let size = p.area.abs().max(q.area.abs());
        let same = |x: f64, y: f64, size: f64| (x.abs() - y.abs()).abs() <= SAME_MOMENTS * size;
        let length = size.sqrt();
        Ok(same(p.area, q.area, size) && same(p.x, q.x, size * length) && same(p.y, q.y, size * length))
    }

    /// The cusp at which the segments of two pieces join, if they do: pieces before and after it.
    fn cusp_between(&self, a: &Piece, b: &Piece) -> Option<&Cusp> {
        if a.loop_at != b.loop_at {
            return None;
        }
        let cusps = &self.cusps[a.loop_at as usize];
        [(a, b), (b, a)].into_iter().find_map(|(p, q)| {
            let joins = (p.segment + 1) % cusps.len() as u32 == q.segment;
            let facing = p.segment != q.segment || (p.t[0] >= 0.5 && q.t[1] <= 0.5);
            cusps[q.segment as usize].as_ref().filter(|_| joins && facing)
        })
    }
}

/// A joint where the direction is reversed. Its branches come arbitrarily close near the tip without fault;
/// on which side of each other they lie is decided by the angle there.
struct Cusp {
    tip: Point,
    reach: f64,
}

impl Cusp {
    /// The cusp at the start of each segment of a loop, where there is one.
    fn all(l: &BoundaryLoop) -> Result<Vec<Option<Cusp>>> {
        let cusp = |i: usize| {
            if l.turn(i)?.abs() < PI - CUSP_ANGLE {
                return Ok(None);
            }
            let (before, after) = (&l.segments()[l.before(i)], &l.segments()[i]);
            let reach = CUSP_REACH * before.size()?.min(after.size()?);
            Ok(Some(Cusp { tip: after.start()?, reach }))
        };
        (0..l.segments().len()).map(cusp).collect()
    }

    /// Whether the whole piece is near the tip.
    fn exempts(&self, piece: &Piece) -> bool {
        piece.ends.iter().all(|e| (e - self.tip).norm() <= self.reach)
    }

    /// Whether a part of the piece may be near the tip, and the piece is long enough to tell it from the rest.
    fn divides(&self, piece: &Piece) -> bool {
        let near = distance_to_segment(self.tip, &piece.ends) <= self.reach + piece.deviation;
        near && piece.chord().norm() > 0.1 * self.reach
    }
}

/// Whether two pieces, the first ending where the second starts, meet only there: seen from the joint they
/// lie in cones around their chords that have no direction in common.
fn leaves_joint(first: &Piece, second: &Piece) -> bool {
    let (back, ahead) = (-first.chord(), second.chord());
    let between = cross(back, ahead).atan2(back.dot(&ahead)).abs();
    between > first.spread + second.spread
}
