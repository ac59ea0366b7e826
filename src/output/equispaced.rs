//! The mesh's nodes at equispaced points, each once: the node family of VTK and Gmsh.

use crate::mesh::HighOrderMesh;
use crate::numerics::interpolation::{equispaced, Interpolation};
use crate::numerics::{Point, Vector};

/// Equispaced nodes without duplicates.
pub struct EquispacedNodes {
    /// Vertices, then (N − 1) of each edge from its first vertex to its second, then (N − 1)²
    /// of each element, i fastest.
    pub points: Vec<Point>,
    /// Numbers of each element's (N + 1)² nodes, `[element][j][i]`.
    pub numbers: Vec<u32>,
}

impl EquispacedNodes {
    /// Interpolates and numbers the nodes of `mesh`.
    pub fn new(mesh: &HighOrderMesh) -> Self {
        let n = mesh.order;
        let row = n + 1;
        let interpolation = Interpolation::new(mesh.reference_nodes.clone());
        let matrix = interpolation.matrix(&equispaced(n));
        let numbers = mesh.node_numbers();
        let mut points = mesh.vertices.clone();
        points.resize(mesh.node_count(), Point::origin());
        let mut values = vec![Point::origin(); row * row];
        for (e, sides) in mesh.element_edges.iter().enumerate() {
            let own = e * row * row..(e + 1) * row * row;
            tensor(&matrix, &mesh.nodes[own.clone()], &mut values);
            // Of two elements at an edge one gives the points: the other's differ by rounding.
            let gives = sides.map(|edge| mesh.edges[edge as usize].elements[0] == e as u32);
            for (k, &number) in numbers[own].iter().enumerate() {
                let (i, j) = (k % row, k / row);
                let (left_or_right, below_or_above) = (i == 0 || i == n, j == 0 || j == n);
                let given = match (left_or_right, below_or_above) {
                    (true, true) => false,
                    (false, true) => gives[if j == 0 { 0 } else { 2 }],
                    (true, false) => gives[if i == 0 { 3 } else { 1 }],
                    (false, false) => true,
                };
                if given {
                    points[number as usize] = values[k];
                }
            }
        }
        EquispacedNodes { points, numbers }
    }
}

/// The matrix applied in both directions of a tensor of points.
fn tensor(matrix: &nalgebra::DMatrix<f64>, given: &[Point], values: &mut [Point]) {
    let row = matrix.ncols();
    let mut half = vec![Vector::zeros(); row * row];
    for j in 0..row {
        for a in 0..row {
            half[j * row + a] = (0..row).map(|i| given[j * row + i].coords * matrix[(a, i)]).sum();
        }
    }
    for b in 0..row {
        for a in 0..row {
            let sum: Vector = (0..row).map(|j| half[j * row + a] * matrix[(b, j)]).sum();
            values[b * row + a] = Point::from(sum);
        }
    }
}
