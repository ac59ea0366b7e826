//! From separatrices to the T-mesh, combinatorially.
//!
//! Each node knows the counter-clockwise order of its arcs and how many quarter turns of the cross lie
//! between neighbours; regions are the cycles of the arcs, their corners the places with one
//! quarter turn (or none: the tip of a corner below 45°). Geometry is not asked.

use super::{Arc, BlockLayout, Node, NodeKind, Region, SideArc};
use crate::domain::{Boundary, BoundaryPoint, Place};
use crate::error::{Error, Result};
use crate::numerics::{Point, NONE};
use crate::separatrices::{Separatrix, TraceEnd};
use crate::singularities::{CornerFan, Singularity};

/// Sector outside the domain.
const OUTSIDE: u8 = u8::MAX;

/// An arc leaving a node, and the quarter turns from it to the next arc counter-clockwise.
#[derive(Clone, Copy)]
struct Spoke {
    arc: SideArc,
    sector: u8,
}

/// What became of the separatrices.
#[derive(Debug, Clone, PartialEq)]
pub enum Traced {
    /// A T-mesh.
    Layout(BlockLayout),
    /// Regions with two tips: a separatrix from each of these boundary points would divide them.
    Seeds(Vec<BoundaryPoint>),
}

/// Place of a node along its loop: chain, arc length, then the base mesh's finer order.
type LoopKey = (usize, f64, u32, f64);

struct Builder<'a> {
    boundary: &'a Boundary,
    layout: BlockLayout,
    /// Counter-clockwise spokes of each node; of border nodes first the outgoing border arc.
    spokes: Vec<Vec<Spoke>>,
    /// Nodes along each loop.
    border: Vec<Vec<(LoopKey, u32)>>,
    /// Loop of each chain and its place in it.
    chain_position: Vec<(usize, usize)>,
}

impl Builder<'_> {
    fn node(&mut self, point: Point, kind: NodeKind, place: Place) -> u32 {
        self.layout.nodes.push(Node { point, kind, place });
        self.spokes.push(Vec::new());
        self.layout.nodes.len() as u32 - 1
    }

    fn border_node(&mut self, end: TraceEnd, point: Point) -> Result<u32> {
        let TraceEnd::Border { edge, share, place: place @ Place::Boundary(at), .. } = end else {
            return Err(Error::Layout {
                reason: "a separatrix ends off the boundary".into(),
                at: Some(point),
            });
        };
        let (l, position) = self.chain_position[at.chain as usize];
        let node = self.node(point, NodeKind::Boundary, place);
        self.border[l].push(((position, at.s, edge, share), node));
        Ok(node)
    }
}

