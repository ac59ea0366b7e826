//! A merge on a patch is the merge of the whole mesh, and leaves a sound one.

use super::chords::chord_through;
use super::live::LiveMesh;
use super::merge::{diagonal_growth, Merge};
use super::patch::Patch;
use super::refusals::{Key, Refusals};
use crate::domain::{Boundary, BoundaryPoint, Chain, Frame, Junction, Place, Sample};
use crate::mesh::{QuadMesh, Vertex};
use crate::numerics::{Point, Vector};
use std::collections::HashMap;
use std::f64::consts::FRAC_PI_2;

/// Rings that hold any of the meshes here.
const ALL: usize = 99;

/// A rectangle of `m` by `n` unit squares, every interior edge bent a little.
fn grid(m: usize, n: usize) -> (Boundary, QuadMesh) {
    let corners = [(0, 0), (m, 0), (m, n), (0, n)].map(|(x, y)| Point::new(x as f64, y as f64));
    let chains: Vec<Chain> = (0..4)
        .map(|k| {
            let (a, b) = (corners[k], corners[(k + 1) % 4]);
            let (length, tangent) = ((b - a).norm(), (b - a).normalize());
            let sample = |s: f64| Sample {
                s,
                point: a + tangent * s,
                tangent,
                curvature: 0.0,
                segment: 0,
                t: s / length,
            };
            let ends = Some([k as u32, (k as u32 + 1) % 4]);
            let samples = vec![sample(0.0), sample(length)];
            Chain { loop_index: 0, name: 0, ends, length, samples: samples.into(), breaks: vec![] }
        })
        .collect();
    let junctions = (0..4).map(|k| Junction {
        point: corners[k],
        angle: FRAC_PI_2,
        chain_in: (k as u32 + 3) % 4,
        chain_out: k as u32,
    });
    let boundary = Boundary {
        frame: Frame::identity(),
        diagonal: 1.0,
        loop_sources: vec![],
        names: vec!["outer".into()],
        junctions: junctions.collect(),
        loops: vec![vec![0, 1, 2, 3]],
        area: (m * n) as f64,
        chains,
    };
    let place = |i: usize, j: usize| {
        let on = |chain, s: usize| Place::Boundary(BoundaryPoint { chain, s: s as f64 });
        match (i, j) {
            (0, 0) => Place::Junction(0),
            (i, 0) if i == m => Place::Junction(1),
            (i, j) if i == m && j == n => Place::Junction(2),
            (0, j) if j == n => Place::Junction(3),
            (i, 0) => on(0, i),
            (i, j) if i == m => on(1, j),
            (i, j) if j == n => on(2, m - i),
            (0, j) => on(3, n - j),
            _ => Place::Interior,
        }
    };
    let vertices = (0..(m + 1) * (n + 1))
        .map(|k| {
            let (i, j) = (k % (m + 1), k / (m + 1));
            Vertex { point: Point::new(i as f64, j as f64), place: place(i, j) }
        })
        .collect();
    let at = |i: usize, j: usize| (j * (m + 1) + i) as u32;
    let quads: Vec<[u32; 4]> = (0..m * n)
        .map(|q| (q % m, q / m))
        .map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)])
        .collect();
    let region = vec![0; quads.len()];
    let mut mesh = QuadMesh::new(&boundary, vertices, quads, region, &HashMap::new()).expect("a mesh");
    for (e, edge) in mesh.edges.iter_mut().enumerate().filter(|(_, e)| e.span.is_none()) {
        edge.bubbles = (0..3).map(|k| Vector::new(0.01, -0.02) * ((e + k) as f64).sin()).collect();
    }
    (boundary, mesh)
}

/// The ends of a chord's edges, as a merge takes them.
fn pairs(mesh: &QuadMesh, rungs: &[u32]) -> Vec<([u32; 2], bool)> {
    rungs.iter().map(|e| &mesh.edges[*e as usize]).map(|e| (e.vertices, e.span.is_some())).collect()
}

/// Splices the merge as seen by a patch of so many rings.
fn splice(boundary: &Boundary, live: &LiveMesh, merge: &Merge, rings: usize) -> LiveMesh {
    let patch = Patch::new(boundary, merge, &merge.touched, rings).expect("a patch");
    let mut spliced = live.clone();
    spliced.splice(&patch, merge.clone().into_removal());
    spliced
}

/// The mesh with nothing left to the order in which its parts were found: edges from the lesser vertex.
fn normal(mesh: QuadMesh) -> QuadMesh {
    let mut mesh = mesh;
    for edge in mesh.edges.iter_mut().filter(|e| e.vertices[0] > e.vertices[1] && e.span.is_none()) {
        edge.vertices.reverse();
        edge.quads.reverse();
        edge.bubbles = crate::mesh::reversed_bubbles(&edge.bubbles);
    }
    mesh
}

#[test]
fn patches_of_any_size_leave_the_same_mesh() {
    let (boundary, mesh) = grid(7, 5);
    let live = LiveMesh::new(mesh, 4);
    let mesh = &live.mesh;
    let diagonal = (vec![([mesh.quads[16][0], mesh.quads[16][2]], false)], vec![16]);
    // Through the sides of a quad in the middle, and of one at the boundary.
    let strips = [(16, 0), (16, 1), (0, 0)].map(|(q, side): (usize, usize)| {
        let chord = chord_through(mesh, mesh.quad_edges[q][side]);
        (pairs(mesh, &chord.rungs), chord.quads)
    });
    for (pairs, dropped) in strips.into_iter().chain([diagonal]) {
        let merge = Merge::new(&boundary, &live, &pairs, &dropped, &[1; 4]).expect("a merge");
        assert_eq!(merge.removed, dropped.len());
        let whole = splice(&boundary, &live, &merge, ALL);
        assert_eq!(whole.count, live.count - dropped.len());
        let whole = normal(whole.compact());
        whole.check(&boundary).expect("a sound mesh");
        assert_eq!(whole.quads.len(), mesh.quads.len() - dropped.len());
        for rings in 1..4 {
            assert_eq!(normal(splice(&boundary, &live, &merge, rings).compact()), whole, "{rings} rings");
        }
    }
}

