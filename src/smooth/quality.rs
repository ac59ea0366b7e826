//! Quality of elements by sampling; the proof of validity is made elsewhere.

use super::reference::{bubble, Reference};
use super::straightness::Straightness;
use crate::domain::walk::{walk, FOUR};
use crate::domain::Boundary;
use crate::mesh::QuadMesh;
use crate::numerics::tolerances::LEAST_JACOBIAN;
use crate::numerics::{cross, Vector};

/// What sampling sees of one element.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElementQuality {
    /// Minimum of det J / (|x_ξ| |x_η|).
    pub scaled_jacobian: f64,
    /// Minimum of det J divided by its maximum; not positive if the element is inverted.
    pub jacobian_ratio: f64,
    /// The longer of the two mean lengths of opposite sides.
    pub size: f64,
}

/// Quality of a mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Quality {
    pub elements: Vec<ElementQuality>,
    pub min_scaled_jacobian: f64,
    pub mean_scaled_jacobian: f64,
    pub min_jacobian_ratio: f64,
    /// Largest boundary error divided by the tolerance; 0 without a tolerance.
    pub error_ratio: f64,
}

impl Quality {
    pub(super) fn new(elements: Vec<ElementQuality>, error_ratio: f64) -> Self {
        let least = |f: fn(&ElementQuality) -> f64| elements.iter().map(f).fold(f64::INFINITY, f64::min);
        let sum: f64 = elements.iter().map(|e| e.scaled_jacobian).sum();
        Quality {
            min_scaled_jacobian: least(|e| e.scaled_jacobian),
            mean_scaled_jacobian: sum / elements.len().max(1) as f64,
            min_jacobian_ratio: least(|e| e.jacobian_ratio),
            error_ratio,
            elements,
        }
    }

    /// Whether no sample is inverted.
    pub fn valid(&self) -> bool {
        self.min_jacobian_ratio > LEAST_JACOBIAN
    }
}

/// Values and slopes of an edge at the samples, in the edge's direction.
fn edge_samples(boundary: &Boundary, reference: &Reference, mesh: &QuadMesh, edge: u32) -> Vec<[Vector; 2]> {
    let edge = &mesh.edges[edge as usize];
    let (k, lanes) = (reference.samples.len(), reference.lanes);
    if let Some(span) = edge.span {
        let mut out = vec![[Vector::zeros(); 2]; k];
        let chain = &boundary.chains[span.chain as usize];
        walk(chain, [span.start, span.end - span.start], &reference.nodes, |first, four| {
            for i in first..(first + FOUR).min(reference.nodes.len()) {
                let p = Vector::new(four.point[0][i - first], four.point[1][i - first]);
                let value = &reference.lagrange[i * lanes..i * lanes + k];
                let slope = &reference.lagrange_slope[i * lanes..i * lanes + k];
                for ((out, value), slope) in out.iter_mut().zip(value).zip(slope) {
                    out[0] += p * *value;
                    out[1] += p * *slope;
                }
            }
        });
        return out;
    }
    let [a, b] = edge.vertices.map(|v| mesh.vertices[v as usize].point.coords);
    let d = b - a;
    let sample = |t: &f64| {
        let (mut p, mut v) = (a + d * *t, d);
        for (m, c) in edge.bubbles.iter().enumerate() {
            let (value, slope) = bubble(m, *t);
            p += c * value;
            v += c * slope;
        }
        [p, v]
    };
    reference.samples.iter().map(sample).collect()
}

/// Quality of a quad with straight sides: det J is linear and the angle of its columns monotonic along each side,
/// so that the corners have the extremes.
fn plain(mesh: &QuadMesh, quad: u32) -> ElementQuality {
    let p = mesh.quads[quad as usize].map(|v| mesh.vertices[v as usize].point);
    let sides = [0, 1, 2, 3].map(|i| p[(i + 1) % 4] - p[i]);
    let length = sides.map(|s| s.norm());
    let (mut scaled, mut least, mut most) = (f64::INFINITY, f64::INFINITY, 0.0f64);
    for i in 0..4 {
        let before = (i + 3) % 4;
        let det = cross(sides[before], sides[i]);
        scaled = scaled.min(det / (length[before] * length[i]).max(f64::MIN_POSITIVE));
        least = least.min(det);
        most = most.max(det.abs());
    }
    ElementQuality {
        scaled_jacobian: scaled,
        jacobian_ratio: least / most.max(f64::MIN_POSITIVE),
        size: 0.5 * (length[0] + length[2]).max(length[1] + length[3]),
    }
}

/// Quality of quad `quad`.
pub(super) fn element(
    boundary: &Boundary,
    reference: &Reference,
    straightness: &Straightness,
    mesh: &QuadMesh,
    quad: u32,
) -> ElementQuality {
    if mesh.quad_edges[quad as usize].into_iter().all(|e| straightness.holds_now(mesh, e)) {
        return plain(mesh, quad);
    }
    let corners = mesh.quads[quad as usize];
    let starts = [corners[0], corners[1], corners[3], corners[0]];
    let side = |i: usize| {
        let e = mesh.quad_edges[quad as usize][i];
        let mut samples = edge_samples(boundary, reference, mesh, e);
        if mesh.edges[e as usize].vertices[0] != starts[i] {
            samples.reverse();
            samples.iter_mut().for_each(|s| s[1] = -s[1]);
        }
        samples
    };
    let c = [side(0), side(1), side(2), side(3)];
    let k = reference.samples.len();
    let p = [c[0][0][0], c[0][k - 1][0], c[2][k - 1][0], c[2][0][0]];
    let straight = [p[1] - p[0], p[2] - p[1], p[2] - p[3], p[3] - p[0]];
    let (mut scaled, mut least, mut most) = (f64::INFINITY, f64::INFINITY, 0.0f64);
    for (j, tj) in reference.samples.iter().enumerate() {
        for (i, ti) in reference.samples.iter().enumerate() {
            let a = (c[0][i][1] - straight[0]) * (1.0 - tj) + (c[2][i][1] - straight[2]) * *tj + c[1][j][0]
                - c[3][j][0];
            let b = (c[3][j][1] - straight[3]) * (1.0 - ti) + (c[1][j][1] - straight[1]) * *ti + c[2][i][0]
                - c[0][i][0];
            let det = cross(a, b);
            scaled = scaled.min(det / (a.norm() * b.norm()).max(f64::MIN_POSITIVE));
            least = least.min(det);
            most = most.max(det.abs());
        }
    }
    let length = |c: &[[Vector; 2]]| c.windows(2).map(|w| (w[1][0] - w[0][0]).norm()).sum::<f64>();
    let l = [0, 1, 2, 3].map(|i| length(&c[i]));
    ElementQuality {
        scaled_jacobian: scaled,
        jacobian_ratio: least / most.max(f64::MIN_POSITIVE),
        size: 0.5 * (l[0] + l[2]).max(l[1] + l[3]),
    }
}
