//! The newest interval that the samples pushed so far allow.
use super::interval::checked_period;
use super::{Command, Interval, Mode, Sample};
use crate::PlanError;
use servobench_base::Stateful;

/// Takes slow samples and returns commands within the newest complete interval; its size is fixed.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Interpolator {
    #[state(constant)]
    mode: Mode,
    #[state(constant)]
    period: f64,
    /// The last six samples, the newest at the end.
    window: [Sample; 6],
    received: u64,
    interval: Option<Interval>,
}

impl Interpolator {
    /// No sample yet; the slow task ticks every `period` (s).
    ///
    /// # Errors
    /// [`PlanError`] when the period is not between 1e-30 and 1e30 s.
    pub fn new(mode: Mode, period: f64) -> Result<Self, PlanError> {
        let period = checked_period(period)?;
        Ok(Self { mode, period, window: [Sample::default(); 6], received: 0, interval: None })
    }

    /// Takes the next slow sample and advances by one interval.
    ///
    /// # Errors
    /// [`PlanError::Sample`] with the number of the sample, from 0, when a value is not finite or above 1e30 in magnitude.
    /// Nothing changes then: the present interval stays.
    pub fn push(&mut self, sample: Sample) -> Result<(), PlanError> {
        let sample = sample.checked(self.received)?;
        self.window.rotate_left(1);
        self.window[5] = sample;
        self.received += 1;
        if self.received >= self.mode.points() as u64 {
            self.interval = Some(Interval::of_window(self.mode, self.period, &self.window));
        }
        Ok(())
    }

    /// Forgets all samples: the next one is the first again.
    pub fn restart(&mut self) {
        self.received = 0;
        self.interval = None;
    }

    /// The command at `fraction` of a slow period, 0 to 1, after the newest sample: the set-point
    /// [`Mode::delay_samples`] periods earlier.
    ///
    /// # Errors
    /// [`PlanError::Waiting`] until [`Mode::points`] samples are there; [`PlanError::Parameter`] for a fraction that is
    /// not between 0 and 1.
    pub fn at(&self, fraction: f64) -> Result<Command, PlanError> {
        match &self.interval {
            Some(interval) => interval.at(fraction),
            None => Err(PlanError::Waiting {
                // Below the six points of the largest mode.
                received: usize::try_from(self.received).unwrap_or(usize::MAX),
                needed: self.mode.points(),
            }),
        }
    }

    /// The newest complete interval; `None` while there are too few samples.
    #[must_use]
    pub const fn interval(&self) -> Option<&Interval> {
        self.interval.as_ref()
    }

    /// Mode of interpolation between the samples.
    #[must_use]
    pub const fn mode(&self) -> Mode {
        self.mode
    }

    /// Time between two slow samples (s).
    #[must_use]
    pub const fn period(&self) -> f64 {
        self.period
    }

    /// Number of samples since the start or the last restart.
    #[must_use]
    pub const fn received(&self) -> u64 {
        self.received
    }
}