#[test]
fn a_wider_patch_takes_over_what_moved_in_a_narrower_one() {
    let (boundary, mesh) = grid(9, 7);
    let live = LiveMesh::new(mesh, 4);
    let quad = live.mesh.quads[31];
    let merge =
        Merge::new(&boundary, &live, &[([quad[0], quad[2]], false)], &[31], &[1; 4]).expect("a merge");
    let patch = |rings| Patch::new(&boundary, &merge, &merge.touched, rings).expect("a patch");
    let mut narrow = patch(1);
    let held: Vec<u32> = (0..narrow.edges.len())
        .filter(|e| narrow.rim[*e])
        .flat_map(|e| narrow.mesh.edges[e].vertices)
        .collect();
    let mut moved = 0;
    for v in (0..narrow.vertices.len()).filter(|v| !held.contains(&(*v as u32))) {
        narrow.mesh.vertices[v].point += Vector::new(0.01, 0.02) * (v as f64).cos();
        moved += 1;
    }
    for (e, edge) in narrow.mesh.edges.iter_mut().enumerate().filter(|(e, _)| !narrow.rim[*e]) {
        edge.bubbles = vec![Vector::new(0.03, e as f64); 2];
    }
    assert!(moved > 2);
    // In the whole mesh it is the same, whichever of the two brings it there.
    let spliced = |patch: &Patch| {
        let mut whole = live.clone();
        whole.splice(patch, merge.clone().into_removal());
        normal(whole.compact())
    };
    for rings in 2..4 {
        let mut wide = patch(rings);
        wide.take_over(&narrow);
        assert_eq!(spliced(&wide), spliced(&narrow), "{rings} rings");
        assert_ne!(spliced(&wide), spliced(&patch(rings)));
    }
}

#[test]
fn changes_one_after_another_leave_a_sound_mesh() {
    let (boundary, mesh) = grid(6, 6);
    let mut live = LiveMesh::new(mesh, 4);
    let mut merges = 0;
    // Whatever diagonal can go goes, then whatever chord: doublets come up, and chords that cross
    // themselves.
    for q in 0..36 {
        if !live.quads().any(|own| own == q) {
            continue;
        }
        let quad = live.mesh.quads[q as usize];
        let Ok(merge) = Merge::new(&boundary, &live, &[([quad[0], quad[2]], false)], &[q], &[1; 4]) else {
            continue;
        };
        if let Some(growth) = diagonal_growth(&boundary, &live, q, 0) {
            assert_eq!(growth, merge.irregularity, "quad {q}");
        }
        live = splice(&boundary, &live, &merge, 1);
        merges += 1;
    }
    assert!(merges > 3);
    live.clone().compact().check(&boundary).expect("a sound mesh");
    for e in 0..live.mesh.edges.len() as u32 {
        if !live.has_edge(e) {
            continue;
        }
        let chord = chord_through(&live.mesh, e);
        let pairs = pairs(&live.mesh, &chord.rungs);
        let Ok(merge) = Merge::new(&boundary, &live, &pairs, &chord.quads, &[1; 4]) else { continue };
        live = splice(&boundary, &live, &merge, 1);
        live.clone().compact().check(&boundary).expect("a sound mesh");
        merges += 1;
    }
    let fewest: usize = live.boundary_edges.iter().sum();
    assert!(live.count < 30 && fewest < 24, "{merges} merges leave {} quads", live.count);
}

#[test]
fn what_failed_is_worth_another_try_where_something_moved() {
    let (_, mesh) = grid(4, 4);
    let inside = |v: usize| mesh.vertices[v].place == Place::Interior;
    let here = (0..mesh.vertices.len()).find(|v| inside(*v)).expect("an interior vertex");
    let there = (0..mesh.vertices.len()).rfind(|v| inside(*v)).expect("another");
    let live = LiveMesh::new(mesh.clone(), 4);
    let mut refusals = Refusals::default();
    refusals.begin(&live);
    let [one, all] = [Key::Chord(0), Key::Chord(1)];
    refusals.refuse(one, vec![here as u32]);
    refusals.refuse(all, Vec::new());
    let still = |refusals: &Refusals, touched: usize| {
        [one, all].map(|key| refusals.still_refused(key, || vec![touched as u32]))
    };
    assert_eq!(still(&refusals, there), [true, true]);
    assert!(!refusals.still_refused(Key::Chord(2), Vec::new));
    // The mesh comes back smoothed: one vertex hardly moved, another by a third of its edges.
    let mut smoothed = mesh;
    smoothed.vertices[here].point.x += 0.01;
    smoothed.vertices[there].point.x += 0.33;
    refusals.begin(&LiveMesh::new(smoothed.clone(), 4));
    assert_eq!(still(&refusals, there), [true, false]);
    assert_eq!(still(&refusals, here), [true, true]);
    // Small moves add up.
    for k in 2..20 {
        smoothed.vertices[here].point.x += 0.01;
        refusals.begin(&LiveMesh::new(smoothed.clone(), 4));
        assert_eq!(still(&refusals, here), [k < 10, k < 10], "after {k} moves");
    }
}
