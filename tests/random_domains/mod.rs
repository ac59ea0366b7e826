//! Random domains as control files, each from its seed.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;

/// A random domain and what it is to be meshed with.
pub struct Case {
    pub kind: &'static str,
    pub text: String,
    pub order: usize,
    pub relative: f64,
}

/// A sequence of numbers in [0, 1): splitmix64 (Steele, Lea, Flood 2014).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.next()
    }

    /// A whole number from a to b, both included.
    fn whole(&mut self, a: usize, b: usize) -> usize {
        a + ((b - a + 1) as f64 * self.next()) as usize
    }
}

type Point = [f64; 2];

/// A loop, counter-clockwise.
#[derive(Clone)]
enum Loop {
    Polygon(Vec<Point>),
    /// Centre, radius, and waves (number, height, phase) on it.
    Blob(Point, f64, Vec<(usize, f64, f64)>),
    /// Centre, radius, first angle, angle: a sector with its tip at the centre.
    Sector(Point, f64, f64, f64),
}

impl Loop {
    fn curves(&self) -> String {
        let mut out = String::new();
        match self {
            Loop::Polygon(points) => {
                for (k, p) in points.iter().enumerate() {
                    line(&mut out, *p, points[(k + 1) % points.len()]);
                }
            }
            Loop::Blob(center, radius, waves) => {
                let mut r = format!("{radius:.17}");
                for (n, height, phase) in waves {
                    write!(r, " + {:.17}*cos({n}*2*pi*t + {phase:.17})", radius * height).unwrap();
                }
                let [x, y] = center;
                write!(
                    out,
                    "\\begin{{PARAMETRIC_EQUATION_CURVE}}\nname = blob\nxeqn = x(t) = {x:.17} + ({r})*cos(2*pi*t)\n\
                     yeqn = y(t) = {y:.17} + ({r})*sin(2*pi*t)\nzeqn = z(t) = 0\n\\end{{PARAMETRIC_EQUATION_CURVE}}\n"
                )
                .unwrap();
            }
            Loop::Sector(center, radius, first, angle) => {
                let at = |a: f64| [center[0] + radius * a.cos(), center[1] + radius * a.sin()];
                line(&mut out, *center, at(*first));
                write!(
                    out,
                    "\\begin{{CIRCULAR_ARC}}\nname = arc\nunits = radians\ncenter = [{:.17}, {:.17}, 0.0]\n\
                     radius = {radius:.17}\nstart angle = {first:.17}\nend angle = {:.17}\n\\end{{CIRCULAR_ARC}}\n",
                    center[0],
                    center[1],
                    first + angle
                )
                .unwrap();
                line(&mut out, at(first + angle), *center);
            }
        }
        out
    }
}

fn line(out: &mut String, a: Point, b: Point) {
    write!(
        out,
        "\\begin{{END_POINTS_LINE}}\nname = line\nxStart = [{:.17}, {:.17}, 0.0]\nxEnd = [{:.17}, {:.17}, 0.0]\n\
         \\end{{END_POINTS_LINE}}\n",
        a[0], a[1], b[0], b[1]
    )
    .unwrap();
}

fn control(outer: &Loop, holes: &[Loop]) -> String {
    let mut inner = String::new();
    for (k, hole) in holes.iter().enumerate() {
        write!(inner, "\\begin{{CHAIN}}\nname = hole{k}\n{}\\end{{CHAIN}}\n", hole.curves()).unwrap();
    }
    format!(
        "\\begin{{MODEL}}\n\\begin{{OUTER_BOUNDARY}}\n{}\\end{{OUTER_BOUNDARY}}\n\\begin{{INNER_BOUNDARIES}}\n{inner}\
         \\end{{INNER_BOUNDARIES}}\n\\end{{MODEL}}\n\\end{{FILE}}\n",
        outer.curves()
    )
}

fn circle(center: Point, radius: f64) -> Loop {
    Loop::Blob(center, radius, Vec::new())
}

/// A smooth loop within `radius` of its centre, at least a third of it away.
fn blob(random: &mut Random, center: Point, radius: f64) -> Loop {
    let count = random.whole(1, 3);
    let waves: Vec<_> = (0..count)
        .map(|_| (random.whole(2, 6), random.between(0.02, 0.5) / count as f64, random.between(0.0, TAU)))
        .collect();
    Loop::Blob(center, radius / 1.5, waves)
}

/// A star-shaped polygon within `radius` of its centre.
fn polygon(random: &mut Random, center: Point, radius: f64, most: usize) -> Loop {
    let n = random.whole(3, most);
    let turn = random.between(0.0, TAU);
    let corner = |k: usize, random: &mut Random| {
        let angle = turn + TAU * (k as f64 + random.between(-0.35, 0.35)) / n as f64;
        let r = radius * random.between(0.35, 1.0);
        [center[0] + r * angle.cos(), center[1] + r * angle.sin()]
    };
    Loop::Polygon((0..n).map(|k| corner(k, random)).collect())
}

