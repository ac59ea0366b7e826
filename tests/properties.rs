//! Random domains: every one becomes a mesh whose own checks hold. Each case is a control file made from its seed, so
//! that a failing one can be kept: it is written to the target folder, and its seed printed.
//!
//! `QUADREL_PROPERTIES=10000 cargo test --release --test properties -- --nocapture` for a long run;
//! `QUADREL_PROPERTIES=17,290` for single seeds.

mod random_domains;

use quadrel::mesh::BoundaryTolerance;
use quadrel::numerics::NONE;
use quadrel::options::Tolerance;
use quadrel::stages::Stages;
use quadrel::{generate, input, Error, Options};
use random_domains::{case, Case};
use std::collections::BTreeMap;
use std::panic::{catch_unwind, AssertUnwindSafe};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::Mutex;
use std::time::Instant;

/// Cases of the usual run.
const USUAL: u64 = 300;

/// Seeds of the usual run that are known to fail, with the name of their error. They are run, printed and counted
/// like all others.
const KNOWN_FAILURES: [(u64, &str); 0] = [];

/// What is wrong with a case: the error's name, or the promise that is not kept, and details.
struct Failure {
    kind: String,
    details: String,
}

fn failure(kind: &str, details: impl ToString) -> Result<usize, Failure> {
    Err(Failure { kind: kind.into(), details: details.to_string() })
}

/// Meshes a case and checks everything that is promised; the number of elements.
fn run(case: &Case) -> Result<usize, Failure> {
    let domain = match input::read_control_str(&case.text, None) {
        Ok(model) => model.domain,
        Err(error) => return failure(&format!("reading: {}", error.name()), error),
    };
    let tolerance = Tolerance::Relative(case.relative);
    let options = Options { order: case.order, tolerance, ..Options::default() };
    let mut stages = Stages::default();
    let mesh = match generate(&domain, &options, &mut stages) {
        Ok(mesh) => mesh,
        Err(error @ Error::Internal { .. }) => return failure("internal", error),
        Err(error) => {
            let reached = stages.reached.map_or("nothing", |stage| stage.name());
            return failure(error.name(), format!("after {reached}: {error}"));
        }
    };
    let Some(boundary) = &stages.boundary else { return failure("no boundary", "") };
    if let Err((reason, at)) = mesh.check() {
        return failure("check", format!("{reason} at {at}"));
    }
    let allowed = BoundaryTolerance::new(&options, boundary).in_caller_frame(&boundary.frame).value;
    let border = || mesh.edges.iter().filter(|e| e.loop_index != NONE);
    // Not so for NaN.
    if !border().all(|e| e.error <= allowed) {
        return failure("tolerance not kept", "");
    }
    let euler = mesh.vertices.len() as i64 - mesh.edges.len() as i64 + mesh.elements.len() as i64;
    if euler != 2 - domain.loops().len() as i64 {
        return failure("Euler number", euler);
    }
    let near = 1e-9 * domain.diagonal();
    for junction in &boundary.junctions {
        let corner = boundary.frame.to_caller(junction.point);
        if !border().any(|e| (mesh.vertices[e.vertices[0] as usize] - corner).norm() <= near) {
            return failure("corner missed", corner);
        }
    }
    Ok(mesh.elements.len())
}

/// The seeds to run.
fn seeds() -> Vec<u64> {
    match std::env::var("QUADREL_PROPERTIES") {
        Ok(list) if list.contains(',') => {
            list.split(',').filter(|s| !s.is_empty()).map(|s| s.trim().parse().expect("a seed")).collect()
        }
        Ok(count) => (0..count.parse().expect("a number of cases")).collect(),
        Err(_) => (0..USUAL).collect(),
    }
}

#[test]
fn random_domains_become_meshes_that_keep_every_promise() {
    let seeds = seeds();
    let next = AtomicU64::new(0);
    let failures = Mutex::new(Vec::new());
    let kinds = Mutex::new(BTreeMap::<&str, [usize; 2]>::new());
    let started = Instant::now();
    let work = || {
        while let Some(&seed) = seeds.get(next.fetch_add(1, Ordering::Relaxed) as usize) {
            let case = case(seed);
            let began = Instant::now();
            let result =
                catch_unwind(AssertUnwindSafe(|| run(&case))).unwrap_or_else(|_| failure("panic", ""));
            let seconds = began.elapsed().as_secs_f64();
            let mut kinds = kinds.lock().unwrap();
            let counts = kinds.entry(case.kind).or_default();
            counts[0] += 1;
            if let Err(failure) = result {
                counts[1] += 1;
                let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("property-{seed}.control"));
                std::fs::write(&file, &case.text).unwrap();
                let Failure { kind, details } = failure;
                println!(
                    "seed {seed}, {}, order {}, relative {:.1e}, {seconds:.1} s: {kind}: {details} ({})",
                    case.kind,
                    case.order,
                    case.relative,
                    file.display()
                );
                failures.lock().unwrap().push((seed, kind));
            }
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        scope.spawn(work);
    });
    let (mut failures, kinds) = (failures.into_inner().unwrap(), kinds.into_inner().unwrap());
    failures.sort();
    for (kind, [cases, failed]) in &kinds {
        println!("{kind}: {cases} cases, {failed} failed");
    }
    println!("{} cases, {} failed, {:.0} s", seeds.len(), failures.len(), started.elapsed().as_secs_f64());
    let known = |f: &(u64, String)| KNOWN_FAILURES.iter().any(|(seed, kind)| *seed == f.0 && *kind == f.1);
    println!("{} of them known: {KNOWN_FAILURES:?}", failures.iter().filter(|f| known(f)).count());
    failures.retain(|f| !known(f));
    assert!(failures.is_empty(), "{failures:?}");
}

#[test]
fn a_seed_is_always_the_same_domain() {
    for seed in 0..20 {
        let (a, b) = (case(seed), case(seed));
        assert_eq!(a.text, b.text);
        assert_ne!(a.text, case(seed + 1).text);
    }
}
