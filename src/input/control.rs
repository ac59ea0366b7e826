//! HOHQMesh control files (two-dimensional models).
//!
//! Taken: the model's curves, the polynomial order, the outer boundary's `tolerance`, the refinement regions and
//! the size of the background grid; without an outer boundary the box of BACKGROUND_GRID. Everything else about
//! HOHQMesh's own grids is skipped.

use crate::domain::{CubicSpline, Curve, Domain, DomainBuilder, EllipticArc, Line, LoopKind};
use crate::error::{Error, Result};
use crate::input::blocks::{self, Block, Located};
use crate::input::equation::EquationCurve;
use crate::input::expression::Expression;
use crate::input::{refinement, Model};
use crate::numerics::Point;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Blocks that make a model three-dimensional.
const THREE_D: [&str; 5] =
    ["SIMPLE_EXTRUSION", "SIMPLE_ROTATION", "SWEEP_ALONG_CURVE", "SWEEP_CURVE", "SWEEP_SCALE_FACTOR"];

/// Most rows of a spline's data file.
const MOST_ROWS: usize = 10_000_000;

/// Reads the text of a control file; data files are looked for in `base` and the folders above it.
pub(crate) fn read(name: &str, text: &str, base: Option<&Path>) -> Result<Model> {
    let root = blocks::parse(text)?;
    if let Some(block) = root.find(&THREE_D) {
        return Err(Error::Unsupported {
            what: format!(
                "line {}: {} makes a three-dimensional model; only plane ones are meshed",
                block.line, block.name
            ),
        });
    }
    let control = root.child("CONTROL_INPUT").unwrap_or(&root);
    let order = match control.child("RUN_PARAMETERS").and_then(|b| b.get("polynomial order")) {
        Some(v) => Some(whole(v)?),
        None => None,
    };
    let model = root.child("MODEL");
    let mut builder = Domain::builder();
    builder.skip_empty_segments(true);
    let mut tolerance = None;
    match model.and_then(|m| m.child("OUTER_BOUNDARY")) {
        Some(outer) => {
            tolerance = outer.get("tolerance").map(number).transpose()?;
            builder.begin_loop(LoopKind::Outer, "outer")?;
            for c in &outer.children {
                let curves = if c.name == "CHAIN" { &c.children[..] } else { std::slice::from_ref(c) };
                add_curves(&mut builder, curves, base)?;
            }
            end_loop(&mut builder, outer)?;
        }
        None => {
            let grid = control.child("BACKGROUND_GRID").ok_or_else(|| Error::Parse {
                what: "neither an OUTER_BOUNDARY nor a BACKGROUND_GRID".into(),
                line: 1,
                column: 1,
            })?;
            add_background_box(&mut builder, grid)?;
        }
    }
    for (block, kind) in [("INNER_BOUNDARIES", LoopKind::Hole), ("INTERFACE_BOUNDARIES", LoopKind::Interface)]
    {
        let Some(block) = model.and_then(|m| m.child(block)) else { continue };
        for c in &block.children {
            let curves = if c.name == "CHAIN" { &c.children[..] } else { std::slice::from_ref(c) };
            builder.begin_loop(kind, c.get("name").map_or("", |v| &v.text))?;
            add_curves(&mut builder, curves, base)?;
            end_loop(&mut builder, c)?;
        }
    }
    let domain = builder.build()?;
    let warnings = domain.warnings.clone();
    let size = refinement::size_function(control)?;
    let background_size = control.child("BACKGROUND_GRID").map(background_size).transpose()?.flatten();
    Ok(Model { name: name.to_string(), domain, order, tolerance, size, background_size, warnings })
}

fn end_loop(builder: &mut DomainBuilder, block: &Block) -> Result<()> {
    builder.end_loop().map(|_| ()).map_err(|_| block.error(format!("{} has no curves", block.name)))
}

/// The size of the background grid's cells, the larger of both directions.
fn background_size(grid: &Block) -> Result<Option<f64>> {
    let Some(value) = grid.get("background grid size").or(grid.get("dx")) else { return Ok(None) };
    let [dx, dy] = pair(value)?;
    Ok(Some(dx.max(dy)).filter(|size| *size > 0.0))
}

