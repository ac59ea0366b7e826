//! Times the stages and reports progress.

use crate::error::Result;
use crate::options::Options;
use crate::progress::{Progress, Stage};
use crate::stages::Stages;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

/// Share of the run that is done when a stage begins; an estimate for progress bars.
const BEGINS: [f64; 9] = [0.0, 0.02, 0.06, 0.1, 0.12, 0.16, 0.25, 0.4, 0.97];

/// The same of the coarsening, from its beginning to its end.
const COARSENING: [f64; 2] = [0.6, 0.95];

/// Raises `reached` to `share`, if that is more, and returns it.
fn raise(reached: &Mutex<f64>, share: f64) -> f64 {
    let mut reached = reached.lock().unwrap_or_else(PoisonError::into_inner);
    *reached = reached.max(share);
    *reached
}

pub(super) struct Watch {
    progress: Progress,
    /// Progress never goes back, also when stages run again.
    reached: Arc<Mutex<f64>>,
    /// Element evaluations spent on smoothing.
    pub work: u64,
}

impl Watch {
    pub fn new(options: &Options) -> Self {
        Watch { progress: options.progress.clone(), reached: Arc::default(), work: 0 }
    }

    /// For the mesh of a part of the domain: the same progress, work of its own.
    pub fn of_part(&self) -> Self {
        Watch { progress: self.progress.clone(), reached: Arc::clone(&self.reached), work: 0 }
    }

    /// Reports `share` of `stage`, in 0..=1.
    pub fn report(&self, stage: Stage, share: f64) -> Result<()> {
        let begin = BEGINS[stage as usize];
        let end = match stage {
            Stage::Smooth => COARSENING[0],
            _ => BEGINS.get(stage as usize + 1).copied().unwrap_or(1.0),
        };
        self.progress.report(stage, raise(&self.reached, begin + (end - begin) * share.clamp(0.0, 1.0)))
    }

    /// For coarsening: takes its own shares in 0..=1, and reports them as shares of the run.
    pub fn coarsening(&self) -> Progress {
        let (progress, reached) = (self.progress.clone(), Arc::clone(&self.reached));
        let [begin, end] = COARSENING;
        Progress::new(move |stage, share| {
            progress.report(stage, raise(&reached, begin + (end - begin) * share.clamp(0.0, 1.0))).is_ok()
        })
    }

    /// Runs a stage under the clock.
    pub fn run<T>(
        &mut self,
        stages: &mut Stages,
        stage: Stage,
        work: impl FnOnce(&mut Stages) -> Result<T>,
    ) -> Result<T> {
        self.report(stage, 0.0)?;
        let start = Instant::now();
        let result = work(stages);
        stages.seconds[stage as usize] += start.elapsed().as_secs_f64();
        if result.is_ok() {
            stages.reached = Some(stage);
            self.report(stage, 1.0)?;
        }
        result
    }
}
