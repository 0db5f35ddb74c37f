//! Buffer of samples between motion task and link: schedule of the intervals that are read.
//!
//! ```text
//!                 samples of the interval that is read                  ahead of it
//!   in time:      … k−1   k   ───────────────────────────────────────   k+1 … (at most AHEAD)
//!   late by one:  … k     k'  k' predicted from k                        –
//!   late by two:  … k'    k'' both predicted                             –
//! ```
//!
//! Sample k is due at `tick(k) = tick(0) + k·cycle`. The interval that ends `points/2 − 1` samples before it is read from
//! `tick(k) + margin` on, whenever the sample came: the output at t is the motion of `t − delay`, `delay = (points/2)·cycle + margin`.
//! Missing samples after the end of an interval only matter when the interval is over. Then the next one is formed with a predicted sample
//! in place of the late one, twice at most; when the late sample comes, it replaces its prediction, and the next one is predicted anew.
//!
//! # Ahead of the samples
//!
//! With [`Timing::ahead`] samples predicted from the start, the interval that is read ends that many samples later, and the delay is that
//! many cycles shorter. Each sample that comes replaces the oldest prediction, those behind it are predicted anew, and another one is added
//! when the next interval begins. Of the two steps that can be predicted, fewer are left for late samples accordingly.
//!
//! A mode predicts from the values that it uses. Modes that use the velocity continue along the parabola of the last sample, the others
//! along the straight line through the last two.
use core::array::from_fn;
use servobench_base::Stateful;
use servobench_motion::interpolate::{Command, Interval, Mode, Sample};

/// Most samples that can be stored before they are needed.
pub(crate) const AHEAD: usize = 4;
/// Most steps that are predicted.
pub(crate) const PREDICTED: usize = 2;
/// Most samples that a mode uses.
const POINTS: usize = 6;

/// Mode and times, constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Timing {
    pub(crate) mode: Mode,
    /// Cycle of the motion task (base ticks).
    pub(crate) cycle: u64,
    /// Tolerated lateness of a sample without a prediction (base ticks).
    pub(crate) margin: u64,
    /// Number of samples predicted when all come in time, at most [`PREDICTED`] and half of those that the mode uses.
    pub(crate) ahead: usize,
    /// Length of a base tick (s).
    pub(crate) tick: f64,
}

impl Timing {
    /// Cycle of the motion task (s).
    fn period(&self) -> f64 {
        self.cycle as f64 * self.tick
    }

    /// Delay of the motion that is read behind the samples (base ticks).
    pub(crate) const fn delay(&self) -> u64 {
        (self.mode.delay_samples() - self.ahead) as u64 * self.cycle + self.margin
    }

    fn predict(&self, before: Sample, last: Sample) -> Sample {
        let t = self.period();
        match self.mode {
            Mode::Linear | Mode::CubicBSpline | Mode::QuinticBSpline => Sample { x: 2.0 * last.x - before.x, ..last },
            Mode::Cubic | Mode::Quintic | Mode::AllLinear | Mode::AllCubic => {
                Sample { x: last.x + t * (last.v + t / 2.0 * last.a), v: last.v + t * last.a, ..last }
            }
        }
    }
}

/// Effect of a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Taken {
    /// No change of the motion that is read.
    Kept,
    /// A predicted sample is now known.
    Corrected,
    /// The buffer was full: reading restarts with the newest samples.
    Overflow,
}

/// State of the reading.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reading {
    /// Nothing to read yet.
    Waiting,
    /// In the interval of the buffer with this number of predicted samples, 0 to 2.
    Interval(usize),
    /// Past the last predictable sample; the buffer is empty now.
    Underflow,
}

/// Samples, and the interval that is read.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub(crate) struct Buffer {
    /// Samples last shifted in, the newest at the end; predicted ones come last.
    window: [Sample; POINTS],
    predicted: usize,
    /// Samples in the window since the buffer was empty, up to the number that matters.
    received: usize,
    /// Samples behind the window, the oldest first.
    ahead: [Sample; AHEAD],
    waiting: usize,
    /// Due time of the newest sample (base ticks).
    newest: u64,
    /// Begin of the interval (base ticks).
    begins: u64,
    interval: Option<Interval>,
}

impl Buffer {
    pub(crate) const EMPTY: Self = {
        let none = Sample { x: 0.0, v: 0.0, a: 0.0, torque: 0.0 };
        Self {
            window: [none; POINTS],
            predicted: 0,
            received: 0,
            ahead: [none; AHEAD],
            waiting: 0,
            newest: 0,
            begins: 0,
            interval: None,
        }
    };

    /// Takes a sample that was due at `due`, `missed` samples after the last one, at the time `now`.
    ///
    /// A sample on the grid of the cycle is placed by its tick, one off the grid behind those before it. Missing samples in between are
    /// permanently replaced by predictions; if too many are missing, the buffer restarts.
    pub(crate) fn take(&mut self, timing: &Timing, sample: Sample, due: u64, missed: u64, now: u64) -> Taken {
        if self.received == 0 {
            self.newest = due.saturating_sub(timing.cycle);
            return self.put(timing, sample, now);
        }
        let missing = match due.checked_sub(self.newest + timing.cycle) {
            Some(beyond) if beyond.is_multiple_of(timing.cycle) => beyond / timing.cycle,
            _ => missed,
        };
        if missing > PREDICTED as u64 {
            *self = Self::EMPTY;
            self.newest = due.saturating_sub(timing.cycle);
            return self.put(timing, sample, now);
        }
        let mut taken = Taken::Kept;
        for _ in 0..missing {
            let [before, last] = self.last_two();
            taken = taken.max(self.put(timing, timing.predict(before, last), now));
        }
        taken.max(self.put(timing, sample, now))
    }

