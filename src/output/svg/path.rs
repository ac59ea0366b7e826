//! Path data: absolute moves, then relative lines and cubics, with as few digits as the eye needs.

use super::canvas::Canvas;
use crate::numerics::{cross, Point, Vector};

/// Deviation in SVG units that the eye does not see.
const TOLERANCE: f64 = 0.12;

/// Path data in the making.
pub struct Path<'a> {
    canvas: &'a Canvas,
    data: String,
    /// Where the pen is, in hundredths of an SVG unit.
    pen: Option<[i64; 2]>,
    /// Coordinates are multiples of this many hundredths.
    grid: i64,
}

impl<'a> Path<'a> {
    /// An empty path.
    pub fn new(canvas: &'a Canvas) -> Self {
        Path { canvas, data: String::new(), pen: None, grid: 1 }
    }

    /// Rounds to tenths of an SVG unit from here on: enough for what is only a background.
    pub fn coarse(&mut self) {
        self.grid = 10;
    }

    /// The data.
    pub fn finish(self) -> String {
        self.data
    }

    /// Moves without drawing; nothing happens where the pen is there already.
    pub fn move_to(&mut self, p: Point) {
        let to = self.rounded(p);
        if self.pen != Some(to) {
            self.data.push('M');
            self.numbers(&to);
            self.pen = Some(to);
        }
    }

    /// A straight line.
    pub fn line_to(&mut self, p: Point) {
        let to = self.rounded(p);
        let pen = self.pen.unwrap_or(to);
        if pen != to {
            self.data.push('l');
            self.numbers(&[to[0] - pen[0], to[1] - pen[1]]);
        }
        self.pen = Some(to);
    }

    /// A cubic from where the pen is to `p`, with the derivatives at its ends over a parameter in
    /// [0, 1]; a line where it is straight.
    pub fn hermite_to(&mut self, from: Point, leaving: Vector, p: Point, arriving: Vector) {
        let start = self.pen.unwrap_or_else(|| self.rounded(from));
        let shape = [from + leaving / 3.0, p - arriving / 3.0, p];
        let offsets = shape.map(|q| {
            let to = self.rounded(q);
            [to[0] - start[0], to[1] - start[1]]
        });
        let [a, b, chord] = offsets.map(|o| Vector::new(o[0] as f64, o[1] as f64) / 100.0);
        if off_line(chord, a).max(off_line(chord, b)) < TOLERANCE {
            return self.line_to(p);
        }
        self.data.push('c');
        self.numbers(offsets.as_flattened());
        self.pen = Some(self.rounded(p));
    }

    /// A polyline that starts with a move; points that the eye does not miss are left out.
    pub fn polyline(&mut self, points: impl IntoIterator<Item = Point>) {
        let mut points = points.into_iter();
        let Some(mut anchor) = points.next() else { return };
        self.move_to(anchor);
        // The directions from the anchor that pass all points skipped so far within the tolerance.
        let mut skipped: Option<Point> = None;
        let mut cone: Option<Cone> = None;
        for p in points {
            cone = match (cone, skipped) {
                (Some(cone), Some(last)) => match self.cone(anchor, p).within(&cone) {
                    Some(narrower) => Some(narrower),
                    None => {
                        self.line_to(last);
                        anchor = last;
                        Some(self.cone(anchor, p))
                    }
                },
                _ => Some(self.cone(anchor, p)),
            };
            skipped = Some(p);
        }
        if let Some(last) = skipped {
            self.line_to(last);
        }
    }

    /// The directions from `anchor` that pass `p` within the tolerance.
    fn cone(&self, anchor: Point, p: Point) -> Cone {
        let axis = (p - anchor) * self.canvas.scale;
        let distance = axis.norm();
        let reach = if distance > TOLERANCE { (TOLERANCE / distance).asin() } else { std::f64::consts::PI };
        Cone { axis, low: -reach, high: reach, distance }
    }

    /// SVG coordinates in hundredths, on the grid.
    fn rounded(&self, p: Point) -> [i64; 2] {
        let (x, y) = self.canvas.place(p);
        let grid = self.grid as f64;
        [x, y].map(|v| (v * 100.0 / grid).round() as i64 * self.grid)
    }

    /// Appends hundredths as decimal numbers; a sign separates as well as a blank.
    fn numbers(&mut self, hundredths: &[i64]) {
        for (k, value) in hundredths.iter().enumerate() {
            if k > 0 && *value >= 0 {
                self.data.push(' ');
            }
            let sign = if *value < 0 { "-" } else { "" };
            let (whole, rest) = (value.unsigned_abs() / 100, value.unsigned_abs() % 100);
            let text = match (whole, rest) {
                (_, 0) => format!("{sign}{whole}"),
                (0, _) => format!("{sign}.{rest:02}"),
                _ => format!("{sign}{whole}.{rest:02}"),
            };
            self.data.push_str(if rest % 10 == 0 && rest > 0 { &text[..text.len() - 1] } else { &text });
        }
    }
}

/// Directions in the plane: those whose angle from `axis` lies between `low` and `high`.
#[derive(Clone, Copy)]
struct Cone {
    axis: Vector,
    low: f64,
    high: f64,
    /// How far away the point is that it was last narrowed for.
    distance: f64,
}

impl Cone {
    /// What of it lies in `outer`; `None` if its own axis does not, or if the line turns back.
    fn within(&self, outer: &Cone) -> Option<Cone> {
        let turn = cross(outer.axis, self.axis).atan2(outer.axis.dot(&self.axis));
        let inside = (outer.low..=outer.high).contains(&turn) && self.distance + TOLERANCE >= outer.distance;
        inside.then(|| Cone {
            axis: outer.axis,
            low: outer.low.max(turn + self.low),
            high: outer.high.min(turn + self.high),
            distance: self.distance.max(outer.distance),
        })
    }
}

/// Distance of `p` from the line along `chord` (from its start if that has no length).
fn off_line(chord: Vector, p: Vector) -> f64 {
    if chord.norm() > 0.0 {
        cross(chord, p).abs() / chord.norm()
    } else {
        p.norm()
    }
}
