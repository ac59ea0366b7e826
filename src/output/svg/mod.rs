//! Pictures (SVG) of a mesh and of what each stage left behind; y points up, in the caller's pose.

mod canvas;
mod colouring;
mod mesh;
mod palette;
mod path;
mod stages;
mod trails;

use crate::mesh::HighOrderMesh;
use crate::numerics::Point;
use crate::stages::Stages;

/// What a stage can be drawn as, in running order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Picture {
    /// Boundary chains and the junctions between them.
    Boundary,
    /// The base mesh.
    Triangles,
    /// The cross field.
    Crosses,
    /// Interior singularities (triangle: valence 3, pentagon: 5) and corners.
    Singularities,
    /// Separatrices.
    Separatrices,
    /// Regions of the T-mesh.
    Regions,
    /// Blocks of the conforming layout, straight inside.
    Blocks,
}

impl Picture {
    /// All pictures, in running order.
    pub const ALL: [Picture; 7] = [
        Picture::Boundary,
        Picture::Triangles,
        Picture::Crosses,
        Picture::Singularities,
        Picture::Separatrices,
        Picture::Regions,
        Picture::Blocks,
    ];

    /// Its name, fit for a file name.
    pub fn name(self) -> &'static str {
        match self {
            Picture::Boundary => "boundary",
            Picture::Triangles => "triangles",
            Picture::Crosses => "crosses",
            Picture::Singularities => "singularities",
            Picture::Separatrices => "separatrices",
            Picture::Regions => "regions",
            Picture::Blocks => "blocks",
        }
    }
}

/// The mesh: elements tinted by their scaled Jacobian, the boundary thicker, irregular interior
/// vertices marked by polygons of as many corners as their valence, irregular boundary vertices by
/// squares.
pub fn mesh(mesh: &HighOrderMesh) -> String {
    mesh::draw(mesh, canvas::SINGLE).finish()
}

/// One stage's picture; `None` where generation did not come that far. `failure` is circled.
pub fn stage(stages: &Stages, picture: Picture, failure: Option<Point>) -> Option<String> {
    stages::draw(stages, picture, failure, canvas::SINGLE).map(canvas::Canvas::finish)
}

/// All stages that were reached side by side, the mesh last. `failure` is circled in the last of them.
pub fn overview(stages: &Stages, mesh: Option<&HighOrderMesh>, failure: Option<Point>) -> String {
    let shown = Picture::ALL.into_iter().filter(|p| *p != Picture::Boundary);
    let mut reached: Vec<Picture> = shown.filter(|p| stages::reached(stages, *p)).collect();
    if reached.is_empty() {
        reached.push(Picture::Boundary);
    }
    // Six panels fill two rows; the straight-sided blocks say least beside the mesh.
    if mesh.is_some() {
        reached.retain(|p| *p != Picture::Blocks);
    }
    let last = reached.len() - 1;
    let mut panels: Vec<canvas::Canvas> = reached
        .into_iter()
        .enumerate()
        .filter_map(|(k, p)| stages::draw(stages, p, failure.filter(|_| k == last), canvas::PANEL))
        .collect();
    panels.extend(mesh.map(|m| mesh::draw(m, canvas::PANEL)));
    canvas::tile(panels, 3)
}
