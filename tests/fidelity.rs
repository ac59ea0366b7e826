//! Boundary edges against the exact curves, by a quadrature of the test's own with ten times the points: within
//! the tolerance in every norm, at every order; where that cannot be, an error that says where.
//!
//! `QUADREL_FIDELITY=all cargo test --release --test fidelity -- --nocapture` runs every order, tolerance and norm
//! on all of `DOMAINS`, or on the files that the variable names (a list separated by colons).

use quadrel::domain::{CurveSegment, Domain};
use quadrel::mesh::{BoundaryTolerance, HighOrderMesh, MeshEdge};
use quadrel::numerics::{GaussLegendre, Interpolation, Point, Vector, NONE};
use quadrel::options::{Norm, Tolerance};
use quadrel::progress::Progress;
use quadrel::stages::Stages;
use quadrel::{generate, input, Error, Options};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

const ORDERS: [usize; 4] = [2, 4, 8, 12];
const TOLERANCES: [f64; 8] = [1e-5, 1e-9, 1e-2, 1e-7, 1e-3, 1e-6, 1e-4, 1e-8];
const NORMS: [Norm; 3] = [Norm::L2, Norm::Max, Norm::H1];

/// Of the shapes that are named for it, those that are among the test domains.
const DOMAINS: [&str; 9] = [
    "mech/unit-circle.control",
    "hohq/BlobAdapt.control",
    "hohq/NACA0012.control",
    "mech/turek-hron-fsi.control",
    "mech/journal-bearing-1e-3.control",
    "glyphs/Lobster/u00d8.svg",
    "coast/island-8N79W-65-smooth.control",
    "hohq/GingerbreadMan.control",
    "hohq/LakeSuperior.control",
];

/// What `cargo test` runs: file, order, relative tolerance, norm.
const SOME: [(&str, usize, f64, Norm); 17] = [
    ("mech/unit-circle.control", 2, 1e-7, Norm::L2),
    ("mech/unit-circle.control", 4, 1e-9, Norm::H1),
    ("mech/unit-circle.control", 12, 1e-9, Norm::Max),
    ("hohq/BlobAdapt.control", 2, 1e-4, Norm::H1),
    ("hohq/BlobAdapt.control", 2, 1e-7, Norm::L2),
    ("hohq/BlobAdapt.control", 8, 1e-7, Norm::Max),
    ("hohq/BlobAdapt.control", 12, 1e-2, Norm::L2),
    ("hohq/NACA0012.control", 2, 1e-5, Norm::Max),
    ("hohq/NACA0012.control", 4, 1e-6, Norm::H1),
    ("hohq/NACA0012.control", 8, 1e-9, Norm::L2),
    ("mech/turek-hron-fsi.control", 4, 1e-8, Norm::Max),
    ("mech/turek-hron-fsi.control", 8, 1e-3, Norm::H1),
    ("mech/journal-bearing-1e-3.control", 4, 1e-5, Norm::L2),
    ("glyphs/Lobster/u00d8.svg", 4, 1e-5, Norm::H1),
    ("coast/island-8N79W-65-smooth.control", 8, 1e-6, Norm::Max),
    ("hohq/GingerbreadMan.control", 4, 1e-4, Norm::H1),
    ("hohq/GingerbreadMan.control", 8, 1e-2, Norm::Max),
];

/// Points on an edge: ten times what the library uses at least.
const POINTS: usize = 240;
/// What two quadratures may differ by: of a smooth curve's error they agree in all digits, of a kink's in two.
const ROUNDING: f64 = 1.01;

/// A stretch of one exact curve, from t to t in the loop's direction.
struct Stretch<'a> {
    curve: &'a CurveSegment,
    from: f64,
    to: f64,
}

