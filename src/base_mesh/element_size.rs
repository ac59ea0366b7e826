//! How large elements should be before coarsening, anywhere in the domain.
//!
//! At the boundary an element may turn with the curve by about a radian, and reach from junction to
//! junction; inwards the size grows with the distance, along the base mesh's edges. The base mesh
//! knows the gaps: an element is at most so many base edges long. What the caller asks for holds where it is
//! less, and the size grows from there as it does from the boundary.

use super::size_samples::SizeSamples;
use super::Triangulation;
use crate::domain::{Boundary, Place};
use crate::error::Result;
use crate::numerics::tolerances::EDGE_TURN;
use crate::numerics::{cross, Point};
use crate::options::Options;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Size of an element at a chain that is one edge, relative to the chain's length.
const CHAIN_SHARE: f64 = 1.0;
/// Growth of the size with the distance from the boundary.
const GROWTH: f64 = 0.5;
/// Largest size, relative to the square root of the domain's area.
const LARGEST: f64 = 0.28;
/// Longest element in base edges: bounds the aspect ratio in gaps.
const MOST_BASE_EDGES: f64 = 16.0;
/// Shortest element in base edges, where the boundary turns sharply.
const LEAST_BASE_EDGES: f64 = 2.0;

/// Share of the size asked for that is aimed at: lengths in whole numbers are rounded down as well as up.
const AIM: f64 = 0.85;

/// Local size anywhere in the plane: that of the nearest sample (a k-d tree).
#[derive(Debug, Clone)]
pub struct ElementSize {
    /// Samples, arranged as an implicit balanced tree.
    nodes: Vec<Sample>,
    /// About how many elements of the sizes that the caller allows fill the domain.
    pub least_elements: f64,
}

#[derive(Debug, Clone, Copy)]
struct Sample {
    point: Point,
    /// The size to aim at.
    wanted: f64,
    /// The largest one the caller allows; infinite if it is all the same.
    asked: f64,
}

