//! Tolerances that take many more edges than the shape does: a mesh for a looser one, and its division at the boundary.
//!
//! A layout whose boundary edges are many times shorter than what they bound is a bundle of slivers that cross the
//! domain, and untangling them may fail. Few elements for a tolerance at which the shape decides are soon valid. Their
//! boundary edges are divided where they break the tolerance, inside their elements, so that the mesh grows with the
//! number of edges: two elements for each one more.
//!
//! *In:* a mesh and the tolerance. *Out:* wide elements divided with their chords ([`divide_wide`]), rows put along
//! stretches that many edges of need division ([`layered`]), and edges divided once ([`divide_boundary`]): the last two
//! in turn until nothing is left, with smoothing in between.

use super::divide::divide_chords;
use super::inside::divide_inside;
use super::layer::insert_layer;
use super::pieces::{greedy, growth};
use super::{least_pieces, SizeLimit};
use crate::domain::{Boundary, Chain, Span};
use crate::error::Result;
use crate::mesh::{BoundaryError, BoundaryTolerance, Edge, QuadMesh};
use crate::numerics::tolerances::EDGE_TURN;

/// Edges that the tolerance takes for each one that the shape takes above which a looser one comes first. At order 5
/// and a relative tolerance of 1e-5 domains have 0.5 to 1.
const MOST_FOR_SHAPE: f64 = 2.0;
/// The same that the looser one takes at most.
const FIRST_FOR_SHAPE: f64 = 1.0;
/// The same, both for one, where a mesh at once has come out poor.
const SOONER_FOR_SHAPE: f64 = 0.8;
/// Edges of all chains that a mesh has at once however few the shape takes ...
const NOT_MANY_EDGES: f64 = 100.0;
/// ... and that the looser tolerance may take.
const FEW_EDGES: f64 = 12.0;
/// Most steps in which the looser tolerance is found ...
const MOST_STEPS: usize = 60;
/// ... and how many times the edges that are too many each step is made for: to come down by one edge takes steps
/// without end.
const STEP_AMPLE: f64 = 1.01;
/// Length of a boundary edge, in depths of its element, above which it is divided with its chord.
const WIDE: f64 = 4.0;
/// Rounds of that: parts of curved elements may be wide again.
const WIDE_ROUNDS: usize = 3;
/// Most parts of one edge that are counted: more are for several divisions.
const MOST_PARTS: u32 = 64;
/// Most equal parts that come of one division in three and the next: where it takes more, thirds of thirds will do.
const MOST_EQUAL: u32 = 9;
/// The common error of parts is looked for down to this share of the tolerance ...
const LEAST_LEVEL: f64 = 100.0;
/// ... to this ratio.
const LEVEL_RATIO: f64 = 1.1;

/// What elements are made for first: `tolerance` itself, or a looser one that takes few edges, if `tolerance` takes
/// many more than the turns of the boundary do; `sooner`: if it takes about as many.
///
/// # Errors
/// As [`least_pieces`].
pub fn first_tolerance(
    boundary: &Boundary,
    tolerance: &BoundaryTolerance,
    sooner: bool,
) -> Result<BoundaryTolerance> {
    let shape: f64 = boundary.chains.iter().map(edges_for_shape).sum();
    let [most, few] = if sooner {
        [FEW_EDGES.max(SOONER_FOR_SHAPE * shape); 2]
    } else {
        [NOT_MANY_EDGES.max(MOST_FOR_SHAPE * shape), FEW_EDGES.max(FIRST_FOR_SHAPE * shape)]
    };
    let count = |tolerance: &BoundaryTolerance| -> Result<f64> {
        let error = BoundaryError::new(*tolerance);
        let pieces = boundary.chains.iter().map(|chain| least_pieces(chain, &error));
        Ok(pieces.sum::<Result<usize>>()? as f64)
    };
    let mut first = *tolerance;
    let mut now = count(&first)?;
    if now <= most {
        return Ok(first);
    }
    let growth = growth(&BoundaryError::new(first));
    for _ in 0..MOST_STEPS {
        if now <= few {
            break;
        }
        // As on a smooth curve.
        first.value *= (STEP_AMPLE * now / few).powf(growth);
        now = count(&first)?;
    }
    Ok(first)
}

/// Edges that the turns of a chain take.
fn edges_for_shape(chain: &Chain) -> f64 {
    let samples = &chain.samples;
    let turn: f64 =
        samples.windows(2).map(|w| 0.5 * (w[0].curvature + w[1].curvature).abs() * (w[1].s - w[0].s)).sum();
    1.0 + turn / EDGE_TURN
}

/// Which boundary edges break the tolerance.
fn breaking(mesh: &QuadMesh, boundary: &Boundary, error: &BoundaryError) -> Vec<bool> {
    mesh.edges.iter().map(|e| e.span.is_some_and(|span| error.ratio(boundary, span) > 1.0)).collect()
}

