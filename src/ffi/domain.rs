//! Domain: loops of curve segments
//!
//! A loop is begun, given its segments in order, and ended; either orientation will do. A segment with name
//! NULL bears its loop's name. Edges on segments of equal name form one boundary of the mesh.

use super::callback::User;
use super::guard::{array, free, guard, optional_text, required, required_mut, text, Failure};
use super::status::quadrel_status;
use crate::domain::{Domain, DomainBuilder, LoopKind};
use crate::error::Result as CoreResult;
use crate::input::{EquationCurve, Expression, Model};
use libc::{c_char, c_int, c_void};
use std::sync::Arc;

/// A domain: its boundary, loop by loop, or what was read from a file.
pub struct quadrel_domain {
    pub(super) source: Source,
}

/// Where a domain comes from.
pub(super) enum Source {
    Built(Box<DomainBuilder>),
    Read(Box<Model>),
}

impl quadrel_domain {
    /// The checked domain, and what its reader had to say.
    pub(super) fn checked(&self) -> CoreResult<(Domain, &[String])> {
        match &self.source {
            Source::Built(builder) => Ok((builder.build()?, &[])),
            Source::Read(model) => Ok((model.domain.clone(), &model.warnings)),
        }
    }
}

/// What a loop bounds.
pub type quadrel_loop_kind = i32;

/// the outer boundary; exactly one
pub const QUADREL_LOOP_OUTER: quadrel_loop_kind = 0;
/// the boundary of a hole
pub const QUADREL_LOOP_HOLE: quadrel_loop_kind = 1;
/// outer or hole by nesting (even-odd) among the loops of this kind
pub const QUADREL_LOOP_AUTO: quadrel_loop_kind = 3;

/// A curve: writes the point at t in [0, 1] (both included) to xy, or its derivative d/dt. Equal t must give
/// equal results. Returns 0, or non-zero to give up.
///
/// cbindgen:ptrs-as-arrays=[[xy;2]]
pub type quadrel_curve_fn = Option<unsafe extern "C" fn(user: *mut c_void, t: f64, xy: *mut f64) -> c_int>;

/// Called exactly once, when user is needed no more.
pub type quadrel_destroy_fn = Option<unsafe extern "C" fn(user: *mut c_void)>;

/// A domain without loops.
#[no_mangle]
pub extern "C" fn quadrel_domain_new() -> *mut quadrel_domain {
    Box::into_raw(Box::new(quadrel_domain { source: Source::Built(Box::default()) }))
}

/// Frees a domain; callbacks that nothing else needs are destroyed.
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_free(domain: *mut quadrel_domain) {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { free(domain) }
}

/// Runs `change` on the builder of `domain`, with the name of a segment or loop.
unsafe fn build(
    domain: *mut quadrel_domain,
    name: *const c_char,
    change: impl FnOnce(&mut DomainBuilder, &str) -> Result<(), Failure>,
) -> quadrel_status {
    guard(|| {
        // SAFETY: the caller's promise (first comment of the header).
        let (domain, name) =
            unsafe { (required_mut(domain, "the domain")?, optional_text(name, "the name")?) };
        match &mut domain.source {
            Source::Built(builder) => change(builder, name.unwrap_or("")),
            Source::Read(_) => Err(Failure::argument(
                "the domain",
                "one that was read from a file",
                "a domain made by quadrel_domain_new: those from files are complete",
            )),
        }
    })
}

/// `[count][2]` numbers as points.
unsafe fn points<'a>(
    pointer: *const f64,
    count: usize,
    what: &'static str,
) -> Result<&'a [[f64; 2]], Failure> {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe { array(pointer.cast(), count, what) }
}

/// One point.
unsafe fn point(pointer: *const f64, what: &'static str) -> Result<[f64; 2], Failure> {
    // SAFETY: the caller's promise (first comment of the header).
    Ok(unsafe { points(pointer, 1, what) }?[0])
}

/// Begins a loop; kind is a QUADREL_LOOP number, name may be NULL.
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_begin_loop(
    domain: *mut quadrel_domain,
    kind: quadrel_loop_kind,
    name: *const c_char,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        build(domain, name, |builder, name| {
            let kind = match kind {
                QUADREL_LOOP_OUTER => LoopKind::Outer,
                QUADREL_LOOP_HOLE => LoopKind::Hole,
                QUADREL_LOOP_AUTO => LoopKind::Auto,
                _ => return Err(Failure::argument("the kind of loop", kind, "a QUADREL_LOOP number")),
            };
            builder.begin_loop(kind, name)?;
            Ok(())
        })
    }
}

/// Ends the loop that was begun. Joins and closure are checked with everything else by quadrel_domain_check
/// and quadrel_generate.
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_end_loop(domain: *mut quadrel_domain) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        build(domain, std::ptr::null(), |builder, _| {
            builder.end_loop()?;
            Ok(())
        })
    }
}

/// One of the caller's functions as the core wants it.
fn curve_function(
    function: unsafe extern "C" fn(user: *mut c_void, t: f64, xy: *mut f64) -> c_int,
    user: Arc<User>,
) -> Box<crate::domain::CurveFn> {
    Box::new(move |t| {
        let mut xy = [f64::NAN; 2];
        // SAFETY: the function and its user pointer came together from the caller.
        match unsafe { function(user.pointer(), t, xy.as_mut_ptr()) } {
            0 => Ok(xy),
            code => Err(format!("the callback returned {code}")),
        }
    })
}

