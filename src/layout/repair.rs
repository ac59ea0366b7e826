//! Step 6 of the paper: regions that are not four-sided.
//!
//! Three sides: the centroid is joined to the three sides (a star, filled at extraction). Five: a star
//! as well, or the paper's cut and then the triangle rule. More: cuts between corners take off
//! four-sided pieces until 3 to 5 sides remain. Fewer than three: the region is halved into
//! triangles. A four-sided region whose lengths contradict the others' is *relaxed*: one corner is cut off, a
//! triangle and a pentagon that together have no irregularity but take any even perimeter.
//! The new lines run on through the neighbours, as their grids are filled.

use super::cut::BorderNode;
use super::polyline::{self, Measured};
use super::targets::{PentagonRule, Targets};
use super::BlockLayout;
use crate::domain::Boundary;
use crate::numerics::NONE;

/// Which rules were needed: grows with their strength.
pub const NOTHING: u8 = 0;
/// The paper's rules for triangles and pentagons.
pub const PAPER_RULE: u8 = 1;
/// A pattern: six and more sides, or a relaxed quadrilateral.
pub const PATTERN: u8 = 2;

fn corner(i: usize) -> BorderNode {
    BorderNode { side: i, index: 0 }
}

impl BlockLayout {
    /// Cuts until every region has 4 sides, or 3 or 5 and is to be filled as a star. Returns the strongest
    /// rule used.
    pub fn repair(&mut self, boundary: &Boundary, targets: &Targets) -> u8 {
        let mut level = NOTHING;
        let mut r = 0;
        while r < self.regions.len() {
            let region = r as u32;
            let k = self.regions[r].sides.len();
            let used = match k {
                4 => NOTHING,
                3 => PAPER_RULE,
                5 if targets.pentagon == PentagonRule::Star => PAPER_RULE,
                5 => {
                    let (from, to) = self.pentagon_cut(region);
                    self.cut(region, corner(from), corner(to));
                    PAPER_RULE
                }
                0..=2 => {
                    self.halve(region, boundary, targets);
                    PATTERN
                }
                _ => {
                    // Three sides and the cut make a quadrilateral; k − 2 sides are left.
                    let candidates = if k == 6 { 3 } else { k };
                    let best = (0..candidates)
                        .map(|i| (self.cut_score(region, i, (i + 3) % k), i))
                        .fold((f64::NEG_INFINITY, 0), |best, c| if c.0 > best.0 + 1e-9 { c } else { best });
                    self.cut(region, corner(best.1), corner((best.1 + 3) % k));
                    PATTERN
                }
            };
            level = level.max(used);
            // A cut region is looked at again: both parts may need more.
            if matches!(k, 3 | 4) || (k == 5 && targets.pentagon == PentagonRule::Star) {
                r += 1;
            }
        }
        level
    }

    /// The paper's rule 2: from the corner with the largest inner angle to that of the two corners not
    /// adjacent to it which leaves the larger smallest angle.
    fn pentagon_cut(&self, region: u32) -> (usize, usize) {
        let widest = (0..5)
            .map(|i| self.corner_angle(region, i))
            .enumerate()
            .fold((0, 0.0), |best, (i, angle)| if angle > best.1 + 1e-9 { (i, angle) } else { best })
            .0;
        let [a, b] = [(widest + 2) % 5, (widest + 3) % 5];
        let better = self.cut_score(region, widest, a) >= self.cut_score(region, widest, b);
        (widest, if better { a } else { b })
    }

    /// The smallest of the four angles that a cut between two corners makes; less by π where it cannot be straight.
    fn cut_score(&self, region: u32, from: usize, to: usize) -> f64 {
        let path = self.cut_path(region, corner(from), corner(to));
        let n = path.len();
        let one = self.divided_angle(region, corner(from), path[1] - path[0]);
        let other = self.divided_angle(region, corner(to), path[n - 2] - path[n - 1]);
        let smallest = one.iter().chain(&other).fold(f64::INFINITY, |m, &a| m.min(a));
        if n > 2 || polyline::leaves(&path, &self.polygon(region)) {
            smallest - std::f64::consts::PI
        } else {
            smallest
        }
    }

