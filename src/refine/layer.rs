//! A row of elements along the boundary, as deep as they are long: a sheet that follows the boundary and leaves it
//! only at corners of one element, so that nothing else is divided.
//!
//! ```text
//!    |   |                    y-------+
//!   a'--b'  the row           |       |
//!    |   |                    w'--c'--x'    a corner between two rows
//!    a---b  the boundary      |   |    |
//! ```
//!
//! Such sheets are known as pillowing: S. A. Mitchell, T. J. Tautges, *Pillowing doublets*, 1995.

use super::coons::View;
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::error::{Error, Result};
use crate::mesh::{bubble_shape, part_of_bubbles, QuadMesh, Vertex};
use crate::numerics::{Point, Vector, NONE};
use std::collections::HashMap;

/// Depth of an element of a row, in lengths of its boundary edge: divided in three there, it makes good ones.
const DEPTH: f64 = 2.0 / 3.0;
/// Most of an edge that leaves the boundary, or of one along it at a corner, that a row takes.
const MOST: f64 = 0.4;
/// Interior angle of a corner above which two elements, which a row has at it, are too few.
const WIDEST: f64 = 1.25 * std::f64::consts::PI;

/// The new vertices at a boundary vertex.
#[derive(Clone)]
enum Inner {
    /// No row passes.
    None,
    /// One, so far along the edges that leave the boundary there.
    Within { vertex: u32, share: f64 },
    /// At a wide corner, one on each edge that leaves the boundary there: (edge, vertex, share of the edge).
    Fan { spokes: Vec<(u32, u32, f64)> },
    /// At a corner of one element: of the row that comes in, on the edge that goes out.
    In { vertex: u32, share: f64 },
    /// Of the row that goes out, on the edge that comes in.
    Out { vertex: u32, share: f64 },
    /// Of both rows: on the edges that go out and come in, and inside.
    Both { ahead: u32, behind: u32, inside: u32, shares: [f64; 2] },
}

/// Puts a row along every stretch of boundary, between corners of one element, of whose edges more than `share` are
/// `marked` (one entry an edge). `order` as for [`divide_chords`](super::divide_chords).
///
/// # Errors
/// [`Error::Layout`] when the mesh is defective.
pub fn insert_layer(
    mesh: &QuadMesh,
    boundary: &Boundary,
    marked: &[bool],
    share: f64,
    order: usize,
) -> Result<QuadMesh> {
    let mut layer = Layer::new(mesh, boundary, marked, share, order);
    layer.place_vertices();
    let mut region = Vec::with_capacity(2 * mesh.quads.len());
    for q in 0..mesh.quads.len() {
        layer.divide(q);
        region.resize(layer.quads.len(), mesh.region[q]);
    }
    layer.shape_edges();
    QuadMesh::new(boundary, layer.vertices, layer.quads, region, &layer.shapes)
        .map_err(|(reason, at)| Error::Layout { reason, at: Some(at) })
}

struct Layer<'a> {
    mesh: &'a QuadMesh,
    boundary: &'a Boundary,
    /// Degrees that a new line's shape has.
    count: usize,
    /// The quads at each vertex.
    around: Vec<Vec<u32>>,
    /// The boundary edges that come in and go out at each vertex; `NONE` inside.
    ends: Vec<[u32; 2]>,
    /// Whether a row follows each edge.
    on: Vec<bool>,
    inner: Vec<Inner>,
    vertices: Vec<Vertex>,
    quads: Vec<[u32; 4]>,
    shapes: HashMap<[u32; 2], Vec<Vector>>,
}

