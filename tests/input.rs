//! The readers: expressions, control files, SVG paths; and the real outlines in `tests/domains`.

use quadrel::domain::{Boundary, Domain};
use quadrel::input::{gingerbread_man, read, read_control_str, read_svg_str, Expression};
use quadrel::Error;
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

/// Value and derivative, the latter compared with a difference quotient.
fn value(text: &str, t: f64) -> f64 {
    let e = Expression::parse(text, "t", 1, 1).unwrap();
    let (v, d) = e.evaluate(t);
    let h = 1e-6;
    let quotient = (e.evaluate(t + h).0 - e.evaluate(t - h).0) / (2.0 * h);
    assert!((d - quotient).abs() < 1e-5 * (1.0 + d.abs()), "{text} at {t}: {d} {quotient}");
    v
}

#[test]
fn expressions_follow_fortrans_precedence() {
    for (text, t, expected) in [
        ("-t^2", 3.0, -9.0),
        ("-t**2", 3.0, -9.0),
        ("2^3^2", 0.0, 512.0),
        ("2^-2", 0.0, 0.25),
        ("t^-1", 4.0, 0.25),
        ("2*-t", 3.0, -6.0),
        ("1 - 2 - 3", 0.0, -4.0),
        ("12/2/3", 0.0, 2.0),
        ("12/2*3", 0.0, 18.0),
        ("-2*t + 3", 1.0, 1.0),
        ("1.5d1*t", 2.0, 30.0),
        ("1.0D-1 + 2E0", 0.0, 2.1),
        (".5*T", 3.0, 1.5),
        ("COS(PI*t)", 1.0, -1.0),
        ("(1 - t)^8", 3.0, 256.0),
        ("(t - 2)^3", 1.0, -1.0),
        ("t^0.5", 4.0, 2.0),
        ("2^t", 3.0, 8.0),
        ("+t", 2.0, 2.0),
        ("4*cos(2*pi*t) - 3/5*cos(8*pi*t)^3", 0.125, 4.0 * (PI / 4.0).cos() + 0.6),
    ] {
        let v = value(text, t);
        assert!((v - expected).abs() < 1e-12 * (1.0 + expected.abs()), "{text} = {v}, not {expected}");
    }
}

#[test]
fn functions_have_their_values_and_derivatives() {
    let x: f64 = 0.37;
    for (name, expected) in [
        ("sin", x.sin()),
        ("cos", x.cos()),
        ("tan", x.tan()),
        ("asin", x.asin()),
        ("acos", x.acos()),
        ("atan", x.atan()),
        ("sinh", x.sinh()),
        ("cosh", x.cosh()),
        ("tanh", x.tanh()),
        ("atanh", x.atanh()),
        ("exp", x.exp()),
        ("log", x.ln()),
        ("ln", x.ln()),
        ("log10", x.log10()),
        ("sqrt", x.sqrt()),
        ("abs", x),
    ] {
        assert!((value(&format!("{name}(t)"), x) - expected).abs() < 1e-15, "{name}");
        value(&format!("{name}(0.5*t^2 + 0.1)*t"), x);
    }
}

#[test]
fn equation_names_its_own_variable() {
    let e = Expression::parse_equation("f(s) = 2*s", 1, 1).unwrap();
    assert_eq!(e.evaluate(3.0), (6.0, 2.0));
    assert!(Expression::parse_equation("f(s) = 2*t", 1, 1).is_err());
}

fn corner_count(domain: &Domain) -> usize {
    let b = Boundary::new(domain).unwrap();
    b.check().unwrap();
    b.junctions.iter().filter(|j| (j.angle - PI).abs() > 1e-3).count()
}

#[test]
fn gingerbread_man_is_built_in() {
    let model = gingerbread_man().unwrap();
    assert_eq!((model.order, model.domain.loops().len()), (Some(6), 7));
    // Neck, and the seams of the smile and one button that are not periodic splines.
    assert_eq!(corner_count(&model.domain), 3);
    // 310° at the neck, by the paper's Fig. 4.
    let b = Boundary::new(&model.domain).unwrap();
    let largest = b.junctions.iter().map(|j| j.angle.to_degrees()).fold(0.0, f64::max);
    assert!((largest - 310.0).abs() < 1.0, "{largest}");
}

