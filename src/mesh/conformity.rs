//! The check that a [`QuadMesh`] is a conforming mesh of its whole domain.

use super::QuadMesh;
use crate::domain::{Boundary, Place};
use crate::numerics::tolerances::{PLACE_DISTANCE, SPAN_GAP};
use crate::numerics::{Point, NONE};

/// Why a mesh is none, in words, and where.
type Defect = (String, Point);

impl QuadMesh {
    /// Number of quads at each vertex.
    pub fn quads_at(&self) -> Vec<u32> {
        let mut count = vec![0; self.vertices.len()];
        for v in self.quads.iter().flatten() {
            count[*v as usize] += 1;
        }
        count
    }

    /// Checks every invariant: indices and adjacency agree; every vertex is used, has one fan of quads, at
    /// least three inside; the border edges cover every chain from end to end in order, and every
    /// junction; border vertices lie where their place says; the mesh is in one piece and its Euler
    /// number is that of the domain.
    pub fn check(&self, boundary: &Boundary) -> Result<(), (String, Point)> {
        self.check_indices()?;
        self.check_places(boundary)?;
        self.check_fans()?;
        self.check_chains(boundary)?;
        self.check_euler(boundary)
    }

    fn at(&self, v: u32) -> Point {
        self.vertices.get(v as usize).map_or(Point::origin(), |v| v.point)
    }

    fn check_indices(&self) -> Result<(), Defect> {
        let fail = |what: String, at: Point| Err((what, at));
        if self.quads.is_empty() {
            return fail("the mesh has no quads".into(), Point::origin());
        }
        if self.region.len() != self.quads.len() || self.quad_edges.len() != self.quads.len() {
            return fail(
                "there is not one region and one set of edges for each quad".into(),
                Point::origin(),
            );
        }
        for (q, (quad, edges)) in self.quads.iter().zip(&self.quad_edges).enumerate() {
            for s in 0..4 {
                let (a, b) = (quad[s], quad[(s + 1) % 4]);
                if a as usize >= self.vertices.len() {
                    return fail(format!("quad {q} has no vertex {a}"), Point::origin());
                }
                let at = self.at(a);
                if quad.iter().filter(|v| **v == a).count() > 1 {
                    return fail(format!("quad {q} has a vertex twice"), at);
                }
                let Some(edge) = self.edges.get(edges[s] as usize) else {
                    return fail(format!("quad {q} has no edge on side {s}"), at);
                };
                let side = usize::from(edge.vertices == [b, a]);
                if side == 0 && edge.vertices != [a, b] || edge.quads[side] != q as u32 {
                    return fail(format!("side {s} of quad {q} and its edge disagree"), at);
                }
            }
        }
        // Each side is on an edge's own side, so the counts agree if and only if no edge has more.
        let sides = self.edges.iter().flat_map(|e| e.quads).filter(|q| *q != NONE).count();
        if sides != 4 * self.quads.len() {
            return fail("an edge names a quad that it is not a side of".into(), Point::origin());
        }
        for edge in &self.edges {
            let border = edge.quads[1] == NONE;
            let at = self.at(edge.vertices[0]);
            if edge.quads[0] == NONE {
                return fail("an edge has no quad on its left".into(), at);
            }
            if border != edge.span.is_some() {
                return fail(
                    "an edge is on the border and has no piece of boundary, or the reverse".into(),
                    at,
                );
            }
        }
        let finite = |p: &Point| p.x.is_finite() && p.y.is_finite();
        match self.vertices.iter().find(|v| !finite(&v.point)) {
            Some(v) => fail("a vertex is not finite".into(), v.point),
            None => Ok(()),
        }
    }

    fn check_places(&self, boundary: &Boundary) -> Result<(), Defect> {
        for vertex in &self.vertices {
            let known = match vertex.place {
                Place::Interior => true,
                Place::Boundary(p) => (p.chain as usize) < boundary.chains.len(),
                Place::Junction(j) => (j as usize) < boundary.junctions.len(),
            };
            if !known {
                return Err(("a vertex is at a place that the boundary does not have".into(), vertex.point));
            }
            if boundary.point(vertex.place).is_some_and(|p| (p - vertex.point).norm() > PLACE_DISTANCE) {
                return Err(("a vertex is not at its place on the boundary".into(), vertex.point));
            }
        }
        for edge in &self.edges {
            let [a, b] = edge.vertices.map(|v| self.vertices[v as usize]);
            let Some(span) = edge.span else { continue };
            let expected = boundary.span(a.place, b.place);
            let same = expected.is_some_and(|e| {
                e.chain == span.chain
                    && (e.start - span.start).abs() <= SPAN_GAP
                    && (e.end - span.end).abs() <= SPAN_GAP
            });
            if !same {
                return Err((
                    "a border edge's piece of boundary is not between its vertices".into(),
                    a.point,
                ));
            }
        }
        Ok(())
    }

