//! SVG files: their `<path>` elements, true arcs, the y axis turned up, filled by the even-odd rule.

use crate::domain::{Domain, DomainBuilder, LoopKind};
use crate::error::{Error, Result};
use crate::input::svg_arc::CenterArc;
use crate::input::Model;
use crate::numerics::tolerances::{CLOSED_PATH, JOIN, TURNED_BACK};
use svgtypes::{PathParser, PathSegment};

/// Reads the text of an SVG file.
pub(crate) fn read(name: &str, text: &str, component: Option<usize>) -> Result<Model> {
    let options = roxmltree::ParsingOptions { allow_dtd: true, nodes_limit: 1 << 20 };
    let document = roxmltree::Document::parse_with_options(text, options).map_err(|e| {
        use roxmltree::Error as E;
        let what = format!("not well-formed XML: {e}");
        match e {
            // These do not tell where; the text ends too early.
            E::UnclosedRootNode | E::UnexpectedEndOfStream => {
                let line = text.lines().count().max(1);
                let column = text.lines().last().map_or(0, |l| l.chars().count()) + 1;
                Error::Parse { what, line, column }
            }
            other => {
                let at = other.pos();
                Error::Parse { what, line: at.row as usize, column: at.col as usize }
            }
        }
    })?;
    let position = |offset: usize| {
        let at = document.text_pos_at(offset);
        (at.row as usize, at.col as usize)
    };
    let root = document.root_element();
    if root.tag_name().name() != "svg" {
        let (line, column) = position(root.range().start);
        let what = format!("the root element is <{}>, not <svg>", root.tag_name().name());
        return Err(Error::Parse { what, line, column });
    }
    let mut builder = Domain::builder();
    builder.skip_empty_segments(true).component(component);
    let mut paths = 0;
    for node in root.descendants().filter(|n| n.is_element()) {
        if let Some(transform) = node.attribute_node("transform") {
            let (line, _) = position(transform.range().start);
            return Err(Error::Unsupported {
                what: format!("line {line}: a transform attribute; apply it in a drawing program first"),
            });
        }
        if node.tag_name().name() != "path" {
            continue;
        }
        let Some(data) = node.attribute_node("d") else {
            let (line, column) = position(node.range().start);
            return Err(Error::Parse { what: "<path> without d".into(), line, column });
        };
        let (line, column) = position(data.range_value().start);
        let name = node.attribute("id").unwrap_or("");
        add_path(&mut builder, data.value(), name, line, column)?;
        paths += 1;
    }
    if paths == 0 {
        return Err(Error::Unsupported {
            what: "no <path> element; convert shapes, text and strokes to paths first".into(),
        });
    }
    let domain = builder.build()?;
    let warnings = domain.warnings.clone();
    Ok(Model {
        name: name.to_string(),
        domain,
        order: None,
        tolerance: None,
        size: None,
        background_size: None,
        warnings,
    })
}

/// Where and why path data cannot be read.
fn path_error(e: svgtypes::Error, line: usize, column: usize) -> Error {
    use svgtypes::Error as E;
    let at = match e {
        E::UnexpectedData(p) | E::InvalidNumber(p) | E::InvalidChar(_, p) | E::InvalidString(_, p) => p,
        _ => 1,
    };
    Error::Parse { what: format!("bad path data: {e}"), line, column: column + at.max(1) - 1 }
}

/// The last control point, for the smooth commands that reflect it.
#[derive(Clone, Copy, PartialEq)]
enum LastControl {
    None,
    Quadratic([f64; 2]),
    Cubic([f64; 2]),
}

/// The pen: what path commands are relative to. SVG coordinates, y down.
struct Pen<'a> {
    builder: &'a mut DomainBuilder,
    name: &'a str,
    at: [f64; 2],
    start: [f64; 2],
    /// Least and greatest coordinates of the subpath's points.
    extent: [[f64; 2]; 2],
    open: bool,
    control: LastControl,
    /// Directions in which the subpath leaves its start and arrives at the current point, where known.
    leaving: Option<[f64; 2]>,
    arriving: Option<[f64; 2]>,
}

fn between(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [b[0] - a[0], b[1] - a[1]]
}

fn up(p: [f64; 2]) -> [f64; 2] {
    [p[0], -p[1]]
}

