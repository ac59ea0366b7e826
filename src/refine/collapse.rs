//! Merging vertices: the topology of chord removal and of diagonal collapse, with what forbids it.

use super::stars::{ideal_valence, irregularity, Stars};
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::mesh::{QuadMesh, Vertex};
use crate::numerics::{Point, Vector};
use std::collections::HashMap;

/// A mesh with some vertices merged; vertices keep their numbers, those merged away are not used any more.
#[derive(Debug, Clone)]
pub(super) struct Collapsed {
    pub mesh: QuadMesh,
    pub stars: Stars,
    /// Vertices that came out of a merge or lost a quad, ascending.
    pub touched: Vec<u32>,
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

fn find(parent: &mut [u32], mut v: u32) -> u32 {
    while parent[v as usize] != v {
        parent[v as usize] = parent[parent[v as usize] as usize];
        v = parent[v as usize];
    }
    v
}

/// What the members of a merged group are.
#[derive(Debug, Clone, Default)]
struct Group {
    members: Vec<u32>,
    boundary_rungs: usize,
}

/// Merges the ends of each pair (`bool`: the pair is a boundary edge) and drops the quads `dropped`.
/// `spare[chain]` is how many edges the chain may lose.
pub(super) fn collapse(
    boundary: &Boundary,
    mesh: &QuadMesh,
    stars: &Stars,
    pairs: &[([u32; 2], bool)],
    dropped: &[u32],
    spare: &[usize],
) -> Result<Collapsed, Refusal> {
    let mut parent: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    for ([a, b], _) in pairs {
        let (a, b) = (find(&mut parent, *a), find(&mut parent, *b));
        parent[a.max(b) as usize] = a.min(b);
    }
    let mut groups: Vec<(u32, Group)> = Vec::new();
    let mut index = HashMap::new();
    let mut group_of = |v: u32, parent: &mut [u32], groups: &mut Vec<(u32, Group)>| -> usize {
        let root = find(parent, v);
        *index.entry(root).or_insert_with(|| {
            groups.push((root, Group::default()));
            groups.len() - 1
        })
    };
    for ([a, b], on_boundary) in pairs {
        let g = group_of(*a, &mut parent, &mut groups);
        groups[g].1.boundary_rungs += usize::from(*on_boundary);
        groups[g].1.members.extend([*a, *b]);
    }
    let mut vertices = mesh.vertices.clone();
    let mut lost = vec![0usize; boundary.chains.len()];
    for (root, group) in &mut groups {
        group.members.sort_unstable();
        group.members.dedup();
        let (vertex, chains) = merged(boundary, mesh, stars, group)?;
        chains.iter().for_each(|c| lost[*c as usize] += 1);
        vertices[*root as usize] = vertex;
    }
    if lost.iter().zip(spare).any(|(lost, spare)| lost > spare) {
        return Err(Refusal::Tolerance);
    }
    let mut drop = vec![false; mesh.quads.len()];
    dropped.iter().for_each(|q| drop[*q as usize] = true);
    let mut quads = Vec::with_capacity(mesh.quads.len());
    let mut region = Vec::with_capacity(mesh.quads.len());
    let mut touched: Vec<u32> = groups.iter().map(|g| g.0).collect();
    for (q, quad) in mesh.quads.iter().enumerate() {
        let quad = quad.map(|v| find(&mut parent, v));
        if drop[q] {
            touched.extend(quad);
            continue;
        }
        if (0..4).any(|i| (i + 1..4).any(|j| quad[i] == quad[j])) {
            return Err(Refusal::Topology);
        }
        quads.push(quad);
        region.push(mesh.region[q]);
    }
    remove_doublets(&vertices, &mut quads, &mut region, &mut touched)?;
    touched.sort_unstable();
    touched.dedup();
    let shapes = shapes(mesh, &mut parent);
    let new = QuadMesh::new(boundary, vertices, quads, region, &shapes).map_err(|_| Refusal::Topology)?;
    let new_stars = Stars::new(new.vertices.len(), &new.quads);
    touched.retain(|v| new_stars.valence(*v) > 0);
    for v in &touched {
        let place = new.vertices[*v as usize].place;
        let valence = new_stars.valence(*v);
        let allowed = match place {
            Place::Interior => (3..=MOST_INSIDE).contains(&valence),
            Place::Boundary(_) => (2..=MOST_SMOOTH).contains(&valence),
            Place::Junction(_) => {
                let ideal = ideal_valence(boundary, place);
                let before = old_junction_valence(mesh, stars, place, *v);
                ideal.abs_diff(valence) <= ideal.abs_diff(before)
            }
        };
        if !allowed {
            return Err(Refusal::Valence);
        }
        if !one_fan(&new, &new_stars, *v) {
            return Err(Refusal::Pinch);
        }
    }
    let change = irregularity_change(boundary, mesh, stars, &new, &new_stars, &groups, &touched);
    Ok(Collapsed { mesh: new, stars: new_stars, touched, irregularity: change })
}

/// The vertex that a group becomes, and for each boundary edge that vanishes its chain.
fn merged(
    boundary: &Boundary,
    mesh: &QuadMesh,
    stars: &Stars,
    group: &Group,
) -> Result<(Vertex, Vec<u32>), Refusal> {
    let members: Vec<&Vertex> = group.members.iter().map(|v| &mesh.vertices[*v as usize]).collect();
    let on_boundary: Vec<&Vertex> = members.iter().copied().filter(|v| v.place != Place::Interior).collect();
    // Boundary vertices are joined by boundary edges or not at all.
    if on_boundary.len() > 1 && group.boundary_rungs + 1 != on_boundary.len() {
        return Err(Refusal::Pinch);
    }
    // Irregular vertices of equal sign repel each other: what they were made for would be lost.
    let mut signs = [0; 2];
    for (v, vertex) in group.members.iter().zip(&members) {
        let (ideal, now) = (ideal_valence(boundary, vertex.place), stars.valence(*v));
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

/// Joins the two quads at every interior vertex that has only two.
fn remove_doublets(
    vertices: &[Vertex],
    quads: &mut Vec<[u32; 4]>,
    region: &mut Vec<u32>,
    touched: &mut Vec<u32>,
) -> Result<(), Refusal> {
    let mut count = vec![0usize; vertices.len()];
    quads.iter().flatten().for_each(|v| count[*v as usize] += 1);
    let mut next = 0;
    while next < touched.len() {
        let v = touched[next];
        next += 1;
        if vertices[v as usize].place != Place::Interior || count[v as usize] != 2 {
            continue;
        }
        let mut own = (0..quads.len()).filter(|q| quads[*q].contains(&v));
        let (Some(p), Some(q)) = (own.next(), own.next()) else { return Err(Refusal::Topology) };
        let from = |quad: [u32; 4]| {
            let i = quad.iter().position(|w| *w == v).unwrap_or(0);
            [quad[(i + 1) % 4], quad[(i + 2) % 4], quad[(i + 3) % 4]]
        };
        let ([b, c, a], [a2, d, b2]) = (from(quads[p]), from(quads[q]));
        if a != a2 || b != b2 || c == d {
            return Err(Refusal::Topology);
        }
        quads[p] = [b, c, a, d];
        quads.remove(q);
        region.remove(q);
        count[v as usize] = 0;
        for w in [a, b] {
            count[w as usize] -= 1;
        }
        touched.extend([a, b, c, d]);
    }
    Ok(())
}

/// Bubbles of the edges that stay; of two edges that become one, the mean.
fn shapes(mesh: &QuadMesh, parent: &mut [u32]) -> HashMap<[u32; 2], Vec<Vector>> {
    let mut shapes: HashMap<[u32; 2], (Vec<Vector>, f64)> = HashMap::with_capacity(mesh.edges.len());
    for edge in mesh.edges.iter().filter(|e| !e.bubbles.is_empty()) {
        let [a, b] = edge.vertices.map(|v| find(parent, v));
        if a == b {
            continue;
        }
        let flip = a > b;
        let signed = |m: usize, c: &Vector| if flip && m % 2 == 1 { -c } else { *c };
        let (sum, count) = shapes.entry([a.min(b), a.max(b)]).or_default();
        for (m, c) in edge.bubbles.iter().enumerate() {
            if sum.len() <= m {
                sum.push(Vector::zeros());
            }
            sum[m] += signed(m, c);
        }
        *count += 1.0;
    }
    shapes.into_iter().map(|(k, (sum, n))| (k, sum.into_iter().map(|c| c / n).collect())).collect()
}

/// Whether the quads at `v` follow each other edge by edge in one fan.
fn one_fan(mesh: &QuadMesh, stars: &Stars, v: u32) -> bool {
    let own = stars.of(v);
    let mut reached = vec![own[0]];
    let mut next = 0;
    while next < reached.len() {
        let q = reached[next];
        next += 1;
        for e in mesh.quad_edges[q as usize] {
            let edge = &mesh.edges[e as usize];
            if edge.vertices.contains(&v) {
                for other in edge.quads {
                    if own.contains(&other) && !reached.contains(&other) {
                        reached.push(other);
                    }
                }
            }
        }
    }
    reached.len() == own.len()
}

/// Valence, before the merge, of the junction that vertex `v` now is.
fn old_junction_valence(mesh: &QuadMesh, stars: &Stars, place: Place, v: u32) -> usize {
    if mesh.vertices[v as usize].place == place {
        return stars.valence(v);
    }
    let own =
        mesh.vertices.iter().enumerate().find(|(w, x)| x.place == place && stars.valence(*w as u32) > 0);
    own.map_or(0, |(w, _)| stars.valence(w as u32))
}

fn irregularity_change(
    boundary: &Boundary,
    old: &QuadMesh,
    old_stars: &Stars,
    new: &QuadMesh,
    new_stars: &Stars,
    groups: &[(u32, Group)],
    touched: &[u32],
) -> isize {
    let of = |mesh: &QuadMesh, stars: &Stars, v: u32| match stars.valence(v) {
        0 => 0,
        n => irregularity(boundary, mesh.vertices[v as usize].place, n) as isize,
    };
    let mut before: Vec<u32> = groups.iter().flat_map(|g| g.1.members.iter().copied()).collect();
    before.extend(touched);
    before.sort_unstable();
    before.dedup();
    let after: isize = touched.iter().map(|v| of(new, new_stars, *v)).sum();
    let then: isize = before.iter().map(|v| of(old, old_stars, *v)).sum();
    after - then
}