/// The exact curve under a boundary edge, cut where it is less smooth.
fn exact_curve<'a>(domain: &'a Domain, edge: &MeshEdge) -> Vec<Stretch<'a>> {
    let own = domain.loops().iter().find(|l| l.index() == edge.loop_index as usize).expect("a loop");
    let segments = own.segments();
    // Segments with corners inside have become several of one number.
    let place = |number: u32, caller: f64, end: bool| {
        let inside = |s: &CurveSegment| {
            let [a, b] = [s.caller_parameter(0.0), s.caller_parameter(1.0)];
            (caller - a) / (b - a)
        };
        let parts = segments.iter().enumerate().filter(|(_, s)| s.index() == number as usize);
        // At the end of one part and the start of the next: an edge starts at 0 and ends at 1.
        let off = |t: f64| (-t).max(t - 1.0).max(if end { 1e-9 - t } else { t - 1.0 + 1e-9 }).max(0.0);
        let best = parts.map(|(k, s)| (k, inside(s))).min_by(|a, b| off(a.1).total_cmp(&off(b.1)));
        let (k, t) = best.expect("a segment");
        (k, t.clamp(0.0, 1.0))
    };
    let (first, from) = place(edge.segments[0], edge.parameters[0], false);
    let (last, to) = place(edge.segments[1], edge.parameters[1], true);
    let mut stretches = Vec::new();
    let (mut k, mut t) = (first, from);
    loop {
        let curve = &segments[k];
        let ends_here = k == last && to > t;
        let end = if ends_here { to } else { 1.0 };
        let mut cuts: Vec<f64> = curve.pieces().into_iter().filter(|x| *x > t && *x < end).collect();
        cuts.push(end);
        for cut in cuts {
            stretches.push(Stretch { curve, from: t, to: cut });
            t = cut;
        }
        if ends_here || stretches.len() > 100_000 {
            return stretches;
        }
        (k, t) = ((k + 1) % segments.len(), 0.0);
    }
}

/// Exact points of an edge: arc length from its start, weight ds, point, unit tangent; and the whole length.
fn sampled(domain: &Domain, edge: &MeshEdge) -> (Vec<(f64, f64, Point, Vector)>, f64) {
    let stretches = exact_curve(domain, edge);
    let rule = GaussLegendre::new(12);
    let panels = (POINTS / 12).div_ceil(stretches.len()).max(4);
    let mut points = Vec::new();
    let mut s = 0.0;
    for stretch in &stretches {
        let speed = |t: f64| stretch.curve.derivative(t).unwrap().norm();
        for k in 0..panels {
            // Panels shrink towards the ends, where parametrisations are often singular.
            let share = |k: usize| 0.5 - 0.5 * (std::f64::consts::PI * k as f64 / panels as f64).cos();
            let at = |k: usize| stretch.from + (stretch.to - stretch.from) * share(k);
            let (a, b) = (at(k), at(k + 1));
            for (x, w) in rule.nodes.iter().zip(&rule.weights) {
                let t = a + 0.5 * (1.0 + x) * (b - a);
                let d = stretch.curve.derivative(t).unwrap();
                let run = s + rule.integrate(a, t, speed);
                let ds = 0.5 * w * (b - a) * d.norm();
                points.push((run, ds, stretch.curve.point(t).unwrap(), d.normalize()));
            }
            s += rule.integrate(a, b, speed);
        }
    }
    (points, s)
}

/// The boundary edges and their nodes.
fn boundary_edges(mesh: &HighOrderMesh) -> impl Iterator<Item = (&MeshEdge, Vec<Point>)> {
    mesh.edges.iter().enumerate().filter(|(_, edge)| edge.loop_index != NONE).map(|(e, edge)| {
        let element = edge.elements[0] as usize;
        let side = mesh.element_edges[element].iter().position(|x| *x as usize == e).unwrap();
        (edge, (0..=mesh.order).map(|k| mesh.side_node(element, side, k)).collect())
    })
}

