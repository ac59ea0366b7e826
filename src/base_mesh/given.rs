//! A base mesh that the caller brings: checked like any input.

use super::{BaseVertex, Triangulation};
use crate::domain::{Boundary, Domain, Place};
use crate::error::{Error, Result};
use crate::numerics::tolerances::{GIVEN_OFF_CURVE, JUNCTION_MATCH};
use crate::numerics::{Point, NONE};
use crate::options::BaseTriangulation;
use std::collections::HashMap;

/// The caller's triangulation in the canonical frame, vertices and triangles in the caller's order.
///
/// # Errors
/// [`Error::InvalidArgument`] for numbers out of range; [`Error::BaseMesh`] with its place, in the caller's
/// frame, where it does not triangulate the domain.
pub fn adopt(given: &BaseTriangulation, domain: &Domain, boundary: &Boundary) -> Result<Triangulation> {
    let frame = &boundary.frame;
    check_numbers(given)?;
    let at = |v: u32| given.vertices.get(v as usize).map(|p| Point::from(*p));
    let fail = |reason: &str, v: u32| {
        Err(Error::BaseMesh { reason: format!("the caller's triangulation: {reason}"), at: at(v) })
    };
    let mut vertices: Vec<BaseVertex> = (given.vertices.iter())
        .map(|p| BaseVertex { point: frame.to_canonical(Point::from(*p)), place: Place::Interior })
        .collect();
    for b in &given.boundary {
        let place = boundary.place_of(domain, b.loop_index as usize, b.segment as usize, b.t)?;
        let known = &mut vertices[b.vertex as usize].place;
        // A corner may be told as the end of one segment and as the start of the next.
        if *known != Place::Interior && !same_place(boundary, *known, place) {
            return fail("a vertex has two different places on the boundary", b.vertex);
        }
        *known = place;
    }

    let neighbors = match neighbors(&given.triangles) {
        Ok(neighbors) => neighbors,
        Err(v) => return fail("an edge has three triangles, or two of opposite orientation", v),
    };
    let mut next = vec![NONE; vertices.len()];
    for (corners, across) in given.triangles.iter().zip(&neighbors) {
        for i in (0..3).filter(|i| across[*i] == NONE) {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            if next[a as usize] != NONE {
                return fail("its border touches itself", a);
            }
            next[a as usize] = b;
        }
    }

    // Border edges follow the chains, and cover each of them once.
    let mut covered = vec![0.0; boundary.chains.len()];
    let mut loops = vec![Vec::new(); boundary.loops.len()];
    let mut met = vec![false; vertices.len()];
    for start in (0..vertices.len() as u32).filter(|v| next[*v as usize] != NONE) {
        let mut own = Vec::new();
        let mut chain = None;
        let mut v = start;
        while !met[v as usize] {
            met[v as usize] = true;
            own.push(v);
            let to = next[v as usize];
            if to == NONE {
                return fail("its border does not close", v);
            }
            let [a, b] = [v, to].map(|v| vertices[v as usize].place);
            match boundary.span(a, b) {
                Some(span) => {
                    covered[span.chain as usize] += span.end - span.start;
                    chain = Some(span.chain);
                }
                None if a == Place::Interior => {
                    return fail("a border vertex has no place on the boundary", v)
                }
                None if b == Place::Interior => {
                    return fail("a border vertex has no place on the boundary", to)
                }
                None => {
                    let reason = "a border edge does not follow the boundary from one vertex to the next \
                                  (every corner needs a vertex)";
                    return fail(reason, v);
                }
            }
            v = to;
        }
        if let Some(chain) = chain {
            let l = boundary.chains[chain as usize].loop_index as usize;
            if !loops[l].is_empty() {
                return fail("two parts of its border are on the same loop", start);
            }
            loops[l] = own;
        }
    }
    for (c, chain) in boundary.chains.iter().enumerate() {
        if (covered[c] - chain.length).abs() > 1e2 * JUNCTION_MATCH {
            let at = Some(frame.to_caller(chain.point(0.0)));
            let reason = "the caller's triangulation: its border does not cover the boundary once".into();
            return Err(Error::BaseMesh { reason, at });
        }
    }
    let result = Triangulation { vertices, triangles: given.triangles.clone(), neighbors, loops };
    if let Err(v) = check_distances(&result, boundary) {
        return fail("a border vertex is not at its place", v);
    }
    result.check().map_err(|(reason, at)| Error::BaseMesh {
        reason: format!("the caller's triangulation: {reason}"),
        at: Some(frame.to_caller(at)),
    })?;
    Ok(result)
}

/// Refuses indices out of range and coordinates that are not finite.
fn check_numbers(given: &BaseTriangulation) -> Result<()> {
    let count = given.vertices.len();
    let used = given.triangles.iter().flatten().copied().chain(given.boundary.iter().map(|b| b.vertex));
    for v in used {
        if v as usize >= count {
            return Err(Error::InvalidArgument {
                what: "a vertex number of the base triangulation",
                value: v.to_string(),
                allowed: "numbers below the number of vertices",
            });
        }
    }
    for p in &given.vertices {
        if !p.iter().all(|x| x.is_finite()) {
            return Err(Error::InvalidArgument {
                what: "a vertex of the base triangulation",
                value: format!("({}, {})", p[0], p[1]),
                allowed: "finite coordinates",
            });
        }
    }
    Ok(())
}

/// Whether two places are the same up to rounding.
fn same_place(boundary: &Boundary, a: Place, b: Place) -> bool {
    match (a, b) {
        (Place::Boundary(p), Place::Boundary(q)) => {
            let gap = (p.s - q.s).abs();
            let round = boundary.chains[p.chain as usize].length - gap;
            p.chain == q.chain && gap.min(round) <= JUNCTION_MATCH
        }
        _ => a == b,
    }
}

/// For each triangle the ones across its edges; `Err`: a vertex where the triangles do not fit.
fn neighbors(triangles: &[[u32; 3]]) -> std::result::Result<Vec<[u32; 3]>, u32> {
    let mut by_edge = HashMap::with_capacity(3 * triangles.len());
    for (t, corners) in (0u32..).zip(triangles) {
        for i in 0..3 {
            if by_edge.insert([corners[i], corners[(i + 1) % 3]], t).is_some() {
                return Err(corners[i]);
            }
        }
    }
    let across = |a: u32, b: u32| by_edge.get(&[b, a]).copied().unwrap_or(NONE);
    Ok(triangles.iter().map(|&[a, b, c]| [across(a, b), across(b, c), across(c, a)]).collect())
}

/// `Err`: a border vertex that is too far from its place.
fn check_distances(mesh: &Triangulation, boundary: &Boundary) -> std::result::Result<(), u32> {
    for own in &mesh.loops {
        let n = own.len();
        let point = |i: usize| mesh.vertices[own[i % n] as usize].point;
        for (i, &v) in own.iter().enumerate() {
            let (p, next, last) = (point(i), point(i + 1), point(i + n - 1));
            let shorter = (next - p).norm().min((last - p).norm());
            let exact = boundary.point(mesh.vertices[v as usize].place);
            if exact.is_none_or(|q| (q - p).norm() > GIVEN_OFF_CURVE * shorter) {
                return Err(v);
            }
        }
    }
    Ok(())
}
