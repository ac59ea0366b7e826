//! Constrained Delaunay triangulation and refinement of the chords; the only file that names spade.

use super::adjacency::{assemble, RawMesh};
use super::sampling::Sampling;
use super::size_field::SizeField;
use super::Triangulation;
use crate::domain::{Boundary, Place};
use crate::error::{Error, Result};
use crate::numerics::tolerances::{BASE_ANGLE, CHORD_SAGITTA};
use crate::numerics::{Point, NONE};
use spade::handles::{FixedFaceHandle, FixedVertexHandle, InnerTag};
use spade::{
    AngleLimit, ConstrainedDelaunayTriangulation, HierarchyHintGenerator, Point2, RefinementParameters,
    Triangulation as _,
};

type Cdt = ConstrainedDelaunayTriangulation<Point2<f64>, (), (), (), HierarchyHintGenerator<f64>>;

/// Most rounds of halving chords that cross or are too coarse for a gap: 2^-24 of a chord.
const ROUNDS: usize = 24;
/// Rounds after which crossings are blamed on the grid and border vertices are left where they are.
const SNAPPED_ROUNDS: usize = 12;
/// Rounds in which chords are halved for a gap alone.
const GAP_ROUNDS: usize = 10;
/// Most passes that split interior edges down to a wanted size; each halves them.
const SIZE_PASSES: usize = 16;

/// The border polygon with one number for each vertex; chord i starts at vertex i.
struct Polygon {
    points: Vec<Point>,
    places: Vec<Place>,
    next: Vec<u32>,
    /// First vertex of each loop, and the total.
    offsets: Vec<usize>,
}

impl Polygon {
    fn new(sampling: &Sampling, snap: bool) -> Polygon {
        let mut polygon = Polygon { points: vec![], places: vec![], next: vec![], offsets: vec![0] };
        for starts in sampling.starts(snap) {
            let first = polygon.points.len() as u32;
            let n = starts.len() as u32;
            for (i, (place, point)) in (0..n).zip(starts) {
                polygon.points.push(point);
                polygon.places.push(place);
                polygon.next.push(first + (i + 1) % n);
            }
            polygon.offsets.push(polygon.points.len());
        }
        polygon
    }

    fn len(&self) -> usize {
        self.points.len()
    }

    /// The chord between two border vertices, if they are neighbours.
    fn chord(&self, a: usize, b: usize) -> Option<usize> {
        match (self.next[a] as usize == b, self.next[b] as usize == a) {
            (true, _) => Some(a),
            (_, true) => Some(b),
            _ => None,
        }
    }

    /// Flags of chords, arranged by loops.
    fn by_loops(&self, marks: &[bool]) -> Vec<Vec<bool>> {
        self.offsets.windows(2).map(|w| marks[w[0]..w[1]].to_vec()).collect()
    }
}

/// What became of a polygon.
enum Attempt {
    Done(Box<Cdt>, Vec<FixedVertexHandle>),
    /// These chords are too coarse.
    Coarse(Vec<bool>),
}

/// See [`super::triangulate`].
pub(super) fn triangulate(boundary: &Boundary, sizes: &SizeField) -> Result<Triangulation> {
    let mut sampling = Sampling::new(boundary, sizes);
    for round in 0..ROUNDS {
        let polygon = Polygon::new(&sampling, round < SNAPPED_ROUNDS);
        match constrain(&polygon)? {
            Attempt::Coarse(marks) => {
                let at = marks.iter().position(|&m| m).map(|i| polygon.points[i]);
                // Near the end halving has not helped: the curves themselves cross.
                if round + 1 == ROUNDS || !sampling.halve(&polygon.by_loops(&marks)) {
                    return Err(Error::BaseMesh { reason: "boundary curves cross or touch".into(), at });
                }
            }
            Attempt::Done(mut cdt, handles) => {
                let outside = outside(&mut cdt);
                let mut marks = inverted(&cdt, &polygon, &sampling, &handles, &outside);
                if marks.is_none() && round < GAP_ROUNDS {
                    marks = coarse_for_gap(&cdt, &polygon, &sampling, &handles);
                }
                match marks {
                    Some(marks) if sampling.halve(&polygon.by_loops(&marks)) => {}
                    Some(_) => {
                        let reason = "the boundary's loops are not nested".into();
                        return Err(Error::BaseMesh { reason, at: None });
                    }
                    None => return refine(*cdt, polygon, handles, &sampling, sizes),
                }
            }
        }
        sampling.balance();
    }
    Err(Error::BaseMesh { reason: "boundary curves nearly touch everywhere".into(), at: None })
}

