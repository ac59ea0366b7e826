//! Boundary names as text formats can hold them.

use std::collections::BTreeSet;

/// The names as single words: blanks, control characters and commas become `_`; a name that is empty, or is
/// HOHQMesh's mark `---` of sides inside the domain, becomes `boundary_K`, K its number from 1; names that
/// became equal get `_K` at the end.
pub fn words(names: &[String]) -> Vec<String> {
    let mut taken = BTreeSet::new();
    (1..)
        .zip(names)
        .map(|(k, name)| {
            let blank = |c: char| c.is_whitespace() || c.is_control() || c == ',';
            let mut word: String = name.trim().chars().map(|c| if blank(c) { '_' } else { c }).collect();
            if word.is_empty() || word == "---" {
                word = format!("boundary_{k}");
            }
            while !taken.insert(word.clone()) {
                word.push_str(&format!("_{k}"));
            }
            word
        })
        .collect()
}

/// The names as they may stand between double quotes on one line, at most `longest` bytes; a name that is
/// empty becomes `boundary_K`, names that became equal get ` K` at the end.
pub fn quotable(names: &[String], longest: usize) -> Vec<String> {
    let mut taken = BTreeSet::new();
    (1..)
        .zip(names)
        .map(|(k, name)| {
            let plain = |c: char| if c.is_control() { ' ' } else { c };
            let mut text: String =
                name.trim().chars().map(|c| if c == '"' { '\'' } else { plain(c) }).collect();
            if text.is_empty() {
                text = format!("boundary_{k}");
            }
            while !taken.insert(shortened(&mut text, longest)) {
                // Room for the number, which makes the names differ.
                shortened(&mut text, longest.saturating_sub(12));
                text.push_str(&format!(" {k}"));
            }
            text
        })
        .collect()
}

/// Cuts `text` to at most `longest` bytes, between characters, and gives a copy.
fn shortened(text: &mut String, longest: usize) -> String {
    while text.len() > longest {
        text.pop();
    }
    text.clone()
}
