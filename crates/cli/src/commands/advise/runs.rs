//! The runs of an advice: a scenario with a set-point on a machine.
use super::AdviseMistake;
use crate::args::AdviseArgs;
use crate::console::say;
use crate::engines;
use crate::error::{CliError, FailedRun};
use crate::sources;
use crate::workers;
use servobench::usage::{Usage, load_mode};
use servobench::{Engines, instability};
use servobench_advise::{Bench, Question, Reading, SetPoint};
use servobench_base::{Coordinate, Shortest};
use servobench_metrics::{Limit, Name};
use servobench_plant::EngineName;
use servobench_scenario::{Document, Override};
use servobench_sim::Program;
use servobench_suite::{AtATime, Job, RunError, Source, Workers, execute, map_in_parallel};
use servobench_sweep::Value;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Start and factor of the Fowler–Noll–Vo hash that gives each machine its seed.
const FNV: (u64, u64) = (0xcbf2_9ce4_8422_2325, 0x0100_0000_01b3);
/// Time between progress messages.
const PERIOD: Duration = Duration::from_secs(10);

/// Makes the runs of an advice.
pub(super) struct Runs<'a> {
    args: &'a AdviseArgs,
    base: &'a Source,
    document: &'a Document,
    limits: &'a [Limit],
    question: &'a Question,
    engine: EngineName,
    engines: Engines,
    workers: Workers,
    at_a_time: AtATime,
    wanted: Vec<Name>,
    /// Stiffness of the spring whose tolerance was assumed (N/m or N·m/rad).
    spring: Option<f64>,
    made: usize,
    told: Instant,
    /// Number of runs that could not be carried out, and the first error.
    broken: Mutex<Option<(usize, RunError)>>,
}

impl<'a> Runs<'a> {
    pub(super) fn new(
        args: &'a AdviseArgs,
        base: &'a Source,
        document: &'a Document,
        limits: &'a [Limit],
        question: &'a Question,
    ) -> Result<Self, CliError> {
        let allowed = workers::limits(None, args.memory.memory_limit);
        let engine = args.engine.or_else(|| base.scenario.engines.first().copied()).unwrap_or_default();
        Ok(Self {
            args,
            base,
            document,
            limits,
            question,
            engine,
            engines: engines::installed(),
            workers: workers::of(&std::env::temp_dir(), args.worker_timeout, allowed)?,
            at_a_time: workers::at_a_time(args.jobs, allowed),
            wanted: vec![Name::MoveTime, Name::MoveAndSettlingTime],
            spring: load_mode(&base.scenario).filter(|_| args.within.is_empty()).map(|mode| mode.link.stiffness),
            made: 0,
            told: Instant::now(),
            broken: Mutex::default(),
        })
    }

    pub(super) const fn engine(&self) -> EngineName {
        self.engine
    }

    /// Ends worker processes and reports runs that could not be carried out.
    pub(super) fn finish(&self) {
        workers::dismiss(&self.workers);
        if let Some((count, first)) = &*self.broken.lock().unwrap_or_else(PoisonError::into_inner) {
            say(&format!(
                "{count} of {} runs could not be carried out and do not count; the first: {first}\n",
                self.made
            ));
        }
    }

    /// Overrides, as on the command line, for a run of `point` on the machine of the scenario.
    pub(super) fn settings(&self, point: &SetPoint) -> Vec<String> {
        self.args.with.overrides.iter().map(ToString::to_string).chain(self.set_point(point)).collect()
    }

    /// Refuses tolerances whose corners are invalid scenarios, loops that are all unstable, and a scenario that cannot run on its engine.
    pub(super) fn check(&self) -> Result<(), CliError> {
        let Question { ceiling, distance, .. } = self.question;
        let mut unstable = Vec::new();
        for (index, family) in self.question.families.iter().enumerate() {
            let slow = [distance / ceiling.velocity, ceiling.velocity / ceiling.acceleration, 0.1, 0.1];
            let point = SetPoint::by_boxes(index, family.order, *distance, slow);
            // Only a choice changes the loop, not an order or a shaper.
            let is_new = index == 0 || !self.args.choose.is_empty();
            let mut why_not = None;
            for machine in self.question.machines.corners() {
                let source = self.source(&point, &machine).map_err(|why| AdviseMistake::Machine {
                    settings: [self.set_point(&point), self.machine(&machine)].concat().join(", "),
                    why: why.join("\n"),
                })?;
                if is_new && why_not.is_none() {
                    let job = self.job(source);
                    let model = self.workers.linearise(&job);
                    why_not = instability(&job.scenario, model.as_ref()).map(|why| (self.loop_of(&machine), why));
                }
            }
            if is_new {
                unstable.push(why_not);
            }
        }
        // A choice of gains among which one is stable can be advised.
        if unstable.iter().all(Option::is_some)
            && let Some(Some((settings, why))) = unstable.into_iter().next()
        {
            return Err(AdviseMistake::Unstable { settings, why }.into());
        }
        let job = self.job(self.base.clone());
        match execute(&job, &self.engines, &self.workers, &mut |_| {}) {
            Ok(_) => Ok(()),
            Err(broken) => Err(CliError::Runs(vec![FailedRun::new(&job, broken.error)])),
        }
    }

