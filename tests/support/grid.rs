//! Meshes from a map of a rectangular grid, whose elements start at different corners.

use quadrel::mesh::{HighOrderMesh, MeshEdge};
use quadrel::numerics::{GaussLobatto, Point, NONE};
use std::collections::BTreeMap;

/// The reference corners of an element on the grid, counter-clockwise.
pub struct Corners([(f64, f64); 4]);

impl Corners {
    /// The grid's (x, y) at the element's own parameters in [0, 1].
    pub fn at(&self, a: f64, b: f64) -> (f64, f64) {
        let [p, q, r, s] = self.0;
        let mix = |p: f64, q: f64, r: f64, s: f64| {
            (1.0 - a) * (1.0 - b) * p + a * (1.0 - b) * q + a * b * r + (1.0 - a) * b * s
        };
        (mix(p.0, q.0, r.0, s.0), mix(p.1, q.1, r.1, s.1))
    }
}

/// `columns` × `rows` elements on [0, 1]² under `map`; element k starts at its corner k mod 4.
/// Boundary 0 is the bottom and the right side, boundary 1 the rest.
pub fn grid_mesh(
    columns: usize,
    rows: usize,
    order: usize,
    map: impl Fn(f64, f64) -> Point,
) -> (HighOrderMesh, Vec<Corners>) {
    let place = |i: usize, j: usize| (i as f64 / columns as f64, j as f64 / rows as f64);
    let vertex = |i: usize, j: usize| (j * (columns + 1) + i) as u32;
    let mut vertices = Vec::new();
    for j in 0..=rows {
        vertices.extend((0..=columns).map(|i| map(place(i, j).0, place(i, j).1)));
    }
    let (mut elements, mut corners) = (Vec::new(), Vec::new());
    for j in 0..rows {
        for i in 0..columns {
            let mut ids = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            ids.rotate_left(elements.len() % 4);
            elements.push(ids.map(|(i, j)| vertex(i, j)));
            corners.push(Corners(ids.map(|(i, j)| place(i, j))));
        }
    }
    let name = |a: u32, b: u32| {
        let (wide, last) = (columns as u32 + 1, columns as u32);
        let bottom = a <= last && b <= last;
        let right = a % wide == last && b % wide == last;
        u32::from(!(bottom || right))
    };
    let mesh = assemble(order, vertices, elements, name, |e, a, b| {
        let (x, y) = corners[e].at(a, b);
        map(x, y)
    });
    (mesh, corners)
}

/// A mesh from its elements' maps over [0, 1]²; `boundary` names border edges.
pub fn assemble(
    order: usize,
    vertices: Vec<Point>,
    elements: Vec<[u32; 4]>,
    boundary: impl Fn(u32, u32) -> u32,
    map: impl Fn(usize, f64, f64) -> Point,
) -> HighOrderMesh {
    let reference_nodes = GaussLobatto::new(order).nodes;
    let unit = |k: usize| 0.5 * (1.0 + reference_nodes[k]);
    let mut nodes = Vec::new();
    let mut edges: Vec<MeshEdge> = Vec::new();
    let mut known: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    let mut element_edges = Vec::new();
    for (e, quad) in elements.iter().enumerate() {
        for j in 0..=order {
            nodes.extend((0..=order).map(|i| map(e, unit(i), unit(j))));
        }
        let mut own = [NONE; 4];
        for s in 0..4 {
            let (a, b) = (quad[s], quad[(s + 1) % 4]);
            own[s] = *known.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                edges.push(MeshEdge {
                    vertices: [a, b],
                    elements: [e as u32, NONE],
                    boundary: NONE,
                    loop_index: NONE,
                    segments: [NONE; 2],
                    parameters: [0.0; 2],
                    error: 0.0,
                });
                edges.len() as u32 - 1
            });
            let edge = &mut edges[own[s] as usize];
            if edge.vertices == [b, a] {
                edge.elements[1] = e as u32;
            }
        }
        element_edges.push(own);
    }
    for edge in edges.iter_mut().filter(|e| e.elements[1] == NONE) {
        edge.boundary = boundary(edge.vertices[0], edge.vertices[1]);
        edge.loop_index = 0;
        edge.segments = [0; 2];
        edge.error = 1e-6;
    }
    HighOrderMesh {
        order,
        reference_nodes,
        vertices,
        blocks: (0..elements.len() as u32).collect(),
        scaled_jacobian: (0..elements.len()).map(|e| 0.9 - 0.5 * e as f64 / elements.len() as f64).collect(),
        elements,
        nodes,
        edges,
        element_edges,
        boundary_names: vec!["first".into(), "second".into()],
    }
}
