//! The invariants of the T-mesh and of the conforming layout.

use super::polyline;
use super::{BlockLayout, NodeKind, QuadLayout};
use crate::domain::{Boundary, Place};
use crate::numerics::tolerances::LAYOUT_AREA;
use crate::numerics::{Point, NONE};
use std::collections::BTreeMap;

type Defect = (String, Point);

impl BlockLayout {
    /// Checks that the arcs of every region close up, that every arc has a region on each side (one on the
    /// boundary), Euler's formula V − E + F = 1 − holes, the regions' areas, and the corners at every node.
    /// `Err` tells the first defect and where it is.
    pub fn check(&self, boundary: &Boundary) -> Result<(), Defect> {
        self.check_indices(boundary)?;
        self.check_regions()?;
        self.check_arcs()?;
        self.check_corners()?;
        let at = self.nodes.first().map_or(Point::origin(), |n| n.point);
        let holes = boundary.loops.len() as i64 - 1;
        let euler = self.nodes.len() as i64 - self.arcs.len() as i64 + self.regions.len() as i64;
        if euler != 1 - holes {
            return Err((format!("V - E + F is {euler}, not {}", 1 - holes), at));
        }
        let mut total = 0.0;
        for r in 0..self.regions.len() as u32 {
            let polygon = self.polygon(r);
            let area = polyline::area(&polygon);
            if area < -LAYOUT_AREA * boundary.area {
                return Err((format!("region {r} has area {area:.3e}"), polyline::mean(&polygon)));
            }
            total += area;
        }
        if (total - boundary.area).abs() > LAYOUT_AREA * boundary.area {
            return Err((format!("regions cover {total:.6e} of the area {:.6e}", boundary.area), at));
        }
        Ok(())
    }

    fn check_indices(&self, boundary: &Boundary) -> Result<(), Defect> {
        let n = self.nodes.len();
        for (i, node) in self.nodes.iter().enumerate() {
            let fits = match node.place {
                Place::Interior => matches!(node.kind, NodeKind::Interior | NodeKind::Singularity(_)),
                Place::Boundary(p) => {
                    node.kind == NodeKind::Boundary && (p.chain as usize) < boundary.chains.len()
                }
                Place::Junction(j) => {
                    node.kind == NodeKind::Junction && (j as usize) < boundary.junctions.len()
                }
            };
            if !(fits && node.point.x.is_finite() && node.point.y.is_finite()) {
                return Err((format!("node {i}: its kind and place do not agree"), node.point));
            }
        }
        for (i, arc) in self.arcs.iter().enumerate() {
            if arc.nodes.iter().any(|&v| v as usize >= n) || arc.points.len() < 2 {
                let at = arc.points.first().copied().unwrap_or(Point::origin());
                return Err((format!("arc {i} has no such node, or fewer than two points"), at));
            }
            if arc.span.is_some_and(|s| s.chain as usize >= boundary.chains.len()) {
                return Err((format!("arc {i} has no such chain"), arc.points[0]));
            }
        }
        let bad = |s: &super::SideArc| s.arc as usize >= self.arcs.len();
        match self.regions.iter().position(|r| {
            r.sides.is_empty() || r.sides.iter().any(|side| side.is_empty() || side.iter().any(bad))
        }) {
            Some(r) => Err((format!("region {r} has an empty side or no such arc"), Point::origin())),
            None => Ok(()),
        }
    }

    fn check_regions(&self) -> Result<(), Defect> {
        for (r, region) in self.regions.iter().enumerate() {
            let cycle: Vec<_> = region.sides.iter().flatten().copied().collect();
            for (i, &s) in cycle.iter().enumerate() {
                let next = cycle[(i + 1) % cycle.len()];
                if self.end(s) != self.start(next) {
                    let at = self.nodes[self.end(s) as usize].point;
                    return Err((
                        format!("region {r}: arc {} is not followed by arc {}", s.arc, next.arc),
                        at,
                    ));
                }
            }
        }
        Ok(())
    }

    fn check_arcs(&self) -> Result<(), Defect> {
        let mut uses = vec![[0u8; 2]; self.arcs.len()];
        for s in self.regions.iter().flat_map(|r| &r.sides).flatten() {
            uses[s.arc as usize][s.forward as usize] += 1;
        }
        for (i, (arc, used)) in self.arcs.iter().zip(&uses).enumerate() {
            let wanted = if arc.span.is_some() { [0, 1] } else { [1, 1] };
            if *used != wanted {
                return Err((
                    format!("arc {i} has {} regions to its left and {} to its right", used[1], used[0]),
                    arc.points[arc.points.len() / 2],
                ));
            }
        }
        Ok(())
    }

    /// At an interior node the corners and straight passages fill 360°: at least three corners, a straight
    /// passage counting as two; on the boundary at least two, at a junction one.
    fn check_corners(&self) -> Result<(), Defect> {
        let mut quarters = vec![0u32; self.nodes.len()];
        for side in self.regions.iter().flat_map(|r| &r.sides) {
            for (i, &s) in side.iter().enumerate() {
                quarters[self.start(s) as usize] += if i == 0 { 1 } else { 2 };
            }
        }
        for (i, (node, &q)) in self.nodes.iter().zip(&quarters).enumerate() {
            let least = match node.kind {
                NodeKind::Singularity(_) | NodeKind::Interior => 3,
                NodeKind::Boundary => 2,
                NodeKind::Junction => 1,
            };
            if q < least {
                return Err((format!("node {i} has room for {q} quads only"), node.point));
            }
        }
        Ok(())
    }
}

