//! Thinning: strips that are much finer inside the domain than wanted end before they cross it.
//!
//! Every boundary edge sends a chord through the domain. Where a boundary asks for many short edges (a
//! coastline), chords run side by side over long distances. Two neighbouring columns of quads can end
//! instead: the three lines of vertices beside them become one, and at either end two quads become one,
//! with a three- and a five-valent vertex. Where chords from a finer boundary crowd on a coarser one, an end may be
//! on the boundary: three of its vertices become one there. The work is on connectivity alone; positions are means,
//! and whoever calls smooths afterwards.
//!
//! The pattern is the "3 : 1" transition of structured coarsening, see R. Schneiders, *Refining quadrilateral and
//! hexahedral element meshes*, 1996.

use crate::domain::{Boundary, Place};
use crate::mesh::{Edge, QuadMesh, Vertex};
use crate::numerics::{Point, Vector, NONE};
use std::collections::HashMap;

/// Mean width of two columns, in wanted sizes, below which they may end.
const TOO_FINE: f64 = 0.4;
/// Fewest rows of vertices that become one: fewer would cost more irregular vertices than quads.
const LEAST_ROWS: usize = 4;
/// The same for a run with an end on the boundary, where there is nothing to pay.
const LEAST_BOUNDARY_ROWS: usize = 2;
/// Fewest edges of a loop that boundary vertices are taken from: a pass leaves at least a third.
const LEAST_LOOP: usize = 15;
/// Most passes; each leaves about a third of the columns.
const PASSES: usize = 6;

/// Ends columns of `mesh` where they are finer than `wanted`, the element size wanted at a point. Interior
/// edges come out straight.
pub fn thin(mesh: QuadMesh, boundary: &Boundary, wanted: &dyn Fn(Point) -> f64) -> QuadMesh {
    let mut mesh = mesh;
    for _ in 0..PASSES {
        let runs = Lines::new(&mesh, boundary, wanted).runs();
        if runs.is_empty() {
            break;
        }
        match without(&mesh, boundary, &runs) {
            Some(thinner) => mesh = thinner,
            None => break,
        }
    }
    mesh
}

/// Consecutive vertices of a line with their neighbours to the left and right; the first and the last row
/// stay unless they are on the boundary, the others become one vertex each.
struct Run {
    rows: Vec<[u32; 3]>,
    /// Quads to the left and right of the line between rows.
    quads: Vec<[u32; 2]>,
    /// Whether the first and the last row become one vertex, too.
    to_boundary: [bool; 2],
}

/// What finding the runs needs.
struct Lines<'a> {
    mesh: &'a QuadMesh,
    wanted: &'a dyn Fn(Point) -> f64,
    valence: Vec<u8>,
    /// Whether a boundary vertex may be taken from its loop; by vertex.
    spare: Vec<bool>,
}

impl<'a> Lines<'a> {
    fn new(mesh: &'a QuadMesh, boundary: &Boundary, wanted: &'a dyn Fn(Point) -> f64) -> Self {
        let mut valence = vec![0u8; mesh.vertices.len()];
        mesh.quads
            .iter()
            .flatten()
            .for_each(|v| valence[*v as usize] = valence[*v as usize].saturating_add(1));
        let loop_of = |e: &Edge| e.span.map(|s| boundary.chains[s.chain as usize].loop_index as usize);
        let mut edges = vec![0; boundary.loops.len()];
        mesh.edges.iter().filter_map(loop_of).for_each(|l| edges[l] += 1);
        let mut spare = vec![false; mesh.vertices.len()];
        for edge in &mesh.edges {
            if loop_of(edge).is_some_and(|l| edges[l] >= LEAST_LOOP) {
                edge.vertices.iter().for_each(|v| spare[*v as usize] = true);
            }
        }
        Lines { mesh, wanted, valence, spare }
    }

    fn regular(&self, v: u32) -> bool {
        self.valence[v as usize] == 4 && self.mesh.vertices[v as usize].place == Place::Interior
    }

    /// Whether a row of boundary vertices may become one: no corner, at most one vertex that has to stay.
    fn spare_row(&self, row: &[u32; 3]) -> bool {
        let junction = |v: &&u32| matches!(self.mesh.vertices[**v as usize].place, Place::Junction(_));
        row.iter().all(|v| self.valence[*v as usize] == 2 && self.spare[*v as usize])
            && row.iter().filter(junction).count() <= 1
    }

