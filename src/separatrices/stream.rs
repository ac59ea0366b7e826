//! The order-preserving map of streamlines through one triangle.
//!
//! Along each edge the outflow density (length × cosine between the branch of the cross and the outward
//! normal) is taken linear between its end values, so that an edge has at most one inflow and one
//! outflow part, the same seen from both sides. A streamline that enters at p leaves at the q where
//! the flux between p and q balances, inflow and outflow scaled to the same total. So the map is
//! monotone, its reverse is the map of the opposite branch, and two streamlines of one family never
//! cross or merge. (The idea of monotone edge maps: Ray & Sokolov 2014; Myles, Pietroni & Zorin 2014.)

use crate::base_mesh::Triangulation;
use crate::cross_field::CrossField;
use crate::numerics::{Point, NONE};
use std::cmp::Ordering;
use std::f64::consts::FRAC_PI_2;

/// A point of a triangle's border: `share` of edge `edge` from its start; a corner is share 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Position {
    pub edge: usize,
    pub share: f64,
}

impl Position {
    fn mirrored(self) -> Position {
        Position { edge: 2 - self.edge, share: 1.0 - self.share }
    }

    /// How far `self` lies behind `from`, walking counter-clockwise (or clockwise): comparable with other
    /// distances from the same place.
    pub fn distance(self, from: Position, ccw: bool) -> (usize, f64) {
        let (x, p) = if ccw { (self, from) } else { (self.mirrored(), from.mirrored()) };
        let mut edges = (x.edge + 3 - p.edge) % 3;
        if edges == 0 && x.share < p.share {
            edges = 3;
        }
        (edges, x.share)
    }

    /// Whether `self` lies strictly inside the walk from `from` to `to`.
    pub fn within(self, from: Position, to: Position, ccw: bool) -> bool {
        self != from && self != to && before(self.distance(from, ccw), to.distance(from, ccw))
    }
}

/// Strict order of two distances.
pub(crate) fn before(a: (usize, f64), b: (usize, f64)) -> bool {
    a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)) == Ordering::Less
}

/// A part of an edge with outflow (or inflow) only; densities at its ends, positive for outflow.
#[derive(Debug, Clone, Copy)]
struct Piece {
    edge: usize,
    ends: [f64; 2],
    density: [f64; 2],
}

impl Piece {
    fn flux(&self) -> f64 {
        (self.ends[1] - self.ends[0]) * 0.5 * (self.density[0] + self.density[1])
    }

    fn density_at(&self, x: f64) -> f64 {
        let w = (x - self.ends[0]) / (self.ends[1] - self.ends[0]);
        self.density[0] * (1.0 - w) + self.density[1] * w
    }

    /// The part of this piece from the walk's start (or `from`) on.
    fn after(&self, from: f64, ccw: bool) -> Piece {
        let d = self.density_at(from);
        if ccw {
            Piece { ends: [from, self.ends[1]], density: [d, self.density[1]], ..*self }
        } else {
            Piece { ends: [self.ends[0], from], density: [self.density[0], d], ..*self }
        }
    }

    /// Where the flux from the walk's start of the piece has the size `flux`; strictly inside.
    fn invert(&self, flux: f64, ccw: bool) -> f64 {
        let [a, b] = self.ends;
        let [qa, qb] = self.density.map(f64::abs);
        let slope = (qb - qa) / (b - a);
        let (q, m) = if ccw { (qa, slope) } else { (qb, -slope) };
        let root = (q * q + 2.0 * m * flux).max(0.0).sqrt();
        let d = if q + root > 0.0 { 2.0 * flux / (q + root) } else { 0.0 };
        let x = if ccw { a + d } else { b - d };
        let margin = INSET * (b - a);
        x.clamp(a + margin, b - margin)
    }
}

/// Least distance of a crossing from an edge's ends and from the change between inflow and
/// outflow, relative to that part of the edge: only keeps rounding from hitting a vertex.
const INSET: f64 = 1e-13;

/// Outflow beside the entry, relative to the triangle's, that is rounding of the change between inflow and
/// outflow and no exit: angles carry 1e-15, lifts and shares some powers of ten more.
const SLIVER: f64 = 1e-9;