impl ElementSize {
    /// Sizes for the domain of `boundary` on its base mesh, in the canonical frame; none above what `options`
    /// allow.
    ///
    /// # Errors
    /// [`Error::SizeFunction`](crate::Error::SizeFunction), with its place in the caller's frame.
    pub fn new(mesh: &Triangulation, boundary: &Boundary, options: &Options) -> Result<Self> {
        let frame = &boundary.frame;
        let most = options.max_element_size.map_or(f64::INFINITY, |h| h / frame.scale);
        let largest = LARGEST * boundary.area.max(0.0).sqrt();
        let n = mesh.vertices.len();
        let mut edges = vec![(0.0f64, 0.0f64); n];
        for t in &mesh.triangles {
            for i in 0..3 {
                let (a, b) = (t[i] as usize, t[(i + 1) % 3] as usize);
                let length = (mesh.vertices[a].point - mesh.vertices[b].point).norm();
                for v in [a, b] {
                    edges[v].0 += length;
                    edges[v].1 += 1.0;
                }
            }
        }
        let mut ask = |p: Point| match &options.element_size {
            Some(function) => Ok(function.at(frame.to_caller(p))? / frame.scale),
            None => Ok(f64::INFINITY),
        };
        let places: Vec<Point> = options
            .element_size
            .iter()
            .flat_map(|f| f.places())
            .map(|p| frame.to_canonical(Point::from(*p)))
            .collect();
        let mut samples = SizeSamples::new(mesh, &places, &mut ask)?;
        // One number for all says nothing about the layout; with a function it counts where it is less.
        let everywhere = if options.element_size.is_some() { most } else { f64::INFINITY };
        samples.asked.iter_mut().for_each(|asked| *asked = asked.min(everywhere));
        let mut neighbors: Vec<Vec<(u32, f64)>> = vec![Vec::new(); samples.points.len()];
        for [a, b] in samples.triangles.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]) {
            let length = (samples.points[a as usize] - samples.points[b as usize]).norm();
            neighbors[a as usize].push((b, length));
            neighbors[b as usize].push((a, length));
        }
        // Non-negative numbers order as their bits do.
        let mut size: Vec<f64> = samples.asked.iter().map(|asked| (AIM * asked).min(largest)).collect();
        let mut queue: BinaryHeap<_> = match options.element_size {
            Some(_) => size.iter().zip(0u32..).map(|(size, v)| Reverse((size.to_bits(), v))).collect(),
            None => BinaryHeap::new(),
        };
        for (v, vertex) in mesh.vertices.iter().enumerate() {
            let chains = match vertex.place {
                Place::Interior => continue,
                Place::Boundary(p) => [(p.chain, p.s), (p.chain, p.s)],
                Place::Junction(j) => {
                    let junction = &boundary.junctions[j as usize];
                    let end = boundary.chains[junction.chain_in as usize].length;
                    [(junction.chain_in, end), (junction.chain_out, 0.0)]
                }
            };
            for (c, s) in chains {
                let chain = &boundary.chains[c as usize];
                let turn = EDGE_TURN / chain.curvature(s).abs().max(f64::MIN_POSITIVE);
                let base = edges[v].0 / edges[v].1.max(1.0);
                size[v] = size[v].min(turn.max(LEAST_BASE_EDGES * base).min(CHAIN_SHARE * chain.length));
            }
            size[v] = size[v].min(largest);
            queue.push(Reverse((size[v].to_bits(), v as u32)));
        }
        while let Some(Reverse((bits, v))) = queue.pop() {
            if f64::from_bits(bits) > size[v as usize] {
                continue;
            }
            for &(w, length) in &neighbors[v as usize] {
                let grown = (size[v as usize] + GROWTH * length).min(largest);
                if grown < size[w as usize] {
                    size[w as usize] = grown;
                    queue.push(Reverse((grown.to_bits(), w)));
                }
            }
        }
        let mut longest: Vec<f64> = edges.iter().map(|e| MOST_BASE_EDGES * e.0 / e.1).collect();
        for ends in &samples.between {
            longest.push(0.5 * ends.map(|v| longest[v as usize]).iter().sum::<f64>());
        }
        let mut nodes: Vec<Sample> =
            (samples.points.iter().zip(&samples.asked).zip(size.iter().zip(&longest)))
                // A vertex without edges has no size.
                .filter(|(_, (_, longest))| !longest.is_nan())
                .map(|((point, asked), (size, longest))| Sample {
                    point: *point,
                    wanted: size.min(*longest),
                    asked: asked.min(most),
                })
                .collect();
        arrange(&mut nodes, 0);
        let elements = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| samples.points[v as usize]);
            // Sizes are means of the corners', so that a single small one does not count for all.
            let mean = most.min(t.iter().map(|v| samples.asked[*v as usize]).sum::<f64>() / 3.0);
            0.5 * cross(b - a, c - a) / (mean * mean)
        };
        let least_elements = samples.triangles.iter().map(elements).sum();
        Ok(ElementSize { nodes, least_elements })
    }

    /// The size to aim at at `p`.
    pub fn at(&self, p: Point) -> f64 {
        self.nearest(p).map_or(1.0, |sample| sample.wanted)
    }

    /// The largest size that the caller allows at `p`; infinite without a limit.
    pub fn allowed(&self, p: Point) -> f64 {
        self.nearest(p).map_or(f64::INFINITY, |sample| sample.asked)
    }

    fn nearest(&self, p: Point) -> Option<&Sample> {
        let mut best = (f64::INFINITY, None);
        nearest(&self.nodes, p, 0, &mut best);
        best.1
    }
}

fn coordinate(p: Point, axis: usize) -> f64 {
    if axis == 0 {
        p.x
    } else {
        p.y
    }
}

/// Puts the median of alternating coordinates in the middle of every part.
fn arrange(nodes: &mut [Sample], axis: usize) {
    if nodes.len() < 2 {
        return;
    }
    let middle = nodes.len() / 2;
    nodes.select_nth_unstable_by(middle, |a, b| {
        coordinate(a.point, axis)
            .total_cmp(&coordinate(b.point, axis))
            .then(coordinate(a.point, 1 - axis).total_cmp(&coordinate(b.point, 1 - axis)))
    });
    let (low, high) = nodes.split_at_mut(middle);
    arrange(low, 1 - axis);
    arrange(&mut high[1..], 1 - axis);
}

/// Depth is the logarithm of the number of nodes.
fn nearest<'a>(nodes: &'a [Sample], p: Point, axis: usize, best: &mut (f64, Option<&'a Sample>)) {
    if nodes.is_empty() {
        return;
    }
    let middle = nodes.len() / 2;
    let sample = &nodes[middle];
    let d = (p - sample.point).norm_squared();
    if d < best.0 {
        *best = (d, Some(sample));
    }
    let offset = coordinate(p, axis) - coordinate(sample.point, axis);
    let (low, high) = (&nodes[..middle], &nodes[middle + 1..]);
    let (near, far) = if offset < 0.0 { (low, high) } else { (high, low) };
    nearest(near, p, 1 - axis, best);
    if offset * offset < best.0 {
        nearest(far, p, 1 - axis, best);
    }
}
