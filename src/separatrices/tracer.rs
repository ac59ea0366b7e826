//! The motorcycle graph: all separatrices grow together by arc length, each stops at the first
//! earlier one that it crosses.
//!
//! Every trace leaves one chord in each triangle that it passes. Two chords cross if their ends
//! alternate around the triangle: a matter of order alone. Geometry serves only for lengths and pictures.

use super::stream::{before, Branch, Position, Stream};
use super::{Separatrix, Stop, TraceEnd};
use crate::base_mesh::Triangulation;
use crate::cross_field::CrossField;
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::error::{Error, Result};
use crate::numerics::{cross, Point, NONE};
use crate::singularities::{CornerFan, Singularity};
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;
use std::f64::consts::FRAC_PI_2;

/// What a chord is: a way through, or the first piece of a separatrix from the singular point to its port.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Course {
    /// Flux was balanced counter-clockwise (`true`): a singular point lies to its left.
    Through(bool),
    Port,
}

/// The passage of a trace through a triangle.
#[derive(Debug, Clone, Copy)]
struct Chord {
    trace: u32,
    /// The trace's step: the chord runs from `points[step]` to `points[step + 1]`.
    step: u32,
    from: Position,
    to: Position,
    course: Course,
    /// The branch's parity in this triangle's lift: equal parity, one family (regular triangles only).
    family: i32,
    /// If the trace stops inside the triangle: how far along the whole chord.
    end: Option<(usize, f64)>,
}

impl Chord {
    /// Where `other` crosses this chord, as a comparable distance from its start; `None`: not at all.
    fn crossing(&self, other: &Chord) -> Option<(usize, f64)> {
        match (self.course, other.course) {
            (Course::Port, Course::Port) => None,
            (Course::Port, Course::Through(ccw)) => {
                // Crossings farther out on a port's chord have ends nearer to the port.
                self.to.within(other.from, other.to, ccw).then(|| {
                    let end = if ccw { other.to } else { other.from };
                    let d = end.distance(self.to, true);
                    (3 - d.0.min(3), 1.0 - d.1)
                })
            }
            (Course::Through(ccw), Course::Port) => {
                other.to.within(self.from, self.to, ccw).then(|| other.to.distance(self.from, ccw))
            }
            (Course::Through(ccw), Course::Through(_)) => {
                let inside = [other.from, other.to].map(|x| x.within(self.from, self.to, ccw));
                let touches = other.from == self.from || other.to == self.to;
                if inside[0] == inside[1] || touches {
                    return None;
                }
                let end = if inside[0] { other.from } else { other.to };
                Some(end.distance(self.from, ccw))
            }
        }
    }

    /// Whether `other`, stopping on this chord, comes from its left.
    fn comes_from_left(&self, other: &Chord) -> bool {
        match (self.course, other.course) {
            (Course::Port, Course::Through(ccw)) => !ccw,
            (Course::Through(ccw), Course::Port) => ccw,
            _ => !other.from.within(self.from, self.to, true),
        }
    }
}

/// A trace under way.
struct Trace {
    from: TraceEnd,
    to: Option<TraceEnd>,
    points: Vec<Point>,
    length: f64,
    triangle: u32,
    at: Position,
    branch: Branch,
    /// (step, distance along the chord, stop), unsorted.
    stops: Vec<(u32, (usize, f64), Stop)>,
}

/// Priority: the shortest trace moves first; ties by number.
#[derive(PartialEq)]
struct Turn(f64, u32);
impl Eq for Turn {}
impl PartialOrd for Turn {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Turn {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0).then(self.1.cmp(&other.1))
    }
}

/// Most triangles a trace may pass, as a multiple of the triangles there are: a spiral to a limit cycle
/// passes the same ones again and again.
const MAX_PASSES: usize = 4;

/// Traces separatrices on one base mesh.
pub(super) struct Tracer<'a> {
    stream: Stream<'a>,
    boundary: &'a Boundary,
    singularities: &'a [Singularity],
    corners: &'a [CornerFan],
    singular_in: Vec<u32>,
    chords: Vec<Vec<Chord>>,
    traces: Vec<Trace>,
    queue: BinaryHeap<Reverse<Turn>>,
    /// For each vertex its loop and index there, or `NONE`.
    border_index: Vec<(u32, u32)>,
    /// For each border vertex the triangle on the border edge that starts there, else `NONE`.
    border_triangle: Vec<u32>,
}

