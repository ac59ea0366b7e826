//! The paper's step 8: Laplacian smoothing combined with equal spacing, guarded.
//!
//! References: S. Canann, J. Tristano, M. Staten, *An approach to combined Laplacian and
//! optimization-based smoothing for triangular, quadrilateral, and quad-dominant meshes*, 7th International
//! Meshing Roundtable, 1998 (a move is made only if the elements beside it allow it).

use super::Optimiser;
use crate::domain::{BoundaryPoint, Place, Span};
use crate::mesh::{QuadMesh, Vertex};
use crate::numerics::{Point, Vector, NONE};

/// Share of an element's scaled Jacobian that one move may cost.
const LEAST_SHARE: f64 = 0.7;
/// Scaled Jacobians above this count as equally good: a grid of rectangles could not move else.
const GOOD: f64 = 0.5;
/// Shares of the move that are tried.
const SHARES: [f64; 3] = [1.0, 0.5, 0.25];
/// Moves below this share of the shortest edge are not worth measuring.
const STILL: f64 = 1e-4;

/// The surroundings of one vertex.
#[derive(Debug, Clone, Default)]
struct Star {
    edges: Vec<u32>,
    quads: Vec<u32>,
}

/// Moves vertices, one after another in `sweeps` sweeps, to the mean of their neighbours and, where four
/// edges meet, to equal distance from opposite neighbours; boundary vertices to the middle of theirs along
/// the curve. A move stands only if no element beside it gets worse than the mesh's worst, loses
/// more than a part of its quality, or leaves the tolerance. Edges keep their shape relative to
/// their chord. Returns the number of moves made.
pub fn equal_spacing(optimiser: &Optimiser, mesh: &mut QuadMesh, sweeps: usize) -> usize {
    let worst = optimiser.quality(mesh).min_scaled_jacobian.min(GOOD);
    let mut stars = vec![Star::default(); mesh.vertices.len()];
    for (e, edge) in mesh.edges.iter().enumerate() {
        edge.vertices.iter().for_each(|v| stars[*v as usize].edges.push(e as u32));
    }
    for (q, quad) in mesh.quads.iter().enumerate() {
        quad.iter().for_each(|v| stars[*v as usize].quads.push(q as u32));
    }
    let mut moves = 0;
    for _ in 0..sweeps {
        let before = moves;
        for (v, star) in stars.iter().enumerate() {
            moves += usize::from(relax(optimiser, mesh, v as u32, star, worst));
        }
        if moves == before {
            break;
        }
    }
    moves
}

/// Tries one vertex; whether it moved.
fn relax(optimiser: &Optimiser, mesh: &mut QuadMesh, v: u32, star: &Star, worst: f64) -> bool {
    let old = mesh.vertices[v as usize];
    let spans: Vec<Option<Span>> = star.edges.iter().map(|e| mesh.edges[*e as usize].span).collect();
    let state = |mesh: &QuadMesh| {
        let q = optimiser.quality_of(mesh, Some(&star.quads));
        (q.min_scaled_jacobian, q.error_ratio)
    };
    let shortest = star.edges.iter().map(|e| chord(mesh, *e).norm()).fold(f64::INFINITY, f64::min) * STILL;
    let now = state(mesh);
    let attempt = |mesh: &mut QuadMesh, apply: &dyn Fn(&mut QuadMesh, f64)| {
        for share in SHARES {
            apply(mesh, share);
            if allowed(now, state(mesh), worst) {
                return true;
            }
            mesh.vertices[v as usize] = old;
            for (e, span) in star.edges.iter().zip(&spans) {
                mesh.edges[*e as usize].span = *span;
            }
        }
        false
    };
    match old.place {
        Place::Interior => {
            let step = interior_target(mesh, v, star) - old.point;
            step.norm() > shortest
                && attempt(mesh, &|mesh, share| mesh.vertices[v as usize].point = old.point + step * share)
        }
        Place::Boundary(BoundaryPoint { chain, s }) => {
            let [Some(into), Some(out)] = boundary_edges(mesh, v, star) else { return false };
            let length = |e: u32| mesh.edges[e as usize].span.map_or(0.0, |s| s.end - s.start);
            let shift = 0.5 * (length(out) - length(into));
            let chain_of = &optimiser.boundary().chains[chain as usize];
            shift.abs() > shortest
                && attempt(mesh, &|mesh, share| {
                    let shift = share * shift;
                    let s = chain_of.wrap(s + shift);
                    let place = Place::Boundary(BoundaryPoint { chain, s });
                    mesh.vertices[v as usize] = Vertex { place, point: chain_of.point(s) };
                    if let Some(span) = &mut mesh.edges[into as usize].span {
                        span.end += shift;
                    }
                    if let Some(span) = &mut mesh.edges[out as usize].span {
                        let length = span.end - span.start - shift;
                        (span.start, span.end) = (s, s + length);
                    }
                })
        }
        Place::Junction(_) => false,
    }
}

/// (scaled Jacobian, error ratio) before and after a move.
fn allowed(now: (f64, f64), then: (f64, f64), worst: f64) -> bool {
    let shape = then.0 >= now.0 || (then.0 >= worst && then.0 >= LEAST_SHARE * now.0.min(GOOD));
    shape && (then.1 <= 1.0 || then.1 <= now.1)
}

fn chord(mesh: &QuadMesh, edge: u32) -> Vector {
    let [a, b] = mesh.edges[edge as usize].vertices.map(|v| mesh.vertices[v as usize].point);
    b - a
}

/// The boundary edges that end and start at `v`.
fn boundary_edges(mesh: &QuadMesh, v: u32, star: &Star) -> [Option<u32>; 2] {
    [1, 0].map(|end| {
        star.edges.iter().copied().find(|e| {
            let edge = &mesh.edges[*e as usize];
            edge.quads[1] == NONE && edge.vertices[end] == v
        })
    })
}

/// Mean of the neighbours; where four edges meet, half way between it and the equally spaced point.
fn interior_target(mesh: &QuadMesh, v: u32, star: &Star) -> Point {
    let at = mesh.vertices[v as usize].point;
    let arms: Vec<Vector> = star
        .edges
        .iter()
        .map(|e| {
            let edge = &mesh.edges[*e as usize];
            let other = edge.vertices[usize::from(edge.vertices[0] == v)];
            mesh.vertices[other as usize].point - at
        })
        .collect();
    let mean = arms.iter().sum::<Vector>() / arms.len() as f64;
    if arms.len() != 4 {
        return at + mean;
    }
    // Opposite edges share no quad.
    let quads = |i: usize| mesh.edges[star.edges[i] as usize].quads;
    let opposite = (1..4).find(|i| quads(*i).iter().all(|q| !quads(0).contains(q)));
    let Some(opposite) = opposite else { return at + mean };
    let mut others = (1..4).filter(|i| *i != opposite);
    let pairs = [(0, opposite), (others.next().unwrap_or(1), others.next().unwrap_or(2))];
    let mut spacing = Vector::zeros();
    for (i, j) in pairs {
        let along = arms[j] - arms[i];
        if along.norm() > 0.0 {
            spacing += along.normalize() * (0.5 * (arms[j].norm() - arms[i].norm()));
        }
    }
    at + (mean + spacing) * 0.5
}
