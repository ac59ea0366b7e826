//! Boundaries made by hand, for tests of the stages that only need chains.
#![allow(dead_code)]

use quadrel::domain::{Boundary, BoundaryPoint, Chain, Frame, Junction, Place, Sample};
use quadrel::mesh::{QuadMesh, Vertex};
use quadrel::numerics::{cross, GaussLegendre, Point, Vector};
use std::collections::HashMap;

/// A curve over t in [0, 1] with its derivative.
pub type CurveFn<'a> = &'a dyn Fn(f64) -> (Point, Vector);

/// The table of `curve` with `n` intervals, closed or with ends at junctions 0 and 1. `knots` are
/// the parameters in (0, 1) of its breaks; they are table points.
pub fn chain(curve: CurveFn, n: usize, closed: bool, knots: &[f64]) -> Chain {
    let rule = GaussLegendre::new(12);
    let mut parameters: Vec<f64> = (0..=n).map(|i| i as f64 / n as f64).collect();
    parameters.extend_from_slice(knots);
    parameters.sort_by(f64::total_cmp);
    parameters.dedup();
    let mut s = 0.0;
    let mut samples: Vec<Sample> = Vec::new();
    let mut breaks = Vec::new();
    for (i, &t) in parameters.iter().enumerate() {
        if i > 0 {
            s += rule.integrate(parameters[i - 1], t, |u| curve(u).1.norm());
        }
        if knots.contains(&t) {
            breaks.push(s);
        }
        let (point, d) = curve(t);
        samples.push(Sample { s, point, tangent: d.normalize(), curvature: 0.0, segment: 0, t });
    }
    let ends = if closed { None } else { Some([0, 1]) };
    Chain { loop_index: 0, name: 0, ends, length: s, samples: samples.into(), breaks }
}

/// A domain bounded by the given loops of chains. Every chain of a loop of several gets a junction
/// at its start; the area comes from the tables.
pub fn boundary(loops: Vec<Vec<Chain>>) -> Boundary {
    let mut b = Boundary {
        frame: Frame::identity(),
        names: vec!["wall".into()],
        chains: Vec::new(),
        junctions: Vec::new(),
        loops: Vec::new(),
        area: 0.0,
        loop_sources: (0..loops.len() as u32).collect(),
        diagonal: 1.0,
    };
    for (l, chains) in loops.into_iter().enumerate() {
        let first = b.chains.len() as u32;
        let (count, first_junction) = (chains.len() as u32, b.junctions.len() as u32);
        let open = chains[0].ends.is_some();
        b.loops.push((first..first + count).collect());
        for (k, mut chain) in (0u32..).zip(chains) {
            chain.loop_index = l as u32;
            if open {
                chain.ends = Some([first_junction + k, first_junction + (k + 1) % count]);
            }
            b.area += chain
                .samples
                .windows(2)
                .map(|w| 0.5 * cross(w[0].point.coords, w[1].point.coords))
                .sum::<f64>();
            b.chains.push(chain);
        }
        for k in 0..if open { count } else { 0 } {
            let (before, after) = ((first + (k + count - 1) % count) as usize, (first + k) as usize);
            let incoming = b.chains[before].samples.last().unwrap().tangent;
            let outgoing = b.chains[after].samples[0].tangent;
            let turn = cross(incoming, outgoing).atan2(incoming.dot(&outgoing));
            b.junctions.push(Junction {
                point: b.chains[after].samples[0].point,
                angle: std::f64::consts::PI - turn,
                chain_in: before as u32,
                chain_out: after as u32,
            });
        }
    }
    b
}

/// The ellipse of half axes a and b around the origin, counter-clockwise.
pub fn ellipse(a: f64, b: f64) -> impl Fn(f64) -> (Point, Vector) {
    move |t| {
        let w = std::f64::consts::TAU;
        let (s, c) = (w * t).sin_cos();
        (Point::new(a * c, b * s), Vector::new(-a * w * s, b * w * c))
    }
}

/// The straight segment from p to q.
pub fn segment(p: [f64; 2], q: [f64; 2]) -> impl Fn(f64) -> (Point, Vector) {
    let (p, q) = (Point::from(p), Point::from(q));
    move |t| (p + (q - p) * t, q - p)
}

