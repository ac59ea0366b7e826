//! The canonical frame: the pose and size in which all stages work.

use crate::numerics::{Point, Vector};

/// A similarity between the caller's coordinates and the canonical frame, in which the bounding-box
/// diagonal is about 1 and the pose depends on the shape alone; so results do not change when
/// the domain is moved, turned or scaled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// The caller's point that is the canonical origin.
    pub origin: Point,
    /// Length in the caller's unit of a canonical length of 1.
    pub scale: f64,
    /// Direction of the canonical x axis in the caller's frame, as a unit vector.
    pub axis: Vector,
}

impl Frame {
    /// The frame of the caller itself.
    pub fn identity() -> Self {
        Frame { origin: Point::origin(), scale: 1.0, axis: Vector::new(1.0, 0.0) }
    }

    /// A caller's point in the canonical frame.
    pub fn to_canonical(&self, p: Point) -> Point {
        let d = (p - self.origin) / self.scale;
        Point::new(d.x * self.axis.x + d.y * self.axis.y, -d.x * self.axis.y + d.y * self.axis.x)
    }

    /// A caller's displacement in the canonical frame.
    pub fn vector_to_canonical(&self, d: Vector) -> Vector {
        let d = d / self.scale;
        Vector::new(d.x * self.axis.x + d.y * self.axis.y, -d.x * self.axis.y + d.y * self.axis.x)
    }

    /// A canonical point in the caller's frame.
    pub fn to_caller(&self, p: Point) -> Point {
        self.origin
            + Vector::new(p.x * self.axis.x - p.y * self.axis.y, p.x * self.axis.y + p.y * self.axis.x)
                * self.scale
    }
}
