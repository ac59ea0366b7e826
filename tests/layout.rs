//! Steps 5 and 6 on layouts drawn by hand: repair, lengths, extraction.

mod drawing;

use drawing::{add_loop, circle, draw, least_corner, nowhere, picture, polygons, quad, valences};
use quadrel::domain::{Boundary, Place};
use quadrel::layout::{conform, BlockLayout, Conforming, NodeKind, PentagonRule, Targets};
use quadrel::numerics::Point;
use std::collections::BTreeMap;

fn uniform(h: f64) -> impl Fn(Point) -> f64 {
    move |_| h
}

fn points(p: &[(f64, f64)]) -> Vec<Point> {
    p.iter().map(|&(x, y)| Point::new(x, y)).collect()
}

/// A region as drawn: the points along each side.
type Sides = Vec<Vec<usize>>;

/// Conforms and checks what must hold for every result: a valid layout, all lengths used, valences as counted.
fn conformed(layout: &BlockLayout, boundary: &Boundary, targets: &Targets, name: &str) -> Conforming {
    layout.check(boundary).unwrap();
    let result = conform(layout, boundary, targets).unwrap();
    picture(&result.layout, name);
    result.layout.check(boundary).unwrap();
    result.repaired.check(boundary).unwrap();
    assert!(result.layout.region.iter().all(|&r| (r as usize) < result.repaired.regions.len()));
    assert_eq!(result.lengths.len(), result.repaired.arcs.len());
    // Σ over interior vertices (4 − valence) + Σ over the border (2 − quads) = 4 (1 − holes).
    let mut quads = vec![0i64; result.layout.vertices.len()];
    result.layout.quads.iter().flatten().for_each(|&v| quads[v as usize] += 1);
    let index: i64 = result
        .layout
        .vertices
        .iter()
        .zip(&quads)
        .map(|(v, q)| if v.place == Place::Interior { 4 - q } else { 2 - q })
        .sum();
    assert_eq!(index, 4 * (2 - boundary.loops.len() as i64), "{name}");
    result
}

/// A 3 × 3 arrangement of unit-third squares in the unit square whose middle square is left to the test: points
/// 4 r + c at (c / 3, r / 3), eight regions around the middle.
fn frame() -> (Boundary, Vec<(f64, f64)>, Vec<Sides>) {
    let boundary = polygons(&[points(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])]);
    let grid: Vec<(f64, f64)> = (0..16).map(|i| ((i % 4) as f64 / 3.0, (i / 4) as f64 / 3.0)).collect();
    let mut regions = Vec::new();
    for r in 0..3 {
        for c in 0..3 {
            if (r, c) != (1, 1) {
                let at = 4 * r + c;
                regions.push(quad([at, at + 1, at + 5, at + 4]));
            }
        }
    }
    (boundary, grid, regions)
}

#[test]
fn a_square_of_one_region_is_a_grid() {
    let boundary = polygons(&[points(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])]);
    let layout =
        draw(&boundary, &[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)], &[quad([0, 1, 2, 3])], &[]);
    let size = uniform(0.26);
    let result = conformed(&layout, &boundary, &Targets::new(&size, &[]), "square");
    assert_eq!(result.layout.quads.len(), 16);
    assert_eq!(result.fallback, 0);
    assert!(least_corner(&result.layout) > 0.999);
    // A chain's least count outweighs the size, and carries over to the opposite chain.
    let result = conformed(&layout, &boundary, &Targets::new(&size, &[7]), "square-7");
    assert_eq!(result.layout.quads.len(), 28);
}

#[test]
fn a_triangle_becomes_three_quads_whose_lines_run_through_the_neighbours() {
    // The middle square is halved by a diagonal and so is a corner's neighbour, by hand.
    let (boundary, grid, mut regions) = frame();
    regions.push(vec![vec![5], vec![6], vec![10]]);
    regions.push(vec![vec![5], vec![10], vec![9]]);
    let layout = draw(&boundary, &grid, &regions, &[]);
    let size = uniform(0.5);
    let result = conformed(&layout, &boundary, &Targets::new(&size, &[]), "triangle");
    assert_eq!(result.fallback, 1);
    let count = valences(&result.layout);
    assert_eq!(count[&3], 2, "a three-valent vertex in each triangle: {count:?}");
    assert!(least_corner(&result.layout) > 0.2);
    // Both triangles need two edges a side, so the lines reach the boundary.
    let border = result.layout.vertices.iter().filter(|v| v.place != Place::Interior).count();
    assert_eq!(border, 16);
}

