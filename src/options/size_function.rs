//! The element size that the caller wants, as a function of the place.

use crate::error::{Error, Result};
use crate::numerics::Point;
use std::fmt;
use std::sync::Arc;

/// The wanted size at a point (x, y) of the caller's frame, or in words why there is none.
pub type SizeFn = dyn Fn([f64; 2]) -> std::result::Result<f64, String> + Send + Sync;

/// A wanted element size everywhere in the domain, in the caller's unit and frame. Its values must be finite
/// and above 0. It is called on the thread that generates, for points of the domain only (up to the height
/// of a base triangle's chord over its arc).
///
/// ```
/// use quadrel::options::SizeFunction;
/// let fine_at_the_left = SizeFunction::new(|[x, _]| 0.1 + 0.4 * x.abs());
/// let options = quadrel::Options { element_size: Some(fine_at_the_left), ..Default::default() };
/// ```
#[derive(Clone)]
pub struct SizeFunction {
    size: Arc<SizeFn>,
    places: Arc<[[f64; 2]]>,
}

impl SizeFunction {
    /// A function that always has a value.
    pub fn new(size: impl Fn([f64; 2]) -> f64 + Send + Sync + 'static) -> Self {
        Self::fallible(move |p| Ok(size(p)))
    }

    /// A function that may give up; its words become part of [`Error::SizeFunction`].
    pub fn fallible(
        size: impl Fn([f64; 2]) -> std::result::Result<f64, String> + Send + Sync + 'static,
    ) -> Self {
        SizeFunction { size: Arc::new(size), places: Arc::new([]) }
    }

    /// Points that sampling must not miss: where the size is small in a spot much smaller than the domain.
    pub fn with_places(self, places: Vec<[f64; 2]>) -> Self {
        SizeFunction { places: places.into(), ..self }
    }

    /// The smaller of this size and another everywhere.
    pub fn min(self, other: SizeFunction) -> Self {
        let places = self.places.iter().chain(other.places.iter()).copied().collect();
        let (a, b) = (self.size, other.size);
        let both = Self::fallible(move |p| Ok(finite(a(p)?)?.min(finite(b(p)?)?)));
        both.with_places(places)
    }

    /// The points given by [`Self::with_places`].
    pub fn places(&self) -> &[[f64; 2]] {
        &self.places
    }

    /// The wanted size at `p`.
    ///
    /// # Errors
    /// [`Error::SizeFunction`] with the place if the function gives up or its value is not finite and above 0.
    pub fn at(&self, p: Point) -> Result<f64> {
        (self.size)([p.x, p.y]).and_then(finite).map_err(|reason| Error::SizeFunction { reason, at: p })
    }
}

fn finite(size: f64) -> std::result::Result<f64, String> {
    if size > 0.0 && size.is_finite() {
        Ok(size)
    } else {
        Err(format!("its value is {size}"))
    }
}

impl fmt::Debug for SizeFunction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SizeFunction").field("places", &self.places).finish_non_exhaustive()
    }
}
