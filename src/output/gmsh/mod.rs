//! Gmsh meshes (`.msh`), version 4.1, text, orders 1 to 10.
//!
//! Nodes are equispaced in Gmsh, so the mesh's Gauss-Lobatto nodes are interpolated anew; that
//! changes the curves by rounding only. A node that elements share is written once. The file has the
//! topology of the domain: one surface, one curve for each run of boundary edges of one name along a
//! loop (`runs`), and a point where two such runs meet. Physical groups: the surface, named
//! `domain`, with tag 1, and the curves of each boundary, with the boundary's name and its number
//! from 1 as tag. Elements: one line for each boundary edge, the domain to its left, and the quadrilaterals.
//!
//! Reference: Gmsh's manual, *MSH file format*, *Node ordering*, *High-order elements*.

mod node_order;
mod runs;

pub use node_order::{line_order, quadrilateral_order};

use super::equispaced::EquispacedNodes;
use super::labels;
use crate::mesh::HighOrderMesh;
use crate::numerics::{Point, NONE};
use runs::{boundary_runs, Run};
use std::fmt::Write;

/// Gmsh's numbers of the line elements of order 1 to 10.
const LINES: [u32; 10] = [1, 8, 26, 27, 28, 62, 63, 64, 65, 66];
/// Gmsh's numbers of the complete quadrilaterals of order 1 to 10.
const QUADRILATERALS: [u32; 10] = [3, 10, 36, 37, 38, 47, 48, 49, 50, 51];
/// The highest order that has a number.
pub const HIGHEST_ORDER: usize = QUADRILATERALS.len();
/// Gmsh reads this many bytes of a physical name.
const LONGEST_NAME: usize = 127;

/// The file's content; the mesh's order is 1 to [`HIGHEST_ORDER`].
pub fn render(mesh: &HighOrderMesh) -> Vec<u8> {
    let nodes = EquispacedNodes::new(mesh);
    let runs = boundary_runs(mesh);
    let mut text = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    physical_names(&mut text, &mesh.boundary_names);
    let corners = corner_points(&runs);
    entities(&mut text, mesh, &nodes, &runs, &corners);
    write_nodes(&mut text, mesh, &nodes, &runs, &corners);
    elements(&mut text, mesh, &nodes, &runs);
    text.into_bytes()
}

/// The vertices at which runs start and end, ascending; the k-th is point k + 1.
fn corner_points(runs: &[Run]) -> Vec<u32> {
    let mut corners: Vec<u32> = runs.iter().filter_map(|r| r.ends).flatten().collect();
    corners.sort_unstable();
    corners.dedup();
    corners
}

fn physical_names(text: &mut String, names: &[String]) {
    let _ = writeln!(text, "$PhysicalNames\n{}", names.len() + 1);
    for (k, name) in (1..).zip(labels::quotable(names, LONGEST_NAME)) {
        let _ = writeln!(text, "1 {k} \"{name}\"");
    }
    text.push_str("2 1 \"domain\"\n$EndPhysicalNames\n");
}

/// Numbers of the inner nodes of an edge, from its first vertex to its second.
fn inside_edge(mesh: &HighOrderMesh, edge: u32) -> std::ops::Range<u32> {
    let inside = mesh.order as u32 - 1;
    let first = mesh.vertices.len() as u32 + edge * inside;
    first..first + inside
}

/// Numbers of all nodes on a run, in order; the first one again at the end of a closed run.
fn nodes_of_run(mesh: &HighOrderMesh, run: &Run) -> Vec<u32> {
    let mut numbers = Vec::new();
    for &e in &run.edges {
        numbers.push(mesh.edges[e as usize].vertices[0]);
        numbers.extend(inside_edge(mesh, e));
    }
    numbers.extend(run.edges.last().map(|e| mesh.edges[*e as usize].vertices[1]));
    numbers
}

