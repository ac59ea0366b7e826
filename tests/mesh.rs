//! Meshes, their proof and their measures.

mod support;

use quadrel::mesh::{JacobianProof, Verdict};
use quadrel::numerics::{coons_map, GaussLobatto, Interpolation, Point, Vector};

/// SplitMix64 with a fixed seed: the same elements in every run.
struct Generator(u64);

impl Generator {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn symmetric(&mut self) -> f64 {
        2.0 * self.uniform() - 1.0
    }
}

/// An element of order n whose four sides are random cubics, more curved with larger `amplitude`.
fn random_element(g: &mut Generator, n: usize, amplitude: f64) -> Vec<Point> {
    let nodes = GaussLobatto::new(n).nodes;
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        .map(|c| Point::new(c[0] + 0.3 * amplitude * g.symmetric(), c[1] + 0.3 * amplitude * g.symmetric()));
    let sides: Vec<Vec<Point>> = (0..4)
        .map(|s| {
            let (a, b) = (corners[s], corners[(s + 1) % 4]);
            let (c, d) =
                (Vector::new(g.symmetric(), g.symmetric()), Vector::new(g.symmetric(), g.symmetric()));
            let shape = |x: f64| a + (b - a) * (0.5 * (1.0 + x)) + (c + d * x) * (amplitude * (1.0 - x * x));
            nodes
                .iter()
                .enumerate()
                .map(|(i, x)| {
                    if i == 0 {
                        a
                    } else if i == n {
                        b
                    } else {
                        shape(*x)
                    }
                })
                .collect()
        })
        .collect();
    let mut out = Vec::new();
    coons_map(&nodes, [0, 1, 2, 3].map(|s| sides[s].as_slice()), &mut out);
    out
}

/// det J on a grid of m × m points, ends included.
fn sampled(nodes: &[Point], n: usize, m: usize) -> Vec<f64> {
    let interpolation = Interpolation::new(GaussLobatto::new(n).nodes);
    let targets: Vec<f64> = (0..m).map(|i| 2.0 * i as f64 / (m - 1) as f64 - 1.0).collect();
    let (l, d) = (interpolation.matrix(&targets), interpolation.derivative_matrix(&targets));
    let component = |c: usize| nalgebra::DMatrix::from_row_iterator(n + 1, n + 1, nodes.iter().map(|p| p[c]));
    let (x, y) = (component(0), component(1));
    let (xu, yu) = (&l * &x * d.transpose(), &l * &y * d.transpose());
    let (xv, yv) = (&d * &x * l.transpose(), &d * &y * l.transpose());
    (xu.component_mul(&yv) - yu.component_mul(&xv)).iter().copied().collect()
}

