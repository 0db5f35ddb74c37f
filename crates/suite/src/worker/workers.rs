//! The workers of a suite: started on demand, and used again.
use super::WorkerError;
use super::message::{End, Message};
use super::order::{Order, Task};
use super::process::Worker;
use crate::error::RunError;
use crate::execute::{Interruption, Recorded};
use crate::job::Job;
use crate::time_limit::TimeLimit;
use servobench::check::Objection;
use servobench_metrics::EarlyEnd;
use servobench_scenario::{AxisMechanics, TimeBound};
use servobench_sim::MechanicsAtRest;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Duration after which a run is slow.
const SLOW: Duration = Duration::from_mins(1);

/// Program of a worker, and the limits of runs in any process.
#[derive(Debug, Clone)]
pub struct WorkerCommand {
    /// The program.
    pub program: PathBuf,
    /// Folder for the recordings on their way from the worker; they have no names there.
    pub folder: PathBuf,
    /// Longest silence of a worker. It reports every thousand ticks or so, but not while the engine reads the model nor while it writes the
    /// recording.
    pub timeout: Duration,
    /// Limits of a run.
    pub limits: RunLimits,
}

/// Limits of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunLimits {
    /// Wall-clock time; a scenario may set less. `None`: that of the scenario, otherwise a default.
    pub time: Option<TimeBound>,
    /// Memory (B): of a recording, and of a worker.
    pub memory: u64,
}

/// Worker processes.
#[derive(Debug)]
pub struct Workers {
    command: WorkerCommand,
    /// Idle workers.
    idle: Mutex<Vec<Worker>>,
}

impl Workers {
    /// Without workers yet.
    #[must_use]
    pub const fn new(command: WorkerCommand) -> Self {
        Self { command, idle: Mutex::new(Vec::new()) }
    }

    /// Without workers and limits: an engine that needs a worker cannot be checked.
    #[must_use]
    pub const fn none() -> Self {
        let limits = RunLimits { time: Some(TimeBound::Unlimited), memory: u64::MAX };
        Self::new(WorkerCommand { program: PathBuf::new(), folder: PathBuf::new(), timeout: Duration::ZERO, limits })
    }

    /// Limits of a run.
    pub(crate) const fn limits(&self) -> RunLimits {
        self.command.limits
    }

    /// Ends the idle workers and returns the processes that they had started and left behind, in words; those were killed too.
    #[must_use]
    pub fn dismiss(&self) -> Vec<String> {
        let idle = std::mem::take(&mut *self.idle.lock().unwrap_or_else(PoisonError::into_inner));
        for worker in &idle {
            worker.dismiss();
        }
        idle.iter().filter_map(Worker::left_behind).collect()
    }

    /// Wall-clock time after which a run of `job` is slow: a minute, or half of its time limit.
    #[must_use]
    pub fn slow(&self, job: &Job) -> Duration {
        let limit = TimeLimit::of(job, self.limits().time);
        limit.map_or(SLOW, |limit| SLOW.min(limit.time / 2))
    }

    /// Runs `job` in a worker process.
    pub(crate) fn run(&self, job: &Job, progress: &mut dyn FnMut(f64)) -> Result<Recorded, RunError> {
        let limit = TimeLimit::of(job, self.limits().time);
        let order =
            Order::new(job, Task::Run { time_limit: limit.map(|limit| limit.time), records_all: job.records_all() });
        let mut done = 0.0;
        let mut recording = None;
        let end = self.converse(&order, limit.map(|limit| limit.time), &mut recording, &mut |message| {
            if let Some(Message::Progress(share)) = message {
                done = share;
            }
            progress(done);
        });
        let exceeded = |reached| limit.map(|limit| limit.exceeded(reached));
        let end = match end {
            Ok(end) => end,
            Err(Broken::Late) => {
                let reached = limit.map_or(0.0, |limit| done * limit.length());
                return Err(exceeded(reached).unwrap_or(WorkerError::Stalled { timeout: self.command.timeout }.into()));
            }
            Err(Broken::Worker(error)) => return Err(error.into()),
        };
        let interruption = match end {
            End::Done => None,
            End::Diverged { time, reason } => Some(Interruption::Early(EarlyEnd::Diverged { time, reason })),
            End::GaveUp(why) => Some(Interruption::Early(EarlyEnd::GaveUp(why))),
            End::Input(why) => return Err(WorkerError::Input(why).into()),
            End::Stopped(reached) => exceeded(reached).map(Interruption::Broken),
            End::Failed(why) => Some(Interruption::Broken(WorkerError::Failed(why).into())),
        };
        match (recording, interruption) {
            (Some(Ok(recording)), interruption) => Ok((recording, interruption)),
            // There is no recording of one that failed before it began.
            (_, Some(Interruption::Broken(error))) => Err(error),
            (Some(Err(error)), _) => Err(WorkerError::Recording(error).into()),
            (None, _) => Err(WorkerError::Recording(std::io::ErrorKind::UnexpectedEof.into()).into()),
        }
    }

