//! The invariants of a checked domain.

use crate::domain::crossing;
use crate::domain::planar_domain::Domain;
use crate::error::{Error, NestingError, Result};
use crate::numerics::tolerances::JOIN_ROUNDING;

impl Domain {
    /// Checks that loops are closed, disjoint and free of crossings, the outer one counter-clockwise and the
    /// holes clockwise.
    pub fn check(&self) -> Result<()> {
        if self.loops.is_empty() {
            return Err(Error::Nesting { reason: NestingError::NoOuterLoop, at: None });
        }
        let diagonal = self.diagonal();
        for (k, l) in self.loops.iter().enumerate() {
            for (i, s) in l.segments.iter().enumerate() {
                let at = l.segments[l.before(i)].end()?;
                let gap = (s.start()? - at).norm();
                if gap > 10.0 * JOIN_ROUNDING * diagonal {
                    let (loop_index, segment) = (l.index, s.index());
                    return Err(Error::OpenLoop { loop_index, segment, gap, at });
                }
            }
            let at = l.segments[0].start()?;
            if (l.moments(at)?.area > 0.0) != (k == 0) {
                let segment = l.segments[0].index();
                let reason = "a loop of the wrong orientation";
                return Err(Error::Degenerate { loop_index: l.index, segment, reason, at });
            }
        }
        crossing::check(&self.loops, diagonal)
    }
}