fn lowest(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

#[test]
fn proof_agrees_with_dense_sampling_on_random_elements() {
    let mut g = Generator(1);
    for n in [1, 2, 3, 4, 5, 6, 7, 8, 10, 11, 16, 32] {
        let mut proof = JacobianProof::new(n);
        let (mut proven, mut negative) = (0, 0);
        let count = if n > 8 { 40 } else { 300 };
        for k in 0..count {
            let element = random_element(&mut g, n, 0.4 * (k % 10) as f64 / 10.0 + 0.02);
            let values = sampled(&element, n, 41);
            let (low, high) = (lowest(&values), -lowest(&values.iter().map(|v| -v).collect::<Vec<_>>()));
            match proof.examine(&element) {
                Verdict::Proven(bound) => {
                    proven += 1;
                    assert!(bound > 0.0 && bound <= low * (1.0 + 1e-12), "order {n}: {bound} {low}");
                }
                Verdict::Negative { value, at } => {
                    negative += 1;
                    assert!(value <= 0.0 && at.iter().all(|x| x.abs() <= 1.0));
                    // A dip that the 41 points miss is shallow.
                    assert!(low < 1e-2 * high, "order {n}: {value} at {at:?} but sampled {low}");
                }
                Verdict::Undecided { .. } => {
                    assert!(low.abs() < 1e-2 * high, "order {n}: undecided with {low} of {high}");
                }
            }
        }
        assert!(proven + negative >= count - 2, "order {n}: {proven} + {negative} of {count}");
        assert!(proven > count / 4 && (n == 1 || negative > count / 20), "order {n}: {proven} {negative}");
    }
}

/// x = ξ, y with dy/dη = ((ξ − a)² + (η − b)²) + c: det J is 1/4 of that, least c at (a, b).
fn dipped(n: usize, a: f64, b: f64, c: f64) -> Vec<Point> {
    let nodes = GaussLobatto::new(n).nodes;
    let mut out = Vec::new();
    for eta in &nodes {
        for xi in &nodes {
            let y = ((xi - a).powi(2) + c) * (eta - b) + (eta - b).powi(3) / 3.0;
            out.push(Point::new(*xi, y));
        }
    }
    out
}

#[test]
fn an_element_barely_inverted_between_sample_points_is_caught() {
    for n in [3, 5, 8, 12] {
        let mut proof = JacobianProof::new(n);
        for (a, b) in [(0.137, -0.411), (-0.777, 0.613), (0.0321, 0.9)] {
            for dip in [1e-2, 1e-3, 1e-4] {
                // Inverted on a disc of radius √dip; a 9 × 9 grid sees nothing of it.
                let bad = dipped(n, a, b, -dip);
                assert!(lowest(&sampled(&bad, n, 9)) > 0.0, "the grid was to miss it");
                match proof.examine(&bad) {
                    Verdict::Negative { at, .. } => {
                        assert!((at[0] - a).hypot(at[1] - b) < 1.01 * dip.sqrt());
                    }
                    Verdict::Undecided { at } => {
                        assert!(dip < 1e-3 && (at[0] - a).hypot(at[1] - b) < 0.1);
                    }
                    proven => panic!("order {n}, dip {dip}: {proven:?}"),
                }
                let good = dipped(n, a, b, dip);
                let verdict = proof.examine(&good);
                assert!(
                    matches!(verdict, Verdict::Proven(low) if low <= dip),
                    "order {n}, {dip}: {verdict:?}"
                );
            }
        }
    }
}

#[test]
fn degenerate_and_absurd_elements_are_not_proven() {
    let mut proof = JacobianProof::new(5);
    let nodes = GaussLobatto::new(5).nodes;
    let map = |f: &dyn Fn(f64, f64) -> Point| -> Vec<Point> {
        nodes.iter().flat_map(|eta| nodes.iter().map(|xi| f(*xi, *eta))).collect()
    };
    let square = map(&|x, y| Point::new(1e6 + 1e-3 * x, 1e-3 * y));
    assert!(matches!(proof.examine(&square), Verdict::Proven(_)), "far away and small is still valid");
    for bad in [
        map(&|x, _| Point::new(x, x)),
        map(&|_, _| Point::new(1.0, 2.0)),
        map(&|x, y| Point::new(y, x)),
        // A corner of 180°.
        map(&|x, y| Point::new((1.0 + x) * (3.0 + y), (1.0 - x) * (1.0 + y))),
        map(&|x, _| Point::new(x, f64::NAN)),
        map(&|x, _| Point::new(x, f64::INFINITY)),
        Vec::from([Point::origin(); 7]),
    ] {
        assert!(!matches!(proof.examine(&bad), Verdict::Proven(_)), "{:?}", proof.examine(&bad));
    }
}

#[test]
fn proof_is_the_same_for_a_moved_element() {
    let mut g = Generator(7);
    let mut proof = JacobianProof::new(5);
    for _ in 0..50 {
        let element = random_element(&mut g, 5, 0.1);
        let moved: Vec<Point> = element.iter().map(|p| p + Vector::new(64.0, -32.0)).collect();
        let (a, b) = (proof.examine(&element), proof.examine(&moved));
        if let (Verdict::Proven(a), Verdict::Proven(b)) = (a, b) {
            assert!((a - b).abs() < 1e-9);
        }
    }
}

#[test]
#[ignore = "a measurement, not a check"]
fn proof_speed() {
    for n in [3, 5, 8, 16, 32] {
        let mut g = Generator(3);
        let mut proof = JacobianProof::new(n);
        let elements: Vec<_> = (0..200).map(|_| random_element(&mut g, n, 0.1)).collect();
        let start = std::time::Instant::now();
        let proven = elements.iter().filter(|e| matches!(proof.examine(e), Verdict::Proven(_))).count();
        println!("order {n}: {proven} of 200, {:.2} µs each", start.elapsed().as_secs_f64() * 1e6 / 200.0);
    }
}
