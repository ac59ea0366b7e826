//! What the stages made as flat arrays, in the caller's frame.

use super::mesh_arrays::{coordinates, indices};
use crate::domain::Frame;
use crate::numerics::{Point, Vector};
use crate::stages::Stages;

/// All arrays that the stages' getters lend out.
#[derive(Default)]
pub struct StageArrays {
    pub base_vertices: Vec<f64>,
    pub base_triangles: Vec<i32>,
    pub cross_field: Vec<f64>,
    pub singularity_points: Vec<f64>,
    pub singularity_valences: Vec<i32>,
    pub corner_points: Vec<f64>,
    pub corner_angles: Vec<f64>,
    pub corner_quads: Vec<i32>,
    pub separatrices: Lines,
    pub blocks: Lines,
    pub block_sides: Vec<i32>,
}

/// Polylines one after the other; line k has the points from `offsets[k]` to `offsets[k + 1]`.
pub struct Lines {
    pub offsets: Vec<usize>,
    pub points: Vec<f64>,
}

impl Default for Lines {
    fn default() -> Self {
        Lines { offsets: vec![0], points: Vec::new() }
    }
}

impl Lines {
    pub fn count(&self) -> usize {
        self.offsets.len() - 1
    }

    fn add(&mut self, points: impl IntoIterator<Item = Point>) {
        self.points.extend(points.into_iter().flat_map(|p| [p.x, p.y]));
        self.offsets.push(self.points.len() / 2);
    }
}

/// (cos 4θ, sin 4θ) of a cross in the caller's frame: turned by four times the frame's angle.
fn cross_to_caller(frame: &Frame, u: [f64; 2]) -> [f64; 2] {
    let square = |v: Vector| Vector::new(v.x * v.x - v.y * v.y, 2.0 * v.x * v.y);
    let turn = square(square(frame.axis));
    [u[0] * turn.x - u[1] * turn.y, u[0] * turn.y + u[1] * turn.x]
}

impl StageArrays {
    pub fn new(stages: &Stages) -> Self {
        let Some(boundary) = &stages.boundary else { return StageArrays::default() };
        let frame = &boundary.frame;
        let mapped = |points: Vec<Point>| coordinates(&points);
        let mut arrays = StageArrays::default();
        if let Some(base) = &stages.triangulation {
            arrays.base_vertices = mapped(base.vertices.iter().map(|v| frame.to_caller(v.point)).collect());
            arrays.base_triangles = indices(base.triangles.iter().copied().flatten());
        }
        if let Some(field) = &stages.cross_field {
            arrays.cross_field = field.u.iter().flat_map(|u| cross_to_caller(frame, *u)).collect();
        }
        let inside = &stages.singularities;
        arrays.singularity_points = mapped(inside.iter().map(|s| frame.to_caller(s.point)).collect());
        arrays.singularity_valences = inside.iter().map(|s| i32::from(s.valence)).collect();
        let junction = |j: u32| frame.to_caller(boundary.junctions[j as usize].point);
        arrays.corner_points = mapped(stages.corners.iter().map(|c| junction(c.junction)).collect());
        arrays.corner_angles = stages.corners.iter().map(|c| c.angle).collect();
        arrays.corner_quads = stages.corners.iter().map(|c| i32::from(c.quads)).collect();
        for line in &stages.separatrices {
            arrays.separatrices.add(line.points.iter().map(|p| frame.to_caller(*p)));
        }
        if let Some(layout) = &stages.block_layout {
            for region in &layout.regions {
                let mut outline = Vec::new();
                for step in region.sides.iter().flatten() {
                    let arc = &layout.arcs[step.arc as usize];
                    // The nodes close the outline; arcs may end a little beside them.
                    let inside = &arc.points[1..arc.points.len() - 1];
                    let node = layout.nodes[arc.nodes[usize::from(!step.forward)] as usize].point;
                    outline.push(frame.to_caller(node));
                    if step.forward {
                        outline.extend(inside.iter().map(|p| frame.to_caller(*p)));
                    } else {
                        outline.extend(inside.iter().rev().map(|p| frame.to_caller(*p)));
                    }
                }
                outline.extend(outline.first().copied());
                arrays.blocks.add(outline);
                arrays.block_sides.push(region.sides.len() as i32);
            }
        }
        arrays
    }
}
