//! Evaluation of a chain at many ascending arc lengths: one search, then steps along the table.

use crate::domain::Chain;
use crate::numerics::Vector;

/// Calls `out(k, point, derivative)` for the arc lengths `start + length · parameters[k]`,
/// parameters ascending in [0, 1]. Same values as [`Chain::evaluate`].
pub(super) fn walk(
    chain: &Chain,
    start: f64,
    length: f64,
    parameters: &[f64],
    mut out: impl FnMut(usize, Vector, Vector),
) {
    let table = &chain.samples;
    let last = table.len() - 2;
    let (mut i, mut before) = (usize::MAX, f64::INFINITY);
    for (k, t) in parameters.iter().enumerate() {
        let s = chain.wrap(start + length * t);
        if s < before {
            i = table.partition_point(|x| x.s <= s).clamp(1, last + 1) - 1;
        }
        before = s;
        while i < last && table[i + 1].s <= s {
            i += 1;
        }
        // The double samples at joints bound an interval of no length.
        while i > 0 && table[i + 1].s <= table[i].s {
            i -= 1;
        }
        let (a, b) = (&table[i], &table[i + 1]);
        let h = b.s - a.s;
        let x = (s - a.s) / h;
        let (x2, x3) = (x * x, x * x * x);
        let (m0, m1) = (a.tangent * h, b.tangent * h);
        let d = b.point - a.point;
        let p = a.point.coords + m0 * (x3 - 2.0 * x2 + x) + d * (3.0 * x2 - 2.0 * x3) + m1 * (x3 - x2);
        let v = (m0 * (3.0 * x2 - 4.0 * x + 1.0) + d * (6.0 * x - 6.0 * x2) + m1 * (3.0 * x2 - 2.0 * x)) / h;
        out(k, p, v);
    }
}
