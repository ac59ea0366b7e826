//! Step 3: number, place and separatrices of the singularities.

mod shapes;

use quadrel::base_mesh::{triangulate, usual_size, Request};
use quadrel::cross_field::{solve, solve_with_corners, CornerRule};
use quadrel::domain::Boundary;
use quadrel::options::FieldMethod;
use quadrel::singularities::{check, find, gate, resolve, Resolved};
use shapes::{all, annulus, boundary, circle, disc, l_shape, regular, sector, square};

fn resolved(b: &Boundary) -> Resolved {
    resolve(b, Request::default(), FieldMethod::Diffused).unwrap()
}

fn valences(r: &Resolved) -> Vec<u8> {
    let mut valences: Vec<u8> = r.singularities.iter().map(|s| s.valence).collect();
    valences.sort_unstable();
    valences
}

#[test]
fn index_theorem_holds_on_every_shape() {
    for (name, b) in all() {
        for method in [FieldMethod::Diffused, FieldMethod::Harmonic] {
            let r =
                resolve(&b, Request::default(), method).unwrap_or_else(|e| panic!("{name} {method:?}: {e}"));
            check(&r.mesh, &r.singularities, &r.corners)
                .unwrap_or_else(|e| panic!("{name} {method:?}: {e:?}"));
        }
    }
}

#[test]
fn simple_shapes_have_the_singularities_of_their_topology() {
    assert_eq!(valences(&resolved(&disc())), [3; 4]);
    assert_eq!(valences(&resolved(&square())), [0; 0]);
    assert_eq!(valences(&resolved(&annulus())), [0; 0]);
    assert_eq!(valences(&resolved(&l_shape())), [0; 0]);
    // Each corner of 60° wants one quad, so 4 − 3 remain.
    assert_eq!(valences(&resolved(&regular(3))), [3]);
    // At 135° the tie goes down to one quad: 4 − 8.
    assert_eq!(valences(&resolved(&regular(8))), [5; 4]);
    // A tie at 45° goes to one quad, and its point stays clear of the tips.
    assert_eq!(valences(&resolved(&sector(45.0))), [3]);
    let right = boundary(&[shapes::polygon(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])]);
    assert_eq!(valences(&resolved(&right)), [3]);
    // The tip has none, so 4 − 2 − 1 − 1.
    assert_eq!(valences(&resolved(&sector(20.0))), [0; 0]);
}

#[test]
fn diffusion_keeps_the_disc_s_singularities_apart() {
    let distance = |method| {
        let b = disc();
        let r = resolve(&b, Request::default(), method).unwrap();
        assert_eq!(
            r.singularities.iter().filter(|s| s.valence == 3).count(),
            4 + r.singularities.len() / 2 - 2
        );
        let middle = 0.25
            * (0..4)
                .map(|i| f64::from(i) * 0.25 * b.chains[0].length)
                .fold(quadrel::numerics::Vector::zeros(), |sum, s| sum + b.chains[0].point(s).coords);
        let mean: f64 = r.singularities.iter().map(|s| (s.point.coords - middle).norm()).sum();
        // The disc's radius is 1/√8 of its bounding box's diagonal.
        mean / r.singularities.len() as f64 * 8f64.sqrt()
    };
    let (diffused, harmonic) = (distance(FieldMethod::Diffused), distance(FieldMethod::Harmonic));
    assert!((0.6..0.9).contains(&diffused), "{diffused}");
    assert!(harmonic < 0.7 * diffused, "{harmonic} {diffused}");
}

#[test]
fn ports_run_counter_clockwise_around_the_triangle() {
    for (name, b) in all() {
        let r = resolved(&b);
        for s in &r.singularities {
            assert_eq!(s.ports.len(), s.valence as usize, "{name}");
            assert!(s.ports.iter().all(|&(e, x)| e < 3 && x > 0.0 && x < 1.0), "{name}: {:?}", s.ports);
            let along: Vec<f64> = s.ports.iter().map(|&(e, x)| f64::from(e) + x).collect();
            let descents = (0..along.len()).filter(|&k| along[(k + 1) % along.len()] <= along[k]).count();
            assert_eq!(descents, 1, "{name}: {along:?}");
        }
    }
}

#[test]
fn ports_follow_the_cross() {
    // Far from the border the field is smooth: each port's direction is an arm of the cross there.
    for b in [disc(), regular(3), regular(5), regular(8)] {
        let r = resolved(&b);
        assert!(!r.singularities.is_empty());
        for s in &r.singularities {
            let p = r.mesh.triangles[s.triangle as usize].map(|v| r.mesh.vertices[v as usize].point);
            let field = &r.field.triangles[s.triangle as usize];
            for &(e, x) in &s.ports {
                let (a, b) = (p[e as usize], p[(e as usize + 1) % 3]);
                let d = a + (b - a) * x - s.point;
                let angle = field.start_of_edge(e as usize) + x * field.edge_turn[e as usize];
                let off = (d.y.atan2(d.x) - angle).rem_euclid(std::f64::consts::FRAC_PI_2);
                let off = off.min(std::f64::consts::FRAC_PI_2 - off);
                assert!(off < 1e-6, "off by {off}");
            }
        }
    }
}

