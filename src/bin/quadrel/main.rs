//! The command line: `quadrel [DOMAIN]` meshes a domain, `quadrel corpus DIR...` many.
//!
//! Exit status 0: mesh written; 1: refused; 2: wrong usage, or a file that cannot be read or written.

mod arguments;
mod columns;
mod corpus;
mod progress;
mod report;
mod run;

use arguments::{Arguments, Command};
use clap::Parser;
use std::process::ExitCode;

/// How the program ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Done = 0,
    Refused = 1,
    Unusable = 2,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match arguments.command {
        Some(Command::Corpus(corpus)) => corpus::run(&corpus),
        None => run::run(&arguments.mesh),
    };
    ExitCode::from(outcome as u8)
}