impl<'a> Tracer<'a> {
    pub fn new(
        mesh: &'a Triangulation,
        field: &'a CrossField,
        boundary: &'a Boundary,
        singularities: &'a [Singularity],
        corners: &'a [CornerFan],
    ) -> Self {
        let mut singular_in = vec![NONE; mesh.triangles.len()];
        for (i, s) in singularities.iter().enumerate() {
            singular_in[s.triangle as usize] = i as u32;
        }
        let mut border_index = vec![(NONE, NONE); mesh.vertices.len()];
        for (l, cycle) in mesh.loops.iter().enumerate() {
            for (i, &v) in cycle.iter().enumerate() {
                border_index[v as usize] = (l as u32, i as u32);
            }
        }
        let mut border_triangle = vec![NONE; mesh.vertices.len()];
        for (t, neighbors) in mesh.neighbors.iter().enumerate() {
            for i in (0..3).filter(|&i| neighbors[i] == NONE) {
                border_triangle[mesh.triangles[t][i] as usize] = t as u32;
            }
        }
        Tracer {
            border_triangle,
            stream: Stream { mesh, field },
            boundary,
            singularities,
            corners,
            singular_in,
            chords: vec![Vec::new(); mesh.triangles.len()],
            traces: Vec::new(),
            queue: BinaryHeap::new(),
            border_index,
        }
    }

    fn failure(&self, reason: &str, at: Point) -> Error {
        Error::Separatrix { reason: reason.into(), at: Some(at) }
    }

    /// Cuts every tip (a corner without quads) off by a ray across it, which runs before all others:
    /// lines along the sides would else meet in the tip. What is cut off is a triangle.
    pub fn cut_tips(&mut self) -> Result<()> {
        for c in self.corners.iter().filter(|c| c.quads == 0) {
            let mesh = self.stream.mesh;
            let (l, i) = self.border_index[c.vertex as usize];
            let cycle = &mesh.loops[l as usize];
            let n = cycle.len();
            let point = |k: usize| mesh.vertices[cycle[k % n] as usize].point;
            let junction = &self.boundary.junctions[c.junction as usize];
            let sides =
                [junction.chain_in, junction.chain_out].map(|k| self.boundary.chains[k as usize].length);
            let reach = TIP_SIDE_SHARE * sides[0].min(sides[1]);
            // The edge that holds the cut, but not one that has turned away from the tip's side.
            let first = point(i as usize + 1) - point(i as usize);
            let mut edge = i as usize;
            for k in i as usize..i as usize + n - 1 {
                let along = point(k + 1) - point(k);
                if cross(first, along).atan2(first.dot(&along)).abs() > TIP_TURN {
                    break;
                }
                edge = k;
                if (point(k + 1) - point(i as usize)).norm() > reach {
                    break;
                }
            }
            self.launch_seed(l, (edge % n) as u32)?;
            self.run()?;
        }
        Ok(())
    }

    /// Launches all separatrices of singularities and corners.
    pub fn launch_all(&mut self) -> Result<()> {
        for (i, s) in self.singularities.iter().enumerate() {
            for (j, &(edge, share)) in s.ports.iter().enumerate() {
                self.launch_port(i as u32, j as u8, s, Position { edge: edge as usize, share });
            }
        }
        for (i, c) in self.corners.iter().enumerate() {
            for ray in 1..c.quads {
                self.launch_ray(i as u32, ray, c)?;
            }
        }
        Ok(())
    }

    fn push(&mut self, trace: Trace) {
        let id = self.traces.len() as u32;
        self.queue.push(Reverse(Turn(trace.length, id)));
        self.traces.push(trace);
    }

    fn launch_port(&mut self, singularity: u32, port: u8, s: &Singularity, to: Position) {
        let t = s.triangle;
        let exit = self.stream.point(t, to);
        let out = exit - s.point;
        let branch = self.stream.branch(t, to, out.y.atan2(out.x));
        let id = self.traces.len() as u32;
        let chord = Chord { trace: id, step: 0, from: to, to, course: Course::Port, family: 0, end: None };
        self.chords[t as usize].push(chord);
        let from = TraceEnd::Singularity { singularity, port };
        let (points, length, stops) = (vec![s.point, exit], out.norm(), Vec::new());
        match self.stream.across(t, to, branch) {
            Some((triangle, at, branch)) => {
                self.push(Trace { from, to: None, points, length, triangle, at, branch, stops });
            }
            // The singular triangle lies at the border: the separatrix ends there at once.
            None => {
                let end = Some(self.border_end(t, to));
                self.traces.push(Trace { from, to: end, points, length, triangle: t, at: to, branch, stops });
            }
        }
    }

