//! The largest element size that the caller allows, and the division of what is larger.

use super::{divide_chords, split_chords};
use crate::domain::Boundary;
use crate::error::{Error, Result};
use crate::mesh::{bubble_shape, QuadMesh};
use crate::numerics::Point;
use std::fmt;

/// Most rounds of halving: 2^-24 of an element.
const ROUNDS: usize = 24;
/// Most rounds of division into equal parts: lengths of parts differ, so the first one may leave a few too long.
const EVEN_ROUNDS: usize = 3;
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

    /// For each edge how many parts of it are no longer than allowed, by its quads' mean lengths.
    fn needed(&self, mesh: &QuadMesh) -> Vec<f64> {
        let lengths: Vec<f64> = (0..mesh.edges.len()).map(|e| length(mesh, e)).collect();
        let mut needed = vec![0.0f64; mesh.edges.len()];
        for (q, edges) in (0u32..).zip(&mesh.quad_edges) {
            let allowed = self.of_quad(mesh, q);
            for s in [0, 1] {
                let pair = [edges[s] as usize, edges[s + 2] as usize];
                let ratio = 0.5 * pair.iter().map(|e| lengths[*e]).sum::<f64>() / allowed;
                pair.iter().for_each(|e| needed[*e] = needed[*e].max(ratio));
            }
        }
        needed
    }

    /// Marks the edges of quads whose mean length there is above `slack` times what is allowed.
    pub fn too_long(&self, mesh: &QuadMesh, slack: f64) -> Vec<bool> {
        self.needed(mesh).iter().map(|ratio| *ratio > slack).collect()
    }

    /// Divides chords into as many equal parts as it takes for no quad to be longer than `slack` times what is
    /// allowed. For sizes that vary little: all of a chord is divided alike. `order` as for [`split_chords`].
    ///
    /// # Errors
    /// [`Error::Layout`] when the mesh is defective, or has more than `most` quads then.
    pub fn divide_evenly(
        &self,
        mesh: QuadMesh,
        boundary: &Boundary,
        slack: f64,
        order: usize,
        most: usize,
    ) -> Result<QuadMesh> {
        let mut mesh = mesh;
        for _ in 0..EVEN_ROUNDS {
            let needed = self.needed(&mesh);
            if needed.iter().all(|ratio| *ratio <= slack) {
                break;
            }
            let parts: Vec<u32> = needed.iter().map(|ratio| (ratio / slack).ceil() as u32).collect();
            let count = |edges: &[u32; 4]| {
                [0, 1].map(|s| f64::from(parts[edges[s] as usize])).iter().product::<f64>()
            };
            let quads: f64 = mesh.quad_edges.iter().map(count).sum();
            if quads > most as f64 {
                let reason = format!("the sizes asked for take {quads:.0} elements or more, above {most}");
                return Err(Error::Layout { reason, at: None });
            }
            mesh = divide_chords(&mesh, boundary, &parts, order)?;
        }
        Ok(mesh)
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
