//! Symmetric domains get symmetric meshes, seen from outside: all nodes reflected or turned are nodes, and elements
//! go to elements.

mod symmetric_domains;

use quadrel::domain::{Domain, LoopKind};
use quadrel::mesh::{DomainCurve, HighOrderMesh};
use quadrel::numerics::{Point, Vector};
use quadrel::options::SizeFunction;
use quadrel::progress::Progress;
use quadrel::stages::{Stages, SymmetryCount};
use quadrel::symmetry::Group;
use quadrel::{generate, input, Options};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{PI, TAU};
use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use symmetric_domains::{builder, circle, disc, domains, file, gingerbread, plate, wheel};

/// Farthest that a reflected node may be from a node, in diagonals of the domain.
const EXACT: f64 = 1e-12;

/// A rotation by `angle` about `center`, or the mirror at the line through `center` at `angle`.
#[derive(Debug, Clone, Copy)]
enum Map {
    Turn { center: [f64; 2], angle: f64 },
    Mirror { center: [f64; 2], angle: f64 },
}

impl Map {
    fn point(&self, p: Point) -> Point {
        let (Map::Turn { center, angle } | Map::Mirror { center, angle }) = *self;
        let center = Point::from(center);
        let d = p - center;
        let (x, y, angle) = match self {
            Map::Turn { .. } => (d.x, d.y, angle),
            Map::Mirror { .. } => (d.x, -d.y, 2.0 * angle),
        };
        let (s, c) = angle.sin_cos();
        center + Vector::new(c * x - s * y, s * x + c * y)
    }
}

/// The mirrors at the axes of `center`, at these angles.
fn mirrors(center: [f64; 2], angles: &[f64]) -> Vec<Map> {
    angles.iter().map(|angle| Map::Mirror { center, angle: *angle }).collect()
}

/// The point of `sorted` (by x) nearest to `p`: its index and distance.
fn nearest(sorted: &[(Point, usize)], p: Point, reach: f64) -> Option<(usize, f64)> {
    let from = sorted.partition_point(|(q, _)| q.x < p.x - reach);
    let close = sorted[from..].iter().take_while(|(q, _)| q.x <= p.x + reach);
    close.map(|(q, i)| (*i, (q - p).norm())).min_by(|a, b| a.1.total_cmp(&b.1))
}

/// What is wrong with the claim that `map` takes `mesh` onto itself.
fn defect(mesh: &HighOrderMesh, diagonal: f64, map: Map) -> Option<String> {
    let by_x = |points: &[Point]| {
        let mut sorted: Vec<(Point, usize)> = points.iter().copied().zip(0..).collect();
        sorted.sort_by(|a, b| a.0.x.total_cmp(&b.0.x));
        sorted
    };
    let reach = EXACT * diagonal;
    let nodes = mesh.shared_nodes();
    let sorted = by_x(&nodes);
    let mut met = BTreeSet::new();
    for p in &nodes {
        match nearest(&sorted, map.point(*p), reach) {
            Some((i, d)) if d <= reach => {
                met.insert(i);
            }
            other => return Some(format!("{map:?} of {p} is no node: {other:?}")),
        }
    }
    if met.len() != nodes.len() {
        return Some(format!("{map:?}: two nodes go to one"));
    }
    let sorted = by_x(&mesh.vertices);
    let image = |v: &u32| nearest(&sorted, map.point(mesh.vertices[*v as usize]), reach).map(|x| x.0 as u32);
    let elements: BTreeSet<BTreeSet<u32>> =
        mesh.elements.iter().map(|e| e.iter().copied().collect()).collect();
    for element in &mesh.elements {
        let corners: Option<BTreeSet<u32>> = element.iter().map(image).collect();
        if !corners.is_some_and(|c| elements.contains(&c)) {
            return Some(format!("{map:?}: the image of element {element:?} is none"));
        }
    }
    None
}

