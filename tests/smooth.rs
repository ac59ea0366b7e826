//! Step 8: the optimiser cures, keeps and improves.

mod fixtures;

use fixtures::*;
use quadrel::domain::Place;
use quadrel::mesh::{unproven, BoundaryTolerance, HighOrderMesh, QuadMesh, TableCurve, Vertex};
use quadrel::numerics::Vector;
use quadrel::options::Norm;
use quadrel::smooth::{equal_spacing, Care, Optimiser};
use std::collections::HashMap;

#[test]
fn disc_of_twelve() {
    let (b, mut m) = disc(2, 1);
    assert_eq!(m.quads.len(), 12);
    let tolerance = BoundaryTolerance { norm: Norm::L2, order: 5, value: 1e-5 };
    let optimiser = Optimiser::new(&b, 5, Some(tolerance));
    let before = optimiser.quality(&m);
    let outcome = optimiser.optimise(&mut m, None, Care::Full);
    let after = optimiser.quality(&m);
    assert!(outcome.valid);
    assert!(after.min_scaled_jacobian >= 0.75, "{}", after.min_scaled_jacobian);
    assert!(after.min_scaled_jacobian > before.min_scaled_jacobian);
    assert!(after.error_ratio <= 1.0);
    assert!(after.min_jacobian_ratio > 0.1, "{}", after.min_jacobian_ratio);
}

/// Two quads whose common edge joins two junctions, in one line with a wall: one has a flat corner until it bends.
#[test]
fn an_edge_in_line_with_a_wall_bends() {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [0.0, 1.0]];
    let b = boundary(vec![polygon(&corners)]);
    let junction = |k: u32| Vertex { point: b.junctions[k as usize].point, place: Place::Junction(k) };
    let vertices = (0..6).map(junction).collect();
    let quads = vec![[0, 1, 4, 5], [1, 2, 3, 4]];
    let mut m = QuadMesh::new(&b, vertices, quads, vec![0; 2], &HashMap::new()).unwrap();
    let optimiser = Optimiser::new(&b, 4, None);
    assert!(!optimiser.quality(&m).valid(), "the start must have a flat corner");
    let outcome = optimiser.optimise(&mut m, None, Care::Full);
    assert!(outcome.valid && outcome.min_scaled_jacobian > 0.3, "{outcome:?}");
}

#[test]
fn scrambled_grids_are_cured() {
    let optimise = |(b, mut m): (quadrel::domain::Boundary, quadrel::mesh::QuadMesh), low, high, order| {
        for seed in 1..4 {
            scramble(&mut m, low, high, seed);
            let optimiser = Optimiser::new(&b, order, None);
            assert!(!optimiser.quality(&m).valid(), "the start must be tangled");
            let outcome = optimiser.optimise(&mut m, None, Care::Full);
            assert!(outcome.valid, "seed {seed}: {outcome:?}");
            assert!(outcome.min_scaled_jacobian > 0.6, "seed {seed}: {outcome:?}");
        }
    };
    optimise(rectangle(1.0, 0.6, &even(8), &even(6)), [0.0, 0.0], [1.0, 0.6], 4);
    optimise(rectangle(1.0, 0.02, &even(12), &even(4)), [0.0, 0.0], [1.0, 0.02], 3);
    optimise(disc(3, 2), [-0.35, -0.35], [0.35, 0.35], 5);
    optimise(annulus(10, 3, 0.1, 0.12), [-0.35, -0.35], [0.35, 0.35], 6);
}

#[test]
fn sizes_of_one_to_a_thousand() {
    // Columns that shrink by half each: 2^-10 of the width at the end.
    let mut xs: Vec<f64> = (0..=10).map(|i| 1.0 - 0.5f64.powi(i)).collect();
    xs[10] = 1.0;
    let (b, mut m) = rectangle(1.0, 0.3, &xs, &even(3));
    let mut random = Sequence(7);
    let width = |x: f64| 0.6 * (1.0 - x).max(1e-3);
    for v in m.vertices.iter_mut().filter(|v| v.place == Place::Interior) {
        let (x, y) = (random.next() - 0.5, random.next() - 0.5);
        v.point += Vector::new(x * width(v.point.x), 0.15 * y);
    }
    let optimiser = Optimiser::new(&b, 4, None);
    let outcome = optimiser.optimise(&mut m, None, Care::Full);
    assert!(outcome.valid && outcome.min_scaled_jacobian > 0.5, "{outcome:?}");
}

