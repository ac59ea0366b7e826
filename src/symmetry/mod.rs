//! Symmetric domains get symmetric meshes.
//!
//! *In:* the [`Boundary`](crate::domain::Boundary), and a valid [`QuadMesh`](crate::mesh::QuadMesh) of it.
//! *Out:* the boundary's [`Group`] of mirrors and rotations, and a mesh that has them, to rounding.
//!
//! *Method:* a [`Symmetry`] is an orthogonal map about the centroid of the area that takes the boundary onto
//! itself, names included. Candidates come from few corners that are alike (or points farthest from the
//! centroid); every table entry of the boundary decides. A mesh whose connectivity already has the symmetries
//! ([`mesh_symmetries`] walks it) is averaged over them ([`average`]). For one that has not, the domain is cut
//! along mirror axes: the sector between two of them ([`Sector`]) is a domain like any other, and
//! [`Sector::weld`] makes its mesh and its images one; beside an axis there are then strips next to their own
//! images, of which one is often enough ([`strip_orbits`]). [`SymmetricCurve`] keeps the roundings of the
//! curves out of the finished nodes.
//!
//! *Reference:* D. Panozzo, Y. Lipman, E. Puppo, D. Zorin, *Fields on symmetric surfaces*, ACM Transactions on
//! Graphics 31(4), 2012: symmetric layouts by way of the quotient.

mod automorphism;
mod average;
mod candidates;
mod curve;
mod group;
mod image;
mod isometry;
mod sector;
mod strips;
mod weld;

pub use automorphism::{mesh_symmetries, MeshSymmetries};
pub use average::average;
pub use curve::SymmetricCurve;
pub use group::Group;
pub use image::{ChainImage, Symmetry};
pub use isometry::Isometry;
pub use sector::{Cut, Sector};
pub use strips::strip_orbits;