/// Inserts the vertices in a strided order (runs along a loop make long thin triangles, which cost
/// quadratic time), then the chords.
fn constrain(polygon: &Polygon) -> Result<Attempt> {
    let n = polygon.len();
    let mut cdt = Cdt::new();
    let mut handles = vec![FixedVertexHandle::from_index(0); n];
    let mut owner: Vec<usize> = Vec::with_capacity(n);
    let mut marks = vec![false; n];
    let previous = |i: usize| match polygon.offsets.partition_point(|&o| o <= i) {
        k if polygon.offsets[k - 1] == i => polygon.offsets[k] - 1,
        _ => i - 1,
    };
    for i in strided(n) {
        let p = polygon.points[i];
        let handle = cdt
            .insert(Point2::new(p.x, p.y))
            .map_err(|e| Error::BaseMesh { reason: format!("a boundary point: {e}"), at: Some(p) })?;
        handles[i] = handle;
        match owner.get(handle.index()) {
            // Two border vertices at one point.
            Some(&j) => [i, previous(i), j, previous(j)].iter().for_each(|&c| marks[c] = true),
            None => owner.push(i),
        }
    }
    if marks.contains(&true) {
        return Ok(Attempt::Coarse(marks));
    }
    for i in strided(n) {
        let (from, to) = (handles[i], handles[polygon.next[i] as usize]);
        match cdt.try_add_constraint(from, to).len() {
            1 => {}
            0 => {
                marks[i] = true;
                for edge in cdt.get_conflicting_edges_between_vertices(from, to) {
                    let [a, b] = edge.vertices().map(|v| owner[v.fix().index()]);
                    if let Some(c) = polygon.chord(a, b) {
                        marks[c] = true;
                    }
                }
            }
            _ => {
                // The chord runs exactly through other vertices.
                marks[i] = true;
                for edge in cdt.get_conflicting_edges_between_vertices(from, to) {
                    let v = owner[edge.from().fix().index()];
                    [v, previous(v)].iter().for_each(|&c| marks[c] = true);
                }
            }
        }
    }
    match marks.contains(&true) {
        true => Ok(Attempt::Coarse(marks)),
        false => Ok(Attempt::Done(Box::new(cdt), handles)),
    }
}

/// 0..n in a fixed order that jumps about.
fn strided(n: usize) -> impl Iterator<Item = usize> {
    let gcd = |mut a: usize, mut b: usize| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    // Golden section: successive vertices fall into the largest gaps left.
    let mut stride = ((n as f64 * 0.618_034) as usize).max(1);
    while gcd(stride, n) > 1 {
        stride += 1;
    }
    (0..n).map(move |i| (i as u64 * stride as u64 % n as u64) as usize)
}

/// For each face of the triangulation whether it lies outside the domain.
fn outside(cdt: &mut Cdt) -> Vec<bool> {
    let only_look = RefinementParameters::new().exclude_outer_faces(true).with_max_additional_vertices(0);
    let mut outside = vec![false; cdt.num_all_faces()];
    for face in cdt.refine(only_look).excluded_faces {
        outside[face.index()] = true;
    }
    outside
}