#[test]
fn a_thin_gap_with_coarse_elements() {
    // The hole leaves a gap of 0.01 on one side: straight chords would cross it.
    let (b, mut m) = annulus(5, 2, 0.24, 0.1);
    let optimiser = Optimiser::new(&b, 6, None);
    assert!(!optimiser.quality(&m).valid(), "the start must be tangled");
    let outcome = optimiser.optimise(&mut m, None, Care::Full);
    assert!(outcome.valid && outcome.min_scaled_jacobian > 0.3, "{outcome:?}");
}

#[test]
fn only_active_quads_move() {
    let (b, mut m) = disc(3, 2);
    let active: Vec<u32> = (0..9).collect();
    let optimiser = Optimiser::new(&b, 5, None);
    let before = m.clone();
    let outcome = optimiser.optimise(&mut m, Some(&active), Care::Final);
    assert!(outcome.valid);
    let inside = |q: u32| q < 9;
    let mut moved = 0;
    for (e, (now, then)) in m.edges.iter().zip(&before.edges).enumerate() {
        if now.quads.iter().all(|q| inside(*q)) {
            moved += usize::from(now != then);
        } else {
            assert_eq!(now, then, "edge {e} has a neighbour outside");
        }
    }
    assert!(moved > 0);
    for (q, quad) in m.quads.iter().enumerate().filter(|(q, _)| !inside(*q as u32)) {
        for v in quad {
            assert_eq!(m.vertices[*v as usize], before.vertices[*v as usize], "quad {q}");
        }
    }
}

#[test]
fn tolerance_is_kept_and_regained() {
    let (b, mut m) = disc(1, 1);
    let error = |m: &quadrel::mesh::QuadMesh| {
        Optimiser::new(&b, 4, Some(BoundaryTolerance { norm: Norm::L2, order: 4, value: 1.0 }))
            .quality(m)
            .error_ratio
    };
    let even_error = error(&m);
    // One long edge and three short ones: the long one is far above the tolerance.
    let uneven = [0.525, 0.975, 0.125, 0.375];
    for (k, share) in uneven.iter().enumerate() {
        m.vertices[4 + k] = on(&b, 0, *share);
    }
    m = mesh(&b, m.vertices, m.quads);
    assert!(error(&m) > 4.0 * even_error);
    for norm in [Norm::L2, Norm::H1, Norm::Max] {
        let own = Optimiser::new(&b, 4, Some(BoundaryTolerance { norm, order: 4, value: 1.0 }));
        let (mut even, _) = (disc(1, 1).1, ());
        let tolerance = 2.0 * own.quality(&even).error_ratio;
        let optimiser = Optimiser::new(&b, 4, Some(BoundaryTolerance { norm, order: 4, value: tolerance }));
        assert!(optimiser.optimise(&mut even, None, Care::Full).valid);
        assert!(optimiser.quality(&even).error_ratio <= 1.0, "{norm:?} lost");
        let mut m = m.clone();
        assert!(optimiser.quality(&m).error_ratio > 1.0);
        assert!(optimiser.optimise(&mut m, None, Care::Full).valid);
        let ratio = optimiser.quality(&m).error_ratio;
        assert!(ratio <= 1.0, "{norm:?} not regained: {ratio}");
    }
}

#[test]
fn validity_is_never_lost_at_any_order() {
    for order in [1, 2, 3, 7, 12, 20] {
        let (b, mut m) = disc(2, 2);
        let optimiser = Optimiser::new(&b, order, None);
        assert!(optimiser.quality(&m).valid(), "order {order}: start");
        let before = optimiser.quality(&m).min_scaled_jacobian;
        let outcome = optimiser.optimise(&mut m, None, Care::Full);
        assert!(outcome.valid && outcome.min_scaled_jacobian > before, "order {order}: {outcome:?}");
    }
}

#[test]
fn same_input_same_bits() {
    let run = || {
        let (b, mut m) = disc(3, 2);
        scramble(&mut m, [-0.2, -0.2], [0.2, 0.2], 5);
        Optimiser::new(&b, 5, None).optimise(&mut m, None, Care::Full);
        m
    };
    assert_eq!(run(), run());
}

