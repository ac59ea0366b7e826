//! The exact boundary behind the chains' tables.

use crate::domain::{Boundary, BoundaryPoint, Chain, Domain};
use crate::error::Result;
use crate::numerics::Point;

/// Where a boundary point lies in the caller's own description.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CallerPlace {
    /// The loop, and its segment, in the caller's order.
    pub loop_index: u32,
    pub segment: u32,
    /// The segment's parameter in the caller's direction.
    pub t: f64,
}

/// The exact boundary, in the caller's frame.
pub trait ExactCurve {
    /// The exact point at arc length `at.s` of chain `at.chain`.
    fn point(&self, at: BoundaryPoint) -> Result<Point>;

    /// What the caller calls the place `at`; `before`: as the end of what leads there, which differs
    /// where segments join.
    fn place(&self, at: BoundaryPoint, before: bool) -> Result<CallerPlace>;
}

/// The boundary's tables taken as the exact curves: for meshes without a [`Domain`].
#[derive(Debug, Clone, Copy)]
pub struct TableCurve<'a>(pub &'a Boundary);

impl ExactCurve for TableCurve<'_> {
    fn point(&self, at: BoundaryPoint) -> Result<Point> {
        Ok(self.0.frame.to_caller(self.0.chains[at.chain as usize].point(at.s)))
    }

    fn place(&self, at: BoundaryPoint, before: bool) -> Result<CallerPlace> {
        let chain = &self.0.chains[at.chain as usize];
        let joint = if before { joint_before(chain, at.s) } else { None };
        let (segment, t) = joint.unwrap_or_else(|| chain.segment_parameter(at.s));
        Ok(CallerPlace { loop_index: chain.loop_index, segment, t })
    }
}

/// The curves of a [`Domain`].
#[derive(Debug, Clone, Copy)]
pub struct DomainCurve<'a> {
    pub boundary: &'a Boundary,
    pub domain: &'a Domain,
}

impl ExactCurve for DomainCurve<'_> {
    fn point(&self, at: BoundaryPoint) -> Result<Point> {
        self.boundary.exact_point(self.domain, at.chain, at.s)
    }

    fn place(&self, at: BoundaryPoint, before: bool) -> Result<CallerPlace> {
        let mut place = self.boundary.curve_place(self.domain, at.chain, at.s)?;
        if before {
            if let Some((segment, t)) = joint_before(&self.boundary.chains[at.chain as usize], at.s) {
                (place.segment, place.t) = (segment as usize, t);
            }
        }
        let (loop_index, segment, t) = place.in_callers_terms(self.domain);
        Ok(CallerPlace { loop_index: loop_index as u32, segment: segment as u32, t })
    }
}

/// Segment and parameter of the first table entry that is exactly at `s`: at a joint, the end of the
/// segment that leads there. At s = 0 of a closed chain that is the chain's last entry.
fn joint_before(chain: &Chain, s: f64) -> Option<(u32, f64)> {
    let s = if s <= 0.0 && chain.ends.is_none() { chain.length } else { s };
    let sample = chain.samples.get(chain.samples.partition_point(|x| x.s < s))?;
    (sample.s == s).then_some((sample.segment, sample.t))
}