impl<'a> Layer<'a> {
    fn new(mesh: &'a QuadMesh, boundary: &'a Boundary, marked: &[bool], share: f64, order: usize) -> Self {
        let mut ends = vec![[NONE; 2]; mesh.vertices.len()];
        for (e, edge) in (0u32..).zip(&mesh.edges).filter(|(_, e)| e.span.is_some()) {
            ends[edge.vertices[0] as usize][1] = e;
            ends[edge.vertices[1] as usize][0] = e;
        }
        let around = mesh.quads_around();
        let mut on = vec![false; mesh.edges.len()];
        let mut seen = on.clone();
        for start in (0..mesh.edges.len()).filter(|e| mesh.edges[*e].span.is_some()) {
            let (mut stretch, mut next) = (Vec::new(), vec![start as u32]);
            while let Some(e) = next.pop() {
                if std::mem::replace(&mut seen[e as usize], true) {
                    continue;
                }
                stretch.push(e);
                let passed =
                    mesh.edges[e as usize].vertices.into_iter().filter(|v| around[*v as usize].len() > 1);
                next.extend(passed.flat_map(|v| ends[v as usize]));
            }
            let many = stretch.iter().filter(|e| marked[**e as usize]).count();
            if many as f64 > share * stretch.len() as f64 {
                stretch.iter().for_each(|e| on[*e as usize] = true);
            }
        }
        Layer {
            mesh,
            boundary,
            count: order.saturating_sub(1),
            around,
            ends,
            on,
            inner: vec![Inner::None; mesh.vertices.len()],
            vertices: mesh.vertices.clone(),
            quads: Vec::with_capacity(2 * mesh.quads.len()),
            shapes: HashMap::new(),
        }
    }

    fn add(&mut self, vertex: Vertex) -> u32 {
        self.vertices.push(vertex);
        self.vertices.len() as u32 - 1
    }

    /// Length of a boundary edge.
    fn length(&self, e: u32) -> f64 {
        self.mesh.edges[e as usize].span.map_or(0.0, |span| span.end - span.start)
    }

    /// The point of an edge at `share` of it from its end `v`.
    fn point_from(&self, e: u32, v: u32, share: f64) -> Point {
        let edge = &self.mesh.edges[e as usize];
        let share = if edge.vertices[0] == v { share } else { 1.0 - share };
        let [a, b] = edge.vertices.map(|v| self.mesh.vertices[v as usize].point);
        a + (b - a) * share + bubble_shape(&edge.bubbles, 2.0 * share - 1.0)
    }

    fn place_vertices(&mut self) {
        let mut fanned = vec![false; self.mesh.quads.len()];
        for v in 0..self.mesh.vertices.len() as u32 {
            let ends = self.ends[v as usize];
            if ends[0] == NONE {
                continue;
            }
            self.inner[v as usize] = match ends.map(|e| self.on[e as usize]) {
                [false, false] => Inner::None,
                _ if self.around[v as usize].len() > 1 => self.within(v, &mut fanned),
                on => self.at_corner(ends, on),
            };
        }
    }

    /// Where more than one element is. `fanned`: quads that lie between spokes of a wide corner already.
    fn within(&mut self, v: u32, fanned: &mut [bool]) -> Inner {
        let (ends, quads) = (self.ends[v as usize], &self.around[v as usize]);
        let sides = |q: &u32| self.mesh.quad_edges[*q as usize];
        let mut spokes: Vec<u32> = quads.iter().flat_map(sides).collect();
        spokes.retain(|e| !ends.contains(e) && self.mesh.edges[*e as usize].vertices.contains(&v));
        spokes.sort_unstable();
        spokes.dedup();
        let reach = |e: &u32| {
            let [a, b] = self.mesh.edges[*e as usize].vertices.map(|v| self.mesh.vertices[v as usize].point);
            (b - a).norm()
        };
        let reaches: Vec<f64> = spokes.iter().map(reach).collect();
        let shortest = reaches.iter().copied().fold(f64::INFINITY, f64::min);
        let depth = (DEPTH * 0.5 * (self.length(ends[0]) + self.length(ends[1]))).min(MOST * shortest);
        let shares = reaches.iter().map(|reach| depth / reach);
        let points: Vec<(u32, f64, Point)> =
            spokes.iter().zip(shares).map(|(e, share)| (*e, share, self.point_from(*e, v, share))).collect();
        let wide = match self.mesh.vertices[v as usize].place {
            Place::Junction(j) => self.boundary.junctions[j as usize].angle > WIDEST,
            _ => false,
        };
        let middle: Vec<u32> =
            quads.iter().copied().filter(|q| !sides(q).iter().any(|e| ends.contains(e))).collect();
        let inside = |point| Vertex { point, place: Place::Interior };
        if wide && !middle.is_empty() && middle.iter().all(|q| !fanned[*q as usize]) {
            middle.iter().for_each(|q| fanned[*q as usize] = true);
            let spokes = points.into_iter().map(|(e, share, point)| (e, self.add(inside(point)), share));
            return Inner::Fan { spokes: spokes.collect() };
        }
        let sum: Vector = points.iter().map(|(_, _, point)| point.coords).sum();
        let vertex = self.add(inside(Point::from(sum / points.len() as f64)));
        Inner::Within { vertex, share: depth / shortest }
    }