/// The box that HOHQMesh takes where there is no outer boundary.
fn add_background_box(builder: &mut DomainBuilder, grid: &Block) -> Result<()> {
    let [x0, dx, n] = [grid.need("x0")?, grid.need("dx")?, grid.need("n")?];
    let ([ax, ay], [dx, dy], [nx, ny]) = (pair(x0)?, pair(dx)?, pair(n)?);
    let (bx, by) = (ax + dx * nx, ay + dy * ny);
    let corners = [[ax, ay], [bx, ay], [bx, by], [ax, by]];
    builder.begin_loop(LoopKind::Outer, "background grid")?;
    for (i, name) in ["Bottom", "Right", "Top", "Left"].into_iter().enumerate() {
        builder.add_line(corners[i], corners[(i + 1) % 4], name)?;
    }
    builder.end_loop().map(|_| ())
}

fn add_curves(builder: &mut DomainBuilder, blocks: &[Block], base: Option<&Path>) -> Result<()> {
    for block in blocks {
        builder.add_curve(curve(block, base)?, block.get("name").map_or("", |v| &v.text))?;
    }
    Ok(())
}

/// One curve block.
fn curve(block: &Block, base: Option<&Path>) -> Result<Arc<dyn Curve>> {
    match block.name.as_str() {
        "END_POINTS_LINE" => {
            let (from, to) = (point(block.need("xstart")?)?, point(block.need("xend")?)?);
            Ok(Arc::new(Line { from, to }))
        }
        "PARAMETRIC_EQUATION_CURVE" => equation(block),
        "CIRCULAR_ARC" | "ELLIPTIC_ARC" => arc(block),
        "SPLINE_CURVE" => spline(block, base),
        other => Err(block.error(format!("unknown curve type {other}"))),
    }
}

fn equation(block: &Block) -> Result<Arc<dyn Curve>> {
    let parse = |v: &Located| Expression::parse_equation(&v.text, v.line, v.column);
    let curve = EquationCurve { x: parse(block.need("xeqn")?)?, y: parse(block.need("yeqn")?)? };
    if let Some(z) = block.get("zeqn") {
        let height = parse(z)?;
        if (0..7).any(|k| height.evaluate(k as f64 / 6.0).0 != 0.0) {
            return out_of_plane(z);
        }
    }
    Ok(Arc::new(curve))
}

fn out_of_plane<T>(v: &Located) -> Result<T> {
    Err(Error::Unsupported { what: format!("line {}: a curve out of the plane z = 0", v.line) })
}

fn arc(block: &Block) -> Result<Arc<dyn Curve>> {
    let center = point(block.need("center")?)?;
    let degrees = block.get("units").is_some_and(|u| u.text.eq_ignore_ascii_case("degrees"));
    let unit = if degrees { std::f64::consts::PI / 180.0 } else { 1.0 };
    let angle = |key: &str| Ok::<f64, Error>(unit * number(block.need(key)?)?);
    let length = |key: &str| {
        let v = block.need(key)?;
        let r = number(v)?;
        if r > 0.0 {
            Ok(r)
        } else {
            Err(v.error(format!("the {key} must be above 0")))
        }
    };
    let (start, end) = (angle("start angle")?, angle("end angle")?);
    Ok(Arc::new(if block.name == "CIRCULAR_ARC" {
        EllipticArc::circle(center, length("radius")?, start, end)
    } else {
        let rotation = block.get("rotation").map(number).transpose()?.unwrap_or(0.0);
        EllipticArc::ellipse(center, [length("xradius")?, length("yradius")?], unit * rotation, start, end)
    }))
}

fn spline(block: &Block, base: Option<&Path>) -> Result<Arc<dyn Curve>> {
    let rows = match (block.get("file"), block.child("SPLINE_DATA")) {
        (Some(file), _) => data_file(file, base)?,
        (None, Some(data)) => {
            let n = whole(block.need("nknots")?)?;
            if n != data.rows.len() {
                return Err(data.error(format!("nKnots = {n}, but there are {} rows", data.rows.len())));
            }
            data.rows.clone()
        }
        (None, None) => return Err(block.error("SPLINE_CURVE without SPLINE_DATA or file")),
    };
    let (mut knots, mut points) = (Vec::with_capacity(rows.len()), Vec::with_capacity(rows.len()));
    for row in &rows {
        let v = numbers(row, &row.text.replace(',', " "))?;
        if v.len() < 3 {
            return Err(row.error("a row of spline data needs t, x, y"));
        }
        if v.get(3).is_some_and(|&z| z != 0.0) {
            return out_of_plane(row);
        }
        knots.push(v[0]);
        points.push(Point::new(v[1], v[2]));
    }
    let spline = CubicSpline::with_knots(&knots, &points).map_err(|what| block.error(what))?;
    Ok(Arc::new(spline))
}

