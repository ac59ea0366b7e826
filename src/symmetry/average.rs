//! A mesh made as symmetric as its connectivity is.

use super::automorphism::MeshSymmetries;
use super::group::Group;
use super::image::Symmetry;
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::mesh::{reversed_bubbles, QuadMesh};
use crate::numerics::{Point, Vector};
use std::collections::HashMap;

/// `mesh` with every vertex and every edge's shape the mean of those that its symmetries make one, boundary
/// vertices in arc length; `None` if their places do not fit. It is not proven valid.
pub fn average(
    mesh: &QuadMesh,
    boundary: &Boundary,
    group: &Group,
    symmetries: &MeshSymmetries,
) -> Option<QuadMesh> {
    let elements: Vec<(&Symmetry, &[u32])> = symmetries
        .elements
        .iter()
        .zip(&symmetries.vertices)
        .map(|(e, images)| (&group.elements[*e], images.as_slice()))
        .collect();
    let share = 1.0 / elements.len() as f64;
    let mut result = mesh.clone();
    for (v, vertex) in result.vertices.iter_mut().enumerate() {
        let images = elements.iter().map(|(symmetry, images)| (*symmetry, mesh.vertices[images[v] as usize]));
        match vertex.place {
            Place::Junction(_) => {}
            Place::Interior => {
                let sum: Vector = images.map(|(s, w)| s.map.inverse().vector(w.point.coords)).sum();
                vertex.point = Point::from(sum * share);
            }
            Place::Boundary(own) => {
                let chain = &boundary.chains[own.chain as usize];
                let mut moved = 0.0;
                for (symmetry, w) in images {
                    let Place::Boundary(at) = w.place else { return None };
                    let mut d = symmetry.chains[own.chain as usize].origin(at.s) - own.s;
                    if chain.ends.is_none() {
                        d -= chain.length * (d / chain.length).round();
                    }
                    moved += d * share;
                }
                let s = chain.wrap(own.s + moved);
                vertex.place = Place::Boundary(BoundaryPoint { s, ..own });
                vertex.point = chain.point(s);
            }
        }
    }
    let known: HashMap<[u32; 2], usize> =
        (0..).zip(&mesh.edges).map(|(e, edge)| (edge.vertices, e)).collect();
    for edge in &mut result.edges {
        let [a, b] = edge.vertices.map(|v| v as usize);
        if edge.span.is_some() {
            edge.span = Some(boundary.span(result.vertices[a].place, result.vertices[b].place)?);
            continue;
        }
        let mut sum: Vec<Vector> = Vec::new();
        for (symmetry, images) in &elements {
            let (c, d) = (images[a], images[b]);
            let shape = match known.get(&[c, d]) {
                Some(e) => mesh.edges[*e].bubbles.clone(),
                None => reversed_bubbles(&mesh.edges[*known.get(&[d, c])?].bubbles),
            };
            let back = symmetry.map.inverse();
            sum.resize(sum.len().max(shape.len()), Vector::zeros());
            sum.iter_mut().zip(shape).for_each(|(sum, c)| *sum += back.vector(c) * share);
        }
        edge.bubbles = sum;
    }
    result.check(boundary).ok()?;
    Some(result)
}
