//! What the caller may choose; the defaults need no tuning.

mod size_function;

pub use size_function::{SizeFn, SizeFunction};

use crate::error::{Error, Result};
use crate::progress::Progress;
use std::sync::Arc;

/// The norm in which a boundary edge is compared with the exact curve (`docs` of
/// [`crate::mesh`] define each).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Norm {
    /// (∫ |x − x_N|² ds)^½; unit length^{3/2}.
    #[default]
    L2,
    /// L2 with the derivative, weighted by the edge's length; unit length^{3/2}.
    H1,
    /// The largest distance; unit length.
    Max,
}

/// The boundary tolerance, per boundary edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Tolerance {
    /// In the norm's own unit.
    Absolute(f64),
    /// For the domain scaled to a bounding-box diagonal of 1, in the pose in which that box is least: turning
    /// the domain changes nothing.
    Relative(f64),
}

/// Which cross field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FieldMethod {
    /// Laplace, then diffuse-and-renormalise steps, which keep singularities apart.
    #[default]
    Diffused,
    /// Laplace alone: the paper's field.
    Harmonic,
}

/// How much work fewer elements are worth. Validity, tolerance, quality floor and sizes hold with any.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Effort {
    /// About two thirds of the time of [`Effort::Default`], for about 5 % more elements.
    Fast,
    /// What is removed is smoothed around there as far as it takes.
    #[default]
    Default,
    /// The best of four meshes, from both cross fields, each with usual and with finer blocks: about four times the time,
    /// for about 6 % fewer elements. [`Options::field`] says with which it begins.
    Best,
}

/// How boundary edges are divided until the tolerance holds (step 7).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Subdivision {
    /// Vertices are placed where the error is the same on all edges of a chain.
    #[default]
    EqualError,
    /// The paper's rule: halve at the middle until the norm holds.
    Halving,
}

/// A caller's own base mesh (step 1), in the caller's frame. It has to triangulate the domain: its border
/// vertices lie on the boundary curves, one at every corner and every change of name, and border edges follow
/// the boundary. It is not refined: it should turn with the boundary by less than 0.3 rad an edge.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct BaseTriangulation {
    pub vertices: Vec<[f64; 2]>,
    /// Counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
    /// Where on the boundary each border vertex lies.
    pub boundary: Vec<BoundaryVertex>,
}

/// A border vertex of a [`BaseTriangulation`] and its place: parameter `t` of a segment of a loop, both
/// counted as they were added to the domain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BoundaryVertex {
    pub vertex: u32,
    pub loop_index: u32,
    pub segment: u32,
    pub t: f64,
}

/// Everything that steers [`crate::generate`].
#[derive(Clone)]
pub struct Options {
    /// Polynomial order N of the elements, 1 to 32.
    pub order: usize,
    /// Boundary tolerance, per boundary edge.
    pub tolerance: Tolerance,
    /// Its norm.
    pub norm: Norm,
    /// Which cross field (step 2). Where the mesh that comes of it has an element below 0.6 of the best possible scaled
    /// Jacobian, or there is none, the other one is tried, too, and the better mesh is kept.
    pub field: FieldMethod,
    /// How boundary edges are divided (step 7).
    pub subdivision: Subdivision,
    /// Largest wanted element size (the longer of the mean lengths of opposite sides), in the caller's unit;
    /// `None`: no limit. The finished mesh is divided, so that halving it makes a solver's error fall as the order
    /// promises; with at least 2π elements along the diagonal, further where strongly curved elements, or joints and
    /// knots inside edges, would hold most of that error.
    pub max_element_size: Option<f64>,
    /// The same as a function of the place; the smaller of both holds. `None`: no limit. The layout's lengths aim
    /// at it, what is larger is divided, and coarsening makes no element larger.
    pub element_size: Option<SizeFunction>,
    /// Wanted size of the base triangles, in the caller's unit; `None`: automatic.
    pub base_mesh_size: Option<f64>,
    /// The caller's own base mesh; `None`: one is made.
    pub base_triangulation: Option<Arc<BaseTriangulation>>,
    /// Share, in (0, 1), of the domain's best possible scaled Jacobian ([`crate::mesh::scaled_jacobian_ceiling`])
    /// that coarsening, and moving what was divided for a size, do not take elements below; where the mesh is below
    /// it already, they do not make it worse.
    pub quality_floor: f64,
    /// Whether a domain with mirrors or rotations gets a mesh that has them, to rounding, if one is found that is not
    /// clearly worse. Not with [`element_size`](Self::element_size) or
    /// [`base_triangulation`](Self::base_triangulation), which know nothing of them.
    pub symmetry: bool,
    /// How much work fewer elements are worth.
    pub effort: Effort,
    /// Most elements allowed.
    pub max_elements: usize,
    /// Called now and then with the stage and the share done; it can cancel.
    pub progress: Progress,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            order: 5,
            tolerance: Tolerance::Relative(1e-5),
            norm: Norm::L2,
            field: FieldMethod::Diffused,
            subdivision: Subdivision::EqualError,
            max_element_size: None,
            element_size: None,
            base_mesh_size: None,
            base_triangulation: None,
            quality_floor: 0.8,
            symmetry: true,
            effort: Effort::Default,
            max_elements: 1_000_000,
            progress: Progress::default(),
        }
    }
}

impl Options {
    /// Largest order accepted.
    pub const MAX_ORDER: usize = 32;

    /// Refuses values out of range, naming the option.
    pub fn check(&self) -> Result<()> {
        let bad = |what, value: f64, allowed| {
            Err(Error::InvalidArgument { what, value: value.to_string(), allowed })
        };
        if self.order < 1 || self.order > Self::MAX_ORDER {
            return bad("the polynomial order", self.order as f64, "1 to 32");
        }
        let (Tolerance::Absolute(e) | Tolerance::Relative(e)) = self.tolerance;
        if !(e > 0.0 && e.is_finite()) {
            return bad("the tolerance", e, "a finite number above 0");
        }
        if !(self.quality_floor > 0.0 && self.quality_floor < 1.0) {
            return bad("the quality floor", self.quality_floor, "a number between 0 and 1");
        }
        for (what, size) in
            [("the largest element size", self.max_element_size), ("the base mesh size", self.base_mesh_size)]
        {
            if let Some(h) = size {
                if !(h > 0.0 && h.is_finite()) {
                    return bad(what, h, "a finite length above 0");
                }
            }
        }
        if self.max_elements == 0 {
            return bad("the element limit", 0.0, "at least 1");
        }
        Ok(())
    }
}