    /// The edge of `quad` at `v` that is not `edge`.
    fn other_edge(&self, quad: u32, v: u32, edge: u32) -> u32 {
        let own = self.mesh.quad_edges[quad as usize];
        own.into_iter().find(|e| *e != edge && self.ends(*e).contains(&v)).unwrap_or(NONE)
    }

    fn ends(&self, edge: u32) -> [u32; 2] {
        self.mesh.edges[edge as usize].vertices
    }

    fn other_end(&self, edge: u32, v: u32) -> u32 {
        let [a, b] = self.ends(edge);
        if a == v {
            b
        } else {
            a
        }
    }

    /// Quads to the left and right of an edge, seen in direction from `v`.
    fn sides(&self, edge: u32, v: u32) -> [u32; 2] {
        let own = &self.mesh.edges[edge as usize];
        let [left, right] = own.quads;
        if own.vertices[0] == v {
            [left, right]
        } else {
            [right, left]
        }
    }

    /// The edge straight on from `edge` through the regular vertex `v`.
    fn straight_on(&self, edge: u32, v: u32) -> u32 {
        let quad = self.mesh.edges[edge as usize].quads[0];
        let across = self.other_edge(quad, v, edge);
        let [left, right] = self.mesh.edges[across as usize].quads;
        self.other_edge(if left == quad { right } else { left }, v, across)
    }

    /// All lines as edges in order with the first vertex: from one irregular or boundary vertex to the next.
    fn lines(&self) -> Vec<(u32, Vec<u32>)> {
        let mut seen = vec![false; self.mesh.edges.len()];
        let mut lines = Vec::new();
        for first in 0..self.mesh.edges.len() as u32 {
            if seen[first as usize] || self.mesh.edges[first as usize].span.is_some() {
                continue;
            }
            // Back to the line's beginning, or once around a closed one.
            let (mut edge, mut v) = (first, self.ends(first)[0]);
            while self.regular(v) {
                edge = self.straight_on(edge, v);
                v = self.other_end(edge, v);
                if edge == first {
                    break;
                }
            }
            let start = v;
            let mut line = Vec::new();
            loop {
                if std::mem::replace(&mut seen[edge as usize], true) {
                    break;
                }
                line.push(edge);
                v = self.other_end(edge, v);
                if !self.regular(v) {
                    break;
                }
                edge = self.straight_on(edge, v);
            }
            lines.push((start, line));
        }
        lines
    }

    /// Disjoint runs, the longest first.
    fn runs(&self) -> Vec<Run> {
        let mut runs = Vec::new();
        for (start, line) in self.lines() {
            self.runs_of(start, &line, &mut runs);
        }
        runs.sort_by_key(|r| (std::cmp::Reverse(r.rows.len()), r.rows[0]));
        let mut used = vec![false; self.mesh.vertices.len()];
        runs.retain(|run| {
            let free = run.rows.iter().flatten().all(|v| !used[*v as usize]);
            if free {
                run.rows.iter().flatten().for_each(|v| used[*v as usize] = true);
            }
            free
        });
        runs
    }