/// Chords without the domain to their left or with it to their right: somewhere an arc bulges over
/// another loop or the sides of a sharp corner have changed places. Everything curved is then too coarse.
fn inverted(
    cdt: &Cdt,
    polygon: &Polygon,
    sampling: &Sampling,
    handles: &[FixedVertexHandle],
    outside: &[bool],
) -> Option<Vec<bool>> {
    let inside = |face: Option<FixedFaceHandle<InnerTag>>| face.is_some_and(|f| !outside[f.index()]);
    let wrong = (0..polygon.len()).any(|i| {
        let edge = cdt.get_edge_from_neighbors(handles[i], handles[polygon.next[i] as usize]);
        edge.is_none_or(|e| {
            !inside(e.face().as_inner().map(|f| f.fix()))
                || inside(e.rev().face().as_inner().map(|f| f.fix()))
        })
    });
    wrong.then(|| sampling.loops.iter().flatten().map(|c| c.turn > 1e-6).collect())
}

/// Chords whose arcs are too high for the distance to the vertex or chord across.
fn coarse_for_gap(
    cdt: &Cdt,
    polygon: &Polygon,
    sampling: &Sampling,
    handles: &[FixedVertexHandle],
) -> Option<Vec<bool>> {
    let chords: Vec<_> = sampling.loops.iter().flatten().collect();
    let mut owner = vec![0; polygon.len()];
    handles.iter().enumerate().for_each(|(i, h)| owner[h.index()] = i);
    let mut previous = vec![0; polygon.len()];
    polygon.next.iter().enumerate().for_each(|(i, &j)| previous[j as usize] = i);
    let mut marks = vec![false; polygon.len()];
    for i in 0..polygon.len() {
        let next = polygon.next[i] as usize;
        let Some(edge) = cdt.get_edge_from_neighbors(handles[i], handles[next]) else { continue };
        let Some(apex) = edge.opposite_vertex().map(|v| owner[v.fix().index()]) else { continue };
        // The apex beside the chord is its own curve going on.
        if apex == previous[i] || apex == polygon.next[next] as usize {
            continue;
        }
        let (a, b, p) = (polygon.points[i], polygon.points[next], polygon.points[apex]);
        let share = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
        let gap = (p - (a + (b - a) * share)).norm();
        for c in [i, apex, previous[apex]] {
            marks[c] |= chords[c].sagitta() > CHORD_SAGITTA * gap;
        }
    }
    marks.contains(&true).then_some(marks)
}

/// Delaunay refinement to the wanted sizes.
fn refine(
    mut cdt: Cdt,
    polygon: Polygon,
    handles: Vec<FixedVertexHandle>,
    sampling: &Sampling,
    sizes: &SizeField,
) -> Result<Triangulation> {
    let size = sizes.usual();
    let area: f64 = (0..polygon.len())
        .map(|i| {
            let (a, b) = (polygon.points[i], polygon.points[polygon.next[i] as usize]);
            0.5 * (a.x * b.y - a.y * b.x)
        })
        .sum();
    // An equilateral triangle has 0.43 size²; refinement leaves triangles of half the bound on average.
    let most_vertices = 30 * polygon.len() + (20.0 * area.abs() / (size * size)) as usize + 5000;
    let parameters = RefinementParameters::new()
        .exclude_outer_faces(true)
        .with_angle_limit(AngleLimit::from_deg(BASE_ANGLE))
        .with_max_allowed_area(0.5 * size * size)
        .with_max_additional_vertices(most_vertices);
    let mut result = cdt.refine(parameters.clone());
    let mut changed = split_bridges(&mut cdt, &result.excluded_faces, &polygon, sampling)?;
    for _ in 0..SIZE_PASSES {
        if sizes.is_uniform() || !split_long(&mut cdt, sizes)? {
            break;
        }
        changed = true;
    }
    if changed {
        result = cdt.refine(parameters);
    }

    let mut outside = vec![false; cdt.num_all_faces()];
    result.excluded_faces.iter().for_each(|f| outside[f.index()] = true);
    let mut number = vec![NONE; cdt.num_all_faces()];
    let inside: Vec<_> = cdt.inner_faces().filter(|f| !outside[f.fix().index()]).collect();
    (0u32..).zip(&inside).for_each(|(t, f)| number[f.fix().index()] = t);
    let mut raw = RawMesh {
        points: cdt.vertices().map(|v| Point::new(v.position().x, v.position().y)).collect(),
        triangles: Vec::with_capacity(inside.len()),
        neighbors: Vec::with_capacity(inside.len()),
    };
    for face in &inside {
        let edges = face.adjacent_edges();
        raw.triangles.push(edges.map(|e| e.from().fix().index() as u32));
        raw.neighbors.push(edges.map(|e| number[e.rev().face().fix().index()]));
    }
    let starts: Vec<Vec<(u32, Place)>> = polygon
        .offsets
        .windows(2)
        .map(|w| (w[0]..w[1]).map(|i| (handles[i].index() as u32, polygon.places[i])).collect())
        .collect();
    assemble(&raw, &starts, &sampling.loops)
}

