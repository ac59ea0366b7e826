//! The file formats of HOHQMesh: corners, and the sides of elements as curves at Chebyshev-Lobatto points.
//!
//! Sides are 1 to 4 in an element: 1 from its corner 1 to 2, 2 from 2 to 3, 3 from 4 to 3, 4 from
//! 1 to 4. A side is flagged 0 where it is the straight line between its corners, else 1, and is then
//! followed by the (x, y, z) of N + 1 points along it. The inside is not in these files: readers fill it
//! by transfinite interpolation, which is the map that the elements have here.
//!
//! Reference: HOHQMesh's documentation, *The HOHQMesh mesh file formats*; D. A. Kopriva, *Implementing
//! Spectral Methods for Partial Differential Equations*, 2009, §8.4.

mod abaqus;
mod ism;
mod sides;

pub use abaqus::render as render_abaqus;
pub use ism::{render as render_ism, Version};
