//! The finished mesh: curved edges, elements tinted by quality, irregular vertices marked.

use super::canvas::{Canvas, Mark, Stroke};
use super::palette::{quality_tint, valence_color, BOUNDARY};
use super::path::Path;
use crate::mesh::{quads_by_table, HighOrderMesh};
use crate::numerics::interpolation::Interpolation;
use crate::numerics::{cross, Point, Vector, NONE};
use nalgebra::DMatrix;

/// Draws the mesh on a canvas `width` wide.
pub fn draw(mesh: &HighOrderMesh, width: f64) -> Canvas {
    let mut canvas = Canvas::around(mesh.nodes.iter().copied(), width);
    let curves = EdgeCurves::new(mesh);
    let typical = typical_edge(mesh) / canvas.unit();
    let line = (0.03 * typical).clamp(0.3, 1.2);

    for (e, edges) in mesh.element_edges.iter().enumerate() {
        let worst = mesh.scaled_jacobian.get(e).copied().unwrap_or(1.0);
        canvas.area(&quality_tint(worst), |path| {
            for (side, &edge) in edges.iter().enumerate() {
                let forward = mesh.edges[edge as usize].vertices[0] == mesh.elements[e][side];
                curves.append(edge as usize, forward, side == 0, path);
            }
        });
    }
    let boundary = |e: &usize| mesh.edges[*e].elements[1] == NONE || mesh.edges[*e].elements[0] == NONE;
    canvas.lines(Stroke { color: "#445", width: line }, |path| {
        for e in (0..mesh.edges.len()).filter(|e| !boundary(e)) {
            curves.append(e, true, true, path);
        }
    });
    canvas.lines(Stroke { color: BOUNDARY, width: (2.2 * line).max(1.2) }, |path| {
        for e in (0..mesh.edges.len()).filter(boundary) {
            curves.append(e, true, true, path);
        }
    });
    let radius = (0.13 * typical).clamp(2.4, 7.0);
    for (v, valence) in irregular_vertices(mesh) {
        canvas.mark(mesh.vertices[v], Mark::Polygon(valence.max(3)), radius, valence_color(valence));
    }
    for (v, excess) in irregular_border(mesh, &curves) {
        canvas.mark(
            mesh.vertices[v],
            Mark::Polygon(4),
            0.8 * radius,
            valence_color(4_usize.saturating_add_signed(excess)),
        );
    }
    let worst = mesh.scaled_jacobian.iter().copied().fold(f64::INFINITY, f64::min);
    canvas.caption(format!(
        "mesh: {} elements of order {}, scaled Jacobian ≥ {worst:.2}",
        mesh.elements.len(),
        mesh.order
    ));
    canvas
}

/// Interior vertices whose number of elements is not 4, with that number.
fn irregular_vertices(mesh: &HighOrderMesh) -> Vec<(usize, usize)> {
    let mut valence = vec![0; mesh.vertices.len()];
    for v in mesh.elements.iter().flatten() {
        valence[*v as usize] += 1;
    }
    for edge in mesh.edges.iter().filter(|e| e.elements.contains(&NONE)) {
        for v in edge.vertices {
            valence[v as usize] = 4;
        }
    }
    valence.into_iter().enumerate().filter(|(_, n)| *n != 4).collect()
}

/// Border vertices whose number of elements is not Table 1's for the angle there, with the excess.
fn irregular_border(mesh: &HighOrderMesh, curves: &EdgeCurves) -> Vec<(usize, isize)> {
    let mut border = vec![false; mesh.vertices.len()];
    for edge in mesh.edges.iter().filter(|e| e.elements.contains(&NONE)) {
        edge.vertices.iter().for_each(|v| border[*v as usize] = true);
    }
    let mut at = vec![(0, 0.0); mesh.vertices.len()];
    for (e, corners) in mesh.elements.iter().enumerate() {
        let leaving = |side: usize, corner: u32| {
            let id = mesh.element_edges[e][side] as usize;
            curves.leaving(id, mesh.edges[id].vertices[0] == corner)
        };
        for (side, corner) in corners.iter().enumerate() {
            let (a, b) = (leaving(side, *corner), leaving((side + 3) % 4, *corner));
            let (count, angle) = &mut at[*corner as usize];
            *count += 1;
            *angle += cross(a, b).atan2(a.dot(&b));
        }
    }
    // The better of the table's answers for angles this close.
    let excess = |(count, angle): (usize, f64)| {
        let off = |angle: f64| count as isize - quads_by_table(angle) as isize;
        [off(angle - TIE), off(angle + TIE)].into_iter().min_by_key(|x| x.abs()).unwrap_or(0)
    };
    let found = at.into_iter().map(excess).enumerate();
    found.filter(|(v, excess)| border[*v] && *excess != 0).collect()
}