/// `mesh` with boundary edges that break the tolerance, and are much longer than their elements are deep, divided with
/// their chords. `order` as for [`divide_chords`].
///
/// # Errors
/// [`Error::Layout`](crate::Error::Layout) when the mesh is defective.
pub fn divide_wide(
    mut mesh: QuadMesh,
    boundary: &Boundary,
    error: &BoundaryError,
    order: usize,
) -> Result<QuadMesh> {
    let any = |_| 1.0;
    for _ in 0..WIDE_ROUNDS {
        let lengths = SizeLimit::new(&any).ratios(&mesh);
        let breaks = breaking(&mesh, boundary, error);
        let wanted = |(e, edge): (u32, &Edge)| {
            let (Some(span), true) = (edge.span, breaks[e as usize]) else { return 1 };
            let quad = edge.quads[0] as usize;
            let side = mesh.quad_edges[quad].iter().position(|own| *own == e).unwrap_or(0);
            let depth = lengths[quad][1 - side % 2];
            let wide = ((span.end - span.start) / (WIDE * depth)) as u32 + 1;
            wide.min(parts(span, boundary, error))
        };
        let wanted: Vec<u32> = (0u32..).zip(&mesh.edges).map(wanted).collect();
        if wanted.iter().all(|n| *n == 1) {
            break;
        }
        mesh = divide_chords(&mesh, boundary, &wanted, order)?;
    }
    Ok(mesh)
}

/// `mesh` with a row of elements along every stretch of boundary of which more than `share` breaks the tolerance.
/// `order` as for [`divide_chords`].
///
/// # Errors
/// [`Error::Layout`](crate::Error::Layout) when the mesh is defective.
pub fn layered(
    mesh: &QuadMesh,
    boundary: &Boundary,
    error: &BoundaryError,
    share: f64,
    order: usize,
) -> Result<QuadMesh> {
    insert_layer(mesh, boundary, &breaking(mesh, boundary, error), share, order)
}

/// `mesh` with every boundary edge divided in three, inside its element, that breaks the tolerance; `None` if none
/// does. `even`: for symmetric meshes, where an edge and its image have to be divided alike; else where the parts that
/// the tolerance takes at last will end. `order` as for [`divide_chords`].
///
/// # Errors
/// [`Error::Layout`](crate::Error::Layout) when the mesh is defective.
pub fn divide_boundary(
    mesh: &QuadMesh,
    boundary: &Boundary,
    error: &BoundaryError,
    even: bool,
    order: usize,
) -> Result<Option<QuadMesh>> {
    let breaks = breaking(mesh, boundary, error);
    if !breaks.contains(&true) {
        return Ok(None);
    }
    let cut = |(edge, breaks): (&Edge, &bool)| {
        edge.span.filter(|_| *breaks).map(|span| {
            let ends =
                if even { equal_parts(span, boundary, error) } else { odd_parts(span, boundary, error) };
            ends.and_then(|ends| thirds(&ends))
                .unwrap_or_else(|| [1.0, 2.0].map(|k| span.start + (span.end - span.start) * k / 3.0))
        })
    };
    let cuts: Vec<Option<[f64; 2]>> = mesh.edges.iter().zip(&breaks).map(cut).collect();
    divide_inside(mesh, boundary, &cuts, order).map(Some)
}

/// The ends among `ends`, of an odd number of parts, that leave odd numbers of them and about thirds of the length.
fn thirds(ends: &[f64]) -> Option<[f64; 2]> {
    let last = ends.len() - 1;
    let near = |from: usize, to: usize, share: f64| {
        let at = ends[0] + share * (ends[last] - ends[0]);
        let off = |k: &usize| (ends[*k] - at).abs();
        (from..to).step_by(2).min_by(|a, b| off(a).total_cmp(&off(b)))
    };
    let first = near(1, last - 1, 1.0 / 3.0)?;
    let second = near(first + 1, last, 2.0 / 3.0)?;
    Some([ends[first], ends[second]])
}

/// The ends of as few parts of `span` as keep the tolerance, or one more: an odd number, of about one error.
fn odd_parts(span: Span, boundary: &Boundary, error: &BoundaryError) -> Option<Vec<f64>> {
    let chain = &boundary.chains[span.chain as usize];
    let at = |level: f64, most: usize| greedy(chain, error, span.start, span.end, level, most);
    let mut high = error.tolerance.value;
    let mut ends = at(high, usize::MAX)?;
    let parts = (ends.len() - 1) | 1;
    // The greedy last part is what is left over: with less error for each it is as long as the others.
    let mut low = high / LEAST_LEVEL;
    while high / low > LEVEL_RATIO {
        let middle = (high * low).sqrt();
        match at(middle, parts) {
            Some(found) => (high, ends) = (middle, found),
            None => low = middle,
        }
    }
    while ends.len() <= parts {
        let length = |i: &usize| ends[*i + 1] - ends[*i];
        let longest = (0..ends.len() - 1).max_by(|a, b| length(a).total_cmp(&length(b)))?;
        ends.insert(longest + 1, 0.5 * (ends[longest] + ends[longest + 1]));
    }
    Some(ends)
}

/// The ends of the least odd number of equal parts of `span` that keep the tolerance; `None` if these are many.
fn equal_parts(span: Span, boundary: &Boundary, error: &BoundaryError) -> Option<Vec<f64>> {
    let n = parts(span, boundary, error) | 1;
    let at = |k: u32| span.start + (span.end - span.start) * f64::from(k) / f64::from(n);
    (n <= MOST_EQUAL).then(|| (0..=n).map(at).collect())
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
        n = (guess as u32).max(n + 1 + n / 8).min(MOST_PARTS);
        now = largest(n);
    }
    n
}