/// The rows of a spline's data file: their number, then t x y z each.
fn data_file(file: &Located, base: Option<&Path>) -> Result<Vec<Located>> {
    let name = file.text.trim_matches(['\'', '"', '`']);
    let path = find_data_file(name, base)
        .ok_or_else(|| file.error(format!("the data file '{name}' is not found")))?;
    let bytes = std::fs::read(&path)
        .map_err(|e| Error::Io { path: path.display().to_string(), reason: e.to_string() })?;
    let text = String::from_utf8_lossy(&bytes);
    let mut lines = text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty()).map(|(i, l)| Located {
        text: l.trim().to_string(),
        line: i + 1,
        column: 1,
    });
    let bad = |what: String| file.error(format!("{}: {what}", path.display()));
    let first = lines.next().ok_or_else(|| bad("the file is empty".into()))?;
    let count = first.text.split_whitespace().next().and_then(|x| x.parse::<usize>().ok());
    let count = count
        .filter(|&n| n <= MOST_ROWS)
        .ok_or_else(|| bad(format!("line {}: the number of rows is missing", first.line)))?;
    let rows: Vec<Located> = lines.take(count).collect();
    if rows.len() < count {
        return Err(bad(format!("{count} rows are announced, {} are there", rows.len())));
    }
    Ok(rows)
}

/// Looks in `base` (with and without the name's folders), then in the folders above.
fn find_data_file(name: &str, base: Option<&Path>) -> Option<PathBuf> {
    let base = base.unwrap_or(Path::new("."));
    let base = std::path::absolute(base).unwrap_or_else(|_| base.to_path_buf());
    let bare = Path::new(name).file_name()?;
    [base.join(name), base.join(bare)]
        .into_iter()
        .chain(base.ancestors().skip(1).map(|d| d.join(name)))
        .find(|p| p.is_file())
}

/// A number, Fortran exponents allowed.
fn parse_number(text: &str) -> Option<f64> {
    text.parse()
        .ok()
        .or_else(|| text.to_lowercase().replace('d', "e").parse().ok())
        .filter(|x: &f64| x.is_finite())
}

pub(super) fn number(v: &Located) -> Result<f64> {
    let text = v.text.split('%').next().unwrap_or("").trim();
    parse_number(text).ok_or_else(|| v.error(format!("'{text}' is not a number")))
}

fn whole(v: &Located) -> Result<usize> {
    let x = number(v)?;
    if x >= 0.0 && x.fract() == 0.0 && x < 1e9 {
        Ok(x as usize)
    } else {
        Err(v.error(format!("'{}' is not a whole number", v.text)))
    }
}

fn numbers(place: &Located, text: &str) -> Result<Vec<f64>> {
    text.split_whitespace()
        .map(|x| parse_number(x).ok_or_else(|| place.error(format!("'{x}' is not a number"))))
        .collect()
}

/// The first two numbers of `[a, b, c]`, and the others.
fn bracketed(v: &Located) -> Result<Vec<f64>> {
    let text = v.text.split('%').next().unwrap_or("").trim();
    let inner = text.strip_prefix('[').and_then(|t| t.strip_suffix(']'));
    let inner = inner.ok_or_else(|| v.error(format!("'{text}' is not of the form [x, y, z]")))?;
    let list = numbers(v, &inner.replace(',', " "))?;
    if list.len() < 2 {
        return Err(v.error("two coordinates are needed"));
    }
    Ok(list)
}

fn pair(v: &Located) -> Result<[f64; 2]> {
    bracketed(v).map(|list| [list[0], list[1]])
}

pub(super) fn point(v: &Located) -> Result<Point> {
    let list = bracketed(v)?;
    if list.get(2).is_some_and(|&z| z != 0.0) {
        return out_of_plane(v);
    }
    Ok(Point::new(list[0], list[1]))
}
