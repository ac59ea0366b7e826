//! Which points fall together because something between them has length 0, and why.

use std::collections::VecDeque;

/// Union-find over points that remembers the reason (arcs whose total is 0) of every identification.
#[derive(Debug, Clone)]
pub(super) struct Identification {
    parent: Vec<u32>,
    links: Vec<Vec<(u32, u32)>>,
    reasons: Vec<Vec<u32>>,
}

impl Identification {
    /// `n` points, all distinct.
    pub fn new(n: usize) -> Self {
        Identification { parent: (0..n as u32).collect(), links: vec![Vec::new(); n], reasons: Vec::new() }
    }

    /// A reason to be given to [`unite`](Self::unite): the arcs.
    pub fn reason(&mut self, arcs: Vec<u32>) -> u32 {
        self.reasons.push(arcs);
        self.reasons.len() as u32 - 1
    }

    /// The point that stands for the class of `i`.
    pub fn find(&self, mut i: u32) -> u32 {
        while self.parent[i as usize] != i {
            i = self.parent[i as usize];
        }
        i
    }

    fn find_and_shorten(&mut self, i: u32) -> u32 {
        let root = self.find(i);
        let mut j = i;
        while self.parent[j as usize] != root {
            j = std::mem::replace(&mut self.parent[j as usize], root);
        }
        root
    }

    /// Two points are the same.
    pub fn unite(&mut self, a: u32, b: u32, reason: u32) {
        if a == b {
            return;
        }
        self.links[a as usize].push((b, reason));
        self.links[b as usize].push((a, reason));
        let (a, b) = (self.find_and_shorten(a), self.find_and_shorten(b));
        // The smaller index stands for the class, whatever the order of the unions.
        self.parent[a.max(b) as usize] = a.min(b);
    }

    /// Classes numbered 0.. by their first point: the class of every point, and their number.
    pub fn classes(&self) -> (Vec<u32>, usize) {
        let mut class = vec![0u32; self.parent.len()];
        let mut n = 0;
        for i in 0..self.parent.len() {
            let root = self.find(i as u32) as usize;
            if root == i {
                class[i] = n;
                n += 1;
            } else {
                class[i] = class[root];
            }
        }
        (class, n as usize)
    }

    /// The arcs on the shortest chain of identifications from `a` to `b`, sorted; `None` if they
    /// are not in one class. At least one of these arcs must have a length for the two to part.
    pub fn chain(&self, a: u32, b: u32) -> Option<Vec<u32>> {
        let mut before: std::collections::BTreeMap<u32, (u32, u32)> = [(a, (a, 0))].into();
        let mut queue = VecDeque::from([a]);
        while let Some(x) = queue.pop_front() {
            if x == b {
                break;
            }
            for &(y, reason) in &self.links[x as usize] {
                before.entry(y).or_insert_with(|| {
                    queue.push_back(y);
                    (x, reason)
                });
            }
        }
        let mut arcs = Vec::new();
        let mut x = b;
        before.get(&b)?;
        while x != a {
            let (previous, reason) = before[&x];
            arcs.extend_from_slice(&self.reasons[reason as usize]);
            x = previous;
        }
        arcs.sort_unstable();
        arcs.dedup();
        Some(arcs)
    }
}
