//! The mesh is the domain's: moved, turned, scaled, given backwards or begun elsewhere, it stays the same.
//!
//! Scaling by powers of two and giving loops backwards change no bit that matters: the mesh must be
//! the same up to the map. Other similarities round the input, so topology must agree, and the number of elements
//! within 2 %.

use quadrel::domain::{Curve, CurveFailure, CurveSegment, Domain, LoopKind};
use quadrel::mesh::HighOrderMesh;
use quadrel::numerics::{Point, Vector};
use quadrel::output::Format;
use quadrel::stages::Stages;
use quadrel::{generate, input, Options};
use std::path::Path;
use std::sync::Arc;

/// A similarity, and how the loops are given.
#[derive(Debug, Clone, Copy)]
struct Map {
    name: &'static str,
    scale: f64,
    angle: f64,
    /// In diagonals of the domain, in both directions.
    shift: f64,
    backwards: bool,
    /// Loops start at another segment; a single smooth closed segment at another point.
    begun_elsewhere: bool,
    /// Connectivity and coordinates must agree.
    exact: bool,
}

const SAME: Map = Map {
    name: "same",
    scale: 1.0,
    angle: 0.0,
    shift: 0.0,
    backwards: false,
    begun_elsewhere: false,
    exact: true,
};

const MAPS: [Map; 8] = [
    Map { name: "scaled by 2^20", scale: 1_048_576.0, ..SAME },
    Map { name: "scaled by 2^-20", scale: 1.0 / 1_048_576.0, ..SAME },
    Map { name: "backwards", backwards: true, ..SAME },
    Map { name: "scaled by 1e6", scale: 1e6, exact: false, ..SAME },
    Map { name: "scaled by 1e-6", scale: 1e-6, exact: false, ..SAME },
    Map { name: "shifted by 1e3 diagonals", shift: 1e3, exact: false, ..SAME },
    Map { name: "turned by 0.3", angle: 0.3, exact: false, ..SAME },
    Map { name: "begun elsewhere", begun_elsewhere: true, exact: false, ..SAME },
];

/// A [`Map`] for one domain.
#[derive(Debug, Clone, Copy)]
struct Similarity {
    map: Map,
    shift: Vector,
}

impl Similarity {
    fn vector(&self, v: Vector) -> Vector {
        if self.map.angle == 0.0 {
            return v * self.map.scale;
        }
        let (s, c) = self.map.angle.sin_cos();
        Vector::new(c * v.x - s * v.y, s * v.x + c * v.y) * self.map.scale
    }

    fn point(&self, p: Point) -> Point {
        Point::from(self.vector(p.coords) + self.shift)
    }
}

/// A segment seen through a map.
struct Moved {
    segment: CurveSegment,
    similarity: Similarity,
    /// The closed segment starts at this parameter.
    start: f64,
    breaks: Vec<f64>,
}

impl Moved {
    fn new(segment: &CurveSegment, similarity: Similarity, start: f64) -> Moved {
        let pieces = segment.pieces();
        let mut breaks: Vec<f64> = pieces[1..pieces.len() - 1].to_vec();
        if similarity.map.backwards {
            breaks.reverse();
            breaks.iter_mut().for_each(|t| *t = 1.0 - *t);
        }
        Moved { segment: segment.clone(), similarity, start, breaks }
    }

    fn parameter(&self, t: f64) -> f64 {
        let t = if self.similarity.map.backwards { 1.0 - t } else { t };
        match t + self.start {
            u if u > 1.0 => u - 1.0,
            u => u,
        }
    }
}

impl Curve for Moved {
    fn point(&self, t: f64) -> Result<Point, CurveFailure> {
        let p = self.segment.point(self.parameter(t)).map_err(|e| CurveFailure(e.to_string()))?;
        Ok(self.similarity.point(p))
    }

