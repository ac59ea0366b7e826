//! The rules of the house that a compiler does not check: which folder may use which, where `unsafe`
//! and foreign crates may appear, that the library is silent, that files are small.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// May be used by everything.
const FREE: [&str; 4] = ["numerics", "options", "error", "progress"];

/// What each folder (or file) directly in `src/` may use beside [`FREE`] and itself.
const MAY_USE: &[(&str, &[&str])] = &[
    ("numerics", &[]),
    ("options", &[]),
    ("error", &[]),
    ("progress", &[]),
    ("domain", &[]),
    ("base_mesh", &["domain"]),
    ("cross_field", &["domain", "base_mesh"]),
    ("singularities", &["domain", "base_mesh", "cross_field"]),
    ("separatrices", &["domain", "base_mesh", "cross_field", "singularities"]),
    ("layout", &["domain", "singularities", "separatrices"]),
    ("mesh", &["domain"]),
    ("smooth", &["domain", "mesh"]),
    ("symmetry", &["domain", "mesh"]),
    // Coarsening re-optimises round every removal.
    ("refine", &["domain", "mesh", "layout", "smooth"]),
    ("input", &["domain"]),
    ("stages", &["domain", "base_mesh", "cross_field", "singularities", "separatrices", "layout", "mesh"]),
    ("statistics", &["domain", "mesh", "stages"]),
    ("output", &["domain", "mesh", "stages"]),
];

/// Uses all but these; and nothing but these uses them.
const GENERATE_MAY_NOT_USE: [&str; 3] = ["ffi", "input", "output"];