    /// Ray `ray` of a corner: at k θ / n of the interior angle, in the fan's triangle that holds it.
    fn launch_ray(&mut self, corner: u32, ray: u8, c: &CornerFan) -> Result<()> {
        let mesh = self.stream.mesh;
        let v = c.vertex;
        let origin = mesh.vertices[v as usize].point;
        let (l, i) = self.border_index[v as usize];
        let cycle = &mesh.loops[l as usize];
        let n = cycle.len();
        let next = cycle[(i as usize + 1) % n];
        let first = mesh.vertices[next as usize].point - origin;
        let theta = self.stream.field.border_angle[v as usize];
        let wanted = theta * f64::from(ray) / f64::from(c.quads);
        // Walk the fan counter-clockwise from the outgoing border edge.
        let mut t = self.border_triangle[v as usize];
        let mut phi = 0.0;
        loop {
            let i = mesh.triangles[t as usize].iter().position(|&x| x == v).unwrap_or(0);
            let (a, b) = (self.stream.corner(t, i + 1) - origin, self.stream.corner(t, i + 2) - origin);
            let wedge = cross(a, b).atan2(a.dot(&b));
            let across = mesh.neighbors[t as usize][(i + 2) % 3];
            if wanted < phi + wedge || across == NONE {
                let from = Position { edge: i, share: 0.0 };
                let spoke = self.stream.angle(t, from);
                // Clockwise over the wedge the lift rises by minus the corner's turn.
                let turn = -self.stream.field.triangles[t as usize].corner_turn[i];
                let lifted = spoke + turn * (wanted - phi) / wedge;
                let direction = first.y.atan2(first.x) + wanted;
                let branch = ((direction - lifted) / FRAC_PI_2).round() as Branch;
                let from_end = TraceEnd::Corner { corner, ray };
                let trace = Trace {
                    from: from_end,
                    to: None,
                    points: vec![origin],
                    length: 0.0,
                    triangle: t,
                    at: from,
                    branch,
                    stops: Vec::new(),
                };
                self.push(trace);
                return Ok(());
            }
            phi += wedge;
            t = across;
        }
    }

    /// A ray straight into the domain from the middle of a border edge.
    pub fn launch_seed(&mut self, loop_index: u32, edge: u32) -> Result<()> {
        let mesh = self.stream.mesh;
        let cycle = &mesh.loops[loop_index as usize];
        let a = cycle[edge as usize];
        let t = self.border_triangle[a as usize];
        let side = mesh.triangles[t as usize].iter().position(|&v| v == a).unwrap_or(0);
        let at = Position { edge: side, share: SEED_SHARE };
        let along = self.stream.corner(t, side + 1) - self.stream.corner(t, side);
        let branch = self.stream.branch(t, at, along.x.atan2(-along.y));
        let from = self.border_end(t, at);
        let points = vec![self.stream.point(t, at)];
        self.push(Trace { from, to: None, points, length: 0.0, triangle: t, at, branch, stops: Vec::new() });
        Ok(())
    }

    /// A ray straight into the domain from the border edge that holds `seed`.
    pub fn launch_seed_at(&mut self, seed: BoundaryPoint) -> Result<()> {
        let mesh = self.stream.mesh;
        let l = self.boundary.chains[seed.chain as usize].loop_index;
        let cycle = &mesh.loops[l as usize];
        let edge = (0..cycle.len()).find(|&i| {
            let [a, b] = [cycle[i], cycle[(i + 1) % cycle.len()]].map(|v| mesh.vertices[v as usize].place);
            self.boundary.span(a, b).is_some_and(|span| {
                let length = self.boundary.chains[span.chain as usize].length;
                let inside = |s: f64| span.start <= s && s < span.end;
                span.chain == seed.chain && (inside(seed.s) || inside(seed.s + length))
            })
        });
        self.launch_seed(l, edge.unwrap_or(0) as u32)
    }

    /// The end of a trace at `at` on the border edge of triangle `t`.
    fn border_end(&self, t: u32, at: Position) -> TraceEnd {
        let mesh = self.stream.mesh;
        let [a, b] = [at.edge, (at.edge + 1) % 3].map(|i| mesh.triangles[t as usize][i]);
        let (loop_index, edge) = self.border_index[a as usize];
        let [pa, pb] = [a, b].map(|v| mesh.vertices[v as usize].place);
        let place = self.boundary.span(pa, pb).map(|span| {
            let chain = &self.boundary.chains[span.chain as usize];
            let s = chain.wrap(span.start + at.share * (span.end - span.start));
            BoundaryPoint { chain: span.chain, s }
        });
        let place = place.map_or(Place::Interior, Place::Boundary);
        TraceEnd::Border { loop_index, edge, share: at.share, place }
    }

