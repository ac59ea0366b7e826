//! Pieces of boundary curves bounded by fat chords: the curve piece lies within a distance `deviation`
//! of its chord, and its direction within an angle `spread` of the chord's.

use crate::domain::bounds::Bounds;
use crate::domain::gauss::snap;
use crate::domain::segment::CurveSegment;
use crate::error::Result;
use crate::numerics::{cross, Point, Vector};

/// A piece of a segment from parameter `t[0]` to `t[1]`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Piece {
    /// Loop (position in the list checked) and segment (position in the loop).
    pub loop_at: u32,
    pub segment: u32,
    pub t: [f64; 2],
    pub ends: [Point; 2],
    /// The curve stays this close to the chord.
    pub deviation: f64,
    /// The curve's direction stays within this angle of the chord's; infinite if it is not known to.
    pub spread: f64,
}

/// Interior points looked at to bound a piece, and the safety of the bounds drawn from them. Between seven
/// samples a piece that turns by less than `MOST_SPREAD` leaves its chord by hardly more than at them.
const PROBES: usize = 7;
const SAFETY: f64 = 1.3;

/// Pieces turn less than this to either side of their chord before pairs are looked at.
pub(crate) const MOST_SPREAD: f64 = 0.4;

/// Deepest initial bisection.
const MOST_DEPTH: u32 = 24;

impl Piece {
    /// Bounds the piece of `segment` between parameters `t`.
    pub fn new(segment: &CurveSegment, loop_at: u32, index: u32, t: [f64; 2]) -> Result<Self> {
        let ends = [segment.point(t[0])?, segment.point(t[1])?];
        let mut piece = Piece { loop_at, segment: index, t, ends, deviation: 0.0, spread: 0.0 };
        if segment.is_line() {
            return Ok(piece);
        }
        let chord = ends[1] - ends[0];
        let length = chord.norm();
        let mut last = ends[0];
        for k in 1..=PROBES + 1 {
            let p = if k > PROBES {
                ends[1]
            } else {
                segment.point(snap(t[0] + (t[1] - t[0]) * k as f64 / (PROBES + 1) as f64))?
            };
            piece.deviation = piece.deviation.max(distance_to_segment(p, &ends) * SAFETY);
            // Directions of the steps between probes stand for the tangents.
            let step = p - last;
            if step.norm() > 0.0 {
                let angle = cross(chord, step).atan2(chord.dot(&step)).abs();
                piece.spread = piece.spread.max(angle);
            }
            last = p;
        }
        // Tangents at the ends go beyond the first and last step by about half a step's turn.
        piece.spread = if length > 0.0 { piece.spread * SAFETY + 1e-12 } else { f64::INFINITY };
        Ok(piece)
    }

    /// Box around the curve piece.
    pub fn bounds(&self, margin: f64) -> Bounds {
        Bounds::of(&self.ends).inflated(self.deviation + margin)
    }

    pub fn chord(&self) -> Vector {
        self.ends[1] - self.ends[0]
    }

    /// Both halves of the piece.
    pub fn halves(&self, segment: &CurveSegment) -> Result<[Piece; 2]> {
        let middle = snap(0.5 * (self.t[0] + self.t[1]));
        Ok([
            Piece::new(segment, self.loop_at, self.segment, [self.t[0], middle])?,
            Piece::new(segment, self.loop_at, self.segment, [middle, self.t[1]])?,
        ])
    }

    /// Whether it can be halved at all.
    pub fn is_divisible(&self) -> bool {
        let middle = snap(0.5 * (self.t[0] + self.t[1]));
        middle > self.t[0] && middle < self.t[1]
    }
}

/// The pieces of a segment, in order, divided at its knots and until each turns little.
pub(crate) fn pieces_of(segment: &CurveSegment, loop_at: u32, index: u32) -> Result<Vec<Piece>> {
    if segment.is_line() {
        return Ok(vec![Piece::new(segment, loop_at, index, [0.0, 1.0])?]);
    }
    let ends = segment.pieces();
    // A curve in one piece is first cut evenly, so that no wave hides between the probes.
    let parts = if ends.len() == 2 { 8 } else { 1 };
    let mut open = Vec::new();
    for w in ends.windows(2) {
        let at =
            |k: usize| if k == parts { w[1] } else { snap(w[0] + (w[1] - w[0]) * k as f64 / parts as f64) };
        for k in 0..parts {
            open.push((Piece::new(segment, loop_at, index, [at(k), at(k + 1)])?, 0));
        }
    }
    open.reverse();
    let mut pieces = Vec::new();
    while let Some((piece, depth)) = open.pop() {
        if piece.spread > MOST_SPREAD && depth < MOST_DEPTH && piece.is_divisible() {
            let [a, b] = piece.halves(segment)?;
            open.push((b, depth + 1));
            open.push((a, depth + 1));
        } else {
            pieces.push(piece);
        }
    }
    Ok(pieces)
}

/// Distance from `p` to a straight segment.
pub(crate) fn distance_to_segment(p: Point, ends: &[Point; 2]) -> f64 {
    let d = ends[1] - ends[0];
    let along = (p - ends[0]).dot(&d);
    let square = d.norm_squared();
    let share = if square > 0.0 { (along / square).clamp(0.0, 1.0) } else { 0.0 };
    (p - (ends[0] + d * share)).norm()
}

/// Distance of two straight segments, and the point midway between their closest points.
pub(crate) fn segment_distance(a: &[Point; 2], b: &[Point; 2]) -> (f64, Point) {
    let (u, v) = (a[1] - a[0], b[1] - b[0]);
    let side = |p: Point, ends: &[Point; 2]| robust::orient2d(coord(ends[0]), coord(ends[1]), coord(p));
    let opposite = |x: f64, y: f64| (x > 0.0 && y < 0.0) || (x < 0.0 && y > 0.0);
    if opposite(side(a[0], b), side(a[1], b)) && opposite(side(b[0], a), side(b[1], a)) {
        let share = cross(b[0] - a[0], v) / cross(u, v);
        return (0.0, a[0] + u * share.clamp(0.0, 1.0));
    }
    let candidates = [(a[0], b), (a[1], b), (b[0], a), (b[1], a)];
    let mut best = (f64::INFINITY, a[0]);
    for (p, ends) in candidates {
        let d = distance_to_segment(p, ends);
        if d < best.0 {
            best = (d, p);
        }
    }
    best
}

fn coord(p: Point) -> robust::Coord<f64> {
    robust::Coord { x: p.x, y: p.y }
}
