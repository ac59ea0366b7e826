//! The domain and its boundary tables: curves, angles, invariance of the canonical frame.

use quadrel::domain::{Boundary, Domain, DomainBuilder, LoopKind};
use quadrel::numerics::{Point, Vector};
use quadrel::options::{Norm, Tolerance};
use std::f64::consts::PI;

/// One loop made by `add`, as an outer one.
fn outer(add: impl FnOnce(&mut DomainBuilder)) -> Domain {
    let mut builder = Domain::builder();
    builder.begin_loop(LoopKind::Outer, "outer").unwrap();
    add(&mut builder);
    builder.end_loop().unwrap();
    builder.build().unwrap()
}

fn boundary(domain: &Domain) -> Boundary {
    let b = Boundary::new(domain).unwrap();
    b.check().unwrap();
    b
}

/// Largest distance of the tables' interpolant from the exact curve at many arc lengths, and largest error of
/// arc length against a fine polygon through exact points.
fn table_errors(domain: &Domain) -> (f64, f64) {
    let b = boundary(domain);
    let (mut distance, mut length) = (0.0f64, 0.0f64);
    for (k, chain) in b.chains.iter().enumerate() {
        let n = 4000;
        let mut last = chain.samples[0].point;
        let mut polygon = 0.0;
        for i in 0..=n {
            let s = chain.length * i as f64 / n as f64;
            let exact = b.frame.to_canonical(b.exact_point(domain, k as u32, s).unwrap());
            // A closed chain wraps its length to its start.
            distance = distance.max((chain.point(s) - exact).norm());
            polygon += (exact - last).norm();
            last = exact;
        }
        length = length.max((polygon - chain.length).abs());
    }
    (distance, length)
}

#[test]
fn rectangle_has_its_area_angles_and_lengths() {
    let d = Domain::polygon(&[[0.0, 0.0], [3.0, 0.0], [3.0, 4.0], [0.0, 4.0]], &[]).unwrap();
    let b = boundary(&d);
    assert!((d.area().unwrap() - 12.0).abs() < 1e-13);
    assert!((d.diagonal() - 5.0).abs() < 1e-13);
    assert!((b.area * b.frame.scale.powi(2) - 12.0).abs() < 1e-12);
    assert_eq!((b.chains.len(), b.junctions.len()), (4, 4));
    assert!(b.junctions.iter().all(|j| (j.angle - PI / 2.0).abs() < 1e-12));
    let length: f64 = b.chains.iter().map(|c| c.length).sum();
    assert!((length * b.frame.scale - 14.0).abs() < 1e-12);
}

#[test]
fn circle_is_one_closed_chain_of_constant_curvature() {
    let d = outer(|b| {
        b.add_arc([5.0, -2.0], 2.0, 0.0, 2.0 * PI, "").unwrap();
    });
    let b = boundary(&d);
    assert_eq!((b.chains.len(), b.junctions.len()), (1, 0));
    let chain = &b.chains[0];
    assert!(chain.ends.is_none());
    assert!((chain.length * b.frame.scale - 4.0 * PI).abs() < 1e-10);
    assert!((d.area().unwrap() - 4.0 * PI).abs() < 1e-12);
    for i in 0..100 {
        let curvature = chain.curvature(chain.length * i as f64 / 100.0) / b.frame.scale;
        assert!((curvature - 0.5).abs() < 1e-4, "{curvature}");
    }
    let (distance, length) = table_errors(&d);
    assert!(distance < 1e-11, "{distance}");
    assert!(length < 1e-5, "{length}");
}

