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
struct Elements<'a> {
    triangles: &'a [[u32; 3]],
    /// For each triangle and corner what joins the two others: half the cotangent of its angle.
    weights: Vec<[f64; 3]>,
    mass: Vec<f64>,
}

impl<'a> Elements<'a> {
    fn new(mesh: &'a Triangulation) -> Self {
        let mut mass = vec![0.0; mesh.vertices.len()];
        let mut weights = Vec::with_capacity(mesh.triangles.len());
        for corners in &mesh.triangles {
            let p = corners.map(|v| mesh.vertices[v as usize].point);
            let double = cross(p[1] - p[0], p[2] - p[0]);
            corners.iter().for_each(|v| mass[*v as usize] += double / 6.0);
            weights.push([0, 1, 2].map(|i| {
                // The floor keeps a triangle that is flat to rounding from swallowing the rest.
                let (d, e) = (p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
                0.5 * d.dot(&e) / double.max(1e-12 * (d.norm_squared() + e.norm_squared()))
            }));
        }
        Elements { triangles: &mesh.triangles, weights, mass }
    }

    /// Multiplies the stiffness of each triangle by its diffusion time.
    fn scale(&mut self, times: &[f64]) {
        for (weights, time) in self.weights.iter_mut().zip(times) {
            *weights = weights.map(|w| w * time);
        }
    }

    /// Entries (i, j, K_ij) with i > j off the diagonal, and the diagonal; nine in a row of each triangle.
    fn stiffness(&self) -> impl Iterator<Item = Entry> + '_ {
        self.triangles.iter().zip(&self.weights).flat_map(|(corners, weights)| {
            [0, 1, 2].into_iter().flat_map(|i| {
                let (a, b, weight) = (corners[(i + 1) % 3], corners[(i + 2) % 3], weights[i]);
                [(a, a, weight), (b, b, weight), (a.max(b), a.min(b), -weight)]
            })
        })
    }
}

/// A linear system on the inner vertices: `mass_share` M + K.
struct System<'a> {
    elements: &'a Elements<'a>,
    mass_share: f64,
    unknown: &'a [u32],
    /// Vertex of each unknown.
    inner: &'a [u32],
    factors: Cholesky,
}

impl<'a> System<'a> {
    fn new(
        elements: &'a Elements<'a>,
        mass_share: f64,
        unknown: &'a [u32],
        inner: &'a [u32],
    ) -> Result<Self> {
        let stiffness = elements.stiffness().filter_map(|(a, b, k)| {
            let (i, j) = (unknown[a as usize], unknown[b as usize]);
            (i != NONE && j != NONE).then(|| (i.max(j), i.min(j), k))
        });
        let diagonal = (0..).zip(inner).map(|(i, &v)| (i, i, mass_share * elements.mass[v as usize]));
        let factors = Cholesky::new(inner.len(), stiffness.chain(diagonal)).map_err(linear)?;
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
        for (a, b, k) in self.elements.stiffness() {
            for [row, column] in [[a, b], [b, a]].map(|pair| pair.map(|v| v as usize)) {
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
    let mut elements = Elements::new(mesh);
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
        elements.scale(&mesh.triangles.iter().map(time).collect::<Vec<_>>());
        let step = System::new(&elements, 1.0, &unknown, &inner)?;
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