impl QuadLayout {
    /// Checks that the quads fit together along whole edges, form one fan at every vertex, satisfy Euler's
    /// formula, have 3 to 6 quads at interior vertices, and that the border runs once along
    /// every chain, each loop with at least three edges, through every junction.
    pub fn check(&self, boundary: &Boundary) -> Result<(), Defect> {
        let mut directed: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let mut valence = vec![0u32; self.vertices.len()];
        for (q, quad) in self.quads.iter().enumerate() {
            for i in 0..4 {
                let (a, b) = (quad[i], quad[(i + 1) % 4]);
                let Some(vertex) = self.vertices.get(a as usize) else {
                    return Err((format!("quad {q} has no such vertex"), Point::origin()));
                };
                valence[a as usize] += 1;
                if (0..i).any(|k| quad[k] == a) || directed.insert([a, b], q as u32).is_some() {
                    return Err((
                        format!("quad {q} is degenerate or shares an edge with two others"),
                        vertex.point,
                    ));
                }
            }
        }
        let border: Vec<[u32; 2]> =
            directed.keys().filter(|e| !directed.contains_key(&[e[1], e[0]])).copied().collect();
        let holes = boundary.loops.len() as i64 - 1;
        let edges = (directed.len() + border.len()) as i64 / 2;
        let euler = self.vertices.len() as i64 - edges + self.quads.len() as i64;
        let somewhere = self.vertices.first().map_or(Point::origin(), |v| v.point);
        if euler != 1 - holes {
            return Err((format!("V - E + F is {euler}, not {}", 1 - holes), somewhere));
        }
        self.check_border(boundary, &border)?;
        let mut on_border = vec![0u32; self.vertices.len()];
        border.iter().for_each(|e| on_border[e[0] as usize] += 1);
        for (v, vertex) in self.vertices.iter().enumerate() {
            let inside = vertex.place == Place::Interior;
            if inside != (on_border[v] == 0) || on_border[v] > 1 {
                return Err((format!("vertex {v}: the border passes {} times", on_border[v]), vertex.point));
            }
            let allowed = if inside { 3..=6 } else { 1..=12 };
            if !allowed.contains(&valence[v]) {
                return Err((format!("vertex {v} has {} quads", valence[v]), vertex.point));
            }
            if self.fan(v as u32, &directed) != valence[v] {
                return Err((format!("the quads at vertex {v} form no fan"), vertex.point));
            }
        }
        Ok(())
    }

    /// Vertices whose quads form more than one fan, or inside fewer than 3 or more than 6.
    pub(super) fn spoiled(&self) -> Vec<u32> {
        let mut directed = BTreeMap::new();
        let mut valence = vec![0u32; self.vertices.len()];
        for (q, quad) in self.quads.iter().enumerate() {
            for i in 0..4 {
                directed.insert([quad[i], quad[(i + 1) % 4]], q as u32);
                valence[quad[i] as usize] += 1;
            }
        }
        let spoiled = |&v: &u32| {
            let n = valence[v as usize];
            let inside = self.vertices[v as usize].place == Place::Interior;
            self.fan(v, &directed) != n || (inside && !(3..=6).contains(&n))
        };
        (0..self.vertices.len() as u32).filter(spoiled).collect()
    }

    /// Number of quads in the fan of one quad at `v`, walked counter-clockwise from the border if there is one.
    fn fan(&self, v: u32, directed: &BTreeMap<[u32; 2], u32>) -> u32 {
        let own: Vec<(u32, u32)> = directed.range([v, 0]..=[v, NONE]).map(|(e, &q)| (e[1], q)).collect();
        let before = |q: u32| {
            let quad = self.quads[q as usize];
            let i = quad.iter().position(|&c| c == v).unwrap_or(0);
            quad[(i + 3) % 4]
        };
        let first = own.iter().find(|e| !directed.contains_key(&[e.0, v])).or(own.first());
        let Some(&(start, mut q)) = first else { return 0 };
        let mut n = 1;
        loop {
            let next = before(q);
            match directed.get(&[v, next]) {
                Some(&p) if next != start && n <= own.len() as u32 => {
                    q = p;
                    n += 1;
                }
                _ => return n,
            }
        }
    }

    fn check_border(&self, boundary: &Boundary, border: &[[u32; 2]]) -> Result<(), Defect> {
        let mut covered = vec![0.0; boundary.chains.len()];
        let mut count = vec![0usize; boundary.loops.len()];
        for &[a, b] in border {
            let (from, to) = (&self.vertices[a as usize], &self.vertices[b as usize]);
            let Some(span) = boundary.span(from.place, to.place) else {
                return Err(("a border edge does not follow one boundary chain".into(), from.point));
            };
            covered[span.chain as usize] += span.end - span.start;
            count[boundary.chains[span.chain as usize].loop_index as usize] += 1;
        }
        for (c, chain) in boundary.chains.iter().enumerate() {
            if (covered[c] - chain.length).abs() > 1e-6 * chain.length {
                return Err((format!("chain {c} is not run along exactly once"), chain.point(0.0)));
            }
        }
        match count.iter().position(|&n| n < 3) {
            Some(l) => {
                let at = boundary.chains[boundary.loops[l][0] as usize].point(0.0);
                Err((format!("loop {l} has {} edges", count[l]), at))
            }
            None => Ok(()),
        }
    }
}