    /// Every vertex is on a ring of quads, or on one fan between two border edges.
    fn check_fans(&self) -> Result<(), Defect> {
        let count = self.quads_at();
        let mut border_edges = vec![0u32; self.vertices.len()];
        for edge in self.edges.iter().filter(|e| e.quads[1] == NONE) {
            for v in edge.vertices {
                border_edges[v as usize] += 1;
            }
        }
        // A quad at each vertex from which to walk: on the border the one whose side into
        // the vertex is on the border, so that the walk meets the whole fan.
        let mut first = vec![None; self.vertices.len()];
        for (q, quad) in self.quads.iter().enumerate() {
            for s in 0..4 {
                let incoming = self.quad_edges[q][(s + 3) % 4] as usize;
                let slot = &mut first[quad[s] as usize];
                if slot.is_none() || self.edges[incoming].quads[1] == NONE {
                    *slot = Some((q, s));
                }
            }
        }
        for (v, vertex) in self.vertices.iter().enumerate() {
            let fail = |what: &str| Err((what.to_string(), vertex.point));
            let Some((mut q, mut s)) = first[v] else {
                return fail("a vertex has no quads");
            };
            let inside = border_edges[v] == 0;
            if inside != (vertex.place == Place::Interior) {
                return fail("a vertex is on the border and its place is not, or the reverse");
            }
            if !inside && border_edges[v] != 2 {
                return fail("the border touches itself at a vertex");
            }
            if inside && count[v] < 3 {
                return fail("an interior vertex has fewer than three quads");
            }
            // Clockwise: across the side that leaves the vertex.
            let start = (q, s);
            let mut met = 0;
            while met < count[v] {
                met += 1;
                let edge = &self.edges[self.quad_edges[q][s] as usize];
                let next = edge.quads[usize::from(edge.quads[0] == q as u32)];
                if next == NONE {
                    break;
                }
                q = next as usize;
                s = match self.quads[q].iter().position(|w| *w as usize == v) {
                    Some(s) => s,
                    None => return fail("two quads at a vertex disagree about their edge"),
                };
                if (q, s) == start {
                    break;
                }
            }
            if met != count[v] {
                return fail("the quads at a vertex do not form one fan");
            }
        }
        Ok(())
    }

    /// The border edges of each chain follow one another from its start to its end.
    fn check_chains(&self, boundary: &Boundary) -> Result<(), Defect> {
        let mut pieces: Vec<Vec<(f64, f64, [u32; 2])>> = vec![Vec::new(); boundary.chains.len()];
        for edge in &self.edges {
            if let Some(span) = edge.span {
                pieces[span.chain as usize].push((span.start, span.end, edge.vertices));
            }
        }
        for (chain, own) in boundary.chains.iter().zip(&mut pieces) {
            own.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (Some(first), Some(last)) = (own.first(), own.last()) else {
                return Err(("a chain of the boundary has no edges".into(), chain.point(0.0)));
            };
            for pair in own.windows(2) {
                if pair[0].2[1] != pair[1].2[0] || (pair[0].1 - pair[1].0).abs() > SPAN_GAP {
                    return Err(("a chain's edges have a gap or overlap".into(), chain.point(pair[0].1)));
                }
            }
            let complete = match chain.ends {
                None => last.2[1] == first.2[0] && (last.1 - first.0 - chain.length).abs() <= SPAN_GAP,
                Some(ends) => {
                    let place = |v: u32| self.vertices[v as usize].place;
                    place(first.2[0]) == Place::Junction(ends[0])
                        && place(last.2[1]) == Place::Junction(ends[1])
                        && first.0.abs() <= SPAN_GAP
                        && (last.1 - chain.length).abs() <= SPAN_GAP
                }
            };
            if !complete {
                return Err(("a chain's edges do not cover it".into(), chain.point(first.0)));
            }
        }
        let mut at_junction = vec![0u32; boundary.junctions.len()];
        for vertex in &self.vertices {
            if let Place::Junction(j) = vertex.place {
                at_junction[j as usize] += 1;
            }
        }
        match at_junction.iter().position(|n| *n != 1) {
            Some(j) => Err((format!("junction {j} has not exactly one vertex"), boundary.junctions[j].point)),
            None => Ok(()),
        }
    }

    fn check_euler(&self, boundary: &Boundary) -> Result<(), Defect> {
        let mut reached = vec![false; self.quads.len()];
        let mut stack = vec![0usize];
        reached[0] = true;
        while let Some(q) = stack.pop() {
            for e in self.quad_edges[q] {
                for n in self.edges[e as usize].quads {
                    if n != NONE && !reached[n as usize] {
                        reached[n as usize] = true;
                        stack.push(n as usize);
                    }
                }
            }
        }
        if let Some(q) = reached.iter().position(|r| !r) {
            return Err(("the mesh is in several pieces".into(), self.at(self.quads[q][0])));
        }
        let euler = self.vertices.len() as i64 - self.edges.len() as i64 + self.quads.len() as i64;
        let expected = 2 - boundary.loops.len() as i64;
        if euler != expected {
            return Err((format!("the Euler number is {euler}, not {expected}"), self.at(self.quads[0][0])));
        }
        Ok(())
    }
}
