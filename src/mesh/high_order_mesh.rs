//! From the [`QuadMesh`] to the finished [`HighOrderMesh`]: exact boundary nodes, and every promise
//! verified.

use super::{
    BoundaryError, BoundaryTolerance, DomainCurve, Edge, ExactCurve, Geometry, HighOrderMesh, JacobianProof,
    MeshEdge, QuadMesh, Quality, Verdict, Vertex,
};
use crate::domain::{Boundary, BoundaryPoint, Domain, Frame, Place};
use crate::error::{Error, Result};
use crate::mesh::boundary_error::breaks_within;
use crate::numerics::{Point, Vector, NONE};

/// A canonical displacement in the caller's frame.
fn vector_to_caller(frame: &Frame, v: Vector) -> Vector {
    Vector::new(v.x * frame.axis.x - v.y * frame.axis.y, v.x * frame.axis.y + v.y * frame.axis.x)
        * frame.scale
}

impl HighOrderMesh {
    /// The finished mesh of `domain` from `mesh`, proven: see [`HighOrderMesh::with_curve`].
    ///
    /// # Errors
    /// As [`HighOrderMesh::with_curve`]; [`Error::Callback`] from a caller's curve.
    pub fn new(
        mesh: &QuadMesh,
        boundary: &Boundary,
        domain: &Domain,
        tolerance: &BoundaryTolerance,
    ) -> Result<HighOrderMesh> {
        Self::with_curve(mesh, boundary, &DomainCurve { boundary, domain }, tolerance)
    }

    /// Makes the order-N mesh of `mesh` in the caller's frame, with boundary nodes on `curve`, and
    /// proves it: conforming, every Jacobian positive, every boundary edge within `tolerance`
    /// (canonical; its order is the mesh's).
    ///
    /// # Errors
    /// [`Error::Layout`] when `mesh` is no conforming mesh of the domain, [`Error::InvalidElement`],
    /// [`Error::Tolerance`], each with its place in the caller's frame, and what `curve` reports.
    pub fn with_curve(
        mesh: &QuadMesh,
        boundary: &Boundary,
        curve: &dyn ExactCurve,
        tolerance: &BoundaryTolerance,
    ) -> Result<HighOrderMesh> {
        let frame = &boundary.frame;
        mesh.check(boundary)
            .map_err(|(reason, at)| Error::Layout { reason, at: Some(frame.to_caller(at)) })?;
        let geometry = Geometry::new(tolerance.order);
        let vertices = exact_vertices(mesh, boundary, curve)?;
        let edge_nodes = exact_edge_nodes(mesh, boundary, curve, &geometry, &vertices)?;
        let error = BoundaryError::new(tolerance.in_caller_frame(frame));
        let edges = measured_edges(mesh, boundary, curve, &error, &edge_nodes)?;
        let mut result = HighOrderMesh {
            order: tolerance.order,
            reference_nodes: geometry.reference.clone(),
            vertices,
            elements: mesh.quads.clone(),
            nodes: Vec::with_capacity(mesh.quads.len() * geometry.edge_len().pow(2)),
            blocks: mesh.region.clone(),
            edges,
            element_edges: mesh.quad_edges.clone(),
            boundary_names: boundary.names.clone(),
            scaled_jacobian: Vec::with_capacity(mesh.quads.len()),
        };
        let mut proof = JacobianProof::new(tolerance.order);
        let quality = Quality::new(tolerance.order);
        let mut nodes = Vec::new();
        for q in 0..mesh.quads.len() {
            geometry.element_nodes(mesh, &edge_nodes, q, &mut nodes);
            let scaled_jacobian = quality.scaled_jacobian(&nodes);
            match proof.examine(&nodes) {
                Verdict::Proven(_) => {}
                Verdict::Negative { at, .. } | Verdict::Undecided { at } => {
                    let at = quality.point(&nodes, at);
                    return Err(Error::InvalidElement { jacobian: scaled_jacobian, at });
                }
            }
            result.scaled_jacobian.push(scaled_jacobian);
            result.nodes.extend_from_slice(&nodes);
        }
        Ok(result)
    }

    /// The (N + 1)² nodes of element `e`, `[j][i]`.
    pub fn element_nodes(&self, e: usize) -> &[Point] {
        let size = (self.order + 1).pow(2);
        &self.nodes[e * size..(e + 1) * size]
    }

    /// Node `k` (0 to N) of side `side` of element `e`, counter-clockwise.
    pub fn side_node(&self, e: usize, side: usize, k: usize) -> Point {
        let n = self.order;
        let (i, j) = match side {
            0 => (k, 0),
            1 => (n, k),
            2 => (n - k, n),
            _ => (0, n - k),
        };
        self.element_nodes(e)[j * (n + 1) + i]
    }

