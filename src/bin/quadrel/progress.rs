//! One line on a terminal that says how far the run is.

use quadrel::progress::{Progress, Stage};
use std::io::{stderr, IsTerminal, Write};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Time between two updates of the line.
const INTERVAL: Duration = Duration::from_millis(50);

/// A progress callback that writes to standard error, if that is a terminal.
pub fn terminal() -> Progress {
    if !stderr().is_terminal() {
        return Progress::default();
    }
    let last: Mutex<Option<(Instant, Stage)>> = Mutex::new(None);
    Progress::new(move |stage, fraction| {
        if let Ok(mut last) = last.lock() {
            let due = last.is_none_or(|(time, shown)| shown != stage || time.elapsed() >= INTERVAL);
            if due {
                *last = Some((Instant::now(), stage));
                let _ = write!(stderr(), "\r\x1b[K{:>3.0} %  {}", 100.0 * fraction, stage.name());
            }
        }
        true
    })
}

/// A progress callback that writes a stage's name to standard error when it begins: what a process that
/// had to be ended was doing last.
pub fn log() -> Progress {
    let last: Mutex<Option<Stage>> = Mutex::new(None);
    Progress::new(move |stage, _| {
        if let Ok(mut last) = last.lock() {
            if last.replace(stage) != Some(stage) {
                let _ = writeln!(stderr(), "{}", stage.name());
            }
        }
        true
    })
}

/// Takes the line away.
pub fn clear() {
    if stderr().is_terminal() {
        let _ = write!(stderr(), "\r\x1b[K");
    }
}
