//! Building a domain, loop by loop and segment by segment; `build` checks everything.

use crate::domain::arc::EllipticArc;
use crate::domain::bezier::Bezier;
use crate::domain::boundary_loop::{BoundaryLoop, LoopKind};
use crate::domain::bounds::Bounds;
use crate::domain::callback::{CallbackCurve, CurveFn};
use crate::domain::corners_inside::split_at_corners;
use crate::domain::curve::Curve;
use crate::domain::line::Line;
use crate::domain::planar_domain::Domain;
use crate::domain::segment::CurveSegment;
use crate::domain::spline::CubicSpline;
use crate::domain::{crossing, nesting};
use crate::error::{Error, Result};
use crate::numerics::tolerances::{CUSP_ANGLE, JOIN, JOIN_ROUNDING, NO_EXTENT};
use crate::numerics::Point;
use std::sync::Arc;

/// A loop as the caller gave it.
#[derive(Clone)]
pub(crate) struct GivenLoop {
    kind: LoopKind,
    name: String,
    segments: Vec<(Arc<dyn Curve>, String)>,
}

/// Collects loops; each is begun, given its segments in order (either orientation), and ended.
#[derive(Clone, Default)]
pub struct DomainBuilder {
    loops: Vec<GivenLoop>,
    open: Option<GivenLoop>,
    join_tolerance: Option<f64>,
    component: Option<usize>,
    skip_empty_segments: bool,
}

/// A value out of range, or a call out of order.
fn argument(what: &'static str, value: impl ToString, allowed: &'static str) -> Error {
    Error::InvalidArgument { what, value: value.to_string(), allowed }
}

/// `p` as a point, if it is finite.
fn finite(what: &'static str, p: [f64; 2]) -> Result<Point> {
    if p[0].is_finite() && p[1].is_finite() {
        Ok(Point::from(p))
    } else {
        Err(argument(what, format!("({}, {})", p[0], p[1]), "finite coordinates"))
    }
}

fn finite_number(what: &'static str, x: f64) -> Result<f64> {
    if x.is_finite() {
        Ok(x)
    } else {
        Err(argument(what, x, "a finite number"))
    }
}

impl DomainBuilder {
    /// Begins a loop. Segments without a name of their own bear the loop's.
    pub fn begin_loop(&mut self, kind: LoopKind, name: &str) -> Result<&mut Self> {
        if self.open.is_some() {
            return Err(argument("a loop", "begun before the last one ended", "end_loop first"));
        }
        self.open = Some(GivenLoop { kind, name: name.to_string(), segments: Vec::new() });
        Ok(self)
    }

    /// Ends the loop.
    pub fn end_loop(&mut self) -> Result<&mut Self> {
        match self.open.take() {
            Some(l) if !l.segments.is_empty() => {
                self.loops.push(l);
                Ok(self)
            }
            Some(_) => Err(argument("a loop", "empty", "at least one segment")),
            None => Err(argument("a loop", "ended that was not begun", "begin_loop first")),
        }
    }

    /// Adds any curve to the loop; an empty `name` stands for the loop's.
    pub fn add_curve(&mut self, curve: Arc<dyn Curve>, name: &str) -> Result<&mut Self> {
        match &mut self.open {
            Some(l) => {
                l.segments.push((curve, name.to_string()));
                Ok(self)
            }
            None => Err(argument("a segment", "outside a loop", "begin_loop first")),
        }
    }

    /// Adds the straight segment between two points.
    pub fn add_line(&mut self, from: [f64; 2], to: [f64; 2], name: &str) -> Result<&mut Self> {
        let what = "the end of a line";
        self.add_curve(Arc::new(Line { from: finite(what, from)?, to: finite(what, to)? }), name)
    }

    /// Adds a circular arc; angles in radians, counter-clockwise if `end > start`.
    pub fn add_arc(
        &mut self,
        center: [f64; 2],
        radius: f64,
        start: f64,
        end: f64,
        name: &str,
    ) -> Result<&mut Self> {
        self.add_elliptic_arc(center, [radius, radius], 0.0, start, end, name)
    }

