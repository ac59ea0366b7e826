//! The boundary error of an edge, and where step 7 puts the vertices of a chain.

mod support;

use quadrel::domain::{Boundary, Chain, Span};
use quadrel::mesh::{BoundaryError, BoundaryTolerance};
use quadrel::numerics::{GaussLegendre, GaussLobatto, Interpolation, Point};
use quadrel::options::{Norm, Options, Tolerance};
use quadrel::refine::{least_pieces, place_by_halving, place_equal_error, Placement};
use quadrel::Error;
use std::f64::consts::{PI, TAU};
use support::{boundary, chain, ellipse, segment, wavy_spline};

fn measure(norm: Norm, order: usize, value: f64) -> BoundaryError {
    BoundaryError::new(BoundaryTolerance { norm, order, value })
}

fn l2(order: usize, value: f64) -> BoundaryError {
    measure(Norm::L2, order, value)
}

fn circle() -> Boundary {
    boundary(vec![vec![chain(&ellipse(0.5, 0.5), 4000, true, &[])]])
}

/// The same error by brute force on the exact unit-speed circle of radius 0.5.
fn circle_error(norm: Norm, order: usize, length: f64) -> f64 {
    let nodes = GaussLobatto::new(order).nodes;
    let x = |s: f64| Point::new(0.5 * (2.0 * s).cos(), 0.5 * (2.0 * s).sin());
    let points: Vec<Point> = nodes.iter().map(|xi| x(0.5 * (1.0 + xi) * length)).collect();
    let edge = Interpolation::new(nodes);
    let distance = |s: f64| (x(s) - edge.point(&points, 2.0 * s / length - 1.0)).norm();
    let panels = 400;
    let rule = GaussLegendre::new(4);
    let h = length / panels as f64;
    match norm {
        Norm::Max => (0..=20000).map(|i| distance(length * i as f64 / 20000.0)).fold(0.0, f64::max),
        _ => (0..panels)
            .map(|i| rule.integrate(i as f64 * h, (i + 1) as f64 * h, |s| distance(s).powi(2)))
            .sum::<f64>()
            .sqrt(),
    }
}

#[test]
fn error_of_a_circular_edge_agrees_with_brute_force() {
    let b = circle();
    for order in [1, 2, 4, 5, 8] {
        for length in [0.3, 0.8] {
            let span = Span { chain: 0, start: 0.1, end: 0.1 + length };
            for norm in [Norm::L2, Norm::Max] {
                let (ours, exact) =
                    (measure(norm, order, 1.0).of_span(&b, span), circle_error(norm, order, length));
                assert!((ours - exact).abs() < 0.01 * exact + 1e-13, "{norm:?} {order}: {ours} {exact}");
            }
            let (h1, plain) =
                (measure(Norm::H1, order, 1.0).of_span(&b, span), l2(order, 1.0).of_span(&b, span));
            assert!(h1 > plain, "the derivative adds to the norm");
        }
    }
}

#[test]
fn error_falls_with_the_power_of_the_edge_length() {
    let b = circle();
    for (norm, extra) in [(Norm::L2, 1.5), (Norm::H1, 1.5), (Norm::Max, 1.0)] {
        for order in [2, 3, 5] {
            let error = measure(norm, order, 1.0);
            let at = |length: f64| error.of_span(&b, Span { chain: 0, start: 0.2, end: 0.2 + length });
            let slope = (at(0.4) / at(0.2)).log2();
            assert!((slope - (order as f64 + extra)).abs() < 0.15, "{norm:?}, order {order}: {slope}");
        }
    }
}

#[test]
fn a_kink_between_quadrature_points_is_not_missed() {
    // Two straight pieces that meet at a break at an angle of 0.02 rad.
    let bent = |t: f64| {
        let k = 0.7;
        if t < k {
            segment([0.0, 0.0], [1.0, 0.0])(t)
        } else {
            let (p, d) = segment([0.0, 0.0], [1.0, 0.02])(t - k);
            (p + quadrel::numerics::Vector::new(k, 0.0), d)
        }
    };
    let c = chain(&bent, 1000, false, &[0.7]);
    let error = l2(5, 1.0).of_chain(&c, 0.0, c.length);
    // Brute force against the same polynomial with 10,000 points.
    let nodes = GaussLobatto::new(5).nodes;
    let points: Vec<Point> = nodes.iter().map(|x| c.point(0.5 * (1.0 + x) * c.length)).collect();
    let edge = Interpolation::new(nodes);
    let n = 10_000;
    let sum: f64 = (0..n)
        .map(|i| (i as f64 + 0.5) / n as f64)
        .map(|x| (c.point(x * c.length) - edge.point(&points, 2.0 * x - 1.0)).norm_squared())
        .sum();
    let exact = (sum * c.length / n as f64).sqrt();
    assert!((error - exact).abs() < 0.01 * exact, "{error} {exact}");
}