    /// A machine's settings in words, for messages about its loop.
    fn loop_of(&self, machine: &[f64]) -> String {
        let settings = self.machine(machine).into_iter().filter(|one| !one.starts_with("measure."));
        settings.collect::<Vec<_>>().join(", ")
    }

    fn job(&self, source: Source) -> Job {
        let mut job = Job::new("advise".into(), source, self.engine);
        job.leave_recording_out();
        job.measure_only(&self.wanted);
        job
    }

    /// A set-point as on the command line.
    fn set_point(&self, point: &SetPoint) -> Vec<String> {
        let family = &self.question.families[point.family];
        let unit = if self.base.scenario.axis.motion == Coordinate::Linear { "m" } else { "rad" };
        let mut settings = vec![format!("setpoint.order={}", family.order)];
        let names = ["velocity", "acceleration", "jerk", "snap"];
        for ((name, limit), power) in names.iter().zip(point.limits).zip(1_u32..) {
            if power <= family.order && limit.is_finite() {
                let power = if power > 1 { power.to_string() } else { String::new() };
                settings.push(format!("setpoint.{name}={} {unit}/s{power}", Shortest(limit)));
            }
        }
        settings.extend(family.settings.iter().cloned());
        settings
    }

    /// A machine as on the command line, with the measured mode moved to that of the machine.
    fn machine(&self, machine: &[f64]) -> Vec<String> {
        let mut settings = Vec::new();
        for (range, value) in self.question.machines.ranges().iter().zip(machine) {
            let written = Value::Number(*value, range.unit.clone()).written();
            settings.push(format!("{}={written}", range.key));
            if range.key.ends_with(".frequency") && self.base.scenario.measure.mode.is_some() {
                settings.push(format!("measure.mode={written}"));
            }
            // The default stiffness range is relative to the scenario's, and moves its mode by the root.
            if let (Some(mode), Some(own)) = (self.base.scenario.measure.mode, &self.spring)
                && range.key.ends_with(".stiffness")
            {
                settings.push(format!("measure.mode={} Hz", Shortest(mode * (value / own).sqrt())));
            }
        }
        settings
    }

    /// Overrides with a separate seed for each machine, so that promises about draws hold for any noise.
    fn noise(&self, machine: &[f64]) -> Vec<String> {
        let mixed = machine.iter().fold(FNV.0, |hash, value| (hash ^ value.to_bits()).wrapping_mul(FNV.1));
        let seed = (mixed >> 32) as u32;
        self.base.scenario.seeds().iter().map(|one| format!("{}={seed}", one.key)).collect()
    }

    fn source(&self, point: &SetPoint, machine: &[f64]) -> Result<Source, Vec<String>> {
        let noise = self.noise(machine);
        let key = |written: &str| written.split('=').next().unwrap_or_default().replace('[', ".").replace(']', "");
        let is_seeded = |one: &Override| noise.iter().any(|other| key(other) == key(&one.to_string()));
        let mut overrides: Vec<Override> =
            self.args.with.overrides.iter().filter(|one| !is_seeded(one)).cloned().collect();
        for written in self.set_point(point).into_iter().chain(self.machine(machine)).chain(noise) {
            overrides.push(written.parse::<Override>().map_err(|error| vec![format!("`{written}`: {error}")])?);
        }
        sources::varied(self.document, &overrides).map_err(|error| sources::reasons(&error))
    }

    fn reading(&self, point: &SetPoint, machine: &[f64]) -> Option<Usage> {
        let source = self.source(point, machine).ok()?;
        let has_window = source.scenario.measure.window.is_some();
        match execute(&self.job(source), &self.engines, &self.workers, &mut |_| {}) {
            Ok(run) => Some(run.usage(self.limits, has_window)),
            Err(error) => {
                let mut broken = self.broken.lock().unwrap_or_else(PoisonError::into_inner);
                broken.get_or_insert((0, error.error)).0 += 1;
                None
            }
        }
    }

    fn tell(&mut self, more: usize) {
        self.made += more;
        if self.told.elapsed() >= PERIOD {
            self.told = Instant::now();
            say(&format!("{} runs made\n", self.made));
        }
    }
}

impl Bench for Runs<'_> {
    fn durations(&mut self, points: &[SetPoint]) -> Vec<Option<f64>> {
        let middle = self.question.machines.middle();
        let duration = |point: &SetPoint| {
            let source = self.source(point, &middle).ok()?;
            let program = Program::new(&source.scenario).ok()?;
            program.durations().reduce(f64::max)
        };
        let planned = map_in_parallel(points, self.at_a_time, |_| ((), 0), |point, ()| duration(point));
        planned.into_iter().map(|one| one.ok().flatten()).collect()
    }

    fn run(&mut self, runs: &[(SetPoint, &[f64])]) -> Vec<Reading> {
        let made =
            map_in_parallel(runs, self.at_a_time, |_| ((), 0), |(point, machine), ()| self.reading(point, machine));
        self.tell(runs.len());
        let nothing = || Usage { time: f64::NAN, shares: vec![f64::NAN; self.limits.len()], is_sound: false };
        let readings = made.into_iter().map(|one| one.ok().flatten().unwrap_or_else(nothing));
        readings.map(|Usage { time, shares, is_sound }| Reading { time, usage: shares, is_sound }).collect()
    }
}
