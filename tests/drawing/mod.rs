//! Layouts drawn by hand: points, regions as lists of sides, the boundary found from them.
#![allow(dead_code)] // not every test file uses all

use quadrel::domain::{Boundary, BoundaryPoint, Chain, Frame, Junction, Place, Sample, Span};
use quadrel::layout::{Arc, BlockLayout, Node, NodeKind, QuadLayout, Region, SideArc};
use quadrel::numerics::{cross, Point, Vector};
use std::collections::BTreeMap;

/// A boundary without any loop yet.
pub fn nowhere() -> Boundary {
    Boundary {
        diagonal: 1.0,
        loop_sources: Vec::new(),
        frame: Frame::identity(),
        names: vec!["wall".into()],
        chains: Vec::new(),
        junctions: Vec::new(),
        loops: Vec::new(),
        area: 0.0,
    }
}

/// Polygonal loops (outer counter-clockwise, holes clockwise) as a boundary; every point is a junction.
pub fn polygons(loops: &[Vec<Point>]) -> Boundary {
    let mut boundary = nowhere();
    for points in loops {
        let n = points.len();
        let chains: Vec<Vec<Point>> = (0..n).map(|i| vec![points[i], points[(i + 1) % n]]).collect();
        add_loop(&mut boundary, &chains);
    }
    boundary
}

/// Adds a loop of chains, each through the points of a polyline; junctions where they meet.
pub fn add_loop(boundary: &mut Boundary, chains: &[Vec<Point>]) {
    let (n, first) = (chains.len() as u32, boundary.junctions.len() as u32);
    let first_chain = boundary.chains.len() as u32;
    let loop_index = boundary.loops.len() as u32;
    boundary.loop_sources.push(loop_index);
    boundary.loops.push((first_chain..first_chain + n).collect());
    for (i, points) in chains.iter().enumerate() {
        let i = i as u32;
        let before = &chains[((i + n - 1) % n) as usize];
        let (u, v) = (before[before.len() - 1] - before[before.len() - 2], points[1] - points[0]);
        let angle = std::f64::consts::PI - cross(u, v).atan2(u.dot(&v));
        let [chain_in, chain_out] = [first_chain + (i + n - 1) % n, first_chain + i];
        boundary.junctions.push(Junction { point: points[0], angle, chain_in, chain_out });
        let mut s = 0.0;
        let mut samples = Vec::new();
        for (k, &point) in points.iter().enumerate() {
            let (a, b) = (points[k.max(1) - 1], points[(k + 1).min(points.len() - 1)]);
            s += if k > 0 { (point - a).norm() } else { 0.0 };
            let t = k as f64 / (points.len() - 1) as f64;
            samples.push(Sample { s, point, tangent: (b - a).normalize(), curvature: 0.0, segment: i, t });
            boundary.area += if k > 0 { cross(a.coords, point.coords) / 2.0 } else { 0.0 };
        }
        let ends = Some([first + i, first + (i + 1) % n]);
        boundary.chains.push(Chain {
            loop_index,
            name: 0,
            ends,
            length: s,
            samples: samples.into(),
            breaks: Vec::new(),
        });
    }
}

/// A closed chain without junctions through the points of a circle (clockwise if `turns` < 0).
pub fn circle(boundary: &mut Boundary, centre: Point, radius: f64, turns: f64) {
    let n = 256;
    let length = std::f64::consts::TAU * radius;
    let samples = (0..=n)
        .map(|i| {
            let x = i as f64 / n as f64;
            let a = turns * std::f64::consts::TAU * x;
            Sample {
                s: x * length,
                point: centre + Vector::new(a.cos(), a.sin()) * radius,
                tangent: Vector::new(-a.sin(), a.cos()) * turns,
                curvature: turns / radius,
                segment: 0,
                t: x,
            }
        })
        .collect();
    let loop_index = boundary.loops.len() as u32;
    boundary.loops.push(vec![boundary.chains.len() as u32]);
    boundary.area += turns * std::f64::consts::PI * radius * radius;
    boundary.chains.push(Chain { loop_index, name: 0, ends: None, length, samples, breaks: Vec::new() });
}

/// Place of a point on the boundary, if it is on it.
fn place(boundary: &Boundary, p: Point) -> Place {
    let near = |q: Point| (q - p).norm() < 1e-9;
    if let Some(j) = boundary.junctions.iter().position(|j| near(j.point)) {
        return Place::Junction(j as u32);
    }
    for (c, chain) in boundary.chains.iter().enumerate() {
        for pair in chain.samples.windows(2) {
            let (a, b) = (pair[0].point, pair[1].point);
            let x = (p - a).dot(&(b - a)) / (b - a).norm_squared();
            if (-1e-9..1.0 - 1e-9).contains(&x) && near(a + (b - a) * x) {
                let s = pair[0].s + x * (pair[1].s - pair[0].s);
                return Place::Boundary(BoundaryPoint { chain: c as u32, s });
            }
        }
    }
    Place::Interior
}