    fn put(&mut self, timing: &Timing, sample: Sample, now: u64) -> Taken {
        self.newest += timing.cycle;
        let needed = timing.mode.points() - timing.ahead;
        if self.received < needed {
            self.shift_in(sample);
            if self.received == needed {
                self.begins = self.newest + timing.margin;
                self.run_ahead(timing);
                self.build(timing);
            }
            return Taken::Kept;
        }
        if self.predicted > 0 {
            self.correct(timing, sample);
            return Taken::Corrected;
        }
        if let Some(slot) = self.ahead.get_mut(self.waiting) {
            *slot = sample;
            self.waiting += 1;
            return Taken::Kept;
        }
        self.start_again(timing, sample, now);
        Taken::Overflow
    }

    /// Replaces the oldest predicted sample by the received one.
    fn correct(&mut self, timing: &Timing, sample: Sample) {
        let known = POINTS - self.predicted;
        self.window[known] = sample;
        self.predicted -= 1;
        self.received = (self.received + 1).min(POINTS);
        for place in known + 1..POINTS {
            self.window[place] = timing.predict(self.window[place - 2], self.window[place - 1]);
        }
        self.build(timing);
    }

    /// Advances to the interval that is read when all samples come in time.
    fn run_ahead(&mut self, timing: &Timing) {
        for _ in 0..timing.ahead {
            let next = if self.waiting > 0 {
                self.next_waiting()
            } else {
                let [before, last] = if self.received == 1 && self.predicted == 0 {
                    self.last_two()
                } else {
                    let [.., before, last] = self.window;
                    [before, last]
                };
                self.predicted += 1;
                timing.predict(before, last)
            };
            self.shift(next);
        }
    }

    fn next_waiting(&mut self) -> Sample {
        let next = self.ahead[0];
        self.ahead.rotate_left(1);
        self.waiting -= 1;
        next
    }

    /// Restarts the reading: the newest of all stored samples are read from `now` on with the nominal delay.
    fn start_again(&mut self, timing: &Timing, sample: Sample, now: u64) {
        let all: [Sample; POINTS + AHEAD + 1] = from_fn(|i| match i {
            i if i < POINTS => self.window[i],
            i if i < POINTS + AHEAD => self.ahead[i - POINTS],
            _ => sample,
        });
        // No sample comes before it is due: a tick in the future means that its sender counts in shorter cycles than the motion task's.
        self.newest = self.newest.min(now);
        // Samples that are not to be read yet: the margin is two cycles at most.
        let early = (self.newest + timing.margin).saturating_sub(now).div_ceil(timing.cycle);
        let waiting = usize::try_from(early).unwrap_or(AHEAD).min(AHEAD - 1);
        let end = all.len() - waiting;
        self.window.copy_from_slice(&all[end - POINTS..end]);
        self.ahead[..waiting].copy_from_slice(&all[end..]);
        self.waiting = waiting;
        self.begins = (self.newest + timing.margin - waiting as u64 * timing.cycle).min(now);
        self.run_ahead(timing);
        self.build(timing);
    }

    /// Advances to the interval that is read at `now`.
    pub(crate) fn advance(&mut self, timing: &Timing, now: u64) -> Reading {
        if self.interval.is_none() || now < self.begins {
            return Reading::Waiting;
        }
        let mut moved = false;
        while now - self.begins >= timing.cycle {
            if self.waiting > 0 {
                let next = self.next_waiting();
                self.shift_in(next);
            } else if self.predicted < PREDICTED {
                let [.., before, last] = self.window;
                self.shift_in(timing.predict(before, last));
                self.predicted += 1;
            } else {
                *self = Self::EMPTY;
                return Reading::Underflow;
            }
            self.begins += timing.cycle;
            moved = true;
        }
        if moved {
            self.build(timing);
        }
        Reading::Interval(self.predicted)
    }

    /// Motion at `now`, extrapolated by its derivatives when the interval is over; `None` without an interval.
    pub(crate) fn at(&self, timing: &Timing, now: u64) -> Option<Command> {
        let interval = self.interval.as_ref()?;
        let passed = now.checked_sub(self.begins)?;
        if passed <= timing.cycle {
            return interval.at(passed as f64 / timing.cycle as f64).ok();
        }
        let end = interval.at(1.0).ok()?;
        Some(Command { setpoint: end.setpoint.after((passed - timing.cycle) as f64 * timing.tick), ..end })
    }

    fn shift(&mut self, sample: Sample) {
        self.window.rotate_left(1);
        self.window[POINTS - 1] = sample;
    }

    fn shift_in(&mut self, sample: Sample) {
        self.shift(sample);
        self.received = (self.received + 1).min(POINTS);
    }

    /// Last two samples without predicted ones; if there is only one, that one twice.
    fn last_two(&self) -> [Sample; 2] {
        let known = POINTS - self.predicted;
        let last = |back: usize| match self.waiting.checked_sub(back) {
            Some(place) => self.ahead[place],
            None => self.window[known - (back - self.waiting)],
        };
        if self.received == 1 { [last(1); 2] } else { [last(2), last(1)] }
    }

    fn build(&mut self, timing: &Timing) {
        // Samples are checked when they are pushed, and so is the period: an interval is refused for nothing else.
        self.interval = Interval::new(timing.mode, timing.period(), &self.window).ok();
    }
}
