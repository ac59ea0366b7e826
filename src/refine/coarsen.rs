//! Coarsening: chords are removed and diagonals collapsed while everything holds.
//!
//! Chords go in the order of quads removed per element spoiled (inverted or nearly so right
//! after the merge): many quads first, at little harm. After each removal the surroundings are optimised;
//! a result that breaks a limit is forgotten. The scores of chords that were not tried yet are only
//! renewed when they come up ("lazy greedy").

use super::chords::{chords, Chord};
use super::collapse::{collapse, Collapsed, Refusal};
use super::pieces::least_pieces;
use super::stars::Stars;
use super::trial::{boundary_edges, compact, on_boundary, settle, Limits};
use crate::domain::Boundary;
use crate::error::{Error, Result};
use crate::mesh::QuadMesh;
use crate::numerics::tolerances::ORDER_TIE;
use crate::progress::{Progress, Stage};
use crate::smooth::{Effort, Optimiser};
use std::collections::{HashMap, HashSet};

/// Scaled Jacobian below which an element counts as spoiled by a merge.
const SPOILED: f64 = 0.15;
/// Passes over all chords and diagonals.
const PASSES: usize = 4;
/// A renewed score counts as still the best at this share of the next one's old score.
const STILL_BEST: f64 = 0.8;
/// Growth of Σ (valence − ideal)² that a diagonal collapse may cost.
const DIAGONAL_IRREGULARITY: isize = 2;

/// Most element evaluations of one coarsening (a few microseconds each at order 5): what is coarse
/// enough by then is taken.
const MOST_WORK: u64 = 1_500_000;

/// Quads copied in the time of one element evaluation: a change that is only tried out costs a copy.
const COPIES_PER_EVALUATION: u64 = 8;

/// State of a coarsening.
struct Coarsening<'a> {
    boundary: &'a Boundary,
    optimiser: &'a Optimiser<'a>,
    limits: Limits,
    /// Whether all elements keep the limits from the start.
    holds: bool,
    /// Least number of edges of each chain.
    least: Vec<usize>,
    mesh: QuadMesh,
    stars: Stars,
    /// Number of changes made.
    time: usize,
    /// When each vertex was last moved or merged.
    changed: Vec<usize>,
    /// When each chord or diagonal was last refused.
    failed: HashMap<Key, usize>,
    /// Element evaluations spent.
    work: u64,
}

/// A chord's or diagonal's name that survives changes elsewhere: the least pair of vertices on it.
type Key = [u32; 2];

