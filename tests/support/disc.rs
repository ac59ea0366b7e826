//! The unit disc, moved and turned, through all stages by hand: five blocks, four three-valent points.

use super::grid::assemble;
use quadrel::base_mesh::{BaseVertex, Triangulation};
use quadrel::cross_field::{CrossField, TriangleCross};
use quadrel::domain::{Boundary, BoundaryPoint, Chain, Frame, Place, Sample};
use quadrel::layout::{Arc, BlockLayout, LayoutVertex, Node, NodeKind, QuadLayout, Region, SideArc};
use quadrel::mesh::HighOrderMesh;
use quadrel::numerics::{Point, Vector, NONE};
use quadrel::progress::Stage;
use quadrel::separatrices::{Separatrix, TraceEnd};
use quadrel::singularities::Singularity;
use quadrel::stages::{Round, Stages};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// Radius in the canonical frame, where the diagonal is 1, and of the inner block's corners.
const RADIUS: f64 = 0.353_553_390_593_273_8;
const INNER: f64 = 0.2;
const RINGS: usize = 14;
const SECTORS: usize = 72;

fn polar(radius: f64, angle: f64) -> Point {
    Point::new(radius * angle.cos(), radius * angle.sin())
}

fn frame() -> Frame {
    Frame { origin: Point::new(3.0, 1.0), scale: 2.0, axis: Vector::new(0.8, 0.6) }
}

/// Angle of the k-th corner of the inner block.
fn diagonal(k: usize) -> f64 {
    FRAC_PI_4 + k as f64 * FRAC_PI_2
}

pub fn mesh(order: usize) -> HighOrderMesh {
    let frame = frame();
    let corner = |k: usize, outer: bool| polar(if outer { RADIUS } else { INNER }, diagonal(k % 4));
    let vertices = (0..8).map(|v| frame.to_caller(corner(v % 4, v >= 4))).collect();
    let mut elements = vec![[0, 1, 2, 3]];
    elements.extend((0..4).map(|k| [k, k + 4, (k + 1) % 4 + 4, (k + 1) % 4]));
    assemble(
        order,
        vertices,
        elements,
        |_, _| 0,
        |e, a, b| {
            let p = if e == 0 {
                let mix = |f: fn(&Point) -> f64| {
                    (1.0 - a) * (1.0 - b) * f(&corner(0, false))
                        + a * (1.0 - b) * f(&corner(1, false))
                        + a * b * f(&corner(2, false))
                        + (1.0 - a) * b * f(&corner(3, false))
                };
                Point::new(mix(|p| p.x), mix(|p| p.y))
            } else {
                let (from, to) = (corner(e - 1, false), corner(e, false));
                let inner = from + (to - from) * b;
                let outer = polar(RADIUS, diagonal(e - 1) + b * FRAC_PI_2);
                inner + (outer - inner) * a
            };
            frame.to_caller(p)
        },
    )
}

fn boundary() -> Boundary {
    let length = TAU * RADIUS;
    let count = 256;
    let sample = |k: usize| {
        let t = k as f64 / count as f64;
        Sample {
            s: t * length,
            point: polar(RADIUS, t * TAU),
            tangent: Vector::new(-(t * TAU).sin(), (t * TAU).cos()),
            curvature: 1.0 / RADIUS,
            segment: 0,
            t,
        }
    };
    Boundary {
        frame: frame(),
        names: vec!["circle".into()],
        chains: vec![Chain {
            loop_index: 0,
            name: 0,
            ends: None,
            length,
            samples: (0..=count).map(sample).collect(),
            breaks: vec![],
        }],
        junctions: vec![],
        loops: vec![vec![0]],
        area: PI * RADIUS * RADIUS,
        loop_sources: vec![0],
        diagonal: 1.0,
    }
}

fn triangulation() -> Triangulation {
    let at = |ring: usize, sector: usize| 1 + ((ring - 1) * SECTORS + sector % SECTORS) as u32;
    let mut vertices = vec![BaseVertex { point: Point::origin(), place: Place::Interior }];
    for ring in 1..=RINGS {
        for sector in 0..SECTORS {
            let angle = sector as f64 / SECTORS as f64 * TAU;
            let place = match ring {
                RINGS => Place::Boundary(BoundaryPoint { chain: 0, s: RADIUS * angle }),
                _ => Place::Interior,
            };
            let point = polar(RADIUS * ring as f64 / RINGS as f64, angle);
            vertices.push(BaseVertex { point, place });
        }
    }
    let mut triangles = Vec::new();
    for k in 0..SECTORS {
        triangles.push([0, at(1, k), at(1, k + 1)]);
        for r in 1..RINGS {
            triangles.push([at(r, k), at(r + 1, k), at(r + 1, k + 1)]);
            triangles.push([at(r, k), at(r + 1, k + 1), at(r, k + 1)]);
        }
    }
    let mut owner = std::collections::BTreeMap::new();
    for (t, c) in triangles.iter().enumerate() {
        for i in 0..3 {
            owner.insert((c[i], c[(i + 1) % 3]), t as u32);
        }
    }
    let across = |a: u32, b: u32| owner.get(&(b, a)).copied().unwrap_or(NONE);
    let neighbors = triangles.iter().map(|c| [across(c[0], c[1]), across(c[1], c[2]), across(c[2], c[0])]);
    Triangulation {
        neighbors: neighbors.collect(),
        vertices,
        triangles,
        loops: vec![(0..SECTORS).map(|k| at(RINGS, k)).collect()],
    }
}