    /// Checks the mesh's invariants by itself: sizes and indices agree, both elements of an edge have the
    /// same bits on it, corners are the vertices, and every Jacobian is proven positive.
    pub fn check(&self) -> std::result::Result<(), (String, Point)> {
        let (n, count) = (self.order, self.elements.len());
        let sizes = [self.element_edges.len(), self.blocks.len(), self.scaled_jacobian.len()];
        if n == 0
            || self.reference_nodes.len() != n + 1
            || self.nodes.len() != count * (n + 1).pow(2)
            || sizes.iter().any(|s| *s != count)
        {
            return Err(("the arrays' sizes do not agree".into(), Point::origin()));
        }
        let mut proof = JacobianProof::new(n);
        for (e, (element, sides)) in self.elements.iter().zip(&self.element_edges).enumerate() {
            for s in 0..4 {
                let (a, b) = (element[s], element[(s + 1) % 4]);
                let (Some(vertex), Some(edge)) =
                    (self.vertices.get(a as usize), self.edges.get(sides[s] as usize))
                else {
                    return Err((format!("element {e} has an index out of range"), Point::origin()));
                };
                if self.side_node(e, s, 0) != *vertex {
                    return Err((format!("corner {s} of element {e} is not its vertex"), *vertex));
                }
                let right = edge.vertices == [b, a];
                let own = edge.elements[usize::from(right)] == e as u32;
                if !own || !right && edge.vertices != [a, b] {
                    return Err((format!("side {s} of element {e} and its edge disagree"), *vertex));
                }
                let other = edge.elements[usize::from(!right)];
                if other == NONE {
                    continue;
                }
                let place =
                    self.element_edges.get(other as usize).map(|o| o.iter().position(|x| x == &sides[s]));
                let Some(Some(t)) = place else {
                    return Err((format!("element {e} and its neighbour disagree"), *vertex));
                };
                let same = (0..=n).all(|k| {
                    let (p, q) = (self.side_node(e, s, k), self.side_node(other as usize, t, n - k));
                    p.x.to_bits() == q.x.to_bits() && p.y.to_bits() == q.y.to_bits()
                });
                if !same {
                    return Err((format!("elements {e} and {other} do not match"), *vertex));
                }
            }
            if !matches!(proof.examine(self.element_nodes(e)), Verdict::Proven(_)) {
                return Err((format!("element {e} is not proven valid"), self.side_node(e, 0, 0)));
            }
        }
        Ok(())
    }

    /// Largest boundary error of an edge on each loop, in the caller's unit.
    pub fn boundary_errors(&self) -> Vec<f64> {
        let border = || self.edges.iter().filter(|e| e.elements[1] == NONE);
        let loops = border().map(|e| e.loop_index as usize + 1).max().unwrap_or(0);
        let mut errors = vec![0.0f64; loops];
        for edge in border() {
            let slot = &mut errors[edge.loop_index as usize];
            *slot = slot.max(edge.error);
        }
        errors
    }
}

fn exact_vertices(mesh: &QuadMesh, boundary: &Boundary, curve: &dyn ExactCurve) -> Result<Vec<Point>> {
    mesh.vertices.iter().map(|v| exact_vertex(v, boundary, curve)).collect()
}

/// A vertex in the caller's frame.
pub(super) fn exact_vertex(vertex: &Vertex, boundary: &Boundary, curve: &dyn ExactCurve) -> Result<Point> {
    match vertex.place {
        Place::Interior => Ok(boundary.frame.to_caller(vertex.point)),
        Place::Boundary(p) => curve.point(p),
        Place::Junction(j) => {
            let chain = boundary.junctions[j as usize].chain_out;
            curve.point(BoundaryPoint { chain, s: 0.0 })
        }
    }
}

/// Nodes of all edges in the caller's frame, ends exactly the vertices.
fn exact_edge_nodes(
    mesh: &QuadMesh,
    boundary: &Boundary,
    curve: &dyn ExactCurve,
    geometry: &Geometry,
    vertices: &[Point],
) -> Result<Vec<Point>> {
    let len = geometry.edge_len();
    let mut nodes = vec![Point::origin(); len * mesh.edges.len()];
    for (edge, out) in mesh.edges.iter().zip(nodes.chunks_exact_mut(len)) {
        let ends = edge.vertices.map(|v| vertices[v as usize]);
        exact_nodes(edge, ends, boundary, curve, geometry, out)?;
    }
    Ok(nodes)
}

