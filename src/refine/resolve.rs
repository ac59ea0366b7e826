//! More parts for chords whose elements follow solutions worse than their size promises.
//!
//! A straight element of size h and order N follows a wave as well as its order promises. One with a side that is
//! strongly curved, or less smooth in itself, has a map with high modes, and follows the wave only as well as these
//! are small: a few such elements hold most of a solution's error. Dividing their chords costs few elements.
//!
//! *In:* a mesh and into how many parts each edge is to be divided for its size. *Out:* the same or more. Chords are
//! divided more, those together that bring most for their elements, while that lowers the error of waves 2πh long by
//! enough.

use super::chords::chord_through;
use super::coons::CoonsMap;
use super::waves::{Errors, Waves};
use crate::domain::Boundary;
use crate::mesh::QuadMesh;
use crate::numerics::tolerances::{EQUAL_WORTH, LEAST_WAVE_ERROR};
use crate::numerics::{GaussLegendre, Point, NONE};
use std::collections::BTreeMap;

/// Lines along each direction of a quad on which waves are followed.
const LINES: usize = 4;
/// Most quads of a mesh that is looked at: with more the size alone counts.
const MOST_QUADS: usize = 50_000;
/// What steps must bring: the error falls with the number of elements as it does in even division at fifth order.
/// Edges get the third, whose curvature is not smooth inside: dividing them for that would have no end.
const LEAST_ORDER: f64 = 5.0;
/// Least share of an error that steps are said to leave: less is rounding.
const LEAST_LEFT: f64 = 1e-12;

struct Chord {
    rungs: Vec<u32>,
    /// Quads passed, each with the direction (0: u, 1: v) that the chord divides.
    passes: Vec<(u32, usize)>,
    parts: u32,
    /// Square errors over all quads passed, by parts.
    known: BTreeMap<u32, Errors>,
}

struct Resolution<'a> {
    mesh: &'a QuadMesh,
    boundary: &'a Boundary,
    waves: Waves,
    lines: GaussLegendre,
    chords: Vec<Chord>,
    /// The chords through each quad, by direction.
    of_quad: Vec<[u32; 2]>,
}

/// The parts of each edge, `parts` or more, with which waves are followed about as well as by squares of `size`, as
/// far as that pays; `parts` where elements are so large, against the domain of diagonal 1, that there are no such
/// waves, or where it takes more than `most` quads.
pub(super) fn resolved(
    mesh: &QuadMesh,
    boundary: &Boundary,
    parts: &[u32],
    order: usize,
    size: f64,
    most: usize,
) -> Vec<u32> {
    if std::f64::consts::TAU * size > 1.0 || mesh.quads.len() > MOST_QUADS {
        return parts.to_vec();
    }
    let mut resolution = Resolution::new(mesh, boundary, parts, Waves::new(order, 1.0 / size));
    if !resolution.refine(size, most as f64) {
        return parts.to_vec();
    }
    let mut result = parts.to_vec();
    for chord in &resolution.chords {
        chord.rungs.iter().for_each(|r| result[*r as usize] = chord.parts);
    }
    result
}

impl<'a> Resolution<'a> {
    fn new(mesh: &'a QuadMesh, boundary: &'a Boundary, parts: &[u32], waves: Waves) -> Self {
        let mut of_edge = vec![NONE; mesh.edges.len()];
        let mut chords: Vec<Chord> = Vec::new();
        for e in 0..mesh.edges.len() {
            if of_edge[e] == NONE {
                let rungs = chord_through(mesh, e as u32).rungs;
                rungs.iter().for_each(|r| of_edge[*r as usize] = chords.len() as u32);
                chords.push(Chord { rungs, passes: Vec::new(), parts: parts[e], known: BTreeMap::new() });
            }
        }
        let of_quad: Vec<[u32; 2]> =
            mesh.quad_edges.iter().map(|edges| [0, 1].map(|s| of_edge[edges[s] as usize])).collect();
        for (q, own) in (0u32..).zip(&of_quad) {
            (0..2).for_each(|s| chords[own[s] as usize].passes.push((q, s)));
        }
        Resolution { mesh, boundary, waves, lines: GaussLegendre::new(LINES), chords, of_quad }
    }

