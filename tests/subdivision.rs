//! Splitting the chords of a mesh until its boundary keeps the tolerance.

mod support;

use quadrel::domain::{Boundary, Place};
use quadrel::mesh::{
    bubble_shape, fit_bubbles, part_of_bubbles, BoundaryError, BoundaryTolerance, HighOrderMesh, QuadMesh,
    Quality, TableCurve, Vertex,
};
use quadrel::numerics::{Point, Vector};
use quadrel::options::Norm;
use quadrel::refine::{split_chords, subdivide};
use quadrel::Error;
use support::{boundary, chain, disc_o_grid, ellipse, o_grid, polygon};

fn tolerance(order: usize, value: f64) -> BoundaryTolerance {
    BoundaryTolerance { norm: Norm::L2, order, value }
}

fn area(mesh: &HighOrderMesh) -> f64 {
    let quality = Quality::new(mesh.order);
    (0..mesh.elements.len()).map(|e| quality.area(mesh.element_nodes(e))).sum()
}

#[test]
fn halving_a_mesh_goes_on_until_every_edge_keeps_the_tolerance() {
    let flat = boundary(vec![vec![chain(&ellipse(0.45, 0.2), 4000, true, &[])]]);
    for (b, mesh) in [disc_o_grid(0.6), (flat.clone(), o_grid(&flat, 0.6))] {
        for (order, value) in [(1, 1e-3), (3, 1e-5), (5, 1e-8)] {
            let error = BoundaryError::new(tolerance(order, value));
            let fine = subdivide(mesh.clone(), &b, &error, 100_000).unwrap();
            fine.check(&b).unwrap();
            assert!(fine.quads.len() > mesh.quads.len());
            let done = HighOrderMesh::with_curve(&fine, &b, &TableCurve(&b), &error.tolerance).unwrap();
            done.check().unwrap();
            // Nothing was halved once more than needed: some pair of neighbours joined fails.
            let spans: Vec<_> = fine.edges.iter().filter_map(|e| e.span).collect();
            let needed = spans.iter().any(|a| {
                let next = spans.iter().find(|c| (c.start - a.end).abs() < 1e-12);
                next.is_some_and(|c| {
                    error.of_span(&b, quadrel::domain::Span { end: c.end, ..*a }) > error.tolerance.value
                })
            });
            assert!(needed);
        }
    }
}

#[test]
fn a_mesh_that_keeps_the_tolerance_is_left_alone() {
    let (b, mesh) = disc_o_grid(0.6);
    let error = BoundaryError::new(tolerance(5, 1e-2));
    assert_eq!(subdivide(mesh.clone(), &b, &error, 12).unwrap(), mesh);
}

#[test]
fn the_element_limit_is_an_error_at_the_worst_edge() {
    let (b, mesh) = disc_o_grid(0.6);
    let error = BoundaryError::new(tolerance(1, 1e-9));
    assert!(matches!(subdivide(mesh, &b, &error, 1000), Err(Error::Tolerance { .. })));
}

/// A 2 × 2 mesh of a square, its four inner edges curved.
fn curved_square() -> (Boundary, QuadMesh) {
    let b = polygon(&[[0.0, 0.0], [0.6, 0.0], [0.6, 0.6], [0.0, 0.6]]);
    let middle = |chain| Place::Boundary(quadrel::domain::BoundaryPoint { chain, s: 0.3 });
    let mut vertices: Vec<Vertex> = (0..4)
        .map(Place::Junction)
        .chain((0..4).map(middle))
        .map(|place| Vertex { point: b.point(place).unwrap(), place })
        .collect();
    vertices.push(Vertex { point: Point::new(0.33, 0.28), place: Place::Interior });
    let quads = vec![[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]];
    let shapes = [([4, 8], 0.01), ([8, 5], -0.01), ([8, 6], 0.02), ([7, 8], 0.02)]
        .map(|(v, a)| (v, vec![Vector::new(a, -0.5 * a), Vector::new(0.2 * a, a), Vector::new(0.0, 0.3 * a)]))
        .into_iter()
        .collect();
    let mesh = QuadMesh::new(&b, vertices, quads, vec![3, 1, 4, 1], &shapes).unwrap();
    (b, mesh)
}

#[test]
fn chords_split_both_ways_quarter_the_quads_and_keep_their_curves() {
    let (b, mesh) = curved_square();
    let t = tolerance(5, 1e-6);
    let finish = |m: &QuadMesh| HighOrderMesh::with_curve(m, &b, &TableCurve(&b), &t).unwrap();
    let all = split_chords(&mesh, &b, &vec![true; mesh.edges.len()], 5).unwrap();
    all.check(&b).unwrap();
    assert_eq!((all.quads.len(), all.vertices.len()), (16, 25));
    assert_eq!(all.region.iter().filter(|r| **r == 1).count(), 8);
    assert!((area(&finish(&all)) - 0.36).abs() < 1e-12);
    let coarse = finish(&mesh);
    let fine = finish(&all);
    let quality = Quality::new(5);
    for q in 0..4 {
        // The first child of each quad is the quarter at its first corner, with the same curves.
        let (parent, child) = (coarse.element_nodes(q), fine.element_nodes(4 * q));
        for x in [-1.0, -0.3, 0.4, 1.0] {
            let half = 0.5 * (x - 1.0);
            for (at, inside) in [([x, -1.0], [half, -1.0]), ([x, 1.0], [half, 0.0]), ([1.0, x], [0.0, half])]
            {
                let distance = (quality.point(child, at) - quality.point(parent, inside)).norm();
                assert!(distance < 1e-12, "quad {q} at {at:?}: {distance}");
            }
        }
    }
}

#[test]
fn one_chord_halves_only_the_quads_it_crosses() {
    let (b, mesh) = curved_square();
    let mut marked = vec![false; mesh.edges.len()];
    marked[mesh.quad_edges[0][0] as usize] = true;
    let one = split_chords(&mesh, &b, &marked, 5).unwrap();
    one.check(&b).unwrap();
    assert_eq!(one.quads.len(), 6);
    assert_eq!(one.region, [3, 3, 1, 4, 1, 1]);
}

#[test]
fn bubbles_fit_and_restrict_exactly() {
    let bubbles = [Vector::new(1.0, -0.5), Vector::new(0.3, 0.2), Vector::new(-0.1, 0.7)];
    let fitted = fit_bubbles(3, |x| bubble_shape(&bubbles, x));
    for (a, b) in fitted.iter().zip(&bubbles) {
        assert!((a - b).norm() < 1e-14);
    }
    let part = part_of_bubbles(&bubbles, -0.4, 0.7);
    let (start, end) = (bubble_shape(&bubbles, -0.4), bubble_shape(&bubbles, 0.7));
    for k in 0..=10 {
        let share = k as f64 / 10.0;
        let whole = bubble_shape(&bubbles, -0.4 + 1.1 * share);
        let sum = start * (1.0 - share) + end * share + bubble_shape(&part, 2.0 * share - 1.0);
        assert!((whole - sum).norm() < 1e-14);
    }
}