/// Builds the T-mesh of `separatrices`.
///
/// # Errors
/// [`Error::Layout`] with the place, if a region is none (never with an order-preserving trace).
pub fn build(
    boundary: &Boundary,
    singularities: &[Singularity],
    corners: &[CornerFan],
    separatrices: &[Separatrix],
) -> Result<Traced> {
    let mut chain_position = vec![(0, 0); boundary.chains.len()];
    for (l, chains) in boundary.loops.iter().enumerate() {
        chains.iter().enumerate().for_each(|(i, c)| chain_position[*c as usize] = (l, i));
    }
    let mut b = Builder {
        boundary,
        layout: BlockLayout::default(),
        spokes: Vec::new(),
        border: vec![Vec::new(); boundary.loops.len()],
        chain_position,
    };
    for s in singularities {
        b.node(s.point, NodeKind::Singularity(s.valence), Place::Interior);
    }
    let first_junction = b.layout.nodes.len() as u32;
    for (j, junction) in boundary.junctions.iter().enumerate() {
        let node = b.node(junction.point, NodeKind::Junction, Place::Junction(j as u32));
        let (l, position) = b.chain_position[junction.chain_out as usize];
        b.border[l].push(((position, -1.0, 0, 0.0), node));
    }
    // End nodes of the separatrices.
    let mut ends = Vec::with_capacity(separatrices.len());
    for s in separatrices {
        let point = s.points[s.points.len() - 1];
        let from = match s.from {
            TraceEnd::Singularity { singularity, .. } => singularity,
            TraceEnd::Corner { corner, .. } => first_junction + corners[corner as usize].junction,
            end => b.border_node(end, s.points[0])?,
        };
        let to = match s.to {
            TraceEnd::Separatrix { .. } => b.node(point, NodeKind::Interior, Place::Interior),
            end => b.border_node(end, point)?,
        };
        ends.push([from, to]);
    }

    // Arcs along the separatrices; spokes at their ends are known later, so keep first and last.
    let mut first_last = Vec::with_capacity(separatrices.len());
    let mut beside: Vec<[SideArc; 2]> = Vec::new();
    let mut beside_of = vec![NONE; b.layout.nodes.len()];
    for (i, s) in separatrices.iter().enumerate() {
        let first = b.layout.arcs.len() as u32;
        let mut start = (ends[i][0], 0usize, s.points[0]);
        let last_point = s.points.len() - 1;
        let stops =
            s.stops.iter().map(|stop| (ends[stop.stem as usize][1], stop.segment as usize, stop.point));
        for (node, segment, point) in stops.chain([(ends[i][1], last_point, s.points[last_point])]) {
            let mut points = Vec::with_capacity(segment.saturating_sub(start.1) + 2);
            points.push(start.2);
            points.extend_from_slice(s.points.get(start.1 + 1..=segment).unwrap_or(&[]));
            if points.last() != Some(&point) || points.len() == 1 {
                points.push(point);
            }
            let arc = b.layout.arcs.len() as u32;
            b.layout.arcs.push(Arc { nodes: [start.0, node], points, span: None });
            if node != ends[i][1] {
                beside_of[node as usize] = beside.len() as u32;
                beside.push([SideArc { arc: arc + 1, forward: true }, SideArc { arc, forward: false }]);
            }
            start = (node, segment, point);
        }
        let last = b.layout.arcs.len() as u32 - 1;
        first_last.push([SideArc { arc: first, forward: true }, SideArc { arc: last, forward: false }]);
    }

    // Spokes: interior ones first, border arcs around them below.
    let mut rays = vec![Vec::new(); b.layout.nodes.len()];
    for (i, s) in separatrices.iter().enumerate() {
        let order = match s.from {
            TraceEnd::Singularity { port, .. } => port,
            TraceEnd::Corner { ray, .. } => ray,
            _ => 0,
        };
        rays[ends[i][0] as usize].push((order, first_last[i][0]));
        if !matches!(s.to, TraceEnd::Separatrix { .. }) {
            rays[ends[i][1] as usize].push((0, first_last[i][1]));
        }
    }
    for list in &mut rays {
        list.sort_by_key(|r| r.0);
    }
    for (n, list) in rays.iter().enumerate().take(singularities.len()) {
        b.spokes[n] = list.iter().map(|&(_, arc)| Spoke { arc, sector: 1 }).collect();
    }
    for s in separatrices {
        for stop in &s.stops {
            let node = ends[stop.stem as usize][1] as usize;
            let [forward, back] = beside[beside_of[node] as usize];
            let stem = first_last[stop.stem as usize][1];
            b.spokes[node] = if stop.left {
                vec![
                    Spoke { arc: forward, sector: 1 },
                    Spoke { arc: stem, sector: 1 },
                    Spoke { arc: back, sector: 2 },
                ]
            } else {
                vec![
                    Spoke { arc: forward, sector: 2 },
                    Spoke { arc: back, sector: 1 },
                    Spoke { arc: stem, sector: 1 },
                ]
            };
        }
    }
    let mut quads_at = vec![2u8; b.layout.nodes.len()];
    for c in corners {
        quads_at[(first_junction + c.junction) as usize] = c.quads;
    }
    let outside = add_border_arcs(&mut b, &rays, &quads_at)?;
    regions(b, &outside)
}