#[test]
fn elliptic_arc_bezier_and_splines_are_tabulated_exactly() {
    let ellipse = outer(|b| {
        b.add_elliptic_arc([0.0, 0.0], [3.0, 1.0], 0.7, 0.3, 0.3 + 2.0 * PI, "").unwrap();
    });
    // Quintic with coincident first control points: the derivative vanishes at its start.
    let bezier = outer(|b| {
        let c = [[0.0, 0.0], [0.0, 0.0], [0.0, 0.0], [2.0, 3.0], [4.0, -1.0], [4.0, 2.0]];
        b.add_bezier(&c, "").unwrap();
        b.add_line([4.0, 2.0], [0.0, 4.0], "").unwrap();
        b.add_line([0.0, 4.0], [0.0, 0.0], "").unwrap();
    });
    let closed = [[1.0, 0.0], [0.4, 0.9], [-1.0, 0.6], [-0.7, -0.8], [0.3, -1.1], [1.0, 0.0]];
    let periodic = outer(|b| {
        b.add_spline(&closed, "").unwrap();
    });
    let natural = outer(|b| {
        b.add_spline(&[[0.0, 0.0], [1.0, 0.3], [2.0, -0.2], [3.0, 0.0]], "").unwrap();
        b.add_line([3.0, 0.0], [1.0, 5.0], "").unwrap();
        b.add_line([1.0, 5.0], [0.0, 0.0], "").unwrap();
    });
    for (name, d) in
        [("ellipse", &ellipse), ("bezier", &bezier), ("periodic", &periodic), ("natural", &natural)]
    {
        let (distance, length) = table_errors(d);
        assert!(distance < 3e-11, "{name}: {distance}");
        assert!(length < 1e-5, "{name}: {length}");
    }
    assert!((ellipse.area().unwrap() - 3.0 * PI).abs() < 1e-10);
    // A periodic spline has no corner at its seam, and its knots are breaks.
    let b = boundary(&periodic);
    assert!(b.junctions.is_empty());
    assert_eq!(b.chains[0].breaks.len(), closed.len() - 2);
    for p in closed {
        let near = (0..20000).map(|i| b.chains[0].point(b.chains[0].length * i as f64 / 20000.0));
        let p = b.frame.to_canonical(Point::from(p));
        let distance = near.map(|q| (q - p).norm()).fold(f64::INFINITY, f64::min);
        assert!(distance < 1e-4, "the spline passes its points: {distance}");
    }
}

#[test]
fn callback_without_derivative_and_with_wild_parametrisation_is_arc_length() {
    // Half a circle whose parameter stands still at both ends, and a straight line back.
    let d = outer(|b| {
        let half = |t: f64| {
            let a = PI * t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
            Ok([a.cos(), a.sin()])
        };
        b.add_callback(Box::new(half), None, "").unwrap();
        b.add_line([-1.0, 0.0], [1.0, 0.0], "").unwrap();
    });
    let b = boundary(&d);
    assert_eq!(b.junctions.len(), 2);
    for j in &b.junctions {
        assert!((j.angle - PI / 2.0).abs() < 1e-6, "{}", j.angle);
    }
    let arc = b.chains.iter().find(|c| c.samples.len() > 2).unwrap();
    assert!((arc.length * b.frame.scale - PI).abs() < 1e-9, "{}", arc.length * b.frame.scale - PI);
    let center = b.frame.to_canonical(Point::origin());
    for i in 0..1000 {
        let p = arc.point(arc.length * i as f64 / 1000.0);
        assert!(((p - center).norm() * b.frame.scale - 1.0).abs() < 1e-9);
    }
}