#[test]
fn control_file_with_everything_is_read() {
    let text = "
% comment
\\begin{CONTROL_INPUT}
  \\begin{RUN_PARAMETERS}
    polynomial   order = 7
  \\end{RUN_PARAMETERS}
  \\begin{SOMETHING_NEW}
    key = value
  \\end{SOMETHING_NEW}
\\end{CONTROL_INPUT}
\\begin{MODEL}
  \\begin{OUTER_BOUNDARY}
    tolerance = 1.0d-3
    \\begin{CHAIN}
      \\begin{ELLIPTIC_ARC}
        name = shell
        units = degrees
        center = [1.0, 2.0, 0.0]
        xRadius = 4.0
        yRadius = 3.0
        rotation = 30.0
        start angle = 0.0
        end angle = 360.0
      \\end{ELLIPTIC_ARC}
    \\end{CHAIN}
  \\end{OUTER_BOUNDARY}
  \\begin{INNER_BOUNDARIES}
    \\begin{CIRCULAR_ARC}
      name = pin
      center = [1.0, 2.0, 0.0]
      radius = 0.5
      start angle = 0.0
      end angle = 6.283185307179586
    \\end{CIRCULAR_ARC}
  \\end{INNER_BOUNDARIES}
  \\begin{INTERFACE_BOUNDARIES}
    \\begin{CHAIN}
      name = seam
      \\begin{END_POINTS_LINE}
        xStart = [0.0, 1.0, 0.0]
        xEnd = [0.5, 1.0, 0.0]
      \\end{END_POINTS_LINE}
    \\end{CHAIN}
  \\end{INTERFACE_BOUNDARIES}
\\end{MODEL}
";
    let model = read_control_str(text, None).unwrap();
    assert_eq!((model.order, model.tolerance), (Some(7), Some(1e-3)));
    let area = model.domain.area().unwrap();
    assert!((area - PI * (12.0 - 0.25)).abs() < 1e-9, "{area}");
    assert_eq!(corner_count(&model.domain), 0);
    assert!(model.warnings.iter().any(|w| w.contains("interface")), "{:?}", model.warnings);
    assert_eq!(Boundary::new(&model.domain).unwrap().names, ["shell", "pin"]);
}

#[test]
fn background_grid_stands_for_a_missing_outer_boundary() {
    let model = read(Path::new("tests/domains/hohq/NACA0012.control"), None).unwrap();
    let bounds = model.domain.bounds();
    assert_eq!((bounds.low.x, bounds.low.y, bounds.high.x, bounds.high.y), (-20.0, -20.0, 20.0, 20.0));
    let names = Boundary::new(&model.domain).unwrap().names;
    assert_eq!(names[..4], ["Bottom", "Right", "Top", "Left"]);
}

#[test]
fn svg_commands_draw_what_they_say() {
    let area = |d: &str| {
        let text = format!("<svg><path d=\"{d}\"/></svg>");
        let domain = read_svg_str(&text, None).unwrap().domain;
        Boundary::new(&domain).unwrap().check().unwrap();
        domain.area().unwrap()
    };
    // Straight, absolute and relative, implicit repetition, without closing.
    for d in ["M0 0H2V1H0Z", "m0 0h2v1h-2z", "M0 0 2 0 2 1 0 1", "M0,0L2-0l0 1-2,0z"] {
        assert!((area(d) - 2.0).abs() < 1e-12, "{d}");
    }
    // Circles of radius 1 by arcs: two halves; a large and a small part; radii too small grow.
    for d in [
        "M1 0A1 1 0 0 1-1 0A1 1 0 0 1 1 0",
        "M1 0A1 1 0 0 1 0 1A1 1 0 1 1 1 0Z",
        "M1 0A.2.2 0 01-1 0A.2.2 0 011 0",
    ] {
        assert!((area(d) - PI).abs() < 1e-9, "{d}: {}", area(d));
    }
    // A turned ellipse.
    let d = "M0 0A4 2 30 0 0 6 2A4 2 30 0 0 0 0z";
    assert!(area(d) > 0.0);
    // Parabola segments: 2/3 of base times height 1.
    assert!((area("M0 0Q1 2 2 0z") - 4.0 / 3.0).abs() < 1e-12);
    assert!((area("M0 0Q1 2 2 0T4 0V-2H0z") - 8.0).abs() < 1e-12);
    // S mirrors the control point: the curve is smooth at its joint.
    let text = "<svg><path d=\"M0 0C0 2 1 2 2 2S4 2 4 0z\"/></svg>";
    assert_eq!(corner_count(&read_svg_str(text, None).unwrap().domain), 2);
    // A hole by even-odd, y up.
    let text = "<svg><path d=\"M0 0H4V3H0Z\"/><path d=\"M1 1h1v1h-1z\"/></svg>";
    let domain = read_svg_str(text, None).unwrap().domain;
    assert_eq!(domain.loops().len(), 2);
    assert!((domain.area().unwrap() - 11.0).abs() < 1e-12);
    assert_eq!((domain.bounds().low.y, domain.bounds().high.y), (-3.0, 0.0));
}