/// The mesh of `domain`, which has to have the symmetries `maps`; its report has to say `expected`.
fn check(name: &str, domain: &Domain, expected: [usize; 2], maps: &[Map]) -> HighOrderMesh {
    let mut stages = Stages::default();
    let mesh = generate(domain, &Options::default(), &mut stages).unwrap_or_else(|e| panic!("{name}: {e}"));
    let report = stages.symmetry.unwrap();
    let [rotations, mirrors] = expected;
    assert_eq!(report.domain, SymmetryCount { rotations, mirrors }, "{name}");
    assert_eq!(report.mesh, report.domain, "{name}: {:?}", report.asymmetry);
    assert_eq!(report.asymmetry, None, "{name}");
    for map in maps {
        assert_eq!(defect(&mesh, domain.diagonal(), *map), None, "{name}");
    }
    mesh.check().unwrap();
    mesh
}

#[test]
fn a_disc_has_the_symmetries_of_a_square() {
    let center = [0.5, -0.25];
    let mut maps = mirrors(center, &[0.0, PI / 4.0, PI / 2.0, 3.0 * PI / 4.0]);
    maps.push(Map::Turn { center, angle: PI / 2.0 });
    let mesh = check("disc", &disc(), [4, 4], &maps);
    assert!(mesh.elements.len() <= 8, "{} elements", mesh.elements.len());
}

#[test]
fn a_square_with_a_round_hole() {
    let mut maps = mirrors([0.0; 2], &[0.0, PI / 4.0, PI / 2.0, 3.0 * PI / 4.0]);
    maps.push(Map::Turn { center: [0.0; 2], angle: PI / 2.0 });
    check("plate", &plate(), [4, 4], &maps);
}

#[test]
fn the_gingerbread_man() {
    check("gingerbread", &gingerbread(), [1, 1], &mirrors([0.0; 2], &[PI / 2.0]));
}

#[test]
fn the_pill_and_the_airfoil() {
    // Their mirror images bear other names, one to one.
    let maps = mirrors([0.0, 0.25], &[0.0, PI / 2.0]);
    let mesh = check("pill", &file("hohq/Pill.control"), [2, 2], &maps);
    let name = |edge: &quadrel::mesh::MeshEdge| mesh.boundary_names.get(edge.boundary as usize).cloned();
    for edge in mesh.edges.iter().filter(|e| e.elements[1] == u32::MAX) {
        let [a, b] = edge.vertices.map(|v| mesh.vertices[v as usize]);
        let middle = a + (b - a) * 0.5;
        let expected = match (middle.x, middle.y) {
            (x, y) if x.abs() <= 1.0 && y < 1e-9 => "B1",
            (x, y) if x.abs() <= 1.0 && y > 0.5 - 1e-9 => "B3",
            (x, y) if (x - 1.0).hypot(y - 0.25) < 0.03 => "CircleRight",
            (x, y) if (x + 1.0).hypot(y - 0.25) < 0.03 => "CircleLeft",
            (x, y) if x.hypot(y - 0.25) < 0.17 => "CircleCenter",
            (x, _) if x > 1.0 => "B2",
            _ => "B4",
        };
        assert_eq!(name(edge).as_deref(), Some(expected), "at {middle}");
    }
    check("NACA0012", &file("hohq/NACA0012.control"), [1, 1], &mirrors([0.0; 2], &[0.0]));
}

#[test]
fn boundary_edges_tell_where_they_lie_on_the_callers_curves() {
    for domain in [plate(), gingerbread(), disc()] {
        let mesh = generate(&domain, &Options::default(), &mut Stages::default()).unwrap();
        for edge in mesh.edges.iter().filter(|e| e.elements[1] == u32::MAX) {
            let l = domain.loops().iter().find(|l| l.index() == edge.loop_index as usize).unwrap();
            for k in 0..2 {
                let segment = l.segments().iter().find(|s| s.index() == edge.segments[k] as usize).unwrap();
                let t = edge.parameters[k];
                let own = segment.point(if segment.is_reversed() { 1.0 - t } else { t }).unwrap();
                let vertex = mesh.vertices[edge.vertices[k] as usize];
                assert!((own - vertex).norm() <= 1e-11 * domain.diagonal(), "{own} and {vertex}");
            }
        }
    }
}