    /// A border place at `share` of the measure of side `side`, dividing an arc there unless a node is close.
    fn place_on_side(
        &mut self,
        region: u32,
        side: usize,
        share: f64,
        boundary: &Boundary,
        targets: &Targets,
    ) -> BorderNode {
        let arcs = self.regions[region as usize].sides[side].clone();
        let lengths: Vec<f64> = arcs
            .iter()
            .map(|a| Measured::new(&self.arcs[a.arc as usize].points, targets.size).total())
            .collect();
        let total: f64 = lengths.iter().sum();
        let (mut run, wanted) = (0.0, share * total);
        for (i, (a, &l)) in arcs.iter().zip(&lengths).enumerate() {
            // A node within a tenth of the side serves as well as a new one.
            if i > 0 && (run - wanted).abs() < 0.1 * total {
                return BorderNode { side, index: i };
            }
            let last = i + 1 == arcs.len();
            if last || wanted <= run + l - 0.1 * total {
                let x = if l > 0.0 { ((wanted - run) / l).clamp(0.1, 0.9) } else { 0.5 };
                self.split_arc(a.arc, if a.forward { x } else { 1.0 - x }, targets.size, boundary);
                return BorderNode { side, index: i + 1 };
            }
            run += l;
        }
        BorderNode { side, index: 0 }
    }

    /// A region of one or two sides: a cut from side to side makes triangles, or a triangle and a region of
    /// two sides, which is halved in its turn.
    fn halve(&mut self, region: u32, boundary: &Boundary, targets: &Targets) {
        if self.regions[region as usize].sides.len() == 2 {
            self.cut_between(region, [0, 1], [0.5, 0.5], boundary, targets);
        } else {
            self.cut_between(region, [0, 0], [0.67, 0.33], boundary, targets);
        }
    }

    /// `regions`, and the regions around them until a four-sided one is among them.
    fn with_four_sided(&self, regions: &[u32]) -> Vec<u32> {
        let mut pool = regions.to_vec();
        while !pool.iter().any(|&r| self.regions[r as usize].sides.len() == 4) {
            let beside: Vec<u32> = self
                .arc_sides()
                .iter()
                .map(|on| [on[0].0, on[1].0])
                .filter(|[a, b]| *b != NONE && pool.contains(a) != pool.contains(b))
                .map(|[a, b]| if pool.contains(&a) { b } else { a })
                .collect();
            if beside.is_empty() {
                break;
            }
            pool.extend(beside);
            pool.sort_unstable();
            pool.dedup();
        }
        pool
    }

    /// Relaxes the four-sided region among `regions` (or near them) and that corner of it where a 3-5
    /// pair costs least. `false`: there is none.
    pub fn relax(&mut self, regions: &[u32], wanted: &[f64], boundary: &Boundary, targets: &Targets) -> bool {
        let mut best: Option<(f64, u32, usize)> = None;
        for r in self.with_four_sided(regions) {
            let sides = &self.regions[r as usize].sides;
            if sides.len() != 4 {
                continue;
            }
            let length =
                |s: usize| -> f64 { sides[s % 4].iter().map(|a| wanted[a.arc as usize]).sum::<f64>() };
            for c in 0..4 {
                // The cut sides carry at least 4 each, the others 2: what is missing is the cost.
                // Among free ones the roundest is best.
                let [one, two] = [length(c + 3), length(c)];
                let missing = f64::max(0.0, 4.0 - one)
                    + f64::max(0.0, 4.0 - two)
                    + f64::max(0.0, 2.0 - length(c + 1))
                    + f64::max(0.0, 2.0 - length(c + 2));
                let slender = (one.max(1e-9) / two.max(1e-9)).ln().abs();
                let cost = missing + 0.1 * slender;
                if best.is_none_or(|b| cost < b.0 - 1e-9) {
                    best = Some((cost, r, c));
                }
            }
        }
        let Some((_, r, c)) = best else { return false };
        // Equally far from the corner on both sides, so that a long region is cut near its end.
        let sides = [(c + 3) % 4, c];
        let [one, two] = sides.map(|s| {
            let side = &self.regions[r as usize].sides[s];
            side.iter().map(|a| wanted[a.arc as usize]).sum::<f64>().max(f64::MIN_POSITIVE)
        });
        let reach = f64::min(one, two) / 2.0;
        self.cut_between(r, sides, [1.0 - reach / one, reach / two], boundary, targets);
        true
    }

    /// Cuts from a place on one side to a place on another (or an earlier one on the same).
    fn cut_between(
        &mut self,
        region: u32,
        sides: [usize; 2],
        shares: [f64; 2],
        boundary: &Boundary,
        targets: &Targets,
    ) {
        let first = self.place_on_side(region, sides[0], shares[0], boundary, targets);
        let node = self.border_node(region, first);
        let second = self.place_on_side(region, sides[1], shares[1], boundary, targets);
        // The second division may have moved the first place's index.
        let side = &self.regions[region as usize].sides[first.side];
        let found = (1..side.len()).find(|&i| self.start(side[i]) == node);
        let first = BorderNode { side: first.side, index: found.unwrap_or(first.index) };
        self.cut(region, first, second);
    }
}