    /// Lets all launched traces run to their ends.
    pub fn run(&mut self) -> Result<()> {
        let limit = 1000 + MAX_PASSES * self.stream.mesh.triangles.len();
        while let Some(Reverse(Turn(_, id))) = self.queue.pop() {
            let i = id as usize;
            if self.traces[i].points.len() > limit {
                let at = self.traces[i].points[limit / 2];
                return Err(self.failure("a separatrix winds without end", at));
            }
            self.advance(id)?;
            if self.traces[i].to.is_none() {
                self.queue.push(Reverse(Turn(self.traces[i].length, id)));
            }
        }
        Ok(())
    }

    /// One triangle further.
    fn advance(&mut self, id: u32) -> Result<()> {
        let trace = &self.traces[id as usize];
        let (t, from, branch) = (trace.triangle, trace.at, trace.branch);
        let step = trace.points.len() as u32 - 1;
        let here = trace.points[step as usize];
        let singular = self.singular_in[t as usize];
        let passage = if singular == NONE {
            self.stream.through_regular(t, from, branch)
        } else {
            let s = &self.singularities[singular as usize];
            let ports: Vec<Position> =
                s.ports.iter().map(|&(e, share)| Position { edge: e as usize, share }).collect();
            self.stream.through_singular(t, &ports, from, branch, s.point)
        };
        // Lines along the sides of a tip meet in it; the ray that cuts the tip off is crossed before.
        let passage = passage.or_else(|| self.tip_of(t).map(|edge| (Position { edge, share: 0.0 }, true)));
        let (to, ccw) = passage.ok_or_else(|| self.failure("the field leads nowhere in a triangle", here))?;
        let family = branch.rem_euclid(2);
        let mut chord = Chord { trace: id, step, from, to, course: Course::Through(ccw), family, end: None };
        let exit = self.stream.point(t, to);

        // The first earlier chord on the way.
        let mut first: Option<(usize, (usize, f64))> = None;
        for (k, other) in self.chords[t as usize].iter().enumerate() {
            if singular == NONE && other.family == family && other.course != Course::Port {
                continue;
            }
            let Some(mine) = chord.crossing(other) else { continue };
            let Some(theirs) = other.crossing(&chord) else { continue };
            if other.end.is_some_and(|end| before(end, theirs)) {
                continue;
            }
            if first.is_none_or(|(_, d)| before(mine, d)) {
                first = Some((k, mine));
            }
        }
        if let Some((k, mine)) = first {
            let host = self.chords[t as usize][k];
            let at = self.meeting_point(&host, here, exit);
            chord.end = Some(mine);
            let left = host.comes_from_left(&chord);
            let key = host.crossing(&chord).unwrap_or((0, 0.0));
            let stop = Stop { segment: host.step, point: at, stem: id, left };
            self.traces[host.trace as usize].stops.push((host.step, key, stop));
            let trace = &mut self.traces[id as usize];
            trace.length += (at - here).norm();
            trace.points.push(at);
            trace.to = Some(TraceEnd::Separatrix { on: host.trace });
            self.chords[t as usize].push(chord);
            return Ok(());
        }
        if to.share == 0.0 {
            return Err(self.failure("a separatrix runs into a sharp corner", exit));
        }
        self.chords[t as usize].push(chord);
        let end = match self.stream.across(t, to, branch_at_exit(&self.stream, t, from, to, branch, ccw)) {
            None => Err(self.border_end(t, to)),
            Some(next) => Ok(next),
        };
        let trace = &mut self.traces[id as usize];
        trace.length += (exit - here).norm();
        trace.points.push(exit);
        match end {
            Err(border) => trace.to = Some(border),
            Ok((triangle, at, branch)) => (trace.triangle, trace.at, trace.branch) = (triangle, at, branch),
        }
        Ok(())
    }

    /// The corner of triangle `t` that is a tip, if it has one.
    fn tip_of(&self, t: u32) -> Option<usize> {
        let field = self.stream.field;
        let corners = &self.stream.mesh.triangles[t as usize];
        corners
            .iter()
            .position(|&v| self.border_index[v as usize].0 != NONE && field.quads_at[v as usize] == 0)
    }

    /// Where the straight chords meet; on the host's chord also where they miss each other beside a
    /// singular point.
    fn meeting_point(&self, host: &Chord, a: Point, b: Point) -> Point {
        let points = &self.traces[host.trace as usize].points;
        let p = points[host.step as usize];
        let q = points.get(host.step as usize + 1).copied().unwrap_or(p);
        let (d, e) = (q - p, b - a);
        let denominator = cross(d, e);
        let x = if denominator == 0.0 { 0.5 } else { cross(a - p, e) / denominator };
        p + d * if x.is_finite() { x.clamp(CHORD_INSET, 1.0 - CHORD_INSET) } else { 0.5 }
    }

