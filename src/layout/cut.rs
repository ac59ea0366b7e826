//! Cutting regions in two and arcs in two: the operations that repair is made of.

use super::polyline::{self, Measured};
use super::{Arc, BlockLayout, Node, NodeKind, Region, SideArc};
use crate::domain::{Boundary, BoundaryPoint, Place, Span};
use crate::numerics::{Point, Vector, NONE};

/// A place on a region's border: before arc `index` of side `side`; index 0 is the corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BorderNode {
    pub side: usize,
    pub index: usize,
}

impl BlockLayout {
    /// The node where a side's arc starts, walked as the side walks it.
    pub fn start(&self, s: SideArc) -> u32 {
        self.arcs[s.arc as usize].nodes[!s.forward as usize]
    }

    /// The node where a side's arc ends.
    pub fn end(&self, s: SideArc) -> u32 {
        self.arcs[s.arc as usize].nodes[s.forward as usize]
    }

    /// The arc's points in the direction in which the side walks it.
    pub fn walked(&self, s: SideArc) -> Vec<Point> {
        let mut points = self.arcs[s.arc as usize].points.clone();
        if !s.forward {
            points.reverse();
        }
        points
    }

    /// The points of several consecutive arcs, ends included.
    pub(super) fn path<'a>(&self, arcs: impl IntoIterator<Item = &'a SideArc>) -> Vec<Point> {
        let mut points: Vec<Point> = Vec::new();
        for &s in arcs {
            let own = self.walked(s);
            points.extend_from_slice(&own[if points.is_empty() { 0 } else { 1 }..]);
        }
        points
    }

    /// A region's border as a closed polygon, counter-clockwise, first point not repeated.
    pub fn polygon(&self, region: u32) -> Vec<Point> {
        let mut points = self.path(self.regions[region as usize].sides.iter().flatten());
        points.pop();
        points
    }

    /// Directions of the border after and before the start of arc `index` of side `side`, both
    /// pointing away from that node.
    fn border_directions(&self, region: u32, at: BorderNode) -> (Vector, Vector) {
        let sides = &self.regions[region as usize].sides;
        let after = sides[at.side][at.index];
        let before = if at.index > 0 {
            sides[at.side][at.index - 1]
        } else {
            let side = &sides[(at.side + sides.len() - 1) % sides.len()];
            side[side.len() - 1]
        };
        let (after, before) = (self.walked(after), self.walked(before));
        let n = before.len();
        (after[1] - after[0], before[n - 2] - before[n - 1])
    }

    /// Interior angle of a region at its corner before side `corner`.
    pub fn corner_angle(&self, region: u32, corner: usize) -> f64 {
        let (after, before) = self.border_directions(region, BorderNode { side: corner, index: 0 });
        polyline::turn(after, before)
    }

    /// The two angles into which a line along `direction` divides the region at a border node.
    pub(super) fn divided_angle(&self, region: u32, at: BorderNode, direction: Vector) -> [f64; 2] {
        let (after, before) = self.border_directions(region, at);
        [polyline::turn(after, direction), polyline::turn(direction, before)]
    }

    /// The node at a border place.
    pub(super) fn border_node(&self, region: u32, at: BorderNode) -> u32 {
        self.start(self.regions[region as usize].sides[at.side][at.index])
    }

    /// Divides an arc at `share` of its measure; the first part keeps its index. All sides that it is on are
    /// brought up to date. Returns the new node.
    pub fn split_arc(
        &mut self,
        arc: u32,
        share: f64,
        size: &dyn Fn(Point) -> f64,
        boundary: &Boundary,
    ) -> u32 {
        let old = &self.arcs[arc as usize];
        let measured = Measured::new(&old.points, size);
        let t = measured.parameter(share);
        let (mut point, run) = measured.at(share);
        let (mut kind, mut place, mut spans) = (NodeKind::Interior, Place::Interior, [None, None]);
        if let Some(span) = old.span {
            let chain = &boundary.chains[span.chain as usize];
            let s = span.start + run * (span.end - span.start);
            kind = NodeKind::Boundary;
            place = Place::Boundary(BoundaryPoint { chain: span.chain, s: chain.wrap(s) });
            point = chain.point(s);
            spans = [Some(Span { end: s, ..span }), Some(Span { start: s, ..span })];
        }
        let node = self.nodes.len() as u32;
        let whole = (t.floor() as usize).min(old.points.len() - 2);
        let mut head = old.points[..=whole].to_vec();
        head.push(point);
        let mut tail = vec![point];
        tail.extend_from_slice(&old.points[whole + 1..]);
        let nodes = old.nodes;
        let new = self.arcs.len() as u32;
        self.nodes.push(Node { point, kind, place });
        self.arcs[arc as usize] = Arc { nodes: [nodes[0], node], points: head, span: spans[0] };
        self.arcs.push(Arc { nodes: [node, nodes[1]], points: tail, span: spans[1] });
        for side in self.regions.iter_mut().flat_map(|r| &mut r.sides) {
            let mut i = 0;
            while i < side.len() {
                if side[i].arc == arc {
                    let forward = side[i].forward;
                    side.insert(if forward { i + 1 } else { i }, SideArc { arc: new, forward });
                    i += 1;
                }
                i += 1;
            }
        }
        node
    }

    /// Cuts a region by a new arc from border place `from` to border place `to`. The part to the right of the
    /// arc (which begins with the border after `from`) keeps the region's index, the other is appended;
    /// its index is returned.
    pub fn cut(&mut self, region: u32, from: BorderNode, to: BorderNode) -> u32 {
        let points = self.cut_path(region, from, to);
        let nodes = [self.border_node(region, from), self.border_node(region, to)];
        let arc = self.arcs.len() as u32;
        self.arcs.push(Arc { nodes, points, span: None });
        let (cycle, p) = self.cycle_from(region, from, to);
        let piece = |range: &[(SideArc, bool)], forward: bool| {
            let mut sides: Vec<Vec<SideArc>> = Vec::new();
            for (i, &(s, corner)) in range.iter().enumerate() {
                if i == 0 || corner {
                    sides.push(Vec::new());
                }
                let last = sides.len() - 1;
                sides[last].push(s);
            }
            sides.push(vec![SideArc { arc, forward }]);
            Region { sides }
        };
        let (right, left) = (piece(&cycle[..p], false), piece(&cycle[p..], true));
        self.regions[region as usize] = right;
        self.regions.push(left);
        self.regions.len() as u32 - 1
    }

    /// The region's border from `from` on, each arc with whether it starts at a corner, and the
    /// index at which `to` comes.
    fn cycle_from(&self, region: u32, from: BorderNode, to: BorderNode) -> (Vec<(SideArc, bool)>, usize) {
        let sides = &self.regions[region as usize].sides;
        let mut cycle = Vec::new();
        let (mut first, mut second) = (0, 0);
        for (s, side) in sides.iter().enumerate() {
            for (i, &arc) in side.iter().enumerate() {
                let here = BorderNode { side: s, index: i };
                if here == from {
                    first = cycle.len();
                }
                if here == to {
                    second = cycle.len();
                }
                cycle.push((arc, i == 0));
            }
        }
        let n = cycle.len();
        cycle.rotate_left(first);
        (cycle, (second + n - first) % n)
    }

    /// Shape of a cut: straight if that stays inside, else the mean of the border on both sides.
    pub(super) fn cut_path(&self, region: u32, from: BorderNode, to: BorderNode) -> Vec<Point> {
        let ends = [from, to].map(|b| self.nodes[self.border_node(region, b) as usize].point);
        let polygon = self.polygon(region);
        let straight = vec![ends[0], ends[1]];
        if ends[0] != ends[1] && !polyline::leaves(&straight, &polygon) {
            return straight;
        }
        let (cycle, p) = self.cycle_from(region, from, to);
        let one = |_: Point| 1.0;
        let right = self.path(cycle[..p].iter().map(|c| &c.0));
        let mut left = self.path(cycle[p..].iter().map(|c| &c.0));
        left.reverse();
        let (right, left) = (Measured::new(&right, &one), Measured::new(&left, &one));
        // Enough pieces to follow the border's bends; the optimiser smooths the rest.
        let pieces = 16;
        let curve = |weight: f64| -> Vec<Point> {
            (0..=pieces)
                .map(|i| {
                    let x = i as f64 / pieces as f64;
                    let (a, b) = (right.at(x).0, left.at(x).0);
                    a + (b - a) * weight
                })
                .collect()
        };
        // Close to one side where the other lies far around a hole.
        let curves = [0.5, 0.35, 0.65, 0.2, 0.8, 0.1, 0.9, 0.05, 0.95, 0.02, 0.98, 0.01, 0.99].map(curve);
        curves.iter().find(|c| !polyline::leaves(c, &polygon)).unwrap_or(&curves[0]).clone()
    }

    /// For each arc the (region, side) pairs that it is on, `NONE` where there is none.
    pub fn arc_sides(&self) -> Vec<[(u32, u32); 2]> {
        let mut on = vec![[(NONE, NONE); 2]; self.arcs.len()];
        for (r, region) in self.regions.iter().enumerate() {
            for (s, side) in region.sides.iter().enumerate() {
                for arc in side {
                    let slots = &mut on[arc.arc as usize];
                    let free = (slots[0].0 != NONE) as usize;
                    slots[free] = (r as u32, s as u32);
                }
            }
        }
        on
    }
}