#[test]
fn a_pentagon_is_repaired_by_star_and_by_the_papers_cut() {
    // The middle square lacks its upper right corner: a pentagon; the neighbour there has five sides, too.
    let (boundary, mut grid, _) = frame();
    grid.push((2.0 / 3.0, 0.5));
    grid.push((0.5, 2.0 / 3.0));
    let mut regions = vec![
        quad([0, 1, 5, 4]),
        quad([1, 2, 6, 5]),
        quad([2, 3, 7, 6]),
        quad([4, 5, 9, 8]),
        quad([8, 9, 13, 12]),
        vec![vec![5], vec![6], vec![16], vec![17], vec![9]],
    ];
    regions.push(vec![vec![6], vec![7, 11], vec![10, 16]]);
    regions.push(vec![vec![9, 17], vec![10, 14], vec![13]]);
    // Right and upper neighbours meet at point 10, with the cut-off triangle.
    regions.push(vec![vec![16], vec![10], vec![17]]);
    regions.push(quad([10, 11, 15, 14]));
    regions[6] = vec![vec![6], vec![7], vec![11], vec![10, 16]];
    regions[7] = vec![vec![9, 17], vec![10], vec![14], vec![13]];
    let layout = draw(&boundary, &grid, &regions, &[]);
    let size = uniform(0.3);
    let mut targets = Targets::new(&size, &[]);
    let star = conformed(&layout, &boundary, &targets, "pentagon-star");
    assert_eq!(star.fallback, 1);
    let count = valences(&star.layout);
    assert!(count[&5] >= 1 && count[&3] >= 1, "{count:?}");
    targets.pentagon = PentagonRule::Cut;
    let cut = conformed(&layout, &boundary, &targets, "pentagon-cut");
    assert_eq!(cut.fallback, 1);
    assert_eq!(cut.repaired.regions.len(), layout.regions.len() + 1);
    assert!(least_corner(&star.layout) > 0.1 && least_corner(&cut.layout) > 0.1);
}

/// A ring of quads around a regular polygon with `k` sides.
fn ring(k: usize) -> (Boundary, BlockLayout) {
    let at = |i: usize, r: f64| {
        let a = std::f64::consts::TAU * i as f64 / k as f64;
        (0.5 + r * a.cos(), 0.5 + r * a.sin())
    };
    let mut all: Vec<(f64, f64)> = (0..k).map(|i| at(i, 0.5)).collect();
    let boundary = polygons(&[points(&all)]);
    all.extend((0..k).map(|i| at(i, 0.25)));
    let mut regions: Vec<_> = (0..k).map(|i| quad([i, (i + 1) % k, k + (i + 1) % k, k + i])).collect();
    regions.push((k..2 * k).map(|i| vec![i]).collect());
    let layout = draw(&boundary, &all, &regions, &[]);
    (boundary, layout)
}

#[test]
fn regions_of_six_to_nine_sides_are_cut_by_a_pattern() {
    for (k, pieces) in [(6, [0, 2, 0]), (7, [0, 1, 1]), (8, [0, 3, 0]), (9, [0, 2, 1])] {
        let (boundary, layout) = ring(k);
        let size = uniform(0.15);
        let result = conformed(&layout, &boundary, &Targets::new(&size, &[]), &format!("ring-{k}"));
        assert_eq!(result.fallback, 2);
        let mut sides = [0; 3];
        let inner = result.repaired.regions.iter().filter(|r| {
            r.sides.iter().flatten().all(|s| result.repaired.arcs[s.arc as usize].span.is_none())
        });
        inner.for_each(|r| sides[r.sides.len() - 3] += 1);
        assert_eq!(sides, pieces, "{k} sides");
        assert!(valences(&result.layout).keys().all(|v| (3..=6).contains(v)));
        assert!(least_corner(&result.layout) > 0.05, "{k} sides: {}", least_corner(&result.layout));
    }
}

