//! The block structure of HOHQMesh's control files: nested \begin{NAME} ... \end{NAME}, in each
//! `key = value` lines and rows of data.

use crate::error::{Error, Result};

/// A piece of text and where it stands (from 1).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Located {
    pub text: String,
    pub line: usize,
    pub column: usize,
}

impl Located {
    /// A parse error at this place.
    pub fn error(&self, what: impl Into<String>) -> Error {
        Error::Parse { what: what.into(), line: self.line, column: self.column }
    }
}

/// A block.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Block {
    /// Upper case.
    pub name: String,
    pub line: usize,
    pub children: Vec<Block>,
    /// Keys in lower case with single blanks.
    pub keys: Vec<(String, Located)>,
    /// Other lines.
    pub rows: Vec<Located>,
}

impl Block {
    fn new(name: String, line: usize) -> Self {
        Block { name, line, children: Vec::new(), keys: Vec::new(), rows: Vec::new() }
    }

    /// The first child of this name.
    pub fn child(&self, name: &str) -> Option<&Block> {
        self.children.iter().find(|c| c.name == name)
    }

    /// The value of a key; the last one counts.
    pub fn get(&self, key: &str) -> Option<&Located> {
        self.keys.iter().rev().find(|(k, _)| k == key).map(|(_, v)| v)
    }

    /// The value of a key that must be there.
    pub fn need(&self, key: &str) -> Result<&Located> {
        self.get(key).ok_or_else(|| self.error(format!("{} lacks '{key}'", self.name)))
    }

    /// A parse error at the block's first line.
    pub fn error(&self, what: impl Into<String>) -> Error {
        Error::Parse { what: what.into(), line: self.line, column: 1 }
    }

    /// The first block of one of these names, at any depth.
    pub fn find(&self, names: &[&str]) -> Option<&Block> {
        self.children
            .iter()
            .find_map(|c| if names.contains(&c.name.as_str()) { Some(c) } else { c.find(names) })
    }
}

/// Deepest nesting of blocks accepted.
const MAX_DEPTH: usize = 32;

/// The name in `\begin{NAME}` or `\end{NAME}`, if `line` is such a line of this `word`.
fn marker(line: &str, word: &str) -> Option<String> {
    let rest = line.strip_prefix('\\')?.strip_prefix(word)?.trim_start().strip_prefix('{')?;
    let name = rest.split_once('}')?.0.trim();
    (!name.is_empty()).then(|| name.to_uppercase())
}

/// Parses the whole text into a block named ROOT.
pub(crate) fn parse(text: &str) -> Result<Block> {
    let mut open = vec![Block::new("ROOT".into(), 1)];
    for (k, raw) in text.lines().enumerate() {
        let line = k + 1;
        let trimmed = raw.trim();
        let column = raw.chars().take_while(|c| c.is_whitespace()).count() + 1;
        if trimmed.is_empty() || trimmed.starts_with(['%', '!']) {
            continue;
        }
        let error = |what: String| Error::Parse { what, line, column };
        if let Some(name) = marker(trimmed, "begin") {
            if open.len() > MAX_DEPTH {
                return Err(error("blocks are nested too deeply".into()));
            }
            open.push(Block::new(name, line));
        } else if let Some(name) = marker(trimmed, "end") {
            if name == "FILE" {
                break;
            }
            match open.pop() {
                Some(block) if block.name == name && !open.is_empty() => {
                    if let Some(parent) = open.last_mut() {
                        parent.children.push(block);
                    }
                }
                Some(block) if !open.is_empty() => {
                    return Err(error(format!("\\end{{{name}}} closes \\begin{{{}}}", block.name)))
                }
                _ => return Err(error(format!("\\end{{{name}}} without its \\begin"))),
            }
        } else if trimmed.starts_with("\\begin") || trimmed.starts_with("\\end") {
            return Err(error(format!("'{trimmed}' is no block marker: \\begin{{NAME}} or \\end{{NAME}}")));
        } else if let Some(block) = open.last_mut() {
            if let Some(equals) = raw.find('=') {
                let key = raw[..equals].split_whitespace().collect::<Vec<_>>().join(" ").to_lowercase();
                let value = &raw[equals + 1..];
                let blanks = value.chars().take_while(|c| c.is_whitespace()).count();
                let column = raw[..=equals].chars().count() + blanks + 1;
                block.keys.push((key, Located { text: value.trim().to_string(), line, column }));
            } else {
                block.rows.push(Located { text: trimmed.to_string(), line, column });
            }
        }
    }
    match (open.pop(), open.is_empty()) {
        (Some(root), true) => Ok(root),
        (Some(block), _) => Err(block.error(format!("\\begin{{{}}} is never closed", block.name))),
        (None, _) => Err(Error::Parse { what: "no blocks".into(), line: 1, column: 1 }),
    }
}
