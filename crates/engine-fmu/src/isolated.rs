//! The simulation's side of an isolated FMU.
use crate::error::IsolationError;
use crate::page::{Answered, Asked, Page};
use crate::protocol::{Command, Message, Status, log_of_lines};
use serde::Serialize;
use servobench_fmi::{Bounds, Capabilities, Feedthrough, LogLine, Severity, Slave, SlaveError, StepEnd, Unpacked};
use servobench_isolation::{Contained, Ending, Limits, Listener, Program as HostCommand, Stopwatch, Stream, in_words};
use std::borrow::Cow;
use std::sync::Arc;
use std::sync::atomic::Ordering::Relaxed;
use std::time::Duration;

/// Interval of checks on the process while it works. Its end is normally reported at once; the checks are for one that has overwritten
/// the memory used for that.
const GLANCE: Duration = Duration::from_millis(50);
/// Time for the process to end after it has freed its FMU.
const LEAVE: Duration = Duration::from_secs(1);
const OVERWRITTEN: &str = "it wrote over the memory through which it is spoken to";

/// Number of exchanged values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wires {
    /// Inputs.
    pub inputs: usize,
    /// Outputs.
    pub outputs: usize,
}

/// An FMU isolated in a process: a failure costs only its own run. Dropping this ends the process.
///
/// Standard output and standard error of the process are part of its log, line by line, stamped with the time of the last step before
/// they were read. The time of writing and the severity are unknown.
#[derive(Debug)]
pub struct Isolated {
    process: Contained,
    page: Arc<Page>,
    capabilities: Capabilities,
    call_timeout: Duration,
    listener: Listener,
    /// Number of the last command, from 1.
    number: u32,
    /// Time of the last request (s).
    time: f64,
    /// Time that the last step reached (s).
    reached: f64,
    /// True if the outputs have been read since the last step.
    fresh: bool,
    /// Error after which it cannot continue.
    failed: Option<SlaveError>,
    is_initialising: bool,
    has_ended: bool,
    /// Problems at its end, until they are logged.
    warnings: Vec<String>,
    known: Option<Known>,
}

/// Facts known without the process.
#[derive(Debug)]
pub(crate) struct Known {
    pub(crate) feedthrough: Feedthrough,
    /// True if it waits in its initialisation.
    pub(crate) waits: bool,
    /// Its unpacked files, which must outlive it.
    pub(crate) _unpacked: Unpacked,
}

impl Isolated {
    /// Starts the process, which loads and initialises the FMU of `setup`; see [`serve`](crate::serve).
    ///
    /// # Errors
    /// [`IsolationError`]
    pub fn start<S: Serialize>(
        command: &HostCommand,
        setup: &S,
        wires: Wires,
        bounds: Bounds,
    ) -> Result<Self, IsolationError> {
        Self::start_known(command, setup, wires, bounds, None)
    }

    /// The same for an FMU with known facts.
    pub(crate) fn start_known<S: Serialize>(
        command: &HostCommand,
        setup: &S,
        wires: Wires,
        bounds: Bounds,
        known: Option<Known>,
    ) -> Result<Self, IsolationError> {
        let system = |action| move |source| IsolationError::System { action, source };
        let setup = serde_json::to_vec(setup).map_err(IsolationError::Setup)?;
        let (page, file) =
            Page::new(wires.inputs, wires.outputs, &setup).map_err(system("make memory that two processes share"))?;
        let page = Arc::new(page);
        let for_its_end = Arc::clone(&page);
        let limits = Limits { memory: bounds.memory, is_foreign: true };
        // Wakes whoever waits for an answer.
        let process =
            Contained::start(command, file.into(), None, limits, move || for_its_end.header().answer.give_up())
                .map_err(|source| IsolationError::Start { program: command.program.clone(), source })?;
        let mut isolated = Self {
            process,
            page,
            capabilities: Capabilities::default(),
            call_timeout: bounds.call_timeout,
            listener: Listener::default(),
            number: 0,
            time: 0.0,
            reached: 0.0,
            fresh: false,
            failed: None,
            is_initialising: known.as_ref().is_some_and(|known| known.waits),
            has_ended: false,
            warnings: Vec::new(),
            known,
        };
        match isolated.ask(Command::Load)? {
            Status::Message => {}
            _ => return Err(isolated.overwritten().into()),
        }
        match isolated.message()? {
            Message::Ready(capabilities) => {
                isolated.capabilities = capabilities;
                Ok(isolated)
            }
            Message::Refused(why) => Err(IsolationError::Refused(why)),
            Message::Failed(failure) => Err(failure.into()),
        }
    }

    fn page(&self) -> &Page {
        &self.page
    }

    fn asked(&self) -> &Asked {
        &self.page().header().asked
    }

    fn answered(&self) -> &Answered {
        &self.page().header().answered
    }

