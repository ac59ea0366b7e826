//! The exact boundary of a symmetric domain, symmetric to rounding.

use super::image::Symmetry;
use crate::domain::{Boundary, BoundaryPoint};
use crate::error::Result;
use crate::mesh::{CallerPlace, ExactCurve};
use crate::numerics::tolerances::{JUNCTION_MATCH, SYMMETRY_ROUNDING};
use crate::numerics::{Point, Vector};

/// Curves whose points are images of one another where their arc lengths are. The curves themselves may differ
/// from their images by up to [`SYMMETRY`](crate::numerics::tolerances::SYMMETRY), and arc lengths are
/// measured to some roundings.
pub struct SymmetricCurve<'a> {
    pub exact: &'a dyn ExactCurve,
    pub boundary: &'a Boundary,
    /// The symmetries that the mesh has, the identity included.
    pub symmetries: Vec<&'a Symmetry>,
}

impl ExactCurve for SymmetricCurve<'_> {
    fn point(&self, at: BoundaryPoint) -> Result<Point> {
        let own = self.exact.point(at)?;
        // One point speaks for all its images: that on the first chain, first along it.
        let images: Vec<BoundaryPoint> = self.symmetries.iter().map(|s| s.point(self.boundary, at)).collect();
        let first = |a: &&BoundaryPoint, b: &&BoundaryPoint| a.chain.cmp(&b.chain).then(a.s.total_cmp(&b.s));
        let Some(speaker) = images.iter().min_by(first) else { return Ok(own) };
        let frame = &self.boundary.frame;
        let spoken = frame.to_canonical(self.exact.point(*speaker)?);
        // On a mirror's axis it has several ways to itself: their mean is on the axis.
        let here = |p: &BoundaryPoint| p.chain == speaker.chain && (p.s - speaker.s).abs() <= JUNCTION_MATCH;
        let ways = self.symmetries.iter().zip(&images).filter(|(_, p)| here(p));
        let (mut sum, mut count) = (Vector::zeros(), 0.0);
        for (symmetry, _) in ways {
            sum += symmetry.map.inverse().vector(spoken.coords);
            count += 1.0;
        }
        let point = Point::from(sum / count);
        if (point - frame.to_canonical(own)).norm() <= SYMMETRY_ROUNDING {
            return Ok(own);
        }
        Ok(frame.to_caller(point))
    }

    fn place(&self, at: BoundaryPoint, before: bool) -> Result<CallerPlace> {
        self.exact.place(at, before)
    }
}
