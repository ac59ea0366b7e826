//! Boundary vertices near a merge moved along their chains until every edge keeps the tolerance again.

use super::merge::Merge;
use super::stretch::{worst_of, Stretch, ALLOWED};
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::mesh::BoundaryError;

/// Edges on either side among which room is looked for: what lies farther away would have to be moved, and
/// optimised again, for one edge less.
const FARTHEST: usize = 32;

/// Windows tried, for each edge that may break the tolerance: windows that take room from each other must end.
const TRIES_PER_EDGE: usize = 4;

/// Edges of the merged mesh along a chain.
struct Window<'a> {
    stretch: Stretch<'a>,
    chain: u32,
    /// The ends of the edges.
    vertices: Vec<u32>,
}

/// Makes the boundary edges of the quads at the merged vertices, and the next ones, keep the tolerance by moving vertices along their chains,
/// near the offending edges first, along the whole of a short chain at worst. The vertices moved; `None`
/// if it cannot be done.
pub(super) fn respace(boundary: &Boundary, error: &BoundaryError, merge: &mut Merge) -> Option<Vec<u32>> {
    let mut edges: Vec<[u32; 2]> = Vec::new();
    let quads = merge.touched.iter().flat_map(|v| merge.star(*v));
    let mut near: Vec<u32> = quads.flat_map(|q| merge.corners(*q)).collect();
    near.sort_unstable();
    near.dedup();
    near.retain(|v| merge.vertex(*v).place != Place::Interior);
    for v in near {
        let [before, after] = merge.along_loop(v)?;
        edges.extend([[before, v], [v, after]]);
    }
    edges.sort_unstable();
    edges.dedup();
    let ratio = |merge: &Merge, [a, b]: [u32; 2]| {
        let span = boundary.span(merge.vertex(a).place, merge.vertex(b).place)?;
        Some(error.ratio(boundary, span))
    };
    let mut ratios = edges.iter().map(|e| ratio(merge, *e)).collect::<Option<Vec<f64>>>()?;
    let mut all_moved: Vec<u32> = Vec::new();
    let mut tries = TRIES_PER_EDGE * edges.len();
    while let Some(worst) = worst_of(&ratios) {
        let (window, at) = Window::around(boundary, error, merge, edges[worst])?;
        let room = window.stretch.make_room(at)?;
        let moved = window.write(boundary, merge, &room.ends);
        for (ratio_of, edge) in ratios.iter_mut().zip(&edges) {
            let placed_anew = room.all && edge.iter().all(|v| window.vertices.contains(v));
            if placed_anew || edge.iter().any(|v| moved.contains(v)) {
                *ratio_of = ratio(merge, *edge)?;
            }
            // The whole chain's placement may leave edges between what is allowed and the tolerance, for good.
            if placed_anew && *ratio_of <= 1.0 {
                *ratio_of = ratio_of.min(ALLOWED);
            }
        }
        if ratios[worst] > ALLOWED {
            return None;
        }
        all_moved.extend(moved);
        tries -= 1;
        if tries == 0 {
            return None;
        }
    }
    Some(all_moved)
}

impl<'a> Window<'a> {
    /// The edges around `edge`, and its index among them.
    fn around(
        boundary: &'a Boundary,
        error: &'a BoundaryError,
        merge: &Merge,
        edge: [u32; 2],
    ) -> Option<(Self, usize)> {
        let chain = boundary.span(merge.vertex(edge[0]).place, merge.vertex(edge[1]).place)?.chain;
        let ends_chain = |v: u32| matches!(merge.vertex(v).place, Place::Junction(_));
        let mut vertices = vec![edge[0]];
        while vertices.len() <= FARTHEST && !ends_chain(vertices[vertices.len() - 1]) {
            let [before, _] = merge.along_loop(vertices[vertices.len() - 1])?;
            if before == edge[1] {
                break;
            }
            vertices.push(before);
        }
        vertices.reverse();
        let at = vertices.len() - 1;
        vertices.push(edge[1]);
        let mut last = edge[1];
        while vertices.len() < at + FARTHEST + 2 && !ends_chain(last) && last != vertices[0] {
            [_, last] = merge.along_loop(last)?;
            vertices.push(last);
        }
        let whole = last == vertices[0] || (ends_chain(vertices[0]) && ends_chain(last));
        let mut ends: Vec<f64> = Vec::with_capacity(vertices.len());
        for pair in vertices.windows(2) {
            let span = boundary.span(merge.vertex(pair[0]).place, merge.vertex(pair[1]).place)?;
            let start = ends.last().copied().unwrap_or(span.start);
            if ends.is_empty() {
                ends.push(start);
            }
            ends.push(start + (span.end - span.start));
        }
        let stretch = Stretch { curve: &boundary.chains[chain as usize], error, ends, whole };
        Some((Window { stretch, chain, vertices }, at))
    }

    /// Moves the vertices to `ends`; those that were elsewhere before.
    fn write(&self, boundary: &Boundary, merge: &mut Merge, ends: &[f64]) -> Vec<u32> {
        let curve = &boundary.chains[self.chain as usize];
        let mut moved = Vec::new();
        for (i, v) in self.vertices.iter().enumerate() {
            let mut vertex = merge.vertex(*v);
            if let Place::Boundary(p) = &mut vertex.place {
                // A closed chain's last vertex is its first, a lap later.
                if ends[i] != self.stretch.ends[i] && !moved.contains(v) {
                    *p = BoundaryPoint { chain: self.chain, s: curve.wrap(ends[i]) };
                    vertex.point = curve.point(p.s);
                    merge.set_vertex(*v, vertex);
                    moved.push(*v);
                }
            }
        }
        moved
    }
}