    /// Sends a command and waits for the answer.
    fn ask(&mut self, command: Command) -> Result<Status, SlaveError> {
        if let Some(error) = &self.failed {
            return Err(error.clone());
        }
        self.fresh = false;
        // The highest bit marks a doorbell that has given up.
        self.number = (self.number + 1) & (u32::MAX >> 1);
        let header = self.page.header();
        header.asked.command.store(command as u32, Relaxed);
        header.order.ring(self.number);
        let (process, call_timeout, mut watch) = (&self.process, self.call_timeout, None);
        // Time in which the simulation itself is suspended does not count.
        let heard = self.listener.wait(&header.answer, self.number, GLANCE, || {
            process.ending().is_none() && watch.get_or_insert_with(Stopwatch::start).elapsed() < call_timeout
        });
        if process.ending().is_some() || !heard {
            return Err(self.lost(command));
        }
        let status = Status::of(header.answered.status.load(Relaxed)).filter(|_| self.page.intact());
        status.ok_or_else(|| self.overwritten())
    }

    /// The reason why it does not answer.
    fn lost(&mut self, command: Command) -> SlaveError {
        let ended_by_itself = self.process.ending().is_some();
        let (time, call_timeout) = (self.time, self.call_timeout.as_secs_f64());
        // The function of an ordinary step need not be named.
        let call = self.answered().call();
        let call: Cow<'static, str> =
            if command == Command::Step && call.ends_with("DoStep") { "".into() } else { call.into() };
        let intact = self.page().intact();
        let error = match self.process.end() {
            Some(ending) if !intact => {
                let how = format!("{OVERWRITTEN}: {}", ending.how());
                SlaveError::Crashed { call: "".into(), time, how }
            }
            Some(ending) if ended_by_itself => SlaveError::Crashed { call, time, how: ending.how() },
            Some(ending) if ending.of_memory() => SlaveError::Crashed {
                call,
                time,
                how: Ending { status: None, ..ending.clone() }.how()
                    + &format!("; it did not come back within {call_timeout} s and was ended"),
            },
            _ if call.is_empty() => SlaveError::Hung { call: command.words().into(), time, call_timeout },
            _ => SlaveError::Hung { call, time, call_timeout },
        };
        self.fail(error)
    }

    /// The answer is invalid.
    fn overwritten(&mut self) -> SlaveError {
        self.process.end();
        self.fail(SlaveError::Crashed { call: "".into(), time: self.time, how: OVERWRITTEN.into() })
    }

    /// Records that it cannot continue.
    fn fail(&mut self, error: SlaveError) -> SlaveError {
        self.failed = Some(error.clone());
        error
    }

    fn message(&mut self) -> Result<Message, SlaveError> {
        serde_json::from_slice(&self.page().message()).map_err(|_| self.overwritten())
    }

    /// The error of an answer other than success.
    fn failure(&mut self, status: Status) -> SlaveError {
        let failure = match (status, self.message()) {
            (Status::Message, Ok(Message::Failed(failure))) => failure,
            (_, Err(error)) => return error,
            _ => return self.overwritten(),
        };
        match failure {
            // It is where it was before, and can continue.
            SlaveError::Discarded { .. } => failure,
            _ => self.fail(failure),
        }
    }

    /// Sends a command that either succeeds or fails.
    fn order(&mut self, command: Command) -> Result<(), SlaveError> {
        match self.ask(command)? {
            Status::Done => Ok(()),
            other => Err(self.failure(other)),
        }
    }
}

impl Slave for Isolated {
    fn capabilities(&self) -> Capabilities {
        self.capabilities
    }

    fn feeds_through(&self, output: usize, input: usize) -> bool {
        self.known.as_ref().is_none_or(|known| known.feedthrough.between(output, input))
    }

    fn is_discrete(&self, output: usize) -> bool {
        self.known.as_ref().is_some_and(|known| known.feedthrough.is_discrete(output))
    }

    fn is_initialising(&self) -> bool {
        self.is_initialising
    }

    fn follows_at_start(&self, output: usize, input: usize) -> bool {
        self.known.as_ref().is_none_or(|known| known.feedthrough.at_start(output, input))
    }

    fn start(&mut self, inputs: Option<&[f64]>) -> Result<(), SlaveError> {
        self.is_initialising = false;
        let Some(inputs) = inputs else { return self.order(Command::Start) };
        self.write_present(inputs);
        self.order(Command::StartWith)
    }

    fn end(&mut self) {
        // One that cannot continue is ended silently: its error has been reported.
        if self.failed.is_none() && !std::mem::replace(&mut self.has_ended, true) {
            // A sum of times, reported without its rounding.
            self.time = (self.reached * 1e12).round() / 1e12;
            let late = self.leave().err();
            self.warnings.extend(late.map(|error| error.to_string()));
            self.warnings.extend(self.process.ending().and_then(Ending::left_in_words));
        }
    }

