//! Meshes, their proof and their measures.

mod support;

use quadrel::domain::{Boundary, BoundaryPoint, Place};
use quadrel::mesh::{
    irregular, irregularity_bound, quads_by_table, scaled_jacobian_ceiling, BoundaryTolerance, Geometry,
    HighOrderMesh, Irregular, JacobianProof, QuadMesh, Quality, TableCurve, Verdict,
};
use quadrel::numerics::{coons_map, GaussLobatto, Interpolation, Point, Vector, NONE};
use quadrel::options::{Norm, Options, Tolerance};
use quadrel::Error;
use std::f64::consts::{FRAC_PI_2, PI};
use support::{boundary, chain, disc_o_grid, ellipse, polygon};

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

fn unit_circle_tolerance(b: &Boundary, order: usize, value: f64) -> BoundaryTolerance {
    let options = Options { order, tolerance: Tolerance::Absolute(value), ..Options::default() };
    BoundaryTolerance::new(&options, b)
}

fn finish(b: &Boundary, mesh: &QuadMesh, tolerance: &BoundaryTolerance) -> quadrel::Result<HighOrderMesh> {
    HighOrderMesh::with_curve(mesh, b, &TableCurve(b), tolerance)
}

#[test]
fn disc_of_12_elements_is_proven_and_within_the_tolerance() {
    let (b, mesh) = disc_o_grid(0.6);
    let fine = finish(&b, &mesh, &unit_circle_tolerance(&b, 5, 1e-5)).unwrap();
    fine.check().unwrap();
    assert_eq!((fine.elements.len(), fine.vertices.len(), fine.nodes.len()), (12, 17, 12 * 36));
    assert!(fine.scaled_jacobian.iter().all(|s| *s > 0.6 && *s <= 1.0));
    let border: Vec<_> = fine.edges.iter().filter(|e| e.elements[1] == NONE).collect();
    assert_eq!(border.len(), 8);
    for edge in &border {
        assert!(edge.error > 0.0 && edge.error <= 1e-5 && edge.boundary == 0 && edge.loop_index == 0);
        assert!(edge.parameters[0] < edge.parameters[1]);
    }
    // In the caller's frame: on the unit circle around the frame's origin, of area π.
    for v in &fine.vertices[..8] {
        assert!(((v - b.frame.origin).norm() - 1.0).abs() < 1e-13);
    }
    let quality = Quality::new(5);
    let area: f64 = (0..12).map(|e| quality.area(fine.element_nodes(e))).sum();
    assert!((area - PI).abs() < 1e-7, "{area}");
    assert_eq!(fine.boundary_errors().len(), 1);
}

#[test]
fn area_converges_spectrally_on_the_disc() {
    let error = |order| {
        let (b, mesh) = disc_o_grid(0.6);
        let fine = finish(&b, &mesh, &unit_circle_tolerance(&b, order, 1.0)).unwrap();
        let quality = Quality::new(order);
        ((0..12).map(|e| quality.area(fine.element_nodes(e))).sum::<f64>() - PI).abs()
    };
    assert!(error(2) > 1e-5 && error(4) < 1e-6 && error(8) < 1e-12, "{} {} {}", error(2), error(4), error(8));
}

