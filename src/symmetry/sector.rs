//! The part of a domain between two of its mirror axes, as a domain of its own.

use super::group::Group;
use super::isometry::{direction, Isometry};
use crate::domain::{Boundary, Chain, Junction, Place, Sample};
use crate::numerics::tolerances::{JUNCTION_MATCH, SYMMETRY_ANGLE};
use crate::numerics::{cross, Point, Vector};
use std::f64::consts::PI;

/// Name of the boundary that the axes become.
const AXIS_NAME: &str = "axis of symmetry";

/// Where to cut: the sector is one of 2 `rotations` equal parts, images of each other under the subgroup of
/// `rotations` rotations and the mirrors beginning with `mirror` ([`Group::subgroup`]). One rotation: half of the
/// domain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cut {
    pub rotations: usize,
    pub mirror: usize,
}

/// Where a chain of a sector comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Source {
    /// Arc length s is `start` + s of the whole domain's chain.
    Chain { chain: u32, start: f64 },
    /// It lies on the axis at the sector's beginning (`false`) or end (`true`).
    Axis(bool),
}

/// Where a junction of a sector comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Corner {
    /// A junction of the whole domain off the axes.
    Junction(u32),
    /// Where the boundary crosses an axis (as in [`Source::Axis`]): a place of the whole domain's.
    Crossing { place: Place, end: bool },
    /// The centroid, where the axes meet.
    Centre,
}

/// A part of a domain between two mirror axes, or half of it.
#[derive(Debug, Clone)]
pub struct Sector {
    /// Its boundary, in the whole domain's frame.
    pub boundary: Boundary,
    pub cut: Cut,
    /// Whether the axes meet inside the domain, at a corner of the sector.
    pub has_centre: bool,
    pub(super) sources: Vec<Source>,
    pub(super) corners: Vec<Corner>,
    /// Unit vectors along the axes at the sector's beginning and end.
    pub(super) axes: [Vector; 2],
}

/// The boundary crossing an axis.
struct Crossing {
    /// Place along the way in on the end's axis and out on the beginning's.
    along: f64,
    place: Place,
    point: Point,
    /// Half the angle through the domain there.
    angle: f64,
    end: bool,
}