    fn derivative(&self, t: f64) -> Option<Result<Vector, CurveFailure>> {
        let d = self.segment.derivative(self.parameter(t)).map_err(|e| CurveFailure(e.to_string()));
        let sign = if self.similarity.map.backwards { -1.0 } else { 1.0 };
        Some(d.map(|d| self.similarity.vector(d) * sign))
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn is_line(&self) -> bool {
        self.segment.is_line()
    }

    fn may_have_corners(&self) -> bool {
        false
    }
}

/// `domain` through `map`.
fn moved(domain: &Domain, map: Map) -> (Domain, Similarity) {
    let shift = Vector::new(1.0, 1.0) * (map.shift * domain.diagonal());
    let similarity = Similarity { map, shift };
    let mut builder = Domain::builder();
    for (i, l) in domain.loops().iter().enumerate() {
        builder.begin_loop(if i == 0 { LoopKind::Outer } else { LoopKind::Hole }, l.name()).unwrap();
        let mut segments: Vec<&CurveSegment> = l.segments().iter().collect();
        let mut start = 0.0;
        if map.begun_elsewhere {
            let half = segments.len() / 2;
            segments.rotate_left(half);
            // Beside other loops the seam of a closed curve is the caller's choice, which the base mesh follows.
            let smooth = domain.loops().len() == 1
                && segments.len() == 1
                && segments[0].pieces().len() == 2
                && l.turn(0).unwrap().abs() < 1e-6;
            start = if smooth { 0.37 } else { 0.0 };
        }
        if map.backwards {
            segments.reverse();
        }
        for s in segments {
            builder.add_curve(Arc::new(Moved::new(s, similarity, start)), s.name()).unwrap();
        }
        builder.end_loop().unwrap();
    }
    (builder.build().unwrap(), similarity)
}

/// What must not change.
#[derive(Debug, PartialEq)]
struct Outcome {
    valences: Vec<u8>,
    regions: usize,
    layout_quads: usize,
}

struct Run {
    outcome: Outcome,
    triangles: usize,
    mesh: HighOrderMesh,
}

fn run(domain: &Domain) -> Run {
    let mut stages = Stages::default();
    let mesh = generate(domain, &Options::default(), &mut stages).unwrap();
    let mut valences: Vec<u8> = stages.singularities.iter().map(|s| s.valence).collect();
    valences.sort_unstable();
    let outcome = Outcome {
        valences,
        regions: stages.block_layout.map_or(0, |l| l.regions.len()),
        layout_quads: stages.quad_layout.map_or(0, |l| l.quads.len()),
    };
    Run { outcome, triangles: stages.triangulation.map_or(0, |t| t.triangles.len()), mesh }
}

/// How `b`, the mesh of the moved domain, differs from `a`; empty if it does not.
fn differences(a: &Run, b: &Run, similarity: &Similarity, diagonal: f64) -> Vec<String> {
    let mut found = Vec::new();
    if a.outcome != b.outcome {
        found.push(format!("{:?} became {:?}", a.outcome, b.outcome));
    }
    let (m, n) = (a.mesh.elements.len(), b.mesh.elements.len());
    if m.abs_diff(n) as f64 > 0.02 * m as f64 {
        found.push(format!("{m} elements became {n}"));
    }
    if similarity.map.exact {
        if a.mesh.elements != b.mesh.elements || a.mesh.blocks != b.mesh.blocks {
            found.push("the connectivity differs".into());
        } else {
            let scale = similarity.map.scale;
            let distance = |(p, q): (&Point, &Point)| (similarity.point(*p) - q).norm() / (scale * diagonal);
            let most = a.mesh.nodes.iter().zip(&b.mesh.nodes).map(distance).fold(0.0, f64::max);
            if most > 1e-9 {
                found.push(format!("nodes moved by {most:e} of the diagonal"));
            }
        }
    }
    found
}

fn examine(file: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/domains").join(file);
    let domain = input::read(&path, None).unwrap().domain;
    let first = run(&domain);
    let second = run(&domain);
    assert!(Format::Vtu.render(&first.mesh) == Format::Vtu.render(&second.mesh), "{file}: two runs differ");
    let mut failures = Vec::new();
    for (i, map) in MAPS.iter().enumerate() {
        let (other, similarity) = moved(&domain, *map);
        let b = run(&other);
        let found = differences(&first, &b, &similarity, domain.diagonal());
        println!(
            "{file} {i} {}: {} triangles, {} singularities, {} regions, {} layout quads, {} elements{}",
            map.name,
            b.triangles,
            b.outcome.valences.len(),
            b.outcome.regions,
            b.outcome.layout_quads,
            b.mesh.elements.len(),
            if found.is_empty() { "" } else { " ***" }
        );
        failures.extend(found.iter().map(|f| format!("{file} {}: {f}", map.name)));
    }
    let Run { outcome, triangles, mesh } = &first;
    println!("{file} original: {triangles} triangles, {outcome:?}, {} elements", mesh.elements.len());
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn unit_circle() {
    examine("mech/unit-circle.control");
}

#[test]
fn naca_0012() {
    examine("hohq/NACA0012.control");
}

#[test]
fn motor_plate() {
    examine("mech/nema17-plate.control");
}

#[test]
fn letter_in_a_circle() {
    examine("icons/mdi/alpha-d-circle-outline-2.svg");
}

#[test]
fn gingerbread_man() {
    examine("hohq/GingerbreadMan.control");
}
