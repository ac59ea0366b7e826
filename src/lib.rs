//! quadrel: curved all-quadrilateral meshes of planar domains for spectral element methods.
#![deny(unsafe_code)]

pub mod base_mesh;
pub mod cross_field;
pub mod domain;
pub mod error;
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

pub use error::{Error, Result};
pub use generate::generate;
pub use options::Options;

/// The examples of the README run as tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