/// A piece of the whole boundary in the sector, from one node to another (of a closed chain: none).
struct Piece {
    chain: u32,
    start: f64,
    end: f64,
    nodes: Option<[Node; 2]>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Node {
    Junction(u32),
    Crossing(usize),
}

impl Sector {
    /// Cuts the domain; `None` where the boundary does not cross the axes in pairs.
    pub fn new(boundary: &Boundary, group: &Group, cut: Cut) -> Option<Sector> {
        let own = group.subgroup(cut.rotations, Some(cut.mirror));
        let step = group.rotations / cut.rotations;
        // The mirrors at both axes: the second is the first followed by the smallest rotation.
        let first = *own.get(cut.rotations)?;
        let second = if cut.rotations > 1 { group.product(step, first) } else { first };
        let mirrors = [first, second].map(|e| &group.elements[e]);
        let angle = mirrors[0].map.axis();
        let axes = [direction(angle), direction(angle + PI / cut.rotations as f64)];
        let mut crossings = Vec::new();
        for (side, mirror) in mirrors.iter().enumerate() {
            if side == 1 && cut.rotations == 1 {
                break;
            }
            let sign = if side == 0 { 1.0 } else { -1.0 };
            let mut add = |place: Place, angle: f64| {
                let out = boundary.point(place)?.coords.dot(&axes[side]);
                if cut.rotations == 1 || out > 0.0 {
                    let point = Point::from(axes[side] * out);
                    crossings.push(Crossing { along: sign * out, place, point, angle, end: side == 1 });
                }
                Some(())
            };
            for (j, junction) in (0..).zip(&boundary.junctions) {
                if mirror.junctions[j as usize] == j {
                    add(Place::Junction(j), 0.5 * junction.angle)?;
                }
            }
            for (c, (chain, image)) in (0..).zip(boundary.chains.iter().zip(&mirror.chains)) {
                if image.chain != c || !image.backwards {
                    continue;
                }
                let s = chain.wrap(0.5 * image.offset);
                let more = chain.ends.is_none().then(|| chain.wrap(s + 0.5 * chain.length));
                for s in [Some(s), more].into_iter().flatten() {
                    add(Place::Boundary(crate::domain::BoundaryPoint { chain: c, s }), 0.5 * PI)?;
                }
            }
        }
        crossings.sort_by(|a, b| a.along.total_cmp(&b.along));
        let even = crossings.len() % 2 == 0;
        let apart = crossings.windows(2).all(|w| w[1].along - w[0].along > JUNCTION_MATCH);
        if crossings.is_empty() || !even || !apart {
            return None;
        }
        let pieces = pieces(boundary, &crossings, axes);
        assemble(boundary, &crossings, &pieces, cut, axes)
    }
}

/// The pieces of the boundary's chains inside the sector.
fn pieces(boundary: &Boundary, crossings: &[Crossing], axes: [Vector; 2]) -> Vec<Piece> {
    let inside = |p: Point| cross(axes[0], p.coords) > 0.0 && cross(p.coords, axes[1]) > 0.0;
    let node = |j: u32| {
        let at = crossings.iter().position(|x| x.place == Place::Junction(j));
        at.map_or(Node::Junction(j), Node::Crossing)
    };
    let mut pieces = Vec::new();
    for (c, chain) in (0..).zip(&boundary.chains) {
        let mut cuts: Vec<(f64, Node)> = Vec::new();
        for (k, crossing) in crossings.iter().enumerate() {
            match crossing.place {
                Place::Boundary(p) if p.chain == c => cuts.push((p.s, Node::Crossing(k))),
                _ => {}
            }
        }
        cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
        match chain.ends {
            Some([a, b]) => {
                cuts.insert(0, (0.0, node(a)));
                cuts.push((chain.length, node(b)));
            }
            None => match cuts.first() {
                Some(&(s, node)) => cuts.push((s + chain.length, node)),
                None if inside(chain.point(0.0)) => {
                    pieces.push(Piece { chain: c, start: 0.0, end: chain.length, nodes: None });
                }
                None => {}
            },
        }
        for w in cuts.windows(2) {
            if inside(chain.point(0.5 * (w[0].0 + w[1].0))) {
                pieces.push(Piece { chain: c, start: w[0].0, end: w[1].0, nodes: Some([w[0].1, w[1].1]) });
            }
        }
    }
    pieces
}

/// The loops of the sector: pieces of the boundary, and of the axes between crossings.
fn assemble(
    whole: &Boundary,
    crossings: &[Crossing],
    pieces: &[Piece],
    cut: Cut,
    axes: [Vector; 2],
) -> Option<Sector> {
    let mut names = whole.names.clone();
    names.push(AXIS_NAME.into());
    let mut sector = Sector {
        boundary: Boundary {
            frame: whole.frame,
            names,
            chains: Vec::new(),
            junctions: Vec::new(),
            loops: Vec::new(),
            area: whole.area / (2 * cut.rotations) as f64,
            loop_sources: Vec::new(),
            diagonal: whole.diagonal,
        },
        cut,
        has_centre: false,
        sources: Vec::new(),
        corners: Vec::new(),
        axes,
    };
    let mut used = vec![false; pieces.len()];
    // The outer loop is the one that crosses the axes first.
    let outer = |p: &Piece| p.nodes.is_some_and(|n| n[0] == Node::Crossing(1) || n[1] == Node::Crossing(0));
    let order = (0..pieces.len()).filter(|i| outer(&pieces[*i])).chain(0..pieces.len());
    for first in order {
        if used[first] {
            continue;
        }
        let first_chain = sector.boundary.chains.len() as u32;
        let first_junction = sector.boundary.junctions.len() as u32;
        let mut next = first;
        loop {
            used[next] = true;
            let piece = &pieces[next];
            let Some([from, to]) = piece.nodes else {
                sector.push_piece(whole, crossings, piece);
                break;
            };
            sector.push_junction(whole, crossings, from);
            sector.push_piece(whole, crossings, piece);
            let goal = match to {
                Node::Crossing(k) => {
                    // The domain lies between the crossings 0 and 1, 2 and 3, and so on.
                    if k % 2 == 1 {
                        return None;
                    }
                    sector.push_junction(whole, crossings, to);
                    sector.push_axis(crossings, k);
                    Node::Crossing(k + 1)
                }
                junction => junction,
            };
            next = pieces.iter().position(|p| p.nodes.is_some_and(|n| n[0] == goal))?;
            if next == first {
                break;
            }
            if used[next] {
                return None;
            }
        }
        sector.close_loop(first_chain, first_junction);
    }
    let crossed = sector.corners.iter().filter(|c| matches!(c, Corner::Crossing { .. })).count();
    (crossed == crossings.len()).then_some(sector)
}

impl Sector {
    /// The sector's own symmetries as far as they are the whole domain's: the mirror between its axes, if that is one.
    pub fn bisector(&self, group: &Group) -> Option<Group> {
        let angle = self.axes[0].y.atan2(self.axes[0].x) + 0.5 * PI / self.cut.rotations as f64;
        let mirror = Isometry::mirror(angle);
        let mut own = group.elements.iter().map(|e| e.map).filter(|m| m.mirror);
        let known = own.find(|m| (m.turn - mirror.turn).norm() <= SYMMETRY_ANGLE)?;
        Group::generated(&self.boundary, 1, Some(known))
    }

