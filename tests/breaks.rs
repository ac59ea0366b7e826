//! Boundary vertices lie at the joints and knots of the boundary where that is near.

use quadrel::input;
use quadrel::options::Tolerance;
use quadrel::{generate, stages::Stages, Options};
use std::path::Path;

/// Joints of segments of the letter 8 that are vertices of its mesh, and how many there are.
fn joints_met(options: &Options) -> (usize, usize) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/domains/glyphs/DejaVuSans/u0038.svg");
    let domain = input::read(&path, None).expect("the letter").domain;
    let mesh = generate(&domain, options, &mut Stages::default()).expect("a mesh");
    let joints: Vec<_> =
        domain.loops().iter().flat_map(|l| l.segments()).map(|s| s.start().expect("a point")).collect();
    // The letter is 1500 units high.
    let met = joints.iter().filter(|j| mesh.nodes.iter().any(|n| (n - **j).norm() < 1e-6)).count();
    (met, joints.len())
}

#[test]
fn joints_of_a_letter_become_vertices() {
    // There are fewer vertices than joints; without moves two of them meet, at the letter's corners.
    let options = Options { order: 10, tolerance: Tolerance::Relative(1e-6), ..Options::default() };
    let (met, all) = joints_met(&options);
    assert!(met >= 10, "{met} of {all} joints");
}

#[test]
fn also_where_elements_were_divided() {
    let options = Options { order: 10, max_element_size: Some(230.0), ..Options::default() };
    let (met, all) = joints_met(&options);
    assert!(2 * met > all, "{met} of {all} joints");
}
