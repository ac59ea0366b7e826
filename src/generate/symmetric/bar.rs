//! What a symmetric mesh must not fall short of.

use crate::domain::Boundary;
use crate::generate::share_aimed_at;
use crate::mesh::scaled_jacobian_ceiling;
use crate::options::Options;
use crate::smooth::Quality;
use crate::stages::Asymmetry;

/// Share of the direct mesh's least scaled Jacobian that a symmetric one has at least, ...
const LEAST_QUALITY: f64 = 0.95;
/// ... or this where there is no better one: symmetry is worth some quality.
const STILL_GOOD: f64 = 0.85;
/// Most elements of a symmetric mesh: this multiple of the direct one's, and some more.
const MOST_ELEMENTS: f64 = 1.25;
const MORE_ELEMENTS: f64 = 4.0;

/// The scaled Jacobian that coarsening keeps.
pub(super) fn floor(options: &Options, boundary: &Boundary) -> f64 {
    options.quality_floor * scaled_jacobian_ceiling(boundary)
}

/// What a symmetric mesh must not fall short of.
pub(super) struct Bar {
    pub scaled_jacobian: f64,
    pub error_ratio: f64,
    /// Elements of the direct mesh, and most of a symmetric one.
    pub direct: usize,
    pub elements: f64,
}

impl Bar {
    pub fn of(direct: &Quality, options: &Options, boundary: &Boundary) -> Self {
        let (least, floor) = (direct.min_scaled_jacobian, floor(options, boundary));
        Bar {
            // Not below what coarsening keeps to, either.
            scaled_jacobian: (LEAST_QUALITY * least).max(floor.min(least)),
            error_ratio: direct.error_ratio.max(1.0 / share_aimed_at(options.order)),
            direct: direct.elements.len(),
            elements: (MOST_ELEMENTS * direct.elements.len() as f64 + MORE_ELEMENTS)
                .min(options.max_elements as f64),
        }
    }

    /// The lower bar for the second choice.
    pub fn lowered(&self, direct: &Quality) -> Self {
        Bar { scaled_jacobian: STILL_GOOD * direct.min_scaled_jacobian, ..*self }
    }

    pub fn shape_objection(&self, mesh: &Quality) -> Option<Asymmetry> {
        if !mesh.valid() || mesh.min_scaled_jacobian < self.scaled_jacobian {
            Some(Asymmetry::Quality)
        } else if mesh.error_ratio > self.error_ratio {
            Some(Asymmetry::Tolerance)
        } else {
            None
        }
    }

    pub fn objection(&self, mesh: &Quality) -> Option<Asymmetry> {
        let many = mesh.elements.len() as f64 > self.elements;
        self.shape_objection(mesh).or(many.then_some(Asymmetry::Elements))
    }
}
