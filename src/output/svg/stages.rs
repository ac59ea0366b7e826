//! What each stage left behind, drawn in the caller's pose.

use super::canvas::{Canvas, Mark, Stroke};
use super::palette::{valence_color, BOUNDARY, CROSS, FAILURE, LINES, TRIANGLE};
use super::trails::trails;
use super::{colouring, Picture};
use crate::domain::{Boundary, Frame, Span};
use crate::numerics::{Point, Vector, NONE};
use crate::stages::Stages;
use std::collections::BTreeMap;

/// Distance of crosses in SVG units; between them, triangles go without.
const CROSS_SPACING: f64 = 15.0;
/// Radius of marks in SVG units.
const MARK: f64 = 5.5;

/// Whether the run came as far as this picture.
pub fn reached(stages: &Stages, picture: Picture) -> bool {
    match picture {
        Picture::Boundary => stages.boundary.is_some(),
        Picture::Triangles => stages.triangulation.is_some(),
        Picture::Crosses => stages.triangulation.is_some() && stages.cross_field.is_some(),
        Picture::Singularities => {
            stages.triangulation.is_some()
                && stages.cross_field.is_some()
                && (!stages.singularities.is_empty()
                    || !stages.corners.is_empty()
                    || stages.block_layout.is_some())
        }
        Picture::Separatrices => !stages.separatrices.is_empty() || stages.block_layout.is_some(),
        Picture::Regions => stages.block_layout.is_some(),
        Picture::Blocks => stages.quad_layout.is_some(),
    }
}

/// Draws one picture on a canvas `width` wide, if the run came that far; `failure` (in the caller's
/// frame) is circled.
pub fn draw(stages: &Stages, picture: Picture, failure: Option<Point>, width: f64) -> Option<Canvas> {
    if !reached(stages, picture) {
        return None;
    }
    let frame = stages.boundary.as_ref().map_or(Frame::identity(), |b| b.frame);
    let mut drawing = Drawing { stages, frame, canvas: view(stages, &frame, width) };
    match picture {
        Picture::Boundary => drawing.junctions(),
        Picture::Triangles => drawing.triangles(1.0),
        Picture::Crosses => drawing.crosses(),
        Picture::Singularities => drawing.singularities(),
        Picture::Separatrices => drawing.separatrices(),
        Picture::Regions => drawing.regions(),
        Picture::Blocks => drawing.blocks(),
    }
    if let Some(at) = failure {
        drawing.canvas.mark(at, Mark::Ring, 14.0, FAILURE);
    }
    Some(drawing.canvas)
}

/// A canvas around all that the stages have.
fn view(stages: &Stages, frame: &Frame, width: f64) -> Canvas {
    let boundary = stages.boundary.iter().flat_map(|b| &b.chains).flat_map(|c| &c.samples).map(|s| s.point);
    let base = stages.triangulation.iter().flat_map(|t| &t.vertices).map(|v| v.point);
    let layout = stages.block_layout.iter().flat_map(|l| &l.nodes).map(|n| n.point);
    Canvas::around(boundary.chain(base).chain(layout).map(|p| frame.to_caller(p)), width)
}

struct Drawing<'a> {
    stages: &'a Stages,
    frame: Frame,
    canvas: Canvas,
}

