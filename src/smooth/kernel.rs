//! The shape energy of one element and its gradient with respect to the samples of its four edges.
//!
//! The element is the Coons blend of its edges c₀ … c₃ (0 and 2 along ξ, 1 and 3 along η):
//! X = (1−η) c₀(ξ) + η c₂(ξ) + (1−ξ) c₃(η) + ξ c₁(η) − bilinear. So a = X_ξ and b = X_η at the
//! samples need only the values and slopes of the edges there, and the gradient flows back to them.

// Several arrays run in step in every loop here; zipping them would hide the formulas.
#![allow(clippy::needless_range_loop)]

use super::pair::Pair;

/// What is summed over the samples of an element (as a mean), from a = X_ξ, b = X_η, d = a × b.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Measure {
    /// f^p / p with f = (1 − w) (|a|² r + |b|²/r) / (2 d) + w (d/A + A/d) / 2. The first part is ≥ 1/sin of
    /// the angle between a and b, with equality at the aspect ratio r = ℓ₂/ℓ₁ to be kept;
    /// the second keeps d even inside the element. Infinite where d ≤ 0. p = 1, 2, 4 or 8.
    Shape(u32),
    /// (½(|a|² r + |b|²/r) + ½λ(d²/A + A)) / χ(d) with χ = (d + √(d² + (εA)²))/2: finite everywhere and
    /// pushing d to the positive side (Garanzha et al., *Foldover-free maps in 50 lines of
    /// code*, 2021). The λ term keeps inverted elements from shrinking instead.
    Regularised { epsilon: f64 },
}

/// λ above: size counts half as much as shape.
const SIZE_WEIGHT: f64 = 0.5;

/// Samples along an element's four sides, in the element's directions, as read from the shared
/// edges; `c` values, `d` slopes; `[side][x or y][sample]`.
pub(super) struct Sides<const K: usize> {
    pub c: [[[f64; K]; 2]; 4],
    pub d: [[[f64; K]; 2]; 4],
}

impl<const K: usize> Sides<K> {
    pub const ZERO: Self = Sides { c: [[[0.0; K]; 2]; 4], d: [[[0.0; K]; 2]; 4] };

    /// Reads side `side` from an edge's samples (c x, c y, d x, d y), backwards if `flip`.
    #[inline]
    pub fn read(&mut self, side: usize, edge: &[f64], flip: bool) {
        for axis in 0..2 {
            let (c, d) = (&edge[axis * K..(axis + 1) * K], &edge[(axis + 2) * K..(axis + 3) * K]);
            if flip {
                for k in 0..K {
                    self.c[side][axis][k] = c[K - 1 - k];
                    self.d[side][axis][k] = -d[K - 1 - k];
                }
            } else {
                self.c[side][axis].copy_from_slice(c);
                self.d[side][axis].copy_from_slice(d);
            }
        }
    }

    /// Adds side `side` of a gradient to an edge's.
    #[inline]
    pub fn add_to(&self, side: usize, edge: &mut [f64], flip: bool) {
        for axis in 0..2 {
            let (c, d) = (&self.c[side][axis], &self.d[side][axis]);
            if flip {
                for k in 0..K {
                    edge[axis * K + k] += c[K - 1 - k];
                    edge[(axis + 2) * K + k] -= d[K - 1 - k];
                }
            } else {
                for k in 0..K {
                    edge[axis * K + k] += c[k];
                    edge[(axis + 2) * K + k] += d[k];
                }
            }
        }
    }
}

/// Aspect ratio r = ℓ₂/ℓ₁ and area A that an element is measured against, and the weight w.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Target {
    pub ratio: f64,
    pub area: f64,
    pub evenness: f64,
}

/// `base` to the power p − 1 for the p that [`Measure::Shape`] allows.
#[inline(always)]
fn power_less_one<const P: u32>(f: Pair) -> Pair {
    match P {
        1 => Pair::splat(1.0),
        2 => f,
        4 => f * f * f,
        _ => {
            let f2 = f * f;
            f2 * f2 * f2 * f
        }
    }
}

/// Energy of an element (mean over the K × K samples, computed in H = ⌈K/2⌉ pairs, at parameters `t`), its gradient in
/// `gradient`, and the least d/A. `None` if the measure is a shape and some d ≤ 0.
#[inline]
pub(super) fn element<const K: usize, const H: usize>(
    measure: Measure,
    t: &[f64; K],
    sides: &Sides<K>,
    target: Target,
    gradient: &mut Sides<K>,
) -> Option<(f64, f64)> {
    match measure {
        Measure::Shape(1) => run::<K, H, 1>(0.0, t, sides, target, gradient),
        Measure::Shape(2) => run::<K, H, 2>(0.0, t, sides, target, gradient),
        Measure::Shape(4) => run::<K, H, 4>(0.0, t, sides, target, gradient),
        Measure::Shape(_) => run::<K, H, 8>(0.0, t, sides, target, gradient),
        Measure::Regularised { epsilon } => run::<K, H, 0>(epsilon, t, sides, target, gradient),
    }
}