    /// Where one element is.
    fn at_corner(&mut self, ends: [u32; 2], on: [bool; 2]) -> Inner {
        let lengths = ends.map(|e| self.length(e));
        let depth = |along: usize| (DEPTH * lengths[along] / lengths[1 - along]).min(MOST);
        match on {
            [true, true] => {
                let both = MOST * lengths[0].min(lengths[1]);
                let shares = lengths.map(|l| both / l);
                let [behind, ahead] =
                    [self.on_edge(ends[0], 1.0 - shares[0]), self.on_edge(ends[1], shares[1])];
                let e = ends[1];
                let quad = self.mesh.edges[e as usize].quads[0] as usize;
                let first = self.mesh.quad_edges[quad].iter().position(|own| *own == e).unwrap_or(0);
                let view = View::new(self.mesh, self.boundary, quad, first);
                let inside = view.point([shares[1], shares[0]]);
                let inside = self.add(Vertex { point: inside, place: Place::Interior });
                Inner::Both { ahead, behind, inside, shares }
            }
            [true, false] => Inner::In { vertex: self.on_edge(ends[1], depth(0)), share: depth(0) },
            _ => Inner::Out { vertex: self.on_edge(ends[0], 1.0 - depth(1)), share: depth(1) },
        }
    }

    /// A new vertex on a boundary edge.
    fn on_edge(&mut self, e: u32, share: f64) -> u32 {
        let Some(span) = self.mesh.edges[e as usize].span else { unreachable!("a boundary edge") };
        let chain = &self.boundary.chains[span.chain as usize];
        let s = chain.wrap(span.start + share * (span.end - span.start));
        let place = Place::Boundary(BoundaryPoint { chain: span.chain, s });
        self.add(Vertex { point: chain.point(s), place })
    }

    /// The new vertex at a wide corner `v` on edge `e`, and how far along it.
    fn spoke(&self, v: u32, e: u32) -> Option<(u32, f64)> {
        let Inner::Fan { spokes } = &self.inner[v as usize] else { return None };
        spokes.iter().find(|s| s.0 == e).map(|s| (s.1, s.2))
    }

    /// What stands in quad `quad` of the old mesh for its corner `k`.
    fn moved(&self, quad: usize, k: usize) -> u32 {
        let v = self.mesh.quads[quad][k];
        match &self.inner[v as usize] {
            Inner::None => v,
            Inner::Within { vertex, .. } | Inner::In { vertex, .. } | Inner::Out { vertex, .. } => *vertex,
            Inner::Both { inside, .. } => *inside,
            Inner::Fan { .. } => {
                let sides = [k, (k + 3) % 4].map(|s| self.mesh.quad_edges[quad][s]);
                sides.iter().find_map(|e| self.spoke(v, *e)).map_or(v, |(vertex, _)| vertex)
            }
        }
    }

    /// The old quad without what rows take of it, and the rows' elements in it.
    fn divide(&mut self, quad: usize) {
        self.shrink(quad);
        for side in 0..4 {
            if self.on[self.mesh.quad_edges[quad][side] as usize] {
                self.row(quad, side);
            }
        }
    }