#[test]
fn a_span_over_the_seam_has_the_same_error_as_any_other() {
    let b = circle();
    let length = b.chains[0].length;
    let error = l2(5, 1.0);
    let at = |start: f64| error.of_span(&b, Span { chain: 0, start, end: start + 0.5 });
    assert!((at(length - 0.2) / at(0.4) - 1.0).abs() < 1e-3);
}

#[test]
fn absolute_tolerances_scale_with_the_frame() {
    let mut b = circle();
    b.frame.scale = 4.0;
    b.diagonal = 1.5;
    let value = |norm, tolerance| {
        let options = Options { norm, tolerance, ..Options::default() };
        let t = BoundaryTolerance::new(&options, &b);
        assert!(
            (t.in_caller_frame(&b.frame).value / t.value - if norm == Norm::Max { 4.0 } else { 8.0 }).abs()
                < 1e-12
        );
        t.value
    };
    assert!((value(Norm::L2, Tolerance::Absolute(0.08)) - 0.01).abs() < 1e-15);
    assert!((value(Norm::H1, Tolerance::Absolute(0.08)) - 0.01).abs() < 1e-15);
    assert!((value(Norm::Max, Tolerance::Absolute(0.08)) - 0.02).abs() < 1e-15);
    // The caller's diagonal is 1.5 in this frame.
    assert!((value(Norm::L2, Tolerance::Relative(1e-5)) - 1e-5 * 1.5f64.powf(1.5)).abs() < 1e-19);
    assert!((value(Norm::Max, Tolerance::Relative(1e-5)) - 1.5e-5).abs() < 1e-19);
}

/// Whether the placement covers the chain, and what its largest error is.
fn check(c: &Chain, error: &BoundaryError, p: &Placement) -> f64 {
    let (first, last) = (p.positions[0], p.positions[p.positions.len() - 1]);
    assert!((last - first - c.length).abs() < 1e-12 && (c.ends.is_none() || first == 0.0));
    assert!(p.positions.windows(2).all(|w| w[0] < w[1]));
    let largest = p
        .positions
        .windows(2)
        .map(|w| error.of_chain(c, w[0], w[1]) / error.tolerance.value)
        .fold(0.0, f64::max);
    assert!((largest - p.largest).abs() <= 1e-12 * largest);
    largest
}

/// Chains of every kind: smooth, with spread curvature, with straight parts, with breaks.
fn chains() -> Vec<(&'static str, Chain)> {
    let wave = |t: f64| {
        let (s, c) = (TAU * 3.0 * t * t).sin_cos();
        (Point::new(t, 0.1 * s), quadrel::numerics::Vector::new(1.0, 0.1 * c * TAU * 6.0 * t))
    };
    // A stadium's half: line, half circle, line.
    let stadium = |t: f64| match t {
        t if t < 0.25 => segment([0.0, 0.0], [2.0, 0.0])(t),
        t if t < 0.75 => {
            let a = -PI / 2.0 + (t - 0.25) * TAU;
            let r = 0.2;
            (
                Point::new(0.5 + r * a.cos(), r + r * a.sin()),
                quadrel::numerics::Vector::new(-r * a.sin(), r * a.cos()) * TAU,
            )
        }
        t => segment([0.5, 0.4], [-1.5, 0.4])(t - 0.75),
    };
    let knots: Vec<f64> = (1..15).map(|k| k as f64 / 15.0).collect();
    vec![
        ("circle", chain(&ellipse(0.5, 0.5), 4000, true, &[])),
        ("ellipse", chain(&ellipse(0.5, 0.05), 8000, true, &[])),
        ("wave", chain(&wave, 8000, false, &[])),
        ("stadium", chain(&stadium, 4000, false, &[0.25, 0.75])),
        ("line", chain(&segment([0.0, 0.0], [0.6, 0.8]), 10, false, &[])),
        ("spline", chain(&wavy_spline(15, 0.4), 4500, true, &knots)),
    ]
}

