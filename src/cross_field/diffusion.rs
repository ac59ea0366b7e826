//! The finite element solve for u = (cos 4θ, sin 4θ).

use super::border::Border;
use super::thickness::thickness;
use super::tips::Held;
use crate::base_mesh::Triangulation;
use crate::error::{Error, Result};
use crate::numerics::sparse::{Cholesky, Entry};
use crate::numerics::tolerances::{DIFFUSION_STEPS, DIFFUSION_TIME};
use crate::numerics::{cross, NONE};
use crate::options::FieldMethod;

/// Stiffness and lumped mass of linear elements.
struct Elements {
    /// Entries (i, j, K_ij) with i > j off the diagonal, and the diagonal; nine in a row of each triangle.
    stiffness: Vec<Entry>,
    mass: Vec<f64>,
}

impl Elements {
    fn new(mesh: &Triangulation) -> Elements {
        let mut stiffness = Vec::with_capacity(9 * mesh.triangles.len());
        let mut mass = vec![0.0; mesh.vertices.len()];
        for corners in &mesh.triangles {
            let p = corners.map(|v| mesh.vertices[v as usize].point);
            let double = cross(p[1] - p[0], p[2] - p[0]);
            for i in 0..3 {
                let (a, b) = (corners[(i + 1) % 3] as usize, corners[(i + 2) % 3] as usize);
                mass[corners[i] as usize] += double / 6.0;
                // Half the cotangent of the angle at corner i; the floor keeps a triangle that is
                // flat to rounding from swallowing the rest.
                let (d, e) = (p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
                let weight = 0.5 * d.dot(&e) / double.max(1e-12 * (d.norm_squared() + e.norm_squared()));
                stiffness.extend([(a, a, weight), (b, b, weight), (a.max(b), a.min(b), -weight)]);
            }
        }
        Elements { stiffness, mass }
    }
}

impl Elements {
    /// The same with the stiffness of each triangle multiplied by its diffusion time.
    fn with_times(&self, times: &[f64]) -> Elements {
        let scaled = |(chunk, time): (&[Entry], &f64)| {
            chunk.iter().map(|&(i, j, k)| (i, j, k * time)).collect::<Vec<_>>()
        };
        Elements {
            stiffness: self.stiffness.chunks(9).zip(times).flat_map(scaled).collect(),
            mass: self.mass.clone(),
        }
    }
}

/// A linear system on the inner vertices: `mass_share` M + K.
struct System<'a> {
    elements: &'a Elements,
    mass_share: f64,
    unknown: &'a [u32],
    /// Vertex of each unknown.
    inner: &'a [u32],
    factors: Cholesky,
}

impl<'a> System<'a> {
    fn new(elements: &'a Elements, mass_share: f64, unknown: &'a [u32], inner: &'a [u32]) -> Result<Self> {
        let mut entries: Vec<Entry> = Vec::with_capacity(elements.stiffness.len() + inner.len());
        for &(a, b, k) in &elements.stiffness {
            let (i, j) = (unknown[a], unknown[b]);
            if i != NONE && j != NONE {
                entries.push((i.max(j) as usize, i.min(j) as usize, k));
            }
        }
        let diagonal = inner.iter().enumerate().map(|(i, &v)| (i, i, mass_share * elements.mass[v as usize]));
        entries.extend(diagonal);
        let factors = Cholesky::new(inner.len(), &entries).map_err(linear)?;
        Ok(System { elements, mass_share, unknown, inner, factors })
    }

    /// Solves with the border's values in `u` fixed and M u as right-hand side; replaces the inner values.
    fn advance(&self, u: &mut [[f64; 2]]) -> Result<()> {
        let scaled = |x: [f64; 2], s: f64| [s * x[0], s * x[1]];
        let mut right: Vec<[f64; 2]> = self
            .inner
            .iter()
            .map(|&v| scaled(u[v as usize], self.mass_share * self.elements.mass[v as usize]))
            .collect();
        for &(a, b, k) in &self.elements.stiffness {
            for (row, column) in [(a, b), (b, a)] {
                if self.unknown[row] != NONE && self.unknown[column] == NONE {
                    let known = scaled(u[column], k);
                    let r = &mut right[self.unknown[row] as usize];
                    *r = [r[0] - known[0], r[1] - known[1]];
                }
            }
        }
        for (&v, x) in self.inner.iter().zip(self.factors.solve(&right).map_err(linear)?) {
            u[v as usize] = x;
        }
        Ok(())
    }
}

/// Brings the inner values to length 1; where u vanishes there is no direction to keep.
fn renormalise(u: &mut [[f64; 2]], inner: &[u32]) {
    for &v in inner {
        let [x, y] = u[v as usize];
        let length = x.hypot(y);
        if length > 1e-12 {
            u[v as usize] = [x / length, y / length];
        }
    }
}

/// Solves for u at the vertices; `held` fixes it at some inner ones.
pub(super) fn solve(
    mesh: &Triangulation,
    border: &Border,
    held: &[Option<Held>],
    method: FieldMethod,
) -> Result<Vec<[f64; 2]>> {
    let mut u = vec![[0.0; 2]; mesh.vertices.len()];
    let mut unknown = vec![NONE; mesh.vertices.len()];
    let mut inner = Vec::new();
    for v in 0..mesh.vertices.len() as u32 {
        if border.holds(v) {
            u[v as usize] = border.mean(v);
        } else if let Some(held) = held[v as usize] {
            u[v as usize] = [(4.0 * held.cross).cos(), (4.0 * held.cross).sin()];
        } else {
            unknown[v as usize] = inner.len() as u32;
            inner.push(v);
        }
    }
    let elements = Elements::new(mesh);
    System::new(&elements, 0.0, &unknown, &inner)?.advance(&mut u)?;
    if method == FieldMethod::Diffused {
        renormalise(&mut u, &inner);
        for v in (0..mesh.vertices.len() as u32).filter(|&v| border.holds(v)) {
            u[v as usize] = border.middle(v);
        }
        // A step longer than a thin part is wide would only bring back the harmonic field there.
        let thickness = thickness(mesh, border);
        let time = |t: &[u32; 3]| {
            let mean = t.iter().map(|&v| thickness[v as usize]).sum::<f64>() / 3.0;
            DIFFUSION_TIME * mean * mean
        };
        let diffusing = elements.with_times(&mesh.triangles.iter().map(time).collect::<Vec<_>>());
        let step = System::new(&diffusing, 1.0, &unknown, &inner)?;
        for _ in 0..DIFFUSION_STEPS {
            step.advance(&mut u)?;
            renormalise(&mut u, &inner);
        }
    }
    Ok(u)
}

fn linear(reason: String) -> Error {
    Error::CrossField { reason, at: None }
}