#[test]
fn exact_point_lies_at_the_arc_length_asked_for() {
    let d = outer(|b| {
        let blob = |t: f64| {
            let a = 2.0 * PI * t;
            Ok([4.0 * a.cos() - 0.6 * (4.0 * a).cos().powi(3), 4.0 * a.sin() - 0.5 * (5.5 * a).sin().powi(2)])
        };
        b.add_callback(Box::new(blob), None, "").unwrap();
    });
    let b = boundary(&d);
    let chain = &b.chains[0];
    let n = 37;
    for i in 0..n {
        let (s0, s1) = (chain.length * i as f64 / n as f64, chain.length * (i as f64 + 0.013) / n as f64);
        let [p, q] = [s0, s1].map(|s| b.exact_point(&d, 0, s).unwrap());
        let chord = (p - q).norm() / b.frame.scale;
        // A chord is shorter than its arc by κ² s³ / 24, here for the largest curvature.
        let bend = chain.samples.iter().map(|x| x.curvature.abs()).fold(0.0, f64::max);
        let short = (bend * (s1 - s0)).powi(2) / 24.0 * (s1 - s0);
        assert!(chord < s1 - s0 + 1e-11 && chord > s1 - s0 - 1.1 * short - 1e-11, "{chord} {}", s1 - s0);
        assert!((b.frame.to_canonical(p) - chain.point(s0)).norm() < 1e-10);
    }
}

#[test]
fn slit_end_has_two_pi_and_reentrant_corner_more_than_pi() {
    // Two arcs that leave the tip tangentially, the domain outside of them.
    let mut b = Domain::builder();
    b.add_polygon(LoopKind::Outer, &[[-3.0, -3.0], [3.0, -3.0], [3.0, 3.0], [-3.0, 3.0]]).unwrap();
    b.begin_loop(LoopKind::Hole, "drop").unwrap();
    b.add_bezier(&[[0.0, 0.0], [1.0, 0.0], [2.0, 1.0]], "").unwrap();
    b.add_line([2.0, 1.0], [2.0, -1.0], "").unwrap();
    b.add_bezier(&[[2.0, -1.0], [1.0, 0.0], [0.0, 0.0]], "").unwrap();
    b.end_loop().unwrap();
    let d = b.build().unwrap();
    d.check().unwrap();
    let angles: Vec<f64> = boundary(&d).junctions.iter().map(|j| j.angle).collect();
    assert_eq!(angles.iter().filter(|a| (**a - 2.0 * PI).abs() < 1e-9).count(), 1, "{angles:?}");
    let l = Domain::polygon(&[[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.]], &[]).unwrap();
    let reentrant = boundary(&l).junctions.iter().filter(|j| (j.angle - 1.5 * PI).abs() < 1e-12).count();
    assert_eq!(reentrant, 1);
}

#[test]
fn smooth_joint_is_a_break_and_a_new_name_a_junction() {
    let halves = |second: &'static str| {
        outer(|b| {
            b.add_arc([0.0, 0.0], 1.0, 0.0, PI, "wall").unwrap();
            b.add_arc([0.0, 0.0], 1.0, PI, 2.0 * PI, second).unwrap();
        })
    };
    let same = boundary(&halves("wall"));
    assert_eq!((same.chains.len(), same.junctions.len(), same.chains[0].breaks.len()), (1, 0, 1));
    let two = boundary(&halves("inlet"));
    assert_eq!((two.chains.len(), two.junctions.len()), (2, 2));
    assert!(two.junctions.iter().all(|j| (j.angle - PI).abs() < 1e-9));
    assert_eq!(two.names, ["wall", "inlet"]);
}

#[test]
fn tolerances_are_converted_to_the_canonical_frame() {
    let d = Domain::polygon(&[[0.0, 0.0], [3.0, 0.0], [3.0, 4.0], [0.0, 4.0]], &[]).unwrap();
    let b = boundary(&d);
    // The rectangle's least bounding box is itself, of diagonal 5; never more than that is allowed.
    for norm in [Norm::L2, Norm::H1, Norm::Max] {
        let power = if norm == Norm::Max { 5.0 } else { 5.0f64.powf(1.5) };
        let relative = b.canonical_tolerance(Tolerance::Relative(1e-3), norm);
        let absolute = b.canonical_tolerance(Tolerance::Absolute(1e-3 * power), norm);
        let share = relative / absolute;
        assert!(share > 0.985 && share <= 1.0, "{share}");
    }
    // Turned by 45 degrees, where its bounding box is larger.
    let c = 0.5f64.sqrt();
    let turned = [[0.0, 0.0], [3.0, 0.0], [3.0, 4.0], [0.0, 4.0]].map(|[x, y]| [c * (x - y), c * (x + y)]);
    let turned = boundary(&Domain::polygon(&turned, &[]).unwrap());
    assert!((turned.diagonal / b.diagonal - 1.0).abs() < 1e-12);
}

