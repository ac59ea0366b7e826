//! The mesh as flat arrays of C's number types.

use crate::mesh::HighOrderMesh;
use crate::numerics::Point;

/// All arrays that the mesh's getters lend out.
pub struct MeshArrays {
    pub vertices: Vec<f64>,
    pub elements: Vec<i32>,
    pub element_neighbors: Vec<i32>,
    pub element_edges: Vec<i32>,
    pub element_boundaries: Vec<i32>,
    pub element_blocks: Vec<i32>,
    pub edge_vertices: Vec<i32>,
    pub edge_elements: Vec<i32>,
    pub edge_sides: Vec<i32>,
    pub edge_boundaries: Vec<i32>,
    pub edge_loops: Vec<i32>,
    pub edge_segments: Vec<i32>,
    pub edge_parameters: Vec<f64>,
    pub nodes: Vec<f64>,
    pub element_nodes: Vec<i32>,
}

/// Coordinates one after the other.
pub fn coordinates<'a>(points: impl IntoIterator<Item = &'a Point>) -> Vec<f64> {
    points.into_iter().flat_map(|p| [p.x, p.y]).collect()
}

/// Indices as C's numbers: "none" becomes -1, and no index comes near the limit.
pub fn indices(values: impl IntoIterator<Item = u32>) -> Vec<i32> {
    values.into_iter().map(|i| i as i32).collect()
}

impl MeshArrays {
    pub fn new(mesh: &HighOrderMesh) -> Self {
        let boundary = |edge: u32| mesh.edges[edge as usize].boundary;
        MeshArrays {
            vertices: coordinates(&mesh.vertices),
            elements: indices(mesh.elements.iter().copied().flatten()),
            element_neighbors: indices(mesh.element_neighbors().into_iter().flatten()),
            element_edges: indices(mesh.element_edges.iter().copied().flatten()),
            element_boundaries: indices(mesh.element_edges.iter().flatten().map(|e| boundary(*e))),
            element_blocks: indices(mesh.blocks.iter().copied()),
            edge_vertices: indices(mesh.edges.iter().flat_map(|e| e.vertices)),
            edge_elements: indices(mesh.edges.iter().flat_map(|e| e.elements)),
            edge_sides: indices(mesh.edge_sides().into_iter().flatten()),
            edge_boundaries: indices(mesh.edges.iter().map(|e| e.boundary)),
            edge_loops: indices(mesh.edges.iter().map(|e| e.loop_index)),
            edge_segments: indices(mesh.edges.iter().flat_map(|e| e.segments)),
            edge_parameters: mesh.edges.iter().flat_map(|e| e.parameters).collect(),
            nodes: coordinates(&mesh.shared_nodes()),
            element_nodes: indices(mesh.node_numbers()),
        }
    }
}