/// u = z⁴ − a⁴ over its value's size, which has simple zeros at the inner block's corners.
fn cross_field(base: &Triangulation) -> CrossField {
    let u = |p: Point| {
        let (r, angle) = (p.coords.norm(), p.y.atan2(p.x));
        let (re, im) = (r.powi(4) * (4.0 * angle).cos() + INNER.powi(4), r.powi(4) * (4.0 * angle).sin());
        [re / re.hypot(im).max(1e-12), im / re.hypot(im).max(1e-12)]
    };
    CrossField {
        u: base.vertices.iter().map(|v| u(v.point)).collect(),
        triangles: vec![
            TriangleCross { start: 0.0, edge_turn: [0.0; 3], corner_turn: [0.0; 3], winding: 0 };
            base.triangles.len()
        ],
        quads_at: vec![0; base.vertices.len()],
        border_angle: vec![0.0; base.vertices.len()],
    }
}

fn block_layout() -> BlockLayout {
    let interior =
        |k| Node { point: polar(INNER, diagonal(k)), kind: NodeKind::Singularity(3), place: Place::Interior };
    let border = |k| Node {
        point: polar(RADIUS, diagonal(k)),
        kind: NodeKind::Boundary,
        place: Place::Boundary(BoundaryPoint { chain: 0, s: RADIUS * diagonal(k) }),
    };
    let nodes: Vec<Node> = (0..4).map(interior).chain((0..4).map(border)).collect();
    let straight = |a: usize, b: usize| Arc {
        nodes: [a as u32, b as u32],
        points: vec![nodes[a].point, nodes[b].point],
        span: None,
    };
    let mut arcs: Vec<Arc> = (0..4).map(|k| straight(k, (k + 1) % 4)).collect();
    arcs.extend((0..4).map(|k| straight(k, k + 4)));
    let boundary = boundary();
    for k in 0..4 {
        let span = boundary.span(nodes[k + 4].place, nodes[(k + 1) % 4 + 4].place);
        let points = (0..=24).map(|i| polar(RADIUS, diagonal(k) + i as f64 / 24.0 * FRAC_PI_2)).collect();
        arcs.push(Arc { nodes: [k as u32 + 4, (k as u32 + 1) % 4 + 4], points, span });
    }
    let side = |arc: usize, forward: bool| vec![SideArc { arc: arc as u32, forward }];
    let mut regions = vec![Region { sides: (0..4).map(|k| side(k, true)).collect() }];
    for k in 0..4 {
        let sides = vec![side(4 + k, true), side(8 + k, true), side(4 + (k + 1) % 4, false), side(k, false)];
        regions.push(Region { sides });
    }
    BlockLayout { nodes, arcs, regions }
}

pub fn stages() -> Stages {
    let base = triangulation();
    let layout = block_layout();
    let singularities = (0..4)
        .map(|k| Singularity {
            triangle: 0,
            point: layout.nodes[k].point,
            valence: 3,
            ports: vec![(0, 0.5), (1, 0.5), (2, 0.5)],
        })
        .collect();
    let separatrices = layout.arcs[..8]
        .iter()
        .map(|arc| Separatrix {
            from: TraceEnd::Singularity { singularity: arc.nodes[0], port: 0 },
            to: TraceEnd::Separatrix { on: 0 },
            points: arc.points.clone(),
            stops: vec![],
        })
        .collect();
    let mut quads = vec![[0, 1, 2, 3]];
    quads.extend((0..4).map(|k| [k, k + 4, (k + 1) % 4 + 4, (k + 1) % 4]));
    Stages {
        boundary: Some(boundary().into()),
        cross_field: Some(cross_field(&base).into()),
        triangulation: Some(base.into()),
        singularities,
        separatrices,
        quad_layout: Some(QuadLayout {
            vertices: layout.nodes.iter().map(|n| LayoutVertex { point: n.point, place: n.place }).collect(),
            quads,
            region: (0..5).collect(),
        }),
        block_layout: Some(layout),
        rounds: vec![Round { action: "layout", elements: 5, scaled_jacobian: 0.7, boundary_error: 0.5 }],
        reached: Some(Stage::Mesh),
        ..Stages::default()
    }
}