    /// The loops of the boundary that no chain of traces connects with loop 0.
    fn unconnected_loops(&self) -> Vec<u32> {
        let loops = self.stream.mesh.loops.len();
        let mut parent: Vec<usize> = (0..loops + self.traces.len()).collect();
        fn root(parent: &mut [usize], mut i: usize) -> usize {
            while parent[i] != i {
                parent[i] = parent[parent[i]];
                i = parent[i];
            }
            i
        }
        // Separatrices of one singularity hang together.
        let mut first_of = vec![usize::MAX; self.singularities.len()];
        for (i, trace) in self.traces.iter().enumerate() {
            for end in [Some(trace.from), trace.to].into_iter().flatten() {
                let other = match end {
                    TraceEnd::Singularity { singularity, .. } => {
                        let first = &mut first_of[singularity as usize];
                        if *first == usize::MAX {
                            *first = loops + i;
                        }
                        *first
                    }
                    TraceEnd::Corner { corner, .. } => {
                        self.border_index[self.corners[corner as usize].vertex as usize].0 as usize
                    }
                    TraceEnd::Border { loop_index, .. } => loop_index as usize,
                    TraceEnd::Separatrix { on } => loops + on as usize,
                };
                let (a, b) = (root(&mut parent, loops + i), root(&mut parent, other));
                parent[a.max(b)] = a.min(b);
            }
        }
        let outer = root(&mut parent, 0);
        (1..loops).filter(|&l| root(&mut parent, l) != outer).map(|l| l as u32).collect()
    }

    /// Connects every loop of the boundary by seed rays, so that every region is a disc.
    pub fn connect_loops(&mut self) -> Result<()> {
        let loops = self.stream.mesh.loops.len();
        for round in 0..SEED_ROUNDS {
            let lone = self.unconnected_loops();
            let Some(&l) = lone.first() else { return Ok(()) };
            let edges = self.stream.mesh.loops[l as usize].len() as u32;
            // Other places in later rounds, spread by the golden ratio.
            let edge = (((f64::from(round as u32 / loops as u32) * 0.618_033_988_749) % 1.0)
                * f64::from(edges)) as u32;
            self.launch_seed(l, edge.min(edges - 1))?;
            self.run()?;
        }
        match self.unconnected_loops().first() {
            None => Ok(()),
            Some(&l) => {
                let v = self.stream.mesh.loops[l as usize][0];
                Err(self.failure("a hole is not reached", self.stream.mesh.vertices[v as usize].point))
            }
        }
    }

    pub fn finish(self) -> Vec<Separatrix> {
        self.traces
            .into_iter()
            .map(|mut t| {
                t.stops.sort_by(|a, b| {
                    a.0.cmp(&b.0)
                        .then(a.1 .0.cmp(&b.1 .0))
                        .then(a.1 .1.total_cmp(&b.1 .1))
                        .then(a.2.stem.cmp(&b.2.stem))
                });
                // The stages keep them to the end.
                t.points.shrink_to_fit();
                let to = t.to.unwrap_or(t.from);
                let stops = t.stops.into_iter().map(|s| s.2).collect();
                Separatrix { from: t.from, to, points: t.points, stops }
            })
            .collect()
    }
}

/// Least share of a chord between its ends and a T-junction drawn on it: beside a singular point straight
/// chords may miss each other. Positions for pictures and lengths only; the order is kept apart.
const CHORD_INSET: f64 = 0.02;

/// How far from a tip it is cut off, relative to the shorter of its sides.
const TIP_SIDE_SHARE: f64 = 0.3;

/// Most that a tip's side may turn before the cut, in radians.
const TIP_TURN: f64 = 0.35;

/// Where on its border edge a seed ray starts: off the middle, so that symmetric domains do not tie.
const SEED_SHARE: f64 = 0.47;

/// Most seed rays tried in all: a few for each loop of the domain.
const SEED_ROUNDS: usize = 400;

/// The branch at the exit, in the lift at the exit: a way around corner 0 of a singular triangle shifts it.
fn branch_at_exit(s: &Stream, t: u32, from: Position, to: Position, branch: Branch, ccw: bool) -> Branch {
    let winding = s.field.triangles[t as usize].winding;
    let back = (to.edge, to.share) < (from.edge, from.share);
    match (ccw, back) {
        (true, true) => branch + winding,
        (false, false) => branch - winding,
        _ => branch,
    }
}