/// A source file: the folder directly in `src/` it belongs to, its path, and its text without
/// comments and strings.
struct Source {
    part: String,
    path: PathBuf,
    code: String,
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn rust_files(dir: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let Ok(entries) = fs::read_dir(dir) else { return found };
    for path in entries.map(|e| e.unwrap().path()) {
        if path.is_dir() {
            found.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn sources() -> Vec<Source> {
    let src = root().join("src");
    let read = |path: PathBuf| {
        let inside = path.strip_prefix(&src).unwrap();
        let first = inside.components().next().unwrap().as_os_str().to_string_lossy().to_string();
        let code = without_comments_and_strings(&fs::read_to_string(&path).unwrap());
        Source { part: first.trim_end_matches(".rs").to_string(), code, path }
    };
    rust_files(&src).into_iter().map(read).collect()
}

/// Replaces comments, string and character literals by blanks; line breaks stay.
fn without_comments_and_strings(text: &str) -> String {
    let bytes: Vec<char> = text.chars().collect();
    let mut out = String::with_capacity(text.len());
    let at = |i: usize| bytes.get(i).copied().unwrap_or(' ');
    let mut i = 0;
    while i < bytes.len() {
        let hashes = (i + 1..).take_while(|k| at(*k) == '#').count();
        let end = if at(i) == '/' && at(i + 1) == '/' {
            (i..bytes.len()).find(|k| at(*k) == '\n').unwrap_or(bytes.len())
        } else if at(i) == '/' && at(i + 1) == '*' {
            (i + 2..bytes.len()).find(|k| at(*k) == '*' && at(*k + 1) == '/').map_or(bytes.len(), |k| k + 2)
        } else if at(i) == 'r' && at(i + 1 + hashes) == '"' && !at(i.wrapping_sub(1)).is_alphanumeric() {
            let close = |k: &usize| at(*k) == '"' && (1..=hashes).all(|h| at(*k + h) == '#');
            (i + 2 + hashes..bytes.len()).find(close).map_or(bytes.len(), |k| k + 1 + hashes)
        } else if at(i) == '"' {
            let mut k = i + 1;
            while k < bytes.len() && at(k) != '"' {
                k += if at(k) == '\\' { 2 } else { 1 };
            }
            k + 1
        } else if at(i) == '\'' && (at(i + 1) == '\\' || at(i + 2) == '\'') {
            let first = if at(i + 1) == '\\' { i + 3 } else { i + 2 };
            (first..bytes.len()).find(|k| at(*k) == '\'').map_or(bytes.len(), |k| k + 1)
        } else {
            out.push(at(i));
            i += 1;
            continue;
        };
        out.extend((i..end.min(bytes.len())).map(|k| if at(k) == '\n' { '\n' } else { ' ' }));
        i = end;
    }
    out
}

/// Whether `code` has `word` with no letter, digit or underscore beside it.
fn has_word(code: &str, word: &str) -> bool {
    let part = |c: char| c.is_alphanumeric() || c == '_';
    code.match_indices(word).any(|(i, _)| {
        !code[..i].chars().next_back().is_some_and(part)
            && !code[i + word.len()..].chars().next().is_some_and(part)
    })
}

/// The names that follow `crate::` anywhere, also in braces.
fn parts_used(code: &str) -> BTreeSet<String> {
    let mut used = BTreeSet::new();
    for (i, _) in code.match_indices("crate::") {
        let rest = code[i + 7..].trim_start();
        let name = |text: &str| -> String {
            text.trim_start().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
        };
        match rest.strip_prefix('{') {
            None => {
                used.insert(name(rest));
            }
            Some(group) => {
                let mut depth = 0;
                let mut start = true;
                for (k, c) in group.char_indices() {
                    match c {
                        '{' => depth += 1,
                        '}' if depth == 0 => break,
                        '}' => depth -= 1,
                        ',' if depth == 0 => start = true,
                        c if start && !c.is_whitespace() => {
                            used.insert(name(&group[k..]));
                            start = false;
                        }
                        _ => {}
                    }
                }
            }
        }
    }
    used
}

/// All rules broken, in words.
fn broken_dependencies(sources: &[Source]) -> Vec<String> {
    let table: BTreeMap<&str, &[&str]> = MAY_USE.iter().copied().collect();
    let known: BTreeSet<&str> = sources.iter().map(|s| s.part.as_str()).collect();
    let mut broken = Vec::new();
    for source in sources {
        let part = source.part.as_str();
        for used in parts_used(&source.code) {
            let used = used.as_str();
            let allowed = match part {
                "lib" | "ffi" | "bin" => true,
                "generate" => !GENERATE_MAY_NOT_USE.contains(&used),
                _ => table.get(part).is_some_and(|list| list.contains(&used)),
            };
            // `crate::Error` and its like are re-exports of free parts.
            let exempt = !known.contains(used) && matches!(used, "Error" | "Result" | "Options");
            if used != part && !FREE.contains(&used) && !exempt && !allowed {
                broken.push(format!("{} uses {used}", source.path.display()));
            }
        }
    }
    broken
}

#[test]
fn folders_use_only_what_the_table_allows() {
    let sources = sources();
    assert!(sources.len() > 10, "the sources were not found");
    for source in &sources {
        let listed = MAY_USE.iter().any(|(name, _)| *name == source.part);
        let special = ["lib", "generate", "ffi", "bin"].contains(&source.part.as_str());
        assert!(listed || special, "{} is in no row of the table", source.path.display());
    }
    assert_eq!(broken_dependencies(&sources), Vec::<String>::new());
}

#[test]
fn the_dependency_check_sees_violations() {
    let source = |part: &str, text: &str| Source {
        part: part.into(),
        path: part.into(),
        code: without_comments_and_strings(text),
    };
    let violations = [
        source("layout", "use crate::cross_field::CrossField;"),
        source("domain", "use crate::{error::Error, mesh::{QuadMesh, Edge}};"),
        source("mesh", "fn f(s: &crate::stages::Stages) {}"),
        source("generate", "use crate::output::svg;"),
        source("generate", "use crate::ffi::status_of;"),
        source("output", "use crate::ffi::status_of;"),
        source("numerics", "use crate::{\n    numerics::Point,\n    domain::Frame,\n};"),
    ];
    let fine = [
        source("layout", "use crate::separatrices::Separatrix; // crate::cross_field is not needed"),
        source("domain", "use crate::{error::Error, numerics::{Point, mesh}}; let s = \"crate::mesh\";"),
        source("bin", "use crate::args::Args;"),
        source("generate", "use crate::mesh::QuadMesh;"),
    ];
    for wrong in violations {
        assert_eq!(broken_dependencies(std::slice::from_ref(&wrong)).len(), 1, "{}", wrong.part);
    }
    assert_eq!(broken_dependencies(&fine), Vec::<String>::new());
}

#[test]
fn only_the_base_mesh_names_spade() {
    let naming: Vec<_> = sources().into_iter().filter(|s| has_word(&s.code, "spade")).collect();
    assert!(naming.iter().all(|s| s.part == "base_mesh"), "{:?}", naming.first().map(|s| &s.path));
}

#[test]
fn only_ffi_names_libc() {
    let naming: Vec<_> = sources().into_iter().filter(|s| has_word(&s.code, "libc")).collect();
    assert!(naming.iter().all(|s| s.part == "ffi"), "{:?}", naming.first().map(|s| &s.path));
}

#[test]
fn only_ffi_is_unsafe() {
    for source in sources().iter().filter(|s| s.part != "ffi") {
        assert!(!has_word(&source.code, "unsafe"), "{} has unsafe code", source.path.display());
    }
    let lib = fs::read_to_string(root().join("src/lib.rs")).unwrap();
    assert!(lib.contains("#![deny(unsafe_code)]"));
}

#[test]
fn the_library_is_silent_and_leaves_nothing_unfinished() {
    for source in sources() {
        let mut banned = vec!["dbg", "todo", "unimplemented"];
        if source.part != "bin" {
            banned.extend(["print", "println", "eprint", "eprintln", "exit"]);
        }
        for name in banned {
            let call = if name == "exit" { "process::exit".to_string() } else { format!("{name}!") };
            let found = source.code.match_indices(&call).any(|(i, _)| {
                !source.code[..i].chars().next_back().is_some_and(|c| c.is_alphanumeric() || c == '_')
            });
            assert!(!found, "{} has {call}", source.path.display());
        }
    }
}

#[test]
fn files_are_small() {
    for folder in ["src", "tests", "examples", "benches"] {
        for path in rust_files(&root().join(folder)) {
            let lines = fs::read_to_string(&path).unwrap().lines().count();
            assert!(lines <= 600, "{} has {lines} lines", path.display());
        }
    }
}

#[test]
fn literals_and_comments_are_blanked() {
    let text = "let a = '\"'; let b = \"x // y\"; let c = r#\"un\"safe\"#; // unsafe\nlet d: &'static str = \"\\\"\";/* e */ let g = ['\\'', '\"']; f";
    let code = without_comments_and_strings(text);
    for gone in ["unsafe", "safe", "x // y", "e */"] {
        assert!(!code.contains(gone), "{gone} in {code}");
    }
    assert!(code.contains("let d: &'static str =") && code.contains(" f"), "{code}");
    assert_eq!(code.lines().count(), text.lines().count());
}
