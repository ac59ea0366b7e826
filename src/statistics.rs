//! The numbers of one run, for tables and statistics files.

mod json;

use crate::domain::Boundary;
use crate::error::Result;
use crate::mesh::{irregularity_bound, quads_by_table, scaled_jacobian_ceiling, HighOrderMesh, Irregular};
use crate::numerics::tolerances::JOIN;
use crate::numerics::{Point, NONE};
use crate::progress::Stage;
use crate::stages::{Round, Stages, SymmetryReport};

/// A distribution of a quality measure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distribution {
    pub min: f64,
    /// The first percentile.
    pub p1: f64,
    pub mean: f64,
}

/// The error of boundary edges, in the chosen norm and the caller's unit.
#[derive(Debug, Clone, PartialEq)]
pub struct LoopErrors {
    /// The largest of all edges.
    pub max: f64,
    /// The largest of each loop's edges, the outer loop first.
    pub loops: Vec<f64>,
}

/// The numbers of one run. What was not reached is `None`.
#[derive(Debug, Clone, PartialEq)]
pub struct Statistics {
    /// `ok`, or the error's [name](crate::Error::name).
    pub status: &'static str,
    /// The error in words.
    pub message: Option<String>,
    /// Where it happened, in the caller's coordinates.
    pub place: Option<Point>,
    /// Seconds in each stage, in running order.
    pub stage_seconds: [(Stage, f64); 9],
    /// Seconds from start to end.
    pub total_seconds: f64,
    /// Triangles of the base mesh.
    pub triangles: Option<usize>,
    /// Interior singularities.
    pub singularities: Option<usize>,
    pub separatrices: Option<usize>,
    /// Regions of the T-mesh.
    pub blocks: Option<usize>,
    pub elements: Option<usize>,
    pub order: Option<usize>,
    /// Different nodes of the finished mesh.
    pub nodes: Option<usize>,
    pub irregular: Option<Irregular>,
    /// How many irregular vertices the domain lets expect.
    pub irregular_expected: Option<usize>,
    pub scaled_jacobian: Option<Distribution>,
    /// The best scaled Jacobian that the domain allows.
    pub scaled_jacobian_ceiling: Option<f64>,
    pub boundary_error: Option<LoopErrors>,
    /// The domain's symmetries and the mesh's; `None`: not looked for.
    pub symmetry: Option<SymmetryReport>,
    /// What repaired the layout: 0 nothing, 1 the paper's rules, 2 a pattern, 3 centroid stars.
    pub fallback: u8,
    /// Base mesh sizes tried.
    pub attempts: usize,
    /// The rounds of steps 7 to 9, of the last attempt.
    pub rounds: Vec<Round>,
    pub warnings: Vec<String>,
}

impl Statistics {
    /// The statistics of a run that left `stages` and ended with `result` after `total_seconds`.
    pub fn new(stages: &Stages, result: &Result<HighOrderMesh>, total_seconds: f64) -> Self {
        let mesh = result.as_ref().ok();
        let error = result.as_ref().err();
        let boundary = stages.boundary.as_deref();
        let after = |stage: Stage| stages.reached.is_some_and(|reached| reached >= stage);
        Statistics {
            status: error.map_or("ok", |e| e.name()),
            message: error.map(|e| e.to_string()),
            place: error.and_then(|e| e.place()),
            stage_seconds: std::array::from_fn(|k| (Stage::ALL[k], stages.seconds[k])),
            total_seconds,
            triangles: stages.triangulation.as_ref().map(|t| t.triangles.len()),
            singularities: after(Stage::Singularities).then_some(stages.singularities.len()),
            separatrices: after(Stage::Separatrices).then_some(stages.separatrices.len()),
            blocks: stages.block_layout.as_ref().map(|l| l.regions.len()),
            elements: mesh.map(|m| m.elements.len()),
            order: mesh.map(|m| m.order),
            nodes: mesh.map(HighOrderMesh::node_count),
            irregular: mesh.and_then(|m| Some(irregular(m, boundary?))),
            irregular_expected: boundary.map(|b| irregularity_bound(b).expected),
            scaled_jacobian: mesh.and_then(|m| Distribution::of(&m.scaled_jacobian)),
            scaled_jacobian_ceiling: boundary.map(scaled_jacobian_ceiling),
            boundary_error: mesh.map(LoopErrors::of),
            symmetry: stages.symmetry,
            fallback: stages.fallback,
            attempts: stages.attempts,
            rounds: stages.rounds.clone(),
            warnings: stages.warnings.clone(),
        }
    }
}

impl Distribution {
    /// The distribution of `values`; `None` if there are none.
    pub fn of(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let place = 0.01 * (sorted.len().checked_sub(1)?) as f64;
        let (low, high) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
        Some(Distribution {
            min: sorted[0],
            p1: low + (high - low) * place.fract(),
            mean: sorted.iter().sum::<f64>() / sorted.len() as f64,
        })
    }
}

impl LoopErrors {
    fn of(mesh: &HighOrderMesh) -> Self {
        let mut loops = Vec::new();
        for edge in mesh.edges.iter().filter(|e| e.loop_index != NONE) {
            let k = edge.loop_index as usize;
            if loops.len() <= k {
                loops.resize(k + 1, 0.0);
            }
            loops[k] = edge.error.max(loops[k]);
        }
        LoopErrors { max: loops.iter().copied().fold(0.0, f64::max), loops }
    }
}

/// Irregular vertices: inside those of valence ≠ 4; on the boundary those whose number of elements is
/// not Table 1's for the junction's angle, 2 where there is no junction.
fn irregular(mesh: &HighOrderMesh, boundary: &Boundary) -> Irregular {
    let mut count = vec![0; mesh.vertices.len()];
    for v in mesh.elements.iter().flatten() {
        count[*v as usize] += 1;
    }
    // What is expected: 4 inside, 2 on the boundary, and at junctions by the angle.
    let mut expected = vec![4; mesh.vertices.len()];
    for edge in mesh.edges.iter().filter(|e| e.loop_index != NONE) {
        for v in edge.vertices {
            expected[v as usize] = 2;
        }
    }
    let mut border: Vec<(Point, usize)> = (0..expected.len())
        .filter(|v| expected[*v] == 2)
        .map(|v| (boundary.frame.to_canonical(mesh.vertices[v]), v))
        .collect();
    border.sort_by(|a, b| a.0.x.total_cmp(&b.0.x));
    let on_border: Vec<usize> = border.iter().map(|(_, v)| *v).collect();
    for junction in &boundary.junctions {
        // The vertex that stands for it is exact; the junction may be off by a gap that was closed.
        let from = border.partition_point(|(p, _)| p.x < junction.point.x - JOIN);
        let close = border[from..].iter().take_while(|(p, _)| p.x <= junction.point.x + JOIN);
        let distance = |p: &Point| (p - junction.point).norm();
        if let Some((_, v)) = close.min_by(|a, b| distance(&a.0).total_cmp(&distance(&b.0))) {
            expected[*v] = quads_by_table(junction.angle);
        }
    }
    let boundary = on_border.iter().filter(|v| count[**v] != expected[**v]).count();
    let all = (0..count.len()).filter(|v| count[*v] != expected[*v]).count();
    Irregular { interior: all - boundary, boundary }
}