#[test]
fn a_graded_strip_becomes_equally_spaced() {
    let xs: Vec<f64> = (0..=8).map(|i| (i as f64 / 8.0).powi(2)).collect();
    let (b, mut m) = rectangle(1.0, 0.4, &xs, &[0.0, 0.15, 0.4, 0.7, 1.0]);
    let optimiser = Optimiser::new(&b, 3, None);
    let moves = equal_spacing(&optimiser, &mut m, 200);
    assert!(moves > 0);
    let quality = optimiser.quality(&m);
    assert!(quality.valid() && quality.min_scaled_jacobian > 0.95);
    for edge in &m.edges {
        let [a, b] = edge.vertices.map(|v| m.vertices[v as usize].point);
        let d = b - a;
        let wanted = if d.x.abs() > d.y.abs() { 1.0 / 8.0 } else { 0.4 / 4.0 };
        assert!((d.norm() - wanted).abs() < 0.02 * wanted, "{} instead of {wanted}", d.norm());
    }
}

#[test]
fn smoothing_never_makes_the_worst_element_worse() {
    let (b, mut m) = annulus(14, 4, 0.15, 0.1);
    let mut random = Sequence(3);
    for v in m.vertices.iter_mut().filter(|v| v.place == Place::Interior) {
        v.point += Vector::new(random.next() - 0.5, random.next() - 0.5) * 0.02;
    }
    let optimiser = Optimiser::new(&b, 4, None);
    let mut worst = optimiser.quality(&m).min_scaled_jacobian;
    assert!(worst > 0.0);
    for _ in 0..10 {
        equal_spacing(&optimiser, &mut m, 1);
        let now = optimiser.quality(&m).min_scaled_jacobian;
        assert!(now >= worst.min(0.5), "{worst} -> {now}");
        worst = now;
    }
}

/// What the proof refuses is listed, and mended without a change elsewhere.
#[test]
fn refused_quads_are_mended_where_they_are() {
    let n = 20;
    let (b, mut m) = rectangle(1.0, 1.0, &even(n), &even(n));
    let unproven_of =
        |m: &QuadMesh, quads: &[u32]| unproven(m, quads.iter().copied(), &b, &TableCurve(&b), 5).unwrap();
    let all: Vec<u32> = (0..m.quads.len() as u32).collect();
    assert!(unproven_of(&m, &all).is_empty());
    // The edge between the first two quads bulges through the second.
    let between = m.edges.iter().position(|e| e.quads == [0, 1]).unwrap();
    m.edges[between].bubbles = vec![Vector::new(1.2 / n as f64 * b.frame.scale.recip(), 0.0)];
    let refused = unproven_of(&m, &all);
    assert!(!refused.is_empty() && refused.iter().all(|q| [0, 1].contains(q)), "{refused:?}");
    let tolerance = BoundaryTolerance { value: 1e-3, norm: Norm::L2, order: 5 };
    assert!(HighOrderMesh::with_curve(&m, &b, &TableCurve(&b), &tolerance).is_err());

    let before = m.clone();
    let optimiser = Optimiser::new(&b, 5, None);
    let (left, work) = optimiser.mend(&mut m, &refused, &unproven_of);
    assert!(left.is_empty() && work > 0, "{left:?}");
    assert!(HighOrderMesh::with_curve(&m, &b, &TableCurve(&b), &tolerance).is_ok());
    for (q, quad) in m.quads.iter().enumerate().filter(|(q, _)| q % n > 9 || q / n > 9) {
        for v in quad {
            assert_eq!(m.vertices[*v as usize], before.vertices[*v as usize], "quad {q}");
        }
        for e in m.quad_edges[q] {
            assert_eq!(m.edges[e as usize], before.edges[e as usize], "quad {q}");
        }
    }
    // What cannot be mended is told, and left as it was.
    let sound = m.clone();
    let (left, _) =
        optimiser.mend(&mut m, &[7], &|_, quads| quads.iter().copied().filter(|q| *q == 7).collect());
    assert_eq!(left, [7]);
    assert_eq!(m, sound);
}