/// Slopes of the sides less those of the bilinear map, and c₂ − c₀ along ξ.
#[inline(always)]
fn differences<const K: usize>(sides: &Sides<K>) -> ([[[f64; K]; 2]; 4], [[f64; K]; 2]) {
    let (c, d) = (&sides.c, &sides.d);
    let mut e = [[[0.0; K]; 2]; 4];
    let mut w = [[0.0; K]; 2];
    for axis in 0..2 {
        let corner = [c[0][axis][0], c[0][axis][K - 1], c[2][axis][K - 1], c[2][axis][0]];
        let straight =
            [corner[1] - corner[0], corner[2] - corner[1], corner[2] - corner[3], corner[3] - corner[0]];
        for side in 0..4 {
            for k in 0..K {
                e[side][axis][k] = d[side][axis][k] - straight[side];
            }
        }
        for k in 0..K {
            w[axis][k] = c[2][axis][k] - c[0][axis][k];
        }
    }
    (e, w)
}

/// What the samples of an element say without an energy.
pub(super) struct Sampled {
    /// Least and largest d, least d / (|a| |b|).
    pub least: f64,
    pub most: f64,
    pub scaled: f64,
}

/// Samples an element.
pub(super) fn jacobians<const K: usize>(t: &[f64; K], sides: &Sides<K>) -> Sampled {
    let c = &sides.c;
    let (e, w) = differences(sides);
    let (mut least, mut most, mut scaled) = (f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY);
    for j in 0..K {
        let (tj, uj) = (t[j], 1.0 - t[j]);
        for i in 0..K {
            let ax = uj * e[0][0][i] + tj * e[2][0][i] + c[1][0][j] - c[3][0][j];
            let ay = uj * e[0][1][i] + tj * e[2][1][i] + c[1][1][j] - c[3][1][j];
            let bx = (1.0 - t[i]) * e[3][0][j] + t[i] * e[1][0][j] + w[0][i];
            let by = (1.0 - t[i]) * e[3][1][j] + t[i] * e[1][1][j] + w[1][i];
            let det = ax * by - ay * bx;
            least = least.min(det);
            most = most.max(det);
            let norms = ((ax * ax + ay * ay) * (bx * bx + by * by)).sqrt();
            scaled = scaled.min(det / norms.max(f64::MIN_POSITIVE));
        }
    }
    Sampled { least, most, scaled }
}

/// Samples in pairs; an odd last one is repeated (and has no weight).
fn pairs<const K: usize, const H: usize>(values: &[f64; K]) -> [Pair; H] {
    let mut out = [Pair::splat(0.0); H];
    for h in 0..H {
        out[h] = Pair([values[2 * h], values[(2 * h + 1).min(K - 1)]]);
    }
    out
}

