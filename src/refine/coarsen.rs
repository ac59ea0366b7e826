//! Coarsening: chords are removed and diagonals collapsed while everything holds.
//!
//! Chords go in the order of quads removed per element spoiled (inverted or nearly so right
//! after the merge): many quads first, at little harm. After each removal the surroundings are optimised;
//! a result that breaks a limit is forgotten. The scores of what was not tried yet are only
//! renewed when they come up ("lazy greedy"), and what was refused is tried again only when
//! something changed at the spot that it was refused for. So everything costs what it touches.

use super::chords::{chord_through, chords, Chord};
use super::live::LiveMesh;
use super::merge::{diagonal_growth, Merge, Refusal};
use super::patch::Patch;
use super::pieces::least_pieces;
use super::refusals::{Key, Refusals};
use super::trial::{settle, Limits, Outcome, Reach};
use crate::domain::{Boundary, Place};
use crate::error::{Error, Result};
use crate::mesh::QuadMesh;
use crate::numerics::tolerances::ORDER_TIE;
use crate::progress::{Progress, Stage};
use crate::smooth::{Care, ElementQuality, Optimiser};
use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashSet};

/// Scaled Jacobian below which an element counts as spoiled by a merge.
const SPOILED: f64 = 0.15;
/// Most passes over all chords and diagonals; it ends when nothing changes.
const PASSES: usize = 8;
/// A renewed score counts as still the best at this share of the next one's old score.
const STILL_BEST: f64 = 0.8;
/// Growth of Σ (valence − ideal)² that a diagonal collapse may cost.
const DIAGONAL_IRREGULARITY: isize = 2;

/// Most element evaluations of one coarsening (a few microseconds each at order 5), in all and for each
/// quad: what is coarse enough by then is taken.
const MOST_WORK: u64 = 1_500_000;
const MOST_WORK_PER_QUAD: u64 = 1200;
const MOST_WORK_AT_ALL: u64 = 3_500_000;

/// State of a coarsening.
struct Coarsening<'a> {
    boundary: &'a Boundary,
    optimiser: &'a Optimiser<'a>,
    limits: Limits<'a>,
    reach: Reach,
    /// Whether all elements keep the limits from the start.
    holds: bool,
    /// Least number of edges of each chain.
    least: Vec<usize>,
    live: LiveMesh,
    /// Quality of the living quads.
    quality: Vec<ElementQuality>,
    refusals: &'a mut Refusals,
    /// Element evaluations spent, and when to stop.
    work: u64,
    most_work: u64,
}

/// Something to be tried: the higher `rank` first, then the lesser key.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Candidate {
    rank: [f64; 2],
    key: Key,
    /// When the rank was computed.
    time: usize,
}

impl Eq for Candidate {}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        let [first, second] = [0, 1].map(|k| self.rank[k].total_cmp(&other.rank[k]));
        first.then(second).then(other.key.cmp(&self.key))
    }
}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Coarsens `mesh`, which should be valid and within the tolerance; a mesh that is not is
/// optimised first. The result has no more elements, keeps `limits`, the tolerance, all junctions
/// and loops.
///
/// # Errors
/// [`Error::Cancelled`]; [`Error::InvalidElement`] if the mesh cannot be made valid.
pub fn coarsen(
    mesh: QuadMesh,
    optimiser: &Optimiser,
    limits: Limits,
    reach: Reach,
    refusals: &mut Refusals,
    progress: &Progress,
) -> Result<QuadMesh> {
    let boundary = optimiser.boundary();
    let mut mesh = mesh;
    let mut quality = optimiser.quality(&mesh);
    if !quality.valid() {
        optimiser.optimise(&mut mesh, None, Care::Full);
        quality = optimiser.quality(&mesh);
    }
    if !quality.valid() {
        let worst = (0..mesh.quads.len()).min_by(|a, b| {
            quality.elements[*a].jacobian_ratio.total_cmp(&quality.elements[*b].jacobian_ratio)
        });
        let at = worst
            .map_or(crate::numerics::Point::origin(), |q| mesh.vertices[mesh.quads[q][0] as usize].point);
        return Err(Error::InvalidElement { jacobian: quality.min_scaled_jacobian, at });
    }
    let least = boundary
        .chains
        .iter()
        .map(|chain| match optimiser.boundary_error() {
            Some(error) => least_pieces(chain, error),
            None => Ok(if chain.ends.is_none() { 3 } else { 1 }),
        })
        .collect::<Result<Vec<_>>>()?;
    let largest = quality.elements.iter().map(|e| e.size).fold(0.0, f64::max);
    let holds = quality.min_scaled_jacobian >= limits.scaled_jacobian
        && quality.min_jacobian_ratio >= limits.jacobian_ratio
        && largest <= limits.size
        && (0u32..).zip(&quality.elements).all(|(q, e)| limits.excess_of(&mesh, q, e.size) <= limits.excess);
    let most_work = (MOST_WORK_PER_QUAD * mesh.quads.len() as u64).clamp(MOST_WORK, MOST_WORK_AT_ALL);
    let live = LiveMesh::new(mesh, boundary.chains.len());
    refusals.begin(&live);
    let mut run = Coarsening {
        boundary,
        optimiser,
        limits,
        reach,
        holds,
        least,
        quality: quality.elements,
        live,
        refusals,
        work: 0,
        most_work,
    };
    for pass in 0..PASSES {
        let before = run.refusals.now();
        progress.report(Stage::Refine, pass as f64 / PASSES as f64)?;
        run.remove_chords(progress)?;
        run.collapse_diagonals(progress)?;
        if run.refusals.now() == before || run.work > run.most_work {
            break;
        }
    }
    let Coarsening { live, refusals, .. } = run;
    let (mesh, numbers) = live.renumbered();
    refusals.renumber(&numbers);
    Ok(mesh)
}