fn entities(text: &mut String, mesh: &HighOrderMesh, nodes: &EquispacedNodes, runs: &[Run], corners: &[u32]) {
    let _ = writeln!(text, "$Entities\n{} {} 1 0", corners.len(), runs.len());
    for (tag, &v) in (1..).zip(corners) {
        let p = mesh.vertices[v as usize];
        let _ = writeln!(text, "{tag} {:?} {:?} 0 0", p.x, p.y);
    }
    for (tag, run) in (1..).zip(runs) {
        let points = nodes_of_run(mesh, run).into_iter().map(|n| nodes.points[n as usize]);
        let _ = write!(text, "{tag} {}", bounding_box(points));
        let _ = match run.boundary {
            NONE => write!(text, " 0"),
            name => write!(text, " 1 {}", name + 1),
        };
        let _ = match run.ends {
            Some(ends) => {
                let [a, b] = ends.map(|v| corners.partition_point(|c| *c < v) + 1);
                writeln!(text, " 2 {a} -{b}")
            }
            None => writeln!(text, " 0"),
        };
    }
    let _ = write!(text, "1 {} 1 1 {}", bounding_box(nodes.points.iter().copied()), runs.len());
    for tag in 1..=runs.len() {
        let _ = write!(text, " {tag}");
    }
    text.push_str("\n$EndEntities\n");
}

fn bounding_box(points: impl Iterator<Item = Point>) -> String {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for p in points {
        for c in 0..2 {
            low[c] = low[c].min(p[c]);
            high[c] = high[c].max(p[c]);
        }
    }
    format!("{:?} {:?} 0 {:?} {:?} 0", low[0], low[1], high[0], high[1])
}

fn write_nodes(
    text: &mut String,
    mesh: &HighOrderMesh,
    nodes: &EquispacedNodes,
    runs: &[Run],
    corners: &[u32],
) {
    let count = nodes.points.len();
    let mut elsewhere = vec![true; count];
    let mut blocks: Vec<(u32, usize, Vec<u32>)> = Vec::new();
    for (tag, &v) in (1..).zip(corners) {
        elsewhere[v as usize] = false;
        blocks.push((0, tag, vec![v]));
    }
    for (tag, run) in (1..).zip(runs) {
        let mut own = nodes_of_run(mesh, run);
        own.pop();
        own.retain(|n| std::mem::replace(&mut elsewhere[*n as usize], false));
        if !own.is_empty() {
            blocks.push((1, tag, own));
        }
    }
    let rest: Vec<u32> = (0..count as u32).filter(|n| elsewhere[*n as usize]).collect();
    if !rest.is_empty() {
        blocks.push((2, 1, rest));
    }
    let _ = writeln!(text, "$Nodes\n{} {count} 1 {count}", blocks.len());
    for (dimension, tag, own) in blocks {
        let _ = writeln!(text, "{dimension} {tag} 0 {}", own.len());
        for n in &own {
            let _ = writeln!(text, "{}", n + 1);
        }
        for n in &own {
            let p = nodes.points[*n as usize];
            let _ = writeln!(text, "{:?} {:?} 0", p.x, p.y);
        }
    }
    text.push_str("$EndNodes\n");
}

fn elements(text: &mut String, mesh: &HighOrderMesh, nodes: &EquispacedNodes, runs: &[Run]) {
    let n = mesh.order;
    let row = n + 1;
    let lines: usize = runs.iter().map(|r| r.edges.len()).sum();
    let count = lines + mesh.elements.len();
    let _ = writeln!(text, "$Elements\n{} {count} 1 {count}", runs.len() + 1);
    let mut tag = 0;
    let mut element = |text: &mut String, nodes: &mut dyn Iterator<Item = u32>| {
        tag += 1;
        let _ = write!(text, "{tag}");
        for node in nodes {
            let _ = write!(text, " {}", node + 1);
        }
        text.push('\n');
    };
    for (entity, run) in (1..).zip(runs) {
        let _ = writeln!(text, "1 {entity} {} {}", LINES[n - 1], run.edges.len());
        for &e in &run.edges {
            let [a, b] = mesh.edges[e as usize].vertices;
            let along: Vec<u32> = std::iter::once(a).chain(inside_edge(mesh, e)).chain([b]).collect();
            element(text, &mut line_order(n).into_iter().map(|k| along[k]));
        }
    }
    let order = quadrilateral_order(n);
    let _ = writeln!(text, "2 1 {} {}", QUADRILATERALS[n - 1], mesh.elements.len());
    for own in nodes.numbers.chunks_exact(row * row) {
        element(text, &mut order.iter().map(|(i, j)| own[j * row + i]));
    }
    text.push_str("$EndElements\n");
}