/// P = 0: the regularised measure.
#[inline]
fn run<const K: usize, const H: usize, const P: u32>(
    epsilon: f64,
    t: &[f64; K],
    sides: &Sides<K>,
    target: Target,
    out: &mut Sides<K>,
) -> Option<(f64, f64)> {
    let c = &sides.c;
    let (slopes, across) = differences(sides);
    let [e0x, e0y] = [pairs::<K, H>(&slopes[0][0]), pairs(&slopes[0][1])];
    let [e2x, e2y] = [pairs::<K, H>(&slopes[2][0]), pairs(&slopes[2][1])];
    let [wx, wy] = [pairs::<K, H>(&across[0]), pairs(&across[1])];
    let ts = pairs::<K, H>(t);
    let splat = Pair::splat;
    let (r, ri) = (splat(target.ratio), splat(1.0 / target.ratio));
    let (area, area_i) = (splat(target.area), splat(1.0 / target.area));
    let (angle, even) = (splat(0.5 * (1.0 - target.evenness)), splat(0.5 * target.evenness));
    let shift = (epsilon * target.area) * (epsilon * target.area);
    let (shift, shift_i) = (splat(shift), splat(2.0 / shift));
    let (half, two, size) = (splat(0.5), splat(2.0), splat(0.5 * SIZE_WEIGHT));
    let (mut energy, mut least) = (splat(0.0), splat(f64::INFINITY));
    // Gradients: to the slopes of sides 0 and 2, to c₂ − c₀ along ξ; the others are sums over rows.
    let mut g0 = [[splat(0.0); H]; 2];
    let mut g2 = [[splat(0.0); H]; 2];
    let mut gw = [[splat(0.0); H]; 2];
    let mut g1 = [[0.0; K]; 2];
    let mut g3 = [[0.0; K]; 2];
    let mut gv = [[0.0; K]; 2]; // to c₁ − c₃ along η
    for j in 0..K {
        let (tj, uj) = (splat(t[j]), splat(1.0 - t[j]));
        let (vx, vy) = (splat(c[1][0][j] - c[3][0][j]), splat(c[1][1][j] - c[3][1][j]));
        let (e3x, e3y) = (splat(slopes[3][0][j]), splat(slopes[3][1][j]));
        let (sx, sy) = (splat(slopes[1][0][j]) - e3x, splat(slopes[1][1][j]) - e3y);
        let mut row = [splat(0.0); 6];
        for h in 0..H {
            let ax = uj * e0x[h] + tj * e2x[h] + vx;
            let ay = uj * e0y[h] + tj * e2y[h] + vy;
            let bx = e3x + ts[h] * sx + wx[h];
            let by = e3y + ts[h] * sy + wy[h];
            let det = ax * by - ay * bx;
            least = least.min(det);
            let norms = r * (ax * ax + ay * ay) + ri * (bx * bx + by * by);
            // The gradient is g_a = linear · r a − cross · (d's gradient), likewise for b.
            let (mut linear, mut cross, mut value);
            if P == 0 {
                // χ = s/2 for d > 0, else (εA)²/(2s), s = √(d² + (εA)²) + |d|: neither cancels.
                let root = (det * det + shift).sqrt();
                let s = root + det.abs();
                let chi_i = det.choose_positive(two / s, s * shift_i);
                let f = (half * norms + size * (det * det * area_i + area)) * chi_i;
                value = f;
                linear = chi_i;
                cross = f / root - two * size * det * area_i * chi_i;
            } else {
                let inverse = splat(1.0) / det;
                let shape = angle * norms * inverse;
                let (up, down) = (even * det * area_i, even * area * inverse);
                let f = shape + up + down;
                let power = power_less_one::<P>(f);
                value = f * power;
                let slope = power * inverse;
                linear = two * angle * slope;
                cross = slope * (shape + down - up);
            }
            if K % 2 == 1 && h == H - 1 {
                let once = Pair([1.0, 0.0]);
                (value, linear, cross) = (value * once, linear * once, cross * once);
            }
            energy = energy + value;
            let (lr, li) = (linear * r, linear * ri);
            let gax = lr * ax - cross * by;
            let gay = lr * ay + cross * bx;
            let gbx = li * bx + cross * ay;
            let gby = li * by - cross * ax;
            g0[0][h] = g0[0][h] + uj * gax;
            g0[1][h] = g0[1][h] + uj * gay;
            g2[0][h] = g2[0][h] + tj * gax;
            g2[1][h] = g2[1][h] + tj * gay;
            gw[0][h] = gw[0][h] + gbx;
            gw[1][h] = gw[1][h] + gby;
            row[0] = row[0] + gax;
            row[1] = row[1] + gay;
            row[2] = row[2] + gbx;
            row[3] = row[3] + gby;
            row[4] = row[4] + ts[h] * gbx;
            row[5] = row[5] + ts[h] * gby;
        }
        let row = row.map(Pair::sum);
        (gv[0][j], gv[1][j]) = (row[0], row[1]);
        (g3[0][j], g3[1][j]) = (row[2] - row[4], row[3] - row[5]);
        (g1[0][j], g1[1][j]) = (row[4], row[5]);
        if P != 0 && least.least() <= 0.0 {
            return None;
        }
    }
    let weight = 1.0 / (K * K) as f64;
    for axis in 0..2 {
        let mut sum = [0.0; 4];
        for k in 0..K {
            let lane = |p: &[Pair; H]| p[k / 2].0[k % 2];
            let g = [lane(&g0[axis]), g1[axis][k], lane(&g2[axis]), g3[axis][k]];
            for side in 0..4 {
                let value = g[side] * weight;
                out.d[side][axis][k] = value;
                sum[side] += value;
            }
            out.c[0][axis][k] = -lane(&gw[axis]) * weight;
            out.c[2][axis][k] = lane(&gw[axis]) * weight;
            out.c[1][axis][k] = gv[axis][k] * weight;
            out.c[3][axis][k] = -gv[axis][k] * weight;
        }
        // The slopes had those of the straight sides taken off, which hang on the corners.
        out.c[0][axis][0] += sum[0] + sum[3];
        out.c[0][axis][K - 1] += sum[1] - sum[0];
        out.c[2][axis][K - 1] -= sum[1] + sum[2];
        out.c[2][axis][0] += sum[2] - sum[3];
    }
    let scale = if P == 0 { weight } else { weight / P as f64 };
    Some((energy.sum() * scale, least.least() / target.area))
}
