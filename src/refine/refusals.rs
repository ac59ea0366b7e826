//! What coarsening tried in vain, remembered until something changes where it failed.

use super::chords::Chord;
use super::live::{LiveMesh, Numbering};
use crate::numerics::{Point, NONE};
use std::collections::HashMap;

/// Share of the shortest edge at a vertex by which it has to have moved to count as changed: on 101 domains as many
/// elements came out as with any movement at all, for 7 % less work; with 0.3 1 % more elements for 20 % less.
const MOVED: f64 = 0.1;

/// Names what can be removed: a chord by the least of its edges, a diagonal by its ends. Neither
/// changes its name because of changes elsewhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Key {
    Chord(u32),
    Diagonal([u32; 2]),
}

impl Key {
    pub fn of_chord(chord: &Chord) -> Key {
        Key::Chord(chord.rungs.iter().copied().min().unwrap_or_default())
    }

    /// Its name in a mesh numbered anew in the same order; `None` if it is gone.
    fn renumbered(self, numbers: &Numbering) -> Option<Key> {
        let some = |n: u32| (n != NONE).then_some(n);
        Some(match self {
            Key::Chord(e) => Key::Chord(some(numbers.edges[e as usize])?),
            Key::Diagonal([a, b]) => {
                Key::Diagonal([some(numbers.vertices[a as usize])?, some(numbers.vertices[b as usize])?])
            }
        })
    }
}

/// When something was refused, and the vertices at fault; none if it is due to all of them.
#[derive(Debug, Clone)]
struct Failure {
    time: usize,
    at: Vec<u32>,
}

/// What was refused in a mesh, and what changed there since. It outlives one coarsening: of the same mesh, smoothed,
/// only what moved is worth another try.
#[derive(Debug, Clone, Default)]
pub struct Refusals {
    failed: HashMap<Key, Failure>,
    /// Number of changes made.
    time: usize,
    /// When each vertex was last moved or merged, ...
    changed: Vec<usize>,
    /// ... and where it was then.
    points: Vec<Point>,
}

impl Refusals {
    /// Begins on `live`: from what is known of it, if that is the mesh that was coarsened last, else from nothing.
    pub(super) fn begin(&mut self, live: &LiveMesh) {
        let vertices = &live.mesh.vertices;
        if self.points.len() != vertices.len() {
            let points = vertices.iter().map(|v| v.point).collect();
            *self = Refusals { changed: vec![0; vertices.len()], points, ..Refusals::default() };
            return;
        }
        self.time += 1;
        (0..vertices.len() as u32).for_each(|v| self.note(live, v));
    }

    /// The number of changes made so far: the time of what is done now.
    pub(super) fn now(&self) -> usize {
        self.time
    }

    /// A change: vertices whose quads are others than before, and those that may have moved with it.
    pub(super) fn change(&mut self, live: &LiveMesh, merged: &[u32], moved: impl IntoIterator<Item = u32>) {
        self.time += 1;
        for v in merged {
            self.mark(live, *v);
        }
        moved.into_iter().for_each(|v| self.note(live, v));
    }

    fn mark(&mut self, live: &LiveMesh, v: u32) {
        self.changed[v as usize] = self.time;
        self.points[v as usize] = live.mesh.vertices[v as usize].point;
    }

    /// Marks `v` if it has moved noticeably since it was marked.
    fn note(&mut self, live: &LiveMesh, v: u32) {
        let (mesh, point) = (&live.mesh, live.mesh.vertices[v as usize].point);
        let moved = (point - self.points[v as usize]).norm_squared();
        let edges = live.star(v).iter().flat_map(|q| mesh.quad_edges[*q as usize]);
        let ends = edges.map(|e| mesh.edges[e as usize].vertices).filter(|ends| ends.contains(&v));
        let length = |[a, b]: [u32; 2]| {
            (mesh.vertices[a as usize].point - mesh.vertices[b as usize].point).norm_squared()
        };
        let shortest = ends.map(length).fold(f64::INFINITY, f64::min);
        if moved > MOVED * MOVED * shortest {
            self.mark(live, v);
        }
    }

    /// Notes that `key` is refused: for what is at the vertices `at`, or, if there are none, for all it touches.
    pub(super) fn refuse(&mut self, key: Key, at: Vec<u32>) {
        self.failed.insert(key, Failure { time: self.time, at });
    }

    /// Whether any of the vertices changed after `time`.
    pub(super) fn changed_since(&self, vertices: &[u32], time: usize) -> bool {
        vertices.iter().any(|v| self.changed[*v as usize] > time)
    }

    /// Whether `key`, which touches the vertices `all`, was refused and nothing changed since that it was refused for.
    pub(super) fn still_refused(&self, key: Key, all: impl FnOnce() -> Vec<u32>) -> bool {
        self.failed.get(&key).is_some_and(|failure| {
            let all = failure.at.is_empty().then(all);
            !self.changed_since(all.as_ref().unwrap_or(&failure.at), failure.time)
        })
    }

    /// The same for the mesh numbered anew; what failed for something that is gone is forgotten.
    pub(super) fn renumber(&mut self, numbers: &Numbering) {
        let kept = |v: &usize| numbers.vertices[*v] != NONE;
        self.changed = (0..self.changed.len()).filter(kept).map(|v| self.changed[v]).collect();
        self.points = (0..self.points.len()).filter(kept).map(|v| self.points[v]).collect();
        let failed = self.failed.drain().filter_map(|(key, mut failure)| {
            failure.at.iter_mut().for_each(|v| *v = numbers.vertices[*v as usize]);
            let here = !failure.at.contains(&NONE);
            Some((key.renumbered(numbers)?, failure)).filter(|_| here)
        });
        self.failed = failed.collect();
    }
}
