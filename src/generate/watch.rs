//! Times the stages and reports progress.

use crate::error::Result;
use crate::options::Options;
use crate::progress::{Progress, Stage};
use crate::stages::Stages;
use std::time::Instant;

/// Share of the run that is done when a stage begins; an estimate for progress bars.
const BEGINS: [f64; 9] = [0.0, 0.02, 0.06, 0.1, 0.12, 0.16, 0.25, 0.5, 0.97];

pub(super) struct Watch {
    progress: Progress,
    /// Progress never goes back, also when stages run again.
    reached: f64,
    /// Element evaluations spent on smoothing.
    pub work: usize,
}

impl Watch {
    pub fn new(options: &Options) -> Self {
        Watch { progress: options.progress.clone(), reached: 0.0, work: 0 }
    }

    /// Reports `share` of `stage`, in 0..=1.
    pub fn report(&mut self, stage: Stage, share: f64) -> Result<()> {
        let i = stage as usize;
        let end = BEGINS.get(i + 1).copied().unwrap_or(1.0);
        self.reached = self.reached.max(BEGINS[i] + (end - BEGINS[i]) * share.clamp(0.0, 1.0));
        self.progress.report(stage, self.reached)
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
