//! Which loop lies in which: exactly one outer loop, its holes beside each other in it.

use crate::domain::boundary_loop::{BoundaryLoop, LoopKind};
use crate::domain::bounds::Bounds;
use crate::error::{Error, NestingError, Result};
use crate::numerics::Point;

/// A loop as a polygon of samples, for containment tests.
struct Outline {
    polygon: Vec<Point>,
    bounds: Bounds,
    area: f64,
}

impl Outline {
    fn of(l: &BoundaryLoop) -> Result<Self> {
        let mut polygon = Vec::new();
        for s in l.segments() {
            let mut points = s.sample()?;
            points.pop();
            polygon.append(&mut points);
        }
        let bounds = Bounds::of(&polygon);
        let area = l.moments(polygon[0])?.area.abs();
        Ok(Outline { polygon, bounds, area })
    }

    /// Crossing parity of the ray to the right.
    fn contains_point(&self, p: Point) -> bool {
        let n = self.polygon.len();
        let mut inside = false;
        for i in 0..n {
            let (a, b) = (self.polygon[i], self.polygon[(i + 1) % n]);
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                inside = !inside;
            }
        }
        inside
    }

    /// Loops are disjoint, so one point would do; the polygons are inexact, so a majority decides.
    fn contains(&self, other: &Outline) -> bool {
        if self.area < other.area || !self.bounds.meets(&other.bounds) {
            return false;
        }
        let step = other.polygon.len().div_ceil(15);
        let probes: Vec<_> = other.polygon.iter().step_by(step).collect();
        let inside = probes.iter().filter(|p| self.contains_point(***p)).count();
        2 * inside > probes.len()
    }
}

/// The outer loop first, then its holes in the caller's order.
pub(crate) fn arrange(
    loops: Vec<(LoopKind, BoundaryLoop)>,
    component: Option<usize>,
) -> Result<Vec<BoundaryLoop>> {
    let nesting = |reason, at| Err(Error::Nesting { reason, at });
    let outlines = loops.iter().map(|(_, l)| Outline::of(l)).collect::<Result<Vec<_>>>()?;
    let n = loops.len();
    let parents: Vec<Vec<usize>> =
        (0..n).map(|i| (0..n).filter(|&j| j != i && outlines[j].contains(&outlines[i])).collect()).collect();
    // Among loops of kind Auto, those at even depth are outer ones.
    let is_outer = |i: usize| match loops[i].0 {
        LoopKind::Outer => true,
        LoopKind::Auto => parents[i].len() % 2 == 0,
        _ => false,
    };
    let mut outer: Vec<usize> = (0..n).filter(|&i| is_outer(i)).collect();
    outer.sort_by(|&a, &b| outlines[b].area.total_cmp(&outlines[a].area).then(a.cmp(&b)));
    let at = |i: usize| Some(outlines[i].polygon[0]);
    let chosen = match (outer.len(), component) {
        (0, _) => return nesting(NestingError::NoOuterLoop, None),
        (1, None) => outer[0],
        (count, None) => return nesting(NestingError::SeveralComponents(count), at(outer[1])),
        (count, Some(k)) => *outer.get(k).ok_or_else(|| Error::InvalidArgument {
            what: "the component",
            value: format!("{k} of {count}"),
            allowed: "a number below the count, from 0",
        })?,
    };
    let mut holes = Vec::new();
    for i in (0..n).filter(|&i| !is_outer(i)) {
        let auto = loops[i].0 == LoopKind::Auto;
        if auto {
            // Its outer loop is the one around it that lies one level up.
            if parents[i].contains(&chosen) && parents[chosen].len() + 1 == parents[i].len() {
                holes.push(i);
            }
        } else if parents[i].iter().any(|&j| !is_outer(j)) {
            return nesting(NestingError::HoleInHole(loops[i].1.index()), at(i));
        } else if parents[i].contains(&chosen) {
            holes.push(i);
        } else if outer.len() == 1 {
            return nesting(NestingError::HoleOutside(loops[i].1.index()), at(i));
        }
    }
    let mut given: Vec<Option<BoundaryLoop>> = loops.into_iter().map(|(_, l)| Some(l)).collect();
    Ok(std::iter::once(chosen).chain(holes).filter_map(|i| given[i].take()).collect())
}