#[test]
fn polygons_gears_and_letters() {
    let hexagon = Domain::polygon(&wheel(6, &[(0.0, 1.0)]), &[]).unwrap();
    let turn = |steps: usize| Map::Turn { center: [0.0; 2], angle: TAU / steps as f64 };
    let mut maps = mirrors([0.0; 2], &[0.0, PI / 6.0, PI / 3.0]);
    maps.push(turn(6));
    check("hexagon", &hexagon, [6, 6], &maps);
    let gear = builder(|b| {
        b.add_polygon(LoopKind::Outer, &wheel(8, &[(-0.3, 0.8), (-0.15, 1.0), (0.15, 1.0), (0.3, 0.8)]))?;
        circle(b, LoopKind::Hole, [0.0; 2], 0.3)
    });
    check("gear", &gear, [8, 8], &[turn(8), mirrors([0.0; 2], &[0.0])[0]]);
    let a = Domain::polygon(
        &[[0.0, 0.0], [0.6, 0.0], [1.0, 1.0], [2.0, 1.0], [2.4, 0.0], [3.0, 0.0], [1.8, 3.0], [1.2, 3.0]],
        &[vec![[1.2, 1.5], [1.5, 2.2], [1.8, 1.5]]],
    )
    .unwrap();
    check("A", &a, [1, 1], &mirrors([1.5, 0.0], &[PI / 2.0]));
    let holes = builder(|b| {
        b.add_polygon(LoopKind::Outer, &[[-2.0, -1.0], [2.0, -1.0], [2.0, 1.0], [-2.0, 1.0]])?;
        for (x, r) in [(-1.0, 0.3), (0.0, 0.4), (1.0, 0.3)] {
            circle(b, LoopKind::Hole, [x, 0.0], r)?;
        }
        Ok(())
    });
    check("three holes", &holes, [2, 2], &mirrors([0.0; 2], &[0.0, PI / 2.0]));
}

#[test]
fn a_pinwheel_has_rotations_only() {
    // Without a mirror there is no axis to cut along: the direct mesh has to come symmetric, as with four arms it does.
    let pinwheel = Domain::polygon(&wheel(4, &[(0.0, 1.0), (0.4, 0.5), (0.65, 0.35)]), &[]).unwrap();
    check("pinwheel", &pinwheel, [4, 0], &[Map::Turn { center: [0.0; 2], angle: TAU / 4.0 }]);
}

#[test]
fn where_no_symmetric_mesh_is_found_the_direct_one_stays_and_says_so() {
    // Without a mirror there is no axis to cut along, and this mesh is not symmetric by itself.
    let pinwheel = Domain::polygon(&wheel(3, &[(0.0, 1.0), (0.35, 0.35), (0.6, 0.5)]), &[]).unwrap();
    let mut stages = Stages::default();
    let mesh = generate(&pinwheel, &Options::default(), &mut stages).unwrap();
    let report = stages.symmetry.unwrap();
    let map = Map::Turn { center: [0.0; 2], angle: TAU / 3.0 };
    let turned = defect(&mesh, pinwheel.diagonal(), map).is_none();
    assert_eq!(report.domain, SymmetryCount { rotations: 3, mirrors: 0 });
    assert_eq!(turned, report.mesh == report.domain);
    assert_eq!(turned, report.asymmetry.is_none());
    let options = Options { symmetry: false, ..Options::default() };
    let direct = generate(&pinwheel, &options, &mut Stages::default()).unwrap();
    assert_eq!(mesh == direct, !turned);
}