    /// Divides chords more while that pays; false if there would be more than `most` quads.
    fn refine(&mut self, size: f64, most: f64) -> bool {
        let ideal = self.ideal(size);
        // What may be left anyway, and what is.
        let mut total = ideal;
        for c in 0..self.chords.len() {
            let own = self.errors(c, self.chords[c].parts);
            total.iter_mut().zip(own).for_each(|(t, e)| *t += e);
        }
        loop {
            let steps = self.steps(&total);
            let Some(best) = best_together(&steps, &total, &ideal, self.elements()) else {
                return self.elements() <= most;
            };
            for step in &steps[..best] {
                self.chords[step.chord].parts = step.parts;
            }
            total = after(&steps[..best], &total, &ideal);
            if self.elements() > most {
                return false;
            }
        }
    }

    /// For each chord the best step, those first that are worth most alone.
    fn steps(&mut self, total: &Errors) -> Vec<Step> {
        let elements = self.elements();
        let mut steps = Vec::new();
        for chord in 0..self.chords.len() {
            let n = self.chords[chord].parts;
            let before = self.errors(chord, n);
            let across = |(q, s): &(u32, usize)| {
                f64::from(self.chords[self.of_quad[*q as usize][1 - s] as usize].parts)
            };
            let row: f64 = self.chords[chord].passes.iter().map(across).sum();
            let mut best: Option<Step> = None;
            for parts in [n + 1, n + 2, (2 * n).max(n + 3)] {
                let after = self.errors(chord, parts);
                let more = row * f64::from(parts - n);
                let mut left = *total;
                (0..total.len()).for_each(|i| left[i] -= (before[i] - after[i]).max(0.0));
                let worth = order(total, &left, 1.0 + more / elements);
                if worth > best.as_ref().map_or(0.0, |b| b.worth) {
                    best = Some(Step { chord, parts, more, before, after, worth });
                }
            }
            steps.extend(best);
        }
        steps.sort_by(|a, b| b.worth.total_cmp(&a.worth));
        steps
    }

    fn elements(&self) -> f64 {
        let count =
            |own: &[u32; 2]| own.iter().map(|c| f64::from(self.chords[*c as usize].parts)).product::<f64>();
        self.of_quad.iter().map(count).sum()
    }

    /// What is left of waves, squared, on the quads that `chord` passes, divided into equal `parts`.
    fn errors(&mut self, chord: usize, parts: u32) -> Errors {
        if let Some(known) = self.chords[chord].known.get(&parts) {
            return *known;
        }
        let mut sum = Errors::default();
        let count = self.waves.rule.nodes.len();
        let (mut points, mut density) = (vec![Point::origin(); count], vec![0.0; count]);
        for (q, s) in &self.chords[chord].passes {
            let map = CoonsMap::new(self.mesh, self.boundary, *q as usize);
            for (y, weight) in self.lines.nodes.iter().zip(&self.lines.weights) {
                let across = 0.5 * (1.0 + y);
                for k in 0..parts {
                    for (i, x) in self.waves.rule.nodes.iter().enumerate() {
                        let along = (f64::from(k) + 0.5 * (1.0 + x)) / f64::from(parts);
                        let (point, jacobian) =
                            if *s == 0 { map.at(along, across) } else { map.at(across, along) };
                        points[i] = point;
                        density[i] = 0.25 * weight * jacobian.abs() / f64::from(parts);
                    }
                    self.waves.unresolved(&points, &density, &mut sum);
                }
            }
        }
        self.chords[chord].known.insert(parts, sum);
        sum
    }

