//! Merging vertices: the topology of chord removal and of diagonal collapse, with what forbids it.

use super::live::{LiveMesh, Removal};
use super::valence::{ideal_valence, irregularity};
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::mesh::{reversed_bubbles, Vertex};
use crate::numerics::{Point, Vector};
use std::collections::BTreeMap;

/// A quad with other corners than before.
#[derive(Debug, Clone, Copy)]
struct Changed {
    corners: [u32; 4],
    /// The edge of the old mesh that each side comes from.
    sides: [u32; 4],
}

/// A mesh with some vertices merged, as differences from the mesh before. Everything keeps its number;
/// of merged vertices the least stays.
#[derive(Debug, Clone)]
pub(super) struct Merge<'a> {
    pub live: &'a LiveMesh,
    parent: BTreeMap<u32, u32>,
    vertices: BTreeMap<u32, Vertex>,
    /// `None`: gone.
    quads: BTreeMap<u32, Option<Changed>>,
    stars: BTreeMap<u32, Vec<u32>>,
    /// The chain of each boundary edge that vanishes.
    lost: Vec<u32>,
    /// Vertices that came out of a merge or lost a quad, ascending.
    pub touched: Vec<u32>,
    /// Number of quads that go.
    pub removed: usize,
    /// Growth of Σ (valence − ideal)².
    pub irregularity: isize,
}

/// Why a merge is impossible.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Refusal {
    /// Two junctions, two loops, or boundary vertices across the domain would be one.
    Pinch,
    /// A chain has no edge to spare.
    Tolerance,
    /// A vertex would have too few or too many quads.
    Valence,
    /// What is left is not a mesh.
    Topology,
}

/// Largest valence inside, and at a smooth boundary vertex.
const MOST_INSIDE: usize = 6;
const MOST_SMOOTH: usize = 3;

/// What the members of a merged group are.
#[derive(Debug, Clone, Default)]
struct Group {
    members: Vec<u32>,
    boundary_rungs: usize,
}

impl<'a> Merge<'a> {
    /// Merges the ends of the edges or diagonals `pairs` (`bool`: the pair is a boundary edge) and drops the
    /// quads `dropped`. `least[chain]` is how many edges the chain has to keep.
    pub fn new(
        boundary: &Boundary,
        live: &'a LiveMesh,
        pairs: &[([u32; 2], bool)],
        dropped: &[u32],
        least: &[usize],
    ) -> Result<Self, Refusal> {
        let mut merge = Merge {
            live,
            parent: BTreeMap::new(),
            vertices: BTreeMap::new(),
            quads: dropped.iter().map(|q| (*q, None)).collect(),
            stars: BTreeMap::new(),
            lost: Vec::new(),
            touched: Vec::new(),
            removed: 0,
            irregularity: 0,
        };
        for ([a, b], _) in pairs {
            let (a, b) = (merge.root(*a), merge.root(*b));
            if a != b {
                merge.parent.insert(a.max(b), a.min(b));
            }
        }
        let mut groups: BTreeMap<u32, Group> = BTreeMap::new();
        for ([a, b], on_boundary) in pairs {
            let group = groups.entry(merge.root(*a)).or_default();
            group.boundary_rungs += usize::from(*on_boundary);
            group.members.extend([*a, *b]);
        }
        for (root, group) in &mut groups {
            group.members.sort_unstable();
            group.members.dedup();
            let (vertex, chains) = merged(boundary, live, group)?;
            merge.lost.extend(chains);
            merge.vertices.insert(*root, vertex);
        }
        merge.lost.sort_unstable();
        for chain in merge.lost.chunk_by(|a, b| a == b) {
            let c = chain[0] as usize;
            if live.boundary_edges[c] < least[c] + chain.len() {
                return Err(Refusal::Tolerance);
            }
        }
        merge.move_quads(&groups, dropped)?;
        merge.remove_doublets()?;
        merge.touched.sort_unstable();
        merge.touched.dedup();
        let mut before: Vec<u32> = groups.values().flat_map(|g| g.members.iter().copied()).collect();
        before.extend(&merge.touched);
        before.sort_unstable();
        before.dedup();
        let then: usize = before
            .iter()
            .map(|v| irregularity(boundary, live.mesh.vertices[*v as usize].place, live.valence(*v)))
            .sum();
        let mut touched = std::mem::take(&mut merge.touched);
        touched.retain(|v| !merge.star(*v).is_empty());
        let mut now = 0;
        for v in &touched {
            let (place, valence) = (merge.vertex(*v).place, merge.star(*v).len());
            let members = groups.get(v).map_or(std::slice::from_ref(v), |g| &g.members[..]);
            if !allowed(boundary, live, place, valence, members) {
                return Err(Refusal::Valence);
            }
            now += irregularity(boundary, place, valence);
        }
        for v in &touched {
            merge.check_fan(boundary, *v)?;
        }
        merge.irregularity = now as isize - then as isize;
        merge.touched = touched;
        merge.removed = merge.quads.values().filter(|q| q.is_none()).count();
        Ok(merge)
    }