    fn push_junction(&mut self, whole: &Boundary, crossings: &[Crossing], node: Node) {
        let (point, angle, corner) = match node {
            Node::Junction(j) => {
                let junction = &whole.junctions[j as usize];
                (junction.point, junction.angle, Corner::Junction(j))
            }
            Node::Crossing(k) => {
                let Crossing { place, point, angle, end, .. } = crossings[k];
                (point, angle, Corner::Crossing { place, end })
            }
        };
        // Each junction is where the next chain starts.
        let chain = self.boundary.chains.len() as u32;
        self.boundary.junctions.push(Junction { point, angle, chain_in: 0, chain_out: chain });
        self.corners.push(corner);
    }

    fn push_piece(&mut self, whole: &Boundary, crossings: &[Crossing], piece: &Piece) {
        let mut chain = part(&whole.chains[piece.chain as usize], piece.start, piece.end);
        chain.loop_index = self.boundary.loops.len() as u32;
        if let Some(nodes) = piece.nodes {
            let last = chain.samples.len() - 1;
            for (node, at) in nodes.into_iter().zip([0, last]) {
                if let Node::Crossing(k) = node {
                    chain.samples.move_point(at, crossings[k].point);
                }
            }
        } else {
            chain = whole.chains[piece.chain as usize].clone();
            chain.loop_index = self.boundary.loops.len() as u32;
        }
        self.boundary.chains.push(chain);
        self.sources.push(Source::Chain { chain: piece.chain, start: piece.start });
    }

    /// The axis from crossing `k` to the next, broken at the centre if the axes meet there.
    fn push_axis(&mut self, crossings: &[Crossing], k: usize) {
        let (from, to) = (&crossings[k], &crossings[k + 1]);
        if self.cut.rotations > 1 && from.end && !to.end {
            self.push_line(from.point, Point::origin(), true);
            let angle = PI / self.cut.rotations as f64;
            let chain = self.boundary.chains.len() as u32;
            self.boundary.junctions.push(Junction {
                point: Point::origin(),
                angle,
                chain_in: 0,
                chain_out: chain,
            });
            self.corners.push(Corner::Centre);
            self.has_centre = true;
            self.push_line(Point::origin(), to.point, false);
        } else {
            self.push_line(from.point, to.point, from.end);
        }
    }

    fn push_line(&mut self, from: Point, to: Point, end: bool) {
        let length = (to - from).norm();
        let tangent = (to - from) / length;
        let sample =
            |s: f64, point: Point| Sample { s, point, tangent, curvature: 0.0, segment: 0, t: s / length };
        self.boundary.chains.push(Chain {
            loop_index: self.boundary.loops.len() as u32,
            name: self.boundary.names.len() as u32 - 1,
            ends: None,
            length,
            samples: vec![sample(0.0, from), sample(length, to)].into(),
            breaks: Vec::new(),
        });
        self.sources.push(Source::Axis(end));
    }

    /// Joins the chains and junctions pushed since to a loop.
    fn close_loop(&mut self, first_chain: u32, first_junction: u32) {
        let boundary = &mut self.boundary;
        let count = boundary.junctions.len() as u32 - first_junction;
        for k in 0..count {
            let (chain, next) = (first_chain + k, first_junction + (k + 1) % count);
            boundary.chains[chain as usize].ends = Some([first_junction + k, next]);
            boundary.junctions[next as usize].chain_in = chain;
        }
        boundary.loop_sources.push(boundary.loops.len() as u32);
        boundary.loops.push((first_chain..boundary.chains.len() as u32).collect());
    }
}

/// The part of a chain from `start` to `end`, which may run over a closed chain's seam.
fn part(chain: &Chain, start: f64, end: f64) -> Chain {
    let at = |s: f64| {
        let (segment, t) = chain.segment_parameter(s);
        let (point, tangent, curvature) = (chain.point(s), chain.tangent(s), chain.curvature(s));
        Sample { s: s - start, point, tangent, curvature, segment, t }
    };
    // Entries closer to the ends than this would make intervals of no length.
    let inside = |s: f64| s > start + JUNCTION_MATCH && s < end - JUNCTION_MATCH;
    let turns: &[f64] = if end > chain.length { &[0.0, 1.0] } else { &[0.0] };
    let mut samples = Vec::new();
    let mut breaks = Vec::new();
    for turn in turns {
        let shift = turn * chain.length;
        let moved = chain.samples.iter().map(|x| Sample { s: x.s + shift, ..*x });
        samples.extend(moved.filter(|x| inside(x.s)).map(|x| Sample { s: x.s - start, ..x }));
        if *turn > 0.0 && inside(shift) {
            breaks.push(shift - start);
        }
        breaks.extend(chain.breaks.iter().map(|b| b + shift).filter(|b| inside(*b)).map(|b| b - start));
    }
    if start == 0.0 && end == chain.length {
        samples.insert(0, chain.samples[0]);
        samples.extend(chain.samples.last());
    } else {
        samples.insert(0, at(start));
        samples.push(Sample { s: end - start, ..at(end) });
    }
    Chain { length: end - start, samples: samples.into(), breaks, ..chain.clone() }
}