    fn step(&mut self, time: f64, length: f64, inputs: &[[f64; 3]]) -> Result<StepEnd, SlaveError> {
        let words = self.page().inputs();
        assert_eq!(3 * inputs.len(), words.len(), "inputs are those that the FMU was wired with");
        words.iter().zip(inputs.as_flattened()).for_each(|(word, value)| word.store(value.to_bits(), Relaxed));
        self.asked().time.store(time.to_bits(), Relaxed);
        self.asked().length.store(length.to_bits(), Relaxed);
        self.time = time;
        let status = self.ask(Command::Step)?;
        self.fresh = self.answered().fresh.load(Relaxed) != 0;
        let reached = f64::from_bits(self.answered().reached.load(Relaxed));
        // A time from a failed step is not its present one.
        if status != Status::Message && reached.is_finite() {
            self.reached = reached;
        }
        match status {
            Status::Done => Ok(StepEnd::Done),
            Status::Until => Ok(StepEnd::Until(reached)),
            Status::Terminated => Ok(StepEnd::Terminated(reached)),
            Status::Message => Err(self.failure(status)),
        }
    }

    fn read(&mut self, inputs: Option<&[f64]>, outputs: &mut [f64]) -> Result<(), SlaveError> {
        assert_eq!(outputs.len(), self.page().outputs().len(), "outputs are those that the FMU was wired with");
        if let Some(inputs) = inputs {
            self.write_present(inputs);
            self.order(Command::ReadFor)?;
        } else if !self.fresh {
            self.order(Command::Read)?;
        }
        let words = self.page().outputs().iter();
        outputs.iter_mut().zip(words).for_each(|(value, word)| *value = f64::from_bits(word.load(Relaxed)));
        Ok(())
    }

    fn save(&mut self) -> Result<(), SlaveError> {
        self.order(Command::Save)
    }

    fn restore(&mut self) -> Result<(), SlaveError> {
        self.order(Command::Restore)
    }

    fn take_log(&mut self) -> Vec<LogLine> {
        let mut log: Vec<LogLine> =
            if self.page().has_log() { log_of_lines(&self.page().take_log()).collect() } else { Vec::new() };
        let dropped = self.answered().log_dropped.swap(0, Relaxed);
        if dropped > 0 {
            let message = format!("{dropped} more lines of its log were dropped: it says more than is read");
            let time = self.time;
            log.push(LogLine { time, severity: Severity::Warning, category: "isolation".into(), message });
        }
        let mut output = self.process.output();
        let stdout = output.stdout.as_mut().and_then(Stream::take);
        let written = [("standard output", stdout), ("standard error", output.stderr.take())];
        for (category, (text, dropped)) in written.into_iter().filter_map(|(name, some)| Some((name, some?))) {
            let line = |severity, message| LogLine { time: self.time, severity, category: category.into(), message };
            if dropped > 0 {
                log.push(line(Severity::Warning, format!("({} before this were dropped)", in_words(dropped))));
            }
            let lines = text.lines().filter(|text| !text.trim().is_empty());
            log.extend(lines.map(|text| line(Severity::Info, text.trim_end().to_owned())));
        }
        drop(output);
        let time = self.time;
        log.extend(self.warnings.drain(..).map(|what| LogLine {
            time,
            severity: Severity::Warning,
            category: String::new(),
            message: format!("its results are complete, but {what}"),
        }));
        log
    }
}

impl Isolated {
    /// Writes the present inputs.
    fn write_present(&self, inputs: &[f64]) {
        let words = self.page().inputs();
        assert_eq!(3 * inputs.len(), words.len(), "inputs are those that the FMU was wired with");
        words.iter().step_by(3).zip(inputs).for_each(|(word, value)| word.store(value.to_bits(), Relaxed));
    }

    /// Frees the FMU and ends the process.
    fn leave(&mut self) -> Result<(), SlaveError> {
        if let Err(error) = self.order(Command::End) {
            // It answers and ends: a slow listener finds it gone.
            return if self.has_left() { Ok(()) } else { Err(error) };
        }
        // If it is still running then, it is killed later.
        self.process.wait_for_end(LEAVE.min(self.call_timeout));
        Ok(())
    }
}

impl Isolated {
    /// True if it has ended as requested, after it had answered.
    fn has_left(&self) -> bool {
        let header = self.page().header();
        header.answer.has_rung(self.number)
            && Status::of(header.answered.status.load(Relaxed)) == Some(Status::Done)
            && self.process.ending().is_some_and(Ending::is_orderly)
    }
}

impl Drop for Isolated {
    fn drop(&mut self) {
        // A process that cannot continue or does not end on request is killed: its results are complete.
        if !self.has_ended && self.process.ending().is_none() {
            self.leave().ok();
        }
    }
}
