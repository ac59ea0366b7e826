//! The unit points of a layout with lengths, and the grids that fill its regions.
//!
//! An arc of length n carries n + 1 points, spaced evenly in ∫ ds / h. A four-sided region w × h is one
//! grid; a star of k sides is k grids around its centre. Points are identified where lengths are 0.

use super::identify::Identification;
use super::lengths::Lengths;
use super::polyline::{self, Measured};
use super::{BlockLayout, SideArc};
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::numerics::{Point, NONE};

/// A grid of (w + 1) × (h + 1) points, index i + (w + 1) j, i and j counter-clockwise oriented.
#[derive(Debug, Clone)]
pub(super) struct Grid {
    pub region: u32,
    pub w: usize,
    pub h: usize,
    pub ids: Vec<u32>,
    /// For each unit step in i, and in j, an arc that it lies on or opposite to.
    pub arcs: [Vec<u32>; 2],
}

impl Grid {
    fn new(region: u32, along: &UnitSide, w: usize, across: &[u32], h: usize) -> Self {
        let ids = vec![NONE; (w + 1) * (h + 1)];
        Grid { region, w, h, ids, arcs: [along.arcs[..w].to_vec(), across.to_vec()] }
    }

    pub fn at(&self, i: usize, j: usize) -> u32 {
        self.ids[i + (self.w + 1) * j]
    }

    fn set(&mut self, i: usize, j: usize, id: u32) {
        self.ids[i + (self.w + 1) * j] = id;
    }
}

/// What one point of the layout is before identification.
#[derive(Debug, Clone, Copy)]
pub(super) struct UnitPoint {
    pub point: Point,
    pub place: Place,
}

/// A star's points: its sides from corner to corner and its spokes from side to centre.
#[derive(Debug, Clone)]
pub(super) struct Star {
    sides: Vec<Vec<u32>>,
    spokes: Vec<Vec<u32>>,
}

impl Star {
    /// Positions of centre and spokes from those of the sides: the centre is the centroid of the
    /// spokes' feet, a spoke the mean of the two pieces of border opposite to it in the grids beside it,
    /// moved so that its ends fit.
    pub fn lay_out(&self, position: &mut [Point]) {
        let k = self.sides.len();
        let feet: Vec<Point> = self.spokes.iter().map(|s| position[s[0] as usize]).collect();
        let centre = polyline::mean(&feet);
        for (i, spoke) in self.spokes.iter().enumerate() {
            let n = spoke.len() - 1;
            let (before, after) = (&self.sides[(i + k - 1) % k], &self.sides[(i + 1) % k]);
            let beside: Vec<Point> = (0..=n)
                .map(|j| {
                    let [a, b] = [before[before.len() - 1 - j], after[j]].map(|id| position[id as usize]);
                    a + (b - a) * 0.5
                })
                .collect();
            let (first, last) = (feet[i] - beside[0], centre - beside[n]);
            for j in 1..=n {
                let x = j as f64 / n as f64;
                position[spoke[j] as usize] = beside[j] + first * (1.0 - x) + last * x;
            }
        }
    }
}

/// All unit points, grids and identifications.
#[derive(Debug, Clone)]
pub(super) struct Grids {
    /// Nodes first, then the arcs' inner points; only these have places yet.
    pub points: Vec<UnitPoint>,
    pub grids: Vec<Grid>,
    pub stars: Vec<Star>,
    pub identification: Identification,
    /// First inner point of each arc.
    pub first: Vec<u32>,
}

/// The points of a side with arcs of length 0 left out, and the arc of each unit step.
struct UnitSide {
    ids: Vec<u32>,
    arcs: Vec<u32>,
}

impl UnitSide {
    fn len(&self) -> usize {
        self.arcs.len()
    }

    fn back(&self, k: usize) -> u32 {
        self.ids[self.ids.len() - 1 - k]
    }
}

impl Grids {
    /// Lays the points out. `Err`: a region whose lengths do not fit it.
    pub fn new(
        layout: &BlockLayout,
        lengths: &Lengths,
        boundary: &Boundary,
        size: &dyn Fn(Point) -> f64,
    ) -> Result<Self, u32> {
        let mut points: Vec<UnitPoint> =
            layout.nodes.iter().map(|n| UnitPoint { point: n.point, place: n.place }).collect();
        let mut first = Vec::with_capacity(layout.arcs.len());
        for (arc, &n) in layout.arcs.iter().zip(&lengths.arcs) {
            first.push(points.len() as u32);
            if n < 2 {
                continue;
            }
            let measured = Measured::new(&arc.points, size);
            for k in 1..n {
                let (point, run) = measured.at(k as f64 / n as f64);
                points.push(match arc.span {
                    None => UnitPoint { point, place: Place::Interior },
                    Some(span) => {
                        let chain = &boundary.chains[span.chain as usize];
                        let s = chain.wrap(span.start + run * (span.end - span.start));
                        let place = Place::Boundary(BoundaryPoint { chain: span.chain, s });
                        UnitPoint { point: chain.point(s), place }
                    }
                });
            }
        }
        let identification = Identification::new(points.len());
        let mut all = Grids { points, grids: Vec::new(), stars: Vec::new(), identification, first };
        for (a, arc) in layout.arcs.iter().enumerate() {
            if lengths.arcs[a] == 0 {
                let reason = all.identification.reason(vec![a as u32]);
                all.identification.unite(arc.nodes[0], arc.nodes[1], reason);
            }
        }
        let mut next = all.points.len() as u32;
        for r in 0..layout.regions.len() {
            let sides: Vec<UnitSide> =
                layout.regions[r].sides.iter().map(|s| all.unit_side(layout, lengths, s)).collect();
            let fits = if sides.len() == 4 {
                all.fill_quad(layout, r as u32, &sides, &mut next)
            } else {
                all.fill_star(r as u32, &sides, &lengths.spokes[r], &mut next)
            };
            if !fits {
                return Err(r as u32);
            }
        }
        Ok(all)
    }

