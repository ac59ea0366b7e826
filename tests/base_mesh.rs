//! Step 1: the base mesh is a valid triangulation inscribed in the boundary.

mod shapes;

use quadrel::base_mesh::{triangulate, usual_size, Request, Triangulation};
use quadrel::domain::{Boundary, Place, Sample};
use quadrel::numerics::{cross, left_normal, Point, Vector};
use shapes::{all, boundary, disc, near_hole, polygon, square};

fn mesh(boundary: &Boundary) -> Triangulation {
    triangulate(boundary, &Request::default()).unwrap()
}

fn corners(mesh: &Triangulation, t: usize) -> [Point; 3] {
    mesh.triangles[t].map(|v| mesh.vertices[v as usize].point)
}

/// Smallest angle of a triangle in degrees.
fn least_angle(p: [Point; 3]) -> f64 {
    (0..3)
        .map(|i| {
            let (a, b) = (p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]);
            cross(a, b).atan2(a.dot(&b)).to_degrees()
        })
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn every_shape_is_triangulated() {
    for (name, b) in all() {
        let m = mesh(&b);
        m.check().unwrap_or_else(|e| panic!("{name}: {e:?}"));
        assert_eq!(m.loops.len(), b.loops.len(), "{name}");
        let area: f64 =
            (0..m.triangles.len()).map(|t| corners(&m, t)).map(|[a, b, c]| 0.5 * cross(b - a, c - a)).sum();
        assert!((area - b.area).abs() < 0.01 * b.area, "{name}: area {area}, {} expected", b.area);
        assert!((300..8000).contains(&m.triangles.len()), "{name}: {} triangles", m.triangles.len());
    }
}

#[test]
fn border_vertices_lie_where_they_say() {
    for (name, b) in all() {
        let m = mesh(&b);
        let mut junctions = vec![0; b.junctions.len()];
        for own in &m.loops {
            for (i, &v) in own.iter().enumerate() {
                let vertex = &m.vertices[v as usize];
                let distance = (b.point(vertex.place).unwrap() - vertex.point).norm();
                // A vertex that refinement put on a chord is off the curve by the arc's height at most.
                assert!(distance < 0.03 * usual_size(&b), "{name}: off by {distance}");
                let next = m.vertices[own[(i + 1) % own.len()] as usize];
                assert!(b.span(vertex.place, next.place).is_some(), "{name}: order along the boundary");
                if let Place::Junction(j) = vertex.place {
                    junctions[j as usize] += 1;
                    assert!(distance < 1e-7, "{name}: junction off by {distance}");
                }
            }
        }
        assert!(junctions.iter().all(|&n| n == 1), "{name}: {junctions:?}");
    }
}

#[test]
fn angles_are_bounded_away_from_sharp_corners() {
    for (name, b) in all() {
        let m = mesh(&b);
        let worst = (0..m.triangles.len()).map(|t| least_angle(corners(&m, t))).fold(90.0, f64::min);
        let sharpest = b.junctions.iter().map(|j| j.angle.to_degrees()).fold(180.0, f64::min);
        let bound = if sharpest < 60.0 { 0.4 * sharpest } else { 20.0 };
        assert!(worst > bound, "{name}: smallest angle {worst}°");
    }
}

#[test]
fn noise_leaves_the_same_mesh() {
    let exact = mesh(&square());
    let noisy = mesh(&boundary(&[polygon(&[[0.0, 1e-13], [1.0, 0.0], [1.0 + 2e-13, 1.0], [0.0, 1.0]])]));
    assert_eq!(exact.triangles, noisy.triangles);
    for (a, b) in exact.vertices.iter().zip(&noisy.vertices) {
        assert_eq!(a.point, b.point);
    }
    assert_eq!(mesh(&disc()), mesh(&disc()));
}

#[test]
fn gaps_are_followed_by_the_border() {
    for gap in [0.1, 1e-2, 1e-3, 1e-5] {
        let b = near_hole(gap);
        let m = mesh(&b);
        m.check().unwrap();
        // Along the gap the polygon's width is the domain's within a fifth.
        let hole: Vec<Point> = m.loops[1].iter().map(|&v| m.vertices[v as usize].point).collect();
        let chain = &b.chains[0];
        let radius = 1.0 / chain.curvature(0.0);
        let center = chain.point(0.0) + left_normal(chain.tangent(0.0)) * radius;
        let width = hole.iter().map(|p| radius - (p - center).norm()).fold(f64::INFINITY, f64::min);
        let exact = gap * radius;
        assert!((width - exact).abs() < 0.2 * exact + 2e-8, "gap {exact}: {width}");
    }
}

#[test]
fn places_are_refined() {
    let b = square();
    let usual = mesh(&b);
    let at = b.junctions[0].point + (b.junctions[2].point - b.junctions[0].point) * 0.31;
    let h = 0.1 * usual_size(&b);
    let fine = triangulate(&b, &Request { size: None, refine: vec![(at, h)] }).unwrap();
    fine.check().unwrap();
    let t = fine.locate(at, 0).unwrap() as usize;
    let [p, q, r] = corners(&fine, t);
    let longest = (q - p).norm().max((r - q).norm()).max((p - r).norm());
    assert!(longest < 1.5 * h, "{longest} for {h}");
    assert!(fine.triangles.len() > usual.triangles.len() + 50);
    assert!(fine.triangles.len() < 2 * usual.triangles.len() + 1000, "{}", fine.triangles.len());
    // On the border too.
    let at = b.junctions[0].point;
    let fine = triangulate(&b, &Request { size: None, refine: vec![(at, h)] }).unwrap();
    fine.check().unwrap();
    let near = fine.loops[0].iter().filter(|&&v| (fine.vertices[v as usize].point - at).norm() < 3.0 * h);
    assert!(near.count() >= 5);
}

#[test]
fn locate_finds_every_triangle() {
    let m = mesh(&shapes::two_holes());
    for t in 0..m.triangles.len() {
        let [a, b, c] = corners(&m, t);
        let center = Point::from((a.coords + b.coords + c.coords) / 3.0);
        assert_eq!(m.locate(center, (t * 7919 % m.triangles.len()) as u32), Some(t as u32));
    }
    assert_eq!(m.locate(Point::new(5.0, 5.0), 0), None);
}

#[test]
fn check_sees_defects() {
    let good = mesh(&square());
    let mut flipped = good.clone();
    flipped.triangles[5].swap(0, 1);
    assert!(flipped.check().is_err());
    let mut deaf = good.clone();
    let inner = deaf.neighbors[7].iter().position(|&n| n != u32::MAX).unwrap();
    deaf.neighbors[7][inner] = 0;
    assert!(deaf.check().is_err());
    let mut short = good.clone();
    short.loops[0].pop();
    assert!(short.check().is_err());
}

#[test]
fn crossing_curves_are_refused_with_their_place() {
    let mut b = near_hole(0.1);
    let aside = Vector::new(0.2, 0.2);
    b.chains[1].samples =
        b.chains[1].samples.iter().map(|x| Sample { point: x.point + aside, ..*x }).collect();
    let error = triangulate(&b, &Request::default()).unwrap_err();
    assert_eq!(error.name(), "base_mesh");
    assert!(error.place().is_some());
}
