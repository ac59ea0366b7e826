//! The C interface seen from Rust: every error has its status; the rest is tested from C and C++ in
//! `cpp_tests/`.

use quadrel::domain::Domain;
use quadrel::error::{Error, NestingError};
use quadrel::ffi::*;
use quadrel::numerics::Point;
use quadrel::stages::Stages;
use quadrel::{generate, Options};
use std::collections::BTreeSet;
use std::ffi::CStr;

fn name(status: quadrel_status) -> &'static str {
    // SAFETY: the names live for ever and end with a zero byte.
    unsafe { CStr::from_ptr(quadrel_status_name(status)) }.to_str().unwrap()
}

/// One error of every kind.
fn every_error() -> Vec<Error> {
    let at = Point::origin();
    let (reason, place) = (String::new(), None);
    vec![
        Error::InvalidArgument { what: "", value: String::new(), allowed: "" },
        Error::Callback { loop_index: 0, segment: 0, t: 0.0, reason: reason.clone() },
        Error::Cancelled,
        Error::OpenLoop { loop_index: 0, segment: 0, gap: 0.0, at },
        Error::Intersection { loops: [0; 2], segments: [0; 2], at },
        Error::Nesting { reason: NestingError::NoOuterLoop, at: place },
        Error::Cusp { loop_index: 0, segment: 0, angle: 0.0, at },
        Error::Degenerate { loop_index: 0, segment: 0, reason: "", at },
        Error::BaseMesh { reason: reason.clone(), at: place },
        Error::CrossField { reason: reason.clone(), at: place },
        Error::Separatrix { reason: reason.clone(), at: place },
        Error::Layout { reason: reason.clone(), at: place },
        Error::Tolerance { error: 0.0, tolerance: 0.0, at },
        Error::InvalidElement { jacobian: 0.0, at },
        Error::Io { path: String::new(), reason: reason.clone() },
        Error::Unsupported { what: reason.clone() },
        Error::Parse { what: reason.clone(), line: 1, column: 1 },
        Error::Internal { reason },
    ]
}

#[test]
fn every_error_has_a_status_of_its_own_by_its_name() {
    let mut seen = BTreeSet::from([QUADREL_OK, QUADREL_ERROR_NULL]);
    for error in every_error() {
        let status = status_of(&error);
        assert!(seen.insert(status), "{error:?} has the status of another");
        assert_eq!(name(status), format!("QUADREL_ERROR_{}", error.name().to_uppercase()));
    }
    assert_eq!(seen.len(), 20);
    assert_eq!(name(QUADREL_OK), "QUADREL_OK");
    for unknown in [-1, 5, 100, i32::MIN, i32::MAX] {
        assert_eq!(name(unknown), "unknown status");
    }
}

#[test]
fn the_version_is_the_crate_s() {
    let version = format!("{QUADREL_VERSION_MAJOR}.{QUADREL_VERSION_MINOR}.{QUADREL_VERSION_PATCH}");
    assert_eq!(version, env!("CARGO_PKG_VERSION"));
    // SAFETY: the text lives for ever and ends with a zero byte.
    let text = unsafe { CStr::from_ptr(quadrel_version_string()) };
    assert_eq!(text.to_str().unwrap(), version);
}

/// The arrays of the C interface against the mesh that Rust makes of the same domain.
#[test]
fn arrays_agree_with_the_mesh() {
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
    let domain = Domain::polygon(&corners, &[]).unwrap();
    let mesh = generate(&domain, &Options::default(), &mut Stages::default()).unwrap();
    // SAFETY: objects are made, used and freed once; arrays are read while the mesh lives.
    unsafe {
        let built = quadrel_domain_new();
        let none = std::ptr::null();
        assert_eq!(quadrel_domain_begin_loop(built, QUADREL_LOOP_OUTER, none), QUADREL_OK);
        for k in 0..4 {
            let (from, to) = (corners[k].as_ptr(), corners[(k + 1) % 4].as_ptr());
            assert_eq!(quadrel_domain_add_line(built, from, to, none), QUADREL_OK);
        }
        assert_eq!(quadrel_domain_end_loop(built), QUADREL_OK);
        let mut made = std::ptr::null_mut();
        let no_stages = std::ptr::null_mut();
        assert_eq!(quadrel_generate(built, std::ptr::null(), no_stages, &mut made), QUADREL_OK);
        quadrel_domain_free(built);
        assert_eq!(quadrel_mesh_element_count(made), mesh.elements.len());
        assert_eq!(quadrel_mesh_node_count(made), mesh.node_count());
        let numbers = quadrel_mesh_element_nodes(made);
        let nodes = quadrel_mesh_nodes(made);
        for (k, node) in mesh.nodes.iter().enumerate() {
            let number = *numbers.add(k) as usize;
            assert_eq!([*nodes.add(2 * number), *nodes.add(2 * number + 1)], [node.x, node.y]);
        }
        quadrel_mesh_free(made);
    }
}