/// A branch of the cross: the lifted angle plus `branch` quarter turns.
pub(crate) type Branch = i32;

/// Streamlines through the triangles of a base mesh.
pub(crate) struct Stream<'a> {
    pub mesh: &'a Triangulation,
    pub field: &'a CrossField,
}

impl Stream<'_> {
    pub fn corner(&self, triangle: u32, i: usize) -> Point {
        let v = self.mesh.triangles[triangle as usize][i % 3];
        self.mesh.vertices[v as usize].point
    }

    pub fn point(&self, triangle: u32, at: Position) -> Point {
        let (a, b) = (self.corner(triangle, at.edge), self.corner(triangle, at.edge + 1));
        a + (b - a) * at.share
    }

    /// The lifted angle of the cross at the start of edge `edge`, walking from corner 0.
    pub fn angle_at_start(&self, triangle: u32, edge: usize) -> f64 {
        let c = &self.field.triangles[triangle as usize];
        (0..edge).fold(c.start, |a, j| a + c.edge_turn[j] + c.corner_turn[(j + 1) % 3])
    }

    pub fn angle(&self, triangle: u32, at: Position) -> f64 {
        let c = &self.field.triangles[triangle as usize];
        self.angle_at_start(triangle, at.edge) + c.edge_turn[at.edge] * at.share
    }

    /// The branch at `at` whose direction is nearest to the angle `direction`.
    pub fn branch(&self, triangle: u32, at: Position, direction: f64) -> Branch {
        ((direction - self.angle(triangle, at)) / FRAC_PI_2).round() as Branch
    }

    /// The same point and direction seen from the triangle across; `None` at the border.
    pub fn across(&self, triangle: u32, at: Position, branch: Branch) -> Option<(u32, Position, Branch)> {
        let other = self.mesh.neighbors[triangle as usize][at.edge];
        if other == NONE {
            return None;
        }
        let start = self.mesh.triangles[triangle as usize][(at.edge + 1) % 3];
        let edge = self.mesh.triangles[other as usize].iter().position(|&v| v == start)?;
        let there = Position { edge, share: 1.0 - at.share };
        let direction = self.angle(triangle, at) + f64::from(branch) * FRAC_PI_2;
        Some((other, there, self.branch(other, there, direction)))
    }

    /// Outflow densities of `branch` at both ends of edge `edge`, the lift shifted by `lift` quarter turns.
    fn densities(&self, triangle: u32, edge: usize, branch: Branch) -> [f64; 2] {
        let (a, b) = (self.corner(triangle, edge), self.corner(triangle, edge + 1));
        let along = b - a;
        let length = along.norm();
        let direction = along.y.atan2(along.x);
        let start = self.angle_at_start(triangle, edge) + f64::from(branch) * FRAC_PI_2;
        let c = &self.field.triangles[triangle as usize];
        if self.mesh.neighbors[triangle as usize][edge] == NONE {
            // A border edge is a streamline itself: a branch runs along it or straight across.
            let quarter = ((start - direction) / FRAC_PI_2).round() as i64;
            let out = match quarter.rem_euclid(4) {
                3 => length,
                1 => -length,
                _ => 0.0,
            };
            return [out, out];
        }
        // cos(angle − outward normal), the normal being the edge's direction − 90°.
        let out = |angle: f64| -length * (angle - direction).sin();
        [out(start), out(start + c.edge_turn[edge])]
    }

    /// The single-signed pieces of an edge in counter-clockwise order.
    fn pieces(&self, triangle: u32, edge: usize, branch: Branch, out: &mut Vec<Piece>) {
        let [q0, q1] = self.densities(triangle, edge, branch);
        if q0 == 0.0 && q1 == 0.0 {
            return;
        }
        if q0 * q1 >= 0.0 {
            out.push(Piece { edge, ends: [0.0, 1.0], density: [q0, q1] });
        } else {
            let x = q0 / (q0 - q1);
            if x > 0.0 {
                out.push(Piece { edge, ends: [0.0, x], density: [q0, 0.0] });
            }
            if x < 1.0 {
                out.push(Piece { edge, ends: [x, 1.0], density: [0.0, q1] });
            }
        }
    }

    /// Where the streamline of `branch` that enters a regular triangle at `from` leaves it, and whether
    /// the flux was balanced counter-clockwise.
    pub fn through_regular(&self, triangle: u32, from: Position, branch: Branch) -> Option<(Position, bool)> {
        let mut pieces = Vec::with_capacity(6);
        (0..3).for_each(|e| self.pieces(triangle, e, branch, &mut pieces));
        let ccw = self.balance_counter_clockwise(triangle, branch);
        let walk = rotate(&pieces, from, ccw);
        first_return(&pieces, &walk, from, ccw).map(|q| (q, ccw))
    }

    /// A streamline that touches an edge from inside splits the flow. Where it passes from inflow to
    /// outflow (counter-clockwise) the balance has to be taken clockwise, else counter-clockwise.
    fn balance_counter_clockwise(&self, triangle: u32, branch: Branch) -> bool {
        let c = &self.field.triangles[triangle as usize];
        let mut to_outflow = false;
        let mut to_inflow = false;
        for edge in 0..3 {
            let [q0, q1] = self.densities(triangle, edge, branch);
            // The cross turns to the left along the edge: tangent from inside.
            if q0 * q1 < 0.0 && c.edge_turn[edge] > 0.0 {
                if q0 < 0.0 {
                    to_outflow = true;
                } else {
                    to_inflow = true;
                }
            }
        }
        match (to_outflow, to_inflow) {
            (true, false) => false,
            (false, true) => true,
            _ => branch.rem_euclid(4) < 2,
        }
    }

    /// The same in a singular triangle with separatrix ports `ports` (counter-clockwise): a streamline that
    /// comes in beside a port passes the singular point, crosses the next port and leaves beside
    /// the one after.
    pub fn through_singular(
        &self,
        triangle: u32,
        ports: &[Position],
        from: Position,
        branch: Branch,
        singular: Point,
    ) -> Option<(Position, bool)> {
        let n = ports.len();
        // Port i is the last one at or before `from`, counter-clockwise.
        let key = |p: Position| (p.edge, p.share);
        let last = |below: bool| {
            (0..n).filter(|&j| !below || key(ports[j]) <= key(from)).max_by(|&a, &b| {
                ports[a].edge.cmp(&ports[b].edge).then(ports[a].share.total_cmp(&ports[b].share))
            })
        };
        let i = last(true).or_else(|| last(false))?;
        let outward = self.point(triangle, ports[i]) - singular;
        let port_branch = self.branch(triangle, ports[i], outward.y.atan2(outward.x));
        // Branch of `from` on the lift that starts at port i.
        let winding = self.field.triangles[triangle as usize].winding;
        let wrapped =
            from.edge < ports[i].edge || (from.edge == ports[i].edge && from.share < ports[i].share);
        let lifted = if wrapped { branch - winding } else { branch };
        // From port j to port j + 2 one family flows around the singular point: from the first to the
        // second counter-clockwise, or back. Streamlines beside the middle port may enter past it.
        let (first, ccw) = match (lifted - port_branch).rem_euclid(4) {
            0 => (i, false),
            1 => (i + n - 1, true),
            2 => (i, true),
            _ => (i + n - 1, false),
        };
        let last = first + 2;
        let (p, q) = (ports[first % n], ports[last % n]);
        let starts_wrapped = from.edge < p.edge || (from.edge == p.edge && from.share < p.share);
        // Branch on the lift whose value at `from` is `branch`, as seen at each edge of the interval.
        let mut pieces = Vec::with_capacity(8);
        let total = q.distance(p, true);
        for step in 0..=3usize {
            let edge = (p.edge + step) % 3;
            let passed_corner_zero = p.edge + step >= 3;
            // Crossing corner 0 counter-clockwise raises the lift by `winding` quarter turns.
            let shift = match (starts_wrapped, passed_corner_zero) {
                (true, false) => -winding,
                (false, true) => winding,
                _ => 0,
            };
            let mut own = Vec::with_capacity(2);
            self.pieces(triangle, edge, branch + shift, &mut own);
            let low = if step == 0 { p.share } else { 0.0 };
            let high = if step == total.0 { q.share } else { 1.0 };
            for piece in own {
                let (a, b) = (piece.ends[0].max(low), piece.ends[1].min(high));
                if a < b {
                    let density = [piece.density_at(a), piece.density_at(b)];
                    pieces.push(Piece { edge, ends: [a, b], density });
                }
            }
            if step == total.0 {
                break;
            }
        }
        let walk = cut(&pieces, from, ccw, p);
        first_return(&pieces, &walk, from, ccw).map(|x| (x, ccw))
    }
}

