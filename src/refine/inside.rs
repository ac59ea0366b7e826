//! Boundary edges divided in three inside their elements: no new line leaves an element, so that the mesh grows with
//! the number of its boundary edges and not with lines through the domain.
//!
//! ```text
//!   d-------c     d-------c      d---p'--q'--c
//!   |\     /|     | `n'  /|      |   |   |   |
//!   | r---s |    q2--'| / |      |   |   |   |
//!   | |   | |     |   |/  |      |   |   |   |
//!   | |   | |    q1---m-n |      |   |   |   |
//!   a-p---q-b     a--p1-p2-b     a---p---q---b
//! ```
//!
//! One side, two sides at a corner, two opposite ones (four: a grid). New lines follow the Coons map of the element.
//! Such templates are known from R. Schneiders, *Refining quadrilateral and hexahedral element meshes*, 1996.

use super::coons::View;
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::error::{Error, Result};
use crate::mesh::{QuadMesh, Vertex};
use crate::numerics::Vector;
use std::collections::HashMap;

/// Where the row of new vertices over a divided side lies in its element.
const ROW: f64 = 0.5;
/// How far the two new vertices beside the one over a divided corner lie from its rows, towards the far corner.
const LEAN: f64 = 0.15;

/// A vertex and its place in the element's unit square.
type Knot = (u32, [f64; 2]);

/// Divides every boundary edge for which `cuts` (one entry an edge) gives two arc lengths, ascending and within its
/// span, at them. Where an element has three such sides one of them stays for the next time. `order` as for
/// [`divide_chords`](super::divide_chords).
///
/// # Errors
/// [`Error::Layout`] when the mesh is defective.
pub fn divide_inside(
    mesh: &QuadMesh,
    boundary: &Boundary,
    cuts: &[Option<[f64; 2]>],
    order: usize,
) -> Result<QuadMesh> {
    let mut division = Division {
        mesh,
        boundary,
        cuts,
        count: order.saturating_sub(1),
        vertices: mesh.vertices.clone(),
        quads: Vec::with_capacity(mesh.quads.len()),
        shapes: mesh.edges.iter().map(|e| (e.vertices, e.bubbles.clone())).collect(),
    };
    let mut region = Vec::with_capacity(mesh.quads.len());
    for q in 0..mesh.quads.len() {
        division.divide(q);
        region.resize(division.quads.len(), mesh.region[q]);
    }
    let Division { vertices, quads, shapes, .. } = division;
    QuadMesh::new(boundary, vertices, quads, region, &shapes)
        .map_err(|(reason, at)| Error::Layout { reason, at: Some(at) })
}

struct Division<'a> {
    mesh: &'a QuadMesh,
    boundary: &'a Boundary,
    cuts: &'a [Option<[f64; 2]>],
    /// Degrees that a new line's shape has.
    count: usize,
    vertices: Vec<Vertex>,
    quads: Vec<[u32; 4]>,
    shapes: HashMap<[u32; 2], Vec<Vector>>,
}

