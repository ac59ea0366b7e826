//! The command line through its binary: exit status, files, tables, statistics, the corpus command.
#![cfg(feature = "cli")]

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A square with a rounded side and a round hole.
const PLATE: &str = r#"<svg xmlns="http://www.w3.org/2000/svg"><path
    d="M0 0H4V3A2 1 0 0 1 0 3Z M1.5 1.5A0.5 0.5 0 0 0 2.5 1.5A0.5 0.5 0 0 0 1.5 1.5Z"/></svg>"#;
const RECTANGLE: &str = r#"<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0H3V2H0Z"/></svg>"#;
/// A loop that crosses itself.
const BOW_TIE: &str = r#"<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0L4 4H0L4 0Z"/></svg>"#;
const TWO_SQUARES: &str =
    r#"<svg xmlns="http://www.w3.org/2000/svg"><path d="M0 0H1V1H0Z M3 0H5V2H3Z"/></svg>"#;

/// An empty folder of this test's own.
fn folder(name: &str) -> PathBuf {
    let dir = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cli-{name}"));
    let _ = fs::remove_dir_all(&dir);
    fs::create_dir_all(&dir).unwrap();
    dir
}

fn quadrel(dir: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_quadrel")).current_dir(dir).args(arguments).output().unwrap()
}

fn status(output: &Output) -> i32 {
    output.status.code().expect("ended by a signal")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// All files below `dir`, relative, sorted.
fn listing(dir: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for entry in fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            found.extend(listing(&path).into_iter().map(|inner| format!("{name}/{inner}")));
        } else {
            found.push(name);
        }
    }
    found.sort();
    found
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn wrong_usage_ends_with_2_and_writes_nothing() {
    let dir = folder("usage");
    fs::write(dir.join("plate.svg"), PLATE).unwrap();
    fs::write(dir.join("empty.control"), "").unwrap();
    fs::write(dir.join("noise.control"), "\\begin{nonsense\n%%%\n").unwrap();
    fs::write(dir.join("broken.svg"), "<svg><path d='M0 0 L").unwrap();
    fs::write(dir.join("mesh.xyz"), PLATE).unwrap();
    let before = listing(&dir);
    let cases: &[(&[&str], &str)] = &[
        (&["missing.control", "-o", "m.vtu"], "missing.control"),
        (&["empty.control", "-o", "m.vtu"], "empty"),
        (&["noise.control", "-o", "m.vtu"], "line"),
        (&["broken.svg", "-o", "m.vtu"], "broken.svg"),
        (&["mesh.xyz", "-o", "m.vtu"], ".control"),
        (&["plate.svg", "-o", "m.stl"], "vtu, msh, ism, ism-v2, ism-mm, inp, mfem, svg"),
        (&["plate.svg", "-o", "m"], ".mesh is ism-v2"),
        (&["plate.svg", "-o", "m.vtu", "--format", "stl"], "vtu, msh"),
        (&["plate.svg", "-o", "m.vtu", "-o", "m.msh", "--order", "11"], "order 1 to 10"),
        (&["plate.svg", "-o", "no/such/m.vtu"], "folder"),
        (&["plate.svg", "-o", "plate.svg"], "domain's own file"),
        (&["plate.svg", "-o", "m.vtu", "--order", "0"], "order"),
        (&["plate.svg", "-o", "m.vtu", "--order", "33"], "1 to 32"),
        (&["plate.svg", "-o", "m.vtu", "--order", "five"], "--order"),
        (&["plate.svg", "-o", "m.vtu", "--tolerance", "-1"], "tolerance"),
        (&["plate.svg", "-o", "m.vtu", "--relative", "nan"], "tolerance"),
        (&["plate.svg", "-o", "m.vtu", "--tolerance", "1", "--relative", "1"], "--relative"),
        (&["plate.svg", "-o", "m.vtu", "--max-size", "0"], "size"),
        (&["plate.svg", "-o", "m.vtu", "--size", "x +"], "term is expected"),
        (&["plate.svg", "-o", "m.vtu", "--quality-floor", "1.5"], "quality floor"),
        (&["plate.svg", "-o", "m.vtu", "--norm", "l7"], "l7"),
        (&["plate.svg", "-o", "m.vtu", "--threads", "0"], "--threads"),
        (&["plate.svg", "-o", "m.vtu", "--nonsense"], "--nonsense"),
        (&["corpus"], "DIR"),
        (&["corpus", "no-such-folder"], "no-such-folder"),
    ];
    for (arguments, expected) in cases {
        let output = quadrel(&dir, arguments);
        let said = text(&output.stderr);
        assert_eq!(status(&output), 2, "{arguments:?}: {said}");
        assert!(said.contains(expected), "{arguments:?} says: {said}");
        assert_eq!(listing(&dir), before, "{arguments:?} wrote something");
    }
}