#[test]
fn t_junctions_disappear() {
    // Three by hand: two lines end on a vertical one from both sides at different heights.
    let boundary = polygons(&[points(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])]);
    let p = [
        (0.0, 0.0),
        (0.5, 0.0),
        (1.0, 0.0),
        (1.0, 1.0),
        (0.5, 1.0),
        (0.0, 1.0),
        (0.0, 0.3),
        (0.5, 0.3),
        (0.5, 0.6),
        (1.0, 0.6),
        (0.25, 0.3),
        (0.25, 1.0),
    ];
    let regions = [
        vec![vec![0], vec![1], vec![7, 10], vec![6]],
        vec![vec![6], vec![10], vec![11], vec![5]],
        vec![vec![10], vec![7, 8], vec![4], vec![11]],
        vec![vec![1], vec![2], vec![9], vec![8, 7]],
        vec![vec![8], vec![9], vec![3], vec![4]],
    ];
    let layout = draw(&boundary, &p, &regions, &[]);
    let size = uniform(0.15);
    let result = conformed(&layout, &boundary, &Targets::new(&size, &[]), "t-junctions");
    assert_eq!((result.fallback, result.relaxed), (0, 0));
    assert_eq!(valences(&result.layout).keys().copied().collect::<Vec<_>>(), [4]);
    assert!(least_corner(&result.layout) > 0.5);
    // So coarse that the two T-junctions on the middle line merge.
    let size = uniform(0.7);
    let coarse = conformed(&layout, &boundary, &Targets::new(&size, &[]), "t-merged");
    assert!(coarse.lengths.contains(&0));
    assert!(coarse.layout.quads.len() <= 4);
}

/// A square whose four regions meet at two T-junctions (points 8 and 9) close to each other, with another
/// node (10) between them.
fn near_miss() -> (Boundary, BlockLayout) {
    let boundary = polygons(&[points(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])]);
    let e = 0.01;
    let p = [
        (0.0, 0.0),
        (0.5, 0.0),
        (1.0, 0.0),
        (1.0, 0.5),
        (1.0, 1.0),
        (0.5 + e, 1.0),
        (0.0, 1.0),
        (0.0, 0.5),
        (0.5, 0.5),
        (0.5 + e, 0.5),
        (0.5 + e / 2.0, 0.5),
    ];
    let regions = [
        quad([0, 1, 8, 7]),
        vec![vec![7], vec![8, 10, 9], vec![5], vec![6]],
        vec![vec![1], vec![2], vec![3], vec![9, 10, 8]],
        quad([9, 3, 4, 5]),
    ];
    (boundary.clone(), draw(&boundary, &p, &regions, &[]))
}

#[test]
fn near_misses_merge_through_zero_arcs() {
    let (boundary, layout) = near_miss();
    let size = uniform(0.4);
    let result = conformed(&layout, &boundary, &Targets::new(&size, &[]), "near-miss");
    let between = layout.arcs.iter().position(|a| a.nodes.contains(&8) && a.nodes.contains(&10)).unwrap();
    assert_eq!(result.lengths[between], 0);
    assert_eq!(result.layout.quads.len(), 4);
}

#[test]
fn singularities_of_equal_sign_stay_apart() {
    let (boundary, mut layout) = near_miss();
    let size = uniform(0.4);
    layout.nodes[8].kind = NodeKind::Singularity(5);
    layout.nodes[9].kind = NodeKind::Singularity(3);
    let merged = conformed(&layout, &boundary, &Targets::new(&size, &[]), "cancelled");
    assert_eq!(merged.layout.quads.len(), 4);
    layout.nodes[9].kind = NodeKind::Singularity(5);
    let kept = conformed(&layout, &boundary, &Targets::new(&size, &[]), "kept-apart");
    assert!(kept.rounds > 1, "the merge is seen after it happened");
    let between = |v: u32| layout.arcs.iter().position(|a| a.nodes.contains(&v) && a.nodes.contains(&10));
    assert!(kept.lengths[between(8).unwrap()] + kept.lengths[between(9).unwrap()] >= 1);
    assert!(kept.layout.quads.len() > 4);
}

/// A disc with a hole whose border is a spiral of one turn and a step: the tangential separatrix of the step winds
/// around and ends above where it began, so a four-sided layout forces the step to length 0.
fn spiral() -> (Boundary, BlockLayout) {
    let n = 64;
    let at = |turn: f64, r: f64| {
        let a = std::f64::consts::TAU * turn;
        Point::new(0.5 + r * a.cos(), 0.5 + r * a.sin())
    };
    let share = |i: usize| i as f64 / n as f64;
    // Clockwise: from the top of the step down the spiral to its foot, then up the step.
    let hole: Vec<Point> = (0..=n).rev().map(|i| at(share(i), 0.15 + 0.1 * share(i))).collect();
    let trace: Vec<Point> = (0..=n).map(|i| at(share(i), 0.25 + 0.1 * share(i))).collect();
    let mut boundary = nowhere();
    circle(&mut boundary, Point::new(0.5, 0.5), 0.5, 1.0);
    add_loop(&mut boundary, &[hole.clone(), vec![hole[n], hole[0]]]);
    // Nodes half-way round keep two arcs between the same nodes apart.
    let (top, foot, w, o, half, round) = (0, 1, 2, 3, 4, 5);
    let nodes = [hole[0], hole[n], trace[n], at(0.0, 0.5), hole[n / 2], trace[n / 2]].map(|p| (p.x, p.y));
    let below = vec![vec![top, half], vec![foot], vec![top, round], vec![w]];
    let above = vec![vec![w, round], vec![top, w], vec![o], vec![o]];
    let mut layout = draw(&boundary, &nodes, &[below, above], &[]);
    let arcs = [0, 1].map(|i| layout.regions[0].sides[2][i].arc as usize);
    layout.arcs[arcs[0]].points = trace[..=n / 2].to_vec();
    layout.arcs[arcs[1]].points = trace[n / 2..].to_vec();
    (boundary, layout)
}

