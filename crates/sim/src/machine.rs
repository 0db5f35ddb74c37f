//! An axis and its time, with the tick that advances both.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::axis::Axis;
use crate::run::{Failure, Outcome, Reason};
use servobench_base::{Rate, Tick, wide_registers};
use std::ops::ControlFlow;

/// Ticks, or exchanges, after which log lines of FMUs are fetched. Each line has its own time; fetching costs system calls.
pub(crate) const LOG_EVERY: u64 = 64;

/// An axis and its time.
pub(crate) struct Machine {
    pub(crate) axis: Axis,
    base_rate: Rate,
    /// The next tick.
    tick: u64,
}

impl Machine {
    /// `axis` at tick 0, built for `base_rate`.
    pub(crate) const fn new(axis: Axis, base_rate: Rate) -> Self {
        Self { axis, base_rate, tick: 0 }
    }

    /// One tick, for every caller:
    ///
    /// ```text
    /// tick k:  sample → set-point → control → power stage → record → integrate to k+1
    /// ```
    ///
    /// # Errors
    /// [`Failure`] states why the axis cannot continue.
    #[inline(always)]
    pub(crate) fn tick(&mut self) -> Result<(), Failure> {
        self.observe();
        let time = self.time();
        self.axis.integrate().map_err(|reason| Failure { time, reason })?;
        self.tick += 1;
        if self.tick.is_multiple_of(LOG_EVERY) {
            self.axis.note_log(self.time());
        }
        Ok(())
    }

    /// Tick k without the mechanics: all of the last tick of a run.
    #[inline(always)]
    pub(crate) fn observe(&mut self) {
        self.axis.observe(self.tick, self.time());
    }

    /// Runs `ticks` ticks, the last of which is only observed. `progress` gets the completed share, from 0 to 1, and may stop
    /// the run.
    ///
    /// # Errors
    /// [`Failure`] states why the axis cannot continue, or that the run was stopped.
    pub(crate) fn run(&mut self, ticks: u64, progress: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Result<(), Failure> {
        wide_registers!(self.all_ticks(ticks, progress), Self::all_ticks_in_wide_registers, self, ticks, progress)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn all_ticks_in_wide_registers(
        &mut self,
        ticks: u64,
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<(), Failure> {
        self.all_ticks(ticks, progress)
    }

    #[inline(always)]
    fn all_ticks(&mut self, ticks: u64, progress: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Result<(), Failure> {
        let mut done = Ok(());
        while self.tick + 1 < ticks {
            if self.tick.is_multiple_of(PROGRESS_EVERY) {
                self.check_recording()?;
                if progress(self.tick as f64 / ticks as f64).is_break() {
                    return Err(Failure { time: self.time(), reason: Reason::Stopped });
                }
            }
            if let Err(failure) = self.tick() {
                done = Err(failure);
                break;
            }
        }
        if done.is_ok() {
            self.observe();
        }
        // The run is over and cannot be stopped any more.
        let _: ControlFlow<()> = progress(1.0);
        done
    }

    /// Checks that the recording still works.
    ///
    /// # Errors
    /// [`Reason::Recording`] if it is not.
    pub(crate) fn check_recording(&self) -> Result<(), Failure> {
        self.axis.recorder.failure().map_or(Ok(()), |error| Err(Failure::not_kept(self.time(), error)))
    }

    /// Ticks per second.
    pub(crate) const fn base_rate(&self) -> Rate {
        self.base_rate
    }

    /// The next tick.
    pub(crate) const fn next(&self) -> Tick {
        Tick(self.tick)
    }

    /// Time of the next tick (s).
    pub(crate) fn time(&self) -> f64 {
        self.base_rate.time(self.next())
    }

    /// Sets the next tick after the axis was restored to it.
    pub(crate) const fn go_back(&mut self, Tick(tick): Tick) {
        self.tick = tick;
    }

    /// Ends the run at the current tick. Returns its outcome, up to `failure` if there was one.
    pub(crate) fn finish(self, failure: Option<Failure>) -> Outcome {
        let present = self.time();
        let (recording, missing) = self.axis.finish(present, failure.as_ref().map_or(present, |failure| failure.time));
        let end = recording.time_of(recording.len());
        let failure = failure.or_else(|| Some(Failure::not_kept(end, missing.as_ref()?)));
        Outcome { recording, failure }
    }
}

/// Ticks between progress reports of a run. With an FMU as mechanics a tick may take milliseconds.
const PROGRESS_EVERY: u64 = 1 << 10;

#[cfg(test)]
mod tests {
    use crate::bench::{Bench, Loop};
    use servobench_plant::Exact;
    use std::ops::ControlFlow;

    const AXIS: &str = r#"
[run]
base_rate = "16 kHz"
duration = "0.3 s"
[axis]
model = "two-mass"
[motor]
model = "saarakkala-2.2kw"
[drive]
dc_link = "540 V"
[drive.current]
rate = "8 kHz"
bandwidth = "1 kHz"
[drive.velocity]
rate = "4 kHz"
bandwidth = "50 Hz"
[drive.position]
rate = "1 kHz"
gain = "60 1/s"
[drive.feedforward]
velocity = true
[setpoint]
order = 3
velocity = "100 rad/s"
acceleration = "1500 rad/s2"
jerk = "6e4 rad/s3"
[[program]]
move_to = "7 rad"
"#;

    /// A run on a processor with wide registers and one on any other are equal to the bit, including limits that bind.
    #[test]
    fn both_kinds_of_processors_give_the_same_run() {
        for axis in [AXIS.to_owned(), AXIS.replace("540 V", "90 V"), AXIS.replace("1500 rad", "90000 rad")] {
            let loaded = servobench_scenario::parse("axis.toml", &axis, None).unwrap_or_else(|error| panic!("{error}"));
            let outcome = |any: bool| {
                let bench = Bench::new(&loaded.scenario, &Exact).unwrap();
                let (ticks, Loop::Alone(mut machine)) = (bench.ticks, bench.closed_loop) else { panic!("no FMUs") };
                let mut progress = |_| ControlFlow::Continue(());
                let done =
                    if any { machine.all_ticks(ticks, &mut progress) } else { machine.run(ticks, &mut progress) };
                machine.finish(done.err())
            };
            let (here, in_any) = (outcome(false), outcome(true));
            assert!(here.recording.len() > 4000 && here.failure == in_any.failure);
            for (one, other) in here.recording.channels.iter().zip(&in_any.recording.channels) {
                let is_same = one.values.iter().zip(&other.values).all(|(a, b)| a.to_bits() == b.to_bits());
                assert!(is_same, "{}", one.spec.name);
            }
            assert_eq!(here.recording.events, in_any.recording.events);
        }
    }
}
