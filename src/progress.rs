//! Progress reports and cancellation.

use crate::error::{Error, Result};
use std::sync::Arc;

/// The stages, in running order, named as the folders.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    Domain,
    BaseMesh,
    CrossField,
    Singularities,
    Separatrices,
    Layout,
    Refine,
    Smooth,
    Mesh,
}

impl Stage {
    /// All of them, in running order.
    pub const ALL: [Stage; 9] = [
        Stage::Domain,
        Stage::BaseMesh,
        Stage::CrossField,
        Stage::Singularities,
        Stage::Separatrices,
        Stage::Layout,
        Stage::Refine,
        Stage::Smooth,
        Stage::Mesh,
    ];

    /// Its name, as in the statistics: `base_mesh` and so on.
    pub fn name(self) -> &'static str {
        match self {
            Stage::Domain => "domain",
            Stage::BaseMesh => "base_mesh",
            Stage::CrossField => "cross_field",
            Stage::Singularities => "singularities",
            Stage::Separatrices => "separatrices",
            Stage::Layout => "layout",
            Stage::Refine => "refine",
            Stage::Smooth => "smooth",
            Stage::Mesh => "mesh",
        }
    }
}

/// What is called with (stage, share of the run done in 0..=1); `false` asks to stop.
pub type ProgressFn = dyn Fn(Stage, f64) -> bool + Send + Sync;

/// A shared progress callback, or none.
#[derive(Clone, Default)]
pub struct Progress(Option<Arc<ProgressFn>>);

impl Progress {
    /// Calls `f` on the thread that generates, never twice at once.
    pub fn new(f: impl Fn(Stage, f64) -> bool + Send + Sync + 'static) -> Self {
        Progress(Some(Arc::new(f)))
    }

    /// Reports; an answer of `false` becomes [`Error::Cancelled`].
    pub fn report(&self, stage: Stage, fraction: f64) -> Result<()> {
        match &self.0 {
            Some(f) if !f(stage, fraction) => Err(Error::Cancelled),
            _ => Ok(()),
        }
    }
}
