//! A caller's own base triangulation: the same singularities as on ours, and every defect refused.

use quadrel::domain::{Boundary, Domain, Place};
use quadrel::numerics::Point;
use quadrel::options::{BaseTriangulation, BoundaryVertex, Tolerance};
use quadrel::stages::Stages;
use quadrel::{generate, input, Error, Options};
use std::path::Path;
use std::sync::Arc;

fn domain(name: &str) -> Domain {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/domains").join(name);
    input::read(&path, None).unwrap_or_else(|e| panic!("{name}: {e}")).domain
}

fn options(own: Option<BaseTriangulation>) -> Options {
    let base_triangulation = own.map(Arc::new);
    Options { order: 4, tolerance: Tolerance::Relative(1e-4), base_triangulation, ..Options::default() }
}

/// The base mesh of a run as a caller would bring it, its vertices in another order.
fn brought(domain: &Domain, stages: &Stages) -> BaseTriangulation {
    let boundary = stages.boundary.as_ref().unwrap();
    let base = stages.triangulation.as_ref().unwrap();
    let n = base.vertices.len() as u32;
    let number = |v: u32| n - 1 - v;
    let mut own = BaseTriangulation::default();
    for (v, vertex) in (0..n).zip(&base.vertices).rev() {
        let p = boundary.frame.to_caller(vertex.point);
        own.vertices.push([p.x, p.y]);
        let (chain, s) = match vertex.place {
            Place::Interior => continue,
            Place::Boundary(p) => (p.chain, p.s),
            Place::Junction(j) => (boundary.junctions[j as usize].chain_out, 0.0),
        };
        let (l, segment, t) = boundary.curve_place(domain, chain, s).unwrap().in_callers_terms(domain);
        own.boundary.push(BoundaryVertex {
            vertex: number(v),
            loop_index: l as u32,
            segment: segment as u32,
            t,
        });
    }
    own.triangles = base.triangles.iter().map(|t| [1, 2, 0].map(|i| number(t[i]))).collect();
    own
}

#[test]
fn the_pipeline_finds_the_same_on_a_mesh_that_was_brought() {
    for name in
        ["mech/unit-circle.control", "mech/half-disc.control", "hohq/PacMan.control", "hohq/Pill.control"]
    {
        let domain = domain(name);
        let mut ours = Stages::default();
        let expected = generate(&domain, &options(None), &mut ours).unwrap();
        let own = brought(&domain, &ours);
        let mut theirs = Stages::default();
        let mesh = generate(&domain, &options(Some(own.clone())), &mut theirs).unwrap();
        mesh.check().unwrap_or_else(|e| panic!("{name}: {e:?}"));
        let base = theirs.triangulation.as_ref().unwrap();
        assert_eq!(base.vertices.len(), own.vertices.len());
        assert_eq!(base.triangles, own.triangles);
        assert_eq!(ours.singularities.len(), theirs.singularities.len(), "{name}");
        for s in &ours.singularities {
            let near = theirs
                .singularities
                .iter()
                .any(|o| o.valence == s.valence && (o.point - s.point).norm() < 1e-3);
            assert!(near, "{name}: no singularity at {}", s.point);
        }
        // Coarsening breaks ties by the order of things, which is another one here.
        assert!(2 * mesh.elements.len() <= 3 * expected.elements.len(), "{name}");
    }
}

#[test]
fn places_are_the_reverse_of_the_caller_s_terms() {
    for name in ["hohq/PacMan.control", "hohq/EllipseAndFourCircles.control", "glyphs/DejaVuSans/u0038.svg"] {
        let domain = domain(name);
        let boundary = Boundary::new(&domain).unwrap();
        for (c, chain) in (0..).zip(&boundary.chains) {
            for k in 0..20 {
                let s = chain.length * (0.05 * k as f64 + 0.013);
                let (l, segment, t) = boundary.curve_place(&domain, c, s).unwrap().in_callers_terms(&domain);
                match boundary.place_of(&domain, l, segment, t).unwrap() {
                    Place::Boundary(p) => assert!(p.chain == c && (p.s - s).abs() < 1e-9, "{name} {s} {p:?}"),
                    other => panic!("{name}: {other:?}"),
                }
            }
        }
        for (j, junction) in (0..).zip(&boundary.junctions) {
            let place = boundary.curve_place(&domain, junction.chain_out, 0.0).unwrap();
            let (l, segment, t) = place.in_callers_terms(&domain);
            assert_eq!(boundary.place_of(&domain, l, segment, t).unwrap(), Place::Junction(j), "{name}");
        }
    }
}

