//! What each stage leaves behind: for pictures, statistics and diagnosis. Kept also on failure.

use crate::base_mesh::Triangulation;
use crate::cross_field::CrossField;
use crate::domain::Boundary;
use crate::layout::{BlockLayout, QuadLayout};
use crate::mesh::QuadMesh;
use crate::progress::Stage;
use crate::separatrices::Separatrix;
use crate::singularities::{CornerFan, Singularity};
use std::sync::Arc;

/// One round of steps 7 and 8: what subdivision, smoothing and coarsening left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Round {
    /// What the round did, in one or two words.
    pub action: &'static str,
    pub elements: usize,
    /// Least scaled Jacobian; negative: inverted.
    pub scaled_jacobian: f64,
    /// Largest boundary error divided by the tolerance.
    pub boundary_error: f64,
}

/// How many rotations (the identity included) and mirrors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SymmetryCount {
    pub rotations: usize,
    pub mirrors: usize,
}

impl SymmetryCount {
    /// How many symmetries in all.
    pub fn order(&self) -> usize {
        self.rotations + self.mirrors
    }
}

/// Why a mesh lacks symmetries of its domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Asymmetry {
    /// No mesh with all of them was found.
    Connectivity,
    /// A symmetric mesh had a clearly smaller scaled Jacobian, ...
    Quality,
    /// ... clearly more elements, or none that keep to the wanted size, ...
    Elements,
    /// ... or did not keep the tolerance.
    Tolerance,
}

impl Asymmetry {
    /// Its name, as in the statistics.
    pub fn name(self) -> &'static str {
        match self {
            Asymmetry::Connectivity => "connectivity",
            Asymmetry::Quality => "quality",
            Asymmetry::Elements => "elements",
            Asymmetry::Tolerance => "tolerance",
        }
    }
}

/// The symmetries of the domain, and those that the mesh has to rounding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SymmetryReport {
    pub domain: SymmetryCount,
    pub mesh: SymmetryCount,
    /// Why those are fewer, if they are.
    pub asymmetry: Option<Asymmetry>,
}

/// Results of the stages, in the canonical frame; `None` or empty where generation did not come that far.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Stages {
    pub boundary: Option<Arc<Boundary>>,
    /// `None`: not looked for ([`Options::symmetry`](crate::Options::symmetry)).
    pub symmetry: Option<SymmetryReport>,
    pub triangulation: Option<Arc<Triangulation>>,
    pub cross_field: Option<Arc<CrossField>>,
    pub singularities: Vec<Singularity>,
    pub corners: Vec<CornerFan>,
    pub separatrices: Vec<Separatrix>,
    pub block_layout: Option<BlockLayout>,
    pub quad_layout: Option<QuadLayout>,
    /// The curved mesh as the rounds of steps 7 to 9 left it.
    pub quad_mesh: Option<QuadMesh>,
    /// Base mesh sizes tried: 1 unless blocks or elements came out wrong.
    pub attempts: usize,
    /// The rounds of the last attempt.
    pub rounds: Vec<Round>,
    /// Seconds spent in each stage, in the order of [`Stage::ALL`], those of meshes that were not kept included.
    pub seconds: [f64; 9],
    /// The last stage that finished.
    pub reached: Option<Stage>,
    /// What repaired the last attempt's layout: 0 nothing, 1 the paper's rules, 2 a pattern, 3 centroid stars.
    pub fallback: u8,
    pub warnings: Vec<String>,
}

impl Stages {
    /// Puts what a reader had to say before the other warnings; the domain may repeat it.
    pub fn put_first(&mut self, warnings: &[String]) {
        let later = std::mem::replace(&mut self.warnings, warnings.to_vec());
        self.warnings.extend(later.into_iter().filter(|w| !warnings.contains(w)));
    }

    /// Forgets what an attempt before left, except its warnings and times.
    pub(crate) fn begin_attempt(&mut self, attempt: usize) {
        *self = Stages {
            boundary: self.boundary.take(),
            symmetry: self.symmetry,
            seconds: self.seconds,
            reached: Some(Stage::Domain),
            warnings: std::mem::take(&mut self.warnings),
            attempts: attempt,
            ..Stages::default()
        };
    }
}
