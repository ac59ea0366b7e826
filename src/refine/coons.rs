//! The Coons map of a quad with its sides on the exact boundary, and its derivatives.

use crate::domain::{Boundary, Chain, Span};
use crate::mesh::{bubble_shape, fit_bubbles, QuadMesh};
use crate::numerics::{cross, legendre, Point, Vector};

/// A side, walked in the direction of u or v.
struct Side<'a> {
    ends: [Point; 2],
    bubbles: &'a [Vector],
    span: Option<(&'a Chain, Span)>,
    backwards: bool,
}

impl Side<'_> {
    /// Point and derivative at `t` in [0, 1].
    fn at(&self, t: f64) -> (Vector, Vector) {
        let (share, sign) = if self.backwards { (1.0 - t, -1.0) } else { (t, 1.0) };
        let (point, slope) = match self.span {
            Some((chain, span)) => {
                let length = span.end - span.start;
                let (point, tangent) = chain.evaluate(span.start + share * length);
                (point, tangent * length)
            }
            None => {
                let [a, b] = self.ends;
                let x = 2.0 * share - 1.0;
                let slope: Vector =
                    self.bubbles.iter().enumerate().map(|(m, c)| c * bubble_slope(m, x)).sum();
                (a + (b - a) * share + bubble_shape(self.bubbles, x), b - a + slope * 2.0)
            }
        };
        (point.coords, slope * sign)
    }
}

/// Derivative of (1 − x²) P_m(x).
fn bubble_slope(m: usize, x: f64) -> f64 {
    let (p, before) = legendre(m, x);
    -2.0 * x * p + m as f64 * (before - x * p)
}

/// The bilinearly blended map of [0, 1]² on a quad; u runs along side 0, v along side 3 backwards.
pub(super) struct CoonsMap<'a> {
    /// Low and high in v, left and right in u.
    sides: [Side<'a>; 4],
    corners: [Vector; 4],
}

impl<'a> CoonsMap<'a> {
    pub fn new(mesh: &'a QuadMesh, boundary: &'a Boundary, quad: usize) -> Self {
        let corners = mesh.quads[quad];
        let side = |s: usize, from: usize| {
            let edge = &mesh.edges[mesh.quad_edges[quad][s] as usize];
            Side {
                ends: edge.vertices.map(|v| mesh.vertices[v as usize].point),
                bubbles: &edge.bubbles,
                span: edge.span.map(|span| (&boundary.chains[span.chain as usize], span)),
                backwards: edge.vertices[0] != corners[from],
            }
        };
        CoonsMap {
            sides: [side(0, 0), side(2, 3), side(3, 0), side(1, 1)],
            corners: corners.map(|v| mesh.vertices[v as usize].point.coords),
        }
    }

    /// The point at (u, v) and the Jacobian there.
    pub fn at(&self, u: f64, v: f64) -> (Point, f64) {
        let [low, high] = [0, 1].map(|s| self.sides[s].at(u));
        let [left, right] = [2, 3].map(|s| self.sides[s].at(v));
        let [a, b, c, d] = self.corners;
        let mix = |p: Vector, q: Vector, t: f64| p * (1.0 - t) + q * t;
        let point = mix(low.0, high.0, v) + mix(left.0, right.0, u) - mix(mix(a, b, u), mix(d, c, u), v);
        let along_u = mix(low.1, high.1, v) + (right.0 - left.0) - mix(b - a, c - d, v);
        let along_v = mix(left.1, right.1, u) + (high.0 - low.0) - mix(d - a, c - b, u);
        (Point::from(point), cross(along_u, along_v))
    }
}

/// A quad's map seen with its corner `first` as the origin: that corner's side 0 is in front.
pub(super) struct View<'a> {
    map: CoonsMap<'a>,
    pub quad: usize,
    pub first: usize,
}

impl<'a> View<'a> {
    pub fn new(mesh: &'a QuadMesh, boundary: &'a Boundary, quad: usize, first: usize) -> Self {
        View { map: CoonsMap::new(mesh, boundary, quad), quad, first }
    }

    pub fn point(&self, [u, v]: [f64; 2]) -> Point {
        let [u, v] = match self.first {
            0 => [u, v],
            1 => [1.0 - v, u],
            2 => [1.0 - u, 1.0 - v],
            _ => [v, 1.0 - u],
        };
        self.map.at(u, v).0
    }

    /// The shape of the line of the map between two places of the unit square, as `count` bubbles.
    pub fn shape(&self, from: [f64; 2], to: [f64; 2], count: usize) -> Vec<Vector> {
        let [a, b] = [from, to].map(|at| self.point(at));
        fit_bubbles(count, |x| {
            let t = 0.5 * (1.0 + x);
            self.point([0, 1].map(|k| from[k] * (1.0 - t) + to[k] * t)) - (a + (b - a) * t)
        })
    }
}