/// Pieces in walking order from `from` once around, the first one cut at `from`.
fn rotate(pieces: &[Piece], from: Position, ccw: bool) -> Vec<Piece> {
    let n = pieces.len();
    let order = |i: usize| if ccw { pieces[i] } else { pieces[n - 1 - i] };
    let behind = |p: &Piece| {
        let end = Position { edge: p.edge, share: if ccw { p.ends[1] } else { p.ends[0] } };
        if ccw {
            (end.edge, end.share) > (from.edge, from.share)
        } else {
            (end.edge, end.share) < (from.edge, from.share)
        }
    };
    let first = (0..n).find(|&i| behind(&order(i))).unwrap_or(0);
    let mut walk: Vec<Piece> = (0..n).map(|i| order((first + i) % n)).collect();
    if let Some(p) = walk.first_mut() {
        if p.edge == from.edge && p.ends[0] < from.share && from.share < p.ends[1] {
            let whole = *p;
            *p = whole.after(from.share, ccw);
            walk.push(whole.after(from.share, !ccw));
        }
    }
    walk
}

/// Pieces of an interval that starts (counter-clockwise) at `start`, in walking order from `from` to its end.
fn cut(pieces: &[Piece], from: Position, ccw: bool, start: Position) -> Vec<Piece> {
    let here = from.distance(start, true);
    let mut walk = Vec::with_capacity(pieces.len());
    for p in pieces {
        let [a, b] = p.ends.map(|share| {
            let d = Position { edge: p.edge, share }.distance(start, true);
            // The interval's first point itself is at distance 0, not once around.
            if share == start.share && p.edge == start.edge {
                (0, start.share)
            } else {
                d
            }
        });
        if ccw && before(here, b) {
            walk.push(if before(a, here) { p.after(from.share, true) } else { *p });
        } else if !ccw && before(a, here) {
            walk.push(if before(here, b) { p.after(from.share, false) } else { *p });
        }
    }
    if !ccw {
        walk.reverse();
    }
    walk
}

