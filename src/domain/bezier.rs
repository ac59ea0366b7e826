//! Bézier curves of any degree.

use crate::domain::curve::{Curve, CurveFailure};
use crate::numerics::{Point, Vector};
use std::sync::Arc;

/// The Bézier curve of its control points, degree = their number − 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Bezier {
    control: Vec<Point>,
}

impl Bezier {
    /// Highest degree accepted: de Casteljau's cost grows with its square.
    pub const MAX_DEGREE: usize = 64;

    /// `None` unless there are 2 to [`Self::MAX_DEGREE`] + 1 control points.
    pub fn new(control: Vec<Point>) -> Option<Self> {
        (2..=Self::MAX_DEGREE + 1).contains(&control.len()).then_some(Bezier { control })
    }

    /// Its control points.
    pub fn control(&self) -> &[Point] {
        &self.control
    }

    /// De Casteljau down to the last two points. Every step is symmetric in its two operands, so that
    /// the curve walked backwards has the same bits.
    fn last_two(&self, t: f64) -> [Vector; 2] {
        let s = 1.0 - t;
        let mut p: Vec<Vector> = self.control.iter().map(|p| p.coords).collect();
        for n in (2..p.len()).rev() {
            for i in 0..n {
                p[i] = p[i] * s + p[i + 1] * t;
            }
        }
        [p[0], p[1]]
    }
}

impl Curve for Bezier {
    fn point(&self, t: f64) -> Result<Point, CurveFailure> {
        let [a, b] = self.last_two(t);
        Ok(Point::from(a * (1.0 - t) + b * t))
    }

    fn derivative(&self, t: f64) -> Option<Result<Vector, CurveFailure>> {
        let [a, b] = self.last_two(t);
        Some(Ok((b - a) * (self.control.len() - 1) as f64))
    }

    fn with_end(&self, at_one: bool, p: Point) -> Option<Arc<dyn Curve>> {
        let mut moved = self.clone();
        let k = if at_one { moved.control.len() - 1 } else { 0 };
        moved.control[k] = p;
        Some(Arc::new(moved))
    }

    fn may_have_corners(&self) -> bool {
        false
    }
}
