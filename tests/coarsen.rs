//! Step 7: coarsening and splitting keep what they must.

mod fixtures;

use fixtures::*;
use quadrel::domain::{Boundary, Place};
use quadrel::mesh::{BoundaryTolerance, QuadMesh};
use quadrel::options::Norm;
use quadrel::progress::Progress;
use quadrel::refine::{coarsen, least_pieces, Limits, Reach, Refusals};
use quadrel::smooth::{Care, Optimiser};

fn tolerance(order: usize, value: f64) -> Option<BoundaryTolerance> {
    Some(BoundaryTolerance { norm: Norm::L2, order, value })
}

/// Vertices less edges plus quads.
fn euler(mesh: &QuadMesh) -> isize {
    mesh.vertices.len() as isize - mesh.edges.len() as isize + mesh.quads.len() as isize
}

fn valences(mesh: &QuadMesh) -> Vec<usize> {
    let mut n = vec![0; mesh.vertices.len()];
    mesh.quads.iter().flatten().for_each(|v| n[*v as usize] += 1);
    n
}

fn boundary_edges(mesh: &QuadMesh, chain: u32) -> usize {
    mesh.edges.iter().filter(|e| e.span.is_some_and(|s| s.chain == chain)).count()
}

/// Coarsens and checks every promise.
fn coarsened(b: &Boundary, m: QuadMesh, order: usize, value: f64, floor: f64) -> QuadMesh {
    let optimiser = Optimiser::new(b, order, tolerance(order, value));
    let mut m = m;
    optimiser.optimise(&mut m, None, Care::Full);
    let before = optimiser.quality(&m);
    assert!(before.valid() && before.error_ratio <= 1.0, "the start must hold: {before:?}");
    let limits = Limits::new(floor);
    let coarse =
        coarsen(m.clone(), &optimiser, limits, Reach::Far, &mut Refusals::default(), &Progress::default())
            .expect("a coarser mesh");
    let after = optimiser.quality(&coarse);
    assert!(after.valid() && after.error_ratio <= 1.0);
    assert!(after.min_scaled_jacobian >= floor.min(before.min_scaled_jacobian));
    assert!(after.min_jacobian_ratio >= limits.jacobian_ratio.min(before.min_jacobian_ratio));
    assert!(coarse.quads.len() <= m.quads.len());
    assert_eq!(euler(&coarse), euler(&m), "the topology changed");
    let error = optimiser.boundary_error().expect("a tolerance");
    for (c, chain) in b.chains.iter().enumerate() {
        let n = boundary_edges(&coarse, c as u32);
        assert!(n >= least_pieces(chain, error).expect("a number"), "chain {c} has {n} edges");
        let length: f64 = coarse
            .edges
            .iter()
            .filter_map(|e| e.span.filter(|s| s.chain == c as u32))
            .map(|s| s.end - s.start)
            .sum();
        assert!((length - chain.length).abs() < 1e-9 * chain.length, "chain {c} is not covered once");
    }
    for (vertex, n) in coarse.vertices.iter().zip(valences(&coarse)) {
        match vertex.place {
            Place::Interior => assert!((3..=6).contains(&n)),
            Place::Boundary(_) => assert!((2..=3).contains(&n)),
            Place::Junction(_) => assert!(n >= 1),
        }
    }
    for j in 0..b.junctions.len() as u32 {
        let there = coarse.vertices.iter().filter(|v| v.place == Place::Junction(j)).count();
        assert_eq!(there, 1, "junction {j}");
    }
    coarse
}

#[test]
fn a_rectangle_becomes_one_quad() {
    let (b, m) = rectangle(0.8, 0.6, &even(7), &even(5));
    assert_eq!(coarsened(&b, m, 3, 1e-6, 0.45).quads.len(), 1);
}

#[test]
fn a_disc_keeps_its_four_singularities() {
    let (b, m) = disc(4, 3);
    let coarse = coarsened(&b, m, 5, 1e-4, 0.5);
    assert!(coarse.quads.len() <= 12, "{}", coarse.quads.len());
    let three =
        coarse.vertices.iter().zip(valences(&coarse)).filter(|(v, n)| v.place == Place::Interior && *n == 3);
    assert_eq!(three.count(), 4);
}

#[test]
fn the_tolerance_decides_how_coarse() {
    let mut before = usize::MAX;
    for value in [1e-9, 1e-7, 1e-4] {
        let (b, m) = annulus(32, 3, 0.1, 0.08);
        let n = coarsened(&b, m, 4, value, 0.4).quads.len();
        assert!(n < before, "{n} quads at {value:e}, {before} at the tighter tolerance");
        before = n;
    }
}

#[test]
fn largest_size_is_kept() {
    let (b, m) = rectangle(0.8, 0.6, &even(16), &even(12));
    let optimiser = Optimiser::new(&b, 2, tolerance(2, 1e-6));
    let limits = Limits { size: 0.22, ..Limits::new(0.4) };
    let coarse = coarsen(m, &optimiser, limits, Reach::Far, &mut Refusals::default(), &Progress::default())
        .expect("a coarser mesh");
    let largest = optimiser.quality(&coarse).elements.iter().map(|e| e.size).fold(0.0, f64::max);
    assert!(largest <= 0.22 && largest > 0.1, "{largest}");
    assert!(coarse.quads.len() < 16 * 12 / 2);
}

#[test]
fn coarsening_is_deterministic_and_can_be_cancelled() {
    let (b, m) = annulus(20, 3, 0.12, 0.05);
    let optimiser = Optimiser::new(&b, 4, tolerance(4, 1e-6));
    let run = || {
        coarsen(
            m.clone(),
            &optimiser,
            Limits::new(0.4),
            Reach::Far,
            &mut Refusals::default(),
            &Progress::default(),
        )
    };
    assert_eq!(run(), run());
    let stop = Progress::new(|_, _| false);
    assert_eq!(
        coarsen(m.clone(), &optimiser, Limits::new(0.4), Reach::Far, &mut Refusals::default(), &stop),
        Err(quadrel::Error::Cancelled)
    );
}