/// Waves (number, height) on a circle, the same on both sides of the axis at `angle` through (3, -1).
fn blob(waves: &[(usize, f64)], angle: f64) -> Domain {
    let waves = waves.to_vec();
    // Radius and its slope at angle `a` from the axis; begun away from it.
    let polar = move |t: f64| {
        let a = TAU * t + 0.7;
        let term = |(n, h): &(usize, f64)| {
            let (s, c) = (*n as f64 * a).sin_cos();
            [h * c, -h * *n as f64 * s]
        };
        let [r, slope] = waves.iter().map(term).fold([1.0, 0.0], |sum, x| [sum[0] + x[0], sum[1] + x[1]]);
        let (s, c) = (a + angle).sin_cos();
        (r, slope, s, c)
    };
    let same = polar.clone();
    let curve = move |t: f64| {
        let (r, _, s, c) = polar(t);
        Ok([3.0 + r * c, -1.0 + r * s])
    };
    let derivative = move |t: f64| {
        let (r, slope, s, c) = same(t);
        Ok([TAU * (slope * c - r * s), TAU * (slope * s + r * c)])
    };
    builder(|b| {
        b.begin_loop(LoopKind::Outer, "blob")?;
        b.add_callback(Box::new(curve), Some(Box::new(derivative)), "")?.end_loop()?;
        Ok(())
    })
}

#[test]
fn mirrored_blobs() {
    // Heights from a fixed sequence (multiples of the golden ratio).
    let mut state = 0.0f64;
    let mut next = || {
        state = (state + 0.618_033_988_749_894_9).fract();
        state
    };
    let mut whole = 0;
    for case in 0..8 {
        let waves: Vec<(usize, f64)> =
            (1..=5).map(|n| (n, (next() - 0.5) * 0.9 / (1.0 + n as f64))).collect();
        let angle = 0.3 * case as f64;
        let domain = blob(&waves, angle);
        let mut stages = Stages::default();
        let mesh = generate(&domain, &Options::default(), &mut stages).unwrap();
        let report = stages.symmetry.unwrap();
        assert_eq!(report.domain, SymmetryCount { rotations: 1, mirrors: 1 }, "case {case}");
        let map = Map::Mirror { center: [3.0, -1.0], angle };
        let found = defect(&mesh, domain.diagonal(), map);
        // The report and the mesh agree.
        assert_eq!(report.mesh.mirrors == 1, found.is_none(), "case {case}: {report:?}, {found:?}");
        assert_eq!(report.mesh.mirrors == 1, report.asymmetry.is_none(), "case {case}");
        whole += usize::from(found.is_none());
    }
    assert!(whole >= 7, "{whole} of 8 meshes are symmetric");
}

#[test]
fn it_can_be_switched_off_and_sizes_switch_it_off() {
    let options = Options { symmetry: false, ..Options::default() };
    let mut stages = Stages::default();
    generate(&plate(), &options, &mut stages).unwrap();
    assert_eq!(stages.symmetry, None);
    let size = SizeFunction::new(|[x, _]| 0.3 + 0.2 * (x + 1.0));
    let options = Options { element_size: Some(size), ..Options::default() };
    generate(&plate(), &options, &mut stages).unwrap();
    assert_eq!(stages.symmetry, None);
}

#[test]
fn without_it_these_meshes_are_not_symmetric() {
    // What is checked above is the work of this step.
    let options = Options { symmetry: false, ..Options::default() };
    let mesh = generate(&gingerbread(), &options, &mut Stages::default()).unwrap();
    let map = mirrors([0.0; 2], &[PI / 2.0])[0];
    assert!(defect(&mesh, gingerbread().diagonal(), map).is_some());
}

#[test]
fn equal_input_gives_equal_bits_and_progress_never_goes_back() {
    let shares = Arc::new(Mutex::new(Vec::new()));
    let seen = Arc::clone(&shares);
    let progress = Progress::new(move |_, share| {
        seen.lock().unwrap().push(share);
        true
    });
    let domain = file("hohq/Pill.control");
    let first =
        generate(&domain, &Options { progress, ..Options::default() }, &mut Stages::default()).unwrap();
    let second = generate(&domain, &Options::default(), &mut Stages::default()).unwrap();
    assert_eq!(first, second);
    let shares = shares.lock().unwrap();
    assert!(shares.windows(2).all(|w| w[0] <= w[1]) && shares.last() == Some(&1.0));
}