    /// The maximal runs of a line whose rows are too fine.
    fn runs_of(&self, start: u32, line: &[u32], runs: &mut Vec<Run>) {
        // Row i is at the line's vertex i, between its edges i - 1 and i; `None` at an irregular vertex.
        let mut rows: Vec<Option<[u32; 3]>> = Vec::with_capacity(line.len() + 1);
        let mut quads: Vec<[u32; 2]> = Vec::with_capacity(line.len());
        let mut v = start;
        let row_at = |edge: u32, sides: [u32; 2], v: u32| {
            let [left, right] = sides.map(|q| self.other_end(self.other_edge(q, v, edge), v));
            let row = [left, v, right];
            let fits = if self.mesh.vertices[v as usize].place == Place::Interior {
                self.regular(v)
            } else {
                self.spare_row(&row)
            };
            fits.then_some(row)
        };
        for edge in line {
            let sides = self.sides(*edge, v);
            rows.push(row_at(*edge, sides, v));
            quads.push(sides);
            v = self.other_end(*edge, v);
            if quads.len() == line.len() {
                rows.push(row_at(*edge, sides, v));
            }
        }
        let interior = |row: &[u32; 3]| self.mesh.vertices[row[1] as usize].place == Place::Interior;
        let on_boundary = |k: usize| rows[k].is_some_and(|row| !interior(&row));
        let stays = |k: usize| rows[k].as_ref().is_some_and(interior);
        let fine = |k: usize| {
            rows[k].is_some_and(|row| {
                let [l, m, r] = row.map(|v| self.mesh.vertices[v as usize].point);
                (on_boundary(k) || row.iter().all(|v| self.regular(*v)))
                    && 0.5 * ((m - l).norm() + (r - m).norm()) < TOO_FINE * (self.wanted)(m)
            })
        };
        let mut k = 0;
        while k < rows.len() {
            if !fine(k) {
                k += 1;
                continue;
            }
            let first = k;
            while k < rows.len() && fine(k) {
                k += 1;
            }
            // A row that stays on either side: the row before where there is one, else the first of the fine
            // ones; none at the boundary.
            let to_boundary = [first == 0 && on_boundary(0), k == rows.len() && on_boundary(k - 1)];
            let low = if first > 0 && stays(first - 1) { first - 1 } else { first };
            let high = if k < rows.len() && stays(k) { k } else { k - 1 };
            let least = if to_boundary.contains(&true) { LEAST_BOUNDARY_ROWS } else { LEAST_ROWS };
            if high - low > least {
                let rows = rows[low..=high].iter().flatten().copied().collect();
                runs.push(Run { rows, quads: quads[low..high].to_vec(), to_boundary });
            }
        }
    }
}

/// The mesh with the runs collapsed; `None` if that is no mesh.
fn without(mesh: &QuadMesh, boundary: &Boundary, runs: &[Run]) -> Option<QuadMesh> {
    let mut becomes: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let mut vertices: Vec<Vertex> = mesh.vertices.clone();
    let mut dropped = vec![false; mesh.quads.len()];
    let mut added = Vec::new();
    for run in runs {
        let last = run.rows.len() - 1;
        let [low, high] = run.to_boundary;
        for (k, row) in run.rows.iter().enumerate() {
            if (k == 0 && !low) || (k == last && !high) {
                continue;
            }
            let mut one = row[1];
            if mesh.vertices[one as usize].place == Place::Interior {
                let sum: Vector = row.iter().map(|v| mesh.vertices[*v as usize].point.coords).sum();
                vertices[one as usize].point = Point::from(sum / 3.0);
            } else {
                let stays = |v: &u32| matches!(mesh.vertices[*v as usize].place, Place::Junction(_));
                one = row.iter().copied().find(stays).unwrap_or(one);
            }
            row.iter().for_each(|v| becomes[*v as usize] = one);
        }
        run.quads.iter().flatten().for_each(|q| dropped[*q as usize] = true);
        let ([a, b, c], [d, e, f]) = (run.rows[0], run.rows[last]);
        let region = |q: u32| mesh.region[q as usize];
        if !low {
            added.push(([a, b, c, becomes[run.rows[1][1] as usize]], region(run.quads[0][0])));
        }
        if !high {
            added.push(([f, e, d, becomes[run.rows[last - 1][1] as usize]], region(run.quads[last - 1][0])));
        }
    }
    let kept = mesh.quads.iter().zip(&mesh.region).zip(&dropped).filter(|(_, dropped)| !**dropped);
    let all = kept.map(|((quad, region), _)| (quad.map(|v| becomes[v as usize]), *region)).chain(added);
    // Vertices are numbered in the order of the old ones.
    let (quads, region): (Vec<[u32; 4]>, Vec<u32>) = all.unzip();
    let mut used = vec![false; vertices.len()];
    quads.iter().flatten().for_each(|v| used[*v as usize] = true);
    let mut number = vec![NONE; vertices.len()];
    let mut left = Vec::new();
    for (v, vertex) in vertices.into_iter().enumerate().filter(|(v, _)| used[*v]) {
        number[v] = left.len() as u32;
        left.push(vertex);
    }
    let quads = quads.into_iter().map(|q| q.map(|v| number[v as usize])).collect();
    QuadMesh::new(boundary, left, quads, region, &HashMap::new()).ok()
}
