//! Boundaries of lines and circular arcs, built by hand in the canonical frame.
#![allow(dead_code)]

use quadrel::domain::{Boundary, Chain, Frame, Junction, Sample};
use quadrel::numerics::tolerances::CORNER_TURN;
use quadrel::numerics::{cross, Point, Vector};
use std::f64::consts::{PI, TAU};

#[derive(Debug, Clone, Copy)]
pub enum Piece {
    Line([f64; 2], [f64; 2]),
    /// Center, radius, first angle, swept angle (positive: counter-clockwise).
    Arc([f64; 2], f64, f64, f64),
}

impl Piece {
    fn length(&self) -> f64 {
        match *self {
            Piece::Line(a, b) => (b[0] - a[0]).hypot(b[1] - a[1]),
            Piece::Arc(_, r, _, sweep) => r * sweep.abs(),
        }
    }

    fn at(&self, t: f64) -> (Point, Vector, f64) {
        match *self {
            Piece::Line(a, b) => {
                let (a, d) = (Point::new(a[0], a[1]), Vector::new(b[0] - a[0], b[1] - a[1]));
                (a + d * t, d.normalize(), 0.0)
            }
            Piece::Arc(c, r, first, sweep) => {
                let angle = first + sweep * t;
                let out = Vector::new(angle.cos(), angle.sin());
                let tangent = Vector::new(-out.y, out.x) * sweep.signum();
                (Point::new(c[0], c[1]) + out * r, tangent, sweep.signum() / r)
            }
        }
    }

    fn samples(&self, segment: u32, s0: f64, scale: f64) -> Vec<Sample> {
        let n = if matches!(self, Piece::Line(..)) { 4 } else { 64 };
        (0..=n)
            .map(|i| {
                let t = f64::from(i) / f64::from(n);
                let (p, tangent, curvature) = self.at(t);
                let s = s0 + self.length() * scale * t;
                Sample { s, point: p * scale, tangent, curvature: curvature / scale, segment, t }
            })
            .collect()
    }
}

/// The boundary of loops (the outer one first, the domain to their left), scaled to a diagonal of 1.
pub fn boundary(loops: &[Vec<Piece>]) -> Boundary {
    let points: Vec<Point> =
        loops.iter().flatten().flat_map(|p| (0..=64).map(move |i| p.at(f64::from(i) / 64.0).0)).collect();
    let bound = |f: fn(&Point) -> f64| {
        let values: Vec<f64> = points.iter().map(f).collect();
        values.iter().copied().fold(f64::MIN, f64::max) - values.iter().copied().fold(f64::MAX, f64::min)
    };
    let scale = 1.0 / bound(|p| p.x).hypot(bound(|p| p.y));
    let mut out = Boundary {
        frame: Frame { scale: 1.0 / scale, ..Frame::identity() },
        names: vec!["wall".into()],
        chains: vec![],
        junctions: vec![],
        loops: vec![],
        area: 0.0,
    };
    for (loop_index, pieces) in loops.iter().enumerate() {
        let n = pieces.len();
        let turn = |i: usize| {
            let (a, b) = (pieces[(i + n - 1) % n].at(1.0).1, pieces[i].at(0.0).1);
            let turn = cross(a, b).atan2(a.dot(&b));
            // A reversal is a slit's end or a spike of the domain; only the former is used here.
            if turn > PI - 1e-9 {
                -turn
            } else {
                turn
            }
        };
        let corners: Vec<usize> = (0..n).filter(|&i| turn(i).abs() > CORNER_TURN).collect();
        let first = corners.first().copied().unwrap_or(0);
        let (chain0, junction0) = (out.chains.len() as u32, out.junctions.len() as u32);
        let count = corners.len().max(1) as u32;
        let mut own = Vec::new();
        for k in 0..count {
            let from = if corners.is_empty() { 0 } else { corners[k as usize] };
            let to = if k + 1 < count { corners[k as usize + 1] } else { first + n };
            let mut samples = Vec::new();
            let mut breaks = Vec::new();
            let mut s = 0.0;
            for i in from..to {
                if i > from {
                    breaks.push(s);
                }
                samples.extend(pieces[i % n].samples((i % n) as u32, s, scale));
                s += pieces[i % n].length() * scale;
            }
            let ends = (!corners.is_empty()).then_some([junction0 + k, junction0 + (k + 1) % count]);
            if !corners.is_empty() {
                out.junctions.push(Junction {
                    point: samples[0].point,
                    angle: PI - turn(from),
                    chain_in: chain0 + (k + count - 1) % count,
                    chain_out: chain0 + k,
                });
            }
            let last = samples.len() - 1;
            samples[last].s = s;
            for w in samples.windows(2) {
                // Green's formula, with the circular segment over each piece's chord.
                let chord = (w[1].point - w[0].point).norm();
                let sagitta = 0.5 * (w[0].curvature + w[1].curvature) * chord * chord * chord / 12.0;
                out.area += 0.5 * cross(w[0].point.coords, w[1].point.coords) + sagitta;
            }
            own.push(out.chains.len() as u32);
            let name = 0;
            out.chains.push(Chain { loop_index: loop_index as u32, name, ends, length: s, samples, breaks });
        }
        out.loops.push(own);
    }
    out
}