    /// Adds an elliptic arc, its first half axis turned by `rotation`; angles in radians.
    pub fn add_elliptic_arc(
        &mut self,
        center: [f64; 2],
        radii: [f64; 2],
        rotation: f64,
        start: f64,
        end: f64,
        name: &str,
    ) -> Result<&mut Self> {
        let center = finite("the centre of an arc", center)?;
        for r in radii {
            if !(r > 0.0 && r.is_finite()) {
                return Err(argument("the radius of an arc", r, "a finite length above 0"));
            }
        }
        for angle in [rotation, start, end] {
            finite_number("an angle of an arc", angle)?;
        }
        if (end - start).abs() > 2.0 * std::f64::consts::PI * (1.0 + 1e-12) {
            return Err(argument("the sweep of an arc", end - start, "at most one full turn"));
        }
        let [a, b] = radii;
        let arc = if a == b && rotation == 0.0 {
            EllipticArc::circle(center, a, start, end)
        } else {
            EllipticArc::ellipse(center, radii, rotation, start, end)
        };
        self.add_curve(Arc::new(arc), name)
    }

    /// Adds the Bézier curve of degree `control.len() − 1`.
    pub fn add_bezier(&mut self, control: &[[f64; 2]], name: &str) -> Result<&mut Self> {
        let points = control.iter().map(|&p| finite("a control point", p)).collect::<Result<Vec<_>>>()?;
        let curve = Bezier::new(points)
            .ok_or_else(|| argument("the number of control points", control.len(), "2 to 65"))?;
        self.add_curve(Arc::new(curve), name)
    }

    /// Adds the C² cubic spline through `points`, its knots by chord length: periodic if the last
    /// point equals the first, else natural.
    pub fn add_spline(&mut self, points: &[[f64; 2]], name: &str) -> Result<&mut Self> {
        let points = points.iter().map(|&p| finite("a spline point", p)).collect::<Result<Vec<_>>>()?;
        let curve = CubicSpline::through(&points).map_err(|reason| {
            argument("a spline", reason, "at least 2 points, each unlike the one before")
        })?;
        self.add_curve(Arc::new(curve), name)
    }

    /// Adds a curve that `point` evaluates at any t in [0, 1], with its derivative d/dt if there is one.
    pub fn add_callback(
        &mut self,
        point: Box<CurveFn>,
        derivative: Option<Box<CurveFn>>,
        name: &str,
    ) -> Result<&mut Self> {
        self.add_curve(Arc::new(CallbackCurve::new(point, derivative)), name)
    }

    /// Adds a whole loop of straight segments; without a name.
    pub fn add_polygon(&mut self, kind: LoopKind, corners: &[[f64; 2]]) -> Result<&mut Self> {
        self.begin_loop(kind, "")?;
        for (i, &corner) in corners.iter().enumerate() {
            self.add_line(corner, corners[(i + 1) % corners.len()], "")?;
        }
        self.end_loop()
    }

    /// Largest gap at joints that is closed silently, in the caller's unit; by default
    /// [`JOIN`] of the diagonal.
    pub fn join_tolerance(&mut self, gap: f64) -> Result<&mut Self> {
        if !(gap >= 0.0 && gap.is_finite()) {
            return Err(argument("the join tolerance", gap, "a finite length, 0 or more"));
        }
        self.join_tolerance = Some(gap);
        Ok(self)
    }

    /// Which component to take if the loops have several, counted from 0 by descending area.
    pub fn component(&mut self, component: Option<usize>) -> &mut Self {
        self.component = component;
        self
    }

    /// Leaves segments without extent out, with a warning, instead of refusing them.
    pub fn skip_empty_segments(&mut self, skip: bool) -> &mut Self {
        self.skip_empty_segments = skip;
        self
    }