/// The unit square with a vertex in the middle; nothing is wrong with it.
fn square() -> (Domain, BaseTriangulation) {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let domain = Domain::polygon(&corners, &[]).unwrap();
    // Corners and middles of the sides, so that the field is resolved.
    let mut own = BaseTriangulation::default();
    for i in 0..4 {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        own.vertices.push(a);
        own.vertices.push([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
        for (k, t) in [(0, 0.0), (1, 0.5)] {
            let vertex = (2 * i + k) as u32;
            own.boundary.push(BoundaryVertex { vertex, loop_index: 0, segment: i as u32, t });
        }
    }
    own.vertices.push([0.5, 0.5]);
    own.triangles = (0..8).map(|i| [i, (i + 1) % 8, 8]).collect();
    (domain, own)
}

/// How a square is refused whose triangulation was changed by `spoil`.
fn refusal(spoil: impl FnOnce(&mut BaseTriangulation)) -> Error {
    let (domain, mut own) = square();
    spoil(&mut own);
    generate(&domain, &options(Some(own)), &mut Stages::default()).unwrap_err()
}

#[test]
fn a_sound_triangulation_of_the_square_is_taken() {
    let (domain, mut own) = square();
    // A corner told for both of its segments.
    own.boundary.push(BoundaryVertex { vertex: 0, loop_index: 0, segment: 3, t: 1.0 });
    let mesh = generate(&domain, &options(Some(own)), &mut Stages::default()).unwrap();
    assert_eq!(mesh.elements.len(), 1);
}

#[test]
fn every_defect_is_refused_with_its_place() {
    type Spoil = fn(&mut BaseTriangulation);
    let base_mesh: [(&str, Spoil); 10] = [
        ("orientation", |o| o.triangles[2].swap(0, 1)),
        ("counter-clockwise", |o| o.vertices[8] = [0.5, -0.1]),
        ("border touches|follow|three triangles|does not cover|place", |o| o.triangles.truncate(4)),
        ("three triangles", |o| o.triangles.push([0, 1, 8])),
        ("no place", |o| {
            o.boundary.remove(3);
        }),
        ("no place", |o| o.boundary.clear()),
        ("not at its place|follow", |o| o.boundary[1].t = 0.9),
        ("two different places", |o| o.boundary.push(BoundaryVertex { t: 0.25, ..o.boundary[1] })),
        ("in no triangle", |o| o.vertices.push([0.25, 0.25])),
        ("does not cover", |o| o.triangles.clear()),
    ];
    for (k, (words, spoil)) in base_mesh.into_iter().enumerate() {
        match refusal(spoil) {
            Error::BaseMesh { reason, at } => {
                assert!(words.split('|').any(|w| reason.contains(w)), "{k}: {reason}");
                assert!(at.is_some_and(|p| (p - Point::new(0.5, 0.5)).norm() < 1.0), "{k}: {at:?}");
            }
            other => panic!("{k}: {other}"),
        }
    }
    let numbers: [Spoil; 6] = [
        |o| o.triangles[0][0] = 9,
        |o| o.boundary[0].vertex = u32::MAX,
        |o| o.boundary[0].loop_index = 1,
        |o| o.boundary[0].segment = 4,
        |o| o.boundary[0].t = 1.5,
        |o| o.vertices[8][0] = f64::NAN,
    ];
    for (k, spoil) in numbers.into_iter().enumerate() {
        let error = refusal(spoil);
        assert!(matches!(error, Error::InvalidArgument { .. }), "{k}: {error}");
    }
}

#[test]
fn a_corner_without_a_vertex_is_refused() {
    let error = refusal(|o| {
        // Corner 1 (vertex 2) is cut off.
        o.triangles[1] = [1, 3, 8];
        o.triangles.remove(2);
        o.boundary.retain(|b| b.vertex != 2);
        o.vertices[2] = [0.6, 0.5];
        o.triangles.push([1, 3, 2]);
    });
    assert!(matches!(error, Error::BaseMesh { .. }), "{error}");
}
