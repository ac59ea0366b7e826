//! Quadrature, interpolation and transfinite maps: exactness on what they must be exact for.

use quadrel::numerics::bernstein::{bernstein_from_chebyshev, chebyshev_from_values};
use quadrel::numerics::interpolation::{chebyshev_lobatto, equispaced};
use quadrel::numerics::{coons_map, legendre, GaussLegendre, GaussLobatto, Interpolation, Point};

fn monomial_integral(k: i32) -> f64 {
    if k % 2 == 0 {
        2.0 / (k + 1) as f64
    } else {
        0.0
    }
}

#[test]
fn lobatto_rules_are_exact_to_degree_2n_minus_1_and_no_further() {
    for n in 1..=32 {
        let rule = GaussLobatto::new(n);
        assert_eq!(rule.order(), n);
        let integral = |k: i32| rule.nodes.iter().zip(&rule.weights).map(|(x, w)| w * x.powi(k)).sum::<f64>();
        for k in 0..2 * n as i32 {
            assert!((integral(k) - monomial_integral(k)).abs() < 1e-14, "order {n}, degree {k}");
        }
        if n < 12 {
            // The error at degree 2N is not lost in rounding for these orders.
            let k = 2 * n as i32;
            assert!((integral(k) - monomial_integral(k)).abs() > 1e-9, "order {n}");
        }
        for k in 0..=n {
            assert_eq!(rule.nodes[k], -rule.nodes[n - k]);
        }
        assert!(rule.nodes.windows(2).all(|w| w[0] < w[1]));
    }
}

#[test]
fn legendre_rules_are_exact_to_degree_2n_minus_1() {
    for n in 1..=48 {
        let rule = GaussLegendre::new(n);
        for k in 0..2 * n as i32 {
            let integral = rule.integrate(-1.0, 1.0, |x| x.powi(k));
            assert!((integral - monomial_integral(k)).abs() < 1e-14, "{n} points, degree {k}");
        }
        assert!(rule.nodes.windows(2).all(|w| w[0] < w[1]));
    }
}

#[test]
fn legendre_polynomials_match_their_closed_forms() {
    for x in [-1.0, -0.3, 0.0, 0.7, 1.0] {
        assert_eq!(legendre(0, x), (1.0, 0.0));
        assert!((legendre(3, x).0 - 0.5 * (5.0 * x * x * x - 3.0 * x)).abs() < 1e-15);
        assert!((legendre(3, x).1 - 0.5 * (3.0 * x * x - 1.0)).abs() < 1e-15);
    }
}

#[test]
fn interpolation_reproduces_polynomials_and_their_derivatives() {
    let targets: Vec<f64> = (0..40).map(|i| -1.0 + i as f64 / 19.5).collect();
    for n in 1..=32usize {
        let gll = GaussLobatto::new(n);
        let interpolation = Interpolation::new(gll.nodes.clone());
        let values = nalgebra::DVector::from_iterator(n + 1, gll.nodes.iter().map(|x| legendre(n, *x).0));
        let at = interpolation.matrix(&targets) * &values;
        let slope = interpolation.derivative_matrix(&targets) * &values;
        for (r, x) in targets.iter().enumerate() {
            let (p, q) = legendre(n, *x);
            assert!((at[r] - p).abs() < 1e-13, "order {n}");
            if x.abs() < 0.999 {
                let derivative = n as f64 * (q - x * p) / (1.0 - x * x);
                assert!((slope[r] - derivative).abs() < 1e-11 * (n * n) as f64, "order {n} at {x}");
            }
        }
        let points: Vec<Point> = gll.nodes.iter().map(|x| Point::new(*x, legendre(n, *x).0)).collect();
        for x in &targets {
            let p = interpolation.point(&points, *x);
            assert!((p.x - x).abs() < 1e-14 && (p.y - legendre(n, *x).0).abs() < 1e-13);
        }
    }
}

