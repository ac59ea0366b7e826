//! How many quads ought to meet at a place.

use crate::domain::{Boundary, Place};
use std::f64::consts::PI;

/// Number of quads that ought to meet at a place: 4 inside, 2 on a smooth boundary, Table 1 of the paper
/// at a corner (with ties downwards).
pub(super) fn ideal_valence(boundary: &Boundary, place: Place) -> usize {
    match place {
        Place::Interior => 4,
        Place::Boundary(_) => 2,
        Place::Junction(j) => {
            let quarters = boundary.junctions[j as usize].angle / (0.5 * PI);
            ((quarters - 0.5 - 1e-6).ceil().max(1.0) as usize).min(4)
        }
    }
}

/// How far `valence` quads are from the ideal at a place, squared.
pub(super) fn irregularity(boundary: &Boundary, place: Place, valence: usize) -> usize {
    let ideal = ideal_valence(boundary, place);
    ideal.abs_diff(valence).pow(2)
}
