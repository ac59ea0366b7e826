//! Tolerances that take many more edges than the shape does: a mesh for a looser one, and its division.
//!
//! A layout whose boundary edges are many times shorter than what they bound is a bundle of slivers that cross the
//! domain, and untangling them may fail. Few elements for a tolerance at which the shape decides are soon valid, and
//! parts of valid elements stay so: their boundaries move by no more than the looser tolerance.

use super::divide::{chord_parts, divided_quads};
use super::pieces::growth;
use super::{divide_chords, least_pieces, subdivide};
use crate::domain::{Boundary, Chain, Span};
use crate::error::Result;
use crate::mesh::{BoundaryError, BoundaryTolerance, Edge, QuadMesh};
use crate::numerics::tolerances::EDGE_TURN;

/// Edges that the tolerance takes for each one that the shape takes above which a looser one comes first. At order 5
/// and a relative tolerance of 1e-5 domains have 0.5 to 1.
const MOST_FOR_SHAPE: f64 = 2.0;
/// The same that the first of several tolerances takes at most.
const FIRST_FOR_SHAPE: f64 = 1.2;
/// Edges of all chains that are few however many the shape takes.
const FEW_EDGES: f64 = 100.0;
/// Least number of edges for each one of the next looser tolerance: a step to fewer is not worth its work.
const WORTH: f64 = 1.4;
/// Most of them: a little more than the two that steps are made for on smooth curves.
const MOST_STEP: f64 = 2.2;
/// Times that a step is made shorter.
const SHORTENINGS: usize = 5;
/// Most tolerances one after the other.
const MOST_STEPS: usize = 30;
/// Most divisions for one tolerance: on curves with knots more edges may be worse ones.
const ROUNDS: usize = 12;
/// Quads above which equal parts are not compared with halving, which is made step by step.
const MOST_COMPARED: usize = 50_000;
/// Most parts of one edge in a division.
const MOST_PARTS: u32 = 64;

/// The tolerances that a mesh should keep one after the other, the last one `tolerance` itself: the only one unless it
/// takes many more edges than the turns of the boundary do. Each takes about twice the edges of the one before.
///
/// # Errors
/// As [`least_pieces`].
pub fn tolerance_steps(boundary: &Boundary, tolerance: &BoundaryTolerance) -> Result<Vec<BoundaryTolerance>> {
    let shape: f64 = boundary.chains.iter().map(edges_for_shape).sum();
    let [most, few] = [MOST_FOR_SHAPE, FIRST_FOR_SHAPE].map(|share| FEW_EDGES.max(share * shape));
    let count = |tolerance: &BoundaryTolerance| -> Result<f64> {
        let error = BoundaryError::new(*tolerance);
        let pieces = boundary.chains.iter().map(|chain| least_pieces(chain, &error));
        Ok(pieces.sum::<Result<usize>>()? as f64)
    };
    let mut steps = vec![*tolerance];
    let mut before = count(tolerance)?;
    if before <= most {
        return Ok(steps);
    }
    // As many steps as needed, all alike, so that the first is hardly looser than it has to be.
    let halvings = (before / few).log2();
    let factor = (halvings / halvings.ceil() * growth(&BoundaryError::new(*tolerance))).exp2();
    let mut looser = *tolerance;
    for _ in 0..MOST_STEPS {
        let (mut exponent, mut next, mut now) = (1.0, looser, before);
        for _ in 0..SHORTENINGS {
            next.value = looser.value * factor.powf(exponent);
            now = count(&next)?;
            if now * MOST_STEP >= before {
                break;
            }
            // Knots take edges that a little more tolerance does without.
            exponent *= 0.5;
        }
        looser = next;
        // Curves with knots may lose fewer edges than smooth ones, too: what loses few is passed over.
        if now <= few || now * WORTH < before {
            steps.push(looser);
            before = now;
        }
        if now <= few {
            break;
        }
    }
    steps.reverse();
    Ok(steps)
}

/// Edges that the turns of a chain take.
fn edges_for_shape(chain: &Chain) -> f64 {
    let samples = &chain.samples;
    let turn: f64 =
        samples.windows(2).map(|w| 0.5 * (w[0].curvature + w[1].curvature).abs() * (w[1].s - w[0].s)).sum();
    1.0 + turn / EDGE_TURN
}

/// `mesh` with chords divided until every boundary edge keeps the tolerance: into equal parts, which smooth curves
/// need, or by halving, which leaves fewer where knots take short edges; whichever makes fewer quads. `order` as for
/// [`divide_chords`].
///
/// # Errors
/// [`Error::Tolerance`](crate::Error::Tolerance) with the worst edge's place when both take more than `most` quads;
/// [`Error::Layout`](crate::Error::Layout) when the mesh is defective.
pub fn divide_to_tolerance(
    mesh: QuadMesh,
    boundary: &Boundary,
    error: &BoundaryError,
    order: usize,
    most: usize,
) -> Result<QuadMesh> {
    match divide_equally(mesh.clone(), boundary, error, order, most)? {
        None => subdivide(mesh, boundary, error, most),
        Some(equal) if equal.quads.len() > MOST_COMPARED => Ok(equal),
        Some(equal) => Ok(subdivide(mesh, boundary, error, equal.quads.len() - 1).unwrap_or(equal)),
    }
}

/// The same into equal parts; `None` if that takes more than `most` quads.
fn divide_equally(
    mut mesh: QuadMesh,
    boundary: &Boundary,
    error: &BoundaryError,
    order: usize,
    most: usize,
) -> Result<Option<QuadMesh>> {
    for _ in 0..ROUNDS {
        let wanted = |e: &Edge| e.span.map_or(1, |span| parts(span, boundary, error));
        let wanted: Vec<u32> = mesh.edges.iter().map(wanted).collect();
        if wanted.iter().all(|n| *n == 1) {
            return Ok(Some(mesh));
        }
        let parts = chord_parts(&mesh, &wanted);
        if divided_quads(&mesh, &parts) > most as f64 {
            break;
        }
        mesh = divide_chords(&mesh, boundary, &parts, order)?;
    }
    Ok(None)
}

/// Equal parts of `span` of which each keeps the tolerance.
fn parts(span: Span, boundary: &Boundary, error: &BoundaryError) -> u32 {
    let chain = &boundary.chains[span.chain as usize];
    let exponent = 1.0 / growth(error);
    let largest = |n: u32| {
        let at = |k: u32| span.start + (span.end - span.start) * f64::from(k) / f64::from(n);
        (0..n).map(|k| error.of_chain(chain, at(k), at(k + 1))).fold(0.0, f64::max) / error.tolerance.value
    };
    let mut n = 1;
    let mut now = largest(n);
    while now > 1.0 && n < MOST_PARTS {
        let guess = f64::from(n) * now.powf(exponent);
        n = (guess as u32).clamp(n + 1 + n / 8, MOST_PARTS);
        now = largest(n);
    }
    n
}