    /// The same on squares of `size` that fill the domain, or what nobody asks to be less.
    fn ideal(&self, size: f64) -> Errors {
        let mut area = 0.0;
        for q in 0..self.mesh.quads.len() {
            let map = CoonsMap::new(self.mesh, self.boundary, q);
            for (x, w) in self.lines.nodes.iter().zip(&self.lines.weights) {
                for (y, v) in self.lines.nodes.iter().zip(&self.lines.weights) {
                    area += 0.25 * w * v * map.at(0.5 * (1.0 + x), 0.5 * (1.0 + y)).1;
                }
            }
        }
        let points: Vec<Point> =
            self.waves.rule.nodes.iter().map(|x| Point::new(0.5 * size * x, 0.0)).collect();
        let mut ideal = Errors::default();
        // Both directions of a square.
        self.waves.unresolved(&points, &vec![0.5 * 2.0; points.len()], &mut ideal);
        ideal.map(|e| e.max(LEAST_WAVE_ERROR * LEAST_WAVE_ERROR) * area)
    }
}

/// More parts for a chord.
struct Step {
    chord: usize,
    parts: u32,
    /// Quads that it adds.
    more: f64,
    /// Square errors on the quads that the chord passes.
    before: Errors,
    after: Errors,
    /// What it brings alone.
    worth: f64,
}

/// How many of the steps, the best first, bring most together in a mesh of so many elements, if that is more than
/// [`LEAST_ORDER`]. Where several chords share an error each alone brings little: what the others leave hides the gain.
fn best_together(steps: &[Step], total: &Errors, ideal: &Errors, elements: f64) -> Option<usize> {
    let mut best: Option<(usize, f64)> = None;
    let mut left = *total;
    let mut more = 0.0;
    for (k, step) in steps.iter().enumerate() {
        left = after(&steps[k..=k], &left, ideal);
        more += step.more;
        // Images of each other in a symmetric mesh go together.
        let tied = steps.get(k + 1).is_some_and(|next| next.worth > (1.0 - EQUAL_WORTH) * step.worth);
        let worth = order(total, &left, 1.0 + more / elements);
        if !tied && worth > best.map_or(LEAST_ORDER, |b| b.1) {
            best = Some((k + 1, worth));
        }
    }
    best.map(|b| b.0)
}

/// What steps leave of `total`: not less than `ideal`.
fn after(steps: &[Step], total: &Errors, ideal: &Errors) -> Errors {
    let mut left = *total;
    for step in steps {
        for i in 0..left.len() {
            left[i] = (left[i] - step.before[i] + step.after[i]).max(ideal[i]);
        }
    }
    left
}

/// The order at which square errors fall from `before` to `after`, the mean over the degrees, with `growth` times as
/// many elements.
fn order(before: &Errors, after: &Errors, growth: f64) -> f64 {
    let fall = |i: usize| (before[i] / after[i].max(LEAST_LEFT * before[i])).ln();
    (0..before.len()).map(fall).sum::<f64>() / before.len() as f64 / growth.ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chords_that_share_an_error_are_divided_together() {
        // Ten in a hundred elements for a thousandth of an error: worth it only where nothing else holds the error.
        let (total, ideal) = ([1.0; 3], [1e-12; 3]);
        let steps = |count: usize| -> Vec<Step> {
            let share = 1.0 / count as f64;
            let (before, after) = ([share; 3], [1e-3 * share; 3]);
            let left = total.map(|t| t - share + 1e-3 * share);
            let worth = order(&total, &left, 1.1);
            (0..count).map(|chord| Step { chord, parts: 2, more: 10.0, before, after, worth }).collect()
        };
        for count in [1, 2, 4, 8] {
            let mut steps = steps(count);
            assert_eq!(best_together(&steps, &total, &ideal, 100.0), Some(count), "{count}");
            // The first alone would not be taken.
            let alone = best_together(&steps[..1], &total, &ideal, 100.0);
            assert_eq!(alone.is_some(), count <= 2, "{count}");
            // A chord that takes too many elements for nothing is left out.
            steps.push(Step {
                chord: count,
                parts: 2,
                more: 500.0,
                before: [0.0; 3],
                after: [0.0; 3],
                worth: 0.0,
            });
            assert_eq!(best_together(&steps, &total, &ideal, 100.0), Some(count), "{count}");
        }
        assert_eq!(best_together(&[], &total, &ideal, 100.0), None);
    }
}