/// Adds a curve that the caller evaluates. derivative is d/dt and may be NULL: differences are used then.
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_add_curve(
    domain: *mut quadrel_domain,
    curve: quadrel_curve_fn,
    derivative: quadrel_curve_fn,
    user: *mut c_void,
    destroy: quadrel_destroy_fn,
    name: *const c_char,
) -> quadrel_status {
    let user = Arc::new(User::new(user, destroy));
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        build(domain, name, |builder, name| {
            let point = curve.ok_or_else(|| Failure::null("the curve"))?;
            let derivative = derivative.map(|d| curve_function(d, user.clone()));
            builder.add_callback(curve_function(point, user), derivative, name)?;
            Ok(())
        })
    }
}

/// Adds the straight segment between two points.
///
/// cbindgen:ptrs-as-arrays=[[from;2],[to;2]]
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_add_line(
    domain: *mut quadrel_domain,
    from: *const f64,
    to: *const f64,
    name: *const c_char,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        build(domain, name, |builder, name| {
            builder.add_line(point(from, "the start of a line")?, point(to, "the end of a line")?, name)?;
            Ok(())
        })
    }
}

/// Adds a circular arc from start_angle to end_angle: counter-clockwise if end_angle is the larger one, at
/// most a full turn.
///
/// cbindgen:ptrs-as-arrays=[[center;2]]
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_add_arc(
    domain: *mut quadrel_domain,
    center: *const f64,
    radius: f64,
    start_angle: f64,
    end_angle: f64,
    name: *const c_char,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        build(domain, name, |builder, name| {
            let center = point(center, "the centre of an arc")?;
            builder.add_arc(center, radius, start_angle, end_angle, name)?;
            Ok(())
        })
    }
}

/// Adds an elliptic arc with the two half axes radii, the first turned by rotation from the x axis. The
/// angles are the ellipse's parameter: the point is center + R(rotation) (radii[0] cos a, radii[1] sin a).
///
/// cbindgen:ptrs-as-arrays=[[center;2],[radii;2]]
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_add_elliptic_arc(
    domain: *mut quadrel_domain,
    center: *const f64,
    radii: *const f64,
    rotation: f64,
    start_angle: f64,
    end_angle: f64,
    name: *const c_char,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        build(domain, name, |builder, name| {
            let (center, radii) =
                (point(center, "the centre of an arc")?, point(radii, "the radii of an arc")?);
            builder.add_elliptic_arc(center, radii, rotation, start_angle, end_angle, name)?;
            Ok(())
        })
    }
}

/// Adds the Bezier curve with count control points [count][2]; its degree is count - 1, at most 64.
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_add_bezier(
    domain: *mut quadrel_domain,
    control_points: *const f64,
    count: usize,
    name: *const c_char,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        build(domain, name, |builder, name| {
            builder.add_bezier(points(control_points, count, "the control points")?, name)?;
            Ok(())
        })
    }
}

/// Adds the twice continuously differentiable cubic spline through points [count][2], its knots by chord
/// length: periodic if the last point equals the first, else with natural ends.
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_add_spline(
    domain: *mut quadrel_domain,
    points: *const f64,
    count: usize,
    name: *const c_char,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        build(domain, name, |builder, name| {
            builder.add_spline(self::points(points, count, "the spline points")?, name)?;
            Ok(())
        })
    }
}

/// An expression in t; a failure says which coordinate it is of.
unsafe fn expression(pointer: *const c_char, coordinate: &str) -> Result<Expression, Failure> {
    // SAFETY: the caller's promise (first comment of the header).
    let text = unsafe { text(pointer, "an expression") }?;
    Expression::parse(text, "t", 1, 1).map_err(|error| {
        let failure = Failure::from(error);
        Failure { text: format!("expression of {coordinate}, {}", failure.text), ..failure }
    })
}

/// Adds the curve (x(t), y(t)), t in [0, 1], given by two expressions: numbers, t, pi, + - * / ^ and **,
/// parentheses, sin cos tan asin acos atan sinh cosh tanh atanh exp log (natural) log10 sqrt abs. Its
/// derivative is exact.
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_add_expression(
    domain: *mut quadrel_domain,
    x: *const c_char,
    y: *const c_char,
    name: *const c_char,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        build(domain, name, |builder, name| {
            let curve = EquationCurve { x: expression(x, "x")?, y: expression(y, "y")? };
            builder.add_curve(Arc::new(curve), name)?;
            Ok(())
        })
    }
}

/// Largest gap between segments that is closed silently; by default 1e-4 of the domain's diagonal.
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_set_join_tolerance(
    domain: *mut quadrel_domain,
    gap: f64,
) -> quadrel_status {
    // SAFETY: the caller's promise (first comment of the header).
    unsafe {
        build(domain, std::ptr::null(), |builder, _| {
            builder.join_tolerance(gap)?;
            Ok(())
        })
    }
}

/// Checks what quadrel_generate checks first: loops closed, disjoint, nested, without cusps.
#[no_mangle]
pub unsafe extern "C" fn quadrel_domain_check(domain: *const quadrel_domain) -> quadrel_status {
    guard(|| {
        // SAFETY: the caller's promise (first comment of the header).
        unsafe { required(domain, "the domain") }?.checked()?;
        Ok(())
    })
}
