//! A tree of the places that want short edges around them: the least wish at a point without asking all places.
//!
//! *In:* places with the edge length that each wants. *Out:* the least of what they want at a point, each wish growing
//! with the distance from its place. Branch and bound: a box of places cannot want less than its least wish grown over
//! the distance to the box.

use crate::numerics::Point;

/// Growth of the wanted length with the distance from a place: what triangles of 26° can follow.
const GROWTH: f64 = 0.35;
/// The full wish holds within so many edges of the place.
const CORE: f64 = 2.0;
/// Places in a leaf.
const LEAF: usize = 8;

struct Node {
    low: Point,
    high: Point,
    /// The least wish inside.
    least: f64,
    /// Range of places.
    first: usize,
    end: usize,
    /// The second child; the first one follows its parent. 0: a leaf.
    second: usize,
}

/// The tree.
pub(super) struct PlaceTree {
    /// Place, its wish and its number, in tree order.
    places: Vec<(Point, f64, u32)>,
    nodes: Vec<Node>,
}

/// What is wanted at a `distance` from a place that wants `wish`.
pub(super) fn grown(wish: f64, distance: f64) -> f64 {
    wish + GROWTH * (distance - CORE * wish).max(0.0)
}

impl PlaceTree {
    pub fn new(places: impl Iterator<Item = (Point, f64, u32)>) -> Self {
        let mut tree = PlaceTree { places: places.collect(), nodes: Vec::new() };
        if !tree.places.is_empty() {
            tree.build(0, tree.places.len());
        }
        tree
    }

    fn build(&mut self, first: usize, end: usize) {
        let own = &mut self.places[first..end];
        let (mut low, mut high, mut least) = (own[0].0, own[0].0, f64::INFINITY);
        for (p, wish, _) in own.iter() {
            (low, high) = (low.inf(p), high.sup(p));
            least = least.min(*wish);
        }
        let index = self.nodes.len();
        let count = end - first;
        if count > LEAF {
            let axis = usize::from(high.y - low.y > high.x - low.x);
            let by_axis = |a: &(Point, f64, u32), b: &(Point, f64, u32)| {
                a.0[axis].total_cmp(&b.0[axis]).then(a.2.cmp(&b.2))
            };
            own.select_nth_unstable_by(count / 2, by_axis);
        }
        self.nodes.push(Node { low, high, least, first, end, second: 0 });
        if count > LEAF {
            self.build(first, first + count / 2);
            self.nodes[index].second = self.nodes.len();
            self.build(first + count / 2, end);
        }
    }

    /// No place of a node wants less than this at `p`.
    fn bound(&self, node: usize, p: Point) -> f64 {
        let node = &self.nodes[node];
        let [dx, dy] = [0, 1].map(|k| (node.low[k] - p[k]).max(p[k] - node.high[k]).max(0.0));
        grown(node.least, dx.hypot(dy))
    }

    /// The least wish at `p`, or `most` if that is less.
    pub fn least(&self, p: Point, most: f64) -> f64 {
        let mut least = most;
        if !self.nodes.is_empty() {
            self.lower(0, p, &mut least);
        }
        least
    }

    fn lower(&self, index: usize, p: Point, least: &mut f64) {
        let node = &self.nodes[index];
        if node.second == 0 {
            for (q, wish, _) in &self.places[node.first..node.end] {
                *least = least.min(grown(*wish, (p - q).norm()));
            }
            return;
        }
        let mut children = [index + 1, node.second].map(|c| (self.bound(c, p), c));
        if children[1].0 < children[0].0 {
            children.swap(0, 1);
        }
        for (bound, child) in children {
            if bound < *least {
                self.lower(child, p, least);
            }
        }
    }

    /// Whether a place other than `number`, and before it where both want the same, asks at `p` for `wish` or less.
    pub fn covered(&self, p: Point, wish: f64, number: u32) -> bool {
        let mut open = if self.nodes.is_empty() { vec![] } else { vec![0] };
        while let Some(index) = open.pop() {
            let node = &self.nodes[index];
            if self.bound(index, p) > wish {
                continue;
            }
            if node.second > 0 {
                open.extend([index + 1, node.second]);
                continue;
            }
            let before = |(q, own, k): &(Point, f64, u32)| {
                (*own < wish || (*own == wish && *k < number)) && grown(*own, (p - q).norm()) <= wish
            };
            if self.places[node.first..node.end].iter().any(before) {
                return true;
            }
        }
        false
    }
}
