//! From the caller's terms (loop, segment, t) to places on the boundary.

use crate::domain::boundary::{Boundary, BoundaryPoint, Place};
use crate::domain::gauss::GaussRule;
use crate::domain::planar_domain::Domain;
use crate::domain::segment::CurveSegment;
use crate::error::{Error, Result};
use crate::numerics::tolerances::JUNCTION_MATCH;

impl Boundary {
    /// The place at parameter `t` of a segment, loop and segment in the caller's order: the reverse of
    /// [`CurvePlace::in_callers_terms`](crate::domain::CurvePlace::in_callers_terms). At a junction's arc
    /// length it is the junction.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] where the domain has no such segment or `t` is not in [0, 1].
    pub fn place_of(&self, domain: &Domain, loop_index: usize, segment: usize, t: f64) -> Result<Place> {
        let refuse = |what, value: String, allowed| Err(Error::InvalidArgument { what, value, allowed });
        if !(0.0..=1.0).contains(&t) {
            return refuse("a boundary parameter", t.to_string(), "a number from 0 to 1");
        }
        let source = domain.loops().iter().position(|l| l.index() == loop_index);
        let Some(k) = self.loop_sources.iter().position(|l| Some(*l as usize) == source) else {
            return refuse("the loop of a boundary vertex", loop_index.to_string(), "a loop of the domain");
        };
        let segments = domain.loops()[self.loop_sources[k] as usize].segments();
        // A segment with corners inside has become several.
        let outside = |s: &CurveSegment| (s.loop_parameter(t) - 0.5).abs();
        let parts = (0u32..).zip(segments).filter(|(_, s)| s.index() == segment);
        let Some((part, curve)) = parts.min_by(|a, b| outside(a.1).total_cmp(&outside(b.1))) else {
            return refuse("the segment of a boundary vertex", segment.to_string(), "a segment of that loop");
        };
        let t = curve.loop_parameter(t).clamp(0.0, 1.0);
        for &chain in &self.loops[k] {
            let table = &self.chains[chain as usize];
            let Some(first) = table.samples.iter().position(|x| x.segment == part) else { continue };
            let count = table.samples[first..].iter().take_while(|x| x.segment == part).count();
            let own = &table.samples[first..first + count];
            let at = &own[own.partition_point(|x| x.t <= t).clamp(1, own.len()) - 1];
            let s = at.s + self.arc_length(curve, at.t, t)?;
            return Ok(self.place_at(BoundaryPoint { chain, s }));
        }
        refuse("the segment of a boundary vertex", segment.to_string(), "a segment with extent")
    }

    /// Canonical length of a segment from `a` to `b`, which lie in one interval of its table.
    fn arc_length(&self, curve: &CurveSegment, a: f64, b: f64) -> Result<f64> {
        let rule = GaussRule::eight();
        let mut length = 0.0;
        for (x, w) in rule.nodes.iter().zip(&rule.weights) {
            length += w * curve.finite_derivative(a + (b - a) * x)?.norm();
        }
        Ok(length * (b - a) / self.frame.scale)
    }

    /// The point of a chain, or the junction that it is.
    fn place_at(&self, p: BoundaryPoint) -> Place {
        let chain = &self.chains[p.chain as usize];
        match chain.ends {
            Some([start, _]) if p.s <= JUNCTION_MATCH => Place::Junction(start),
            Some([_, end]) if p.s >= chain.length - JUNCTION_MATCH => Place::Junction(end),
            None if p.s >= chain.length => Place::Boundary(BoundaryPoint { s: 0.0, ..p }),
            _ => Place::Boundary(p),
        }
    }
}
