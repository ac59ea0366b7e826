//! Which symmetries of its domain a mesh has, by its connectivity.

use super::group::Group;
use super::image::Symmetry;
use crate::domain::{Boundary, Place};
use crate::mesh::QuadMesh;
use crate::numerics::NONE;

/// Symmetries of the domain that a mesh has: a subgroup.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshSymmetries {
    /// Indices into [`Group::elements`], the identity first.
    pub elements: Vec<usize>,
    /// For each of them the image of each vertex.
    pub vertices: Vec<Vec<u32>>,
}

/// Boundary edges tried as the image of one; the right one is nearest or next to it.
const SEEDS: usize = 3;

/// The largest subgroup of `group` that `mesh` has: its connectivity is mapped onto itself, with every border
/// edge on the image of its chain and every junction on its image.
pub fn mesh_symmetries(mesh: &QuadMesh, boundary: &Boundary, group: &Group) -> MeshSymmetries {
    let n = group.rotations;
    let mut found: Vec<Option<Option<Vec<u32>>>> = vec![None; group.elements.len()];
    let mut image = |element: usize| {
        let known = &mut found[element];
        known.get_or_insert_with(|| vertex_images(mesh, boundary, &group.elements[element])).clone()
    };
    let identity: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let mut best = MeshSymmetries { elements: vec![0], vertices: vec![identity.clone()] };
    for rotations in (1..=n).rev().filter(|r| n % r == 0) {
        let step = n / rotations;
        let mirrors = if group.mirrors() > 0 { step } else { 0 };
        for mirror in (0..mirrors).map(Some).chain([None]) {
            let elements = group.subgroup(rotations, mirror);
            if elements.len() <= best.elements.len() {
                continue;
            }
            let turn = if rotations > 1 { image(step) } else { Some(identity.clone()) };
            let flip = mirror.map(|m| image(n + m));
            if let (Some(turn), true) = (turn, flip.as_ref().is_none_or(Option::is_some)) {
                if let Some(vertices) = generated(rotations, &turn, flip.flatten().as_deref()) {
                    best = MeshSymmetries { elements, vertices };
                }
            }
        }
    }
    best
}

/// The permutation that is first `b`, then `a`.
fn after(a: &[u32], b: &[u32]) -> Vec<u32> {
    b.iter().map(|v| a[*v as usize]).collect()
}

/// The permutations of a subgroup's elements, in its order, if they are a group like it.
fn generated(rotations: usize, turn: &[u32], flip: Option<&[u32]>) -> Option<Vec<Vec<u32>>> {
    let identity: Vec<u32> = (0..turn.len() as u32).collect();
    let mut own = vec![identity.clone()];
    for k in 1..rotations {
        own.push(after(turn, &own[k - 1]));
    }
    let whole = after(turn, &own[rotations - 1]) == identity || rotations == 1;
    if let Some(flip) = flip {
        let turned = after(turn, flip);
        if after(flip, flip) != identity || after(&turned, &turned) != identity {
            return None;
        }
        own.extend((0..rotations).map(|k| after(&own[k], flip)).collect::<Vec<_>>());
    }
    whole.then_some(own)
}

/// The image of each vertex under `symmetry`, if the mesh has it.
fn vertex_images(mesh: &QuadMesh, boundary: &Boundary, symmetry: &Symmetry) -> Option<Vec<u32>> {
    let span = |e: usize| mesh.edges[e].span;
    let middle = |s: crate::domain::Span| 0.5 * (s.start + s.end);
    // From a border edge of the chain that has fewest.
    let mut edges_of: Vec<Vec<usize>> = vec![Vec::new(); boundary.chains.len()];
    for e in 0..mesh.edges.len() {
        if let Some(span) = span(e) {
            edges_of[span.chain as usize].push(e);
        }
    }
    let fewest = edges_of.iter().filter(|own| !own.is_empty()).min_by_key(|own| own.len())?;
    let first = fewest[0];
    let from = span(first)?;
    let image = symmetry.chains[from.chain as usize];
    let length = boundary.chains[image.chain as usize].length;
    let wanted = image.image(middle(from));
    let off = |e: &usize| {
        let d = (span(*e).map_or(f64::INFINITY, middle) - wanted).rem_euclid(length);
        d.min(length - d)
    };
    let mut seeds = edges_of[image.chain as usize].clone();
    seeds.sort_by(|a, b| off(a).total_cmp(&off(b)).then(a.cmp(b)));
    seeds.iter().take(SEEDS).find_map(|seed| walk(mesh, symmetry, first, *seed))
}

