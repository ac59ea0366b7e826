//! The shape energy of one element and its gradient with respect to the samples of its four edges.
//!
//! The element is the Coons blend of its edges c₀ … c₃ (0 and 2 along ξ, 1 and 3 along η):
//! X = (1−η) c₀(ξ) + η c₂(ξ) + (1−ξ) c₃(η) + ξ c₁(η) − bilinear. So a = X_ξ and b = X_η at the
//! samples need only the values and slopes of the edges there, and the gradient flows back to them.

// Several arrays run in step in every loop here; zipping them would hide the formulas.
#![allow(clippy::needless_range_loop)]

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
fn power_less_one<const P: u32>(f: f64) -> f64 {
    match P {
        1 => 1.0,
        2 => f,
        4 => f * f * f,
        _ => {
            let f2 = f * f;
            f2 * f2 * f2 * f
        }
    }
}

/// Energy of an element (mean over the K × K samples at parameters `t`), its gradient in
/// `gradient`, and the least d/A. `None` if the measure is a shape and some d ≤ 0.
#[inline]
pub(super) fn element<const K: usize>(
    measure: Measure,
    t: &[f64; K],
    sides: &Sides<K>,
    target: Target,
    gradient: &mut Sides<K>,
) -> Option<(f64, f64)> {
    match measure {
        Measure::Shape(1) => run::<K, 1>(0.0, t, sides, target, gradient),
        Measure::Shape(2) => run::<K, 2>(0.0, t, sides, target, gradient),
        Measure::Shape(4) => run::<K, 4>(0.0, t, sides, target, gradient),
        Measure::Shape(_) => run::<K, 8>(0.0, t, sides, target, gradient),
        Measure::Regularised { epsilon } => run::<K, 0>(epsilon, t, sides, target, gradient),
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

/// The least and the largest d over the samples.
pub(super) fn jacobians<const K: usize>(t: &[f64; K], sides: &Sides<K>) -> (f64, f64) {
    let c = &sides.c;
    let (e, w) = differences(sides);
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
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
        }
    }
    (least, most)
}

/// P = 0: the regularised measure.
#[inline]
fn run<const K: usize, const P: u32>(
    epsilon: f64,
    t: &[f64; K],
    sides: &Sides<K>,
    target: Target,
    out: &mut Sides<K>,
) -> Option<(f64, f64)> {
    let c = &sides.c;
    let (e, w) = differences(sides);
    let (r, ri) = (target.ratio, 1.0 / target.ratio);
    let (area, area_i) = (target.area, 1.0 / target.area);
    let (angle, even) = (1.0 - target.evenness, 0.5 * target.evenness);
    let shift = (epsilon * area) * (epsilon * area);
    let shift_i = 1.0 / shift;
    let weight = 1.0 / (K * K) as f64;
    let (mut energy, mut least) = ([0.0; K], [f64::INFINITY; K]);
    let mut g = [[[0.0; K]; 2]; 4]; // gradient with respect to e
    let mut gw = [[0.0; K]; 2]; // to w: c₂ − c₀ along ξ
    let mut gv = [[0.0; K]; 2]; // to c₁ − c₃ along η
    for j in 0..K {
        let (tj, uj) = (t[j], 1.0 - t[j]);
        let (vx, vy) = (c[1][0][j] - c[3][0][j], c[1][1][j] - c[3][1][j]);
        let (e3x, e3y, e1x, e1y) = (e[3][0][j], e[3][1][j], e[1][0][j], e[1][1][j]);
        let (sx, sy) = (e1x - e3x, e1y - e3y);
        // Rows first, sums afterwards: sums would keep the loop from running on vector registers.
        let (mut gax, mut gay, mut gbx, mut gby) = ([0.0; K], [0.0; K], [0.0; K], [0.0; K]);
        for i in 0..K {
            let ax = uj * e[0][0][i] + tj * e[2][0][i] + vx;
            let ay = uj * e[0][1][i] + tj * e[2][1][i] + vy;
            let bx = e3x + t[i] * sx + w[0][i];
            let by = e3y + t[i] * sy + w[1][i];
            let det = ax * by - ay * bx;
            least[i] = if det < least[i] { det } else { least[i] };
            let half = 0.5 * (r * (ax * ax + ay * ay) + ri * (bx * bx + by * by));
            // The gradient is g_a = linear · r a − cross · (d's gradient), likewise for b.
            let (linear, cross);
            if P == 0 {
                // χ = s/2 for d > 0, else (εA)²/(2s), s = √(d² + (εA)²) + |d|: neither cancels.
                let root = (det * det + shift).sqrt();
                let s = root + det.abs();
                let chi_i = if det > 0.0 { 2.0 / s } else { 2.0 * s * shift_i };
                let f = (half + 0.5 * SIZE_WEIGHT * (det * det * area_i + area)) * chi_i;
                energy[i] += f;
                linear = chi_i;
                cross = f / root - SIZE_WEIGHT * det * area_i * chi_i;
            } else {
                let inverse = 1.0 / det;
                let shape = angle * half * inverse;
                let (up, down) = (even * det * area_i, even * area * inverse);
                let f = shape + up + down;
                let power = power_less_one::<P>(f);
                energy[i] += f * power;
                let slope = power * inverse;
                linear = angle * slope;
                cross = slope * (shape + down - up);
            }
            gax[i] = linear * r * ax - cross * by;
            gay[i] = linear * r * ay + cross * bx;
            gbx[i] = linear * ri * bx + cross * ay;
            gby[i] = linear * ri * by - cross * ax;
        }
        for i in 0..K {
            g[0][0][i] += uj * gax[i];
            g[0][1][i] += uj * gay[i];
            g[2][0][i] += tj * gax[i];
            g[2][1][i] += tj * gay[i];
            gw[0][i] += gbx[i];
            gw[1][i] += gby[i];
        }
        let mut row = [0.0; 6];
        for i in 0..K {
            row[0] += gax[i];
            row[1] += gay[i];
            row[2] += gbx[i];
            row[3] += gby[i];
            row[4] += t[i] * gbx[i];
            row[5] += t[i] * gby[i];
        }
        (gv[0][j], gv[1][j]) = (row[0], row[1]);
        (g[3][0][j], g[3][1][j]) = (row[2] - row[4], row[3] - row[5]);
        (g[1][0][j], g[1][1][j]) = (row[4], row[5]);
        if P != 0 && least.iter().any(|d| *d <= 0.0) {
            return None;
        }
    }
    let energy: f64 = energy.iter().sum();
    let least = least.iter().copied().fold(f64::INFINITY, f64::min);
    for axis in 0..2 {
        let mut sum = [0.0; 4];
        for side in 0..4 {
            for k in 0..K {
                let value = g[side][axis][k] * weight;
                out.d[side][axis][k] = value;
                sum[side] += value;
            }
        }
        for k in 0..K {
            out.c[0][axis][k] = -gw[axis][k] * weight;
            out.c[2][axis][k] = gw[axis][k] * weight;
            out.c[1][axis][k] = gv[axis][k] * weight;
            out.c[3][axis][k] = -gv[axis][k] * weight;
        }
        // e holds minus the straight sides, which hang on the corners.
        out.c[0][axis][0] += sum[0] + sum[3];
        out.c[0][axis][K - 1] += sum[1] - sum[0];
        out.c[2][axis][K - 1] -= sum[1] + sum[2];
        out.c[2][axis][0] += sum[2] - sum[3];
    }
    let scale = if P == 0 { weight } else { weight / P as f64 };
    Some((energy * scale, least * area_i))
}
