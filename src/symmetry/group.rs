//! All symmetries of a boundary.

use super::candidates::{candidates, Candidates};
use super::image::Symmetry;
use super::isometry::{product, Isometry};
use crate::domain::Boundary;
use crate::error::Result;
use crate::mesh::ExactCurve;
use crate::numerics::tolerances::{SYMMETRY, SYMMETRY_ROUGH};
use std::f64::consts::TAU;

/// Most rotations looked at; of a wheel with more, a divisor.
const MOST_ROTATIONS: usize = 64;
/// Steps in which a candidate's angle is fitted to the boundary.
const FITS: usize = 2;
/// Rotations taken of a domain that has all: those of a square.
const CIRCLE_ROTATIONS: usize = 4;

/// The symmetries of a boundary: the rotations by k/n of a full turn, k = 0, 1, …, n − 1, and as many mirrors, or
/// none.
///
/// Discs and rings have all rotations; those of a square are taken, its mirrors at the canonical axis (through the
/// joint at which the circle begins) and every 45° from it. Of more than 64 rotations the largest divisor up to that
/// is taken.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// The identity first, then the other rotations by angle, then the mirrors: the k-th is the first of them
    /// followed by the k-th rotation.
    pub elements: Vec<Symmetry>,
    /// Number of rotations n, the identity included.
    pub rotations: usize,
}

/// The first of `candidates` that is a symmetry of `boundary`, fitted to it.
fn first_symmetry(
    boundary: &Boundary,
    exact: &dyn ExactCurve,
    candidates: &[Isometry],
) -> Result<Option<Isometry>> {
    for candidate in candidates {
        let mut map = Some(*candidate);
        for _ in 0..FITS {
            let rough = map.and_then(|map| Symmetry::of(boundary, map, SYMMETRY_ROUGH));
            map = rough.map(|rough| rough.fitted(boundary, exact)).transpose()?;
        }
        let fine = map.and_then(|map| Symmetry::of(boundary, map, SYMMETRY));
        if let Some(found) = fine {
            return Ok(Some(found.map));
        }
    }
    Ok(None)
}

impl Group {
    /// The symmetries of `boundary`, whose exact curves are `exact`.
    ///
    /// # Errors
    /// What `exact` reports.
    pub fn of(boundary: &Boundary, exact: &dyn ExactCurve) -> Result<Group> {
        let (count, mirror) = match candidates(boundary) {
            Candidates::All => (CIRCLE_ROTATIONS, Some(Isometry::mirror(0.0))),
            Candidates::Few { rotations, mirrors } => {
                let turn = first_symmetry(boundary, exact, &rotations)?;
                let all =
                    turn.map_or(1, |r| (TAU / r.turn.y.atan2(r.turn.x).rem_euclid(TAU)).round() as usize);
                let count = (1..=MOST_ROTATIONS).rev().find(|n| all % n == 0).unwrap_or(1);
                (count, first_symmetry(boundary, exact, &mirrors)?)
            }
        };
        let found =
            Group::generated(boundary, count, mirror).or_else(|| Group::generated(boundary, 1, mirror));
        Ok(found.unwrap_or_else(|| Group::trivial(boundary)))
    }

    /// The identity alone.
    pub fn trivial(boundary: &Boundary) -> Group {
        Group { elements: vec![Symmetry::identity(boundary)], rotations: 1 }
    }

    /// The group of `rotations` rotations, and of `mirror` followed by each; `None` if `boundary` lacks one.
    pub fn generated(boundary: &Boundary, rotations: usize, mirror: Option<Isometry>) -> Option<Group> {
        let mut elements = vec![Symmetry::identity(boundary)];
        let turns: Vec<_> =
            (0..rotations).map(|k| Isometry::rotation(TAU * k as f64 / rotations as f64)).collect();
        for turn in &turns[1..] {
            elements.push(Symmetry::of(boundary, *turn, SYMMETRY)?);
        }
        if let Some(mirror) = mirror {
            for turn in &turns {
                let map = Isometry { turn: product(turn.turn, mirror.turn), mirror: true };
                elements.push(Symmetry::of(boundary, map, SYMMETRY)?);
            }
        }
        Some(Group { elements, rotations })
    }

    /// Number of mirrors.
    pub fn mirrors(&self) -> usize {
        self.elements.len() - self.rotations
    }

    /// Whether there is but the identity.
    pub fn is_trivial(&self) -> bool {
        self.elements.len() == 1
    }

    /// Index of the element that is first `b`, then `a`.
    pub fn product(&self, a: usize, b: usize) -> usize {
        let n = self.rotations;
        // With rotations r and mirrors r m, m r = r⁻¹ m.
        let k = if a < n { a + b % n } else { a + n - b % n } % n;
        if (a < n) == (b < n) {
            k
        } else {
            n + k
        }
    }

    /// The indices of the subgroup of `rotations` (a divisor) rotations and, if there is one, the `mirror`-th mirror
    /// followed by each.
    pub fn subgroup(&self, rotations: usize, mirror: Option<usize>) -> Vec<usize> {
        let step = self.rotations / rotations;
        let mut own: Vec<usize> = (0..rotations).map(|k| k * step).collect();
        if let Some(mirror) = mirror {
            own.extend((0..rotations).map(|k| self.rotations + (mirror + k * step) % self.rotations));
        }
        own
    }
}