    /// Checks everything and normalises the orientation.
    pub fn build(&self) -> Result<Domain> {
        if self.open.is_some() {
            return Err(argument("a loop", "not ended", "end_loop before build"));
        }
        let mut warnings = Vec::new();
        let mut loops: Vec<(LoopKind, BoundaryLoop)> = Vec::new();
        let mut bounds = Bounds::new();
        for (index, given) in self.loops.iter().enumerate() {
            let segment = |(i, (curve, name)): (usize, &(Arc<dyn Curve>, String))| {
                let name = if name.is_empty() { &given.name } else { name };
                CurveSegment::new(curve.clone(), name.clone(), index, i)
            };
            let mut segments = Vec::with_capacity(given.segments.len());
            for s in given.segments.iter().enumerate().map(segment) {
                let sampled = Bounds::of(&s.sample()?);
                if given.kind != LoopKind::Interface {
                    bounds.merge(&sampled);
                }
                segments.append(&mut split_at_corners(s)?);
            }
            let name = given.name.clone();
            loops.push((given.kind, BoundaryLoop { name, index, segments, largest_gap: 0.0 }));
        }
        let diagonal = bounds.diagonal();
        let most = self.join_tolerance.unwrap_or(JOIN * diagonal);
        for (kind, l) in &mut loops {
            self.remove_empty(l, diagonal, &mut warnings)?;
            match l.join(JOIN_ROUNDING * diagonal, most) {
                // An interface may be open: its ends lie on other loops.
                Err(Error::OpenLoop { .. }) if *kind == LoopKind::Interface => {}
                other => other?,
            }
            if l.largest_gap > 1e3 * JOIN_ROUNDING * diagonal {
                warnings.push(format!("loop {}: gaps up to {:.3e} were closed", l.index, l.largest_gap));
            }
        }
        let interfaces = loops.iter().filter(|(kind, _)| *kind == LoopKind::Interface).count();
        if interfaces > 0 {
            warnings.push(format!("{interfaces} interface curves inside the domain were left out"));
            loops.retain(|(kind, _)| *kind != LoopKind::Interface);
        }
        crossing::check(loops.iter().map(|(_, l)| l), diagonal)?;
        for (_, l) in &mut loops {
            orient(l, true)?;
        }
        let mut loops = nesting::arrange(loops, self.component)?;
        for l in &mut loops[1..] {
            l.reverse();
        }
        for l in &mut loops {
            l.join(0.0, most)?;
            check_cusps(l)?;
        }
        let mut bounds = Bounds::new();
        for s in loops.iter().flat_map(|l| &l.segments) {
            bounds.merge(&Bounds::of(&s.sample()?));
        }
        Ok(Domain { loops, bounds, warnings })
    }

    /// Refuses (or leaves out) segments without extent.
    fn remove_empty(&self, l: &mut BoundaryLoop, diagonal: f64, warnings: &mut Vec<String>) -> Result<()> {
        let mut kept = Vec::with_capacity(l.segments.len());
        let mut first_empty = None;
        for s in std::mem::take(&mut l.segments) {
            if Bounds::of(&s.sample()?).diagonal() > NO_EXTENT * diagonal {
                kept.push(s);
            } else if self.skip_empty_segments {
                warnings.push(format!("loop {} segment {} has no extent: left out", l.index, s.index()));
                first_empty.get_or_insert((s.index(), s.start()?));
            } else {
                let (loop_index, segment, at) = (l.index, s.index(), s.start()?);
                return Err(Error::Degenerate {
                    loop_index,
                    segment,
                    reason: "a segment without extent",
                    at,
                });
            }
        }
        if let (true, Some((segment, at))) = (kept.is_empty(), first_empty) {
            let reason = "a loop without extent";
            return Err(Error::Degenerate { loop_index: l.index, segment, reason, at });
        }
        l.segments = kept;
        Ok(())
    }
}

/// Turns the loop so that it runs counter-clockwise (or clockwise).
fn orient(l: &mut BoundaryLoop, counter_clockwise: bool) -> Result<()> {
    let at = l.segments[0].start()?;
    let area = l.moments(at)?.area;
    if area == 0.0 {
        let segment = l.segments[0].index();
        return Err(Error::Degenerate { loop_index: l.index, segment, reason: "a loop without area", at });
    }
    if (area > 0.0) != counter_clockwise {
        l.reverse();
    }
    Ok(())
}

/// Refuses interior angles of 0.
fn check_cusps(l: &BoundaryLoop) -> Result<()> {
    for (i, s) in l.segments.iter().enumerate() {
        let angle = l.interior_angle(i)?;
        if angle < CUSP_ANGLE {
            let (loop_index, segment) = (l.index, s.index());
            return Err(Error::Cusp { loop_index, segment, angle, at: s.start()? });
        }
    }
    Ok(())
}