    /// The vertex that `v` is now.
    pub fn root(&self, mut v: u32) -> u32 {
        while let Some(p) = self.parent.get(&v) {
            v = *p;
        }
        v
    }

    pub fn star(&self, v: u32) -> &[u32] {
        self.stars.get(&v).map_or_else(|| self.live.star(v), Vec::as_slice)
    }

    pub fn corners(&self, q: u32) -> [u32; 4] {
        match self.quads.get(&q) {
            Some(Some(changed)) => changed.corners,
            _ => self.live.mesh.quads[q as usize],
        }
    }

    /// The edges of the old mesh that the sides of quad `q` come from.
    pub fn sides(&self, q: u32) -> [u32; 4] {
        match self.quads.get(&q) {
            Some(Some(changed)) => changed.sides,
            _ => self.live.mesh.quad_edges[q as usize],
        }
    }

    pub fn vertex(&self, v: u32) -> Vertex {
        self.vertices.get(&v).copied().unwrap_or(self.live.mesh.vertices[v as usize])
    }

    /// Moves vertex `v` of the merged mesh.
    pub fn set_vertex(&mut self, v: u32, vertex: Vertex) {
        self.vertices.insert(v, vertex);
    }

    /// Bubbles of the old edge `e`, read from the vertex that is now `from`.
    pub fn bubbles(&self, e: u32, from: u32) -> Vec<Vector> {
        let edge = &self.live.mesh.edges[e as usize];
        if self.root(edge.vertices[0]) == from {
            edge.bubbles.clone()
        } else {
            reversed_bubbles(&edge.bubbles)
        }
    }

    /// What goes.
    pub fn into_removal(self) -> Removal {
        Removal {
            quads: self.quads.iter().filter(|(_, new)| new.is_none()).map(|(q, _)| *q).collect(),
            stars: self.stars.into_iter().collect(),
            chains: self.lost,
        }
    }

    /// New corners of the quads at merged vertices, and the stars.
    fn move_quads(&mut self, groups: &BTreeMap<u32, Group>, dropped: &[u32]) -> Result<(), Refusal> {
        let live = self.live;
        self.touched.extend(groups.keys());
        for (root, group) in groups {
            let mut star: Vec<u32> = Vec::new();
            for v in &group.members {
                star.extend(live.star(*v).iter().filter(|q| self.quads.get(q).is_none_or(Option::is_some)));
                self.stars.insert(*v, Vec::new());
            }
            star.sort_unstable();
            star.dedup();
            for q in &star {
                if !self.quads.contains_key(q) {
                    let corners = live.mesh.quads[*q as usize].map(|v| self.root(v));
                    if (0..4).any(|i| (i + 1..4).any(|j| corners[i] == corners[j])) {
                        return Err(Refusal::Topology);
                    }
                    let sides = live.mesh.quad_edges[*q as usize];
                    self.quads.insert(*q, Some(Changed { corners, sides }));
                }
            }
            self.stars.insert(*root, star);
        }
        for q in dropped {
            for v in live.mesh.quads[*q as usize] {
                self.touched.push(self.root(v));
                self.stars.entry(v).or_insert_with(|| live.star(v).to_vec()).retain(|own| own != q);
            }
        }
        Ok(())
    }