#[test]
fn a_bad_domain_ends_with_1_and_writes_only_what_was_asked_for() {
    let dir = folder("refused");
    fs::write(dir.join("bow.svg"), BOW_TIE).unwrap();
    let output = quadrel(&dir, &["bow.svg", "-o", "bow.vtu", "-o", "bow2.svg", "--stats", "bow.json"]);
    assert_eq!(status(&output), 1);
    assert!(text(&output.stderr).contains("(2.000000000, "), "{}", text(&output.stderr));
    assert_eq!(listing(&dir), ["bow.json", "bow.svg"]);
    let statistics = json(&dir.join("bow.json"));
    assert_eq!(statistics["status"], "intersection");
    assert_eq!(statistics["place"][0], 2.0);
    assert!(statistics["message"].as_str().unwrap().contains("cross"));
    assert!(statistics["elements"].is_null());

    fs::write(dir.join("two.svg"), TWO_SQUARES).unwrap();
    let output = quadrel(&dir, &["two.svg", "-o", "two.vtu"]);
    assert_eq!(status(&output), 1);
    assert!(text(&output.stderr).contains("--component"), "{}", text(&output.stderr));
}

#[test]
fn a_domain_is_meshed_to_every_file_asked_for() {
    let dir = folder("plate");
    fs::write(dir.join("plate.svg"), PLATE).unwrap();
    let arguments = [
        "plate.svg",
        "--order",
        "4",
        "--relative",
        "1e-4",
        "--threads",
        "2",
        "-o",
        "a.vtu",
        "-o",
        "b.svg",
        "--stats",
        "s.json",
        "--stages",
        "pictures",
    ];
    let output = quadrel(&dir, &arguments);
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    assert!(output.stderr.is_empty(), "no progress where there is no terminal");
    let table = text(&output.stdout);
    for word in
        ["base_mesh", "triangles", "elements", "scaled Jacobian", "boundary error", "total", "wrote a.vtu"]
    {
        assert!(table.contains(word), "{word} is missing in\n{table}");
    }
    let pictures =
        ["boundary", "triangles", "crosses", "singularities", "separatrices", "regions", "blocks", "mesh"];
    let mut expected: Vec<String> =
        pictures.iter().enumerate().map(|(k, p)| format!("pictures/{k}-{p}.svg")).collect();
    expected.extend(["a.vtu", "b.svg", "pictures/stages.svg", "plate.svg", "s.json"].map(String::from));
    expected.sort();
    assert_eq!(listing(&dir), expected);

    let statistics = json(&dir.join("s.json"));
    assert_eq!(statistics["status"], "ok");
    assert_eq!(statistics["order"], 4);
    let number = |pointer: &str| statistics.pointer(pointer).and_then(Value::as_f64).unwrap();
    assert!(number("/elements") >= 4.0 && number("/nodes") > 9.0 * number("/elements"));
    assert!(number("/scaled_jacobian/min") > 0.0);
    assert!(number("/scaled_jacobian/min") <= number("/scaled_jacobian/p1"));
    assert!(number("/scaled_jacobian/p1") <= number("/scaled_jacobian/mean"));
    assert!(number("/scaled_jacobian/min") <= number("/scaled_jacobian_ceiling") + 1e-9);
    assert_eq!(statistics["boundary_error"]["loops"].as_array().unwrap().len(), 2);
    assert!(number("/seconds/total") >= number("/seconds/base_mesh"));
}

#[test]
fn statistics_have_their_keys_in_order() {
    let dir = folder("keys");
    fs::write(dir.join("bow.svg"), BOW_TIE).unwrap();
    quadrel(&dir, &["bow.svg", "--stats", "s.json"]);
    let statistics = json(&dir.join("s.json"));
    let keys: Vec<&String> = statistics.as_object().unwrap().keys().collect();
    let expected = [
        "status",
        "message",
        "place",
        "seconds",
        "triangles",
        "singularities",
        "separatrices",
        "blocks",
        "elements",
        "order",
        "nodes",
        "irregular",
        "irregular_expected",
        "scaled_jacobian",
        "scaled_jacobian_ceiling",
        "boundary_error",
        "symmetry",
        "fallback",
        "attempts",
        "rounds",
        "warnings",
    ];
    assert_eq!(keys, expected);
    let seconds: Vec<&String> = statistics["seconds"].as_object().unwrap().keys().collect();
    let stages = quadrel::progress::Stage::ALL.map(|s| s.name());
    assert_eq!(seconds[..9], stages);
    assert_eq!(seconds[9], "total");
}

#[test]
fn the_format_wins_over_the_extension() {
    let dir = folder("format");
    fs::write(dir.join("r.svg"), RECTANGLE).unwrap();
    let output = quadrel(&dir, &["r.svg", "-o", "mesh.dat", "--format", "VTU"]);
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    assert!(fs::read_to_string(dir.join("mesh.dat")).unwrap().contains("<VTKFile"));
}

