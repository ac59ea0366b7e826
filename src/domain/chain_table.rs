//! The table of a chain, and an even grid over its arc length: an interval is found in a step or two, whatever was
//! looked for before. The optimiser evaluates chains at millions of places.

use super::boundary::Sample;
use crate::numerics::Point;
use std::ops::Deref;

/// Intervals of one cell of the grid up to which they are gone through one by one.
const FEW_INTERVALS: usize = 8;

/// Samples by ascending arc length, at least two once they are used. Where two segments join the sample is there twice,
/// once for each. Read as a slice.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ChainTable {
    samples: Vec<Sample>,
    /// For each cell, as many as there are intervals, the interval that holds its start; then the last interval.
    cells: Vec<u32>,
    cells_per_length: f64,
}

impl ChainTable {
    /// The interval that holds arc length `s`, of those that have a length; the first or the last where there is none.
    #[inline(always)]
    pub(crate) fn interval(&self, s: f64) -> usize {
        let table = &self.samples[..];
        let last = table.len() - 2;
        let cell = ((s * self.cells_per_length) as usize).min(last);
        // The cell is found by a product that was rounded: its intervals may begin one cell before.
        let (mut i, end) = (self.cells[cell.saturating_sub(1)] as usize, self.cells[cell + 1] as usize);
        if end - i > FEW_INTERVALS {
            i += table[i + 1..=end].partition_point(|x| x.s <= s);
        }
        while i < last && table[i + 1].s <= s {
            i += 1;
        }
        // The double samples at joints bound an interval of no length.
        while i > 0 && table[i + 1].s <= table[i].s {
            i -= 1;
        }
        i
    }

    /// Moves sample `i` to another point, at the same arc length.
    pub(crate) fn move_point(&mut self, i: usize, point: Point) {
        self.samples[i].point = point;
    }
}

impl From<Vec<Sample>> for ChainTable {
    fn from(samples: Vec<Sample>) -> Self {
        let count = samples.len().saturating_sub(1);
        let length = samples.last().map_or(0.0, |x| x.s);
        let cells_per_length = if length > 0.0 { count as f64 / length } else { 0.0 };
        let mut i = 0;
        let mut cells = Vec::with_capacity(count + 1);
        for cell in 0..count {
            let start = cell as f64 / cells_per_length;
            while i + 1 < count && samples[i + 1].s <= start {
                i += 1;
            }
            cells.push(i as u32);
        }
        cells.push(count.saturating_sub(1) as u32);
        ChainTable { samples, cells, cells_per_length }
    }
}

impl FromIterator<Sample> for ChainTable {
    fn from_iter<T: IntoIterator<Item = Sample>>(samples: T) -> Self {
        samples.into_iter().collect::<Vec<_>>().into()
    }
}

impl Deref for ChainTable {
    type Target = [Sample];

    fn deref(&self) -> &[Sample] {
        &self.samples
    }
}

impl<'a> IntoIterator for &'a ChainTable {
    type Item = &'a Sample;
    type IntoIter = std::slice::Iter<'a, Sample>;

    fn into_iter(self) -> Self::IntoIter {
        self.samples.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::Vector;

    /// Tables with crowded, even and double entries: every interval is the one that bisection finds.
    #[test]
    fn intervals_are_those_of_a_bisection() {
        let even: Vec<f64> = (0..=10).map(|k| 0.1 * k as f64).collect();
        let crowded: Vec<f64> = (0..=40).map(|k| 0.5f64.powi(40 - k)).collect();
        let double = vec![0.0, 0.3, 0.3, 0.4, 1.7, 1.7, 2.0];
        for places in [even, crowded, double, vec![0.0, 3.0]] {
            let sample = |s: &f64| Sample {
                s: *s,
                point: Point::new(*s, 0.0),
                tangent: Vector::x(),
                curvature: 0.0,
                segment: 0,
                t: 0.0,
            };
            let table: ChainTable = places.iter().map(sample).collect();
            let between = places.windows(2).map(|w| 0.5 * (w[0] + w[1]));
            let wanted = |s: f64| {
                let mut i = table.partition_point(|x| x.s <= s).clamp(1, table.len() - 1) - 1;
                while i > 0 && table[i + 1].s <= table[i].s {
                    i -= 1;
                }
                i
            };
            let near = places.iter().flat_map(|s| [s.next_down().max(0.0), *s, s.next_up()]);
            for s in near.chain(between) {
                assert_eq!(table.interval(s), wanted(s), "{s} in {places:?}");
            }
        }
    }
}
