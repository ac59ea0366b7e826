//! One domain in a process of its own.

use crate::arguments::CorpusArguments;
use quadrel::error::Error;
use quadrel::stages::Stages;
use quadrel::statistics::Statistics;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Time between two looks whether a process has ended: short at first, then longer.
const PATIENCE: [Duration; 2] = [Duration::from_millis(2), Duration::from_millis(20)];
/// Bytes of a crashed process's last words that are kept.
const LAST_WORDS: usize = 400;

/// A folder for temporary files, removed in the end.
pub struct Scratch(PathBuf);

impl Scratch {
    pub fn new() -> std::io::Result<Self> {
        let folder = std::env::temp_dir().join(format!("quadrel-corpus-{}", std::process::id()));
        fs::create_dir_all(&folder)?;
        Ok(Scratch(folder))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// How processes are started.
pub struct Child<'a> {
    program: PathBuf,
    arguments: Vec<String>,
    limit: Duration,
    output: Option<PathBuf>,
    scratch: &'a Scratch,
    started: AtomicUsize,
}

impl<'a> Child<'a> {
    /// Processes of this very program, with the order and tolerance given.
    pub fn new(corpus: &CorpusArguments, scratch: &'a Scratch) -> Result<Self, String> {
        let program = std::env::current_exe().map_err(|e| format!("this program's own file: {e}"))?;
        let mut arguments = Vec::new();
        if let Some(order) = corpus.order {
            arguments.extend(["--order".into(), order.to_string()]);
        }
        if let Some(relative) = corpus.relative {
            arguments.extend(["--relative".into(), relative.to_string()]);
        }
        let limit = Duration::try_from_secs_f64(corpus.limit_seconds)
            .map_err(|_| format!("--limit-seconds {}: give a number of seconds", corpus.limit_seconds))?;
        let output = corpus.output.clone();
        Ok(Child { program, arguments, limit, output, scratch, started: AtomicUsize::new(0) })
    }

    /// Meshes the domain of `path` and returns its statistics, whatever happens to the process. With
    /// an output folder the mesh goes below it, to the place that the file has below its own.
    pub fn mesh(&self, path: &Path, relative: &Path) -> Value {
        let number = self.started.fetch_add(1, Ordering::Relaxed);
        let statistics = self.scratch.0.join(format!("{number}.json"));
        let words = self.scratch.0.join(format!("{number}.err"));
        let started = Instant::now();
        let ended = self.run(path, relative, &statistics, &words);
        let seconds = started.elapsed().as_secs_f64();
        let written = fs::read_to_string(&statistics).ok().and_then(|t| serde_json::from_str(&t).ok());
        let value = match (ended, written) {
            (Ok(Some(_)), Some(value)) => value,
            (Ok(None), _) => {
                let stage = last_words(&words).rsplit(' ').next().unwrap_or_default().to_string();
                let stage = if stage.is_empty() { "start" } else { &stage };
                failed("timeout", format!("ended after {seconds:.0} s in stage {stage}"), seconds)
            }
            (Ok(Some(status)), None) => {
                let words = last_words(&words);
                let reason = if words.is_empty() { how(status) } else { format!("{}: {words}", how(status)) };
                failed("crash", reason, seconds)
            }
            (Err(error), _) => failed("crash", error.to_string(), seconds),
        };
        let _ = fs::remove_file(statistics).and_then(|()| fs::remove_file(words));
        value
    }

    /// Runs the process to its end, `None` if that took too long.
    fn run(
        &self,
        path: &Path,
        relative: &Path,
        statistics: &Path,
        words: &Path,
    ) -> std::io::Result<Option<ExitStatus>> {
        let mut command = Command::new(&self.program);
        command.arg(path).args(&self.arguments).arg("--log-stages").arg("--stats").arg(statistics);
        if let Some(folder) = &self.output {
            let name = relative.file_name().unwrap_or_default().to_string_lossy().into_owned();
            let place = folder.join(relative);
            if let Some(parent) = place.parent() {
                fs::create_dir_all(parent)?;
            }
            for extension in ["vtu", "svg"] {
                command.arg("-o").arg(place.with_file_name(format!("{name}.{extension}")));
            }
        }
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(fs::File::create(words)?);
        let started = Instant::now();
        let mut process = command.spawn()?;
        // Where memory runs out, Linux is to end this process before any other.
        let _ = fs::write(format!("/proc/{}/oom_score_adj", process.id()), "1000");
        loop {
            if let Some(status) = process.try_wait()? {
                return Ok(Some(status));
            }
            if started.elapsed() > self.limit {
                process.kill()?;
                process.wait()?;
                return Ok(None);
            }
            std::thread::sleep(PATIENCE[usize::from(started.elapsed() > Duration::from_millis(200))]);
        }
    }
}

/// Statistics of a run that left none.
fn failed(status: &str, reason: String, seconds: f64) -> Value {
    let error = Err(Error::Internal { reason: reason.clone() });
    let mut value = Statistics::new(&Stages::default(), &error, seconds).to_json();
    value["status"] = status.into();
    value["message"] = reason.into();
    value
}

fn how(status: ExitStatus) -> String {
    #[cfg(unix)]
    if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
        return format!("ended by signal {signal}");
    }
    format!("{status} without statistics")
}

/// The end of what a process wrote to standard error, on one line.
fn last_words(path: &Path) -> String {
    let bytes = fs::read(path).unwrap_or_default();
    let tail = &bytes[bytes.len().saturating_sub(LAST_WORDS)..];
    String::from_utf8_lossy(tail).split_whitespace().collect::<Vec<_>>().join(" ")
}
