//! Evaluation of a chain at many arc lengths, four points at once.

use super::boundary::Chain;

/// Points evaluated at once.
pub(crate) const FOUR: usize = 4;

/// Points and derivatives of a chain at four arc lengths: x, y and their derivatives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Four {
    pub point: [[f64; FOUR]; 2],
    pub slope: [[f64; FOUR]; 2],
}

/// Calls `out` for each four of the arc lengths `start + length · parameters[k]`, with the place of the first
/// among the parameters in [0, 1]; a last four may be incomplete and ends in copies of its last.
/// Same values as [`Chain::evaluate`].
#[inline(always)]
pub(crate) fn walk(
    chain: &Chain,
    [start, length]: [f64; 2],
    parameters: &[f64],
    mut out: impl FnMut(usize, Four),
) {
    let table = &chain.samples;
    for (first, four) in (0..).step_by(FOUR).zip(parameters.chunks(FOUR)) {
        let mut x = [0.0; FOUR];
        let mut h = [1.0; FOUR];
        // Points and tangents at both ends of each interval: x, then y.
        let (mut p, mut d, mut t0, mut t1) =
            ([[0.0; FOUR]; 2], [[0.0; FOUR]; 2], [[0.0; FOUR]; 2], [[0.0; FOUR]; 2]);
        for k in 0..FOUR {
            let s = chain.wrap(start + length * four[k.min(four.len() - 1)]);
            let i = table.interval(s);
            let (a, b) = (&table[i], &table[i + 1]);
            h[k] = b.s - a.s;
            x[k] = (s - a.s) / h[k];
            for axis in 0..2 {
                p[axis][k] = a.point[axis];
                d[axis][k] = b.point[axis] - a.point[axis];
                t0[axis][k] = a.tangent[axis];
                t1[axis][k] = b.tangent[axis];
            }
        }
        let mut found = Four { point: p, slope: d };
        for axis in 0..2 {
            for k in 0..FOUR {
                let (x, h, d) = (x[k], h[k], d[axis][k]);
                let (x2, x3) = (x * x, x * x * x);
                let (m0, m1) = (t0[axis][k] * h, t1[axis][k] * h);
                let rise = 3.0 * x2 - 2.0 * x3;
                found.point[axis][k] = p[axis][k] + m0 * (x3 - 2.0 * x2 + x) + d * rise + m1 * (x3 - x2);
                let ends = m0 * (3.0 * x2 - 4.0 * x + 1.0) + m1 * (3.0 * x2 - 2.0 * x);
                found.slope[axis][k] = (ends + d * (6.0 * x - 6.0 * x2)) / h;
            }
        }
        out(first, found);
    }
}
