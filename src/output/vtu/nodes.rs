//! The mesh's nodes as VTK wants them: equispaced, each written once.

use crate::mesh::HighOrderMesh;
use crate::numerics::interpolation::{equispaced, Interpolation};
use crate::numerics::{Point, Vector};

/// The place of node (i, j), each in 0..=`order`, in VTK's list of the nodes of a Lagrange
/// quadrilateral: corners, then edges bottom, right, top, left (all with growing i or j), then the
/// inside with i fastest.
pub fn lagrange_index(order: usize, i: usize, j: usize) -> usize {
    let n = order;
    let inside = n.saturating_sub(1);
    match (i == 0 || i == n, j == 0 || j == n) {
        (true, true) => match (i > 0, j > 0) {
            (false, false) => 0,
            (true, false) => 1,
            (true, true) => 2,
            (false, true) => 3,
        },
        (false, true) => 4 + (i - 1) + if j > 0 { 2 * inside } else { 0 },
        (true, false) => 4 + (j - 1) + if i > 0 { inside } else { 3 * inside },
        (false, false) => 4 + 4 * inside + (i - 1) + inside * (j - 1),
    }
}

/// Equispaced nodes without duplicates.
pub struct SharedNodes {
    /// Vertices, then (N − 1) of each edge from its first vertex to its second, then (N − 1)²
    /// of each element.
    pub points: Vec<Point>,
    /// Indices of each element's (N + 1)² nodes, in VTK's order.
    pub cells: Vec<usize>,
}

impl SharedNodes {
    /// Interpolates and numbers the nodes of `mesh`.
    pub fn new(mesh: &HighOrderMesh) -> Self {
        let n = mesh.order;
        let row = n + 1;
        let interpolation = Interpolation::new(mesh.reference_nodes.clone());
        let matrix = interpolation.matrix(&equispaced(n));
        let numbers = mesh.node_numbers();
        let mut points = mesh.vertices.clone();
        points.resize(mesh.node_count(), Point::origin());
        let mut cells = vec![0; numbers.len()];
        let mut values = vec![Point::origin(); row * row];
        for (e, sides) in mesh.element_edges.iter().enumerate() {
            let own = e * row * row..(e + 1) * row * row;
            tensor(&matrix, &mesh.nodes[own.clone()], &mut values);
            let (numbers, cell) = (&numbers[own.clone()], &mut cells[own]);
            // Of two elements at an edge one gives the points: the other's differ by rounding.
            let gives = sides.map(|edge| mesh.edges[edge as usize].elements[0] == e as u32);
            for (k, &number) in numbers.iter().enumerate() {
                let (i, j) = (k % row, k / row);
                cell[lagrange_index(n, i, j)] = number as usize;
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
        SharedNodes { points, cells }
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
