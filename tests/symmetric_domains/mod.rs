//! Domains with mirrors and rotations.
#![allow(dead_code)]

use quadrel::domain::{Domain, DomainBuilder, LoopKind};
use quadrel::input;
use std::f64::consts::TAU;
use std::path::{Path, PathBuf};

pub fn domains() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/domains")
}

pub fn file(name: &str) -> Domain {
    input::read(&domains().join(name), None).unwrap().domain
}

pub fn builder(add: impl FnOnce(&mut DomainBuilder) -> quadrel::Result<()>) -> Domain {
    let mut builder = Domain::builder();
    add(&mut builder).unwrap();
    builder.build().unwrap()
}

pub fn circle(b: &mut DomainBuilder, kind: LoopKind, center: [f64; 2], radius: f64) -> quadrel::Result<()> {
    b.begin_loop(kind, "circle")?.add_arc(center, radius, 0.0, TAU, "")?.end_loop()?;
    Ok(())
}

pub fn disc() -> Domain {
    builder(|b| circle(b, LoopKind::Outer, [0.5, -0.25], 2.0))
}

/// A square with a round hole in its middle.
pub fn plate() -> Domain {
    builder(|b| {
        b.add_polygon(LoopKind::Outer, &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])?;
        circle(b, LoopKind::Hole, [0.0, 0.0], 0.45)
    })
}

/// The Gingerbread man's outline as a closed spline without a corner. Its points are mirror images of one another up
/// to 1e-6; here they are exactly.
pub fn gingerbread() -> Domain {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/input/GingerbreadMan.control");
    let text = std::fs::read_to_string(path).unwrap();
    let rows = text.lines().skip_while(|l| !l.contains("\\begin{SPLINE_DATA}")).skip(1);
    let rows = rows.take_while(|l| !l.contains("\\end{SPLINE_DATA}"));
    let mut points: Vec<[f64; 2]> = rows
        .map(|row| {
            let numbers: Vec<f64> = row.split_whitespace().map(|x| x.parse().unwrap()).collect();
            [numbers[1], numbers[2]]
        })
        .collect();
    points.pop();
    assert_eq!(points.len(), 108);
    // The spline starts beside the neck and goes round the head first.
    let n = points.len();
    let partner = |i: usize| (18 + n - i) % n;
    let exact: Vec<[f64; 2]> = (0..n)
        .map(|i| {
            let ([x, y], [u, v]) = (points[i], points[partner(i)]);
            assert!((x + u).abs() < 2e-6 && (y - v).abs() < 2e-6, "point {i} has no image");
            [0.5 * (x - u), 0.5 * (y + v)]
        })
        .collect();
    let closed: Vec<[f64; 2]> = exact.iter().chain(&exact[..1]).copied().collect();
    builder(|b| {
        b.begin_loop(LoopKind::Outer, "body")?.add_spline(&closed, "")?.end_loop()?;
        Ok(())
    })
}

/// A regular polygon's corners, or those of a star or pinwheel: (share of a step, radius) of each corner in a step.
pub fn wheel(steps: usize, profile: &[(f64, f64)]) -> Vec<[f64; 2]> {
    let corner = |k: usize, &(share, radius): &(f64, f64)| {
        let (s, c) = (TAU * (k as f64 + share) / steps as f64).sin_cos();
        [radius * c, radius * s]
    };
    (0..steps).flat_map(|k| profile.iter().map(move |p| corner(k, p))).collect()
}
