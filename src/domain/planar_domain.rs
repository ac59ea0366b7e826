//! The checked domain.

use crate::domain::boundary_loop::{BoundaryLoop, Moments};
use crate::domain::bounds::Bounds;
use crate::domain::builder::DomainBuilder;
use crate::error::Result;
use crate::numerics::Point;

/// A bounded planar domain: closed, disjoint, nested loops of curve segments, the outer one first and
/// counter-clockwise, holes clockwise. Made by [`Domain::builder`].
#[derive(Debug, Clone)]
pub struct Domain {
    pub(crate) loops: Vec<BoundaryLoop>,
    pub(crate) bounds: Bounds,
    /// What was repaired or left out.
    pub warnings: Vec<String>,
}

impl Domain {
    /// An empty builder.
    pub fn builder() -> DomainBuilder {
        DomainBuilder::default()
    }

    /// The polygon `outer` with polygonal `holes`; corners in either orientation.
    pub fn polygon(outer: &[[f64; 2]], holes: &[Vec<[f64; 2]>]) -> Result<Domain> {
        let mut builder = Self::builder();
        builder.add_polygon(crate::domain::LoopKind::Outer, outer)?;
        for hole in holes {
            builder.add_polygon(crate::domain::LoopKind::Hole, hole)?;
        }
        builder.build()
    }

    /// Its loops, the outer one first.
    pub fn loops(&self) -> &[BoundaryLoop] {
        &self.loops
    }

    /// The bounding box of sampled points, in the caller's frame.
    pub fn bounds(&self) -> Bounds {
        self.bounds
    }

    /// Diagonal D of the caller's bounding box: relative tolerances refer to it.
    pub fn diagonal(&self) -> f64 {
        self.bounds.diagonal()
    }

    /// Its area, in the caller's unit squared.
    pub fn area(&self) -> Result<f64> {
        Ok(self.moments(self.bounds.center())?.area)
    }

    /// Area and moments about `origin`.
    pub(crate) fn moments(&self, origin: Point) -> Result<Moments> {
        let mut terms: [Vec<f64>; 3] = Default::default();
        for l in &self.loops {
            let m = l.moments(origin)?;
            for (sum, term) in terms.iter_mut().zip([m.area, m.x, m.y]) {
                sum.push(term);
            }
        }
        let [area, x, y] = terms.map(super::boundary_loop::sum_sorted);
        Ok(Moments { area, x, y })
    }
}
