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
    for (first, four) in (0..).step_by(FOUR).zip(parameters.chunks(FOUR)) {
        let (mut point, mut slope) = ([[0.0; FOUR]; 2], [[0.0; FOUR]; 2]);
        for k in 0..FOUR {
            let s = chain.wrap(start + length * four[k.min(four.len() - 1)]);
            let [p, d] = chain.samples.evaluate(s);
            for axis in 0..2 {
                (point[axis][k], slope[axis][k]) = (p[axis], d[axis]);
            }
        }
        out(first, Four { point, slope });
    }
}