#[test]
fn corners_inside_a_callback_are_junctions() {
    // A whole square as one curve, and one with a bend of 0.01 rad inside a side.
    let square = |t: f64| {
        let u = 4.0 * (t % 1.0);
        let side = [u, 1.0, 3.0 - u, 0.0];
        let k = (u as usize).min(3);
        Ok([side[k].clamp(0.0, 1.0), [0.0, u - 1.0, 1.0, 4.0 - u][k]])
    };
    let d = outer(|b| {
        b.add_callback(Box::new(square), None, "").unwrap();
    });
    let b = boundary(&d);
    assert!((d.area().unwrap() - 1.0).abs() < 1e-9);
    assert_eq!(b.junctions.len(), 4);
    assert!(b.junctions.iter().all(|j| (j.angle - PI / 2.0).abs() < 1e-7));
    assert!(b.chains.iter().all(|c| (c.length * b.frame.scale - 1.0).abs() < 1e-9));
    let bent = outer(|b| {
        b.add_callback(Box::new(|t| Ok([3.0 * t, -0.005 + 0.005 * (3.0 * t - 1.0).abs()])), None, "")
            .unwrap();
        b.add_line([3.0, 0.005], [0.0, 2.0], "").unwrap();
        b.add_line([0.0, 2.0], [0.0, 0.0], "").unwrap();
    });
    let b = boundary(&bent);
    let bend = b.junctions.iter().find(|j| (j.angle - PI).abs() < 0.1).unwrap();
    assert!((PI - bend.angle - 0.01).abs() < 1e-4, "{}", bend.angle);
    let x = b.frame.to_caller(bend.point).x;
    assert!((x - 1.0).abs() < 1e-9, "{x}");
}

/// A transformation of the test domain and how its loops are given.
#[derive(Clone, Copy)]
struct Pose {
    scale: f64,
    angle: f64,
    shift: [f64; 2],
    reversed: bool,
    start: usize,
}

const AS_IS: Pose = Pose { scale: 1.0, angle: 0.0, shift: [0.0; 2], reversed: false, start: 0 };