    /// Joins the two quads at every interior vertex that has only two.
    fn remove_doublets(&mut self) -> Result<(), Refusal> {
        let live = self.live;
        let mut next = 0;
        while next < self.touched.len() {
            let v = self.touched[next];
            next += 1;
            let &[p, q] = self.star(v) else { continue };
            if self.vertex(v).place != Place::Interior {
                continue;
            }
            let from = |q: u32| {
                let (quad, sides) = (self.corners(q), self.sides(q));
                let i = quad.iter().position(|w| *w == v).unwrap_or(0);
                let corner = [1, 2, 3].map(|k| quad[(i + k) % 4]);
                (corner, [sides[(i + 1) % 4], sides[(i + 2) % 4]])
            };
            let (([b, c, a], [bc, ca]), ([a2, d, b2], [ad, db])) = (from(p), from(q));
            if a != a2 || b != b2 || c == d {
                return Err(Refusal::Topology);
            }
            self.quads.insert(p, Some(Changed { corners: [b, c, a, d], sides: [bc, ca, ad, db] }));
            self.quads.insert(q, None);
            self.stars.insert(v, Vec::new());
            for w in [a, b, d] {
                let star = self.stars.entry(w).or_insert_with(|| live.star(w).to_vec());
                star.retain(|own| *own != q);
                if w == d {
                    star.push(p);
                    star.sort_unstable();
                }
            }
            self.touched.extend([a, b, c, d]);
        }
        Ok(())
    }

    /// The neighbours of `v` at the start and the end of each quad there, counter-clockwise.
    fn arms(&self, v: u32) -> Vec<[u32; 2]> {
        let arm = |q: &u32| {
            let quad = self.corners(*q);
            let i = quad.iter().position(|w| *w == v).unwrap_or(0);
            [quad[(i + 1) % 4], quad[(i + 3) % 4]]
        };
        self.star(v).iter().map(arm).collect()
    }

    /// The vertices before and after the boundary vertex `v` along its loop.
    pub fn along_loop(&self, v: u32) -> Option<[u32; 2]> {
        let arms = self.arms(v);
        let before = arms.iter().find(|a| arms.iter().all(|b| b[0] != a[1]))?[1];
        let after = arms.iter().find(|a| arms.iter().all(|b| b[1] != a[0]))?[0];
        Some([before, after])
    }

    /// Refuses unless the quads at `v` follow each other edge by edge, once round an interior vertex, from
    /// boundary edge to boundary edge at another.
    fn check_fan(&self, boundary: &Boundary, v: u32) -> Result<(), Refusal> {
        let arms = self.arms(v);
        for k in 0..2 {
            let mut ends: Vec<u32> = arms.iter().map(|a| a[k]).collect();
            ends.sort_unstable();
            if ends.windows(2).any(|w| w[0] == w[1]) {
                return Err(Refusal::Topology);
            }
        }
        let first = arms.iter().position(|a| arms.iter().all(|b| b[1] != a[0]));
        let mut at = first.unwrap_or(0);
        let mut passed = 1;
        while let Some(next) = arms.iter().position(|a| a[0] == arms[at][1]) {
            if next == first.unwrap_or(0) {
                break;
            }
            at = next;
            passed += 1;
        }
        if passed != arms.len() {
            return Err(Refusal::Pinch);
        }
        let place = |v: u32| self.vertex(v).place;
        match (place(v), first) {
            (Place::Interior, None) => Ok(()),
            (Place::Interior, Some(_)) | (_, None) => Err(Refusal::Topology),
            (own, Some(first)) => {
                let follows = boundary.span(own, place(arms[first][0])).is_some()
                    && boundary.span(place(arms[at][1]), own).is_some();
                follows.then_some(()).ok_or(Refusal::Topology)
            }
        }
    }
}

/// Whether `valence` quads may meet at a vertex at `place` that `members` became.
fn allowed(boundary: &Boundary, live: &LiveMesh, place: Place, valence: usize, members: &[u32]) -> bool {
    match place {
        Place::Interior => (3..=MOST_INSIDE).contains(&valence),
        Place::Boundary(_) => (2..=MOST_SMOOTH).contains(&valence),
        Place::Junction(_) => {
            let ideal = ideal_valence(boundary, place);
            let own = members.iter().find(|v| live.mesh.vertices[**v as usize].place == place);
            let before = own.map_or(0, |v| live.valence(*v));
            ideal.abs_diff(valence) <= ideal.abs_diff(before)
        }
    }
}

