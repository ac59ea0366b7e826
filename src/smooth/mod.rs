//! Step 8 of the paper: smoothing, and what takes its place on curved elements.
//!
//! *In:* a [`QuadMesh`](crate::mesh::QuadMesh), possibly with inverted elements. *Out:* the same mesh
//! with its vertices, boundary positions and edge shapes moved.
//!
//! [`equal_spacing`] is the paper's Laplacian. The work is done by one [`Optimiser`] of
//! the curved elements themselves. Its unknowns are the interior vertices, the arc lengths of boundary
//! vertices (boundary edges follow the curve and slide with them) and the bubbles of interior
//! edges; the insides are Coons maps. Its energy Σ f^p, f = (|a|²/ℓ₁² + |b|²/ℓ₂²) / (2 det/(ℓ₁ℓ₂)) ≥
//! 1/sin∠(a, b), leaves the aspect ratio free and, with p raised from 2 to 8, lifts the worst
//! angles. The boundary tolerance is a barrier inside it, det > 0 a condition of every step.
//! Inverted elements are cured first, by the same energy regularised.
//!
//! References: P. Knupp, *Introducing the target-matrix paradigm for mesh optimization via node-movement*,
//! Engineering with Computers 28, 2012; Garanzha et al. 2021 (untangling); S. Canann, J. Tristano,
//! M. Staten, *An approach to combined Laplacian and optimization-based smoothing*, 1998.

mod edge_error;
mod follow;
mod kernel;
mod laplacian;
mod lift;
mod local;
mod mend;
mod minimiser;
mod optimiser;
mod problem;
mod quality;
mod reference;
mod straight;
mod straightness;
mod untangle;

pub use laplacian::equal_spacing;
pub use optimiser::{Aim, Care, Optimiser, Outcome};
pub use quality::{ElementQuality, Quality};
