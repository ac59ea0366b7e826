//! Tolerances that take many more edges than the shape does.

mod fixtures;
mod support;

use fixtures::{even, rectangle};
use quadrel::domain::{Boundary, BoundaryPoint, Domain, LoopKind, Place};
use quadrel::mesh::{BoundaryError, BoundaryTolerance, HighOrderMesh, QuadMesh, Quality, TableCurve, Vertex};
use quadrel::options::{Norm, Tolerance};
use quadrel::refine::{
    divide_boundary, divide_inside, divide_wide, first_tolerance, insert_layer, layered, least_pieces,
};
use quadrel::smooth::{Care, Optimiser};
use quadrel::stages::Stages;
use quadrel::{generate, input, Error, Options};
use std::collections::HashMap;
use std::path::Path;
use support::{boundary, chain, disc_o_grid, ellipse, o_grid, polygon};

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
        assert_eq!(first_tolerance(&flat(), &asked, false).unwrap(), asked);
    }
}

#[test]
fn a_looser_tolerance_takes_few_edges() {
    let flat = flat();
    for (order, value) in [(1, 1e-7), (2, 1e-9), (2, 1e-10)] {
        let asked = tolerance(order, value);
        assert!(pieces(&flat, &asked) > 200);
        let first = first_tolerance(&flat, &asked, false).unwrap();
        // Twelve are few on any domain.
        assert!((6..=12).contains(&pieces(&flat, &first)), "order {order}");
    }
    // Edges that are not many are made at once, unless that has come out poor.
    let asked = tolerance(2, 1e-6);
    assert!((20..=100).contains(&pieces(&flat, &asked)));
    assert_eq!(first_tolerance(&flat, &asked, false).unwrap(), asked);
    assert!(pieces(&flat, &first_tolerance(&flat, &asked, true).unwrap()) <= 12);
}

/// The least scaled Jacobian of the straight-sided elements.
fn least(mesh: &QuadMesh) -> f64 {
    let of = |quad: &[u32; 4]| {
        let p = quad.map(|v| mesh.vertices[v as usize].point);
        let at = |k: usize| {
            let (a, b) = (p[(k + 1) % 4] - p[k], p[(k + 3) % 4] - p[k]);
            (a.x * b.y - a.y * b.x) / (a.norm() * b.norm())
        };
        (0..4).map(at).fold(f64::INFINITY, f64::min)
    };
    mesh.quads.iter().map(of).fold(f64::INFINITY, f64::min)
}

fn boundary_edges(mesh: &QuadMesh) -> usize {
    mesh.edges.iter().filter(|e| e.span.is_some()).count()
}

#[test]
fn sides_are_divided_in_three_inside_their_element() {
    let (b, square) = rectangle(1.0, 1.0, &even(1), &even(1));
    for (sides, quads, edges) in [
        (vec![0], 4, 6),
        (vec![2], 4, 6),
        (vec![0, 1], 6, 8),
        (vec![3, 0], 6, 8),
        (vec![1, 3], 3, 8),
        (vec![0, 1, 2, 3], 9, 12),
        // The third waits.
        (vec![0, 1, 2], 3, 8),
    ] {
        let mut cuts = vec![None; square.edges.len()];
        for side in &sides {
            let e = square.quad_edges[0][*side] as usize;
            let span = square.edges[e].span.unwrap();
            let at = |share| span.start + share * (span.end - span.start);
            cuts[e] = Some([at(0.3), at(0.7)]);
        }
        let divided = divide_inside(&square, &b, &cuts, 3).unwrap();
        divided.check(&b).unwrap();
        assert_eq!((divided.quads.len(), boundary_edges(&divided)), (quads, edges), "sides {sides:?}");
        assert!(least(&divided) > 0.3, "sides {sides:?}: {}", least(&divided));
    }
}

#[test]
fn a_row_follows_the_stretches_with_many_marked_edges() {
    let (b, m) = rectangle(3.0, 2.0, &even(3), &even(2));
    let on_side = |mesh: &QuadMesh, chains: &[u32]| -> Vec<bool> {
        mesh.edges.iter().map(|e| e.span.is_some_and(|s| chains.contains(&s.chain))).collect()
    };
    // Along one side, two that meet, all: so many more quads, and edges at the corners.
    for (chains, quads, edges) in [(vec![0], 3, 2), (vec![0, 1], 3 + 2 + 1, 4), (vec![0, 1, 2, 3], 14, 8)] {
        let layer = insert_layer(&m, &b, &on_side(&m, &chains), 0.5, 3).unwrap();
        layer.check(&b).unwrap();
        assert_eq!(layer.quads.len(), m.quads.len() + quads, "{chains:?}");
        assert_eq!(boundary_edges(&layer), boundary_edges(&m) + edges, "{chains:?}");
        assert!(least(&layer) > 0.8, "{chains:?}: {}", least(&layer));
    }
    let mut one = on_side(&m, &[0]);
    let first = one.iter().position(|on| *on).unwrap();
    one.iter_mut().enumerate().for_each(|(e, on)| *on &= e == first);
    // One of three edges.
    assert_eq!(insert_layer(&m, &b, &one, 0.5, 3).unwrap().quads.len(), m.quads.len());
    assert_eq!(insert_layer(&m, &b, &one, 0.2, 3).unwrap().quads.len(), m.quads.len() + 3);
}

