//! Every kind of bad input is refused with its own error, at its place.

use quadrel::domain::{Boundary, Domain, DomainBuilder, LoopKind};
use quadrel::error::NestingError;
use quadrel::input::{read, read_control_str, read_svg_str, Expression};
use quadrel::numerics::Point;
use quadrel::options::{Options, Tolerance};
use quadrel::Error;
use std::path::{Path, PathBuf};

const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]];

fn square_at(x: f64, y: f64, side: f64) -> Vec<[f64; 2]> {
    vec![[x, y], [x + side, y], [x + side, y + side], [x, y + side]]
}

fn refusal(add: impl FnOnce(&mut DomainBuilder)) -> Error {
    let mut builder = Domain::builder();
    add(&mut builder);
    builder.build().expect_err("the domain is refused")
}

fn polygon(corners: &[[f64; 2]]) -> Error {
    refusal(|b| {
        b.add_polygon(LoopKind::Outer, corners).unwrap();
    })
}

fn with_hole(hole: &[[f64; 2]]) -> Error {
    refusal(|b| {
        b.add_polygon(LoopKind::Outer, &SQUARE).unwrap();
        b.add_polygon(LoopKind::Hole, hole).unwrap();
    })
}

fn close(at: Point, x: f64, y: f64) -> bool {
    (at - Point::new(x, y)).norm() < 1e-6
}

/// A triangle whose third side, segment 2, is a callback.
fn with_callback(curve: fn(f64) -> Result<[f64; 2], String>) -> Error {
    refusal(|b| {
        b.begin_loop(LoopKind::Outer, "").unwrap();
        b.add_line([0.0, 0.0], [1.0, 0.0], "").unwrap();
        b.add_line([1.0, 0.0], [0.0, 1.0], "").unwrap();
        b.add_callback(Box::new(curve), None, "").unwrap();
        b.end_loop().unwrap();
    })
}

