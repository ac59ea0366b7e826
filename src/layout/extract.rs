//! From lengths to the conforming layout, or to the demands that the lengths still violate.
//!
//! Points that lengths of 0 let fall together become one vertex, placed where its most constrained member is.
//! What must not fall together (junctions, loops, singularities of equal sign, an edge's two
//! ends, …) yields a [`Demand`]: the arcs on the chain of identifications must have a total of at least 1.

use super::grids::{coons, Grids};
use super::lengths::Lengths;
use super::polyline;
use super::{BlockLayout, LayoutVertex, NodeKind, QuadLayout};
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::numerics::{Point, NONE};
use std::collections::BTreeMap;

/// A lower bound on the total length of some arcs, with the reason in words and its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Demand {
    pub arcs: Vec<u32>,
    pub at_least: u32,
    pub why: &'static str,
    pub at: Point,
}

/// What extraction leads to.
#[derive(Debug, Clone, PartialEq)]
pub enum Extraction {
    /// The layout; all its checks hold.
    Done(QuadLayout),
    /// The lengths have to change.
    Demands(Vec<Demand>),
}

/// Fills the regions of `layout` by grids and stars. `Err`: lengths that do not fit, or a defect for
/// which no arc can be blamed.
pub fn extract(
    layout: &BlockLayout,
    lengths: &Lengths,
    boundary: &Boundary,
    size: &dyn Fn(Point) -> f64,
) -> Result<Extraction, (String, Point)> {
    let grids = Grids::new(layout, lengths, boundary, size)
        .map_err(|r| (format!("lengths do not fit region {r}"), polyline::mean(&layout.polygon(r))))?;
    let (class, classes) = grids.identification.classes();
    let work = Work { layout, lengths, boundary, grids, class, classes };
    let demands = work.forbidden_merges();
    if !demands.is_empty() {
        return Ok(Extraction::Demands(demands));
    }
    let demands = work.forbidden_edges();
    if !demands.is_empty() {
        return Ok(Extraction::Demands(demands));
    }
    let (result, origin) = work.build();
    let demands = work.spoiled_vertices(&result, &origin);
    if !demands.is_empty() {
        return Ok(Extraction::Demands(demands));
    }
    result.check(boundary)?;
    Ok(Extraction::Done(result))
}

/// A quad as it lies in its grid.
struct UnitQuad {
    grid: usize,
    i: usize,
    j: usize,
}

struct Work<'a> {
    layout: &'a BlockLayout,
    lengths: &'a Lengths,
    boundary: &'a Boundary,
    grids: Grids,
    /// Class of each point on nodes and arcs.
    class: Vec<u32>,
    classes: usize,
}