impl<'a> Coarsening<'a> {
    fn merge_chord(&self, chord: &Chord) -> std::result::Result<Merge<'_>, Refusal> {
        let mesh = &self.live.mesh;
        let on_boundary = |v: u32| mesh.vertices[v as usize].place != Place::Interior;
        let mut pairs = Vec::with_capacity(chord.rungs.len());
        for e in &chord.rungs {
            let edge = &mesh.edges[*e as usize];
            if edge.span.is_none() && edge.vertices.iter().all(|v| on_boundary(*v)) {
                return Err(Refusal::Pinch);
            }
            pairs.push((edge.vertices, edge.span.is_some()));
        }
        Merge::new(self.boundary, &self.live, &pairs, &chord.quads, &self.least)
    }

    /// Quads removed per element spoiled.
    fn score(&self, merge: &Merge) -> f64 {
        let spoiled = Patch::new(self.boundary, merge, &merge.touched, 0).map_or(0, |patch| {
            let spoils = |q: &u32| self.optimiser.element_quality(&patch.mesh, *q).scaled_jacobian < SPOILED;
            (0..patch.quads.len() as u32).filter(spoils).count()
        });
        merge.removed as f64 / (1.0 + spoiled as f64 + 0.5 * merge.irregularity.max(0) as f64)
    }

    fn corners(&self, quads: &[u32]) -> Vec<u32> {
        quads.iter().flat_map(|q| self.live.mesh.quads[*q as usize]).collect()
    }

    /// Whether `key`, whose quads are `quads`, was refused and nothing changed since that it was refused for.
    fn still_refused(&self, key: Key, quads: &[u32]) -> bool {
        self.refusals.still_refused(key, || self.corners(quads))
    }

    /// The limits within some rings around the quads `at`: what is worse there already need not become
    /// better.
    fn limits_at(&self, at: &[u32], rings: usize) -> Limits<'a> {
        if self.holds {
            return self.limits;
        }
        let mut limits = self.limits;
        for q in self.live.rings(&self.corners(at), rings) {
            let now = self.quality[q as usize];
            limits.scaled_jacobian = limits.scaled_jacobian.min(now.scaled_jacobian);
            limits.jacobian_ratio = limits.jacobian_ratio.min(now.jacobian_ratio);
            limits.size = limits.size.max(now.size);
            limits.excess = limits.excess.max(limits.excess_of(&self.live.mesh, q, now.size));
        }
        limits
    }

    /// Tries a merge, of the quads `at`; the outcome and the element evaluations spent.
    fn trial(&self, merge: Merge, at: &[u32]) -> (Outcome, u64) {
        let mut work = 0;
        let outcome = settle(
            self.optimiser,
            merge,
            self.limits.scaled_jacobian,
            &|rings| self.limits_at(at, rings),
            self.reach,
            &mut work,
        );
        (outcome, work)
    }

    /// Puts the outcome of trying `key` into the mesh, or on record. The quads that changed.
    fn take(&mut self, key: Key, outcome: Outcome) -> Option<Vec<u32>> {
        let settled = match outcome {
            Ok(settled) => settled,
            Err(at) => {
                self.refusals.refuse(key, at);
                return None;
            }
        };
        let merged: Vec<u32> = settled.removal.stars.iter().map(|(v, _)| *v).collect();
        self.live.splice(&settled.patch, settled.removal);
        let active: Vec<u32> = settled.active.iter().map(|q| settled.patch.quads[*q as usize]).collect();
        for (q, quality) in active.iter().zip(settled.quality) {
            self.quality[*q as usize] = quality;
        }
        let mut moved = self.corners(&active);
        moved.sort_unstable();
        moved.dedup();
        self.refusals.change(&self.live, &merged, moved);
        Some(active)
    }

    fn remove_chords(&mut self, progress: &Progress) -> Result<()> {
        let mut queue = BinaryHeap::new();
        for chord in chords(&self.live) {
            let key = Key::of_chord(&chord);
            if self.still_refused(key, &chord.quads) {
                continue;
            }
            match self.merge_chord(&chord).map(|merge| self.score(&merge)) {
                Ok(score) => queue.push(Candidate { rank: [score, 0.0], key, time: self.refusals.now() }),
                Err(_) => self.refusals.refuse(key, Vec::new()),
            }
            self.work += chord.quads.len() as u64;
        }
        while let Some(candidate) = queue.pop() {
            progress.report(Stage::Refine, 0.5)?;
            if self.work > self.most_work {
                break;
            }
            let Key::Chord(edge) = candidate.key else { continue };
            if !self.live.has_edge(edge) {
                continue;
            }
            let chord = chord_through(&self.live.mesh, edge);
            // A chord that has become part of another waits for the next pass, under the other's name.
            if Key::of_chord(&chord) != candidate.key {
                continue;
            }
            let stale = self.refusals.changed_since(&self.corners(&chord.quads), candidate.time);
            let Ok(merge) = self.merge_chord(&chord) else {
                self.refusals.refuse(candidate.key, Vec::new());
                continue;
            };
            if stale {
                let score = self.score(&merge);
                if queue.peek().is_some_and(|next| score < STILL_BEST * next.rank[0]) {
                    queue.push(Candidate { rank: [score, 0.0], time: self.refusals.now(), ..candidate });
                    continue;
                }
            }
            let (outcome, work) = self.trial(merge, &chord.quads);
            self.work += work;
            self.take(candidate.key, outcome);
        }
        Ok(())
    }

    /// The quad with these two vertices at opposite corners.
    fn quad_of_diagonal(&self, [a, b]: [u32; 2]) -> Option<u32> {
        self.live.star(a).iter().copied().find(|&q| {
            let quad = &self.live.mesh.quads[q as usize];
            (0..4).any(|i| quad[i] == a && quad[(i + 2) % 4] == b)
        })
    }

    /// The collapse of a diagonal of quad `q`; `None` if it is impossible or costs too much
    /// regularity.
    fn merge_diagonal(&self, q: u32, ends: [u32; 2]) -> Option<Merge<'_>> {
        let mesh = &self.live.mesh;
        if ends.iter().all(|v| mesh.vertices[*v as usize].place != Place::Interior) {
            return None;
        }
        let from = mesh.quads[q as usize].iter().position(|v| *v == ends[0])?;
        if diagonal_growth(self.boundary, &self.live, q, from).is_some_and(|g| g > DIAGONAL_IRREGULARITY) {
            return None;
        }
        let merge = Merge::new(self.boundary, &self.live, &[(ends, false)], &[q], &self.least).ok()?;
        (merge.irregularity <= DIAGONAL_IRREGULARITY).then_some(merge)
    }

    /// The place of a diagonal in the queue: what makes the mesh more regular first, then small quads.
    fn rank_diagonal(&self, q: u32, merge: &Merge) -> [f64; 2] {
        [-(merge.irregularity as f64), -(self.quality[q as usize].size / ORDER_TIE).round()]
    }

    /// Queues the diagonals of quad `q` that may be collapsed, but those that were `tried`.
    fn queue_diagonals(&self, q: u32, tried: &HashSet<Key>, queue: &mut BinaryHeap<Candidate>) {
        let quad = self.live.mesh.quads[q as usize];
        for [a, b] in [[quad[0], quad[2]], [quad[1], quad[3]]] {
            let ends = [a.min(b), a.max(b)];
            let key = Key::Diagonal(ends);
            if tried.contains(&key) || self.still_refused(key, &[q]) {
                continue;
            }
            if let Some(merge) = self.merge_diagonal(q, ends) {
                queue.push(Candidate { rank: self.rank_diagonal(q, &merge), key, time: self.refusals.now() });
            }
        }
    }

    fn collapse_diagonals(&mut self, progress: &Progress) -> Result<()> {
        let mut queue = BinaryHeap::new();
        let mut tried: HashSet<Key> = HashSet::new();
        for q in self.live.quads() {
            self.queue_diagonals(q, &tried, &mut queue);
        }
        while let Some(candidate) = queue.pop() {
            progress.report(Stage::Refine, 0.75)?;
            if self.work > self.most_work {
                break;
            }
            let Key::Diagonal(ends) = candidate.key else { continue };
            // It may have been queued twice, and be gone since.
            let Some(q) = self.quad_of_diagonal(ends) else { continue };
            if tried.contains(&candidate.key) {
                continue;
            }
            let Some(merge) = self.merge_diagonal(q, ends) else { continue };
            let rank = self.rank_diagonal(q, &merge);
            let now = Candidate { rank, time: self.refusals.now(), ..candidate };
            if rank != candidate.rank && queue.peek().is_some_and(|next| now < *next) {
                queue.push(now);
                continue;
            }
            let (outcome, work) = self.trial(merge, &[q]);
            self.work += work;
            tried.insert(candidate.key);
            for q in self.take(candidate.key, outcome).unwrap_or_default() {
                self.queue_diagonals(q, &tried, &mut queue);
            }
        }
        Ok(())
    }
}