#[test]
fn equal_error_succeeds_at_exactly_the_least_count() {
    for (name, c) in chains() {
        for (order, value) in [(2, 1e-4), (5, 1e-5), (5, 1e-2), (8, 1e-7), (12, 1e-9)] {
            let error = l2(order, value);
            let least = least_pieces(&c, &error).unwrap();
            assert!(least >= if c.ends.is_none() { 3 } else { 1 });
            for k in [least, least + 1, 2 * least + 3, 5 * least] {
                let p = place_equal_error(&c, &error, k, 0.3);
                assert_eq!(p.positions.len(), k + 1, "{name}, order {order}, {k} edges");
                let largest = check(&c, &error, &p);
                assert!(largest <= 1.0, "{name}, order {order}, {k} of {least} edges: {largest}");
                if k > 2 * least {
                    assert!(largest <= 0.9, "{name}, order {order}, {k} of {least} edges: {largest}");
                }
            }
        }
    }
}

#[test]
fn least_counts_match_the_circle_and_the_line() {
    // The unit circle at order 5 and an absolute L2 tolerance of 1e-5 needs five edges.
    let b = circle();
    let tolerance = 1e-5 / 2f64.powf(1.5);
    assert_eq!(least_pieces(&b.chains[0], &l2(5, tolerance)).unwrap(), 5);
    let line = chain(&segment([0.0, 0.0], [0.6, 0.8]), 10, false, &[]);
    assert_eq!(least_pieces(&line, &l2(1, 1e-12)).unwrap(), 1);
}

#[test]
fn spare_edges_on_a_line_are_spaced_evenly() {
    let line = chain(&segment([0.0, 0.0], [0.6, 0.8]), 10, false, &[]);
    let p = place_equal_error(&line, &l2(5, 1e-5), 7, 0.0);
    for (i, s) in p.positions.iter().enumerate() {
        assert!((s - line.length * i as f64 / 7.0).abs() < 1e-9);
    }
}

#[test]
fn halving_goes_on_until_the_norm_holds() {
    for (name, c) in chains() {
        for norm in [Norm::L2, Norm::H1, Norm::Max] {
            let error = measure(norm, 4, 1e-5);
            let whole = vec![0.0, 0.3 * c.length, c.length];
            let p = place_by_halving(&c, &error, &whole).unwrap();
            let largest = check(&c, &error, &p);
            assert!(largest <= 1.0 && (p.positions.len() > 3 || name == "line"), "{name}: {largest}");
            // Every new vertex halves an edge in arc length: none was halved without need.
            for w in p.positions.windows(3) {
                if (w[2] - w[1] - (w[1] - w[0])).abs() < 1e-12 && !whole.contains(&w[1]) {
                    let joined = error.of_chain(&c, w[0], w[2]) > error.tolerance.value;
                    let parent = |h: f64| {
                        let cell = if w[0] >= whole[1] { (whole[1], whole[2]) } else { (whole[0], whole[1]) };
                        let k = (w[0] - cell.0) / h;
                        (k / 2.0 - (k / 2.0).round()).abs() < 1e-6
                    };
                    assert!(joined || !parent(w[1] - w[0]), "{name}: halved without need");
                }
            }
        }
    }
}

#[test]
fn equal_error_needs_fewer_edges_than_halving_where_curvature_varies() {
    for (name, c) in chains().into_iter().filter(|(n, _)| ["ellipse", "spline", "wave"].contains(n)) {
        let error = l2(5, 1e-6);
        let thirds: Vec<f64> = (0..=3).map(|i| c.length * i as f64 / 3.0).collect();
        let halved = place_by_halving(&c, &error, &thirds).unwrap().positions.len() - 1;
        let least = least_pieces(&c, &error).unwrap();
        assert!((least as f64) < 0.85 * halved as f64, "{name}: {least} against {halved}");
        assert!(place_equal_error(&c, &error, least, 0.0).largest <= 1.0);
    }
}

#[test]
fn equal_error_is_equal() {
    let c = chain(&ellipse(0.5, 0.05), 8000, true, &[]);
    let error = l2(5, 1e-7);
    let k = least_pieces(&c, &error).unwrap();
    let p = place_equal_error(&c, &error, k, 0.0);
    let errors: Vec<f64> = p.positions.windows(2).map(|w| error.of_chain(&c, w[0], w[1])).collect();
    let (low, high) = errors.iter().fold((f64::MAX, 0f64), |(l, h), e| (l.min(*e), h.max(*e)));
    assert!(high / low < 4.0, "{low} {high}");
}

#[test]
fn a_tolerance_below_rounding_is_refused_with_its_place() {
    let c = chain(&ellipse(0.5, 0.5), 4000, true, &[]);
    let error = l2(5, 1e-30);
    assert!(matches!(least_pieces(&c, &error), Err(Error::Tolerance { .. })));
    assert!(matches!(place_by_halving(&c, &error, &[0.0, c.length]), Err(Error::Tolerance { .. })));
}