fn insert_all(cdt: &mut Cdt, points: &[Point2<f64>]) -> Result<()> {
    for p in points {
        cdt.insert(*p).map_err(|e| Error::BaseMesh {
            reason: format!("a point inside: {e}"),
            at: Some(Point::new(p.x, p.y)),
        })?;
    }
    Ok(())
}

/// Splits interior edges that join two border vertices, so that a layer of free vertices lies
/// between the sides of a narrow part; but not at the tips of sharp corners, where it would
/// never end.
fn split_bridges(
    cdt: &mut Cdt,
    excluded: &[FixedFaceHandle<InnerTag>],
    polygon: &Polygon,
    sampling: &Sampling,
) -> Result<bool> {
    let mut outside = vec![false; cdt.num_all_faces()];
    excluded.iter().for_each(|f| outside[f.index()] = true);
    let mut border = vec![false; cdt.num_vertices()];
    for edge in cdt.undirected_edges().filter(|e| e.is_constraint_edge()) {
        edge.vertices().iter().for_each(|v| border[v.fix().index()] = true);
    }
    let tips = sampling.sharp_tips(&polygon.points);
    let at_tip = |p: Point2<f64>| tips.iter().any(|(q, r)| (p.x - q.x).hypot(p.y - q.y) < *r);
    let mut middles = Vec::new();
    for edge in cdt.undirected_edges().filter(|e| !e.is_constraint_edge()) {
        let inner = edge.as_directed().face().as_inner().is_some_and(|f| !outside[f.fix().index()]);
        if inner && edge.vertices().iter().all(|v| border[v.fix().index()]) {
            let [a, b] = edge.positions();
            let middle = Point2::new(0.5 * (a.x + b.x), 0.5 * (a.y + b.y));
            if !at_tip(middle) {
                middles.push(middle);
            }
        }
    }
    insert_all(cdt, &middles)?;
    Ok(!middles.is_empty())
}

/// Splits interior edges that are longer than a place asks for; whether there was any.
fn split_long(cdt: &mut Cdt, sizes: &SizeField) -> Result<bool> {
    let outside = outside(cdt);
    let mut middles = Vec::new();
    for edge in cdt.undirected_edges().filter(|e| !e.is_constraint_edge()) {
        if edge.as_directed().face().as_inner().is_none_or(|f| outside[f.fix().index()]) {
            continue;
        }
        let [a, b] = edge.positions();
        let middle = Point::new(0.5 * (a.x + b.x), 0.5 * (a.y + b.y));
        // Bisection leaves edges of 0.7 to 1.4 times the wanted length.
        if (a.x - b.x).hypot(a.y - b.y) > 1.4 * sizes.at(middle) {
            middles.push(Point2::new(middle.x, middle.y));
        }
    }
    insert_all(cdt, &middles)?;
    Ok(!middles.is_empty())
}
