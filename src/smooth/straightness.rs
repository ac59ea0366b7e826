//! Which edges are straight and stay so: elements that have no others are cheap.

use crate::domain::{Boundary, Chain, Place};
use crate::mesh::QuadMesh;
use crate::numerics::tolerances::{FLAT_CORNER, STRAIGHT_CHAIN};
use crate::numerics::{Vector, NONE};
use std::borrow::Cow;

/// Chains of a boundary that are straight, and whether interior edges away from all others stay straight.
#[derive(Debug, Clone)]
pub(super) struct Straightness<'a> {
    chains: Cow<'a, [bool]>,
    /// Interior edges may bend everywhere, not beside curved boundaries only.
    everywhere: bool,
}

impl Straightness<'static> {
    /// For meshes of the domain of `boundary`; interior edges bend beside curved boundaries only.
    pub fn new(boundary: &Boundary) -> Self {
        Straightness { chains: boundary.chains.iter().map(is_straight).collect(), everywhere: false }
    }
}

impl Straightness<'_> {
    /// The same with interior edges that may bend everywhere.
    pub fn everywhere(&self) -> Straightness<'_> {
        Straightness { chains: Cow::Borrowed(&self.chains), everywhere: true }
    }

    /// Whether an edge is straight and stays so.
    pub fn holds(&self, mesh: &QuadMesh, edge: u32) -> bool {
        let own = &mesh.edges[edge as usize];
        let beside = |q: &u32| *q != NONE && self.beside_curve(mesh, *q);
        let may_bend = || {
            own.span.is_none()
                && (self.everywhere || own.quads.iter().any(beside) || self.continues_boundary(mesh, edge))
        };
        self.holds_now(mesh, edge) && !may_bend()
    }

    /// Whether a quad has a side or a corner on a curved boundary.
    fn beside_curve(&self, mesh: &QuadMesh, quad: u32) -> bool {
        let curved = |e: u32| mesh.edges[e as usize].span.is_some_and(|s| !self.chains[s.chain as usize]);
        let on_curve = |v: u32| match mesh.vertices[v as usize].place {
            Place::Boundary(p) => !self.chains[p.chain as usize],
            _ => false,
        };
        mesh.quad_edges[quad as usize].into_iter().any(curved)
            || mesh.quads[quad as usize].into_iter().any(on_curve)
    }

    /// Whether an edge joins two junctions, so that nothing moves it, and is in one line with a straight boundary edge of
    /// the same quad: that has no angle there unless the edge bends.
    fn continues_boundary(&self, mesh: &QuadMesh, edge: u32) -> bool {
        let own = &mesh.edges[edge as usize];
        let fixed = |v: &u32| matches!(mesh.vertices[*v as usize].place, Place::Junction(_));
        if !own.vertices.iter().all(fixed) {
            return false;
        }
        own.quads.into_iter().filter(|q| *q != NONE).any(|q| {
            let (quad, sides) = (mesh.quads[q as usize], mesh.quad_edges[q as usize]);
            let side = (0..4).find(|s| sides[*s] == edge).unwrap_or(0);
            // At the corner where the side starts, and where it ends.
            [(side, (side + 3) % 4), ((side + 1) % 4, (side + 1) % 4)].into_iter().any(|(corner, beside)| {
                let along = mesh.edges[sides[beside] as usize].span;
                let [before, at, after] =
                    [3, 0, 1].map(|k| mesh.vertices[quad[(corner + k) % 4] as usize].point);
                let (to, from) = (after - at, before - at);
                along.is_some_and(|span| self.chains[span.chain as usize])
                    && to.perp(&from) <= FLAT_CORNER * to.norm() * from.norm()
            })
        })
    }

    /// Whether an edge is straight now.
    pub fn holds_now(&self, mesh: &QuadMesh, edge: u32) -> bool {
        let edge = &mesh.edges[edge as usize];
        match edge.span {
            Some(span) => self.chains[span.chain as usize],
            None => edge.bubbles.iter().all(|b| *b == Vector::zeros()),
        }
    }
}

/// Whether no point of the chain's table leaves the segment between its ends.
fn is_straight(chain: &Chain) -> bool {
    let [first, last] = [&chain.samples[0], &chain.samples[chain.samples.len() - 1]];
    let along = last.point - first.point;
    let length = along.norm();
    // A chain that returns to its start has no such segment. Tangents too: a cubic between two points of the table
    // may bulge.
    length > 0.5 * chain.length
        && chain.samples.iter().all(|s| {
            (s.point - first.point).perp(&along).abs() <= STRAIGHT_CHAIN * length * length
                && s.tangent.perp(&along).abs() <= STRAIGHT_CHAIN * length
        })
}