/// Lines, arcs, Béziers and a spline, with two holes.
fn shape(pose: Pose) -> Domain {
    let (sin, cos) = if pose.angle == 0.0 { (0.0, 1.0) } else { pose.angle.sin_cos() };
    let at = |p: [f64; 2]| {
        let p = [p[0] * pose.scale, p[1] * pose.scale];
        [p[0] * cos - p[1] * sin + pose.shift[0], p[0] * sin + p[1] * cos + pose.shift[1]]
    };
    enum S {
        Bezier(Vec<[f64; 2]>),
        Spline(Vec<[f64; 2]>),
        Arc([f64; 2], f64, f64, f64),
    }
    let loops = [
        vec![
            S::Bezier(vec![[0.0, 0.0], [6.0, 0.0]]),
            S::Bezier(vec![[6.0, 0.0], [7.0, 1.0], [5.0, 3.0], [6.0, 4.0]]),
            S::Bezier(vec![[6.0, 4.0], [3.0, 5.0], [0.5, 4.0]]),
            S::Spline(vec![[0.5, 4.0], [-0.5, 3.0], [0.25, 1.5], [-0.25, 0.5], [0.0, 0.0]]),
        ],
        vec![S::Arc([1.5, 2.0], 0.5, 0.25, 0.25 + PI), S::Arc([1.5, 2.0], 0.5, 0.25 + PI, 0.25 + 2.0 * PI)],
        vec![
            S::Bezier(vec![[3.5, 1.0], [4.5, 1.25]]),
            S::Bezier(vec![[4.5, 1.25], [4.0, 2.5]]),
            S::Bezier(vec![[4.0, 2.5], [3.5, 1.0]]),
        ],
    ];
    let mut b = Domain::builder();
    for (k, l) in loops.iter().enumerate() {
        b.begin_loop(if k == 0 { LoopKind::Outer } else { LoopKind::Hole }, "wall").unwrap();
        let n = l.len();
        for i in 0..n {
            let i = (i + pose.start) % n;
            let i = if pose.reversed { n - 1 - i } else { i };
            match &l[i] {
                S::Bezier(p) | S::Spline(p) => {
                    let mut p: Vec<_> = p.iter().map(|&p| at(p)).collect();
                    if pose.reversed {
                        p.reverse();
                    }
                    match l[i] {
                        S::Spline(_) => b.add_spline(&p, "").unwrap(),
                        _ => b.add_bezier(&p, "").unwrap(),
                    };
                }
                S::Arc(c, r, from, to) => {
                    let (from, to) = (from + pose.angle, to + pose.angle);
                    let (from, to) = if pose.reversed { (to, from) } else { (from, to) };
                    b.add_arc(at(*c), r * pose.scale, from, to, "").unwrap();
                }
            }
        }
        b.end_loop().unwrap();
    }
    b.build().unwrap()
}

#[test]
fn tables_are_the_same_bits_when_scaled_by_powers_of_two_or_given_backwards() {
    let reference = boundary(&shape(AS_IS));
    let up = 2.0f64.powi(20);
    for pose in [
        Pose { scale: up, ..AS_IS },
        Pose { scale: 1.0 / up, ..AS_IS },
        Pose { reversed: true, ..AS_IS },
        Pose { reversed: true, scale: up, ..AS_IS },
    ] {
        let b = boundary(&shape(pose));
        assert_eq!(b.area, reference.area);
        assert_eq!(b.junctions, reference.junctions);
        assert_eq!(b.chains.len(), reference.chains.len());
        for (x, y) in b.chains.iter().zip(&reference.chains) {
            assert_eq!((x.length, &x.breaks, x.samples.len()), (y.length, &y.breaks, y.samples.len()));
            for (p, q) in x.samples.iter().zip(&y.samples) {
                assert_eq!((p.s, p.point, p.tangent, p.curvature), (q.s, q.point, q.tangent, q.curvature));
            }
        }
    }
}

#[test]
fn tables_agree_to_rounding_in_any_pose_and_from_any_start() {
    let reference = boundary(&shape(AS_IS));
    // Coordinates 1000 diagonals away have lost three digits, those of the caller's own.
    for (pose, tolerance) in [
        (Pose { angle: 0.3, ..AS_IS }, 1e-11),
        (Pose { scale: 1e6, ..AS_IS }, 1e-11),
        (Pose { scale: 1e-6, ..AS_IS }, 1e-11),
        (Pose { start: 1, ..AS_IS }, 1e-11),
        (Pose { start: 2, reversed: true, ..AS_IS }, 1e-11),
        (Pose { shift: [8000.0, -3000.0], ..AS_IS }, 1e-10),
        (Pose { shift: [-5.0, 2.0], angle: 2.5, scale: 17.0, start: 3, ..AS_IS }, 1e-11),
    ] {
        let b = boundary(&shape(pose));
        assert_eq!(b.junctions.len(), reference.junctions.len());
        assert!((b.area - reference.area).abs() < 10.0 * tolerance);
        for (x, y) in b.junctions.iter().zip(&reference.junctions) {
            assert!((x.point - y.point).norm() < tolerance, "{} {}", x.point, y.point);
            assert!((x.angle - y.angle).abs() < 1e-7);
        }
        for (x, y) in b.chains.iter().zip(&reference.chains) {
            assert!((x.length - y.length).abs() < 10.0 * tolerance);
            for i in 0..=50 {
                let share = i as f64 / 50.0;
                // Closed smooth loops start at the same joint; the shares then name the same points.
                let d: Vector = x.point(share * x.length) - y.point(share * y.length);
                assert!(d.norm() < 10.0 * tolerance, "{}", d.norm());
            }
        }
    }
}

