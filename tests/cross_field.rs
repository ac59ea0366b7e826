//! Step 2: the cross field is tangent to the border and consistent.

mod shapes;

use quadrel::base_mesh::{triangulate, Request};
use quadrel::cross_field::{quads_at_corner, solve};
use quadrel::domain::Place;
use quadrel::options::FieldMethod;
use shapes::{all, square};

#[test]
fn invariants_hold_on_every_shape() {
    for (name, b) in all() {
        let mesh = triangulate(&b, &Request::default()).unwrap();
        for method in [FieldMethod::Diffused, FieldMethod::Harmonic] {
            let field = solve(&mesh, &b, method).unwrap();
            field.check(&mesh).unwrap_or_else(|e| panic!("{name} {method:?}: {e:?}"));
            assert!(field.triangles.iter().all(|t| t.winding.abs() <= 1), "{name} {method:?}");
        }
    }
}

#[test]
fn border_angles_are_the_polygon_s() {
    for (name, b) in all() {
        let mesh = triangulate(&b, &Request::default()).unwrap();
        let field = solve(&mesh, &b, FieldMethod::Diffused).unwrap();
        for own in &mesh.loops {
            let turn: f64 = own.iter().map(|&v| std::f64::consts::PI - field.border_angle[v as usize]).sum();
            assert!((turn.abs() - std::f64::consts::TAU).abs() < 1e-9, "{name}: loop turns by {turn}");
            for &v in own {
                let expected = match mesh.vertices[v as usize].place {
                    Place::Junction(j) => quads_at_corner(b.junctions[j as usize].angle),
                    _ => 2,
                };
                assert_eq!(field.quads_at[v as usize], expected, "{name}");
            }
        }
    }
}

#[test]
fn the_square_s_field_is_constant() {
    let b = square();
    let mesh = triangulate(&b, &Request::default()).unwrap();
    let field = solve(&mesh, &b, FieldMethod::Diffused).unwrap();
    for (t, own) in field.triangles.iter().enumerate() {
        assert!(
            own.edge_turn.iter().chain(&own.corner_turn).all(|x| x.abs() < 1e-6),
            "triangle {t}: {own:?}"
        );
    }
}

#[test]
fn diffusion_makes_unit_vectors_and_harmonic_does_not() {
    let b = shapes::disc();
    let mesh = triangulate(&b, &Request::default()).unwrap();
    let least = |method| {
        let u = solve(&mesh, &b, method).unwrap().u;
        u.iter().map(|u| u[0].hypot(u[1])).fold(f64::INFINITY, f64::min)
    };
    assert!((least(FieldMethod::Diffused) - 1.0).abs() < 1e-9);
    // On the disc u = z⁴.
    assert!(least(FieldMethod::Harmonic) < 0.05);
}

#[test]
fn check_sees_a_turn_that_is_not_mutual() {
    let b = square();
    let mesh = triangulate(&b, &Request::default()).unwrap();
    let mut field = solve(&mesh, &b, FieldMethod::Diffused).unwrap();
    field.triangles[3].edge_turn[1] += 0.1;
    assert!(field.check(&mesh).is_err());
    let mut field = solve(&mesh, &b, FieldMethod::Diffused).unwrap();
    field.quads_at[mesh.loops[0][0] as usize] += 1;
    assert!(field.check(&mesh).is_err());
}