    /// Between two spokes of a wide corner the quad becomes three.
    fn shrink(&mut self, quad: usize) {
        let (own, sides) = (self.mesh.quads[quad], self.mesh.quad_edges[quad]);
        let corners = [0, 1, 2, 3].map(|k| self.moved(quad, k));
        let fan = |k: &usize| {
            let [to, from] = [*k, (*k + 3) % 4].map(|s| self.spoke(own[*k], sides[s]));
            to.zip(from)
        };
        match (0..4).find_map(|k| fan(&k).map(|found| (k, found))) {
            Some((k, ((p, share), (q, other)))) => {
                let view = View::new(self.mesh, self.boundary, quad, k);
                let at = [share, other];
                let w = self.add(Vertex { point: view.point(at), place: Place::Interior });
                for (from, place) in
                    [(p, [share, 0.0]), (q, [0.0, other]), (corners[(k + 2) % 4], [1.0, 1.0])]
                {
                    self.shapes.insert([from, w], view.shape(place, at, self.count));
                }
                let [b, c, d] = [1, 2, 3].map(|i| corners[(k + i) % 4]);
                self.quads.extend([[own[k], p, w, q], [p, b, c, w], [w, c, d, q]]);
            }
            None => self.quads.push(corners),
        }
    }

    /// The row's element at side `first` of `quad`, and the one at the corner before it that two rows share.
    fn row(&mut self, quad: usize, first: usize) {
        let (next, last) = ((first + 1) % 4, (first + 3) % 4);
        let sides = self.mesh.quad_edges[quad];
        let [a, b] = [first, next].map(|k| self.mesh.quads[quad][k]);
        let ([low_a, high_a], at_a) = match &self.inner[a as usize] {
            Inner::Both { ahead, inside, shares, .. } => ([*ahead, *inside], [shares[1], shares[0]]),
            Inner::Within { vertex, share } | Inner::Out { vertex, share } => ([a, *vertex], [0.0, *share]),
            _ => self.spoke(a, sides[last]).map_or(([a, a], [0.0; 2]), |(v, share)| ([a, v], [0.0, share])),
        };
        let ([low_b, high_b], at_b) = match &self.inner[b as usize] {
            Inner::Both { behind, inside, shares, .. } => ([*behind, *inside], [1.0 - shares[0], shares[1]]),
            Inner::Within { vertex, share } | Inner::In { vertex, share } => ([b, *vertex], [1.0, *share]),
            _ => self.spoke(b, sides[next]).map_or(([b, b], [1.0, 0.0]), |(v, share)| ([b, v], [1.0, share])),
        };
        self.quads.push([low_a, low_b, high_b, high_a]);
        let view = View::new(self.mesh, self.boundary, quad, first);
        self.shapes.insert([high_a, high_b], view.shape(at_a, at_b, self.count));
        if let Inner::Both { ahead, behind, inside, .. } = self.inner[a as usize] {
            self.quads.push([a, ahead, inside, behind]);
            self.shapes.insert([ahead, inside], view.shape([at_a[0], 0.0], at_a, self.count));
            self.shapes.insert([behind, inside], view.shape([0.0, at_a[1]], at_a, self.count));
        }
    }

    /// Edges of the old mesh without what rows take of them.
    fn shape_edges(&mut self) {
        for (e, edge) in (0u32..).zip(&self.mesh.edges).filter(|(_, e)| e.span.is_none()) {
            let taken = |v: u32| match &self.inner[v as usize] {
                Inner::Within { vertex, share } => (*vertex, *share),
                _ => self.spoke(v, e).unwrap_or((v, 0.0)),
            };
            let [(a, from), (b, to)] = edge.vertices.map(taken);
            let (from, to) = (2.0 * from - 1.0, 1.0 - 2.0 * to);
            self.shapes.insert([a, b], part_of_bubbles(&edge.bubbles, from, to));
            for (v, new, [start, end]) in
                [(edge.vertices[0], a, [-1.0, from]), (edge.vertices[1], b, [1.0, to])]
            {
                let straight = matches!(self.inner[v as usize], Inner::Within { .. })
                    && self.around[v as usize].len() > 2;
                if v != new && !straight {
                    self.shapes.insert([v, new], part_of_bubbles(&edge.bubbles, start, end));
                }
            }
        }
    }
}