/// The largest error of a boundary edge in `norm`, and where.
fn worst(domain: &Domain, mesh: &HighOrderMesh, norm: Norm) -> (f64, Point) {
    let curve = Interpolation::new(mesh.reference_nodes.clone());
    let mut worst = (0.0, Point::origin());
    for (edge, nodes) in boundary_edges(mesh) {
        let (points, length) = sampled(domain, edge);
        let at: Vec<f64> = points.iter().map(|p| 2.0 * p.0 / length - 1.0).collect();
        let (values, slopes) = (curve.matrix(&at), curve.derivative_matrix(&at));
        let (mut sum, mut most) = (0.0, 0.0f64);
        for (i, (_, ds, point, tangent)) in points.iter().enumerate() {
            let (mut x, mut d) = (Vector::zeros(), Vector::zeros());
            for (k, node) in nodes.iter().enumerate() {
                x += node.coords * values[(i, k)];
                d += node.coords * (slopes[(i, k)] * 2.0 / length);
            }
            let error = point.coords - x;
            most = most.max(error.norm());
            sum += ds * error.norm_squared();
            if norm == Norm::H1 {
                sum += ds * length * length * (tangent - d).norm_squared();
            }
        }
        let error = if norm == Norm::Max { most } else { sum.sqrt() };
        if error.is_nan() || error > worst.0 {
            worst = (error, points[points.len() / 2].2);
        }
    }
    worst
}

fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/domains").join(name)
}

/// The mesh and the error that it is allowed, or the typed error.
fn meshed(domain: &Domain, options: &Options) -> Result<(HighOrderMesh, f64), Error> {
    let mut stages = Stages::default();
    let mesh = generate(domain, options, &mut stages)?;
    let boundary = stages.boundary.expect("a boundary");
    let allowed = BoundaryTolerance::new(options, &boundary).in_caller_frame(&boundary.frame).value;
    Ok((mesh, allowed))
}

/// Error divided by the tolerance and the number of elements, or the typed error.
fn run(
    domain: &Domain,
    order: usize,
    relative: f64,
    norm: Norm,
    limit: Duration,
) -> Result<(f64, usize), Error> {
    let end = Instant::now() + limit;
    let progress = Progress::new(move |_, _| Instant::now() < end);
    let tolerance = Tolerance::Relative(relative);
    let (mesh, allowed) =
        meshed(domain, &Options { order, norm, tolerance, progress, ..Options::default() })?;
    Ok((worst(domain, &mesh, norm).0 / allowed, mesh.elements.len()))
}

/// Whether an error is one that a tolerance out of reach may end with: it has its place.
fn located(error: &Error) -> bool {
    matches!(error, Error::Tolerance { .. })
}

