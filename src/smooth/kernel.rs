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
/// edges; `c` values, `d` slopes; `[side][x or y][lane]`. There are as many samples as the reference has, and
/// L lanes, a few more: the compiler keeps whole vectors of lanes in registers. Lanes left over repeat the last
/// sample and have no weight.
pub(super) struct Sides<const L: usize> {
    pub c: [[[f64; L]; 2]; 4],
    pub d: [[[f64; L]; 2]; 4],
}

impl<const L: usize> Sides<L> {
    pub const ZERO: Self = Sides { c: [[[0.0; L]; 2]; 4], d: [[[0.0; L]; 2]; 4] };

    /// Reads side `side` from an edge's lanes (c x, c y, d x, d y); backwards if
    /// `flip`.
    #[inline(always)]
    pub fn read(&mut self, side: usize, edge: &[f64], lanes: &Lanes<L>, flip: bool) {
        let back = &lanes.back;
        for axis in 0..2 {
            let (c, d) = (&mut self.c[side][axis], &mut self.d[side][axis]);
            c.copy_from_slice(&edge[axis * L..(axis + 1) * L]);
            d.copy_from_slice(&edge[(axis + 2) * L..(axis + 3) * L]);
            if flip {
                let (forth, slopes) = (*c, *d);
                for k in 0..L {
                    let from = back[k] % L;
                    (c[k], d[k]) = (forth[from], -slopes[from]);
                }
            }
        }
    }