#[test]
fn callback_that_gives_nan_or_infinity() {
    for curve in [
        |t: f64| Ok([if t > 0.4 { f64::NAN } else { 0.0 }, 1.0 - t]),
        |t: f64| Ok([if t > 0.4 { f64::INFINITY } else { 0.0 }, 1.0 - t]),
    ] {
        match with_callback(curve) {
            Error::Callback { loop_index: 0, segment: 2, t, reason } => {
                assert!(t > 0.4 && t <= 1.0, "{t}");
                assert!(reason.contains("not finite"), "{reason}");
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn callback_that_reports_failure() {
    let error = with_callback(|t| if t < 0.5 { Ok([0.0, 1.0 - t]) } else { Err("no such point".into()) });
    match error {
        Error::Callback { loop_index: 0, segment: 2, t, reason } => {
            assert!(t >= 0.5 && reason == "no such point", "{t} {reason}")
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn nan_among_native_coordinates_fails_at_once() {
    let mut b = Domain::builder();
    b.begin_loop(LoopKind::Outer, "").unwrap();
    for error in [
        b.add_line([0.0, f64::NAN], [1.0, 0.0], "").err(),
        b.add_arc([0.0, 0.0], f64::INFINITY, 0.0, 1.0, "").err(),
        b.add_arc([0.0, 0.0], 0.0, 0.0, 1.0, "").err(),
        b.add_bezier(&[[0.0, 0.0], [f64::INFINITY, 0.0]], "").err(),
        b.add_bezier(&[[0.0, 0.0]], "").err(),
        b.add_spline(&[[0.0, 0.0], [0.0, 0.0]], "").err(),
    ] {
        assert!(matches!(error, Some(Error::InvalidArgument { .. })), "{error:?}");
    }
}

#[test]
fn calls_out_of_order() {
    let mut b = Domain::builder();
    assert!(matches!(b.end_loop().err(), Some(Error::InvalidArgument { .. })));
    assert!(matches!(b.add_line([0.0, 0.0], [1.0, 0.0], "").err(), Some(Error::InvalidArgument { .. })));
    b.begin_loop(LoopKind::Outer, "").unwrap();
    assert!(matches!(b.end_loop().err(), Some(Error::InvalidArgument { .. })));
    b.begin_loop(LoopKind::Outer, "").unwrap();
    assert!(matches!(b.build().err(), Some(Error::InvalidArgument { .. })));
}

#[test]
fn open_loop() {
    let error = refusal(|b| {
        b.begin_loop(LoopKind::Outer, "").unwrap();
        b.add_line([0.0, 0.0], [1.0, 0.0], "").unwrap();
        b.add_line([1.0, 0.0], [1.0, 1.0], "").unwrap();
        b.add_line([1.0, 1.0], [0.0, 0.25], "").unwrap();
        b.end_loop().unwrap();
    });
    match error {
        Error::OpenLoop { loop_index: 0, segment: 0, gap, at } => {
            assert!((gap - 0.25).abs() < 1e-12 && close(at, 0.0, 0.25), "{gap} {at}")
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn two_loops_that_cross() {
    match with_hole(&[[8.0, 4.0], [12.0, 5.0], [8.0, 6.0]]) {
        Error::Intersection { mut loops, segments, at } => {
            loops.sort_unstable();
            assert_eq!(loops, [0, 1]);
            assert!(segments.contains(&1), "{segments:?}");
            assert!(close(at, 10.0, 4.5) || close(at, 10.0, 5.5), "{at}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn loops_that_touch_in_a_point_or_along_a_side() {
    match with_hole(&[[8.0, 4.0], [10.0, 5.0], [8.0, 6.0]]) {
        Error::Intersection { at, .. } => assert!(close(at, 10.0, 5.0), "{at}"),
        other => panic!("{other:?}"),
    }
    match with_hole(&square_at(8.0, 4.0, 2.0)) {
        Error::Intersection { at, .. } => assert!((at.x - 10.0).abs() < 1e-6, "{at}"),
        other => panic!("{other:?}"),
    }
    // Two circles, one inside the other, that touch in one point.
    let error = refusal(|b| {
        for (kind, x, r) in [(LoopKind::Outer, 0.0, 1.0), (LoopKind::Hole, 0.5, 0.5)] {
            b.begin_loop(kind, "").unwrap();
            b.add_arc([x, 0.0], r, 0.3, 0.3 + std::f64::consts::TAU, "").unwrap();
            b.end_loop().unwrap();
        }
    });
    match error {
        Error::Intersection { at, .. } => assert!((at - Point::new(1.0, 0.0)).norm() < 1e-3, "{at}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn thin_gap_does_not_touch() {
    let mut b = Domain::builder();
    for (kind, x, r) in [(LoopKind::Outer, 0.0, 1.0), (LoopKind::Hole, 0.5, 0.5 - 1e-5)] {
        b.begin_loop(kind, "").unwrap();
        b.add_arc([x, 0.0], r, 0.3, 0.3 + std::f64::consts::TAU, "").unwrap();
        b.end_loop().unwrap();
    }
    Boundary::new(&b.build().unwrap()).unwrap().check().unwrap();
}

#[test]
fn self_crossing_loop() {
    match polygon(&[[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 3.0]]) {
        Error::Intersection { loops: [0, 0], mut segments, at } => {
            segments.sort_unstable();
            assert_eq!(segments, [0, 2]);
            assert!(close(at, 12.0 / 7.0, 12.0 / 7.0), "{at}");
        }
        other => panic!("{other:?}"),
    }
    // One curve that crosses itself: a limaçon with its inner loop.
    let error = refusal(|b| {
        b.begin_loop(LoopKind::Outer, "").unwrap();
        let limacon = |t: f64| {
            let a = std::f64::consts::TAU * t;
            let r = 1.0 + 2.0 * a.cos();
            Ok([r * a.cos(), r * a.sin()])
        };
        b.add_callback(Box::new(limacon), None, "").unwrap();
        b.end_loop().unwrap();
    });
    match error {
        Error::Intersection { loops: [0, 0], segments: [0, 0], at } => {
            assert!((at - Point::origin()).norm() < 1e-6, "{at}")
        }
        other => panic!("{other:?}"),
    }
    // A spike: the loop runs back on itself.
    match polygon(&[[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [8.0, 8.0], [4.0, 4.0], [0.0, 4.0]]) {
        Error::Intersection { at, .. } => assert!((at.x - at.y).abs() < 1e-6 && at.x >= 4.0, "{at}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn hole_outside() {
    match with_hole(&square_at(20.0, 0.0, 1.0)) {
        Error::Nesting { reason: NestingError::HoleOutside(1), at: Some(at) } => assert!(at.x >= 20.0),
        other => panic!("{other:?}"),
    }
}

#[test]
fn hole_in_hole() {
    let error = refusal(|b| {
        b.add_polygon(LoopKind::Outer, &SQUARE).unwrap();
        b.add_polygon(LoopKind::Hole, &square_at(2.0, 2.0, 6.0)).unwrap();
        b.add_polygon(LoopKind::Hole, &square_at(4.0, 4.0, 2.0)).unwrap();
    });
    match error {
        Error::Nesting { reason: NestingError::HoleInHole(2), at: Some(at) } => assert!(at.x >= 4.0),
        other => panic!("{other:?}"),
    }
}

#[test]
fn no_outer_loop() {
    let error = refusal(|_| {});
    assert!(matches!(error, Error::Nesting { reason: NestingError::NoOuterLoop, .. }), "{error:?}");
    let error = refusal(|b| {
        b.add_polygon(LoopKind::Hole, &SQUARE).unwrap();
    });
    assert!(matches!(error, Error::Nesting { reason: NestingError::NoOuterLoop, .. }), "{error:?}");
}

#[test]
fn several_outer_loops() {
    let two = |kind| {
        refusal(|b| {
            b.add_polygon(kind, &SQUARE).unwrap();
            b.add_polygon(kind, &square_at(20.0, 0.0, 1.0)).unwrap();
        })
    };
    for error in [two(LoopKind::Outer), two(LoopKind::Auto)] {
        let several =
            matches!(error, Error::Nesting { reason: NestingError::SeveralComponents(2), at: Some(_) });
        assert!(several, "{error:?}");
    }
}

#[test]
fn zero_length_segment_and_loop() {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
    match polygon(&corners) {
        Error::Degenerate { loop_index: 0, segment: 1, at, .. } => assert!(close(at, 1.0, 0.0)),
        other => panic!("{other:?}"),
    }
    match polygon(&[[2.0, 3.0]; 3]) {
        Error::Degenerate { loop_index: 0, segment: 0, at, .. } => assert!(close(at, 2.0, 3.0)),
        other => panic!("{other:?}"),
    }
}

#[test]
fn duplicate_loop() {
    let error = refusal(|b| {
        b.add_polygon(LoopKind::Outer, &SQUARE).unwrap();
        b.add_polygon(LoopKind::Hole, &square_at(2.0, 2.0, 3.0)).unwrap();
        // The same square, started elsewhere and the other way round.
        b.add_polygon(LoopKind::Hole, &[[5.0, 5.0], [5.0, 2.0], [2.0, 2.0], [2.0, 5.0]]).unwrap();
    });
    match error {
        Error::Degenerate { loop_index: 2, reason, at, .. } => {
            assert!(reason.contains("twice") && at.x >= 2.0 && at.x <= 5.0, "{reason}")
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn cusp_of_zero_degrees() {
    // Between two circles that touch: an arbelos with one small arc.
    let error = refusal(|b| {
        b.begin_loop(LoopKind::Outer, "").unwrap();
        b.add_arc([0.0, 0.0], 1.0, 0.0, std::f64::consts::PI, "").unwrap();
        b.add_line([-1.0, 0.0], [0.0, 0.0], "").unwrap();
        b.add_arc([0.5, 0.0], 0.5, std::f64::consts::PI, 0.0, "").unwrap();
        b.end_loop().unwrap();
    });
    match error {
        Error::Cusp { loop_index: 0, segment: 0, angle, at } => {
            assert!(angle < 1e-3 && close(at, 1.0, 0.0), "{angle} {at}")
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn sharp_corner_above_a_tenth_of_a_degree_is_no_cusp() {
    let height = 10.0 * 0.2f64.to_radians().tan();
    let d = Domain::polygon(&[[0.0, 0.0], [10.0, 0.0], [10.0, height]], &[]).unwrap();
    let least = Boundary::new(&d).unwrap().junctions.iter().map(|j| j.angle).fold(9.0, f64::min);
    assert!((least - 0.2f64.to_radians()).abs() < 1e-9);
}

#[test]
fn orders_and_tolerances_out_of_range() {
    let refused = |options: Options, name: &str| match options.check() {
        Err(Error::InvalidArgument { what, .. }) => assert!(what.contains(name), "{what}"),
        other => panic!("{other:?}"),
    };
    for order in [0, 100] {
        refused(Options { order, ..Options::default() }, "order");
    }
    for e in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        refused(Options { tolerance: Tolerance::Absolute(e), ..Options::default() }, "tolerance");
        refused(Options { tolerance: Tolerance::Relative(e), ..Options::default() }, "tolerance");
    }
}

/// A file in a directory of this test run.
fn file(name: &str, bytes: &[u8]) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

fn parse_place(error: Error) -> (usize, usize) {
    match error {
        Error::Parse { line, column, what } => {
            assert!(!what.is_empty());
            (line, column)
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn missing_file() {
    for name in ["no-such.control", "no-such.svg"] {
        match read(Path::new(name), None).err() {
            Some(Error::Io { path, .. }) => assert_eq!(path, name),
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn empty_file() {
    for name in ["empty.control", "empty.svg"] {
        assert_eq!(parse_place(read(&file(name, b""), None).unwrap_err()), (1, 1));
    }
}

#[test]
fn binary_file() {
    for name in ["binary.control", "binary.svg"] {
        let error = read(&file(name, b"ab\ncd\x00\xff\xfe\x01"), None).unwrap_err();
        assert_eq!(parse_place(error), (2, 3));
    }
}

#[test]
fn unknown_extension() {
    let error = read(&file("square.step", b"text"), None).unwrap_err();
    assert!(matches!(error, Error::Unsupported { .. }), "{error:?}");
}

const TRIANGLE: &str = "\
\\begin{MODEL}
   \\begin{OUTER_BOUNDARY}
      \\begin{END_POINTS_LINE}
         name = a
         xStart = [0.0,0.0,0.0]
         xEnd   = [1.0,0.0,0.0]
      \\end{END_POINTS_LINE}
      \\begin{END_POINTS_LINE}
         name = b
         xStart = [1.0,0.0,0.0]
         xEnd   = [0.0,1.0,0.0]
      \\end{END_POINTS_LINE}
      \\begin{PARAMETRIC_EQUATION_CURVE}
         name = c
         xEqn = x(t) = 0.1*sin(pi*t)
         yEqn = y(t) = 1 - t
         zEqn = z(t) = 0.0
      \\end{PARAMETRIC_EQUATION_CURVE}
   \\end{OUTER_BOUNDARY}
\\end{MODEL}
\\end{FILE}
";

fn control_error(from: &str, to: &str) -> Error {
    assert!(TRIANGLE.contains(from));
    read_control_str(&TRIANGLE.replace(from, to), None).expect_err(to)
}

#[test]
fn triangle_control_is_read_without_a_fault() {
    let model = read_control_str(TRIANGLE, None).unwrap();
    assert_eq!(model.domain.loops()[0].segments().len(), 3);
}

#[test]
fn truncated_control_file() {
    let half = &TRIANGLE[..TRIANGLE.find("xEnd   = [0.0,1.0").unwrap()];
    assert_eq!(parse_place(read_control_str(half, None).unwrap_err()), (8, 1));
}

#[test]
fn malformed_control_file() {
    // (text, replacement, line, column)
    for (from, to, line, column) in [
        ("[1.0,0.0,0.0]\n      \\end", "[1.0,zero,0.0]\n      \\end", 6, 19),
        ("xEnd   = [1.0,0.0,0.0]", "xEnd   = 1.0,0.0,0.0", 6, 19),
        ("xEnd   = [1.0,0.0,0.0]", "", 3, 1),
        ("\\end{PARAMETRIC_EQUATION_CURVE}", "\\end{CIRCULAR_ARC}", 18, 7),
        ("\\begin{PARAMETRIC_EQUATION_CURVE}", "\\begin PARAMETRIC", 13, 7),
        ("\\begin{PARAMETRIC_EQUATION_CURVE}\n", "\\begin{SQUIGGLE}\n", 18, 7),
        ("\\begin{MODEL}\n", "\\end{MODEL}\n", 1, 1),
        ("0.1*sin(pi*t)", "0.1*sin(pi*t", 15, 36),
        ("0.1*sin(pi*t)", "0.1*sinus(pi*t)", 15, 28),
        ("y(t) = 1 - t", "1 - t", 16, 17),
    ] {
        assert_eq!(parse_place(control_error(from, to)), (line, column), "{to}");
    }
}

#[test]
fn three_dimensional_control_file() {
    for (from, to) in [
        ("[1.0,0.0,0.0]\n      \\end", "[1.0,0.0,2.0]\n      \\end"),
        ("zEqn = z(t) = 0.0", "zEqn = z(t) = t"),
        ("\\begin{MODEL}\n", "\\begin{SIMPLE_EXTRUSION}\n\\end{SIMPLE_EXTRUSION}\n\\begin{MODEL}\n"),
    ] {
        let error = control_error(from, to);
        assert!(matches!(&error, Error::Unsupported { what } if what.contains("line")), "{error:?}");
    }
}

#[test]
fn control_equation_that_is_undefined() {
    match control_error("1 - t", "1 - t + 0*log(t - 0.5)") {
        Error::Callback { loop_index: 0, segment: 2, t, .. } => assert!(t <= 0.5),
        other => panic!("{other:?}"),
    }
}

#[test]
fn missing_spline_file() {
    let text = "\\begin{MODEL}\n\\begin{OUTER_BOUNDARY}\n\\begin{SPLINE_CURVE}\n  file = nowhere.txt\n\
                \\end{SPLINE_CURVE}\n\\end{OUTER_BOUNDARY}\n\\end{MODEL}\n";
    assert_eq!(parse_place(read_control_str(text, None).unwrap_err()), (4, 10));
}

#[test]
fn malformed_svg_file() {
    let svg = |d: &str| format!("<svg xmlns=\"http://www.w3.org/2000/svg\">\n  <path d=\"{d}\"/>\n</svg>");
    let error = |d: &str| parse_place(read_svg_str(&svg(d), None).unwrap_err());
    read_svg_str(&svg("M0 0L1 0L0 1Z"), None).unwrap();
    assert_eq!(error("M0 0L1 0L0 x1Z"), (2, 23));
    assert_eq!(error("L1 0L0 1Z").0, 2);
    assert_eq!(error("M0 0L1 0L1e999 1Z").0, 2);
    let whole = svg("M0 0L1 0L0 1Z");
    let truncated = &whole[..whole.len() - 8];
    assert_eq!(parse_place(read_svg_str(truncated, None).unwrap_err()).0, 2);
    assert_eq!(parse_place(read_svg_str("no xml at all", None).unwrap_err()), (1, 1));
    assert_eq!(parse_place(read_svg_str("<html/>", None).unwrap_err()), (1, 1));
    assert_eq!(parse_place(read_svg_str("<svg>\n<path/></svg>", None).unwrap_err()), (2, 1));
}

#[test]
fn svg_features_that_are_not_taken() {
    for text in [
        "<svg><circle r=\"3\"/></svg>",
        "<svg><g transform=\"scale(2)\"><path d=\"M0 0L1 0L0 1Z\"/></g></svg>",
    ] {
        let error = read_svg_str(text, None).unwrap_err();
        assert!(matches!(error, Error::Unsupported { .. }), "{error:?}");
    }
}

#[test]
fn several_svg_components_and_one_chosen() {
    let text = "<svg><path d=\"M0 0H1V1H0Z M5 0h3v3h-3z M6 1h1v1h-1z\"/></svg>";
    let error = read_svg_str(text, None).unwrap_err();
    assert!(matches!(error, Error::Nesting { reason: NestingError::SeveralComponents(2), .. }), "{error:?}");
    let areas = [0, 1].map(|k| read_svg_str(text, Some(k)).unwrap().domain.area().unwrap());
    assert!((areas[0] - 8.0).abs() < 1e-12 && (areas[1] - 1.0).abs() < 1e-12, "{areas:?}");
    let error = read_svg_str(text, Some(2)).unwrap_err();
    assert!(matches!(error, Error::InvalidArgument { .. }), "{error:?}");
}

#[test]
fn malformed_expressions() {
    for (text, column) in [
        ("", 1),
        ("1 +", 4),
        ("(t", 3),
        ("t)", 2),
        ("2 t", 3),
        ("foo(t)", 1),
        ("1 + sin t", 9),
        ("3 $ 4", 3),
        ("1..2", 3),
        ("u", 1),
    ] {
        let error = Expression::parse(text, "t", 1, 1).unwrap_err();
        assert_eq!(parse_place(error), (1, column), "{text:?}");
    }
    // Deep nesting must not overflow the stack.
    let deep = "(".repeat(100_000);
    assert_eq!(parse_place(Expression::parse(&deep, "t", 1, 1).unwrap_err()).0, 1);
    let signs = "-".repeat(100_000);
    assert_eq!(parse_place(Expression::parse(&signs, "t", 1, 1).unwrap_err()).0, 1);
}
