//! The invariants of boundary tables.

use crate::domain::boundary::{Boundary, Chain};
use crate::numerics::{Point, Vector};

/// A defect in words and where it is, in the canonical frame.
type Defect = (String, Point);

impl Boundary {
    /// Checks that every loop is a closed sequence of chains between junctions, tables ascend, tangents
    /// are of unit length and chains meet their junctions.
    pub fn check(&self) -> Result<(), Defect> {
        let origin = Point::origin();
        if !(self.area > 0.0 && self.area.is_finite()) {
            return Err((format!("the area is {}", self.area), origin));
        }
        let mut seen = vec![false; self.chains.len()];
        for (k, chains) in self.loops.iter().enumerate() {
            for (i, &c) in chains.iter().enumerate() {
                let Some(chain) = self.chains.get(c as usize) else {
                    return Err((format!("loop {k} names chain {c}, which is not there"), origin));
                };
                let at = chain.samples.first().map_or(origin, |x| x.point);
                if std::mem::replace(&mut seen[c as usize], true) || chain.loop_index as usize != k {
                    return Err((format!("chain {c} belongs to two loops"), at));
                }
                let next = &self.chains[chains[(i + 1) % chains.len()] as usize];
                let meets = match (chain.ends, next.ends) {
                    (None, None) => chains.len() == 1,
                    (Some(a), Some(b)) => a[1] == b[0],
                    _ => false,
                };
                if !meets {
                    return Err((format!("chain {c} does not end where the next one starts"), at));
                }
                self.check_chain(c, chain)?;
            }
        }
        if seen.iter().any(|s| !s) {
            return Err(("a chain belongs to no loop".into(), origin));
        }
        Ok(())
    }

    fn check_chain(&self, index: u32, chain: &Chain) -> Result<(), Defect> {
        let origin = Point::origin();
        let (Some(first), Some(last)) = (chain.samples.first(), chain.samples.last()) else {
            return Err((format!("chain {index} has no table"), origin));
        };
        let defect = |what: &str, at: Point| Err((format!("chain {index}: {what}"), at));
        if first.s != 0.0 || last.s != chain.length || chain.length <= 0.0 {
            return defect("the table does not run from 0 to the length", first.point);
        }
        for w in chain.samples.windows(2) {
            let joint = w[0].segment != w[1].segment;
            if (w[1].s <= w[0].s && !joint) || (joint && (w[1].s != w[0].s || w[1].point != w[0].point)) {
                return defect("the table does not ascend", w[1].point);
            }
        }
        for x in &chain.samples {
            let unit = (x.tangent.norm() - 1.0).abs() < 1e-9;
            if !(unit && x.curvature.is_finite() && x.point.coords.iter().all(|c| c.is_finite())) {
                return defect("a tangent is not of unit length or a value is not finite", x.point);
            }
        }
        let ascending = chain.breaks.windows(2).all(|w| w[0] < w[1]);
        if !ascending || chain.breaks.iter().any(|&b| b <= 0.0 || b >= chain.length) {
            return defect("the breaks do not ascend inside the chain", first.point);
        }
        match chain.ends {
            None if (first.point - last.point) != Vector::zeros() => defect("it is not closed", last.point),
            None => Ok(()),
            Some([a, b]) => {
                for (j, sample) in [(a, first), (b, last)] {
                    match self.junctions.get(j as usize) {
                        Some(junction) if junction.point == sample.point => {}
                        _ => return defect("it misses its junction", sample.point),
                    }
                }
                let (start, end) = (&self.junctions[a as usize], &self.junctions[b as usize]);
                if start.chain_out != index || end.chain_in != index {
                    return defect("its junctions name other chains", first.point);
                }
                Ok(())
            }
        }
    }
}