#[test]
fn corners_are_listed() {
    let r = resolved(&l_shape());
    let quads: Vec<u8> = r.corners.iter().map(|c| c.quads).collect();
    assert_eq!(quads.iter().filter(|&&n| n == 1).count(), 5);
    assert_eq!(quads.iter().filter(|&&n| n == 3).count(), 1);
    let r = resolved(&sector(340.0));
    assert!(r.corners.iter().any(|c| c.quads == 4 && (c.angle.to_degrees() - 340.0).abs() < 1e-6));
    assert!(resolved(&disc()).corners.is_empty());
}

#[test]
fn a_coarse_base_mesh_is_noticed_and_refined() {
    // Slots and holes of a fifth of the wanted edge.
    let b = boundary(&[
        shapes::polygon(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]]),
        circle([1.0, 1.1], -0.3),
        circle([1.7, 1.1], -0.3),
        circle([1.35, 1.75], -0.3),
    ]);
    let coarse = Request { size: Some(0.3), refine: vec![] };
    let mesh = triangulate(&b, &coarse).unwrap();
    let field = solve(&mesh, &b, FieldMethod::Diffused).unwrap();
    let least = 0.05 * usual_size(&b);
    let known = find(&mesh, &b, &field).map_or(vec![], |f| f.0);
    let asked = gate(&mesh, &b, &field, &known, least).unwrap_err();
    assert!(!asked.is_empty() && asked.iter().all(|&(_, h)| h < 0.3));
    let r = resolve(&b, coarse, FieldMethod::Diffused).unwrap();
    assert!(gate(&r.mesh, &b, &r.field, &r.singularities, least).is_ok());
    assert!(r.mesh.triangles.len() > mesh.triangles.len());
}

#[test]
fn singularities_settle_where_u_jumps() {
    // At the seam corner of 310° on the Gingerbread man's neck u jumps almost to its opposite. The zero of u
    // beside it must not wander with the size of the triangles; it went by 0.6 edges when u at the corner
    // was the middle of the arc, which has its part in zeros an edge away.
    let model = quadrel::input::gingerbread_man().unwrap();
    let b = Boundary::new(&model.domain).unwrap();
    let corner = b.junctions.iter().max_by(|a, c| a.angle.total_cmp(&c.angle)).unwrap().point;
    let usual = usual_size(&b);
    let nearest = |share: f64| {
        let request = Request { size: Some(share * usual), refine: vec![] };
        let r = resolve(&b, request, FieldMethod::Diffused).unwrap();
        let five = r.singularities.iter().filter(|s| s.valence == 5).map(|s| s.point);
        five.min_by(|p, q| (p - corner).norm().total_cmp(&(q - corner).norm())).unwrap()
    };
    let finest = nearest(0.15);
    let wanders = [1.0, 0.6, 0.4, 0.25].map(|share| (nearest(share) - finest).norm() / usual);
    assert!(wanders.iter().all(|&w| w < 0.4), "{wanders:?}");
}

#[test]
fn on_a_second_try_corners_near_a_tie_take_up_the_singularities_beside_them() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/domains/icons/mdi/atv.svg");
    let b = Boundary::new(&quadrel::input::read(&path, None).unwrap().domain).unwrap();
    let mesh = triangulate(&b, &Request::default()).unwrap();
    let [first, second] = [false, true].map(|absorbing| {
        let rule = CornerRule { absorbing, ..CornerRule::default() };
        let field = solve_with_corners(&mesh, &b, FieldMethod::Diffused, rule).unwrap();
        let (singularities, corners) = find(&mesh, &b, &field).unwrap();
        check(&mesh, &singularities, &corners).unwrap();
        (singularities.len(), corners)
    });
    assert!(second.0 < first.0, "{} and {}", first.0, second.0);
    // Each of them is a quad more or less at a corner whose quads get angles of 60° to 120°.
    let changed: Vec<_> = first.1.iter().zip(&second.1).filter(|(a, b)| a.quads != b.quads).collect();
    assert_eq!(changed.len(), first.0 - second.0);
    for (before, after) in changed {
        assert_eq!((before.junction, before.quads.abs_diff(after.quads)), (after.junction, 1));
        let share = (after.angle / f64::from(after.quads)).to_degrees();
        assert!((59.9..120.1).contains(&share), "{share} degrees");
    }
}
