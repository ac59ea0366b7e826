//! A tree of bounding boxes: all pairs of items whose boxes meet, without looking at all pairs.

use crate::domain::bounds::Bounds;

/// A binary tree over items, split at the median of the longer side.
pub(crate) struct BoxTree {
    /// Items in tree order.
    items: Vec<u32>,
    boxes: Vec<Bounds>,
    nodes: Vec<Node>,
}

struct Node {
    bounds: Bounds,
    /// Range in `items`.
    first: usize,
    end: usize,
    /// Children; none at a leaf.
    children: Option<[usize; 2]>,
}

/// Items in a leaf.
const LEAF: usize = 4;

impl BoxTree {
    /// The tree over items 0, 1, ... with these boxes.
    pub fn new(boxes: Vec<Bounds>) -> Self {
        let n = boxes.len();
        let mut tree = BoxTree { items: (0..n as u32).collect(), boxes, nodes: Vec::new() };
        if n > 0 {
            tree.build(0, n);
        }
        tree
    }

    fn build(&mut self, first: usize, end: usize) -> usize {
        let mut bounds = Bounds::new();
        for &i in &self.items[first..end] {
            bounds.merge(&self.boxes[i as usize]);
        }
        let index = self.nodes.len();
        self.nodes.push(Node { bounds, first, end, children: None });
        if end - first > LEAF {
            let size = bounds.high - bounds.low;
            let boxes = &self.boxes;
            let key = |i: &u32| {
                let c = boxes[*i as usize].center();
                if size.x >= size.y {
                    c.x
                } else {
                    c.y
                }
            };
            let middle = (end - first) / 2;
            // Halving by number keeps the depth logarithmic whatever the boxes.
            self.items[first..end]
                .select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
            let left = self.build(first, first + middle);
            let right = self.build(first + middle, end);
            self.nodes[index].children = Some([left, right]);
        }
        index
    }

    /// All pairs (i < j) whose boxes meet, sorted.
    pub fn meeting_pairs(&self) -> Vec<(u32, u32)> {
        let mut pairs = Vec::new();
        let mut open = Vec::new();
        if !self.nodes.is_empty() {
            open.push((0, 0));
        }
        while let Some((a, b)) = open.pop() {
            let (p, q) = (&self.nodes[a], &self.nodes[b]);
            if !p.bounds.meets(&q.bounds) {
                continue;
            }
            match (p.children, q.children) {
                (Some([l, r]), _) if a == b => open.extend([(l, l), (r, r), (l, r)]),
                (Some([l, r]), None) => open.extend([(l, b), (r, b)]),
                (None, Some([l, r])) => open.extend([(a, l), (a, r)]),
                (Some([l, r]), Some(_)) if p.end - p.first >= q.end - q.first => {
                    open.extend([(l, b), (r, b)])
                }
                (_, Some([l, r])) => open.extend([(a, l), (a, r)]),
                (None, None) => self.leaf_pairs(a, b, &mut pairs),
            }
        }
        pairs.sort_unstable();
        pairs
    }

    fn leaf_pairs(&self, a: usize, b: usize, pairs: &mut Vec<(u32, u32)>) {
        let (p, q) = (&self.nodes[a], &self.nodes[b]);
        for (k, &i) in self.items[p.first..p.end].iter().enumerate() {
            let others = if a == b { p.first + k + 1..p.end } else { q.first..q.end };
            for &j in &self.items[others] {
                if self.boxes[i as usize].meets(&self.boxes[j as usize]) {
                    pairs.push((i.min(j), i.max(j)));
                }
            }
        }
    }
}
