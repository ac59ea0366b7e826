//! Where the separatrices of a singularity leave its triangle.

use crate::cross_field::TriangleCross;
use crate::numerics::tolerances::PORT_SHARE;
use crate::numerics::{cross, Point};
use std::f64::consts::{FRAC_PI_2, PI};

/// Intervals in which each edge is searched.
const INTERVALS: usize = 24;
/// Bisections of an interval: to 2^-40 of it.
const BISECTIONS: usize = 40;

/// The border of a singular triangle, seen from the singular point.
struct View<'a> {
    corners: [Point; 3],
    field: &'a TriangleCross,
    point: Point,
    /// Direction from the point to each corner, lifted; the fourth is the first after a full turn.
    directions: [f64; 4],
    /// How much the direction minus the cross turns in all, a multiple of π/2, over 2π.
    slope: f64,
    /// The mean of (direction minus cross) less its share that grows with the direction.
    phase: f64,
}

impl<'a> View<'a> {
    fn new(corners: [Point; 3], field: &'a TriangleCross, point: Point, valence: u8) -> Self {
        let to = corners.map(|c| c - point);
        let mut directions = [to[0].y.atan2(to[0].x); 4];
        for i in 0..3 {
            let (a, b) = (to[i], to[(i + 1) % 3]);
            directions[i + 1] = directions[i] + cross(a, b).atan2(a.dot(&b));
        }
        let slope = f64::from(valence) / 4.0;
        let mut view = View { corners, field, point, directions, slope, phase: 0.0 };
        let count = 3 * INTERVALS;
        view.phase = (0..count)
            .map(|k| (k / INTERVALS, (k % INTERVALS) as f64 / INTERVALS as f64 + 0.5 / INTERVALS as f64))
            .map(|(edge, share)| view.excess(edge, share, 0.0) - view.slope * view.direction(edge, share))
            .sum::<f64>()
            / count as f64;
        view
    }

    /// Direction from the singular point to a point of the border, lifted.
    fn direction(&self, edge: usize, share: f64) -> f64 {
        let (a, b) = (self.corners[edge], self.corners[(edge + 1) % 3]);
        let (from, to) = (a - self.point, a + (b - a) * share - self.point);
        self.directions[edge] + cross(from, to).atan2(from.dot(&to))
    }

    /// Direction minus cross, blended by `evenness` with its part that grows evenly.
    fn excess(&self, edge: usize, share: f64, evenness: f64) -> f64 {
        let direction = self.direction(edge, share);
        let angle = self.field.start_of_edge(edge) + share * self.field.edge_turn[edge];
        let even = self.slope * direction + self.phase;
        (1.0 - evenness) * (direction - angle) + evenness * even
    }

    /// The border points where the blended excess is a whole number of quarter turns, counter-clockwise.
    fn crossings(&self, evenness: f64) -> Vec<(u8, f64)> {
        let mut found = Vec::new();
        let mut last = self.excess(0, 0.0, evenness);
        for edge in 0..3 {
            for k in 0..=INTERVALS {
                let share = k as f64 / INTERVALS as f64;
                let value = self.excess(edge, share, evenness);
                let (low, high) = (last.min(value), last.max(value));
                let mut levels: Vec<f64> = ((low / FRAC_PI_2).ceil() as i64
                    ..=(high / FRAC_PI_2).floor() as i64)
                    .map(|m| m as f64 * FRAC_PI_2)
                    // Each interval holds its end and not its start.
                    .filter(|&level| level != last)
                    .collect();
                if value < last {
                    levels.reverse();
                }
                // At k = 0 the cross turns at the corner: such a point belongs to the edge's start.
                let from = (k.max(1) - 1) as f64 / INTERVALS as f64;
                found.extend(
                    levels.into_iter().map(|x| (edge as u8, self.solve(edge, [from, share], x, evenness))),
                );
                last = value;
            }
        }
        // The turn at the first corner comes last.
        let closed = self.excess(0, 0.0, evenness) + 2.0 * PI * self.slope;
        let levels = (closed / FRAC_PI_2).floor() - (last / FRAC_PI_2).floor();
        if closed - last > 1e-9 && levels >= 1.0 {
            found.push((2, 1.0));
        }
        found
    }

    /// The share of `edge` between two where the blended excess is `level`.
    fn solve(&self, edge: usize, between: [f64; 2], level: f64, evenness: f64) -> f64 {
        let [mut from, mut to] = between;
        let below = self.excess(edge, from, evenness) < level;
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (from + to);
            match (self.excess(edge, middle, evenness) < level) == below {
                true => from = middle,
                false => to = middle,
            }
        }
        0.5 * (from + to)
    }
}

/// The singular point and its ports (edge, share) in counter-clockwise order, `valence` of them.
///
/// Ports are where the cross points away from the point. Seen from `point` the cross may turn so
/// unevenly that there are more such places. Then the point is moved towards the centroid, and
/// if that does not help the cross is blended with one that turns evenly about the point (its
/// conformal part), as little as makes the number right.
pub(super) fn ports(
    corners: [Point; 3],
    field: &TriangleCross,
    point: Point,
    valence: u8,
) -> (Point, Vec<(u8, f64)>) {
    let centroid = Point::from((corners[0].coords + corners[1].coords + corners[2].coords) / 3.0);
    let moves = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| (point + (centroid - point) * share, 0.0));
    let blends = [0.25, 0.5, 0.75, 1.0].map(|evenness| (centroid, evenness));
    let mut chosen = (point, Vec::new());
    for (place, evenness) in moves.into_iter().chain(blends) {
        let view = View::new(corners, field, place, valence);
        chosen = (place, view.crossings(evenness));
        if chosen.1.len() == valence as usize {
            break;
        }
    }
    let (point, mut ports) = chosen;
    for port in &mut ports {
        port.1 = port.1.clamp(PORT_SHARE, 1.0 - PORT_SHARE);
    }
    // Ports pushed off the same corner stay apart and in order.
    for k in 1..ports.len() {
        if ports[k].0 == ports[k - 1].0 && ports[k].1 <= ports[k - 1].1 {
            ports[k].1 = ports[k - 1].1 + 0.1 * (1.0 - ports[k - 1].1);
        }
    }
    (point, ports)
}
