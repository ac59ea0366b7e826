//! Boundary vertices moved to the joints and knots of their chains.
//!
//! An edge over a point where the curve is less smooth has high modes that fall only algebraically: however well it
//! keeps the tolerance, solutions see them. With an element's vertex at that point both edges are as smooth as their
//! curves, and the modes fall geometrically.

use crate::domain::{Boundary, BoundaryPoint, Chain, Place};
use crate::mesh::{Edge, QuadMesh, Vertex};

/// Least and most length of an edge afterwards, relative to what it was.
const STRETCH: [f64; 2] = [0.4, 1.8];

/// A vertex that can go to a break.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToBreak {
    pub vertex: u32,
    /// Its number along the chain.
    index: usize,
    /// Arc length of the break.
    pub s: f64,
}

/// What a move changed, to be undone.
#[derive(Debug, Default)]
pub struct Undo {
    vertices: Vec<(u32, Vertex)>,
    edges: Vec<(u32, Edge)>,
}

impl Undo {
    /// The mesh as it was before the move.
    pub fn undo(self, mesh: &mut QuadMesh) {
        self.vertices.into_iter().for_each(|(v, vertex)| mesh.vertices[v as usize] = vertex);
        self.edges.into_iter().for_each(|(e, edge)| mesh.edges[e as usize] = edge);
    }
}

/// The vertices along one chain.
pub struct OnChain<'a> {
    boundary: &'a Boundary,
    chain: u32,
    curve: &'a Chain,
    /// The edges in order, their first vertices, and where these are.
    edges: Vec<u32>,
    vertices: Vec<u32>,
    at: Vec<f64>,
}

impl<'a> OnChain<'a> {
    /// Those of every chain whose curve has breaks.
    pub fn with_breaks(mesh: &QuadMesh, boundary: &'a Boundary) -> Vec<Self> {
        let mut edges: Vec<(u32, f64, u32)> = Vec::new();
        for (e, edge) in (0u32..).zip(&mesh.edges) {
            if let Some(span) = edge.span.filter(|s| !boundary.chains[s.chain as usize].breaks.is_empty()) {
                edges.push((span.chain, boundary.chains[span.chain as usize].wrap(span.start), e));
            }
        }
        edges.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let of_chain = |own: &[(u32, f64, u32)]| OnChain {
            boundary,
            chain: own[0].0,
            curve: &boundary.chains[own[0].0 as usize],
            edges: own.iter().map(|e| e.2).collect(),
            vertices: own.iter().map(|e| mesh.edges[e.2 as usize].vertices[0]).collect(),
            at: own.iter().map(|e| e.1).collect(),
        };
        edges.chunk_by(|a, b| a.0 == b.0).map(of_chain).collect()
    }

    fn closed(&self) -> bool {
        self.curve.ends.is_none()
    }

    /// Signed way from one arc length to another, the shorter one round a closed chain.
    fn way(&self, from: f64, to: f64) -> f64 {
        let way = to - from;
        if self.closed() {
            way - (way / self.curve.length).round() * self.curve.length
        } else {
            way
        }
    }

    /// Where edge `i` ends.
    fn end(&self, i: usize) -> f64 {
        match (self.at.get(i + 1), self.closed()) {
            (Some(next), _) => *next,
            (None, true) => self.at[0] + self.curve.length,
            (None, false) => self.curve.length,
        }
    }

