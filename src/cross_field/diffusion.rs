//! The finite element solve for u = (cos 4θ, sin 4θ).

use super::border::Border;
use super::thickness::thickness;
use super::tips::Held;
use crate::base_mesh::Triangulation;
use crate::error::{Error, Result};
use crate::numerics::sparse::{Cholesky, Pattern};
use crate::numerics::tolerances::{DIFFUSION_STEPS, DIFFUSION_TIME};
use crate::numerics::{cross, NONE};
use crate::options::FieldMethod;

/// Stiffness and lumped mass of linear elements.
struct Elements<'a> {
    triangles: &'a [[u32; 3]],
    /// Half the cotangents of each triangle's angles: minus the stiffness between the other two corners.
    weights: Vec<[f64; 3]>,
    mass: Vec<f64>,
}

impl<'a> Elements<'a> {
    fn new(mesh: &'a Triangulation) -> Self {
        let mut weights = Vec::with_capacity(mesh.triangles.len());
        let mut mass = vec![0.0; mesh.vertices.len()];
        for corners in &mesh.triangles {
            let p = corners.map(|v| mesh.vertices[v as usize].point);
            let double = cross(p[1] - p[0], p[2] - p[0]);
            weights.push([0, 1, 2].map(|i| {
                mass[corners[i] as usize] += double / 6.0;
                // The floor keeps a triangle that is flat to rounding from swallowing the rest.
                let (d, e) = (p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
                0.5 * d.dot(&e) / double.max(1e-12 * (d.norm_squared() + e.norm_squared()))
            }));
        }
        Elements { triangles: &mesh.triangles, weights, mass }
    }

    /// Multiplies the stiffness of each triangle by its diffusion time.
    fn multiply(&mut self, time: impl Fn(&[u32; 3]) -> f64) {
        for (corners, weights) in self.triangles.iter().zip(&mut self.weights) {
            let time = time(corners);
            *weights = weights.map(|weight| weight * time);
        }
    }

    /// Entries (i, j, K_ij) with i ≥ j: their sum is the stiffness.
    fn stiffness(&self) -> impl Iterator<Item = (u32, u32, f64)> + '_ {
        self.triangles.iter().zip(&self.weights).flat_map(|(corners, weights)| {
            [0, 1, 2].into_iter().flat_map(move |i| {
                let (a, b, weight) = (corners[(i + 1) % 3], corners[(i + 2) % 3], weights[i]);
                [(a, a, weight), (b, b, weight), (a.max(b), a.min(b), -weight)]
            })
        })
    }
}

/// Numbers of the vertices whose values are looked for.
struct Unknowns {
    /// Of each vertex; `NONE` if its value is known.
    number: Vec<u32>,
    /// Vertex of each unknown.
    inner: Vec<u32>,
}

impl Unknowns {
    /// Places of the systems' entries: the stiffness, then the mass.
    fn pattern(&self, elements: &Elements) -> Result<Pattern> {
        let pair = |(a, b, _)| {
            let (i, j) = (self.number[a as usize], self.number[b as usize]);
            (i != NONE && j != NONE).then_some((i.max(j), i.min(j)))
        };
        let diagonal = (0..self.inner.len() as u32).map(|i| (i, i));
        let places: Vec<_> = elements.stiffness().filter_map(pair).chain(diagonal).collect();
        Pattern::new(self.inner.len(), &places).map_err(linear)
    }
}

/// A linear system on the inner vertices: `mass_share` M + K.
struct System<'a> {
    unknowns: &'a Unknowns,
    /// Multiples of the mass, by unknown.
    mass: Vec<f64>,
    /// Entries of K between an unknown and a vertex whose value is known.
    known: Vec<(u32, u32, f64)>,
    factors: Cholesky,
}

impl<'a> System<'a> {
    fn new(elements: &Elements, mass_share: f64, unknowns: &'a Unknowns, pattern: &Pattern) -> Result<Self> {
        let mass: Vec<f64> = unknowns.inner.iter().map(|&v| mass_share * elements.mass[v as usize]).collect();
        let mut values = Vec::new();
        let mut known = Vec::new();
        for (a, b, k) in elements.stiffness() {
            match [a, b].map(|v| unknowns.number[v as usize]) {
                [NONE, NONE] => {}
                [row, NONE] => known.push((row, b, k)),
                [NONE, row] => known.push((row, a, k)),
                _ => values.push(k),
            }
        }
        values.extend(&mass);
        Ok(System { unknowns, mass, known, factors: pattern.factor(&values).map_err(linear)? })
    }

    /// Solves with the border's values in `u` fixed and M u as right-hand side; replaces the inner values.
    fn advance(&self, u: &mut [[f64; 2]]) -> Result<()> {
        let scaled = |x: [f64; 2], s: f64| [s * x[0], s * x[1]];
        let inner = &self.unknowns.inner;
        let mut right: Vec<[f64; 2]> =
            inner.iter().zip(&self.mass).map(|(&v, &mass)| scaled(u[v as usize], mass)).collect();
        for &(row, column, k) in &self.known {
            let known = scaled(u[column as usize], k);
            let r = &mut right[row as usize];
            *r = [r[0] - known[0], r[1] - known[1]];
        }
        for (&v, x) in inner.iter().zip(self.factors.solve(&right).map_err(linear)?) {
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
    let mut unknowns = Unknowns { number: vec![NONE; mesh.vertices.len()], inner: Vec::new() };
    for v in 0..mesh.vertices.len() as u32 {
        if border.holds(v) {
            u[v as usize] = border.mean(v);
        } else if let Some(held) = held[v as usize] {
            u[v as usize] = [(4.0 * held.cross).cos(), (4.0 * held.cross).sin()];
        } else {
            unknowns.number[v as usize] = unknowns.inner.len() as u32;
            unknowns.inner.push(v);
        }
    }
    let mut elements = Elements::new(mesh);
    let pattern = unknowns.pattern(&elements)?;
    System::new(&elements, 0.0, &unknowns, &pattern)?.advance(&mut u)?;
    if method == FieldMethod::Diffused {
        renormalise(&mut u, &unknowns.inner);
        for v in (0..mesh.vertices.len() as u32).filter(|&v| border.holds(v)) {
            u[v as usize] = border.middle(v);
        }
        // A step longer than a thin part is wide would only bring back the harmonic field there.
        let thickness = thickness(mesh, border);
        elements.multiply(|t| {
            let mean = t.iter().map(|&v| thickness[v as usize]).sum::<f64>() / 3.0;
            DIFFUSION_TIME * mean * mean
        });
        let step = System::new(&elements, 1.0, &unknowns, &pattern)?;
        for _ in 0..DIFFUSION_STEPS {
            step.advance(&mut u)?;
            renormalise(&mut u, &unknowns.inner);
        }
    }
    Ok(u)
}

fn linear(reason: String) -> Error {
    Error::CrossField { reason, at: None }
}