/// Coarsens `mesh`, which should be valid and within the tolerance; a mesh that is not is
/// optimised first. The result has no more elements, keeps `limits`, the tolerance, all junctions
/// and loops.
///
/// # Errors
/// [`Error::Cancelled`]; [`Error::InvalidElement`] if the mesh cannot be made valid.
pub fn coarsen(
    mesh: QuadMesh,
    boundary: &Boundary,
    optimiser: &Optimiser,
    limits: Limits,
    progress: &Progress,
) -> Result<QuadMesh> {
    let mut mesh = mesh;
    let mut quality = optimiser.quality(&mesh);
    if !quality.valid() {
        optimiser.optimise(&mut mesh, None, Effort::Full);
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
        && largest <= limits.size;
    let stars = Stars::new(mesh.vertices.len(), &mesh.quads);
    let changed = vec![0; mesh.vertices.len()];
    let mut run = Coarsening {
        boundary,
        optimiser,
        limits,
        holds,
        least,
        mesh,
        stars,
        time: 0,
        changed,
        failed: HashMap::new(),
        work: 0,
    };
    for pass in 0..PASSES {
        let before = run.time;
        progress.report(Stage::Refine, pass as f64 / PASSES as f64)?;
        run.remove_chords(progress)?;
        run.collapse_diagonals(progress)?;
        if run.time == before || run.work > MOST_WORK {
            break;
        }
    }
    compact(&mut run.mesh);
    Ok(run.mesh)
}

impl Coarsening<'_> {
    /// Edges that each chain can lose.
    fn spare(&self) -> Vec<usize> {
        let now = boundary_edges(&self.mesh, self.least.len());
        now.iter().zip(&self.least).map(|(now, least)| now.saturating_sub(*least)).collect()
    }

    fn key(&self, chord: &Chord) -> Key {
        let key = |e: &u32| {
            let [a, b] = self.mesh.edges[*e as usize].vertices;
            [a.min(b), a.max(b)]
        };
        chord.rungs.iter().map(key).min().unwrap_or_default()
    }

    fn merge_chord(&self, chord: &Chord, spare: &[usize]) -> std::result::Result<Collapsed, Refusal> {
        let pairs: Vec<([u32; 2], bool)> = chord
            .rungs
            .iter()
            .map(|e| {
                let edge = &self.mesh.edges[*e as usize];
                (edge.vertices, edge.span.is_some())
            })
            .collect();
        if pairs
            .iter()
            .any(|([a, b], rim)| !rim && on_boundary(&self.mesh, *a) && on_boundary(&self.mesh, *b))
        {
            return Err(Refusal::Pinch);
        }
        collapse(self.boundary, &self.mesh, &self.stars, &pairs, &chord.quads, spare)
    }

    /// Quads removed per element spoiled.
    fn score(&self, change: &Collapsed) -> f64 {
        let removed = self.mesh.quads.len() - change.mesh.quads.len();
        let mut near: Vec<u32> = change.touched.iter().flat_map(|v| change.stars.of(*v)).copied().collect();
        near.sort_unstable();
        near.dedup();
        let spoiled = near
            .iter()
            .filter(|q| self.optimiser.element_quality(&change.mesh, **q).scaled_jacobian < SPOILED)
            .count();
        removed as f64 / (1.0 + spoiled as f64 + 0.5 * change.irregularity.max(0) as f64)
    }

    /// Whether a chord's surroundings changed after `time`.
    fn changed_since(&self, quads: &[u32], time: usize) -> bool {
        quads.iter().flat_map(|q| self.mesh.quads[*q as usize]).any(|v| self.changed[v as usize] > time)
    }

    /// The limits within some rings around the quads `at`: what is worse there already need not become
    /// better.
    fn limits_at(&self, at: &[u32], rings: usize) -> Limits {
        if self.holds {
            return self.limits;
        }
        let vertices: Vec<u32> = at.iter().flat_map(|q| self.mesh.quads[*q as usize]).collect();
        let near = self.stars.rings(&self.mesh, &vertices, rings);
        let now = self.optimiser.quality_of(&self.mesh, Some(&near));
        Limits {
            scaled_jacobian: self.limits.scaled_jacobian.min(now.min_scaled_jacobian),
            jacobian_ratio: self.limits.jacobian_ratio.min(now.min_jacobian_ratio),
            size: now.elements.iter().map(|e| e.size).fold(self.limits.size, f64::max),
        }
    }

    /// Takes a change, made at the quads `at`, over if it holds; whether it did.
    fn attempt(&mut self, change: Collapsed, at: &[u32]) -> bool {
        let stars = change.stars.clone();
        let mut work = 0;
        let settled = settle(self.optimiser, change, &|rings| self.limits_at(at, rings), &mut work);
        self.work += work;
        let Some((mesh, active)) = settled else { return false };
        self.time += 1;
        for v in active.iter().flat_map(|q| mesh.quads[*q as usize]) {
            self.changed[v as usize] = self.time;
        }
        (self.mesh, self.stars) = (mesh, stars);
        true
    }

    fn remove_chords(&mut self, progress: &Progress) -> Result<()> {
        // Last score and when it was computed; chords that failed in this pass.
        let mut scores: HashMap<Key, (f64, usize)> = HashMap::new();
        let mut failed: HashSet<Key> = HashSet::new();
        loop {
            let spare = self.spare();
            let mut queue: Vec<(f64, Key, Chord)> = Vec::new();
            for chord in chords(&self.mesh) {
                let key = self.key(&chord);
                if failed.contains(&key)
                    || self.failed.get(&key).is_some_and(|t| !self.changed_since(&chord.quads, *t))
                {
                    continue;
                }
                if self.work > MOST_WORK {
                    return Ok(());
                }
                if let Some((score, _)) = scores.get(&key) {
                    queue.push((*score, key, chord));
                    continue;
                }
                self.work += self.mesh.quads.len() as u64 / COPIES_PER_EVALUATION;
                if let Ok(change) = self.merge_chord(&chord, &spare) {
                    let score = self.score(&change);
                    scores.insert(key, (score, self.time));
                    queue.push((score, key, chord));
                } else {
                    self.failed.insert(key, self.time);
                }
            }
            queue.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            let mut accepted = false;
            let mut i = 0;
            while i < queue.len() {
                progress.report(Stage::Refine, 0.5)?;
                let (_, key, chord) = queue[i].clone();
                i += 1;
                let Ok(change) = self.merge_chord(&chord, &spare) else {
                    self.failed.insert(key, self.time);
                    continue;
                };
                if scores.get(&key).is_none_or(|s| s.1 < self.time) {
                    let score = self.score(&change);
                    scores.insert(key, (score, self.time));
                    if queue.get(i).is_some_and(|next| score < STILL_BEST * next.0) {
                        let at = queue[i..].partition_point(|x| x.0 > score) + i;
                        queue.insert(at, (score, key, chord));
                        continue;
                    }
                }
                if self.attempt(change, &chord.quads) {
                    accepted = true;
                    break;
                }
                failed.insert(key);
                self.failed.insert(key, self.time);
                if self.work > MOST_WORK {
                    return Ok(());
                }
            }
            if !accepted || self.work > MOST_WORK {
                return Ok(());
            }
        }
    }

    /// The quad with these two vertices at opposite corners.
    fn quad_of_diagonal(&self, [a, b]: Key) -> Option<u32> {
        self.stars.of(a).iter().copied().find(|&q| {
            let quad = &self.mesh.quads[q as usize];
            (0..4).any(|i| quad[i] == a && quad[(i + 2) % 4] == b)
        })
    }

    fn collapse_diagonals(&mut self, progress: &Progress) -> Result<()> {
        let mut failed: HashSet<Key> = HashSet::new();
        loop {
            let spare = self.spare();
            let mut queue: Vec<(isize, f64, Key, u32)> = Vec::new();
            for q in 0..self.mesh.quads.len() as u32 {
                let quad = self.mesh.quads[q as usize];
                for [a, b] in [[quad[0], quad[2]], [quad[1], quad[3]]] {
                    let key = [a.min(b), a.max(b)];
                    if on_boundary(&self.mesh, a) && on_boundary(&self.mesh, b)
                        || failed.contains(&key)
                        || self.failed.get(&key).is_some_and(|t| !self.changed_since(&[q], *t))
                    {
                        continue;
                    }
                    if self.work > MOST_WORK {
                        return Ok(());
                    }
                    self.work += self.mesh.quads.len() as u64 / COPIES_PER_EVALUATION;
                    if let Ok(change) =
                        collapse(self.boundary, &self.mesh, &self.stars, &[(key, false)], &[q], &spare)
                    {
                        if change.irregularity <= DIAGONAL_IRREGULARITY {
                            let quality = self.optimiser.element_quality(&self.mesh, q);
                            queue.push((change.irregularity, (quality.size / ORDER_TIE).round(), key, q));
                            continue;
                        }
                    }
                    self.failed.insert(key, self.time);
                }
            }
            queue.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
            let mut accepted = false;
            let start = self.time;
            for (_, _, key, _) in queue {
                progress.report(Stage::Refine, 0.75)?;
                if self.work > MOST_WORK {
                    return Ok(());
                }
                // Quads are renumbered by every change: find the diagonal's again, if it is still there.
                let Some(q) = self.quad_of_diagonal(key) else { continue };
                if self.time > start && self.changed_since(&[q], start) {
                    continue;
                }
                let spare = self.spare();
                let change = collapse(self.boundary, &self.mesh, &self.stars, &[(key, false)], &[q], &spare);
                if let Ok(change) = change {
                    if self.attempt(change, &[q]) {
                        accepted = true;
                        continue;
                    }
                }
                failed.insert(key);
                self.failed.insert(key, self.time);
            }
            if !accepted {
                return Ok(());
            }
        }
    }
}
