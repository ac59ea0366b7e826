//! Tolerances that take many more edges than the shape does.

mod support;

use quadrel::domain::{Boundary, Domain, LoopKind};
use quadrel::mesh::{BoundaryError, BoundaryTolerance, HighOrderMesh, Quality, TableCurve};
use quadrel::options::{Norm, Tolerance};
use quadrel::refine::{divide_to_tolerance, least_pieces, subdivide, tolerance_steps};
use quadrel::stages::Stages;
use quadrel::{generate, input, Error, Options};
use std::path::Path;
use support::{boundary, chain, disc_o_grid, ellipse, o_grid};

fn tolerance(order: usize, value: f64) -> BoundaryTolerance {
    BoundaryTolerance { norm: Norm::L2, order, value }
}

fn pieces(boundary: &Boundary, tolerance: &BoundaryTolerance) -> usize {
    let error = BoundaryError::new(*tolerance);
    boundary.chains.iter().map(|chain| least_pieces(chain, &error).unwrap()).sum()
}

/// An ellipse, the domain that most of what is here is tried on.
fn flat() -> Boundary {
    boundary(vec![vec![chain(&ellipse(0.45, 0.1), 8000, true, &[])]])
}

#[test]
fn usual_tolerances_are_taken_at_once() {
    for (order, value) in [(5, 1e-5), (4, 1e-6), (8, 1e-8), (2, 1e-4)] {
        let asked = tolerance(order, value);
        assert_eq!(tolerance_steps(&flat(), &asked).unwrap(), vec![asked]);
    }
}

#[test]
fn each_step_takes_about_twice_the_edges_of_the_last() {
    let flat = flat();
    for (order, value) in [(1, 1e-7), (2, 1e-9), (2, 1e-10)] {
        let asked = tolerance(order, value);
        let steps = tolerance_steps(&flat, &asked).unwrap();
        assert!(steps.len() > 1, "order {order}");
        assert_eq!(steps.last(), Some(&asked));
        let counts: Vec<usize> = steps.iter().map(|step| pieces(&flat, step)).collect();
        // A hundred are few on any domain.
        assert!((30..=100).contains(&counts[0]), "{counts:?}");
        for pair in counts.windows(2) {
            let factor = pair[1] as f64 / pair[0] as f64;
            assert!((1.3..2.3).contains(&factor), "{counts:?}");
        }
    }
}

#[test]
fn divided_elements_keep_the_tolerance_and_are_valid() {
    let flat = flat();
    for (b, mesh) in [disc_o_grid(0.6), (flat.clone(), o_grid(&flat, 0.6))] {
        for (order, value) in [(2, 1e-6), (3, 1e-8), (5, 1e-10)] {
            let tolerance = tolerance(order, value);
            let error = BoundaryError::new(tolerance);
            let fine = divide_to_tolerance(mesh.clone(), &b, &error, order, 100_000).unwrap();
            fine.check(&b).unwrap();
            // Never more than halving takes.
            assert!(fine.quads.len() <= subdivide(mesh.clone(), &b, &error, 100_000).unwrap().quads.len());
            let done = HighOrderMesh::with_curve(&fine, &b, &TableCurve(&b), &tolerance).unwrap();
            done.check().unwrap();
        }
    }
}

#[test]
fn the_element_limit_is_an_error_with_a_place_on_the_boundary() {
    let (b, mesh) = disc_o_grid(0.6);
    let error = BoundaryError::new(tolerance(1, 1e-9));
    let Err(Error::Tolerance { at, tolerance, error }) = divide_to_tolerance(mesh, &b, &error, 1, 1000)
    else {
        panic!("no refusal")
    };
    assert!(error > tolerance);
    let nearest =
        (0..1000).map(|k| (b.chains[0].point(b.chains[0].length * f64::from(k) / 1000.0) - at).norm());
    assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-2 * b.chains[0].length);
}

/// A disc of radius 1, the order 2 and a tolerance that takes hundreds of edges.
#[test]
fn a_symmetric_domain_keeps_its_symmetries_through_the_steps() {
    let mut builder = Domain::builder();
    builder.begin_loop(LoopKind::Outer, "wall").unwrap();
    builder.add_arc([0.0, 0.0], 1.0, 0.0, std::f64::consts::TAU, "").unwrap();
    builder.end_loop().unwrap();
    let disc = builder.build().unwrap();
    let options = Options { order: 2, tolerance: Tolerance::Relative(1e-9), ..Options::default() };
    let mut stages = Stages::default();
    let mesh = generate(&disc, &options, &mut stages).unwrap();
    assert!(stages.rounds.iter().any(|round| round.action == "tighten"));
    let symmetry = stages.symmetry.unwrap().mesh;
    assert!(symmetry.rotations >= 2 && symmetry.mirrors >= 2, "{symmetry:?}");
    let quality = Quality::new(mesh.order);
    let least = (0..mesh.elements.len())
        .map(|e| quality.measure(mesh.element_nodes(e)).scaled_jacobian)
        .fold(f64::INFINITY, f64::min);
    // Division changes no shape: an element of a disc comes to 0.8.
    assert!(least > 0.7, "{least}");
}

#[test]
fn a_size_divides_the_mesh_that_keeps_the_tolerance() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/domains/hohq/BlobAdapt.control");
    let domain = input::read(&file, None).unwrap().domain;
    let elements = |size: Option<f64>| {
        let options = Options {
            order: 2,
            tolerance: Tolerance::Relative(1e-6),
            max_element_size: size,
            ..Options::default()
        };
        let mut stages = Stages::default();
        let mesh = generate(&domain, &options, &mut stages).unwrap();
        let actions: Vec<&str> = stages.rounds.iter().map(|round| round.action).collect();
        assert!(actions.contains(&"tighten"), "{actions:?}");
        (mesh.elements.len(), stages.boundary.unwrap())
    };
    let (free, boundary) = elements(None);
    // A fifth of the diagonal: as large as most elements are.
    let (sized, _) = elements(Some(0.2 * boundary.diagonal * boundary.frame.scale));
    assert!(sized <= 2 * free, "{free} elements, {sized} of a size");
}