    /// Reasons why `job` cannot be built, from a worker process.
    pub(crate) fn ask(&self, job: &Job) -> Result<Vec<Objection>, WorkerError> {
        let mut all = Vec::new();
        self.answer(job, Task::Check, &mut |message| {
            if let Message::Objections(objections) = message {
                all.extend(objections);
            }
        })?;
        Ok(all)
    }

    /// Linear model of the MJCF file of `job`, from a worker process; `None` without a file.
    pub fn linearise(&self, job: &Job) -> Option<MechanicsAtRest> {
        if !matches!(job.scenario.axis.mechanics, AxisMechanics::Mjcf(_)) {
            return None;
        }
        let mut found = None;
        let end = self.answer(job, Task::Linearise, &mut |message| {
            if let Message::AtRest(mechanics) = message {
                found = Some(mechanics);
            }
        });
        let nothing = || Err("it has numbers that are not finite".to_owned());
        Some(end.map_or_else(|error| Err(error.to_string()), |()| found.unwrap_or_else(nothing)))
    }

    /// Gives `task` to a worker process and passes its messages to `hear`.
    fn answer(&self, job: &Job, task: Task, hear: &mut dyn FnMut(Message)) -> Result<(), WorkerError> {
        match self
            .converse(&Order::new(job, task), None, &mut None, &mut |message| message.into_iter().for_each(&mut *hear))
        {
            Ok(End::Input(why)) => Err(WorkerError::Input(why)),
            Ok(End::Failed(why)) => Err(WorkerError::Failed(why)),
            Ok(_) => Ok(()),
            Err(Broken::Worker(error)) => Err(error),
            Err(Broken::Late) => Err(WorkerError::Stalled { timeout: self.command.timeout }),
        }
    }

    /// Has a worker carry out `order`; `on_message` gets all messages but the last, and `None` from time to time. An existing recording, or
    /// the error of reading it, goes to `recording`.
    fn converse(
        &self,
        order: &Order,
        time_limit: Option<Duration>,
        recording: &mut Option<std::io::Result<servobench_trace::Recording>>,
        on_message: &mut dyn FnMut(Option<Message>),
    ) -> Result<End, Broken> {
        let mut worker = self.worker()?;
        let end = match worker.carry_out(order, time_limit, on_message) {
            // It has ended while it was idle.
            Err(Broken::Worker(WorkerError::Process { action: "speak to", .. })) if worker.is_used() => {
                worker = Worker::start(&self.command)?;
                worker.carry_out(order, time_limit, on_message)
            }
            end => end,
        }?;
        if matches!(order.task, Task::Run { .. }) && !matches!(end, End::Input(_)) {
            *recording = Some(worker.take_recording());
        }
        if !matches!(end, End::Failed(_) | End::Stopped(_)) && worker.may_serve_again() {
            self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(worker);
        }
        Ok(end)
    }

    fn worker(&self) -> Result<Worker, WorkerError> {
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        idle.map_or_else(|| Worker::start(&self.command), Ok)
    }
}

/// Reasons why an order came to no end.
#[derive(Debug)]
pub(super) enum Broken {
    /// By the worker.
    Worker(WorkerError),
    /// Its time limit was exceeded, and it was killed.
    Late,
}

impl From<WorkerError> for Broken {
    fn from(error: WorkerError) -> Self {
        Self::Worker(error)
    }
}