#[test]
fn a_tolerance_that_does_not_hold_is_an_error_at_the_edge() {
    let (b, mesh) = disc_o_grid(0.6);
    match finish(&b, &mesh, &unit_circle_tolerance(&b, 3, 1e-5)) {
        Err(Error::Tolerance { error, tolerance, at }) => {
            assert!(error > 1e-5 && (tolerance - 1e-5).abs() < 1e-18);
            assert!(((at - b.frame.origin).norm() - 1.0).abs() < 1e-3);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn an_inverted_element_is_an_error_with_its_place() {
    let (b, mut mesh) = disc_o_grid(0.6);
    // The centre pushed beyond the inner block, towards vertex 8.
    mesh.vertices[16].point = mesh.vertices[8].point * 1.1;
    match finish(&b, &mesh, &unit_circle_tolerance(&b, 5, 1e-5)) {
        Err(Error::InvalidElement { jacobian, at }) => {
            let place = b.frame.to_canonical(at);
            assert!(jacobian < 0.0 && (place - mesh.vertices[8].point).norm() < 0.2, "{place}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn quad_mesh_check_finds_every_kind_of_defect() {
    let (b, good) = disc_o_grid(0.6);
    good.check(&b).unwrap();
    let defect = |change: &dyn Fn(&mut QuadMesh)| {
        let mut bad = good.clone();
        change(&mut bad);
        bad.check(&b).expect_err("the defect was not found").0
    };
    let mut found = vec![
        defect(&|m| m.vertices[0].point.x += 1e-6),
        defect(&|m| m.vertices[16].point.x = f64::NAN),
        defect(&|m| m.vertices[3].place = Place::Interior),
        defect(&|m| m.vertices[3].place = Place::Junction(4)),
        defect(&|m| m.quads[0].swap(0, 1)),
        defect(&|m| m.quads[0][1] = 99),
        defect(&|m| m.quads[0][1] = m.quads[0][0]),
        defect(&|m| m.edges[0].quads[0] = 5),
        defect(&|m| m.quad_edges[3].swap(1, 2)),
        defect(&|m| {
            m.quads.pop();
        }),
        defect(&|m| m.vertices.push(m.vertices[0])),
        defect(&|m| {
            m.region.pop();
        }),
    ];
    found.sort();
    found.dedup();
    assert!(found.len() >= 7, "{found:?}");
    // One quad short: its interior edges become border edges that follow no chain.
    let quads = good.quads[..11].to_vec();
    assert!(QuadMesh::new(&b, good.vertices.clone(), quads, vec![0; 11], &Default::default()).is_err());
    // A domain with another hole has another boundary and Euler number.
    let hole = chain(&ellipse(0.02, -0.02), 400, true, &[]);
    let mut holed = b.clone();
    holed.chains.push(hole);
    holed.loops.push(vec![1]);
    assert!(good.check(&holed).is_err());
}

#[test]
fn bubbles_bend_interior_edges_the_same_from_both_sides() {
    let (b, mut mesh) = disc_o_grid(0.6);
    let mut g = Generator(11);
    for edge in mesh.edges.iter_mut().filter(|e| e.span.is_none()) {
        edge.bubbles = (0..4).map(|_| Vector::new(g.symmetric(), g.symmetric()) * 4e-3).collect();
    }
    for order in [3, 5, 8] {
        let fine = finish(&b, &mesh, &unit_circle_tolerance(&b, order, 1e-2)).unwrap();
        fine.check().unwrap();
    }
    // The shape handed over by its vertices, in either direction, gives the same mesh.
    let shapes = |reverse: bool| {
        let edges = mesh.edges.iter().filter(|e| e.span.is_none());
        edges
            .map(|e| {
                if !reverse {
                    return (e.vertices, e.bubbles.clone());
                }
                let odd = |m: usize| if m % 2 == 1 { -1.0 } else { 1.0 };
                let turned = e.bubbles.iter().enumerate().map(|(m, v)| v * odd(m)).collect();
                ([e.vertices[1], e.vertices[0]], turned)
            })
            .collect()
    };
    for reverse in [false, true] {
        let again = QuadMesh::new(
            &b,
            mesh.vertices.clone(),
            mesh.quads.clone(),
            mesh.region.clone(),
            &shapes(reverse),
        );
        assert_eq!(again.unwrap(), mesh);
    }
    // The middle of an edge is where the bubbles put it.
    let geometry = Geometry::new(4);
    let (e, edge) = mesh.edges.iter().enumerate().find(|(_, e)| e.span.is_none()).unwrap();
    let mut nodes = [Point::origin(); 5];
    geometry.edge_nodes(&mesh, &b, e, &mut nodes);
    let [p, q] = edge.vertices.map(|v| mesh.vertices[v as usize].point);
    // P_m(0) = 1, 0, −1/2, 0.
    let expected = nalgebra::center(&p, &q) + edge.bubbles[0] - edge.bubbles[2] * 0.5;
    assert!((nodes[2] - expected).norm() < 1e-15);
}

#[test]
fn measures_of_known_elements() {
    let quality = Quality::new(4);
    let nodes = GaussLobatto::new(4).nodes;
    let map = |f: &dyn Fn(f64, f64) -> Point| -> Vec<Point> {
        nodes.iter().flat_map(|eta| nodes.iter().map(|xi| f(*xi, *eta))).collect()
    };
    let rectangle = quality.measure(&map(&|x, y| Point::new(3.0 * x + 100.0, y)));
    assert!((rectangle.scaled_jacobian - 1.0).abs() < 1e-12 && (rectangle.area - 12.0).abs() < 1e-10);
    assert!((rectangle.aspect_ratio - 3.0).abs() < 1e-12 && (rectangle.jacobian_ratio - 1.0).abs() < 1e-12);
    let sheared = quality.measure(&map(&|x, y| Point::new(x + y, y)));
    assert!((sheared.scaled_jacobian - 0.5f64.sqrt()).abs() < 1e-12);
    assert!((sheared.min_angle - PI / 4.0).abs() < 1e-12 && (sheared.max_angle - PI / 4.0).abs() < 1e-12);
    // Corners (0,0), (2,0), (1,1), (0,1): det J goes from 1/4 on the top side to 1/2 on the bottom.
    let trapezoid = quality.measure(&map(&|x, y| Point::new(0.25 * (1.0 + x) * (3.0 - y), 0.5 * (1.0 + y))));
    assert!((trapezoid.jacobian_ratio - 0.5).abs() < 1e-12 && (trapezoid.area - 1.5).abs() < 1e-12);
    assert!((trapezoid.scaled_jacobian - 0.5f64.sqrt()).abs() < 1e-12);
    let mirrored = quality.measure(&map(&|x, y| Point::new(-x, y)));
    assert!(mirrored.scaled_jacobian < -0.99 && mirrored.area < 0.0 && mirrored.jacobian_ratio < 0.0);
}

#[test]
fn least_scaled_jacobian_is_found_between_samples() {
    let mut g = Generator(5);
    for order in [2, 5, 8] {
        let quality = Quality::new(order);
        for _ in 0..50 {
            let element = random_element(&mut g, order, 0.12);
            let least = quality.scaled_jacobian(&element);
            let mut dense = f64::INFINITY;
            for i in 0..=80 {
                for j in 0..=80 {
                    let (u, v) =
                        quality.derivatives(&element, [i as f64 / 40.0 - 1.0, j as f64 / 40.0 - 1.0]);
                    dense = dense.min((u.x * v.y - u.y * v.x) / (u.norm() * v.norm()));
                }
            }
            assert!(least < dense + 2e-3, "order {order}: {least} {dense}");
        }
    }
}

#[test]
fn table_1_rounds_ties_downwards() {
    for (degrees, quads) in [(1.0, 1), (90.0, 1), (135.0, 1), (135.1, 2), (180.0, 2), (225.0, 2), (270.0, 3)]
    {
        assert_eq!(quads_by_table(f64::to_radians(degrees)), quads);
    }
    assert_eq!((quads_by_table(7.0 * PI / 4.0), quads_by_table(2.0 * PI)), (3, 4));
}

fn regular(n: usize) -> Boundary {
    let corners: Vec<[f64; 2]> = (0..n)
        .map(|k| std::f64::consts::TAU * k as f64 / n as f64)
        .map(|a| [0.4 * a.cos(), 0.4 * a.sin()])
        .collect();
    polygon(&corners)
}

#[test]
fn ceilings_of_known_domains() {
    let l_shape = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.5, 0.5], [0.5, 1.0], [0.0, 1.0]];
    let (disc, _) = disc_o_grid(0.6);
    let ring = boundary(vec![
        vec![chain(&ellipse(0.35, 0.35), 1000, true, &[])],
        vec![chain(&ellipse(0.1, -0.1), 1000, true, &[])],
    ]);
    for (name, b, expected) in [
        ("square", regular(4), 1.0),
        ("L", polygon(&l_shape), 1.0),
        ("disc", disc, 0.75f64.sqrt()),
        ("ring", ring, 1.0),
        // Two quads at each corner are better than one, and then 4 three-valent vertices are inside.
        ("octagon", regular(8), 0.75f64.sqrt()),
        // One quad at each of 108°: sin 108°, and one five-valent vertex.
        ("pentagon", regular(5), 0.951_056_516_295_153_5),
        ("thin triangle", polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.1]]), 0.1 / 1.01f64.sqrt()),
    ] {
        let ceiling = scaled_jacobian_ceiling(&b);
        assert!((ceiling - expected).abs() < 1e-9, "{name}: {ceiling}, not {expected}");
    }
}

#[test]
fn irregularity_bounds_of_known_domains() {
    let (disc, mesh) = disc_o_grid(0.6);
    let bound = irregularity_bound(&disc);
    assert_eq!((bound.corners, bound.curves, bound.expected), (4.0, 4, 8));
    assert_eq!(irregular(&mesh, &disc), Irregular { interior: 4, boundary: 0 });
    let square = irregularity_bound(&regular(4));
    assert!(square.corners < 1e-9 && square.curves == 0 && square.expected == 0);
    // Of five corners of 108° one takes two quads: 4 · 0.2 + 0.8.
    assert!((irregularity_bound(&regular(5)).corners - 1.6).abs() < 1e-9);
    // A peanut: convex, concave, convex, concave; its turns are about ±(180° + x), with Σ = 360°.
    let peanut = |t: f64| {
        let a = std::f64::consts::TAU * t;
        let r = 0.3 + 0.15 * (2.0 * a).cos();
        let dr = -0.3 * (2.0 * a).sin();
        let d = Vector::new(dr * a.cos() - r * a.sin(), dr * a.sin() + r * a.cos()) * std::f64::consts::TAU;
        (Point::new(r * a.cos(), r * a.sin()), d)
    };
    let waisted = boundary(vec![vec![chain(&peanut, 2000, true, &[])]]);
    let curves = irregularity_bound(&waisted).curves;
    // Started elsewhere, the same runs.
    let shifted = |t: f64| peanut((t + 0.37).fract());
    assert_eq!(irregularity_bound(&boundary(vec![vec![chain(&shifted, 2000, true, &[])]])).curves, curves);
    assert!((6..=10).contains(&curves), "{curves}");
}

#[test]
fn irregular_counts_boundary_vertices_too() {
    // A square of 1 × 2 quads: the middle vertices have two quads; then with one corner taken as smooth.
    let b = polygon(&[[0.0, 0.0], [0.6, 0.0], [0.6, 0.3], [0.0, 0.3]]);
    let on = |chain, s| Place::Boundary(BoundaryPoint { chain, s });
    let places = [
        Place::Junction(0),
        on(0, 0.3),
        Place::Junction(1),
        Place::Junction(2),
        on(2, 0.3),
        Place::Junction(3),
    ];
    let vertices =
        places.map(|place| quadrel::mesh::Vertex { point: b.point(place).unwrap(), place }).to_vec();
    let quads = vec![[0, 1, 4, 5], [1, 2, 3, 4]];
    let mesh = QuadMesh::new(&b, vertices, quads, vec![0, 0], &Default::default()).unwrap();
    mesh.check(&b).unwrap();
    assert_eq!(irregular(&mesh, &b), Irregular::default());
    let tolerance = BoundaryTolerance { norm: Norm::Max, order: 1, value: 1e-12 };
    let fine = finish(&b, &mesh, &tolerance).unwrap();
    fine.check().unwrap();
    assert!(fine.scaled_jacobian.iter().all(|s| (s - 1.0).abs() < 1e-12));
    let mut blunt = b.clone();
    blunt.junctions[0].angle = 2.0 * FRAC_PI_2;
    assert_eq!(irregular(&mesh, &blunt), Irregular { interior: 0, boundary: 1 });
}

#[test]
fn connectivity_of_the_disc() {
    let (b, mesh) = disc_o_grid(0.5);
    let mesh = finish(&b, &mesh, &unit_circle_tolerance(&b, 4, 1e-2)).unwrap();
    let (neighbors, sides) = (mesh.element_neighbors(), mesh.edge_sides());
    for (e, own) in mesh.element_edges.iter().enumerate() {
        for s in 0..4 {
            let edge = &mesh.edges[own[s] as usize];
            let right = usize::from(edge.elements[0] != e as u32);
            assert_eq!(sides[own[s] as usize][right], s as u32);
            assert_eq!(neighbors[e][s], edge.elements[1 - right]);
        }
    }
    // Every node is numbered, and elements agree on those they share.
    let (numbers, points) = (mesh.node_numbers(), mesh.shared_nodes());
    assert_eq!(points.len(), mesh.node_count());
    let mut met = vec![false; points.len()];
    for (number, node) in numbers.iter().zip(&mesh.nodes) {
        met[*number as usize] = true;
        assert_eq!(points[*number as usize], *node);
    }
    assert!(met.iter().all(|m| *m));
    assert_eq!(points[..mesh.vertices.len()], mesh.vertices[..]);
    let errors = mesh.element_boundary_errors();
    let on_border = neighbors.iter().filter(|n| n.contains(&NONE)).count();
    assert_eq!(errors.iter().filter(|e| **e > 0.0).count(), on_border);
}

#[test]
fn edge_ratio_and_condition_of_known_elements() {
    let quality = Quality::new(3);
    let nodes = |width: f64, shear: f64| -> Vec<Point> {
        let x = GaussLobatto::new(3).nodes;
        let at = |u: f64, v: f64| Point::new(width * u + shear * v, v);
        x.iter().flat_map(|v| x.iter().map(move |u| at(*u, *v))).collect()
    };
    let square = quality.measure(&nodes(1.0, 0.0));
    assert!((square.edge_ratio - 1.0).abs() < 1e-14 && (square.condition - 1.0).abs() < 1e-14);
    let rectangle = quality.measure(&nodes(3.0, 0.0));
    assert!((rectangle.edge_ratio - 3.0).abs() < 1e-13);
    assert!((rectangle.condition - 10.0 / 6.0).abs() < 1e-13);
    let sheared = quality.measure(&nodes(1.0, 1.0));
    assert!((sheared.condition - 1.5).abs() < 1e-13 && (sheared.edge_ratio - 2f64.sqrt()).abs() < 1e-13);
    assert_eq!(quality.measure(&nodes(-1.0, 0.0)).condition, f64::INFINITY);
}