impl Drawing<'_> {
    fn to_caller(&self, p: Point) -> Point {
        self.frame.to_caller(p)
    }

    fn boundary(&mut self, width: f64) {
        let (frame, stages) = (self.frame, self.stages);
        self.canvas.lines(Stroke { color: BOUNDARY, width }, |path| {
            for chain in stages.boundary.iter().flat_map(|b| &b.chains) {
                path.polyline(chain.samples.iter().map(|s| frame.to_caller(s.point)));
            }
        });
    }

    fn junctions(&mut self) {
        self.boundary(2.0);
        let stages = self.stages;
        let Some(boundary) = &stages.boundary else { return };
        for junction in &boundary.junctions {
            self.canvas.mark(self.frame.to_caller(junction.point), Mark::Disc, 3.0, LINES[0]);
        }
        self.canvas.caption(format!(
            "boundary: {} loops, {} chains, {} junctions",
            boundary.loops.len(),
            boundary.chains.len(),
            boundary.junctions.len()
        ));
    }

    fn triangles(&mut self, width: f64) {
        let (frame, stages) = (self.frame, self.stages);
        let Some(base) = &stages.triangulation else { return };
        let thin = width * (4.0 / (base.triangles.len() as f64).sqrt().max(1.0) * 10.0).clamp(0.2, 0.9);
        // Each edge once: from the triangle of lower number.
        let mut edges = Vec::with_capacity(2 * base.triangles.len());
        for (t, corners) in base.triangles.iter().enumerate() {
            let own = |i: &usize| base.neighbors[t][*i] == NONE || t < base.neighbors[t][*i] as usize;
            edges.extend((0..3).filter(own).map(|i| [corners[i], corners[(i + 1) % 3]]));
        }
        let point = |v: u32| frame.to_caller(base.vertices[v as usize].point);
        self.canvas.lines(Stroke { color: TRIANGLE, width: thin }, |path| {
            path.coarse();
            for trail in trails(base.vertices.len(), &edges) {
                path.move_to(point(trail[0]));
                trail[1..].iter().for_each(|v| path.line_to(point(*v)));
            }
        });
        self.boundary(1.6);
        self.canvas.caption(format!("base mesh: {} triangles", base.triangles.len()));
    }

    fn crosses(&mut self) {
        let (frame, stages) = (self.frame, self.stages);
        let (Some(base), Some(field)) = (&stages.triangulation, &stages.cross_field) else { return };
        let cell = CROSS_SPACING * self.canvas.unit();
        let arm = 0.42 * cell;
        // In each cell of a grid the cross of the triangle nearest to its middle.
        let mut chosen: BTreeMap<(i64, i64), (f64, Point, f64)> = BTreeMap::new();
        for corners in &base.triangles {
            let sum = |value: &dyn Fn(usize) -> f64| corners.iter().map(|v| value(*v as usize)).sum::<f64>();
            let coordinate = |c: usize| sum(&|v| base.vertices[v].point[c]) / 3.0;
            let at = frame.to_caller(Point::new(coordinate(0), coordinate(1)));
            let u = [0, 1].map(|c| sum(&|v| field.u[v][c]));
            let angle = 0.25 * u[1].atan2(u[0]) + frame.axis.y.atan2(frame.axis.x);
            let seat = [at.x, at.y].map(|x| (x / cell).floor());
            let off = (at.x / cell - seat[0] - 0.5).hypot(at.y / cell - seat[1] - 0.5);
            let place = chosen.entry((seat[0] as i64, seat[1] as i64)).or_insert((off, at, angle));
            if off < place.0 {
                *place = (off, at, angle);
            }
        }
        self.canvas.lines(Stroke { color: CROSS, width: 1.0 }, |path| {
            path.coarse();
            for (_, at, angle) in chosen.into_values() {
                let a = Vector::new(angle.cos(), angle.sin()) * arm;
                let b = Vector::new(-a.y, a.x);
                path.polyline([at - a, at + a]);
                path.polyline([at - b, at + b]);
            }
        });
        self.boundary(1.6);
        self.canvas.caption("cross field");
    }

    fn marks(&mut self) {
        let stages = self.stages;
        if let Some(base) = &stages.triangulation {
            for corner in &stages.corners {
                let at = self.to_caller(base.vertices[corner.vertex as usize].point);
                // n quads at a corner are what n + 2 are around an inner vertex.
                self.canvas.mark(at, Mark::Disc, 0.6 * MARK, valence_color(usize::from(corner.quads) + 2));
            }
        }
        for s in &stages.singularities {
            let at = self.to_caller(s.point);
            let valence = usize::from(s.valence);
            self.canvas.mark(at, Mark::Polygon(valence.max(3)), MARK, valence_color(valence));
        }
    }

    fn singularities(&mut self) {
        self.triangles(0.8);
        self.marks();
        let count = |valence: u8| self.stages.singularities.iter().filter(|s| s.valence == valence).count();
        self.canvas.caption(format!(
            "singularities: {} three-, {} five-valent, {} corners",
            count(3),
            count(5),
            self.stages.corners.len()
        ));
    }

    fn separatrices(&mut self) {
        let (frame, stages) = (self.frame, self.stages);
        self.boundary(1.6);
        for (k, color) in LINES.into_iter().enumerate() {
            self.canvas.lines(Stroke { color, width: 1.3 }, |path| {
                for line in stages.separatrices.iter().skip(k).step_by(LINES.len()) {
                    path.polyline(line.points.iter().map(|p| frame.to_caller(*p)));
                }
            });
        }
        self.marks();
        self.canvas.caption(format!("separatrices: {}", stages.separatrices.len()));
    }

    /// A colour for each region of the T-mesh.
    fn region_fills(&self) -> Vec<&'static str> {
        let Some(layout) = &self.stages.block_layout else { return Vec::new() };
        let mut first_of_arc = vec![None; layout.arcs.len()];
        let mut pairs = Vec::new();
        for (r, region) in layout.regions.iter().enumerate() {
            for side_arc in region.sides.iter().flatten() {
                match first_of_arc.get_mut(side_arc.arc as usize) {
                    Some(Some(other)) => pairs.push((*other, r)),
                    Some(seat) => *seat = Some(r),
                    None => {}
                }
            }
        }
        colouring::fills(layout.regions.len(), pairs.into_iter())
    }

    fn regions(&mut self) {
        let (frame, stages) = (self.frame, self.stages);
        let Some(layout) = &stages.block_layout else { return };
        for (region, fill) in layout.regions.iter().zip(self.region_fills()) {
            self.canvas.area(fill, |path| {
                let mut outline = Vec::new();
                for step in region.sides.iter().flatten() {
                    let points = &layout.arcs[step.arc as usize].points;
                    let mapped = points.iter().map(|p| frame.to_caller(*p));
                    if step.forward {
                        outline.extend(mapped);
                    } else {
                        outline.extend(mapped.rev());
                    }
                }
                path.polyline(outline);
            });
        }
        self.canvas.lines(Stroke { color: "#556", width: 0.9 }, |path| {
            for arc in layout.arcs.iter().filter(|a| a.span.is_none()) {
                path.polyline(arc.points.iter().map(|p| frame.to_caller(*p)));
            }
        });
        self.boundary(1.8);
        self.marks();
        self.canvas.caption(format!("layout: {} regions", layout.regions.len()));
    }

    fn blocks(&mut self) {
        let (frame, stages) = (self.frame, self.stages);
        let Some(layout) = &stages.quad_layout else { return };
        let fills = self.region_fills();
        let unit = self.canvas.unit() / frame.scale;
        let corner = |v: u32| frame.to_caller(layout.vertices[v as usize].point);
        let borders = border_edges(&layout.quads);
        let side = |a: u32, b: u32| -> Vec<Point> {
            let places = [a, b].map(|v| layout.vertices[v as usize].place);
            let on_border = borders.binary_search(&[a, b]).is_ok();
            let span = stages.boundary.as_ref().filter(|_| on_border);
            match span.and_then(|s| Some((s, s.span(places[0], places[1])?))) {
                Some((boundary, span)) => {
                    span_points(boundary, span, unit).into_iter().map(|p| frame.to_caller(p)).collect()
                }
                None => vec![corner(a), corner(b)],
            }
        };
        for (q, quad) in layout.quads.iter().enumerate() {
            let region = layout.region.get(q).map_or(q, |r| *r as usize);
            let fill = fills.get(region).copied().unwrap_or(super::palette::FILLS[region % 8]);
            self.canvas.area(fill, |path| {
                path.polyline((0..4).flat_map(|i| side(quad[i], quad[(i + 1) % 4])));
            });
        }
        self.canvas.lines(Stroke { color: "#556", width: 0.9 }, |path| {
            for quad in &layout.quads {
                for i in 0..4 {
                    let (a, b) = (quad[i], quad[(i + 1) % 4]);
                    if a < b {
                        path.polyline([corner(a), corner(b)]);
                    }
                }
            }
        });
        self.boundary(1.8);
        self.canvas.caption(format!("conforming layout: {} quads", layout.quads.len()));
    }
}

/// Directed edges that have a quad on one side only, sorted.
fn border_edges(quads: &[[u32; 4]]) -> Vec<[u32; 2]> {
    let mut edges: Vec<[u32; 2]> =
        quads.iter().flat_map(|q| (0..4).map(|i| [q[i], q[(i + 1) % 4]])).collect();
    edges.sort_unstable();
    let single = |e: &&[u32; 2]| edges.binary_search(&[e[1], e[0]]).is_err();
    edges.iter().filter(single).copied().collect()
}

/// Points along a piece of boundary, about three SVG units apart; `unit` is one in the canonical frame.
fn span_points(boundary: &Boundary, span: Span, unit: f64) -> Vec<Point> {
    let chain = &boundary.chains[span.chain as usize];
    let length = span.end - span.start;
    let count = (length / (3.0 * unit)).ceil().clamp(1.0, 400.0) as usize;
    (0..=count).map(|k| chain.point(span.start + length * k as f64 / count as f64)).collect()
}