/// The layout whose regions have sides that run through the numbered points; a side's last point is the
/// next side's first and not repeated. `singular`: valences of singular points.
pub fn draw(
    boundary: &Boundary,
    points: &[(f64, f64)],
    regions: &[Vec<Vec<usize>>],
    singular: &[(usize, u8)],
) -> BlockLayout {
    let nodes: Vec<Node> = points
        .iter()
        .enumerate()
        .map(|(i, &(x, y))| {
            let point = Point::new(x, y);
            let place = place(boundary, point);
            let kind = match place {
                Place::Junction(_) => NodeKind::Junction,
                Place::Boundary(_) => NodeKind::Boundary,
                Place::Interior => match singular.iter().find(|s| s.0 == i) {
                    Some(s) => NodeKind::Singularity(s.1),
                    None => NodeKind::Interior,
                },
            };
            Node { point, kind, place }
        })
        .collect();
    let mut arcs: Vec<Arc> = Vec::new();
    let mut known: BTreeMap<[usize; 2], u32> = BTreeMap::new();
    let mut result = Vec::new();
    for region in regions {
        let mut sides = Vec::new();
        for (s, side) in region.iter().enumerate() {
            let mut path = side.clone();
            path.push(region[(s + 1) % region.len()][0]);
            let mut own = Vec::new();
            for pair in path.windows(2) {
                let [a, b] = [pair[0], pair[1]];
                own.push(match known.get(&[b, a]) {
                    Some(&arc) => SideArc { arc, forward: false },
                    None => {
                        let ends = [nodes[a], nodes[b]];
                        let nodes = [a as u32, b as u32];
                        let points = vec![ends[0].point, ends[1].point];
                        known.insert([a, b], arcs.len() as u32);
                        arcs.push(Arc { nodes, points, span: None });
                        SideArc { arc: arcs.len() as u32 - 1, forward: true }
                    }
                });
            }
            sides.push(own);
        }
        result.push(Region { sides });
    }
    for ([a, b], &arc) in &known {
        let alone = !result.iter().flat_map(|r| &r.sides).flatten().any(|s| s.arc == arc && !s.forward);
        if alone {
            let span = boundary.span(nodes[*a].place, nodes[*b].place);
            let arc = &mut arcs[arc as usize];
            arc.span = span;
            if let Some(Span { chain, start, end }) = span {
                let chain = &boundary.chains[chain as usize];
                let n = if chain.samples.len() > 2 { 32 } else { 1 };
                arc.points =
                    (0..=n).map(|i| chain.point(start + (end - start) * i as f64 / n as f64)).collect();
            }
        }
    }
    BlockLayout { nodes, arcs, regions: result }
}

/// Sides of four points each, as most regions have.
pub fn quad(corners: [usize; 4]) -> Vec<Vec<usize>> {
    corners.iter().map(|&c| vec![c]).collect()
}

/// Least cross product at a corner of any quad, divided by the sides' lengths.
pub fn least_corner(layout: &QuadLayout) -> f64 {
    let mut least = f64::INFINITY;
    for quad in &layout.quads {
        for i in 0..4 {
            let p = |k: usize| layout.vertices[quad[(i + k) % 4] as usize].point;
            let (u, v) = (p(1) - p(0), p(3) - p(0));
            least = least.min(cross(u, v) / (u.norm() * v.norm()));
        }
    }
    least
}

/// How many interior vertices have each number of quads.
pub fn valences(layout: &QuadLayout) -> BTreeMap<u32, usize> {
    let mut valence = vec![0; layout.vertices.len()];
    layout.quads.iter().flatten().for_each(|&v| valence[v as usize] += 1);
    let mut count = BTreeMap::new();
    for (v, n) in valence.into_iter().enumerate() {
        if layout.vertices[v].place == Place::Interior {
            *count.entry(n).or_insert(0) += 1;
        }
    }
    count
}

/// A picture of the layout for whoever looks (`QUADREL_PICTURES` names a folder).
pub fn picture(layout: &QuadLayout, name: &str) {
    let Ok(folder) = std::env::var("QUADREL_PICTURES") else { return };
    let mut svg =
        String::from(r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="-0.1 -1.1 1.2 1.2" width="700">"#);
    for (quad, region) in layout.quads.iter().zip(&layout.region) {
        let p: Vec<String> = quad
            .iter()
            .map(|&v| layout.vertices[v as usize].point)
            .map(|p| format!("{:.5},{:.5}", p.x, -p.y))
            .collect();
        let hue = region * 47 % 360;
        svg += &format!(
            r#"<polygon points="{}" fill="hsl({hue},60%,85%)" stroke="black" stroke-width="0.002"/>"#,
            p.join(" ")
        );
    }
    let _ = std::fs::write(format!("{folder}/{name}.svg"), svg + "</svg>");
}