/// All files below `tests/domains`.
fn real_domains() -> Vec<PathBuf> {
    fn walk(folder: &Path, files: &mut Vec<PathBuf>) {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                walk(&path, files);
            } else if path.extension().is_some_and(|e| e == "control" || e == "svg") {
                files.push(path);
            }
        }
    }
    let mut files = Vec::new();
    walk(Path::new("tests/domains"), &mut files);
    files.sort();
    files
}

#[test]
fn real_outlines_are_read_and_only_true_cusps_refused() {
    let files = real_domains();
    assert!(files.len() >= 40, "{}", files.len());
    for path in files {
        let name = path.display();
        let model = match read(&path, None) {
            Ok(model) => model,
            Err(Error::Cusp { angle, .. }) => {
                assert!(path.ends_with("mech/arbelos.control") && angle < 1e-6, "{name}");
                continue;
            }
            Err(e) => panic!("{name}: {e}"),
        };
        let b = Boundary::new(&model.domain).unwrap();
        b.check().unwrap_or_else(|(what, at)| panic!("{name}: {what} at {at}"));
        // Gauss-Bonnet: curvature and turns of every loop add up to one full turn.
        for (k, chains) in b.loops.iter().enumerate() {
            let mut turn = 0.0;
            for &c in chains {
                let samples = &b.chains[c as usize].samples;
                let mut tangents: Vec<_> = samples.iter().map(|x| x.tangent).collect();
                if b.chains[c as usize].ends.is_none() {
                    tangents.push(tangents[0]);
                }
                for w in tangents.windows(2) {
                    turn += quadrel::numerics::cross(w[0], w[1]).atan2(w[0].dot(&w[1]));
                }
            }
            turn += b
                .junctions
                .iter()
                .filter(|j| chains.contains(&j.chain_out))
                .map(|j| PI - j.angle)
                .sum::<f64>();
            let expected = if k == 0 { 2.0 * PI } else { -2.0 * PI };
            assert!((turn - expected).abs() < 1e-6, "{name} loop {k}: {turn}");
        }
        // The area inside the tables is that of the exact curves.
        let mut area = 0.0;
        for chain in &b.chains {
            for w in chain.samples.windows(2).filter(|w| w[1].s > w[0].s) {
                let h = w[1].s - w[0].s;
                for (x, weight) in [(0.5 - 0.75f64.sqrt() / 3.0, 0.5), (0.5 + 0.75f64.sqrt() / 3.0, 0.5)] {
                    let (p, v) = chain.evaluate(w[0].s + h * x);
                    area += weight * h * 0.5 * quadrel::numerics::cross(p.coords, v);
                }
            }
        }
        assert!((area - b.area).abs() < 1e-9, "{name}: {area} {}", b.area);
    }
}

#[test]
fn a_path_that_misses_its_start_by_rounding_has_no_closing_line() {
    let segments = |gap: &str| {
        let text = format!("<svg><path d=\"M0 0H4V3H0L{gap} 0Z\"/></svg>");
        let domain = read_svg_str(&text, None).unwrap().domain;
        Boundary::new(&domain).unwrap().check().unwrap();
        assert!((domain.area().unwrap() - 12.0).abs() < 1e-4);
        domain.loops()[0].segments().len()
    };
    assert_eq!(segments("-0.0000005"), 4);
    assert_eq!(segments("-0.00001"), 5);
    // One that would run back over the path, as after coordinates rounded to few digits, is none.
    assert_eq!(segments("0.00001"), 4);
}