    /// Number of points on nodes and arcs; the later indices are inside regions.
    pub fn on_arcs(&self) -> usize {
        self.points.len()
    }

    /// The points of an arc of length n, in its direction: its nodes and what lies between.
    pub fn arc_points(&self, layout: &BlockLayout, lengths: &Lengths, arc: u32) -> Vec<u32> {
        let a = arc as usize;
        let n = lengths.arcs[a];
        let [start, end] = layout.arcs[a].nodes;
        let inner = self.first[a]..self.first[a] + n.saturating_sub(1);
        std::iter::once(start).chain(inner).chain(std::iter::once(end)).collect()
    }

    fn unit_side(&self, layout: &BlockLayout, lengths: &Lengths, side: &[SideArc]) -> UnitSide {
        let mut unit = UnitSide { ids: Vec::new(), arcs: Vec::new() };
        for s in side.iter().filter(|s| lengths.arcs[s.arc as usize] > 0) {
            let mut ids = self.arc_points(layout, lengths, s.arc);
            if !s.forward {
                ids.reverse();
            }
            unit.arcs.extend(std::iter::repeat_n(s.arc, ids.len() - 1));
            unit.ids.extend_from_slice(&ids[if unit.ids.is_empty() { 0 } else { 1 }..]);
        }
        unit
    }

    fn fill_quad(&mut self, layout: &BlockLayout, r: u32, sides: &[UnitSide], next: &mut u32) -> bool {
        let (w, h) = (sides[0].len(), sides[1].len());
        if sides[2].len() != w || sides[3].len() != h {
            return false;
        }
        if w == 0 || h == 0 {
            // The region is a line: its long sides are the same.
            let flat = if w == 0 { 0 } else { 1 };
            let arcs = layout.regions[r as usize].sides[flat].iter().map(|s| s.arc).collect();
            let reason = self.identification.reason(arcs);
            let (one, other) = (&sides[1 - flat], &sides[3 - flat]);
            for (k, &id) in one.ids.iter().enumerate() {
                self.identification.unite(id, other.back(k), reason);
            }
            return true;
        }
        let mut grid = Grid::new(r, &sides[0], w, &sides[1].arcs, h);
        for i in 0..=w {
            grid.set(i, 0, sides[0].ids[i]);
            grid.set(i, h, sides[2].back(i));
        }
        for j in 0..=h {
            grid.set(w, j, sides[1].ids[j]);
            grid.set(0, j, sides[3].back(j));
        }
        number_inside(&mut grid, next);
        self.grids.push(grid);
        true
    }

    fn fill_star(&mut self, r: u32, sides: &[UnitSide], spokes: &[u32], next: &mut u32) -> bool {
        let k = sides.len();
        let r_of = |i: usize| spokes[i % k] as usize;
        if spokes.len() != k
            || (0..k).any(|i| spokes[i] == 0 || sides[i].len() != r_of(i + k - 1) + r_of(i + 1))
        {
            return false;
        }
        let centre = *next;
        *next += 1;
        let lines: Vec<Vec<u32>> = (0..k)
            .map(|i| {
                let inner = *next..*next + spokes[i] - 1;
                *next = inner.end;
                std::iter::once(sides[i].ids[r_of(i + k - 1)]).chain(inner).chain([centre]).collect()
            })
            .collect();
        for i in 0..k {
            let before = (i + k - 1) % k;
            let (w, h) = (r_of(before), r_of(i));
            let across: Vec<u32> = sides[before].arcs.iter().rev().take(h).copied().collect();
            let mut grid = Grid::new(r, &sides[i], w, &across, h);
            for (u, &id) in lines[before].iter().enumerate() {
                grid.set(u, 0, sides[i].ids[u]);
                grid.set(u, h, id);
            }
            for (v, &id) in lines[i].iter().enumerate() {
                grid.set(0, v, sides[before].back(v));
                grid.set(w, v, id);
            }
            number_inside(&mut grid, next);
            self.grids.push(grid);
        }
        self.stars.push(Star { sides: sides.iter().map(|s| s.ids.clone()).collect(), spokes: lines });
        true
    }
}

fn number_inside(grid: &mut Grid, next: &mut u32) {
    for j in 1..grid.h {
        for i in 1..grid.w {
            grid.set(i, j, *next);
            *next += 1;
        }
    }
}

/// Positions of a grid's inner points from those of its border: transfinite (Coons) interpolation.
pub(super) fn coons(grid: &Grid, position: &mut [Point]) {
    let (w, h) = (grid.w, grid.h);
    let at = |i: usize, j: usize, position: &[Point]| position[grid.at(i, j) as usize].coords;
    for j in 1..h {
        for i in 1..w {
            let (u, v) = (i as f64 / w as f64, j as f64 / h as f64);
            let p = &*position;
            let edges = at(i, 0, p) * (1.0 - v) + at(i, h, p) * v + at(0, j, p) * (1.0 - u) + at(w, j, p) * u;
            let corners = (at(0, 0, p) * (1.0 - u) + at(w, 0, p) * u) * (1.0 - v)
                + (at(0, h, p) * (1.0 - u) + at(w, h, p) * u) * v;
            position[grid.at(i, j) as usize] = Point::from(edges - corners);
        }
    }
}
