//! Mirrors and rotations of domains are found, and no others; sectors between mirror axes are parts of the domain.

mod symmetric_domains;

use quadrel::domain::{Boundary, Domain, LoopKind, Sample};
use quadrel::mesh::DomainCurve;
use quadrel::numerics::cross;
use quadrel::symmetry::{Cut, Group, Sector};
use std::f64::consts::{PI, TAU};
use symmetric_domains::{builder, circle, disc, file, gingerbread, plate, wheel};

/// Rotations and mirrors found of a domain.
fn found(domain: &Domain) -> [usize; 2] {
    let boundary = Boundary::new(domain).unwrap();
    let group = Group::of(&boundary, &DomainCurve { boundary: &boundary, domain }).unwrap();
    [group.rotations, group.mirrors()]
}

#[test]
fn what_is_symmetric_is_found() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    assert_eq!(found(&Domain::polygon(&square, &[]).unwrap()), [4, 4]);
    let rectangle = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
    assert_eq!(found(&Domain::polygon(&rectangle, &[]).unwrap()), [2, 2]);
    let parallelogram = [[0.0, 0.0], [2.0, 0.0], [2.5, 1.0], [0.5, 1.0]];
    assert_eq!(found(&Domain::polygon(&parallelogram, &[]).unwrap()), [2, 0]);
    assert_eq!(found(&Domain::polygon(&wheel(5, &[(0.0, 1.0), (0.5, 0.5)]), &[]).unwrap()), [5, 5]);
    assert_eq!(found(&Domain::polygon(&wheel(40, &[(0.0, 1.0), (0.5, 0.9)]), &[]).unwrap()), [40, 40]);
    let ellipse = builder(|b| {
        b.begin_loop(LoopKind::Outer, "")?.add_elliptic_arc(
            [3.0, 1.0],
            [2.0, 1.0],
            0.4,
            0.3,
            0.3 + TAU,
            "",
        )?;
        b.end_loop()?;
        Ok(())
    });
    assert_eq!(found(&ellipse), [2, 2]);
    let ring = builder(|b| {
        circle(b, LoopKind::Outer, [0.0; 2], 1.0)?;
        circle(b, LoopKind::Hole, [0.1, 0.0], 0.3)
    });
    assert_eq!(found(&ring), [1, 1]);
    assert_eq!(found(&gingerbread()), [1, 1]);
}

#[test]
fn what_is_almost_symmetric_is_not() {
    let off = 1e-7;
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0 + off]];
    assert_eq!(found(&Domain::polygon(&square, &[]).unwrap()), [1, 0]);
    let hole = builder(|b| {
        b.add_polygon(LoopKind::Outer, &[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])?;
        circle(b, LoopKind::Hole, [off, 0.0], 0.45)
    });
    assert_eq!(found(&hole), [1, 1], "the mirror at the x axis is left");
    assert_eq!(found(&file("hohq/GingerbreadMan.control")), [1, 0], "its spline has a corner at its seam");
}

/// Area to the left of the sampled loops of a boundary.
fn sampled_area(boundary: &Boundary) -> f64 {
    let samples = boundary.chains.iter().flat_map(|c| c.samples.windows(2));
    samples.map(|w| 0.5 * cross(w[0].point.coords, w[1].point.coords)).sum()
}

#[test]
fn sectors_are_parts_of_the_domain_with_closed_loops() {
    let mut seen = 0;
    for (domain, cuts) in [
        (plate(), vec![[4, 0], [2, 0], [2, 1], [1, 0], [1, 1]]),
        (disc(), vec![[4, 0], [2, 1], [1, 0]]),
        (file("hohq/Pill.control"), vec![[2, 0], [1, 0], [1, 1]]),
        (gingerbread(), vec![[1, 0]]),
    ] {
        let boundary = Boundary::new(&domain).unwrap();
        let group = Group::of(&boundary, &DomainCurve { boundary: &boundary, domain: &domain }).unwrap();
        for [rotations, mirror] in cuts {
            let sector = Sector::new(&boundary, &group, Cut { rotations, mirror }).unwrap();
            let part = &sector.boundary;
            let expected = boundary.area / (2 * rotations) as f64;
            assert!((part.area - expected).abs() < 1e-12);
            // The sampled area of curves is off by the square of the tables' intervals.
            assert!((sampled_area(part) - expected).abs() < 1e-4, "{} {expected}", sampled_area(part));
            for chain in &part.chains {
                let Some([start, end]) = chain.ends else { continue };
                let ends = [chain.point(0.0), chain.point(chain.length)];
                let junctions = [start, end].map(|j| part.junctions[j as usize].point);
                assert!((ends[0] - junctions[0]).norm() < 1e-12 && (ends[1] - junctions[1]).norm() < 1e-12);
                assert!(chain.samples.windows(2).all(|w| w[0].s <= w[1].s));
            }
            // Turns and the loops' bends make a full turn round the part.
            let outer = part.loops[0].iter().map(|c| &part.chains[*c as usize]);
            let bends: f64 = outer
                .map(|c| {
                    let turn = |w: &[Sample]| {
                        cross(w[0].tangent, w[1].tangent).atan2(w[0].tangent.dot(&w[1].tangent))
                    };
                    let corner = c.ends.map_or(0.0, |[_, end]| PI - part.junctions[end as usize].angle);
                    c.samples.windows(2).map(turn).sum::<f64>() + corner
                })
                .sum();
            assert!((bends - TAU).abs() < 1e-6, "{bends}");
            seen += 1;
        }
    }
    assert_eq!(seen, 12);
}

/// A square whose sides bear these names, from the lowest counter-clockwise.
fn named_square(names: [&str; 4]) -> Domain {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    builder(|b| {
        b.begin_loop(LoopKind::Outer, "")?;
        for k in 0..4 {
            b.add_line(corners[k], corners[(k + 1) % 4], names[k])?;
        }
        b.end_loop()?;
        Ok(())
    })
}

#[test]
fn names_go_to_names_one_to_one() {
    assert_eq!(found(&named_square(["a", "b", "c", "d"])), [4, 4], "each side to a side");
    assert_eq!(found(&named_square(["in", "wall", "out", "wall"])), [2, 2], "walls stay walls");
    assert_eq!(found(&named_square(["in", "wall", "wall", "wall"])), [1, 1]);
    assert_eq!(
        found(&named_square(["in", "out", "wall", "wall"])),
        [1, 1],
        "the diagonal that swaps in and out"
    );
    // The name changes in the middle of a side that the other sides have whole.
    let broken = builder(|b| {
        b.begin_loop(LoopKind::Outer, "wall")?;
        b.add_line([0.0, 0.0], [0.4, 0.0], "in")?.add_line([0.4, 0.0], [1.0, 0.0], "")?;
        b.add_line([1.0, 0.0], [1.0, 1.0], "")?.add_line([1.0, 1.0], [0.0, 1.0], "")?;
        b.add_line([0.0, 1.0], [0.0, 0.0], "")?.end_loop()?;
        Ok(())
    });
    assert_eq!(found(&broken), [1, 0]);
}