#[test]
fn interpolation_of_a_smooth_function_converges_spectrally() {
    let error = |n: usize| {
        let interpolation = Interpolation::new(GaussLobatto::new(n).nodes);
        let points: Vec<Point> =
            interpolation.nodes.iter().map(|x| Point::new(*x, (3.0 * x).sin())).collect();
        (0..200)
            .map(|i| -1.0 + i as f64 / 99.5)
            .map(|x| (interpolation.point(&points, x).y - (3.0 * x).sin()).abs())
            .fold(0.0, f64::max)
    };
    assert!(error(4) > 1e-2 && error(8) < 1e-3 && error(16) < 1e-10);
}

#[test]
fn node_families_have_their_ends_and_symmetry() {
    for n in 1..=32 {
        for nodes in [equispaced(n), chebyshev_lobatto(n)] {
            assert_eq!((nodes.len(), nodes[0], nodes[n]), (n + 1, -1.0, 1.0));
            assert!((0..=n).all(|k| nodes[k] == -nodes[n - k]));
        }
    }
}

/// A map whose sides are curved and that is of degree 1 across, so that the Coons map is exact.
fn ruled(xi: f64, eta: f64) -> Point {
    let x = 0.5 * (1.0 + xi);
    let y = 0.5 * (1.0 + eta);
    Point::new(2.0 * x + 0.3 * x * x * (1.0 - y) + y * y, y + 0.2 * x * x * x * y - 0.1 * x * y * y)
}

#[test]
fn coons_map_keeps_its_sides_and_reproduces_ruled_maps() {
    for n in [1, 2, 5, 9] {
        let nodes = GaussLobatto::new(n).nodes;
        let side = |f: &dyn Fn(f64) -> Point| nodes.iter().map(|x| f(*x)).collect::<Vec<_>>();
        let sides = [
            side(&|s| ruled(s, -1.0)),
            side(&|s| ruled(1.0, s)),
            side(&|s| ruled(-s, 1.0)),
            side(&|s| ruled(-1.0, -s)),
        ];
        let mut map = Vec::new();
        coons_map(&nodes, [0, 1, 2, 3].map(|s| sides[s].as_slice()), &mut map);
        assert_eq!(map.len(), (n + 1) * (n + 1));
        for j in 0..=n {
            assert_eq!(map[j * (n + 1) + n], sides[1][j]);
            assert_eq!(map[j * (n + 1)], sides[3][n - j]);
            for i in 0..=n {
                let expected = ruled(nodes[i], nodes[j]);
                assert!((map[j * (n + 1) + i] - expected).norm() < 1e-14);
            }
            assert_eq!(map[j], sides[0][j]);
            assert_eq!(map[n * (n + 1) + j], sides[2][n - j]);
        }
    }
}

#[test]
fn bernstein_coefficients_are_those_of_the_polynomial_and_bound_it() {
    for n in [1usize, 2, 5, 9, 13] {
        let nodes = chebyshev_lobatto(n);
        let f = |x: f64| (0..=n).map(|k| (1.0 + k as f64).sin() * legendre(k, x).0).sum::<f64>();
        let values = nalgebra::DVector::from_iterator(n + 1, nodes.iter().map(|x| f(*x)));
        let control = bernstein_from_chebyshev(n) * chebyshev_from_values(n) * values;
        let (low, high) = (control.min(), control.max());
        for i in 0..=50 {
            let t = i as f64 / 50.0;
            // De Casteljau.
            let mut c: Vec<f64> = control.iter().copied().collect();
            while c.len() > 1 {
                c = c.windows(2).map(|w| w[0] * (1.0 - t) + w[1] * t).collect();
            }
            let exact = f(2.0 * t - 1.0);
            assert!((c[0] - exact).abs() < 1e-9, "degree {n} at {t}: {} not {exact}", c[0]);
            assert!(low - 1e-9 <= exact && exact <= high + 1e-9);
        }
    }
}