impl Work<'_> {
    fn point(&self, id: u32) -> Point {
        self.grids.points.get(id as usize).map_or(Point::origin(), |p| p.point)
    }

    fn demand(&self, a: u32, b: u32, why: &'static str) -> Option<Demand> {
        let on_arcs = self.grids.on_arcs() as u32;
        if a == b || a >= on_arcs || b >= on_arcs {
            return None;
        }
        let arcs = self.grids.identification.chain(a, b)?;
        (!arcs.is_empty()).then(|| Demand { arcs, at_least: 1, why, at: self.point(a) })
    }

    /// The unit points on the boundary in order: (loop, point), for each loop.
    fn boundary_points(&self) -> Vec<Vec<u32>> {
        let mut loops = vec![Vec::new(); self.boundary.loops.len()];
        for (a, arc) in self.layout.arcs.iter().enumerate() {
            if let Some(span) = arc.span {
                let l = self.boundary.chains[span.chain as usize].loop_index as usize;
                loops[l].extend(self.grids.arc_points(self.layout, self.lengths, a as u32));
            }
        }
        loops
    }

    /// Classes in which points meet that must stay apart.
    fn forbidden_merges(&self) -> Vec<Demand> {
        let mut demands = Vec::new();
        let mut junction = vec![NONE; self.classes];
        let mut singular: Vec<Vec<u32>> = vec![Vec::new(); self.classes];
        for (v, node) in self.layout.nodes.iter().enumerate() {
            let c = self.class[v] as usize;
            match node.kind {
                NodeKind::Junction if junction[c] != NONE => {
                    demands.extend(self.demand(junction[c], v as u32, "two boundary corners would merge"));
                }
                NodeKind::Junction => junction[c] = v as u32,
                NodeKind::Singularity(_) => singular[c].push(v as u32),
                _ => {}
            }
        }
        let loops = self.boundary_points();
        let mut on_border = vec![(NONE, NONE); self.classes];
        for (l, points) in loops.iter().enumerate() {
            for &p in points {
                let c = self.class[p as usize] as usize;
                let (other, q) = on_border[c];
                if other == NONE {
                    on_border[c] = (l as u32, p);
                } else if other != l as u32 {
                    demands.extend(self.demand(q, p, "two boundary loops would touch"));
                }
            }
        }
        demands.extend(self.boundary_pinches());
        for (c, members) in singular.iter().enumerate() {
            let Some(&first) = members.first() else { continue };
            if on_border[c].0 != NONE {
                demands.extend(self.demand(first, on_border[c].1, "a singularity would touch the boundary"));
                continue;
            }
            let sign = |v: u32| match self.layout.nodes[v as usize].kind {
                NodeKind::Singularity(valence) => 4 - valence as i32,
                _ => 0,
            };
            let sum: i32 = members.iter().map(|&v| sign(v)).sum();
            if sum.abs() > 1 {
                let alike: Vec<u32> = members.iter().copied().filter(|&v| sign(v) * sum > 0).collect();
                let pair =
                    if alike.len() > 1 { [alike[0], alike[1]] } else { [first, members[members.len() - 1]] };
                demands.extend(self.demand(pair[0], pair[1], "two singularities of equal sign would merge"));
            }
        }
        demands
    }

    /// Boundary points of one loop that meet though the boundary between them, on both sides, has a length.
    fn boundary_pinches(&self) -> Vec<Demand> {
        // Classes along the boundary only: identified by boundary arcs of length 0.
        let mut along: Vec<u32> = (0..self.grids.on_arcs() as u32).collect();
        fn root(along: &[u32], mut i: u32) -> u32 {
            while along[i as usize] != i {
                i = along[i as usize];
            }
            i
        }
        for (a, arc) in self.layout.arcs.iter().enumerate() {
            if arc.span.is_some() && self.lengths.arcs[a] == 0 {
                let (x, y) = (root(&along, arc.nodes[0]), root(&along, arc.nodes[1]));
                along[x.max(y) as usize] = x.min(y);
            }
        }
        let mut seen = vec![NONE; self.classes];
        let mut demands = Vec::new();
        for points in self.boundary_points() {
            for p in points {
                let c = self.class[p as usize] as usize;
                if seen[c] == NONE {
                    seen[c] = p;
                } else if root(&along, seen[c]) != root(&along, p) {
                    demands.extend(self.demand(seen[c], p, "the boundary would touch itself"));
                }
            }
        }
        demands
    }

    fn vertex(&self, id: u32) -> u32 {
        let on_arcs = self.grids.on_arcs() as u32;
        if id < on_arcs {
            self.class[id as usize]
        } else {
            self.classes as u32 + id - on_arcs
        }
    }

    fn unit_quads(&self) -> impl Iterator<Item = (UnitQuad, [u32; 4])> + '_ {
        self.grids.grids.iter().enumerate().flat_map(|(g, grid)| {
            (0..grid.h).flat_map(move |j| {
                (0..grid.w).map(move |i| {
                    let ids = [grid.at(i, j), grid.at(i + 1, j), grid.at(i + 1, j + 1), grid.at(i, j + 1)];
                    (UnitQuad { grid: g, i, j }, ids)
                })
            })
        })
    }

    /// Lengthens the strip of quads that crosses edge `e` of a quad by one.
    fn wider(&self, quad: &UnitQuad, e: usize, why: &'static str, at: Point) -> Demand {
        let grid = &self.grids.grids[quad.grid];
        let arc = if e % 2 == 0 { grid.arcs[0][quad.i] } else { grid.arcs[1][quad.j] };
        Demand { arcs: vec![arc], at_least: self.lengths.arcs[arc as usize] + 1, why, at }
    }

    /// Quads whose corners meet, and edges that too many quads share.
    fn forbidden_edges(&self) -> Vec<Demand> {
        let mut demands = Vec::new();
        let mut directed: BTreeMap<[u32; 2], [u32; 2]> = BTreeMap::new();
        for (quad, ids) in self.unit_quads() {
            let corners = ids.map(|id| self.vertex(id));
            for e in 0..4 {
                for f in 0..e {
                    if corners[e] == corners[f] {
                        let why = "a quad's corners would merge";
                        let demand = self.demand(ids[e], ids[f], why);
                        demands
                            .extend(demand.or_else(|| Some(self.wider(&quad, f, why, self.point(ids[f])))));
                    }
                }
            }
            for e in 0..4 {
                let [a, b] = [e, (e + 1) % 4];
                let own = [ids[a], ids[b]];
                if let Some(other) = directed.insert([corners[a], corners[b]], own) {
                    let why = "two edges would join the same vertices";
                    let demand = (0..2).find_map(|k| self.demand(own[k], other[k], why));
                    demands.extend(demand.or_else(|| Some(self.wider(&quad, e, why, self.point(own[0])))));
                }
            }
            // A few at a time: one demand often cures several defects.
            if demands.len() > 8 {
                break;
            }
        }
        demands
    }

    /// Vertices, quads, and for each vertex the points it comes from.
    fn build(&self) -> (QuadLayout, Vec<Vec<u32>>) {
        let on_arcs = self.grids.on_arcs();
        let mut members: Vec<Vec<u32>> = vec![Vec::new(); self.classes];
        for (i, &c) in self.class.iter().enumerate() {
            members[c as usize].push(i as u32);
        }
        let placed: Vec<LayoutVertex> = members.iter().map(|m| self.placed(m)).collect();
        // Positions by point, so that grids can be interpolated from their borders.
        let last = self.grids.grids.iter().flat_map(|g| &g.ids).max().map_or(0, |&m| m as usize + 1);
        let mut position = vec![Point::origin(); last.max(on_arcs)];
        for (i, &c) in self.class.iter().enumerate() {
            position[i] = placed[c as usize].point;
        }
        self.grids.stars.iter().for_each(|star| star.lay_out(&mut position));
        for grid in &self.grids.grids {
            coons(grid, &mut position);
        }
        // Vertices are numbered as the quads meet them.
        let mut number: BTreeMap<u32, u32> = BTreeMap::new();
        let mut result = QuadLayout::default();
        let mut origin = Vec::new();
        for (quad, ids) in self.unit_quads() {
            let corners = ids.map(|id| {
                let v = self.vertex(id);
                *number.entry(v).or_insert_with(|| {
                    if (v as usize) < self.classes {
                        result.vertices.push(placed[v as usize]);
                        origin.push(members[v as usize].clone());
                    } else {
                        let point = position[id as usize];
                        result.vertices.push(LayoutVertex { point, place: Place::Interior });
                        origin.push(vec![id]);
                    }
                    result.vertices.len() as u32 - 1
                })
            });
            result.quads.push(corners);
            result.region.push(self.grids.grids[quad.grid].region);
        }
        (result, origin)
    }

    /// Place and point of a class: that of a junction, else on the boundary, else at a singularity, else
    /// at the mean of its nodes or points.
    fn placed(&self, members: &[u32]) -> LayoutVertex {
        let points = &self.grids.points;
        let nodes = &self.layout.nodes;
        let at = |id: u32| &points[id as usize];
        if let Some(&j) = members.iter().find(|&&m| matches!(at(m).place, Place::Junction(_))) {
            return LayoutVertex { point: at(j).point, place: at(j).place };
        }
        let border: Vec<BoundaryPoint> = members
            .iter()
            .filter_map(|&m| match at(m).place {
                Place::Boundary(p) => Some(p),
                _ => None,
            })
            .collect();
        if let Some(&first) = border.first() {
            // The middle of the arc-length interval that merged, over the seam if need be.
            let chain = &self.boundary.chains[first.chain as usize];
            let offset = |p: &BoundaryPoint| {
                let d = p.s - first.s;
                let closed = chain.ends.is_none() && p.chain == first.chain;
                if closed {
                    d - chain.length * (d / chain.length).round()
                } else {
                    d
                }
            };
            let (low, high) =
                border.iter().map(offset).fold((0.0, 0.0), |(l, h), d| (f64::min(l, d), f64::max(h, d)));
            let s = chain.wrap(first.s + (low + high) / 2.0);
            let place = Place::Boundary(BoundaryPoint { chain: first.chain, s });
            return LayoutVertex { point: chain.point(s), place };
        }
        let singular =
            |m: &&u32| nodes.get(**m as usize).is_some_and(|n| matches!(n.kind, NodeKind::Singularity(_)));
        let node = |m: &&u32| (**m as usize) < nodes.len();
        let mut chosen: Vec<u32> = members.iter().filter(singular).copied().collect();
        if chosen.is_empty() {
            chosen = members.iter().filter(node).copied().collect();
        }
        if chosen.is_empty() {
            chosen = members.to_vec();
        }
        let point = polyline::mean(chosen.iter().map(|&m| &at(m).point));
        LayoutVertex { point, place: Place::Interior }
    }

    /// Vertices whose quads form more than one fan, or are too few or too many: what merged in them must part,
    /// singularities first.
    fn spoiled_vertices(&self, result: &QuadLayout, origin: &[Vec<u32>]) -> Vec<Demand> {
        let regular = |&m: &u32| {
            let node = self.layout.nodes.get(m as usize);
            !node.is_some_and(|n| matches!(n.kind, NodeKind::Singularity(_)))
        };
        let mut demands = Vec::new();
        for v in result.spoiled() {
            let mut members = origin[v as usize].clone();
            members.sort_by_key(regular);
            let why = "a vertex would have no single fan of 3 to 6 quads";
            demands.extend(members[1..].iter().find_map(|&m| self.demand(members[0], m, why)));
        }
        demands
    }
}
