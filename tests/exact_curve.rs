//! Meshes on the exact curves of a domain, however the caller parametrises and walks them.

mod support;

use quadrel::domain::{Boundary, BoundaryPoint, Domain, LoopKind};
use quadrel::mesh::{BoundaryTolerance, DomainCurve, ExactCurve, HighOrderMesh};
use quadrel::numerics::NONE;
use quadrel::options::{Norm, Options, Tolerance};
use support::o_grid;

const A: f64 = 3.0;
const B: f64 = 2.0;

/// The caller's ellipse: walked clockwise, and standing still at its ends.
fn callers_point(t: f64) -> [f64; 2] {
    let angle = -std::f64::consts::TAU * t * t * (3.0 - 2.0 * t);
    [10.0 + A * angle.cos(), 20.0 + B * angle.sin()]
}

fn ellipse() -> (Domain, Boundary) {
    let mut builder = Domain::builder();
    builder.begin_loop(LoopKind::Outer, "rim").unwrap();
    builder.add_callback(Box::new(|t| Ok(callers_point(t))), None, "rim").unwrap();
    builder.end_loop().unwrap();
    let domain = builder.build().unwrap();
    let boundary = Boundary::new(&domain).unwrap();
    (domain, boundary)
}

#[test]
fn points_are_on_the_curve_and_at_their_arc_length() {
    let (domain, boundary) = ellipse();
    let curve = DomainCurve { boundary: &boundary, domain: &domain };
    let chain = &boundary.chains[0];
    for k in 0..=1000 {
        let s = chain.length * k as f64 / 1000.0;
        let p = curve.point(BoundaryPoint { chain: 0, s }).unwrap();
        let off = ((p.x - 10.0) / A).powi(2) + ((p.y - 20.0) / B).powi(2) - 1.0;
        assert!(off.abs() < 1e-13, "at {s}: {off}");
        let table = boundary.frame.to_caller(chain.point(s));
        assert!((p - table).norm() < 1e-9 * boundary.frame.scale);
    }
}

#[test]
fn a_mesh_on_exact_curves_keeps_every_norm() {
    let (domain, boundary) = ellipse();
    let mesh = o_grid(&boundary, 0.6);
    for norm in [Norm::L2, Norm::H1, Norm::Max] {
        let options = Options { norm, order: 8, tolerance: Tolerance::Relative(1e-5), ..Options::default() };
        let tolerance = BoundaryTolerance::new(&options, &boundary);
        let fine = HighOrderMesh::new(&mesh, &boundary, &domain, &tolerance).unwrap();
        fine.check().unwrap();
        // D is the diagonal of the caller's box, 6 by 4.
        let diagonal = (4.0 * (A * A + B * B)).sqrt();
        let allowed = 1e-5 * if norm == Norm::Max { diagonal } else { diagonal.powf(1.5) };
        let largest = fine.boundary_errors()[0];
        assert!(largest > 0.0 && largest <= allowed * (1.0 + 1e-3), "{norm:?}: {largest} of {allowed}");
    }
}

#[test]
fn boundary_edges_name_the_callers_segment_and_parameter() {
    let (domain, boundary) = ellipse();
    let tolerance = BoundaryTolerance::new(&Options { order: 8, ..Options::default() }, &boundary);
    let fine = HighOrderMesh::new(&o_grid(&boundary, 0.6), &boundary, &domain, &tolerance).unwrap();
    let mut checked = 0;
    for edge in fine.edges.iter().filter(|e| e.elements[1] == NONE) {
        assert_eq!((edge.segments, edge.loop_index), ([0, 0], 0));
        for (v, t) in edge.vertices.iter().zip(edge.parameters) {
            let [x, y] = callers_point(t);
            let p = fine.vertices[*v as usize];
            assert!((p.x - x).hypot(p.y - y) < 1e-12, "{p} is not at {t}");
            checked += 1;
        }
        assert!(edge.parameters[0] > edge.parameters[1], "the caller walks the other way");
    }
    assert_eq!(checked, 16);
}
