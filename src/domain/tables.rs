//! Building the boundary tables: segments' tables strung to chains between junctions.

use crate::domain::boundary::{Boundary, Chain, Junction, Sample};
use crate::domain::canonical::canonical;
use crate::domain::chain_table::ChainTable;
use crate::domain::planar_domain::Domain;
use crate::domain::segment_table::{segment_table, Entry};
use crate::error::Result;
use crate::numerics::tolerances::CORNER_TURN;
use std::f64::consts::PI;

impl Boundary {
    /// The tables of `domain`, in its canonical frame. Domains that differ by a similarity, by where
    /// their loops start or by the direction in which they were given have equal tables, up to rounding.
    pub fn new(domain: &Domain) -> Result<Boundary> {
        let pose = canonical(domain)?;
        let frame = pose.frame;
        let mut boundary = Boundary {
            frame,
            names: names(domain),
            chains: Vec::new(),
            junctions: Vec::new(),
            loops: Vec::new(),
            area: domain.area()? / (frame.scale * frame.scale),
            loop_sources: pose.loops.iter().map(|&l| l as u32).collect(),
            diagonal: pose.least_diagonal,
        };
        for (k, &l) in pose.loops.iter().enumerate() {
            boundary.add_loop(domain, k, l, pose.starts[k], &pose.turns[k])?;
        }
        Ok(boundary)
    }

    /// Adds loop `l` of the domain as loop `k`, walked from segment `start`.
    fn add_loop(&mut self, domain: &Domain, k: usize, l: usize, start: usize, turns: &[f64]) -> Result<()> {
        let source = &domain.loops()[l];
        let segments = source.segments();
        let n = segments.len();
        let is_junction: Vec<bool> = (0..n)
            .map(|i| turns[i].abs() > CORNER_TURN || segments[i].name() != segments[source.before(i)].name())
            .collect();
        // A loop without a corner may still have junctions where the name changes.
        let start = (0..n).map(|i| (start + i) % n).find(|&i| is_junction[i]).unwrap_or(start);
        let first_chain = self.chains.len() as u32;
        let mut samples: Vec<Vec<Sample>> = Vec::new();
        for i in (0..n).map(|i| (start + i) % n) {
            let mut table = segment_table(&segments[i], &self.frame)?;
            // Where segments join both tables hold the very same point.
            let next = self.frame.to_canonical(segments[(i + 1) % n].start()?);
            if let Some(last) = table.last_mut() {
                last.point = next;
            }
            if i == start || is_junction[i] {
                let name = self.names.iter().position(|x| x == segments[i].name()).unwrap_or(0) as u32;
                self.chains.push(Chain {
                    loop_index: k as u32,
                    name,
                    ends: None,
                    length: 0.0,
                    samples: ChainTable::default(),
                    breaks: Vec::new(),
                });
                samples.push(Vec::new());
            }
            if let (Some(chain), Some(samples)) = (self.chains.last_mut(), samples.last_mut()) {
                chain.append(&table, i as u32, samples);
            }
        }
        for (chain, samples) in self.chains[first_chain as usize..].iter_mut().zip(samples) {
            chain.samples = samples.into();
        }
        let chains: Vec<u32> = (first_chain..self.chains.len() as u32).collect();
        if is_junction[start] {
            let first_junction = self.junctions.len() as u32;
            let count = chains.len() as u32;
            for (j, &chain) in chains.iter().enumerate() {
                let sample = self.chains[chain as usize].samples[0];
                let i = sample.segment as usize;
                let sharp = turns[i].abs() > CORNER_TURN;
                let angle = if sharp { source.interior_angle(i)? } else { PI - turns[i] };
                let j = j as u32;
                let chain_in = first_chain + (j + count - 1) % count;
                self.junctions.push(Junction { point: sample.point, angle, chain_in, chain_out: chain });
                self.chains[chain as usize].ends =
                    Some([first_junction + j, first_junction + (j + 1) % count]);
            }
        }
        self.loops.push(chains);
        Ok(())
    }
}

impl Chain {
    /// Appends a segment's table at the chain's end, its samples to `samples`.
    fn append(&mut self, table: &[Entry], segment: u32, samples: &mut Vec<Sample>) {
        let offset = self.length;
        if offset > 0.0 {
            self.breaks.push(offset);
        }
        for e in table {
            let s = offset + e.s;
            if e.is_break {
                self.breaks.push(s);
            }
            samples.push(Sample {
                s,
                point: e.point,
                tangent: e.tangent,
                curvature: e.curvature,
                segment,
                t: e.t,
            });
        }
        self.length = offset + table.last().map_or(0.0, |e| e.s);
    }
}

/// The boundary names in the order of the caller's loops and segments.
fn names(domain: &Domain) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for l in domain.loops() {
        let mut segments: Vec<_> = l.segments().iter().collect();
        segments.sort_by_key(|s| s.index());
        for s in segments {
            if !names.iter().any(|n| n == s.name()) {
                names.push(s.name().to_string());
            }
        }
    }
    names
}