/// Tips all around.
fn star(random: &mut Random) -> Loop {
    let tips = random.whole(3, 8);
    let (inner, turn) = (random.between(0.2, 0.8), random.between(0.0, TAU));
    let corner = |k: usize| {
        let (angle, r) = (turn + PI * k as f64 / tips as f64, if k % 2 == 0 { 1.0 } else { inner });
        [r * angle.cos(), r * angle.sin()]
    };
    Loop::Polygon((0..2 * tips).map(corner).collect())
}

/// A disc, blob or polygon with holes that keep apart.
fn with_holes(random: &mut Random) -> (Loop, Vec<Loop>) {
    let (outer, room) = match random.whole(0, 2) {
        0 => (circle([0.0; 2], 1.0), 1.0),
        1 => (Loop::Polygon(vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]), 1.0),
        // Its waves reach to half of the mean radius.
        _ => (blob(random, [0.0; 2], 2.0), 2.0 / 3.0),
    };
    let wanted = random.whole(1, 6);
    let mut discs: Vec<(Point, f64)> = Vec::new();
    let mut holes = Vec::new();
    for _ in 0..200 {
        if holes.len() == wanted {
            break;
        }
        let center = [random.between(-room, room), random.between(-room, room)];
        let radius = random.between(0.04, 0.35) * room;
        let gap = random.between(0.01, 0.2) * room;
        let inside = center[0].hypot(center[1]) + radius + gap < room;
        let apart = |d: &(Point, f64)| (center[0] - d.0[0]).hypot(center[1] - d.0[1]) > radius + d.1 + gap;
        if inside && discs.iter().all(apart) {
            discs.push((center, radius));
            holes.push(match random.whole(0, 2) {
                0 => circle(center, radius),
                1 => blob(random, center, radius),
                _ => polygon(random, center, radius, 6),
            });
        }
    }
    (outer, holes)
}

/// One corner of any angle from 6° to 354°.
fn corner(random: &mut Random) -> Loop {
    let angle = random.between(6.0, 354.0).to_radians();
    let first = random.between(0.0, TAU);
    if random.next() < 0.5 || angle > PI {
        return Loop::Sector([0.0; 2], 1.0, first, angle);
    }
    // A kite.
    let at = |a: f64, r: f64| [r * a.cos(), r * a.sin()];
    let across = random.between(1.05, 2.0) * (0.5 * angle).cos();
    let tip = at(first + 0.5 * angle, across);
    Loop::Polygon(vec![[0.0; 2], at(first, 1.0), tip, at(first + angle, 1.0)])
}

/// A gap from 1e-1 down to 1e-4 of the domain.
fn gap(random: &mut Random) -> (Loop, Vec<Loop>) {
    let gap = 10f64.powf(-random.between(1.0, 4.0));
    match random.whole(0, 3) {
        0 => {
            let radius = random.between(0.2, 0.7);
            (circle([0.0; 2], 1.0), vec![circle([1.0 - radius - gap, 0.0], radius)])
        }
        1 => {
            let [a, b] = [random.between(0.1, 0.3), random.between(0.1, 0.3)];
            let square = Loop::Polygon(vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]);
            (square, vec![circle([-a - 0.5 * gap, 0.1], a), circle([b + 0.5 * gap, 0.1], b)])
        }
        2 => {
            let radius = random.between(0.2, 0.6);
            let square = Loop::Polygon(vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]);
            (square, vec![circle([0.1, -1.0 + radius + gap], radius)])
        }
        // All around: a bearing.
        _ => (circle([0.0; 2], 1.0), vec![circle([0.0; 2], 1.0 - gap.max(1e-3))]),
    }
}

/// The case of a seed.
pub fn case(seed: u64) -> Case {
    // Seeds that follow each other start far apart.
    let mut random = Random(seed.wrapping_mul(0xd134_2543_de82_ef95));
    let order = random.whole(2, 8);
    let relative = 10f64.powf(-random.between(2.0, 5.5));
    let (kind, outer, holes) = match seed % 6 {
        0 => ("blob", blob(&mut random, [0.0; 2], 1.0), vec![]),
        1 => ("polygon", polygon(&mut random, [0.0; 2], 1.0, 12), vec![]),
        2 => ("star", star(&mut random), vec![]),
        3 => {
            let (outer, holes) = with_holes(&mut random);
            ("holes", outer, holes)
        }
        4 => ("corner", corner(&mut random), vec![]),
        _ => {
            let (outer, holes) = gap(&mut random);
            ("gap", outer, holes)
        }
    };
    Case { kind, text: control(&outer, &holes), order, relative }
}
