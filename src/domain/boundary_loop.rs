//! A closed loop of segments: joining, orientation, area.

use crate::domain::junction;
use crate::domain::segment::CurveSegment;
use crate::error::{Error, Result};
use crate::numerics::{cross, Point};

/// What a loop bounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoopKind {
    /// The outer boundary; exactly one.
    Outer,
    /// The boundary of a hole.
    Hole,
    /// A curve inside the domain; read and checked, and left out with a warning.
    Interface,
    /// Outer or hole by even-odd nesting among the loops of this kind.
    Auto,
}

/// A closed loop, the domain to its left.
#[derive(Debug, Clone)]
pub struct BoundaryLoop {
    pub(crate) name: String,
    pub(crate) index: usize,
    pub(crate) segments: Vec<CurveSegment>,
    pub(crate) largest_gap: f64,
}

/// Area to the left of a closed curve and the first moments of area, about an origin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Moments {
    pub area: f64,
    pub x: f64,
    pub y: f64,
}

impl BoundaryLoop {
    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its number in the caller's order of loops.
    pub fn index(&self) -> usize {
        self.index
    }

    /// Its segments in walking order, each starting where the one before ends.
    pub fn segments(&self) -> &[CurveSegment] {
        &self.segments
    }

    /// The largest gap that was closed at a joint, in the caller's unit.
    pub fn largest_gap(&self) -> f64 {
        self.largest_gap
    }

    /// Number of the segment before segment `i`.
    pub(crate) fn before(&self, i: usize) -> usize {
        if i == 0 {
            self.segments.len() - 1
        } else {
            i - 1
        }
    }

    /// Change of direction at the start of segment `i`, left positive.
    pub fn turn(&self, i: usize) -> Result<f64> {
        junction::turn(&self.segments[self.before(i)], &self.segments[i])
    }

    /// Angle through the domain at the start of segment `i`, in [0, 2π].
    pub fn interior_angle(&self, i: usize) -> Result<f64> {
        junction::interior_angle(&self.segments[self.before(i)], &self.segments[i])
    }

    /// Walks the loop the other way.
    pub(crate) fn reverse(&mut self) {
        self.segments.reverse();
        self.segments.iter_mut().for_each(CurveSegment::reverse);
    }

    /// Area and its moments about `origin`. Contributions are sorted before they are summed: the
    /// result does not depend on where the loop starts.
    pub(crate) fn moments(&self, origin: Point) -> Result<Moments> {
        let mut terms: [Vec<f64>; 3] = Default::default();
        for segment in &self.segments {
            let (sign, walked) = if segment.prefers_this_direction()? {
                (1.0, segment.clone())
            } else {
                let mut back = segment.clone();
                back.reverse();
                (-1.0, back)
            };
            let part = walked.integrate(origin, |p, d| {
                let a = 0.5 * cross(p, d);
                [a, 2.0 / 3.0 * p.x * a, 2.0 / 3.0 * p.y * a]
            })?;
            for k in 0..3 {
                terms[k].push(sign * part[k]);
            }
        }
        let [area, x, y] = terms.map(sum_sorted);
        Ok(Moments { area, x, y })
    }

    /// Puts the segments end to start: turns segments that are given backwards, and closes gaps from
    /// `least` to `most` (lengths). A larger gap is an error.
    ///
    /// A gap is closed by moving the end of a line if one of the two is a line (the later one only
    /// if the earlier is not), else the end of the earlier segment.
    pub(crate) fn join(&mut self, least: f64, most: f64) -> Result<()> {
        let segments = &mut self.segments;
        let n = segments.len();
        let far = |p: Point, q: Point| (p - q).norm() > most;
        if n > 1 {
            let end = segments[0].end()?;
            if far(end, segments[1].start()?) && far(end, segments[1].end()?) {
                segments[0].reverse();
            }
            for i in 1..n {
                let end = segments[i - 1].end()?;
                if far(end, segments[i].start()?) && !far(end, segments[i].end()?) {
                    segments[i].reverse();
                }
            }
        }
        for b in 0..n {
            let a = if b == 0 { n - 1 } else { b - 1 };
            let (end, start) = (segments[a].end()?, segments[b].start()?);
            let gap = (start - end).norm();
            if gap > most {
                let (loop_index, segment) = (self.index, segments[b].index());
                return Err(Error::OpenLoop { loop_index, segment, gap, at: end });
            }
            self.largest_gap = self.largest_gap.max(gap);
            if gap > least {
                if n > 1 && segments[b].is_line() && !segments[a].is_line() {
                    segments[b].move_end(false, end)?;
                } else {
                    segments[a].move_end(true, start)?;
                }
            }
        }
        Ok(())
    }
}

/// The sum in ascending order of the terms: independent of their order.
pub(crate) fn sum_sorted(mut terms: Vec<f64>) -> f64 {
    terms.sort_by(f64::total_cmp);
    terms.iter().sum()
}
