//! How thick the domain is around each vertex of the base mesh.

use super::border::Border;
use crate::base_mesh::Triangulation;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Loss of thickness by unit of distance: small enough to reach the walls of a thick part from its
/// middle, large enough to stay out of thin parts beside it.
const DECAY: f64 = 0.5;

/// A vertex and its key; the heap gives the largest key first, then the lowest vertex.
#[derive(PartialEq)]
struct Entry(f64, u32);

impl Eq for Entry {}

impl Ord for Entry {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0).then(other.1.cmp(&self.1))
    }
}

impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Vertices joined by edges, in compressed rows.
struct Edges {
    start: Vec<u32>,
    ends: Vec<u32>,
}

impl Edges {
    fn new(mesh: &Triangulation) -> Edges {
        // Each inner edge comes once from both of its triangles; border edges lack their reverse, which
        // does not matter: both of their vertices are sources.
        let mut start = vec![0; mesh.vertices.len() + 1];
        mesh.triangles.iter().flatten().for_each(|&v| start[v as usize + 1] += 1);
        for v in 0..mesh.vertices.len() {
            start[v + 1] += start[v];
        }
        let mut fill = start.clone();
        let mut ends = vec![0; 3 * mesh.triangles.len()];
        for t in &mesh.triangles {
            for i in 0..3 {
                let slot = &mut fill[t[i] as usize];
                ends[*slot as usize] = t[(i + 1) % 3];
                *slot += 1;
            }
        }
        Edges { start, ends }
    }

    /// Raises `value` to the largest of value(w) − `decay` · (path from w) over all w.
    fn spread(&self, mesh: &Triangulation, value: &mut [f64], decay: f64) {
        let mut heap: BinaryHeap<Entry> =
            (0u32..).zip(value.iter()).filter(|(_, x)| x.is_finite()).map(|(v, &x)| Entry(x, v)).collect();
        while let Some(Entry(x, v)) = heap.pop() {
            if x < value[v as usize] {
                continue;
            }
            let at = mesh.vertices[v as usize].point;
            for &w in &self.ends[self.start[v as usize] as usize..self.start[v as usize + 1] as usize] {
                let spread = x - decay * (mesh.vertices[w as usize].point - at).norm();
                if spread > value[w as usize] {
                    value[w as usize] = spread;
                    heap.push(Entry(spread, w));
                }
            }
        }
    }
}

/// For each vertex the radius of about the largest disc around it or beside it: the distance to the
/// border along edges, carried from the middle of each part to its walls.
pub(super) fn thickness(mesh: &Triangulation, border: &Border) -> Vec<f64> {
    let edges = Edges::new(mesh);
    let at_border = |v: u32| if border.holds(v) { 0.0 } else { f64::NEG_INFINITY };
    // Minus the distance: the nearest wall is the largest.
    let mut value: Vec<f64> = (0..mesh.vertices.len() as u32).map(at_border).collect();
    edges.spread(mesh, &mut value, 1.0);
    value.iter_mut().for_each(|x| *x = -*x);
    edges.spread(mesh, &mut value, DECAY);
    value
}