/// Arcs along the loops, and the spokes of the border's nodes. Returns which directed arcs have the
/// domain to their right.
fn add_border_arcs(b: &mut Builder, rays: &[Vec<(u8, SideArc)>], quads_at: &[u8]) -> Result<Vec<bool>> {
    let mut outside = vec![false; 2 * b.layout.arcs.len()];
    for l in 0..b.border.len() {
        let mut nodes = std::mem::take(&mut b.border[l]);
        nodes.sort_by(|(x, i), (y, j)| {
            (x.0.cmp(&y.0))
                .then(x.1.total_cmp(&y.1))
                .then(x.2.cmp(&y.2))
                .then(x.3.total_cmp(&y.3))
                .then(i.cmp(j))
        });
        let n = nodes.len();
        let first = b.layout.arcs.len() as u32;
        for k in 0..n {
            let (from, to) = (nodes[k].1, nodes[(k + 1) % n].1);
            let [p, q] = [from, to].map(|x| b.layout.nodes[x as usize].place);
            let here = b.layout.nodes[from as usize].point;
            let span = b.boundary.span(p, q).ok_or_else(|| Error::Layout {
                reason: "two separatrices end at one boundary point".into(),
                at: Some(here),
            })?;
            let chain = &b.boundary.chains[span.chain as usize];
            let pieces = 2 + (40.0 * (span.end - span.start) / chain.length) as usize;
            let points = (0..=pieces)
                .map(|i| chain.point(span.start + (span.end - span.start) * i as f64 / pieces as f64))
                .collect();
            b.layout.arcs.push(Arc { nodes: [from, to], points, span: Some(span) });
            outside.extend([false, true]);
        }
        for (k, &(_, node)) in nodes.iter().enumerate() {
            let node = node as usize;
            let out = SideArc { arc: first + k as u32, forward: true };
            let back = SideArc { arc: first + ((k + n - 1) % n) as u32, forward: false };
            let own = &rays[node];
            let sector = if own.is_empty() { quads_at[node] } else { 1 };
            let mut spokes = vec![Spoke { arc: out, sector }];
            spokes.extend(own.iter().map(|&(_, arc)| Spoke { arc, sector: 1 }));
            spokes.push(Spoke { arc: back, sector: OUTSIDE });
            b.spokes[node] = spokes;
        }
    }
    Ok(outside)
}

/// Walks around every region.
fn regions(b: Builder, outside: &[bool]) -> Result<Traced> {
    let Builder { boundary, mut layout, spokes, .. } = b;
    let id = |a: SideArc| 2 * a.arc as usize + usize::from(!a.forward);
    // For each directed arc the place of its reverse among the spokes of its head.
    let mut at_head = vec![(NONE, NONE); 2 * layout.arcs.len()];
    for (n, list) in spokes.iter().enumerate() {
        for (i, s) in list.iter().enumerate() {
            at_head[id(SideArc { forward: !s.arc.forward, ..s.arc })] = (n as u32, i as u32);
        }
    }
    let mut seen = outside.to_vec();
    let mut seeds = Vec::new();
    for start in 0..seen.len() {
        if seen[start] {
            continue;
        }
        let first = SideArc { arc: start as u32 / 2, forward: start % 2 == 0 };
        let here = layout.arcs[first.arc as usize].points[0];
        let broken = |reason: &str| Error::Layout { reason: reason.into(), at: Some(here) };
        let mut cycle = Vec::new();
        let mut arc = first;
        loop {
            seen[id(arc)] = true;
            let (node, i) = at_head[id(arc)];
            let list = spokes.get(node as usize).ok_or_else(|| broken("an arc leads nowhere"))?;
            let next = list[(i as usize + list.len() - 1) % list.len()];
            if next.sector == OUTSIDE {
                return Err(broken("a region leaves the domain"));
            }
            cycle.push((arc, next.sector));
            arc = next.arc;
            if arc == first {
                break;
            }
            if seen[id(arc)] || cycle.len() > layout.arcs.len() * 2 {
                return Err(broken("a region does not close"));
            }
        }
        let turns: u32 = cycle.iter().map(|c| [2, 1, 0][(c.1 as usize).min(2)]).sum();
        if turns != 4 {
            return Err(broken(&format!("a region has {turns} quarter turns")));
        }
        // Sides end where the sector is no straight one.
        let Some(last) = cycle.iter().rposition(|c| c.1 != 2) else {
            return Err(broken("a region without corners"));
        };
        cycle.rotate_left(last + 1);
        let mut sides = vec![Vec::new()];
        for (arc, sector) in cycle {
            if let Some(side) = sides.last_mut() {
                side.push(arc);
            }
            if sector != 2 {
                sides.push(Vec::new());
            }
        }
        sides.pop();
        if sides.len() < 3 {
            let longest = sides
                .iter()
                .flatten()
                .filter_map(|a| layout.arcs[a.arc as usize].span)
                .max_by(|x, y| (x.end - x.start).total_cmp(&(y.end - y.start)));
            let Some(span) = longest else { return Err(broken("a region with two corners lies inside")) };
            let s = boundary.chains[span.chain as usize].wrap(0.5 * (span.start + span.end));
            seeds.push(BoundaryPoint { chain: span.chain, s });
        }
        layout.regions.push(Region { sides });
    }
    Ok(if seeds.is_empty() { Traced::Layout(layout) } else { Traced::Seeds(seeds) })
}