impl Pen<'_> {
    fn place(&self, absolute: bool, x: f64, y: f64) -> [f64; 2] {
        if absolute {
            [x, y]
        } else {
            [self.at[0] + x, self.at[1] + y]
        }
    }

    /// The current point mirrored at itself: the control point that continues smoothly.
    fn mirrored(&self, control: [f64; 2]) -> [f64; 2] {
        [2.0 * self.at[0] - control[0], 2.0 * self.at[1] - control[1]]
    }

    fn begin(&mut self) -> Result<()> {
        if !self.open {
            self.builder.begin_loop(LoopKind::Auto, self.name)?;
            self.start = self.at;
            self.extent = [self.at; 2];
            self.open = true;
        }
        Ok(())
    }

    /// Ends the subpath, with a straight line back to its start if it is not there but for rounding.
    fn close(&mut self) -> Result<()> {
        if self.open {
            let [low, high] = self.extent;
            let size = (high[0] - low[0]).hypot(high[1] - low[1]);
            let gap = (self.at[0] - self.start[0]).hypot(self.at[1] - self.start[1]);
            if gap > CLOSED_PATH * size && !(gap <= JOIN * size && self.closing_turns_back()) {
                self.builder.add_line(up(self.at), up(self.start), "")?;
            }
            self.builder.end_loop()?;
            self.open = false;
        }
        self.at = self.start;
        self.control = LastControl::None;
        Ok(())
    }

    /// Whether the line to the start would run back along the segment before it or the one after it.
    fn closing_turns_back(&self) -> bool {
        let closing = between(self.at, self.start);
        let back = |d: &[f64; 2]| {
            let along = closing[0] * d[0] + closing[1] * d[1];
            along < -TURNED_BACK * closing[0].hypot(closing[1]) * d[0].hypot(d[1])
        };
        self.leaving.iter().chain(&self.arriving).any(back)
    }

    /// Notes the directions at both ends of a segment from the current point.
    fn directed(&mut self, ends: Option<[[f64; 2]; 2]>) {
        if self.at == self.start {
            self.leaving = ends.map(|e| e[0]);
        }
        self.arriving = ends.map(|e| e[1]);
    }

    fn line(&mut self, to: [f64; 2]) -> Result<()> {
        self.begin()?;
        self.directed(Some([between(self.at, to); 2]));
        self.builder.add_line(up(self.at), up(to), "")?;
        self.at = to;
        self.control = LastControl::None;
        Ok(())
    }

    fn cubic(&mut self, c1: [f64; 2], c2: [f64; 2], to: [f64; 2]) -> Result<()> {
        self.begin()?;
        self.directed(Some([between(self.at, c1), between(c2, to)]));
        self.builder.add_bezier(&[up(self.at), up(c1), up(c2), up(to)], "")?;
        self.at = to;
        self.control = LastControl::Cubic(c2);
        Ok(())
    }

    fn quadratic(&mut self, c: [f64; 2], to: [f64; 2]) -> Result<()> {
        self.begin()?;
        self.directed(Some([between(self.at, c), between(c, to)]));
        self.builder.add_bezier(&[up(self.at), up(c), up(to)], "")?;
        self.at = to;
        self.control = LastControl::Quadratic(c);
        Ok(())
    }

    fn arc(&mut self, radii: [f64; 2], rotation: f64, large: bool, sweep: bool, to: [f64; 2]) -> Result<()> {
        self.begin()?;
        self.directed(None);
        if to != self.at {
            match CenterArc::from_end_points(self.at, to, radii, rotation, large, sweep) {
                Some(arc) => self.builder.add_curve(std::sync::Arc::new(arc.flipped()), "")?,
                None => self.builder.add_line(up(self.at), up(to), "")?,
            };
        }
        self.at = to;
        self.control = LastControl::None;
        Ok(())
    }

    fn draw(&mut self, command: PathSegment) -> Result<()> {
        self.follow(command)?;
        for k in 0..2 {
            self.extent[0][k] = self.extent[0][k].min(self.at[k]);
            self.extent[1][k] = self.extent[1][k].max(self.at[k]);
        }
        Ok(())
    }

    fn follow(&mut self, command: PathSegment) -> Result<()> {
        match command {
            PathSegment::MoveTo { abs, x, y } => {
                let to = self.place(abs, x, y);
                if self.open {
                    self.close()?;
                }
                (self.at, self.start) = (to, to);
                Ok(())
            }
            PathSegment::ClosePath { .. } => self.close(),
            PathSegment::LineTo { abs, x, y } => self.line(self.place(abs, x, y)),
            PathSegment::HorizontalLineTo { abs, x } => {
                self.line([if abs { x } else { self.at[0] + x }, self.at[1]])
            }
            PathSegment::VerticalLineTo { abs, y } => {
                self.line([self.at[0], if abs { y } else { self.at[1] + y }])
            }
            PathSegment::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                self.cubic(self.place(abs, x1, y1), self.place(abs, x2, y2), self.place(abs, x, y))
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                let c1 = match self.control {
                    LastControl::Cubic(c) => self.mirrored(c),
                    _ => self.at,
                };
                self.cubic(c1, self.place(abs, x2, y2), self.place(abs, x, y))
            }
            PathSegment::Quadratic { abs, x1, y1, x, y } => {
                self.quadratic(self.place(abs, x1, y1), self.place(abs, x, y))
            }
            PathSegment::SmoothQuadratic { abs, x, y } => {
                let c = match self.control {
                    LastControl::Quadratic(c) => self.mirrored(c),
                    _ => self.at,
                };
                self.quadratic(c, self.place(abs, x, y))
            }
            PathSegment::EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                self.arc([rx, ry], x_axis_rotation, large_arc, sweep, self.place(abs, x, y))
            }
        }
    }
}

/// Adds the subpaths of path data; every one is closed.
fn add_path(builder: &mut DomainBuilder, data: &str, name: &str, line: usize, column: usize) -> Result<()> {
    let located = |e: Error| match e {
        Error::InvalidArgument { what, value, allowed } => {
            Error::Parse { what: format!("{what} is {value}; give {allowed}"), line, column }
        }
        other => other,
    };
    let mut pen = Pen {
        builder,
        name,
        at: [0.0; 2],
        start: [0.0; 2],
        extent: [[0.0; 2]; 2],
        open: false,
        control: LastControl::None,
        leaving: None,
        arriving: None,
    };
    for command in PathParser::from(data) {
        pen.draw(command.map_err(|e| path_error(e, line, column))?).map_err(located)?;
    }
    if pen.open {
        pen.close().map_err(located)?;
    }
    Ok(())
}