/// Where a quad goes: to another, its corner 0 to that one's corner `corner`.
#[derive(Clone, Copy)]
struct Image {
    quad: u32,
    corner: usize,
}

/// The vertices' images if border edge `from` goes to border edge `to`; both have their quad on the left.
fn walk(mesh: &QuadMesh, symmetry: &Symmetry, from: usize, to: usize) -> Option<Vec<u32>> {
    let mirror = symmetry.map.mirror;
    let side_of = |q: u32, e: usize| mesh.quad_edges[q as usize].iter().position(|x| *x as usize == e);
    // A mirror runs round the image the other way.
    let corner_image = |image: Image, i: usize| match mirror {
        false => (image.corner + i) % 4,
        true => (image.corner + 4 - i) % 4,
    };
    let side_image = |image: Image, i: usize| match mirror {
        false => (image.corner + i) % 4,
        true => (image.corner + 7 - i) % 4,
    };
    // The image of a quad whose side i goes to side k of quad q.
    let placed = |quad: u32, i: usize, k: usize| match mirror {
        false => Image { quad, corner: (k + 4 - i) % 4 },
        true => Image { quad, corner: (k + i + 1) % 4 },
    };
    let [start, target] = [from, to].map(|e| mesh.edges[e].quads[0]);
    let mut images: Vec<Option<Image>> = vec![None; mesh.quads.len()];
    let mut vertices = vec![NONE; mesh.vertices.len()];
    let mut taken = vec![false; mesh.quads.len()];
    images[start as usize] = Some(placed(target, side_of(start, from)?, side_of(target, to)?));
    taken[target as usize] = true;
    let mut queue = vec![start];
    while let Some(q) = queue.pop() {
        let image = images[q as usize]?;
        for i in 0..4 {
            let v = mesh.quads[q as usize][i];
            let w = mesh.quads[image.quad as usize][corner_image(image, i)];
            let slot = &mut vertices[v as usize];
            if *slot == NONE {
                if !may_be_image(mesh, symmetry, v, w) {
                    return None;
                }
                *slot = w;
            } else if *slot != w {
                return None;
            }
            let e = mesh.quad_edges[q as usize][i] as usize;
            let f = mesh.quad_edges[image.quad as usize][side_image(image, i)] as usize;
            let across = |e: usize, q: u32| {
                let quads = mesh.edges[e].quads;
                quads[usize::from(quads[0] == q)]
            };
            let (next, next_image) = (across(e, q), across(f, image.quad));
            if (next == NONE) != (next_image == NONE) {
                return None;
            }
            if next == NONE {
                let (a, b) = (mesh.edges[e].span?, mesh.edges[f].span?);
                if symmetry.chains[a.chain as usize].chain != b.chain {
                    return None;
                }
                continue;
            }
            let expected = placed(next_image, side_of(next, e)?, side_of(next_image, f)?);
            match images[next as usize] {
                Some(known) if (known.quad, known.corner) == (expected.quad, expected.corner) => {}
                Some(_) => return None,
                None => {
                    if std::mem::replace(&mut taken[next_image as usize], true) {
                        return None;
                    }
                    images[next as usize] = Some(expected);
                    queue.push(next);
                }
            }
        }
    }
    (!vertices.contains(&NONE)).then_some(vertices)
}

/// Whether vertex `w` lies where the image of `v` may.
fn may_be_image(mesh: &QuadMesh, symmetry: &Symmetry, v: u32, w: u32) -> bool {
    match (mesh.vertices[v as usize].place, mesh.vertices[w as usize].place) {
        (Place::Interior, Place::Interior) => true,
        (Place::Junction(j), Place::Junction(k)) => symmetry.junctions[j as usize] == k,
        (Place::Boundary(p), Place::Boundary(q)) => symmetry.chains[p.chain as usize].chain == q.chain,
        _ => false,
    }
}