#[test]
fn edges_keep_the_tolerance_in_every_norm() {
    let mut failures = Vec::new();
    for (name, order, relative, norm) in SOME {
        let domain = input::read(&file(name), None).unwrap().domain;
        match run(&domain, order, relative, norm, Duration::from_secs(60)) {
            Ok((ratio, _)) if ratio <= ROUNDING => {}
            Ok((ratio, _)) => {
                failures.push(format!("{name} {order} {relative:e} {norm:?}: {ratio} times the tolerance"))
            }
            Err(error) => failures.push(format!("{name} {order} {relative:e} {norm:?}: {error}")),
        }
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

/// The largest L2 error of a boundary edge as a user measures it: Gauss points along the whole edge, which know nothing
/// of knots, and distances to the curve.
fn worst_by_a_plain_rule(domain: &Domain, mesh: &HighOrderMesh) -> f64 {
    let curve = Interpolation::new(mesh.reference_nodes.clone());
    let rule = GaussLegendre::new(mesh.order + 6);
    let (values, slopes) = (curve.matrix(&rule.nodes), curve.derivative_matrix(&rule.nodes));
    let mut worst = 0.0f64;
    for (edge, nodes) in boundary_edges(mesh) {
        let (points, _) = sampled(domain, edge);
        let mut sum = 0.0;
        for (i, weight) in rule.weights.iter().enumerate() {
            let at = |matrix: &nalgebra::DMatrix<f64>| -> Vector {
                nodes.iter().enumerate().map(|(k, node)| node.coords * matrix[(i, k)]).sum()
            };
            let x = Point::from(at(&values));
            let far = |p: &Point| (x - p).norm_squared();
            let (_, _, foot, tangent) = points.iter().min_by(|a, b| far(&a.2).total_cmp(&far(&b.2))).unwrap();
            let off = (x - foot).x * tangent.y - (x - foot).y * tangent.x;
            sum += weight * at(&slopes).norm() * off * off;
        }
        worst = worst.max(sum.sqrt());
    }
    worst
}

/// Edges of high order span several knots, where such a rule is up to 15 % off: the stages aim at less.
#[test]
fn edges_of_high_order_keep_the_tolerance_by_a_plain_rule_too() {
    let domain = input::read(&file("hohq/LakeSuperior.control"), None).unwrap().domain;
    let options = Options { order: 12, tolerance: Tolerance::Relative(1e-5), ..Options::default() };
    let (mesh, allowed) = meshed(&domain, &options).unwrap();
    let ratio = worst_by_a_plain_rule(&domain, &mesh) / allowed;
    assert!(ratio <= 1.0 && ratio > 0.5, "{ratio} times the tolerance");
}

#[test]
fn a_tolerance_below_rounding_is_an_error_with_its_place() {
    let domain = input::read(&file("mech/unit-circle.control"), None).unwrap().domain;
    for norm in NORMS {
        let error = run(&domain, 4, 1e-18, norm, Duration::from_secs(60)).unwrap_err();
        assert!(located(&error) && error.place().is_some(), "{norm:?}: {error}");
    }
}

/// By hand, see the top: prints a line for each case, and sums up. All domains and orders are tried at one tolerance
/// before the next.
#[test]
fn all_orders_tolerances_and_norms() {
    let Ok(which) = std::env::var("QUADREL_FIDELITY") else { return };
    let files: Vec<PathBuf> = match which.as_str() {
        "all" => DOMAINS.iter().map(|name| file(name)).collect(),
        list => list.split(':').map(PathBuf::from).collect(),
    };
    let domains: Vec<_> = files.iter().map(|f| input::read(f, None).unwrap()).collect();
    let mut cases = Vec::new();
    for relative in TOLERANCES {
        for order in ORDERS {
            for norm in NORMS {
                cases.extend(domains.iter().map(|model| (model, order, norm, relative)));
            }
        }
    }
    let [next, kept, refused] = [(); 3].map(|()| AtomicUsize::new(0));
    let work = || {
        while let Some((model, order, norm, relative)) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
            let started = Instant::now();
            let result = run(&model.domain, *order, *relative, *norm, Duration::from_secs(120));
            let seconds = started.elapsed().as_secs_f64();
            let case = format!("{} N={order} {norm:?} {relative:e} ({seconds:.1} s)", model.name);
            match result {
                Ok((ratio, elements)) if ratio <= ROUNDING => {
                    kept.fetch_add(1, Ordering::Relaxed);
                    println!("ok      {case}: {ratio:.4} with {elements} elements");
                }
                Ok((ratio, elements)) => println!("BROKEN  {case}: {ratio:.4} with {elements} elements"),
                Err(error) if located(&error) => {
                    refused.fetch_add(1, Ordering::Relaxed);
                    println!("refused {case}: {error}");
                }
                Err(error) => println!("FAILED  {case}: {error}"),
            }
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        scope.spawn(work);
    });
    let [kept, refused] = [kept, refused].map(AtomicUsize::into_inner);
    println!("{} cases: {kept} keep the tolerance, {refused} are refused with a place", cases.len());
    assert_eq!(cases.len(), kept + refused);
}