/// Three squares round a corner of 270 degrees: it keeps three elements.
#[test]
fn a_row_passes_a_wide_corner() {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let b = polygon(&corners);
    let junction = |k: u32| Vertex { point: b.junctions[k as usize].point, place: Place::Junction(k) };
    let mut vertices: Vec<Vertex> = (0..6).map(junction).collect();
    for chain in [0u32, 5] {
        let s = 0.5 * b.chains[chain as usize].length;
        let place = Place::Boundary(BoundaryPoint { chain, s });
        vertices.push(Vertex { point: b.chains[chain as usize].point(s), place });
    }
    let quads = vec![[0, 6, 3, 7], [6, 1, 2, 3], [7, 3, 4, 5]];
    let m = QuadMesh::new(&b, vertices, quads, vec![0; 3], &HashMap::new()).unwrap();
    let marked: Vec<bool> = m.edges.iter().map(|e| e.span.is_some()).collect();
    let layer = insert_layer(&m, &b, &marked, 0.0, 2).unwrap();
    layer.check(&b).unwrap();
    let around = |v: u32| layer.quads.iter().filter(|quad| quad.contains(&v)).count();
    assert_eq!(around(3), 3);
    // A quad for each edge, five corners, and two more of the middle square.
    assert_eq!(layer.quads.len(), 3 + 8 + 5 + 2);
    assert!(least(&layer) > 0.5, "{}", least(&layer));
}

/// Divided until nothing breaks the tolerance, with smoothing in between as the library has it.
#[test]
fn elements_grow_with_boundary_edges() {
    for (b, mesh) in [disc_o_grid(0.6), (flat(), o_grid(&flat(), 0.6))] {
        for (order, value) in [(2, 1e-8), (3, 1e-9)] {
            for even in [false, true] {
                let tolerance = tolerance(order, value);
                let error = BoundaryError::new(tolerance);
                let fixed = Optimiser::new(&b, order, None).with_fixed_boundary();
                let least_edges = pieces(&b, &tolerance);
                let mut fine = layered(&mesh, &b, &error, 0.3, order).unwrap();
                while let Some(next) = divide_boundary(&fine, &b, &error, even, order).unwrap() {
                    fine = layered(&next, &b, &error, 0.3, order).unwrap();
                    fixed.optimise(&mut fine, None, Care::Quick);
                }
                fine.check(&b).unwrap();
                let edges = boundary_edges(&fine);
                let most = if even { 3 * least_edges } else { 3 * least_edges / 2 };
                assert!(edges <= most, "order {order}: {edges} edges, {least_edges} needed");
                assert!(fine.quads.len() <= 5 * edges / 2, "{} quads, {edges} edges", fine.quads.len());
                let done = HighOrderMesh::with_curve(&fine, &b, &TableCurve(&b), &tolerance).unwrap();
                done.check().unwrap();
            }
        }
    }
}

#[test]
fn wide_elements_are_divided_with_their_chords() {
    // Squeezed to a fifth: 8 edges of four times their elements' depth and more.
    let (b, mesh) = disc_o_grid(0.93);
    let error = BoundaryError::new(tolerance(2, 1e-8));
    let divided = divide_wide(mesh.clone(), &b, &error, 2).unwrap();
    divided.check(&b).unwrap();
    assert!(divided.quads.len() > mesh.quads.len());
    // What keeps the tolerance stays.
    let loose = BoundaryError::new(tolerance(2, 1.0));
    assert_eq!(divide_wide(mesh.clone(), &b, &loose, 2).unwrap().quads, mesh.quads);
}

#[test]
fn the_element_limit_is_an_error_with_a_place_on_the_boundary() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/domains/hohq/BlobAdapt.control");
    let domain = input::read(&file, None).unwrap().domain;
    let options =
        Options { order: 2, tolerance: Tolerance::Relative(1e-9), max_elements: 400, ..Options::default() };
    let mut stages = Stages::default();
    match generate(&domain, &options, &mut stages) {
        Err(Error::Tolerance { at, tolerance, error }) => {
            assert!(error > tolerance);
            let boundary = stages.boundary.unwrap();
            let at = boundary.frame.to_canonical(at);
            let samples = boundary.chains.iter().flat_map(|chain| &chain.samples);
            let nearest = samples.map(|s| (s.point - at).norm()).fold(f64::INFINITY, f64::min);
            assert!(nearest < 1e-2, "{nearest}");
        }
        other => panic!("{:?}", other.map(|mesh| mesh.elements.len())),
    }
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
