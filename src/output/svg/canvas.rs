//! A drawing surface: the plane's coordinates to SVG text.

use super::path::Path;
use crate::numerics::Point;
use std::fmt::Write;

/// Width in SVG units of a picture of its own; the height follows the domain, within limits.
pub const SINGLE: f64 = 800.0;
/// The same of one panel among several.
pub const PANEL: f64 = 430.0;
/// Largest height, in widths.
const TALLEST: f64 = 1.25;
/// Room for the caption of a narrow domain's picture.
const NARROWEST: f64 = 400.0;
const MARGIN: f64 = 14.0;
/// Room for the line of text below.
const CAPTION: f64 = 28.0;
/// Size of text, and a character's width in sizes, with some margin.
const FONT: f64 = 16.0;
const CHARACTER: f64 = 0.56;

/// Looks of a line.
#[derive(Clone, Copy)]
pub struct Stroke {
    pub color: &'static str,
    pub width: f64,
}

/// Shapes that mark points.
#[derive(Clone, Copy)]
pub enum Mark {
    /// A regular polygon with this many corners, on its base.
    Polygon(usize),
    Disc,
    /// An empty circle.
    Ring,
}

/// A picture in the making: its view of the plane, and the SVG elements so far.
pub struct Canvas {
    lo: Point,
    hi: Point,
    pub(super) scale: f64,
    body: String,
    caption: String,
}

impl Canvas {
    /// A canvas `width` wide that shows what lies between `lo` and `hi`.
    fn new(lo: Point, hi: Point, width: f64) -> Self {
        let size = hi - lo;
        let fits = |extent: f64, room: f64| if extent > 0.0 { room / extent } else { f64::INFINITY };
        let scale = fits(size.x, width - 2.0 * MARGIN).min(fits(size.y, TALLEST * width - 2.0 * MARGIN));
        let scale = if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
        Canvas { lo, hi, scale, body: String::new(), caption: String::new() }
    }

    /// A canvas `width` wide around `points` (finite ones).
    pub fn around(points: impl IntoIterator<Item = Point>, width: f64) -> Self {
        let (mut lo, mut hi) = (Point::new(f64::MAX, f64::MAX), Point::new(f64::MIN, f64::MIN));
        for p in points.into_iter().filter(|p| p.x.is_finite() && p.y.is_finite()) {
            lo = Point::new(lo.x.min(p.x), lo.y.min(p.y));
            hi = Point::new(hi.x.max(p.x), hi.y.max(p.y));
        }
        if lo.x > hi.x {
            (lo, hi) = (Point::origin(), Point::new(1.0, 1.0));
        }
        Self::new(lo, hi, width)
    }

    /// Length in the plane of one SVG unit.
    pub fn unit(&self) -> f64 {
        1.0 / self.scale
    }

    /// Width and height in SVG units, the caption's room included.
    pub fn size(&self) -> (f64, f64) {
        let size = (self.hi - self.lo) * self.scale;
        ((size.x + 2.0 * MARGIN).max(NARROWEST), size.y + 2.0 * MARGIN + CAPTION)
    }

    /// The line of text below the picture.
    pub fn caption(&mut self, text: impl Into<String>) {
        self.caption = text.into();
    }

    /// A group of lines that share their looks; `draw` adds their paths.
    pub fn lines(&mut self, stroke: Stroke, draw: impl FnOnce(&mut Path)) {
        let mut path = Path::new(self);
        draw(&mut path);
        let data = path.finish();
        if !data.is_empty() {
            let _ = writeln!(
                self.body,
                "<path d=\"{data}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\"/>",
                stroke.color,
                number(stroke.width)
            );
        }
    }

    /// An area of one colour.
    pub fn area(&mut self, fill: &str, draw: impl FnOnce(&mut Path)) {
        let mut path = Path::new(self);
        draw(&mut path);
        let data = path.finish();
        if !data.is_empty() {
            let _ = writeln!(self.body, "<path d=\"{data}Z\" fill=\"{fill}\"/>");
        }
    }

    /// Marks a point; `radius` in SVG units.
    pub fn mark(&mut self, at: Point, mark: Mark, radius: f64, color: &str) {
        let (x, y) = self.place(at);
        let body = &mut self.body;
        let _ = match mark {
            Mark::Disc => writeln!(
                body,
                "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{color}\"/>",
                number(x),
                number(y),
                number(radius)
            ),
            Mark::Ring => writeln!(
                body,
                "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"none\" stroke=\"{color}\" stroke-width=\"{}\"/>",
                number(x),
                number(y),
                number(radius),
                number(0.2 * radius)
            ),
            Mark::Polygon(corners) => {
                let corner = |k: usize| {
                    let turn = (k as f64 + 0.5) / corners as f64 * std::f64::consts::TAU;
                    format!("{},{}", number(x + radius * turn.sin()), number(y + radius * turn.cos()))
                };
                let points: Vec<String> = (0..corners).map(corner).collect();
                writeln!(
                    body,
                    "<polygon points=\"{}\" fill=\"{color}\" stroke=\"#fff\" stroke-width=\"{}\"/>",
                    points.join(" "),
                    number(0.15 * radius)
                )
            }
        };
    }

    /// The elements drawn, the caption among them, without the `<svg>` around.
    fn content(self) -> String {
        let (width, height) = self.size();
        let mut body = self.body;
        if !self.caption.is_empty() {
            let font = FONT.min(width / (CHARACTER * self.caption.chars().count() as f64));
            let _ = writeln!(
                body,
                "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-size=\"{}\" fill=\"#333\">{}</text>",
                number(0.5 * width),
                number(height - 10.0),
                number(font),
                escape(&self.caption)
            );
        }
        body
    }

    /// The whole file.
    pub fn finish(self) -> String {
        let (width, height) = self.size();
        document(width, height, &self.content())
    }

    /// A point of the plane in SVG units.
    pub(super) fn place(&self, p: Point) -> (f64, f64) {
        let middle = 0.5 * (self.lo.x + self.hi.x);
        let (x, y) = ((p.x - middle) * self.scale, (self.hi.y - p.y) * self.scale);
        (x + 0.5 * self.size().0, y + MARGIN)
    }
}

/// Puts pictures beside each other, `columns` in a row, in reading order.
pub fn tile(pictures: Vec<Canvas>, columns: usize) -> String {
    let (mut wide, mut high) = (0.0_f64, 0.0_f64);
    for (w, h) in pictures.iter().map(Canvas::size) {
        (wide, high) = (wide.max(w), high.max(h));
    }
    let columns = columns.clamp(1, pictures.len().max(1));
    let rows = pictures.len().div_ceil(columns);
    let mut content = String::new();
    for (k, picture) in pictures.into_iter().enumerate() {
        let (w, _) = picture.size();
        let x = (k % columns) as f64 * wide + 0.5 * (wide - w);
        let y = (k / columns) as f64 * high;
        let _ = write!(
            content,
            "<g transform=\"translate({} {})\">\n{}</g>\n",
            number(x),
            number(y),
            picture.content()
        );
    }
    document(columns as f64 * wide, rows as f64 * high, &content)
}

fn document(width: f64, height: f64, content: &str) -> String {
    let (width, height) = (number(width), number(height));
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
         stroke-linejoin=\"round\" stroke-linecap=\"round\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n{content}</svg>\n"
    )
}

/// A number with at most two decimals and nothing needless.
fn number(value: f64) -> String {
    let value = if value.is_finite() { value } else { 0.0 };
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".into()
    } else {
        text.into()
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