impl Division<'_> {
    fn divide(&mut self, quad: usize) {
        let (mesh, boundary) = (self.mesh, self.boundary);
        let on_boundary = |e: u32| mesh.edges[e as usize].span.is_some();
        let cut = mesh.quad_edges[quad].map(|e| on_boundary(e) && self.cuts[e as usize].is_some());
        if !cut.contains(&true) {
            self.quads.push(mesh.quads[quad]);
            return;
        }
        let view = |first: usize| View::new(mesh, boundary, quad, first);
        match cut {
            [true, true, true, true] => self.grid(&view(0), true),
            [true, _, true, _] => self.grid(&view(0), false),
            [_, true, _, true] => self.grid(&view(1), false),
            _ => match (0..4).find(|k| cut[*k] && cut[(*k + 3) % 4]) {
                Some(corner) => self.corner(&view(corner)),
                None => self.side(&view(cut.iter().position(|c| *c).unwrap_or(0))),
            },
        }
    }

    /// The corners of a view.
    fn corners(&self, view: &View) -> [Knot; 4] {
        let at = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        [0, 1, 2, 3].map(|k| (self.mesh.quads[view.quad][(view.first + k) % 4], at[k]))
    }

    /// The two new vertices on side `s` of a view, in the direction of the loop.
    fn cut(&mut self, view: &View, s: usize) -> [Knot; 2] {
        let e = self.mesh.quad_edges[view.quad][(view.first + s) % 4] as usize;
        let (Some(span), Some(ends)) = (self.mesh.edges[e].span, self.cuts[e]) else {
            unreachable!("only boundary edges are cut")
        };
        let chain = &self.boundary.chains[span.chain as usize];
        ends.map(|end| {
            let s_on_chain = chain.wrap(end);
            let place = Place::Boundary(BoundaryPoint { chain: span.chain, s: s_on_chain });
            let share = (end - span.start) / (span.end - span.start);
            let at = [[share, 0.0], [1.0, share], [1.0 - share, 1.0], [0.0, 1.0 - share]][s];
            (self.add(Vertex { point: chain.point(s_on_chain), place }), at)
        })
    }

    fn add(&mut self, vertex: Vertex) -> u32 {
        self.vertices.push(vertex);
        self.vertices.len() as u32 - 1
    }

    fn inner(&mut self, view: &View, at: [f64; 2]) -> Knot {
        (self.add(Vertex { point: view.point(at), place: Place::Interior }), at)
    }

    /// A line of the element's map between two vertices.
    fn line(&mut self, view: &View, [from, to]: [Knot; 2]) {
        let shape = view.shape(from.1, to.1, self.count);
        self.shapes.insert([from.0, to.0], shape);
    }

    fn push(&mut self, quads: &[[Knot; 4]]) {
        self.quads.extend(quads.iter().map(|quad| quad.map(|k| k.0)));
    }

    fn side(&mut self, view: &View) {
        let [a, b, c, d] = self.corners(view);
        let [p, q] = self.cut(view, 0);
        let [r, s] = [p, q].map(|k| self.inner(view, [k.1[0], ROW]));
        for line in [[p, r], [q, s], [r, s], [d, r], [c, s]] {
            self.line(view, line);
        }
        self.push(&[[a, p, r, d], [p, q, s, r], [q, b, c, s], [r, s, c, d]]);
    }

    fn corner(&mut self, view: &View) {
        let [a, b, c, d] = self.corners(view);
        let [p1, p2] = self.cut(view, 0);
        let [q2, q1] = self.cut(view, 3);
        let (u, v) = ([p1, p2].map(|k| k.1[0]), [q1, q2].map(|k| k.1[1]));
        let m = self.inner(view, [u[0], v[0]]);
        let n = self.inner(view, [u[1], v[0] + LEAN * (1.0 - v[0])]);
        let o = self.inner(view, [u[0] + LEAN * (1.0 - u[0]), v[1]]);
        for line in [[p1, m], [q1, m], [p2, n], [m, n], [n, c], [m, o], [q2, o], [o, c]] {
            self.line(view, line);
        }
        self.push(&[[a, p1, m, q1], [p1, p2, n, m], [p2, b, c, n]]);
        self.push(&[[q1, m, o, q2], [q2, o, c, d], [m, n, c, o]]);
    }

    /// Lines from side to side, `both` ways or from side 0 to side 2.
    fn grid(&mut self, view: &View, both: bool) {
        let [a, b, c, d] = self.corners(view);
        let [p, q] = self.cut(view, 0);
        let [q2, p2] = self.cut(view, 2);
        let mut rows = vec![[a, p, q, b]];
        if both {
            let ([low, high], [high_left, low_left]) = (self.cut(view, 1), self.cut(view, 3));
            for (left, right) in [(low_left, low), (high_left, high)] {
                let between = [(p, p2), (q, q2)].map(|(below, above)| {
                    let v = 0.5 * (left.1[1] + right.1[1]);
                    self.inner(view, [below.1[0] * (1.0 - v) + above.1[0] * v, v])
                });
                rows.push([left, between[0], between[1], right]);
            }
        }
        rows.push([d, p2, q2, c]);
        for row in &rows[1..rows.len() - 1] {
            row.windows(2).for_each(|pair| self.line(view, [pair[0], pair[1]]));
        }
        for pair in rows.windows(2) {
            (1..3).for_each(|i| self.line(view, [pair[0][i], pair[1][i]]));
            for i in 0..3 {
                self.push(&[[pair[0][i], pair[0][i + 1], pair[1][i + 1], pair[1][i]]]);
            }
        }
    }
}
