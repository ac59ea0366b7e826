//! What the efforts promise: with any of them the mesh is valid, keeps the tolerance and the floor; more effort never
//! takes more elements.

use quadrel::mesh::scaled_jacobian_ceiling;
use quadrel::options::Effort;
use quadrel::progress::Progress;
use quadrel::stages::Stages;
use quadrel::{generate, input, Error, Options};
use std::path::Path;
use std::sync::{Arc, Mutex};

const DOMAINS: [&str; 4] = [
    "hohq/NACA0012.control",
    "hohq/BlobAdapt.control",
    "hohq/EllipseAndFourCircles.control",
    "glyphs/Lobster/u00d8.svg",
];

fn domain(file: &str) -> quadrel::domain::Domain {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/domains").join(file);
    input::read(&path, None).unwrap_or_else(|e| panic!("{file}: {e}")).domain
}

#[test]
fn more_effort_takes_no_more_elements() {
    let mut totals = [0; 3];
    for file in DOMAINS {
        let domain = domain(file);
        let mut least = usize::MAX;
        for (effort, total) in [Effort::Fast, Effort::Default, Effort::Best].into_iter().zip(&mut totals) {
            let options = Options { effort, ..Options::default() };
            let mut stages = Stages::default();
            let mesh = generate(&domain, &options, &mut stages).unwrap_or_else(|e| panic!("{file}: {e}"));
            mesh.check().unwrap_or_else(|e| panic!("{file}: {e:?}"));
            let boundary = stages.boundary.as_ref().expect("a boundary");
            let floor = options.quality_floor * scaled_jacobian_ceiling(boundary);
            let last = stages.rounds.last().expect("rounds");
            let quality = last.scaled_jacobian;
            assert!(quality >= 0.95 * floor, "{file}, {effort:?}: {quality} where {floor} is asked for");
            assert!(last.boundary_error <= 1.0, "{file}, {effort:?}: {}", last.boundary_error);
            if effort == Effort::Best {
                assert!(mesh.elements.len() <= least, "{file}: {} of {least}", mesh.elements.len());
            }
            least = mesh.elements.len();
            *total += mesh.elements.len();
        }
    }
    let [fast, usual, best] = totals;
    assert!(best <= usual && usual <= fast, "{totals:?}");
    assert!(fast as f64 <= 1.3 * usual as f64, "{totals:?}");
}

/// Progress rises through all starts to the end, and stopping in any of them stops the run.
#[test]
fn progress_runs_once_through_all_starts() {
    let domain = domain("hohq/ABAQUS_IceCreamCone.control");
    let shares = Arc::new(Mutex::new(Vec::new()));
    let seen = Arc::clone(&shares);
    let progress = Progress::new(move |_, share| {
        seen.lock().unwrap().push(share);
        true
    });
    let options = Options { effort: Effort::Best, progress, ..Options::default() };
    let first = generate(&domain, &options, &mut Stages::default()).unwrap();
    let shares = shares.lock().unwrap().clone();
    assert!(shares.windows(2).all(|w| w[0] <= w[1]), "{shares:?}");
    assert_eq!(shares.last(), Some(&1.0));
    let progress = Progress::new(|_, share| share < 0.6);
    let stopped = generate(&domain, &Options { progress, ..options.clone() }, &mut Stages::default());
    assert_eq!(stopped.map(|m| m.elements.len()), Err(Error::Cancelled));
    let again =
        generate(&domain, &Options { progress: Progress::default(), ..options }, &mut Stages::default());
    assert_eq!(again.unwrap(), first);
}