    /// Adds side `side` of a gradient to an edge's.
    #[inline(always)]
    pub fn add_to(&self, side: usize, edge: &mut [f64], lanes: &Lanes<L>, flip: bool) {
        let ahead = &lanes.swap;
        for axis in 0..2 {
            let (mut c, mut d) = (self.c[side][axis], self.d[side][axis]);
            if flip {
                let (forth, slopes) = (c, d);
                for k in 0..L {
                    let from = ahead[k] % L;
                    (c[k], d[k]) = (forth[from], -slopes[from]);
                }
            }
            for (e, g) in edge[axis * L..(axis + 1) * L].iter_mut().zip(c) {
                *e += g;
            }
            for (e, g) in edge[(axis + 2) * L..(axis + 3) * L].iter_mut().zip(d) {
                *e += g;
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

/// Parameters of the samples along a side and their number; lanes left over repeat the last one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lanes<const L: usize> {
    pub t: [f64; L],
    pub count: usize,
    /// The lane of the sample that each has seen from the other end, ...
    back: [usize; L],
    /// ... and the same with the lanes left over in their places.
    swap: [usize; L],
}

impl<const L: usize> Lanes<L> {
    /// For the parameters `samples`, at least one and at most L.
    #[inline(always)]
    pub fn new(samples: &[f64]) -> Self {
        let count = samples.len().min(L);
        let (mut t, mut back, mut swap) = ([0.0; L], [0; L], [0; L]);
        for k in 0..L {
            t[k] = samples[k.min(count - 1)];
            back[k] = count.saturating_sub(k + 1);
            swap[k] = if k < count { count - 1 - k } else { k };
        }
        Lanes { t, count, back, swap }
    }
}

impl Lanes<2> {
    /// The two ends alone.
    pub const ENDS: Self = Lanes { t: [0.0, 1.0], count: 2, back: [1, 0], swap: [1, 0] };
}

/// Energy of an element (mean over the samples), its gradient in
/// `gradient`, and the least d/A. `None` if the measure is a shape and some d ≤ 0.
#[inline(always)]
pub(super) fn element<const L: usize>(
    measure: Measure,
    lanes: &Lanes<L>,
    sides: &Sides<L>,
    target: Target,
    gradient: &mut Sides<L>,
) -> Option<(f64, f64)> {
    match measure {
        Measure::Shape(1) => run::<L, 1>(0.0, lanes, sides, target, gradient),
        Measure::Shape(2) => run::<L, 2>(0.0, lanes, sides, target, gradient),
        Measure::Shape(4) => run::<L, 4>(0.0, lanes, sides, target, gradient),
        Measure::Shape(_) => run::<L, 8>(0.0, lanes, sides, target, gradient),
        Measure::Regularised { epsilon } => run::<L, 0>(epsilon, lanes, sides, target, gradient),
    }
}

/// Slopes of the sides less those of the bilinear map, and c₂ − c₀ along ξ.
#[inline(always)]
fn differences<const L: usize>(sides: &Sides<L>) -> ([[[f64; L]; 2]; 4], [[f64; L]; 2]) {
    let (c, d) = (&sides.c, &sides.d);
    let mut e = [[[0.0; L]; 2]; 4];
    let mut w = [[0.0; L]; 2];
    for axis in 0..2 {
        // The last lane is the last sample.
        let corner = [c[0][axis][0], c[0][axis][L - 1], c[2][axis][L - 1], c[2][axis][0]];
        let straight =
            [corner[1] - corner[0], corner[2] - corner[1], corner[2] - corner[3], corner[3] - corner[0]];
        for side in 0..4 {
            for k in 0..L {
                e[side][axis][k] = d[side][axis][k] - straight[side];
            }
        }
        for k in 0..L {
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

/// The smaller of the two; a NaN in `b` is passed over.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if b < a {
        b
    } else {
        a
    }
}

/// Sum and least value of lanes, halves first: in the same order whatever the width of the registers.
#[inline(always)]
pub(super) fn sum<const L: usize>(mut lanes: [f64; L]) -> f64 {
    let mut width = L;
    while width > 1 {
        let half = width.div_ceil(2);
        for k in half..width {
            lanes[k - half] += lanes[k];
        }
        width = half;
    }
    lanes[0]
}

/// The sums of several.
#[inline(always)]
fn sums<const L: usize, const M: usize>(lanes: [[f64; L]; M]) -> [f64; M] {
    let mut sums = [0.0; M];
    for (total, lanes) in sums.iter_mut().zip(lanes) {
        *total = sum(lanes);
    }
    sums
}

#[inline(always)]
fn least_of<const L: usize>(lanes: &[f64; L]) -> f64 {
    let mut least = lanes[0];
    for lane in lanes {
        least = lesser(least, *lane);
    }
    least
}

/// Samples an element.
#[inline(always)]
pub(super) fn jacobians<const L: usize>(lanes: &Lanes<L>, sides: &Sides<L>) -> Sampled {
    let (c, t) = (&sides.c, &lanes.t);
    let (e, w) = differences(sides);
    let mut least = [f64::INFINITY; L];
    let mut most = [f64::INFINITY; L];
    let mut scaled = [f64::INFINITY; L];
    for j in 0..lanes.count.min(L) {
        let (tj, uj) = (t[j], 1.0 - t[j]);
        let (vx, vy) = (c[1][0][j] - c[3][0][j], c[1][1][j] - c[3][1][j]);
        let (e1x, e1y, e3x, e3y) = (e[1][0][j], e[1][1][j], e[3][0][j], e[3][1][j]);
        for i in 0..L {
            let ax = uj * e[0][0][i] + tj * e[2][0][i] + vx;
            let ay = uj * e[0][1][i] + tj * e[2][1][i] + vy;
            let bx = (1.0 - t[i]) * e3x + t[i] * e1x + w[0][i];
            let by = (1.0 - t[i]) * e3y + t[i] * e1y + w[1][i];
            let det = ax * by - ay * bx;
            let norms = ((ax * ax + ay * ay) * (bx * bx + by * by)).sqrt();
            least[i] = lesser(least[i], det);
            most[i] = lesser(most[i], -det);
            scaled[i] =
                lesser(scaled[i], det / if norms > f64::MIN_POSITIVE { norms } else { f64::MIN_POSITIVE });
        }
    }
    Sampled { least: least_of(&least), most: -least_of(&most), scaled: least_of(&scaled) }
}

/// P = 0: the regularised measure.
#[inline(always)]
fn run<const L: usize, const P: u32>(
    epsilon: f64,
    lanes: &Lanes<L>,
    sides: &Sides<L>,
    target: Target,
    out: &mut Sides<L>,
) -> Option<(f64, f64)> {
    let (c, t, count) = (&sides.c, &lanes.t, lanes.count.min(L));
    let (slopes, across) = differences(sides);
    let [[e0x, e0y], [e2x, e2y], [wx, wy]] = [slopes[0], slopes[2], across];
    let (r, ri) = (target.ratio, 1.0 / target.ratio);
    let (area, area_i) = (target.area, 1.0 / target.area);
    let (angle, even) = (0.5 * (1.0 - target.evenness), 0.5 * target.evenness);
    let shift = (epsilon * target.area) * (epsilon * target.area);
    let (shift_i, size) = (2.0 / shift, 0.5 * SIZE_WEIGHT);
    let mut weights = [1.0; L];
    weights[count..].fill(0.0);
    let mut energy = [0.0; L];
    let mut least = [f64::INFINITY; L];
    // Gradients: to the slopes of sides 0 and 2, to c₂ − c₀ along ξ; the others are sums over rows.
    let [mut g0x, mut g0y, mut g2x, mut g2y, mut gwx, mut gwy] = [[0.0; L]; 6];
    let mut g1 = [[0.0; L]; 2];
    let mut g3 = [[0.0; L]; 2];
    let mut gv = [[0.0; L]; 2]; // to c₁ − c₃ along η
    for j in 0..count {
        let (tj, uj) = (t[j], 1.0 - t[j]);
        let (vx, vy) = (c[1][0][j] - c[3][0][j], c[1][1][j] - c[3][1][j]);
        let (e3x, e3y) = (slopes[3][0][j], slopes[3][1][j]);
        let (sx, sy) = (slopes[1][0][j] - e3x, slopes[1][1][j] - e3y);
        let mut row = [[0.0; L]; 6];
        for i in 0..L {
            let ax = uj * e0x[i] + tj * e2x[i] + vx;
            let ay = uj * e0y[i] + tj * e2y[i] + vy;
            let bx = e3x + t[i] * sx + wx[i];
            let by = e3y + t[i] * sy + wy[i];
            let det = ax * by - ay * bx;
            least[i] = lesser(least[i], det);
            let norms = r * (ax * ax + ay * ay) + ri * (bx * bx + by * by);
            // The gradient is g_a = linear · r a − cross · (d's gradient), likewise for b.
            let (linear, cross, value);
            if P == 0 {
                // χ = s/2 for d > 0, else (εA)²/(2s), s = √(d² + (εA)²) + |d|: neither cancels.
                let root = (det * det + shift).sqrt();
                let s = root + det.abs();
                let chi_i = if det > 0.0 { 2.0 / s } else { s * shift_i };
                let f = (0.5 * norms + size * (det * det * area_i + area)) * chi_i;
                value = f;
                linear = chi_i;
                cross = f / root - 2.0 * size * det * area_i * chi_i;
            } else {
                let inverse = 1.0 / det;
                let shape = angle * norms * inverse;
                let (up, down) = (even * det * area_i, even * area * inverse);
                let f = shape + up + down;
                let power = power_less_one::<P>(f);
                value = f * power;
                let slope = power * inverse;
                linear = 2.0 * angle * slope;
                cross = slope * (shape + down - up);
            }
            let (linear, cross) = (linear * weights[i], cross * weights[i]);
            energy[i] += value * weights[i];
            let (lr, li) = (linear * r, linear * ri);
            let gax = lr * ax - cross * by;
            let gay = lr * ay + cross * bx;
            let gbx = li * bx + cross * ay;
            let gby = li * by - cross * ax;
            g0x[i] += uj * gax;
            g0y[i] += uj * gay;
            g2x[i] += tj * gax;
            g2y[i] += tj * gay;
            gwx[i] += gbx;
            gwy[i] += gby;
            row[0][i] = gax;
            row[1][i] = gay;
            row[2][i] = gbx;
            row[3][i] = gby;
            row[4][i] = t[i] * gbx;
            row[5][i] = t[i] * gby;
        }
        let row = sums(row);
        (gv[0][j], gv[1][j]) = (row[0], row[1]);
        (g3[0][j], g3[1][j]) = (row[2] - row[4], row[3] - row[5]);
        (g1[0][j], g1[1][j]) = (row[4], row[5]);
        if P != 0 && least_of(&least) <= 0.0 {
            return None;
        }
    }
    let weight = 1.0 / (count * count) as f64;
    let along = [[g0x, g0y], [g2x, g2y], [gwx, gwy]];
    for axis in 0..2 {
        let [g0, g2, gw] = [along[0][axis], along[1][axis], along[2][axis]];
        let mut sums = [0.0; 4];
        for (side, g) in [g0, g1[axis], g2, g3[axis]].into_iter().enumerate() {
            for k in 0..L {
                out.d[side][axis][k] = g[k] * weight;
            }
            sums[side] = sum(out.d[side][axis]);
        }
        for k in 0..L {
            out.c[0][axis][k] = -gw[k] * weight;
            out.c[2][axis][k] = gw[k] * weight;
            out.c[1][axis][k] = gv[axis][k] * weight;
            out.c[3][axis][k] = -gv[axis][k] * weight;
        }
        // The slopes had those of the straight sides taken off, which hang on the corners.
        out.c[0][axis][0] += sums[0] + sums[3];
        out.c[0][axis][count - 1] += sums[1] - sums[0];
        out.c[2][axis][count - 1] -= sums[1] + sums[2];
        out.c[2][axis][0] += sums[2] - sums[3];
    }
    let scale = if P == 0 { weight } else { weight / P as f64 };
    Some((sum(energy) * scale, least_of(&least) / target.area))
}