/// Walks from `from` until inflow (scaled to the total outflow of `all`) and outflow balance.
fn first_return(all: &[Piece], walk: &[Piece], from: Position, ccw: bool) -> Option<Position> {
    let (mut inflow, mut outflow) = (0.0, 0.0);
    for p in all {
        let f = p.flux();
        if f < 0.0 {
            inflow -= f;
        } else {
            outflow += f;
        }
    }
    if inflow <= 0.0 || outflow <= 0.0 {
        return None;
    }
    let scale = inflow / outflow;
    let mut level = 0.0;
    let mut last = None;
    let mut entered = false;
    for p in walk {
        let f = p.flux();
        if f < 0.0 {
            level -= f;
            entered = true;
        } else if f > 0.0 {
            // Rounding may put the entry a hair beyond the change to outflow: that sliver is no exit.
            if !entered && p.edge == from.edge && level <= 0.0 && walk.len() > 1 && f < SLIVER * outflow {
                continue;
            }
            if level - f * scale <= 0.0 {
                return Some(Position { edge: p.edge, share: p.invert(level / scale, ccw) });
            }
            level -= f * scale;
            last = Some(*p);
        }
    }
    // All balanced but for rounding: the last exit there is.
    last.map(|p| {
        let share = if ccw { p.ends[1] } else { p.ends[0] };
        let inset = INSET * (p.ends[1] - p.ends[0]);
        Position { edge: p.edge, share: share.clamp(p.ends[0] + inset, p.ends[1] - inset) }
    })
}
