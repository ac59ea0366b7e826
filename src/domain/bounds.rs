//! Axis-parallel bounding boxes.

use crate::numerics::Point;

/// The smallest axis-parallel box around the points added; empty at first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    pub low: Point,
    pub high: Point,
}

impl Bounds {
    /// The empty box.
    pub fn new() -> Self {
        let (inf, low) = (f64::INFINITY, f64::NEG_INFINITY);
        Bounds { low: Point::new(inf, inf), high: Point::new(low, low) }
    }

    /// The box around `points`.
    pub fn of<'a>(points: impl IntoIterator<Item = &'a Point>) -> Self {
        let mut bounds = Self::new();
        points.into_iter().for_each(|p| bounds.add(*p));
        bounds
    }

    /// Makes room for `p`.
    pub fn add(&mut self, p: Point) {
        self.low = Point::new(self.low.x.min(p.x), self.low.y.min(p.y));
        self.high = Point::new(self.high.x.max(p.x), self.high.y.max(p.y));
    }

    /// Makes room for another box.
    pub fn merge(&mut self, other: &Bounds) {
        self.add(other.low);
        self.add(other.high);
    }

    /// The same box, `margin` wider on every side.
    pub fn inflated(&self, margin: f64) -> Self {
        let m = crate::numerics::Vector::new(margin, margin);
        Bounds { low: self.low - m, high: self.high + m }
    }

    /// Whether the boxes have a point in common.
    pub fn meets(&self, other: &Bounds) -> bool {
        self.low.x <= other.high.x
            && other.low.x <= self.high.x
            && self.low.y <= other.high.y
            && other.low.y <= self.high.y
    }

    /// Length of its diagonal; 0 if empty.
    pub fn diagonal(&self) -> f64 {
        let d = self.high - self.low;
        if d.x >= 0.0 {
            d.norm()
        } else {
            0.0
        }
    }

    /// Its middle.
    pub fn center(&self) -> Point {
        nalgebra::center(&self.low, &self.high)
    }
}

impl Default for Bounds {
    fn default() -> Self {
        Self::new()
    }
}
