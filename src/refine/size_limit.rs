//! The largest element size that the caller allows, and the division of what is larger.

use super::divide::{chord_parts, divide_chords, divided_quads};
use super::resolve::resolved;
use super::split_chords;
use crate::domain::Boundary;
use crate::error::{Error, Result};
use crate::mesh::{bubble_shape, QuadMesh};
use crate::numerics::tolerances::ORDER_TIE;
use crate::numerics::Point;
use std::fmt;

/// Most rounds of halving: 2^-24 of an element.
const ROUNDS: usize = 24;
/// Most rounds of division into equal parts: parts differ in length, so each round counts them anew.
const EVEN_ROUNDS: usize = 4;
/// Straight pieces that an edge's length is measured with.
const PIECES: usize = 4;

/// The largest element size allowed at a point, in the frame of the mesh.
#[derive(Clone, Copy)]
pub struct SizeLimit<'a> {
    allowed: &'a dyn Fn(Point) -> f64,
}

impl<'a> SizeLimit<'a> {
    /// `allowed` gives a length above 0 or infinity anywhere.
    pub fn new(allowed: &'a dyn Fn(Point) -> f64) -> Self {
        SizeLimit { allowed }
    }

    /// What an element where `quad` lies may measure: the harmonic mean over it, which is what the number of
    /// elements along a line, ∫ ds / h, makes of a size that varies.
    pub fn of_quad(&self, mesh: &QuadMesh, quad: u32) -> f64 {
        let [a, b, c, d] = mesh.quads[quad as usize].map(|v| mesh.vertices[v as usize].point.coords);
        let shares = [1.0 / 6.0, 0.5, 5.0 / 6.0];
        let mut sum = 0.0;
        for v in shares {
            for u in shares {
                let point = (a * (1.0 - u) + b * u) * (1.0 - v) + (d * (1.0 - u) + c * u) * v;
                sum += 1.0 / (self.allowed)(Point::from(point));
            }
        }
        (shares.len() * shares.len()) as f64 / sum
    }

    /// For each quad its mean lengths along sides 0 and 1, in sizes allowed there.
    pub(super) fn ratios(&self, mesh: &QuadMesh) -> Vec<[f64; 2]> {
        let lengths: Vec<f64> = (0..mesh.edges.len()).map(|e| length(mesh, e)).collect();
        let ratio = |(q, edges): (u32, &[u32; 4])| {
            let allowed = self.of_quad(mesh, q);
            [0, 1].map(|s| 0.5 * (lengths[edges[s] as usize] + lengths[edges[s + 2] as usize]) / allowed)
        };
        (0u32..).zip(&mesh.quad_edges).map(ratio).collect()
    }

    /// Marks an edge of every chord that crosses a quad whose mean length there is above `slack` times what is
    /// allowed.
    pub fn too_long(&self, mesh: &QuadMesh, slack: f64) -> Vec<bool> {
        let mut marked = vec![false; mesh.edges.len()];
        for (edges, ratios) in mesh.quad_edges.iter().zip(self.ratios(mesh)) {
            for s in [0, 1] {
                marked[edges[s] as usize] |= ratios[s] > slack;
            }
        }
        marked
    }

    /// Divides chords into as many equal parts as it takes for no quad to be longer than `slack` times what is
    /// allowed. For sizes that vary little: all of a chord is divided alike. `order` as for [`split_chords`].
    ///
    /// With a `size`, the same everywhere, chords get more parts where their elements' maps follow solutions worse
    /// than squares of that size do.
    ///
    /// # Errors
    /// [`Error::Layout`] when the mesh is defective, or would have more than `most` quads.
    pub fn divide_evenly(
        &self,
        mesh: QuadMesh,
        boundary: &Boundary,
        slack: f64,
        order: usize,
        most: usize,
        size: Option<f64>,
    ) -> Result<QuadMesh> {
        let slack = slack * (1.0 + ORDER_TIE);
        let mut wanted = vec![1u32; mesh.edges.len()];
        // What was measured last: the quads of each quad of `mesh` follow each other.
        let mut ratios = self.ratios(&mesh);
        let mut finer = None;
        for _ in 0..EVEN_ROUNDS {
            if ratios.iter().flatten().all(|ratio| *ratio <= slack) {
                break;
            }
            let now = chord_parts(&mesh, &wanted);
            let mut next = 0;
            for edges in &mesh.quad_edges {
                let parts = [0, 1].map(|s| now[edges[s] as usize]);
                let own = &ratios[next..next + parts[0] as usize * parts[1] as usize];
                next += own.len();
                for s in [0, 1] {
                    let longest = own.iter().map(|r| r[s]).fold(0.0, f64::max) / slack;
                    let more = (f64::from(parts[s]) * longest).ceil() as u32;
                    wanted[edges[s] as usize] = wanted[edges[s] as usize].max(more);
                }
            }
            let parts = chord_parts(&mesh, &wanted);
            let quads = divided_quads(&mesh, &parts);
            if quads > most as f64 {
                let reason = format!("the sizes asked for take {quads:.0} elements or more, above {most}");
                return Err(Error::Layout { reason, at: None });
            }
            let divided = divide_chords(&mesh, boundary, &parts, order)?;
            ratios = self.ratios(&divided);
            finer = Some(divided);
        }
        if let Some(size) = size {
            let parts = chord_parts(&mesh, &wanted);
            let more = resolved(&mesh, boundary, &parts, order, size, most);
            if more != parts {
                finer = Some(divide_chords(&mesh, boundary, &more, order)?);
            }
        }
        Ok(finer.unwrap_or(mesh))
    }

    /// Halves what is too long, with whole chords, until nothing is or there are `most` quads. `order` as for
    /// [`split_chords`].
    ///
    /// # Errors
    /// [`Error::Layout`] when the mesh is defective.
    pub fn divide(
        &self,
        mesh: QuadMesh,
        boundary: &Boundary,
        slack: f64,
        order: usize,
        most: usize,
    ) -> Result<QuadMesh> {
        let mut mesh = mesh;
        for _ in 0..ROUNDS {
            let marked = self.too_long(&mesh, slack);
            if !marked.contains(&true) || mesh.quads.len() > most {
                break;
            }
            mesh = split_chords(&mesh, boundary, &marked, order)
                .map_err(|(reason, at)| Error::Layout { reason, at: Some(at) })?;
        }
        Ok(mesh)
    }
}

/// Length of an edge.
fn length(mesh: &QuadMesh, e: usize) -> f64 {
    let edge = &mesh.edges[e];
    if let Some(span) = edge.span {
        return span.end - span.start;
    }
    let [a, b] = edge.vertices.map(|v| mesh.vertices[v as usize].point);
    if edge.bubbles.is_empty() {
        return (b - a).norm();
    }
    let point = |k: usize| {
        let share = k as f64 / PIECES as f64;
        a + (b - a) * share + bubble_shape(&edge.bubbles, 2.0 * share - 1.0)
    };
    (0..PIECES).map(|k| (point(k + 1) - point(k)).norm()).sum()
}

impl fmt::Debug for SizeLimit<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("SizeLimit")
    }
}

impl PartialEq for SizeLimit<'_> {
    /// Whether both are the same function.
    fn eq(&self, other: &Self) -> bool {
        std::ptr::addr_eq(self.allowed, other.allowed)
    }
}