pub fn polygon(points: &[[f64; 2]]) -> Vec<Piece> {
    (0..points.len()).map(|i| Piece::Line(points[i], points[(i + 1) % points.len()])).collect()
}

/// A whole circle, clockwise (a hole) if `radius` is negative.
pub fn circle(center: [f64; 2], radius: f64) -> Vec<Piece> {
    // Not from angle 0: nothing may depend on where a loop starts.
    vec![Piece::Arc(center, radius.abs(), 0.4, TAU * radius.signum())]
}

pub fn disc() -> Boundary {
    boundary(&[circle([0.0; 2], 1.0)])
}

pub fn square() -> Boundary {
    boundary(&[polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])])
}

pub fn annulus() -> Boundary {
    boundary(&[circle([0.0; 2], 1.0), circle([0.0; 2], -0.4)])
}

pub fn l_shape() -> Boundary {
    boundary(&[polygon(&[[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.]])])
}

pub fn half_disc() -> Boundary {
    boundary(&[vec![Piece::Line([-1.0, 0.0], [1.0, 0.0]), Piece::Arc([0.0; 2], 1.0, 0.0, PI)]])
}

/// A sector of a disc of this angle in degrees, its tip at the center.
pub fn sector(degrees: f64) -> Boundary {
    let angle = degrees.to_radians();
    let end = [angle.cos(), angle.sin()];
    boundary(&[vec![
        Piece::Line([0.0; 2], [1.0, 0.0]),
        Piece::Arc([0.0; 2], 1.0, 0.0, angle),
        Piece::Line(end, [0.0; 2]),
    ]])
}

pub fn regular(sides: usize) -> Boundary {
    let corner = |k: usize| {
        let angle = TAU * k as f64 / sides as f64 + 0.1;
        [angle.cos(), angle.sin()]
    };
    boundary(&[polygon(&(0..sides).map(corner).collect::<Vec<_>>())])
}

/// A square with two round holes.
pub fn two_holes() -> Boundary {
    let square = polygon(&[[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [0.0, 2.0]]);
    boundary(&[square, circle([0.9, 1.1], -0.4), circle([2.1, 0.8], -0.5)])
}

/// A disc whose hole touches the rim but for this gap.
pub fn near_hole(gap: f64) -> Boundary {
    boundary(&[circle([0.0; 2], 1.0), circle([0.5 - gap, 0.0], -0.5)])
}

/// All of them, with their names and the expected Σ (4 − valence) inside.
pub fn all() -> Vec<(&'static str, Boundary)> {
    vec![
        ("disc", disc()),
        ("square", square()),
        ("annulus", annulus()),
        ("L", l_shape()),
        ("half disc", half_disc()),
        ("340° corner", sector(340.0)),
        ("20° wedge", sector(20.0)),
        ("5° wedge", sector(5.0)),
        ("45° wedge", sector(45.0)),
        ("60° wedge", sector(60.0)),
        ("octagon", regular(8)),
        ("triangle", regular(3)),
        ("two holes", two_holes()),
        ("near hole", near_hole(0.01)),
        ("nearer hole", near_hole(1e-4)),
    ]
}