/// A periodic cubic B-spline through a wavy closed polygon of `n` vertices; its knots are k/n.
pub fn wavy_spline(n: usize, amplitude: f64) -> impl Fn(f64) -> (Point, Vector) {
    let control: Vec<Point> = (0..n)
        .map(|k| {
            let a = std::f64::consts::TAU * k as f64 / n as f64;
            let r = 0.4 * (1.0 + amplitude * if k % 3 == 0 { 1.0 } else { -0.5 });
            Point::new(r * a.cos(), r * a.sin())
        })
        .collect();
    move |t| {
        let x = (t * n as f64).clamp(0.0, n as f64);
        let k = (x.floor() as usize).min(n - 1);
        let u = x - k as f64;
        let c = |i: usize| control[(k + i) % n].coords;
        let v = 1.0 - u;
        let weights = [
            v * v * v / 6.0,
            (3.0 * u * u * u - 6.0 * u * u + 4.0) / 6.0,
            (-3.0 * u * u * u + 3.0 * u * u + 3.0 * u + 1.0) / 6.0,
            u * u * u / 6.0,
        ];
        let slopes =
            [-v * v / 2.0, (3.0 * u * u - 4.0 * u) / 2.0, (-3.0 * u * u + 2.0 * u + 1.0) / 2.0, u * u / 2.0];
        let mut p = Vector::zeros();
        let mut d = Vector::zeros();
        for i in 0..4 {
            p += c(i) * weights[i];
            d += c(i) * slopes[i] * n as f64;
        }
        (Point::from(p), d)
    }
}

/// The disc of radius 1 in the canonical frame of diagonal 1 (its own frame: turned and moved), with an
/// O-grid of 12 quads: 2 × 2 inside, 8 around. `inner` is the radius of the inner block's corners.
pub fn disc_o_grid(inner: f64) -> (Boundary, QuadMesh) {
    let r = 1.0 / 8f64.sqrt();
    let mut b = boundary(vec![vec![chain(&ellipse(r, r), 4000, true, &[])]]);
    b.frame = Frame { origin: Point::new(5.0, -3.0), scale: 8f64.sqrt(), axis: Vector::new(0.6, 0.8) };
    let mesh = o_grid(&b, inner);
    (b, mesh)
}

/// An O-grid of 12 quads in a convex domain of one closed chain round the origin: the inner block's
/// corners are boundary points scaled by `inner`, its mid-points by 0.85 of that.
pub fn o_grid(b: &Boundary, inner: f64) -> QuadMesh {
    let length = b.chains[0].length;
    let on_boundary = |k: usize| b.chains[0].point(length * k as f64 / 8.0);
    let mut vertices: Vec<Vertex> = (0..8)
        .map(|k| {
            let s = length * k as f64 / 8.0;
            Vertex { point: on_boundary(k), place: Place::Boundary(BoundaryPoint { chain: 0, s }) }
        })
        .collect();
    let inside = |point| Vertex { point, place: Place::Interior };
    vertices.extend((0..8).map(|k| inside(on_boundary(k) * if k % 2 == 1 { inner } else { 0.85 * inner })));
    vertices.push(inside(Point::origin()));
    let mut quads: Vec<[u32; 4]> = (0..8u32).map(|k| [8 + k, k, (k + 1) % 8, 8 + (k + 1) % 8]).collect();
    quads.extend((0..4u32).map(|c| {
        let k = 2 * c;
        [16, 8 + k, 8 + k + 1, 8 + (k + 2) % 8]
    }));
    let region = vec![0; quads.len()];
    QuadMesh::new(b, vertices, quads, region, &HashMap::new()).unwrap()
}

/// The polygon with the given corners, counter-clockwise, one straight chain a side.
pub fn polygon(corners: &[[f64; 2]]) -> Boundary {
    let sides = (0..corners.len())
        .map(|k| chain(&segment(corners[k], corners[(k + 1) % corners.len()]), 4, false, &[]))
        .collect();
    boundary(vec![sides])
}
