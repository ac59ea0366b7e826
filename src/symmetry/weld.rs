//! A sector's mesh and its images made one.

use super::group::Group;
use super::sector::{Corner, Sector, Source};
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::mesh::{QuadMesh, Vertex};
use crate::numerics::{Point, Vector, NONE};
use std::collections::HashMap;

/// A vertex of the sector's mesh in the whole domain.
struct Origin {
    vertex: Vertex,
    /// On the axis at the sector's beginning, and at its end.
    axes: [bool; 2],
}

impl Sector {
    /// The mesh of the whole domain that consists of `part`, a mesh of the sector, and its images.
    ///
    /// # Errors
    /// As [`QuadMesh::new`].
    pub fn weld(
        &self,
        part: &QuadMesh,
        whole: &Boundary,
        group: &Group,
    ) -> Result<QuadMesh, (String, Point)> {
        let copies = group.subgroup(self.cut.rotations, Some(self.cut.mirror));
        let position = |element: usize| copies.iter().position(|c| *c == element);
        let step = group.rotations / self.cut.rotations;
        let first = copies[self.cut.rotations];
        let second = if self.cut.rotations > 1 { group.product(step, first) } else { first };
        // A copy and the copy beyond its axis have the vertices there in common.
        let beyond: Vec<[Option<usize>; 2]> = copies
            .iter()
            .map(|c| [first, second].map(|mirror| position(group.product(*c, mirror))))
            .collect();
        let origins: Vec<Origin> = part.vertices.iter().map(|v| self.origin(v, whole)).collect();

        let mut vertices: Vec<Vertex> = Vec::new();
        let mut numbers = vec![vec![NONE; part.vertices.len()]; copies.len()];
        for (v, origin) in origins.iter().enumerate() {
            for (c, element) in copies.iter().enumerate() {
                if numbers[c][v] != NONE {
                    continue;
                }
                let number = vertices.len() as u32;
                let symmetry = &group.elements[*element];
                let place = symmetry.place(whole, origin.vertex.place);
                let point = whole.point(place).unwrap_or_else(|| symmetry.map.point(origin.vertex.point));
                vertices.push(Vertex { point, place });
                let mut reached = vec![c];
                while let Some(c) = reached.pop() {
                    numbers[c][v] = number;
                    for (other, on_axis) in beyond[c].iter().zip(origin.axes) {
                        let other = other.filter(|_| on_axis);
                        reached.extend(other.filter(|o| numbers[*o][v] == NONE));
                    }
                }
            }
        }

        let regions = part.region.iter().max().map_or(0, |r| r + 1);
        let (mut quads, mut region) = (Vec::new(), Vec::new());
        let mut shapes: HashMap<[u32; 2], Vec<Vector>> = HashMap::new();
        for (c, element) in copies.iter().enumerate() {
            let map = group.elements[*element].map;
            let number = |v: u32| numbers[c][v as usize];
            for (quad, own) in part.quads.iter().zip(&part.region) {
                let [i, j, k, l] = quad.map(number);
                quads.push(if map.mirror { [i, l, k, j] } else { [i, j, k, l] });
                region.push(own + c as u32 * regions);
            }
            for edge in part.edges.iter().filter(|e| e.span.is_none() && !e.bubbles.is_empty()) {
                let bubbles = edge.bubbles.iter().map(|b| map.vector(*b)).collect();
                shapes.insert(edge.vertices.map(number), bubbles);
            }
        }
        QuadMesh::new(whole, vertices, quads, region, &shapes)
    }

    /// Where a vertex of the sector's mesh lies in the whole domain.
    fn origin(&self, vertex: &Vertex, whole: &Boundary) -> Origin {
        let on_axis = |end: bool| {
            let axis = self.axes[usize::from(end)];
            let point = Point::from(axis * axis.dot(&vertex.point.coords));
            let axes = if self.cut.rotations == 1 { [true, false] } else { [!end, end] };
            Origin { vertex: Vertex { point, place: Place::Interior }, axes }
        };
        let at = |place: Place, axes: [bool; 2]| {
            let point = whole.point(place).unwrap_or(vertex.point);
            Origin { vertex: Vertex { point, place }, axes }
        };
        match vertex.place {
            Place::Interior => Origin { vertex: *vertex, axes: [false; 2] },
            Place::Boundary(p) => match self.sources[p.chain as usize] {
                Source::Axis(end) => on_axis(end),
                Source::Chain { chain, start } => {
                    let s = whole.chains[chain as usize].wrap(start + p.s);
                    at(Place::Boundary(BoundaryPoint { chain, s }), [false; 2])
                }
            },
            Place::Junction(j) => match self.corners[j as usize] {
                Corner::Junction(j) => at(Place::Junction(j), [false; 2]),
                Corner::Crossing { place, end } => at(place, on_axis(end).axes),
                Corner::Centre => Origin {
                    vertex: Vertex { point: Point::origin(), place: Place::Interior },
                    axes: [true; 2],
                },
            },
        }
    }
}
