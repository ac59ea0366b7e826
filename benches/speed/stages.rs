//! Time of each stage, and of the whole, on domains of growing size: `cargo bench --bench stages [FILTER]`.
//!
//! Each stage starts from what the one before made; that is made once and not timed. Layout, refinement and
//! smoothing, which share what they do, are timed as the whole less these.

use divan::{black_box, Bencher};
use quadrel::base_mesh::{triangulate, Request};
use quadrel::cross_field::solve;
use quadrel::domain::{Boundary, BoundaryPoint, Domain};
use quadrel::input;
use quadrel::layout::t_mesh::{build, Traced};
use quadrel::options::{FieldMethod, Options, Tolerance};
use quadrel::separatrices::trace;
use quadrel::singularities::{find, resolve};
use quadrel::stages::Stages;

/// Names of the domains; see [`domain`].
const DOMAINS: [&str; 6] = ["gingerbread", "naca0012", "plate-4", "plate-16", "coast-48", "coast-192"];

fn main() {
    divan::main();
}

/// The embedded example, a file of the tests, a plate with so many round holes, a coast of so many points.
fn domain(name: &str) -> (Domain, Options) {
    let relative = Options { tolerance: Tolerance::Relative(1e-5), ..Options::default() };
    let svg = |path: String| {
        let text = format!("<svg xmlns=\"http://www.w3.org/2000/svg\"><path d=\"{path}\"/></svg>");
        input::read_svg_str(&text, None).expect("a domain").domain
    };
    match name {
        "gingerbread" => {
            let model = input::gingerbread_man().expect("the embedded model");
            (model.domain, Options { tolerance: Tolerance::Absolute(1e-2), ..Options::default() })
        }
        "naca0012" => {
            let text = include_str!("../../tests/domains/hohq/NACA0012.control");
            let model = input::read_control_str(text, None).expect("a domain");
            (model.domain, Options { tolerance: Tolerance::Absolute(5.7e-4), ..Options::default() })
        }
        _ => match name.split_once('-') {
            Some(("plate", holes)) => (svg(plate(holes.parse().expect("a number"))), relative),
            Some((_, points)) => (svg(coast(points.parse().expect("a number"))), relative),
            None => panic!("no domain is called {name}"),
        },
    }
}

/// Numbers in [-1, 1), the same on every run.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        // Knuth's MMIX generator; its upper half is random enough for shapes.
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as f64 / (1u64 << 30) as f64 - 1.0
    }
}

fn plate(holes: usize) -> String {
    let side = holes.isqrt();
    let mut noise = noise(1);
    let mut path = format!("M0 0H{side}V{side}H0Z");
    for k in 0..side * side {
        let [x, y] = [k / side, k % side].map(|k| k as f64 + 0.5 + 0.07 * noise());
        let r = 0.23 + 0.05 * noise();
        path += &format!("M{} {y}a{r} {r} 0 1 0 {} 0a{r} {r} 0 1 0 {} 0Z", x - r, 2.0 * r, -2.0 * r);
    }
    path
}

/// A circle with bays: the radius is random from point to point.
fn coast(points: usize) -> String {
    let mut noise = noise(2);
    let corner = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / points as f64;
        let r = 100.0 * (1.0 + 3.0 / points as f64 * noise());
        format!("{} {}", r * angle.cos(), r * angle.sin())
    };
    format!("M{}Z", (0..points).map(corner).collect::<Vec<_>>().join("L"))
}

fn boundary(name: &str) -> Boundary {
    Boundary::new(&domain(name).0).expect("tables")
}

#[divan::bench(args = DOMAINS)]
fn tables(bencher: Bencher, name: &str) {
    let (domain, _) = domain(name);
    bencher.bench_local(|| Boundary::new(black_box(&domain)));
}

#[divan::bench(args = DOMAINS)]
fn base_mesh(bencher: Bencher, name: &str) {
    let boundary = boundary(name);
    bencher.bench_local(|| triangulate(black_box(&boundary), &Request::default()));
}

#[divan::bench(args = DOMAINS)]
fn cross_field(bencher: Bencher, name: &str) {
    let boundary = boundary(name);
    let mesh = triangulate(&boundary, &Request::default()).expect("a base mesh");
    bencher.bench_local(|| solve(black_box(&mesh), &boundary, FieldMethod::Diffused));
}

#[divan::bench(args = DOMAINS)]
fn singularities(bencher: Bencher, name: &str) {
    let boundary = boundary(name);
    let all = resolve(&boundary, Request::default(), FieldMethod::Diffused).expect("a field");
    bencher.bench_local(|| find(black_box(&all.mesh), &boundary, &all.field));
}

#[divan::bench(args = DOMAINS)]
fn separatrices(bencher: Bencher, name: &str) {
    let boundary = boundary(name);
    let all = resolve(&boundary, Request::default(), FieldMethod::Diffused).expect("a field");
    bencher.bench_local(|| {
        let mut seeds: Vec<BoundaryPoint> = Vec::new();
        loop {
            let traces = trace(&all.mesh, &all.field, &boundary, &all.singularities, &all.corners, &seeds)?;
            match build(&boundary, &all.singularities, &all.corners, &traces)? {
                Traced::Layout(layout) => return Ok::<_, quadrel::Error>(layout),
                Traced::Seeds(more) => seeds.extend(more),
            }
        }
    });
}

#[divan::bench(args = DOMAINS, sample_count = 5, sample_size = 1)]
fn whole(bencher: Bencher, name: &str) {
    let (domain, options) = domain(name);
    bencher.bench_local(|| quadrel::generate(black_box(&domain), &options, &mut Stages::default()));
}
