//! The table of a chain and what evaluates it fast: the cubic between two samples by its coefficients, and an even grid
//! over the arc length, by which an interval is found in a step or two. The optimiser asks for millions of points.

use super::boundary::Sample;
use crate::numerics::Point;
use std::ops::Deref;

/// Intervals of one cell of the grid up to which they are gone through one by one.
const FEW_INTERVALS: usize = 8;
/// Cells for each interval.
const CELLS_PER_INTERVAL: usize = 2;

/// Samples by ascending arc length, at least two once they are used. Where two segments join the sample is there twice,
/// once for each. Read as a slice.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ChainTable {
    samples: Vec<Sample>,
    /// Arc lengths of the samples.
    starts: Vec<f64>,
    /// The cubic of each interval, in powers of the arc length from its start: x and y of each coefficient.
    cubics: Vec<[[f64; 2]; 4]>,
    /// For each cell the last interval that begins in a cell before it (the first where there is none); then the last
    /// interval that has a length.
    cells: Vec<u32>,
    cells_per_length: f64,
}

/// The number of the cell at `x` cells: rounded, which rises with x, and that is all that is asked of it. Numbers that
/// are none have some cell.
#[inline(always)]
fn cell_at(x: f64, count: usize) -> usize {
    /// From here on the lowest bits of a number count whole cells.
    const WHOLE: f64 = (1u64 << 52) as f64;
    ((x.max(0.0) + WHOLE).to_bits() as u32 as usize).min(count)
}

impl ChainTable {
    /// The interval that holds arc length `s`, of those that have a length; the first or the last where there is none.
    #[inline(always)]
    pub(crate) fn interval(&self, s: f64) -> usize {
        let starts = &self.starts[..];
        let count = self.cells.len() - 1;
        let cell = cell_at(s * self.cells_per_length, count - 1);
        let (mut i, next, last) =
            (self.cells[cell] as usize, self.cells[cell + 1] as usize, self.cells[count] as usize);
        if next > i + FEW_INTERVALS {
            i += starts[i + 1..=next].partition_point(|x| *x <= s);
        }
        while i < last && starts[i + 1] <= s {
            i += 1;
        }
        i
    }

    /// Point and derivative at arc length `s`: x, y.
    #[inline(always)]
    pub(crate) fn evaluate(&self, s: f64) -> [[f64; 2]; 2] {
        let i = self.interval(s);
        let (u, [a, b, c, d]) = (s - self.starts[i], &self.cubics[i]);
        let (mut point, mut slope) = ([0.0; 2], [0.0; 2]);
        for k in 0..2 {
            let bend = u * d[k];
            let rise = b[k] + u * (c[k] + bend);
            point[k] = a[k] + u * rise;
            slope[k] = rise + u * (c[k] + 2.0 * bend);
        }
        [point, slope]
    }

    /// Moves sample `i` to another point, at the same arc length.
    pub(crate) fn move_point(&mut self, i: usize, point: Point) {
        self.samples[i].point = point;
        for k in i.saturating_sub(1)..(i + 1).min(self.cubics.len()) {
            self.cubics[k] = cubic(&self.samples[k], &self.samples[k + 1]);
        }
    }
}

/// The cubic Hermite interpolant from `a` to `b`.
fn cubic(a: &Sample, b: &Sample) -> [[f64; 2]; 4] {
    let h = b.s - a.s;
    let mean = (b.point - a.point) / h;
    let second = (3.0 * mean - 2.0 * a.tangent - b.tangent) / h;
    let third = (a.tangent + b.tangent - 2.0 * mean) / (h * h);
    [a.point.coords, a.tangent, second, third].map(Into::into)
}

impl From<Vec<Sample>> for ChainTable {
    fn from(mut samples: Vec<Sample>) -> Self {
        // The boundary is kept to the end.
        samples.shrink_to_fit();
        let intervals = samples.len().saturating_sub(1);
        let count = CELLS_PER_INTERVAL * intervals;
        let length = samples.last().map_or(0.0, |x| x.s);
        let cells_per_length = if length > 0.0 { count as f64 / length } else { 0.0 };
        // The double samples at joints bound an interval of no length.
        let last = (0..intervals).rev().find(|&i| samples[i + 1].s > samples[i].s).unwrap_or(0);
        let mut cells: Vec<u32> = Vec::with_capacity(count + 1);
        for (i, sample) in samples[..intervals].iter().enumerate() {
            let of_sample = cell_at(sample.s * cells_per_length, count.saturating_sub(1));
            cells.resize(cells.len().max(of_sample + 1), i.saturating_sub(1).min(last) as u32);
        }
        cells.resize(count, last as u32);
        cells.push(last as u32);
        let starts = samples.iter().map(|x| x.s).collect();
        let cubics = samples.windows(2).map(|w| cubic(&w[0], &w[1])).collect();
        ChainTable { samples, starts, cubics, cells, cells_per_length }
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
        let double = vec![0.0, 0.3, 0.3, 0.4, 1.7, 1.7, 2.0, 2.0];
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