/// Growth of Σ (valence − ideal)² if the diagonal of quad `q` from its corner `from` is collapsed, from
/// the valences alone: most diagonals are refused for it. `None` where doublets would change more.
pub(super) fn diagonal_growth(boundary: &Boundary, live: &LiveMesh, q: u32, from: usize) -> Option<isize> {
    let quad = live.mesh.quads[q as usize];
    let corner = |k: usize| {
        let v = quad[(from + k) % 4];
        (live.mesh.vertices[v as usize].place, live.valence(v))
    };
    let of = |place: Place, valence: usize| irregularity(boundary, place, valence) as isize;
    let [(a, in_a), (c, in_c)] = [corner(0), corner(2)];
    let place = if a == Place::Interior { c } else { a };
    let mut growth = of(place, (in_a + in_c).saturating_sub(2)) - of(a, in_a) - of(c, in_c);
    for (place, valence) in [corner(1), corner(3)] {
        if place == Place::Interior && valence == 3 {
            return None;
        }
        growth += of(place, valence.saturating_sub(1)) - of(place, valence);
    }
    Some(growth)
}

/// The vertex that a group becomes, and for each boundary edge that vanishes its chain.
fn merged(boundary: &Boundary, live: &LiveMesh, group: &Group) -> Result<(Vertex, Vec<u32>), Refusal> {
    let members: Vec<&Vertex> = group.members.iter().map(|v| &live.mesh.vertices[*v as usize]).collect();
    let on_boundary: Vec<&Vertex> = members.iter().copied().filter(|v| v.place != Place::Interior).collect();
    // Boundary vertices are joined by boundary edges or not at all.
    if on_boundary.len() > 1 && group.boundary_rungs + 1 != on_boundary.len() {
        return Err(Refusal::Pinch);
    }
    // Irregular vertices of equal sign repel each other: what they were made for would be lost.
    let mut signs = [0; 2];
    for (v, vertex) in group.members.iter().zip(&members) {
        let (ideal, now) = (ideal_valence(boundary, vertex.place), live.valence(*v));
        if vertex.place == Place::Interior && now != ideal {
            signs[usize::from(now > ideal)] += 1;
        }
    }
    if signs[0] > 1 || signs[1] > 1 {
        return Err(Refusal::Valence);
    }
    let chains = |vertices: &[&Vertex]| -> Option<Vec<u32>> {
        // Two neighbours share the chain of the vertex that is no junction.
        let free = vertices.iter().find_map(|v| match v.place {
            Place::Boundary(p) => Some(p.chain),
            _ => None,
        });
        free.map(|c| vec![c; vertices.len() - 1])
    };
    let lost = match on_boundary.len() {
        0 | 1 => Vec::new(),
        _ => chains(&on_boundary).ok_or(Refusal::Pinch)?,
    };
    let junctions: Vec<&&Vertex> =
        on_boundary.iter().filter(|v| matches!(v.place, Place::Junction(_))).collect();
    match (junctions.len(), on_boundary.len()) {
        (0, 0) => {
            let sum: Vector = members.iter().map(|v| v.point.coords).sum();
            let point = Point::from(sum / members.len() as f64);
            Ok((Vertex { point, place: Place::Interior }, lost))
        }
        (1, _) => Ok((**junctions[0], lost)),
        (0, 1) => Ok((*on_boundary[0], lost)),
        (0, 2) => {
            let [Place::Boundary(a), Place::Boundary(b)] = [on_boundary[0].place, on_boundary[1].place]
            else {
                return Err(Refusal::Pinch);
            };
            if a.chain != b.chain {
                return Err(Refusal::Pinch);
            }
            let chain = &boundary.chains[a.chain as usize];
            // The shorter way round a closed chain is the edge.
            let mut gap = b.s - a.s;
            if chain.ends.is_none() && gap.abs() > 0.5 * chain.length {
                gap -= chain.length * gap.signum();
            }
            let s = chain.wrap(a.s + 0.5 * gap);
            let place = Place::Boundary(BoundaryPoint { chain: a.chain, s });
            Ok((Vertex { point: chain.point(s), place }, lost))
        }
        _ => Err(Refusal::Pinch),
    }
}