/// Angles read off a mesh, in radians, are this good; a corner this near to a tie of Table 1 is no
/// irregular one.
const TIE: f64 = 0.02;

/// Median chord of the edges.
fn typical_edge(mesh: &HighOrderMesh) -> f64 {
    let chord = |e: &crate::mesh::MeshEdge| {
        (mesh.vertices[e.vertices[1] as usize] - mesh.vertices[e.vertices[0] as usize]).norm()
    };
    let mut chords: Vec<f64> = mesh.edges.iter().map(chord).collect();
    chords.sort_by(f64::total_cmp);
    chords.get(chords.len() / 2).copied().unwrap_or(0.0)
}

/// The edges as cubic pieces: points and derivatives at equispaced parameters.
struct EdgeCurves {
    /// For each edge the joints from first vertex to second: points, and derivatives over a piece.
    joints: Vec<Vec<(Point, Vector)>>,
}

impl EdgeCurves {
    fn new(mesh: &HighOrderMesh) -> Self {
        // A cubic piece for each two orders is exact to order 3 and indistinguishable above.
        let pieces = if mesh.order == 1 { 1 } else { mesh.order.div_ceil(2) };
        let joints: Vec<f64> = (0..=pieces).map(|k| 2.0 * k as f64 / pieces as f64 - 1.0).collect();
        let interpolation = Interpolation::new(mesh.reference_nodes.clone());
        let (values, slopes) = (interpolation.matrix(&joints), interpolation.derivative_matrix(&joints));
        let row = mesh.order + 1;
        let n = mesh.order;
        let mut all = vec![Vec::new(); mesh.edges.len()];
        for (e, edges) in mesh.element_edges.iter().enumerate() {
            let nodes = &mesh.nodes[e * row * row..(e + 1) * row * row];
            for side in 0..4 {
                let id = edges[side] as usize;
                if !all[id].is_empty() {
                    continue;
                }
                let forward = mesh.edges[id].vertices[0] == mesh.elements[e][side];
                let edge: Vec<Point> = (0..=n)
                    .map(|k| {
                        let k = if forward { k } else { n - k };
                        let (i, j) = [(k, 0), (n, k), (n - k, n), (0, n - k)][side];
                        nodes[j * row + i]
                    })
                    .collect();
                all[id] = joint_data(&edge, &values, &slopes, 2.0 / pieces as f64);
            }
        }
        EdgeCurves { joints: all }
    }

    /// Derivative with which an edge leaves its first vertex, or (reversed) its second.
    fn leaving(&self, edge: usize, first: bool) -> Vector {
        let joints = &self.joints[edge];
        let end = if first { joints.first() } else { joints.last() };
        end.map_or(Vector::zeros(), |(_, d)| if first { *d } else { -*d })
    }

    /// Adds an edge to a path, after a move to its start if `begin`.
    fn append(&self, edge: usize, forward: bool, begin: bool, path: &mut Path) {
        let joints = &self.joints[edge];
        let count = joints.len();
        let joint = |k: usize| {
            if forward {
                joints[k]
            } else {
                let (p, d) = joints[count - 1 - k];
                (p, -d)
            }
        };
        if count == 0 {
            return;
        }
        if begin {
            path.move_to(joint(0).0);
        }
        for k in 1..count {
            let ((a, leaving), (b, arriving)) = (joint(k - 1), joint(k));
            path.hermite_to(a, leaving, b, arriving);
        }
    }
}

fn joint_data(
    edge: &[Point],
    values: &DMatrix<f64>,
    slopes: &DMatrix<f64>,
    piece: f64,
) -> Vec<(Point, Vector)> {
    let combine =
        |m: &DMatrix<f64>, k: usize| -> Vector { (0..edge.len()).map(|i| edge[i].coords * m[(k, i)]).sum() };
    (0..values.nrows()).map(|k| (Point::from(combine(values, k)), combine(slopes, k) * piece)).collect()
}