    /// The vertices, in order along the chain; an open chain's last one is not among them.
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }

    /// Takes over that `chosen` is on its break.
    pub fn accept(&mut self, chosen: ToBreak) {
        // Round the seam it stays in order, whatever the break's own arc length.
        self.at[chosen.index] += self.way(self.at[chosen.index], chosen.s);
    }

    /// Vertices and breaks that are nearest to each other.
    pub fn candidates(&self) -> Vec<ToBreak> {
        let length = self.curve.length;
        let seam = self.closed().then_some(0.0);
        let inside = self.curve.breaks.iter().copied().filter(|b| *b < length);
        let breaks: Vec<f64> = seam.into_iter().chain(inside).collect();
        let count = self.at.len();
        // Both lists ascend: a nearest one is beside where the other would be put, or at an end of the list.
        let nearest = |list: &[f64], s: f64| -> Option<usize> {
            let i = list.partition_point(|x| *x < s);
            let near = [i.checked_sub(1), Some(i), Some(0), list.len().checked_sub(1)];
            let near = near.into_iter().flatten().filter(|k| *k < list.len());
            near.min_by(|a, b| self.way(s, list[*a]).abs().total_cmp(&self.way(s, list[*b]).abs()))
        };
        let candidate = |i: usize| {
            let own = breaks[nearest(&breaks, self.at[i])?];
            let by = self.way(self.at[i], own).abs();
            (by > 0.0 && nearest(&self.at, own)? == i).then_some(ToBreak {
                vertex: self.vertices[i],
                index: i,
                s: own,
            })
        };
        (usize::from(!self.closed())..count).filter_map(candidate).collect()
    }

    /// Puts all `chosen` on their breaks, and the vertices between them in proportion. `None`, and nothing done, where
    /// an edge would become too short or too long.
    pub fn move_all(&self, mesh: &mut QuadMesh, chosen: &[ToBreak]) -> Option<Undo> {
        let count = self.at.len();
        let mut to = vec![None; count];
        chosen.iter().for_each(|c| to[c.index] = Some(c.s));
        // (arc length, way) of what is known, between which ways are linear.
        let known = |i: usize| to[i].map(|s| (self.at[i], self.way(self.at[i], s)));
        let mut fixed: Vec<(f64, f64)> = (0..count).filter_map(known).collect();
        let (first, last) = (*fixed.first()?, *fixed.last()?);
        let length = self.curve.length;
        if self.closed() {
            fixed.insert(0, (last.0 - length, last.1));
            fixed.push((first.0 + length, first.1));
        } else {
            fixed.insert(0, (0.0, 0.0));
            fixed.push((length, 0.0));
        }
        let way = |s: f64| {
            let k = fixed.partition_point(|e| e.0 <= s).clamp(1, fixed.len() - 1);
            let (a, b) = (fixed[k - 1], fixed[k]);
            a.1 + (b.1 - a.1) * ((s - a.0) / (b.0 - a.0))
        };
        let ways: Vec<f64> = self.at.iter().map(|s| way(*s)).collect();
        let way_after = |i: usize| match ways.get(i + 1) {
            Some(next) => *next,
            None if self.closed() => ways[0],
            None => 0.0,
        };
        if !(0..count).all(|i| self.may_grow(i, way_after(i) - ways[i])) {
            return None;
        }
        let mut undo = Undo::default();
        for i in 0..count {
            let s = to[i].unwrap_or_else(|| self.curve.wrap(self.at[i] + ways[i]));
            self.place(mesh, i, s, &mut undo);
        }
        (0..count).for_each(|i| self.follow(mesh, i, &mut undo));
        Some(undo)
    }

    /// The same for one vertex, all others where they are.
    pub fn move_one(&self, mesh: &mut QuadMesh, chosen: ToBreak) -> Option<Undo> {
        let i = chosen.index;
        let before = (i + self.at.len() - 1) % self.at.len();
        let way = self.way(self.at[i], chosen.s);
        if before == i || !self.may_grow(before, way) || !self.may_grow(i, -way) {
            return None;
        }
        let mut undo = Undo::default();
        self.place(mesh, i, chosen.s, &mut undo);
        [before, i].into_iter().for_each(|e| self.follow(mesh, e, &mut undo));
        Some(undo)
    }

    /// Whether edge `i` may be longer by `more`.
    fn may_grow(&self, i: usize, more: f64) -> bool {
        let old = self.end(i) - self.at[i];
        (STRETCH[0]..=STRETCH[1]).contains(&((old + more) / old))
    }

    /// Puts vertex `i` to arc length `s`; junctions stay.
    fn place(&self, mesh: &mut QuadMesh, i: usize, s: f64, undo: &mut Undo) {
        let vertex = &mut mesh.vertices[self.vertices[i] as usize];
        if matches!(vertex.place, Place::Boundary(p) if p.s != s) {
            undo.vertices.push((self.vertices[i], *vertex));
            let place = Place::Boundary(BoundaryPoint { chain: self.chain, s });
            *vertex = Vertex { point: self.curve.point(s), place };
        }
    }

    /// Makes edge `i` end where its vertices are.
    fn follow(&self, mesh: &mut QuadMesh, i: usize, undo: &mut Undo) {
        let edge = &mut mesh.edges[self.edges[i] as usize];
        let [a, b] = edge.vertices.map(|v| mesh.vertices[v as usize].place);
        let span = self.boundary.span(a, b);
        if span != edge.span {
            undo.edges.push((self.edges[i], edge.clone()));
            edge.span = span;
        }
    }
}