#[test]
fn it_can_be_cancelled_at_any_report() {
    let domain = file("hohq/Pill.control");
    let count = Arc::new(Mutex::new(0));
    let run = |limit: usize| {
        let count = Arc::clone(&count);
        *count.lock().unwrap() = 0;
        let progress = Progress::new(move |_, _| {
            let mut count = count.lock().unwrap();
            *count += 1;
            *count <= limit
        });
        generate(&domain, &Options { progress, ..Options::default() }, &mut Stages::default())
    };
    run(usize::MAX).unwrap();
    let all = *count.lock().unwrap();
    for limit in [0, all / 2, 9 * all / 10, all - 1] {
        assert_eq!(run(limit), Err(quadrel::Error::Cancelled), "after {limit} of {all} reports");
    }
}

#[test]
fn icons_that_are_symmetric() {
    // Both come with rounded numbers: their symmetries are those that the numbers keep.
    let mut counts = BTreeMap::new();
    for folder in ["icons/bootstrap", "icons/mdi"] {
        let mut files: Vec<PathBuf> =
            std::fs::read_dir(domains().join(folder)).unwrap().map(|e| e.unwrap().path()).collect();
        files.sort();
        for path in files {
            let Ok(model) = input::read(&path, None) else { continue };
            let mut stages = Stages::default();
            let Ok(mesh) = generate(&model.domain, &Options::default(), &mut stages) else { continue };
            let report = stages.symmetry.unwrap();
            // What the report claims is looked at in the canonical frame.
            let boundary = stages.boundary.as_ref().unwrap();
            let group = Group::of(boundary, &DomainCurve { boundary, domain: &model.domain }).unwrap();
            let own: Vec<Map> = group
                .elements
                .iter()
                .map(|e| {
                    let center = [boundary.frame.origin.x, boundary.frame.origin.y];
                    let tilt = boundary.frame.axis.y.atan2(boundary.frame.axis.x);
                    match e.map.mirror {
                        false => Map::Turn { center, angle: e.map.turn.y.atan2(e.map.turn.x) },
                        true => Map::Mirror { center, angle: e.map.axis() + tilt },
                    }
                })
                .collect();
            let diagonal = model.domain.diagonal();
            let kept = own.iter().filter(|m| defect(&mesh, diagonal, **m).is_none()).count();
            assert_eq!(kept, report.mesh.order(), "{}", path.display());
            *counts.entry((report.domain.order() > 1, report.asymmetry.is_none())).or_insert(0) += 1;
        }
    }
    let symmetric: usize = counts.iter().filter(|(k, _)| k.0).map(|(_, n)| n).sum();
    let whole = counts.get(&(true, true)).copied().unwrap_or(0);
    assert!(symmetric > 0 && 10 * whole >= 8 * symmetric, "{counts:?}");
}

#[test]
fn one_size_divides_symmetric_meshes_alike() {
    for (name, domain) in [("plate", plate()), ("disc", disc()), ("pill", file("hohq/Pill.control"))] {
        let options = Options { max_element_size: Some(0.3), ..Options::default() };
        let mut stages = Stages::default();
        let mesh = generate(&domain, &options, &mut stages).unwrap();
        let report = stages.symmetry.unwrap();
        assert_eq!((report.mesh, report.asymmetry), (report.domain, None), "{name}");
        let [x, y] =
            if name == "disc" { [0.5, -0.25] } else { [0.0, if name == "pill" { 0.25 } else { 0.0 }] };
        for map in mirrors([x, y], &[0.0, PI / 2.0]) {
            assert_eq!(defect(&mesh, domain.diagonal(), map), None, "{name}");
        }
    }
}