#[test]
fn a_limit_cycle_gets_a_pair_of_singularities() {
    let (boundary, layout) = spiral();
    let size = uniform(0.1);
    let result = conformed(&layout, &boundary, &Targets::new(&size, &[]), "spiral");
    assert_eq!(result.fallback, 2);
    assert!(result.relaxed >= 1);
    let count = valences(&result.layout);
    assert!(count[&3] == result.relaxed && count[&5] == result.relaxed, "{count:?}");
}

#[test]
fn an_annulus_cut_once_keeps_its_loops() {
    let mut boundary = nowhere();
    circle(&mut boundary, Point::new(0.5, 0.5), 0.5, 1.0);
    circle(&mut boundary, Point::new(0.5, 0.5), 0.2, -1.0);
    let layout = draw(&boundary, &[(1.0, 0.5), (0.7, 0.5)], &[quad([0, 0, 1, 1])], &[]);
    for h in [0.1, 5.0] {
        let size = uniform(h);
        let result = conformed(&layout, &boundary, &Targets::new(&size, &[]), "annulus");
        assert!(valences(&result.layout).keys().all(|&v| v == 4));
        assert!(result.layout.quads.len() >= 4);
    }
}

#[test]
fn regions_of_one_and_two_sides_are_halved() {
    let arc = |from: f64, to: f64| -> Vec<Point> {
        let point = |i: usize| {
            let a = from + (to - from) * i as f64 / 32.0;
            Point::new(0.5 + 0.5 * a.cos(), 0.5 + 0.5 * a.sin())
        };
        (0..=32).map(point).collect()
    };
    let (half, whole) = (std::f64::consts::PI, std::f64::consts::TAU);
    let mut lens = nowhere();
    add_loop(&mut lens, &[arc(0.0, half), arc(half, whole)]);
    let two = draw(&lens, &[(1.0, 0.5), (0.0, 0.5), (0.5, 1.0)], &[vec![vec![0, 2], vec![1]]], &[]);
    let mut drop = nowhere();
    add_loop(&mut drop, &[arc(0.0, whole)]);
    let one = draw(&drop, &[(1.0, 0.5)], &[vec![vec![0]]], &[]);
    for (boundary, layout, name) in [(lens, two, "lens"), (drop, one, "drop")] {
        let size = uniform(0.3);
        let result = conformed(&layout, &boundary, &Targets::new(&size, &[]), name);
        assert_eq!(result.fallback, 2);
        assert!(result.repaired.regions.iter().all(|r| (3..=4).contains(&r.sides.len())));
        assert!(valences(&result.layout)[&3] >= 2);
    }
}

#[test]
fn defects_of_a_drawing_are_named() {
    let (boundary, grid, regions) = frame();
    let layout = draw(&boundary, &grid, &regions, &[]);
    let size = uniform(0.5);
    let error = conform(&layout, &boundary, &Targets::new(&size, &[])).unwrap_err();
    assert_eq!(error.name(), "layout");
    assert!(error.place().is_some());
    let messages: BTreeMap<&str, BlockLayout> = BTreeMap::from([
        ("followed", {
            let mut l = layout.clone();
            l.regions[0].sides.swap(0, 1);
            l
        }),
        ("no such node", {
            let mut l = layout.clone();
            l.arcs[3].nodes[1] = 99;
            l
        }),
        ("empty side", {
            let mut l = layout.clone();
            l.regions[2].sides[1].clear();
            l
        }),
    ]);
    for (words, broken) in messages {
        let (message, _) = broken.check(&boundary).unwrap_err();
        assert!(message.contains(words), "{message}");
    }
}
