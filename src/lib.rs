//! quadrel: curved all-quadrilateral meshes of planar domains for spectral element methods.
//!
//! Give [`generate`] the boundary of a domain, a polynomial order and a tolerance; it returns a conforming
//! mesh of few, large, curved quadrilaterals, proven valid, or an [`Error`] with its cause and place.
//!
//! ```
//! use quadrel::domain::{Domain, LoopKind};
//! use quadrel::{generate, stages::Stages, Options};
//!
//! // The unit square with a round hole.
//! let mut builder = Domain::builder();
//! builder.add_polygon(LoopKind::Outer, &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])?;
//! builder.begin_loop(LoopKind::Hole, "hole")?;
//! builder.add_arc([0.0, 0.0], 0.5, 0.0, std::f64::consts::TAU, "")?;
//! builder.end_loop()?;
//!
//! let options = Options { order: 4, ..Options::default() };
//! let mesh = generate(&builder.build()?, &options, &mut Stages::default())?;
//! assert!(mesh.scaled_jacobian.iter().all(|quality| *quality > 0.0));
//! // (N + 1)² Gauss-Lobatto nodes an element, in the caller's coordinates.
//! assert_eq!(mesh.nodes.len(), mesh.elements.len() * 25);
//! # Ok::<(), quadrel::Error>(())
//! ```
//!
//! The stages are modules, in running order: [`domain`] (boundary curves as tables in arc length),
//! [`base_mesh`] (triangles), [`cross_field`], [`singularities`], [`separatrices`], [`layout`] (conforming
//! blocks), [`refine`] and [`smooth`] (blocks become curved elements that keep the tolerance), [`mesh`]
//! (order-N elements and the proof that they are valid), [`symmetry`] (symmetric domains get symmetric meshes). [`stages::Stages`] keeps what each left behind;
//! [`input`] reads files, [`output`] writes them, [`statistics`] counts.
#![deny(unsafe_code)]

pub mod base_mesh;
pub mod cross_field;
pub mod domain;
pub mod error;
pub mod ffi;
mod generate;
pub mod input;
pub mod layout;
pub mod mesh;
pub mod numerics;
pub mod options;
pub mod output;
pub mod progress;
pub mod refine;
pub mod separatrices;
pub mod singularities;
pub mod smooth;
pub mod stages;
pub mod statistics;
pub mod symmetry;

pub use error::{Error, Result};
pub use generate::generate;
pub use options::Options;

/// The examples of the README run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