#[test]
fn without_a_domain_the_gingerbread_man_is_meshed() {
    let dir = folder("gingerbread");
    let output = quadrel(&dir, &[]);
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("order 5, L2 tolerance 1.000e-2"), "{}", text(&output.stdout));
    assert_eq!(listing(&dir), ["gingerbread.svg", "gingerbread.vtu"]);
}

#[test]
fn equal_runs_write_equal_bytes() {
    let dir = folder("equal");
    fs::write(dir.join("plate.svg"), PLATE).unwrap();
    for name in ["a", "b"] {
        let threads = if name == "a" { "1" } else { "2" };
        let outputs = [format!("{name}.vtu"), format!("{name}.svg")];
        let arguments = ["plate.svg", "--threads", threads, "-o", &outputs[0], "-o", &outputs[1]];
        assert_eq!(status(&quadrel(&dir, &arguments)), 0);
    }
    for extension in ["vtu", "svg"] {
        let read = |name: &str| fs::read(dir.join(format!("{name}.{extension}"))).unwrap();
        assert!(read("a") == read("b"), "{extension} differs");
    }
}

#[test]
fn a_corpus_is_summed_up_by_family_and_status() {
    let dir = folder("corpus");
    for (name, content) in [
        ("first/rectangle.svg", RECTANGLE),
        ("first/deep/bow.svg", BOW_TIE),
        ("second/odd, name.control", "\\begin{"),
        ("second/readme.txt", "no domain"),
        ("top.svg", RECTANGLE),
    ] {
        let path = dir.join("domains").join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }
    let output = quadrel(&dir, &["corpus", "domains", "--csv", "table.csv", "-o", "meshes", "--order", "3"]);
    assert_eq!(status(&output), 1, "some are refused: {}", text(&output.stderr));
    let said = text(&output.stdout);
    for word in ["intersection", "parse", "first", "second", "domains", "all"] {
        assert!(said.contains(word), "{word} is missing in\n{said}");
    }
    let expected = [
        "meshes/first/rectangle.svg.svg",
        "meshes/first/rectangle.svg.vtu",
        "meshes/top.svg.svg",
        "meshes/top.svg.vtu",
        "table.csv",
    ];
    let written: Vec<String> = listing(&dir).into_iter().filter(|f| !f.starts_with("domains/")).collect();
    assert_eq!(written, expected);

    let csv = fs::read_to_string(dir.join("table.csv")).unwrap();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines.len(), 5);
    assert!(lines[0].starts_with("file,family,status,message,place,seconds.domain,"), "{}", lines[0]);
    assert!(
        lines[0].contains(",irregular.interior,irregular.boundary,irregular_expected,scaled_jacobian.min,")
    );
    assert!(lines[1].starts_with("domains/first/deep/bow.svg,first,intersection,"), "{}", lines[1]);
    assert!(lines[2].starts_with("domains/first/rectangle.svg,first,ok,"), "{}", lines[2]);
    assert!(lines[3].starts_with("\"domains/second/odd, name.control\",second,parse,"), "{}", lines[3]);
    assert!(lines[4].starts_with("domains/top.svg,domains,ok,"), "{}", lines[4]);
}

#[test]
fn a_run_that_takes_too_long_is_ended() {
    let dir = folder("limit");
    fs::write(dir.join("plate.svg"), PLATE).unwrap();
    let output = quadrel(&dir, &["corpus", ".", "--limit-seconds", "0", "--csv", "t.csv"]);
    assert_eq!(status(&output), 1);
    let csv = fs::read_to_string(dir.join("t.csv")).unwrap();
    assert!(csv.lines().nth(1).unwrap().starts_with("./plate.svg,cli-limit,timeout,"), "{csv}");
}

