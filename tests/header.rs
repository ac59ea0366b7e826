//! include/quadrel.h is generated from `src/ffi` with cbindgen, a section a file. This test says whether the
//! committed one is fresh; `QUADREL_WRITE_HEADER=1 cargo test --release --test header` writes it.

use std::fs;
use std::path::{Path, PathBuf};

/// The sections in the header's order: a type is declared before it is used.
const SECTIONS: [&str; 12] = [
    "status",
    "domain",
    "domain_file",
    "options",
    "base_triangulation",
    "size",
    "progress",
    "generate",
    "mesh",
    "quality",
    "stages",
    "write",
];

/// The longest line of the header.
const WIDTH: usize = 110;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn source(section: &str) -> PathBuf {
    root().join("src/ffi").join(format!("{section}.rs"))
}

/// The `//!` comment at the top of a file.
fn page(path: &Path) -> Vec<String> {
    let text = fs::read_to_string(path).unwrap();
    let lines = text.lines().map_while(|l| l.strip_prefix("//!"));
    lines.map(|l| l.strip_prefix(' ').unwrap_or(l).to_string()).collect()
}

/// A C comment of several lines.
fn comment(lines: &[String]) -> String {
    let body: Vec<String> = lines.iter().map(|l| format!(" * {l}").trim_end().to_string()).collect();
    format!("/*\n{}\n */\n", body.join("\n"))
}

/// The header's first page: the comment of `src/ffi/mod.rs`, its example without the marks of Markdown.
fn conventions() -> String {
    let mut lines = Vec::new();
    let mut example = false;
    for line in page(&source("mod")) {
        if line.starts_with("```") {
            example = !example;
        } else {
            lines.push(if example { format!("    {line}") } else { line.replace('`', "") });
        }
    }
    comment(&lines)
}

/// What cbindgen makes of one file.
fn declarations(section: &str) -> String {
    let config = cbindgen::Config {
        language: cbindgen::Language::C,
        style: cbindgen::Style::Type,
        documentation_style: cbindgen::DocumentationStyle::Doxy,
        usize_is_size_t: true,
        no_includes: true,
        line_length: WIDTH,
        tab_width: 4,
        ..cbindgen::Config::default()
    };
    let bindings = cbindgen::Builder::new().with_config(config).with_src(source(section)).generate().unwrap();
    let mut bytes = Vec::new();
    bindings.write(&mut bytes);
    String::from_utf8(bytes).unwrap()
}

/// Comments of one line on one line, no blank lines between constants or at the end of comments.
fn compact(text: &str) -> String {
    let mut lines: Vec<String> = Vec::new();
    for line in text.lines().map(str::trim_end) {
        // What annotations for cbindgen leave behind.
        while line == " */" && lines.last().is_some_and(|l| l == " *") {
            lines.pop();
        }
        let single = line == " */" && lines.len() > 1 && lines[lines.len() - 2] == "/**";
        if single {
            let body = lines.pop().unwrap().trim_start_matches(" *").trim().to_string();
            lines.pop();
            lines.push(format!("/** {body} */"));
        } else {
            lines.push(line.to_string());
        }
    }
    let constant = |k: usize| {
        let at = |k: usize| lines.get(k).map_or("", String::as_str);
        at(k).starts_with("#define") || at(k).starts_with("/** ") && at(k + 1).starts_with("#define")
    };
    let mut kept: Vec<String> = Vec::new();
    for (k, line) in lines.iter().enumerate() {
        let after = kept.last().map_or("", String::as_str);
        let between = after.starts_with("#define") && constant(k + 1);
        if !line.is_empty() || !after.is_empty() && !between {
            kept.push(line.clone());
        }
    }
    kept.join("\n").trim().to_string()
}

fn header() -> String {
    let mut text = conventions();
    text.push_str(
        "#ifndef QUADREL_H\n#define QUADREL_H\n\n#include <stddef.h>\n#include <stdint.h>\n\n\
         #ifdef __cplusplus\nextern \"C\" {\n#endif\n",
    );
    for section in SECTIONS {
        let mut lines = page(&source(section));
        lines[0] = format!("---- {} ----", lines[0]);
        text.push_str(&format!("\n{}\n{}\n", comment(&lines), compact(&declarations(section))));
    }
    text.push_str("\n#ifdef __cplusplus\n}\n#endif\n\n#endif /* QUADREL_H */\n");
    text
}

#[test]
fn the_committed_header_is_fresh() {
    let path = root().join("include/quadrel.h");
    let fresh = header();
    if std::env::var_os("QUADREL_WRITE_HEADER").is_some() {
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, &fresh).unwrap();
    }
    let committed = fs::read_to_string(&path).unwrap_or_default();
    if committed != fresh {
        let line = committed.lines().zip(fresh.lines()).position(|(a, b)| a != b).unwrap_or(0);
        panic!(
            "include/quadrel.h is stale from line {} on; write it anew with \
             QUADREL_WRITE_HEADER=1 cargo test --release --test header",
            line + 1
        );
    }
}

#[test]
fn the_header_has_everything_once() {
    let text = header();
    for file in fs::read_dir(root().join("src/ffi")).unwrap() {
        let code = fs::read_to_string(file.unwrap().path()).unwrap();
        for name in code.split("extern \"C\" fn quadrel_").skip(1) {
            let name = format!("quadrel_{}(", name.split('(').next().unwrap());
            let declared = text.lines().filter(|l| !l.starts_with(" *") && l.contains(&name)).count();
            assert_eq!(declared, 1, "{name}");
        }
    }
    assert!(text.lines().all(|l| l.chars().count() <= WIDTH + 20), "a line is too long");
    assert!(text.is_ascii());
}

/// The functions that the header declares are the ones that the shared library may export.
#[test]
fn the_list_of_symbols_is_the_header_s() {
    let text = header();
    let mut names: Vec<&str> = Vec::new();
    for line in text.lines().filter(|l| !l.starts_with([' ', '/', '#']) && !l.starts_with("typedef")) {
        let Some(open) = line.find('(') else { continue };
        names.extend(line[..open].rsplit([' ', '*']).next().filter(|n| n.starts_with("quadrel_")));
    }
    names.sort_unstable();
    let listed = fs::read_to_string(root().join("cpp_tests/symbols.txt")).unwrap();
    assert_eq!(names.join("\n"), listed.trim_end(), "cpp_tests/symbols.txt");
}
