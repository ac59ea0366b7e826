//! One change of the mesh: made, re-optimised, and kept only if everything still holds.

use super::live::Removal;
use super::merge::Merge;
use super::patch::Patch;
use super::respace::respace;
use super::size_limit::SizeLimit;
use crate::mesh::QuadMesh;
use crate::smooth::{Aim, Care, ElementQuality, Optimiser};

/// What a coarser mesh has to keep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits<'a> {
    /// Least scaled Jacobian; a mesh that is below already must not get worse.
    pub scaled_jacobian: f64,
    /// Least ratio of smallest to largest Jacobian inside an element, likewise.
    pub jacobian_ratio: f64,
    /// Largest mean length of opposite sides, in the canonical frame.
    pub size: f64,
    /// The same at each place, and how many times that much is allowed.
    pub sizes: Option<SizeLimit<'a>>,
    pub excess: f64,
}

impl Limits<'_> {
    /// For a floor of the scaled Jacobian, without a limit on the size.
    pub fn new(scaled_jacobian: f64) -> Self {
        Limits { scaled_jacobian, jacobian_ratio: 0.05, size: f64::INFINITY, sizes: None, excess: 1.0 }
    }

    /// Size of `quad` of `mesh`, which is `size`, in sizes allowed there; 0 if there is no limit.
    pub(super) fn excess_of(&self, mesh: &QuadMesh, quad: u32, size: f64) -> f64 {
        self.sizes.map_or(0.0, |sizes| size / sizes.of_quad(mesh, quad))
    }
}

/// How far coarsening goes to make a change hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reach {
    /// The quads next to it are optimised quickly; what does not hold then is refused.
    Near,
    /// If that comes near, more of them, and with care.
    Far,
}

impl Reach {
    fn attempts(self) -> &'static [(usize, Care)] {
        match self {
            Reach::Near => &ATTEMPTS[..1],
            Reach::Far => &ATTEMPTS,
        }
    }
}

/// Rings of quads around a change that are re-optimised, and the care, in turn until one will do.
const ATTEMPTS: [(usize, Care); 3] = [(1, Care::Quick), (3, Care::Quick), (3, Care::Full)];

/// Multiple of the floor with which a trial ends early: the optimiser's samples are fewer than those that judge.
const ENOUGH: f64 = 1.02;
/// Shares of the floor below which, after the first power, a trial is given up: of 1,431 trials on 24 domains 6 that
/// would have succeeded and 113 of the 186 that would not were below.
const OUT_OF_REACH: [f64; 3] = [0.7, 0.0, 0.0];
/// The same for full care, after the first power, the second, the third: of 674 on 440 domains 3 that would have
/// succeeded and 410 of the 586 that would not were below.
const OUT_OF_FULL_REACH: [f64; 3] = [0.85, 0.92, 0.95];
/// The same where the mesh is below the floor already.
const OUT_OF_LOWERED_REACH: [f64; 3] = [0.85, 0.0, 0.0];
/// Elements that a merge may invert for a try: of 9,388 tries on 440 domains 274 inverted more and some of them by
/// far, for a seventh of the work of all; none of them succeeded.
const MOST_INVERTED: usize = 6;
/// Share of the floor that the first attempt must have come to for wider ones: of 20 trials that these made succeed
/// one was below, of 116 that failed all the same more than half.
const PROMISING: f64 = 0.6;
/// Share of the floor from which full care may still reach it: of 674 tries 8 that succeeded and 215 that did not
/// were below.
const NEARLY: f64 = 0.92;
/// The same where the mesh is below the floor already.
const NEARLY_LOWERED: f64 = 0.8;

/// A merge that holds: what to put into the mesh.
pub(super) struct Settled {
    pub patch: Patch,
    pub removal: Removal,
    /// The quads that were optimised, by their numbers in the patch, and their quality.
    pub active: Vec<u32>,
    pub quality: Vec<ElementQuality>,
}

/// What came of a merge. If it broke a limit: the vertices at which something has to change before it is
/// worth another try; none if that may be anywhere.
pub(super) type Outcome = std::result::Result<Settled, Vec<u32>>;

/// Completes a merge: boundary vertices re-spaced, the surroundings optimised, in wider attempts if the
/// limits within so many rings do not hold yet. Adds the element evaluations spent to `work`.
pub(super) fn settle<'a>(
    optimiser: &Optimiser,
    mut merge: Merge,
    floor: f64,
    limits_at: &dyn Fn(usize) -> Limits<'a>,
    reach: Reach,
    work: &mut u64,
) -> Outcome {
    let mut seeds = merge.touched.clone();
    if let Some(error) = optimiser.boundary_error() {
        seeds.extend(respace(optimiser.boundary(), error, &mut merge).ok_or_else(Vec::new)?);
    }
    let around = |rings: usize| Patch::new(optimiser.boundary(), &merge, &seeds, rings).ok_or_else(Vec::new);
    let mut wide = 0;
    let mut patch = Patch::default();
    let mut refused = Vec::new();
    for (rings, care) in reach.attempts().iter().copied() {
        // Most trials are settled by the first attempt: the patch is as wide as each needs.
        if wide < rings + 1 {
            wide = rings + 1;
            let mut wider = around(wide)?;
            wider.take_over(&patch);
            patch = wider;
        }
        let active = patch.within(rings);
        let limits = limits_at(rings + 1);
        // Where the mesh is below the floor already the local limit says little about what would be good.
        let lowered = limits.scaled_jacobian < floor;
        let (reach, nearly) = match (care, lowered) {
            (Care::Full, false) => (OUT_OF_FULL_REACH, NEARLY),
            (Care::Full, true) => (OUT_OF_LOWERED_REACH, NEARLY_LOWERED),
            (_, lowered) => (OUT_OF_REACH, if lowered { NEARLY_LOWERED } else { NEARLY }),
        };
        let aim = Aim {
            enough: ENOUGH * limits.scaled_jacobian.max(floor),
            hopeless: reach.map(|share| share * limits.scaled_jacobian),
            most_inverted: MOST_INVERTED,
        };
        let outcome = optimiser.optimise_until(&mut patch.mesh, Some(&active), care, Some(aim));
        *work += outcome.work;
        let quality = outcome.quality;
        let others = quality.min_jacobian_ratio >= limits.jacobian_ratio
            && quality.error_ratio <= 1.0
            && quality.elements.iter().all(|e| e.size <= limits.size)
            && active
                .iter()
                .zip(&quality.elements)
                .all(|(q, e)| limits.excess_of(&patch.mesh, *q, e.size) <= limits.excess);
        if outcome.valid && others && quality.min_scaled_jacobian >= limits.scaled_jacobian {
            return Ok(Settled { patch, removal: merge.into_removal(), active, quality: quality.elements });
        }
        let worst = active
            .iter()
            .zip(&quality.elements)
            .min_by(|a, b| a.1.scaled_jacobian.total_cmp(&b.1.scaled_jacobian));
        if let Some((q, _)) = worst {
            refused = patch.mesh.quads[*q as usize].map(|v| patch.vertices[v as usize]).to_vec();
        }
        // More work lifts the scaled Jacobian, not the rest; and what is far off will not come back.
        let far_off = quality.min_scaled_jacobian < nearly * limits.scaled_jacobian;
        let promising = quality.min_scaled_jacobian >= PROMISING * limits.scaled_jacobian;
        let hopeless = if rings == 1 { !promising } else { !outcome.valid || !others || far_off };
        if hopeless {
            break;
        }
    }
    Err(refused)
}