/// Nodes of one edge between `ends`, written to `out`.
pub(super) fn exact_nodes(
    edge: &Edge,
    ends: [Point; 2],
    boundary: &Boundary,
    curve: &dyn ExactCurve,
    geometry: &Geometry,
    out: &mut [Point],
) -> Result<()> {
    let ([a, b], last) = (ends, out.len() - 1);
    (out[0], out[last]) = (a, b);
    for (i, node) in out.iter_mut().enumerate().take(last).skip(1) {
        let share = 0.5 * (1.0 + geometry.reference[i]);
        *node = match edge.span {
            Some(span) => {
                let s =
                    boundary.chains[span.chain as usize].wrap(span.start + share * (span.end - span.start));
                curve.point(BoundaryPoint { chain: span.chain, s })?
            }
            None => a + (b - a) * share + vector_to_caller(&boundary.frame, geometry.bubble_offset(edge, i)),
        };
    }
    Ok(())
}

/// The edges of the finished mesh; boundary edges measured against the exact curve.
fn measured_edges(
    mesh: &QuadMesh,
    boundary: &Boundary,
    curve: &dyn ExactCurve,
    error: &BoundaryError,
    edge_nodes: &[Point],
) -> Result<Vec<MeshEdge>> {
    let len = error.reference_nodes().len();
    let mut edges = Vec::with_capacity(mesh.edges.len());
    for (edge, nodes) in mesh.edges.iter().zip(edge_nodes.chunks_exact(len)) {
        let mut result = MeshEdge {
            vertices: edge.vertices,
            elements: edge.quads,
            boundary: NONE,
            loop_index: NONE,
            segments: [NONE; 2],
            parameters: [0.0; 2],
            error: 0.0,
        };
        if let Some(span) = edge.span {
            let chain = &boundary.chains[span.chain as usize];
            let at = |s: f64| BoundaryPoint { chain: span.chain, s: chain.wrap(s) };
            let ends = [curve.place(at(span.start), false)?, curve.place(at(span.end), true)?];
            result.boundary = chain.name;
            result.loop_index = ends[0].loop_index;
            result.segments = ends.map(|e| e.segment);
            result.parameters = ends.map(|e| e.t);
            result.error = exact_error(boundary, curve, error, span, nodes)?;
            if result.error > error.tolerance.value || result.error.is_nan() {
                let at = nodes[len / 2];
                return Err(Error::Tolerance { error: result.error, tolerance: error.tolerance.value, at });
            }
        }
        edges.push(result);
    }
    Ok(edges)
}

/// Most times the quadrature is refined while its answer still changes.
const REFINEMENTS: usize = 5;
/// Change between two quadratures that is taken as agreement.
const AGREEMENT: f64 = 0.01;
/// An error below this share of the tolerance needs no second quadrature.
const CLEARLY_BELOW: f64 = 0.25;

/// Error of an edge against the exact curve; the pieces are halved until two quadratures agree, for
/// curves that are less smooth than their breaks tell.
fn exact_error(
    boundary: &Boundary,
    curve: &dyn ExactCurve,
    error: &BoundaryError,
    span: crate::domain::Span,
    nodes: &[Point],
) -> Result<f64> {
    let chain = &boundary.chains[span.chain as usize];
    // Arc lengths in the caller's unit, measured from the edge's start.
    let scale = boundary.frame.scale;
    let length = (span.end - span.start) * scale;
    let mut breaks = Vec::new();
    breaks_within(chain, span.start, span.end, &mut breaks);
    breaks.iter_mut().for_each(|b| *b *= scale);
    let at = |s: f64| {
        let s = chain.wrap(span.start + s / scale);
        let tangent = vector_to_caller(&boundary.frame, chain.evaluate(s).1) / scale;
        Ok::<_, Error>((curve.point(BoundaryPoint { chain: span.chain, s })?, tangent))
    };
    let mut last = error.measure(nodes, length, &breaks, at)?;
    for _ in 0..REFINEMENTS {
        if last <= CLEARLY_BELOW * error.tolerance.value {
            break;
        }
        let ends: Vec<f64> = std::iter::once(0.0).chain(breaks.iter().copied()).chain([length]).collect();
        breaks.clear();
        for pair in ends.windows(2) {
            breaks.extend([pair[0], 0.5 * (pair[0] + pair[1])]);
        }
        breaks.remove(0);
        let next = error.measure(nodes, length, &breaks, at)?;
        let change = (next - last).abs();
        last = last.max(next);
        if change <= AGREEMENT * last {
            break;
        }
    }
    Ok(last)
}
