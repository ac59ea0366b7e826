//! Domains of lines and circular arcs, as boundaries in the canonical frame.
#![allow(dead_code)]

use quadrel::domain::{Boundary, Domain, DomainBuilder, LoopKind};
use std::f64::consts::{PI, TAU};

#[derive(Debug, Clone, Copy)]
pub enum Piece {
    Line([f64; 2], [f64; 2]),
    /// Center, radius, first angle, swept angle (positive: counter-clockwise).
    Arc([f64; 2], f64, f64, f64),
}

/// The checked domain of these loops.
pub fn domain(loops: &[Vec<Piece>]) -> Domain {
    let mut builder = DomainBuilder::default();
    for pieces in loops {
        builder.begin_loop(LoopKind::Auto, "wall").unwrap();
        for piece in pieces {
            match *piece {
                Piece::Line(a, b) => builder.add_line(a, b, "").unwrap(),
                Piece::Arc(c, r, first, sweep) => builder.add_arc(c, r, first, first + sweep, "").unwrap(),
            };
        }
        builder.end_loop().unwrap();
    }
    builder.build().unwrap()
}

pub fn boundary(loops: &[Vec<Piece>]) -> Boundary {
    Boundary::new(&domain(loops)).unwrap()
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

/// All of them, with their names.
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
