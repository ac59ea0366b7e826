//! The boundary as every later stage sees it: chains between junctions, in arc length.
//!
//! A *junction* is a boundary point that stays a mesh vertex: a change of direction above
//! [`CORNER_TURN`](crate::numerics::tolerances::CORNER_TURN) or of the boundary's name. A
//! *chain* is the smooth piece of a loop from one junction to the next, or a whole loop without any.
//! Chains are tables of points of the exact curves at known arc lengths, in the canonical frame;
//! between them a cubic Hermite interpolant stands in for the curve. The tables are so
//! dense that its error is far below the tolerance; the final mesh is evaluated on the exact curves.

use crate::domain::{ChainTable, Frame};
use crate::numerics::{Point, Vector};

/// A point of the boundary: arc length `s` along chain `chain`, in [0, length].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundaryPoint {
    pub chain: u32,
    pub s: f64,
}

/// A piece of a chain, from arc length `start` to `end` > `start`. On a closed chain `end` may
/// exceed the length (the piece runs over the seam).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    pub chain: u32,
    pub start: f64,
    pub end: f64,
}

/// Where a vertex may lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Place {
    /// Anywhere inside.
    Interior,
    /// On a chain; it may slide along it.
    Boundary(BoundaryPoint),
    /// At junction `.0`, fixed.
    Junction(u32),
}

/// A boundary point that stays a mesh vertex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Junction {
    pub point: Point,
    /// Angle through the domain, in radians: π where smooth, 2π at a slit's end.
    pub angle: f64,
    /// The chain that ends here, and the one that starts here (the domain to their left).
    pub chain_in: u32,
    pub chain_out: u32,
}

/// One entry of a chain's table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Arc length from the chain's start.
    pub s: f64,
    pub point: Point,
    /// Unit tangent in the direction of growing s.
    pub tangent: Vector,
    /// Signed curvature, positive where the chain turns left.
    pub curvature: f64,
    /// The segment of the loop, and its parameter (in the loop's direction, in [0, 1]).
    pub segment: u32,
    pub t: f64,
}

/// A smooth piece of a loop, the domain to its left.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    pub loop_index: u32,
    /// Its boundary's name, an index into [`Boundary::names`].
    pub name: u32,
    /// The junctions at its ends; `None`: the chain is a whole loop and closed.
    pub ends: Option<[u32; 2]>,
    pub length: f64,
    /// Table from s = 0 to s = length.
    pub samples: ChainTable,
    /// Arc lengths strictly inside where the curve is less smooth (joints and knots), ascending.
    pub breaks: Vec<f64>,
}

/// All chains and junctions of a domain, in the canonical frame.
#[derive(Debug, Clone, PartialEq)]
pub struct Boundary {
    pub frame: Frame,
    pub names: Vec<String>,
    pub chains: Vec<Chain>,
    pub junctions: Vec<Junction>,
    /// For each loop (the outer one first) its chains in order.
    pub loops: Vec<Vec<u32>>,
    /// Area of the domain, in the canonical frame.
    pub area: f64,
    /// For each loop its index in [`Domain::loops`](crate::domain::Domain::loops).
    pub loop_sources: Vec<u32>,
    /// Diagonal D that relative tolerances refer to, in the canonical frame: that of the bounding box in the
    /// pose where it is least (within 1 % below), so that turning the domain changes nothing.
    pub diagonal: f64,
}

impl Chain {
    /// `s` brought into [0, length]: modulo the length on a closed chain, clamped on an open one.
    pub fn wrap(&self, s: f64) -> f64 {
        if self.ends.is_none() && !(0.0..=self.length).contains(&s) {
            s.rem_euclid(self.length)
        } else {
            s.clamp(0.0, self.length)
        }
    }

    /// The two table entries around `s`, already wrapped; they lie on one segment.
    pub(crate) fn around(&self, s: f64) -> (&Sample, &Sample) {
        let i = self.samples.interval(s);
        (&self.samples[i], &self.samples[i + 1])
    }

    /// Point and derivative d/ds (nearly of unit length) at arc length `s`.
    pub fn evaluate(&self, s: f64) -> (Point, Vector) {
        let [point, slope] = self.samples.evaluate(self.wrap(s));
        (point.into(), slope.into())
    }

    /// The point at arc length `s`.
    pub fn point(&self, s: f64) -> Point {
        self.evaluate(s).0
    }

    /// The unit tangent at arc length `s`.
    pub fn tangent(&self, s: f64) -> Vector {
        self.evaluate(s).1.normalize()
    }

    /// Signed curvature at `s`, linear between the table's entries.
    pub fn curvature(&self, s: f64) -> f64 {
        let s = self.wrap(s);
        let i = self.samples.interval(s);
        let (a, b) = (&self.samples[i], &self.samples[i + 1]);
        a.curvature + (b.curvature - a.curvature) * (s - a.s) / (b.s - a.s)
    }

    /// The segment of the loop and its parameter at arc length `s`.
    pub fn segment_parameter(&self, s: f64) -> (u32, f64) {
        let s = self.wrap(s);
        let i = self.samples.interval(s);
        let (a, b) = (&self.samples[i], &self.samples[i + 1]);
        (a.segment, a.t + (b.t - a.t) * (s - a.s) / (b.s - a.s))
    }
}

impl Boundary {
    /// The span from place `a` to place `b` along the loop's direction, if one chain holds both.
    pub fn span(&self, a: Place, b: Place) -> Option<Span> {
        let (chain, start) = match a {
            Place::Boundary(p) => (p.chain, p.s),
            Place::Junction(j) => (self.junctions[j as usize].chain_out, 0.0),
            Place::Interior => return None,
        };
        let length = self.chains[chain as usize].length;
        let (chain_b, mut end) = match b {
            Place::Boundary(p) => (p.chain, p.s),
            Place::Junction(j) => (self.junctions[j as usize].chain_in, length),
            Place::Interior => return None,
        };
        if chain != chain_b {
            return None;
        }
        if end <= start {
            if self.chains[chain as usize].ends.is_some() {
                return None;
            }
            end += length;
        }
        Some(Span { chain, start, end })
    }

    /// The point of a place on the boundary.
    pub fn point(&self, place: Place) -> Option<Point> {
        match place {
            Place::Interior => None,
            Place::Boundary(p) => Some(self.chains[p.chain as usize].point(p.s)),
            Place::Junction(j) => Some(self.junctions[j as usize].point),
        }
    }
}