#[test]
fn a_failing_domain_is_reduced_to_what_makes_it_fail() {
    let dir = folder("reduce");
    let hole = |x: f64, y: f64| format!("M{x} {y}h1v1h-1Z");
    let mut path = "M0 0H40V40H0Z ".to_string();
    (0..8).for_each(|k| path.push_str(&hole(2.0 + 4.0 * k as f64, 3.0)));
    // Two holes that overlap.
    path.push_str(&(hole(20.0, 20.0) + &hole(20.5, 20.5)));
    let domain = format!(r#"<svg xmlns="http://www.w3.org/2000/svg"><path d="{path}"/></svg>"#);
    fs::write(dir.join("d.svg"), domain).unwrap();
    let output = quadrel(&dir, &["corpus", "--reduce", "d.svg"]);
    assert_eq!(status(&output), 0, "{}", text(&output.stderr));
    assert_eq!(listing(&dir), ["d.reduced.svg", "d.svg"]);
    let reduced = fs::read_to_string(dir.join("d.reduced.svg")).unwrap();
    assert_eq!(reduced.matches('M').count(), 3, "{reduced}");
    assert!(reduced.contains("M20 20") && reduced.contains("M20.5 20.5"), "{reduced}");
}

#[test]
fn inner_boundaries_of_a_control_file_are_reduced() {
    let dir = folder("reduce-control");
    let line = |a: (f64, f64), b: (f64, f64)| {
        format!(
            "\\begin{{END_POINTS_LINE}}\nname = l\nxStart = [{},{},0.0]\nxEnd = [{},{},0.0]\n\\end{{END_POINTS_LINE}}\n",
            a.0, a.1, b.0, b.1
        )
    };
    let square = |name: &str, x: f64, y: f64, w: f64| {
        let p = [(x, y), (x + w, y), (x + w, y + w), (x, y + w)];
        let lines: String = (0..4).map(|k| line(p[k], p[(k + 1) % 4])).collect();
        format!("\\begin{{CHAIN}}\nname = {name}\n{lines}\\end{{CHAIN}}\n")
    };
    let outer: String = square("o", 0.0, 0.0, 10.0)
        .lines()
        .filter(|l| !l.contains("CHAIN") && *l != "name = o")
        .map(|l| format!("{l}\n"))
        .collect();
    let holes = square("a", 1.0, 1.0, 1.0)
        + &square("b", 5.0, 5.0, 2.0)
        + &square("c", 6.0, 6.0, 2.0)
        + &square("d", 1.0, 7.0, 1.0);
    let control = format!(
        "\\begin{{MODEL}}\n\\begin{{OUTER_BOUNDARY}}\n{outer}\\end{{OUTER_BOUNDARY}}\n\
         \\begin{{INNER_BOUNDARIES}}\n{holes}\\end{{INNER_BOUNDARIES}}\n\\end{{MODEL}}\n\\end{{FILE}}\n"
    );
    fs::write(dir.join("d.control"), control).unwrap();
    let output = quadrel(&dir, &["corpus", "--reduce", "d.control"]);
    assert_eq!(status(&output), 0, "{}{}", text(&output.stdout), text(&output.stderr));
    let reduced = fs::read_to_string(dir.join("d.reduced.control")).unwrap();
    assert_eq!(reduced.matches("\\begin{CHAIN}").count(), 2, "{reduced}");
    assert!(reduced.contains("name = b") && reduced.contains("name = c"));
}

/// A folder in which nobody can make a file: one without the right to write, or, for root, whom that does not
/// stop, the kernel's.
#[cfg(unix)]
fn read_only_folder(dir: &Path) -> PathBuf {
    use std::os::unix::fs::PermissionsExt;
    let locked = dir.join("locked");
    fs::create_dir(&locked).unwrap();
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o555)).unwrap();
    match fs::write(locked.join("probe"), "") {
        Ok(()) => PathBuf::from("/sys"),
        Err(_) => locked,
    }
}

#[cfg(target_os = "linux")]
#[test]
fn what_cannot_be_written_leaves_no_part_of_a_file() {
    let dir = folder("unwritable");
    fs::write(dir.join("plate.svg"), RECTANGLE).unwrap();
    fs::create_dir(dir.join("taken.msh")).unwrap();
    fs::write(dir.join("kept.msh"), "before").unwrap();
    let locked = read_only_folder(&dir);
    let before = listing(&dir);
    let in_locked = locked.join("mesh.msh").display().to_string();
    // A full disk is a device that is always full, and, for regular files, a limit on their size.
    let limited = "trap '' XFSZ; ulimit -f 1; exec \"$0\" plate.svg --order 8";
    let exe = env!("CARGO_BIN_EXE_quadrel");
    let cases: &[(&str, &[&str], &str)] = &[
        (exe, &["plate.svg", "-o", "taken.msh"], "taken.msh: is a folder"),
        (exe, &["plate.svg", "-o", &in_locked], &in_locked),
        (exe, &["plate.svg", "-o", "/dev/full", "--format", "msh"], "/dev/full: cannot be written: No space"),
        ("sh", &["-c", &format!("{limited} -o new.msh"), exe], "new.msh: cannot be written: File too large"),
        ("sh", &["-c", &format!("{limited} -o small.ism -o kept.msh"), exe], "kept.msh: cannot be written"),
    ];
    for (program, arguments, expected) in cases {
        let output = Command::new(program).current_dir(&dir).args(*arguments).output().unwrap();
        let said = text(&output.stderr);
        assert_eq!(status(&output), 2, "{arguments:?}: {said}");
        assert!(said.contains(expected), "{arguments:?} says: {said}");
        assert_eq!(listing(&dir), before, "{arguments:?} left something");
        assert_eq!(fs::read_to_string(dir.join("kept.msh")).unwrap(), "before");
    }
}
