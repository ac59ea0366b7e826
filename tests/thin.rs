//! Step 7, on meshes of thousands of quads: strips that are much finer than wanted end inside the domain.

mod fixtures;

use fixtures::*;
use quadrel::domain::Place;
use quadrel::mesh::{Edge, QuadMesh};
use quadrel::numerics::Point;
use quadrel::refine::thin;
use quadrel::smooth::{Care, Optimiser};

/// 41 columns and 20 rows in a unit square, and sizes that grow from a column's width at the bottom and top.
fn strips() -> (quadrel::domain::Boundary, QuadMesh, impl Fn(Point) -> f64) {
    let (b, m) = rectangle(1.0, 1.0, &even(41), &even(20));
    let [low, high] =
        [f64::min, f64::max].map(|pick| m.vertices.iter().map(|v| v.point.y).reduce(pick).unwrap());
    let size = move |p: Point| 0.03 + 0.5 * f64::min(p.y - low, high - p.y);
    (b, m, size)
}

/// Number of edges on the bottom and on the top side.
fn horizontal_edges(mesh: &QuadMesh) -> [usize; 2] {
    let heights = || mesh.vertices.iter().map(|v| v.point.y);
    let ends = [heights().reduce(f64::min).unwrap(), heights().reduce(f64::max).unwrap()];
    ends.map(|y| {
        let lies_on = |v: &u32| (mesh.vertices[*v as usize].point.y - y).abs() < 1e-9;
        let along = |e: &&Edge| e.span.is_some() && e.vertices.iter().all(lies_on);
        mesh.edges.iter().filter(along).count()
    })
}

#[test]
fn fine_columns_end_before_they_cross_the_domain() {
    let (b, m, size) = strips();
    let thinner = thin(m.clone(), &b, &size);
    assert!(
        10 * thinner.quads.len() < 7 * m.quads.len(),
        "{} of {} quads",
        thinner.quads.len(),
        m.quads.len()
    );
    assert_eq!(horizontal_edges(&thinner), [41, 41], "an edge as wide as wanted was lost");
    let mut valence = vec![0; thinner.vertices.len()];
    thinner.quads.iter().flatten().for_each(|v| valence[*v as usize] += 1);
    let inside = thinner.vertices.iter().zip(&valence).filter(|(v, _)| v.place == Place::Interior);
    let count = |n| inside.clone().filter(|(_, valence)| **valence == n).count();
    assert_eq!(count(3), count(5), "each end has a three- and a five-valent vertex");
    assert!(count(3) > 0 && count(3) + count(4) + count(5) == inside.clone().count());
    // The connectivity is that of a mesh which can be made valid.
    let optimiser = Optimiser::new(&b, 3, None);
    let mut smooth = thinner;
    optimiser.optimise(&mut smooth, None, Care::Full);
    assert!(optimiser.quality(&smooth).valid());
}

#[test]
fn columns_as_wide_as_wanted_stay() {
    let (b, m, _) = strips();
    assert_eq!(thin(m.clone(), &b, &|_| 0.03).quads, m.quads);
}

/// Chords from a fine side that crowd on a coarse one: there, too, boundary vertices become one.
#[test]
fn columns_end_on_a_boundary_that_wants_fewer() {
    let (b, m, _) = strips();
    let low = m.vertices.iter().map(|v| v.point.y).reduce(f64::min).unwrap();
    let thinner = thin(m.clone(), &b, &|p| 0.03 + 0.5 * (p.y - low));
    let [fine, coarse] = horizontal_edges(&thinner);
    assert_eq!(fine, 41, "the fine side keeps its edges");
    assert!((4..=15).contains(&coarse), "{coarse} edges on the coarse side");
    let corners =
        |mesh: &QuadMesh| mesh.vertices.iter().filter(|v| matches!(v.place, Place::Junction(_))).count();
    assert_eq!(corners(&thinner), corners(&m));
    let optimiser = Optimiser::new(&b, 3, None);
    let mut smooth = thinner;
    optimiser.optimise(&mut smooth, None, Care::Full);
    assert!(optimiser.quality(&smooth).valid());
}