#[test]
fn canonical_diagonal_is_one_and_centroid_the_origin() {
    for angle in [0.0, 0.3, 1.0] {
        let b = boundary(&shape(Pose { angle, shift: [3.0, 4.0], ..AS_IS }));
        let points = b.chains.iter().flat_map(|c| &c.samples).map(|s| s.point);
        let (mut low, mut high) = (Point::new(1.0, 1.0), Point::new(-1.0, -1.0));
        for p in points {
            low = Point::new(low.x.min(p.x), low.y.min(p.y));
            high = Point::new(high.x.max(p.x), high.y.max(p.y));
        }
        assert!(((high - low).norm() - 1.0).abs() < 1e-3);
    }
}

/// A plate with holes in it, turned by `angle`, its corners given from number `start` on.
fn plate(corners: &[[f64; 2]], holes: &[([f64; 2], f64)], angle: f64, start: usize) -> Boundary {
    let (sin, cos) = if angle == 0.0 { (0.0, 1.0) } else { angle.sin_cos() };
    let at = |p: [f64; 2]| [p[0] * cos - p[1] * sin, p[0] * sin + p[1] * cos];
    let n = corners.len();
    let mut b = Domain::builder();
    let turned: Vec<_> = (0..n).map(|i| at(corners[(i + start) % n])).collect();
    b.add_polygon(LoopKind::Outer, &turned).unwrap();
    for &(center, radius) in holes {
        b.begin_loop(LoopKind::Hole, "").unwrap();
        b.add_arc(at(center), radius, angle, angle + 2.0 * PI, "").unwrap();
        b.end_loop().unwrap();
    }
    let domain = b.build().unwrap();
    domain.check().unwrap();
    boundary(&domain)
}

#[test]
fn symmetric_domains_have_one_pose() {
    let square = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let isosceles = [[-1.0, 0.0], [1.0, 0.0], [0.0, 0.5]];
    let rectangle = [[-2.0, -1.0], [2.0, -1.0], [2.0, 1.0], [-2.0, 1.0]];
    let grid: Vec<_> =
        (0..9).map(|k| ([(k % 3) as f64 * 0.5 - 0.5, (k / 3) as f64 * 0.5 - 0.5], 0.1)).collect();
    let pair = [([0.5, 0.0], 0.2), ([-0.5, 0.0], 0.2)];
    for (corners, holes) in [
        (&square[..], &grid[..]),
        (&square[..], &pair[..]),
        (&square[..], &[]),
        (&isosceles[..], &[]),
        (&rectangle[..], &pair[..]),
    ] {
        let reference = plate(corners, holes, 0.0, 0);
        for (angle, start) in [(0.3, 0), (1.9, 1), (3.7, 2), (PI, 0)] {
            let b = plate(corners, holes, angle, start);
            for (x, y) in b.junctions.iter().zip(&reference.junctions) {
                assert!((x.point - y.point).norm() < 1e-9, "{angle}: {} {}", x.point, y.point);
            }
            // The seams of the holes are the caller's, so only the circles can be compared.
            let centers = |b: &Boundary| -> Vec<Point> {
                let closed = b.chains.iter().filter(|c| c.ends.is_none());
                closed.map(|c| nalgebra::center(&c.point(0.0), &c.point(0.5 * c.length))).collect()
            };
            for (x, y) in centers(&b).iter().zip(&centers(&reference)) {
                assert!((x - y).norm() < 1e-9, "{angle}: {x} {y}");
            }
        }
    }
}
