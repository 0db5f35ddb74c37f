//! The FMU's side: a process that loads one FMU and carries out commands.
use crate::error::HostError;
use crate::page::Page;
use crate::protocol::{Command, Message, Status, log_to_line};
use serde::de::DeserializeOwned;
use servobench_fmi::{LogLine, Slave, SlaveError, StepEnd};
use servobench_isolation::{ContainError, Listener, MemoryFile, contain, leave_at_once};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::time::Duration;

/// Time that an idle host sleeps at once. It ends with its keeper.
const GLANCE: Duration = Duration::from_secs(1);
/// Bytes of a text that are passed on.
const LONGEST: usize = 8_000;

/// The shared memory of this process, for messages sent without a command.
static PAGE: OnceLock<&'static Page> = OnceLock::new();
/// Lock for writing to the log.
static SPEAKING: Mutex<()> = Mutex::new(());

/// Records the FMU's function in progress in shared memory.
pub(crate) fn note_call(name: &'static str) {
    if let Some(page) = PAGE.get() {
        page.header().answered.note_call(name);
    }
}

/// Writes a log line to shared memory at once, whatever happens next; `false` if this process is not a host.
pub(crate) fn say_at_once(line: &LogLine) -> bool {
    let _speaking = SPEAKING.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(page) = PAGE.get() else { return false };
    let &LogLine { time, severity, ref category, ref message } = line;
    let line = LogLine { time, severity, category: clipped(category.clone()), message: clipped(message.clone()) };
    if !log_to_line(&line).is_some_and(|line| page.add_log(&line)) {
        page.header().answered.log_dropped.fetch_add(1, Relaxed);
    }
    true
}

/// Makes this process the host of one FMU: `load` makes the FMU from the setup given to [`Isolated::start`](crate::Isolated::start). The
/// process exits here, with code 0, when it is no longer needed: destructors of the FMU's library, which is third-party code, do not run.
///
/// Must be called before anything else: it splits this process in two, see [`contain`]. Standard input is the memory that both share, and
/// is empty for the FMU.
///
/// # Errors
/// [`HostError`] if this process was not started as a host. All other errors are reported to the simulation.
pub fn serve<S: DeserializeOwned>(load: impl FnOnce(S) -> Result<Box<dyn Slave>, String>) -> Result<(), HostError> {
    contain().map_err(|error| match error {
        ContainError::NotStarted => HostError::NoPage,
        ContainError::System { action, source } => HostError::System { action, source },
    })?;
    let page = page()?;
    let mut host = Host { page, listener: Listener::default(), number: 0 };
    if host.next() != Some(Command::Load) {
        return Ok(());
    }
    let setup = serde_json::from_slice(&page.setup()).map_err(|error| error.to_string());
    match setup.and_then(load) {
        Ok(mut slave) => {
            host.say(&Message::Ready(slave.capabilities()));
            pass_on(&slave.take_log());
            host.answer(Status::Message);
            host.serve(slave);
        }
        Err(why) => {
            host.say(&Message::Refused(clipped(why)));
            host.answer(Status::Message);
            // Until the parent has read it.
            host.next();
            host.answer(Status::Done);
        }
    }
    leave_at_once()
}

/// The shared memory; standard input is replaced by an empty one.
fn page() -> Result<&'static Page, HostError> {
    let cannot = |action| move |source| HostError::System { action, source };
    let file = MemoryFile::of_standard_input().map_err(cannot("take standard input"))?;
    let page = Page::adopt(&file).map_err(cannot("map standard input"))?.ok_or(HostError::NoPage)?;
    Ok(PAGE.get_or_init(|| Box::leak(Box::new(page))))
}

struct Host {
    page: &'static Page,
    listener: Listener,
    /// Number of the last command.
    number: u32,
}

impl Host {
    /// The next command; `None` if no more will come.
    fn next(&mut self) -> Option<Command> {
        self.number = (self.number + 1) & (u32::MAX >> 1);
        let header = self.page.header();
        let heard = self.listener.wait(&header.order, self.number, GLANCE, || true);
        heard.then(|| Command::of(header.asked.command.load(Relaxed))).flatten()
    }

    fn answer(&self, status: Status) {
        self.page.header().answered.status.store(status as u32, Relaxed);
        self.page.header().answer.ring(self.number);
    }

    fn say(&self, message: &Message) {
        // A message that cannot be serialised arrives empty, which is an error there.
        self.page.set_message(&serde_json::to_vec(message).unwrap_or_default());
    }

    /// Carries out commands until the end.
    fn serve(&mut self, mut slave: Box<dyn Slave>) {
        let mut work = Work {
            page: self.page,
            inputs: vec![[0.0; 3]; self.page.inputs().len() / 3],
            values: vec![0.0; self.page.inputs().len() / 3],
            outputs: vec![0.0; self.page.outputs().len()],
            failed: None,
        };
        while let Some(command) = self.next() {
            if command == Command::End {
                slave.end();
                pass_on(&slave.take_log());
                drop(slave);
                self.answer(Status::Done);
                return;
            }
            let status = work.of(command, slave.as_mut()).unwrap_or_else(|error| {
                self.say(&Message::Failed(without_flood(error)));
                Status::Message
            });
            pass_on(&slave.take_log());
            self.answer(status);
        }
    }
}

/// Buffers for the exchanged numbers.
struct Work {
    page: &'static Page,
    inputs: Vec<[f64; 3]>,
    values: Vec<f64>,
    outputs: Vec<f64>,
    /// Error in reading the outputs after the last step, until they are read.
    failed: Option<SlaveError>,
}

impl Work {
    fn of(&mut self, command: Command, slave: &mut dyn Slave) -> Result<Status, SlaveError> {
        match (command, self.failed.take()) {
            (Command::Step, _) => return self.step(slave),
            (Command::Read, Some(error)) => return Err(error),
            (Command::Read, None) => self.read(slave)?,
            (Command::ReadFor, _) => self.read_for(slave)?,
            (Command::Save, _) => slave.save()?,
            (Command::Restore, _) => slave.restore()?,
            (Command::Start, _) => slave.start(None)?,
            (Command::StartWith, _) => {
                self.take_present();
                slave.start(Some(&self.values))?;
            }
            // Handled before.
            (Command::Load | Command::End, _) => {}
        }
        Ok(Status::Done)
    }

    /// Takes a step and reads the outputs at once, ready for the next request.
    fn step(&mut self, slave: &mut dyn Slave) -> Result<Status, SlaveError> {
        let values = self.inputs.as_flattened_mut();
        values.iter_mut().zip(self.page.inputs()).for_each(|(value, word)| *value = number(word));
        let header = self.page.header();
        let (time, length) = (number(&header.asked.time), number(&header.asked.length));
        header.answered.fresh.store(0, Relaxed);
        let (status, reached) = match slave.step(time, length, &self.inputs)? {
            StepEnd::Done => (Status::Done, time + length),
            StepEnd::Until(reached) => (Status::Until, reached),
            StepEnd::Terminated(reached) => (Status::Terminated, reached),
        };
        header.answered.reached.store(reached.to_bits(), Relaxed);
        match self.read(slave) {
            Ok(()) => header.answered.fresh.store(1, Relaxed),
            Err(error) => self.failed = Some(error),
        }
        Ok(status)
    }

    fn read(&mut self, slave: &mut dyn Slave) -> Result<(), SlaveError> {
        slave.read(None, &mut self.outputs)?;
        self.write_outputs();
        Ok(())
    }

    fn read_for(&mut self, slave: &mut dyn Slave) -> Result<(), SlaveError> {
        self.take_present();
        slave.read(Some(&self.values), &mut self.outputs)?;
        self.write_outputs();
        Ok(())
    }

    fn take_present(&mut self) {
        let values = self.page.inputs().iter().step_by(3);
        self.values.iter_mut().zip(values).for_each(|(value, word)| *value = number(word));
    }

    fn write_outputs(&self) {
        let words = self.page.outputs().iter();
        words.zip(&self.outputs).for_each(|(word, value)| word.store(value.to_bits(), Relaxed));
    }
}

fn number(word: &AtomicU64) -> f64 {
    f64::from_bits(word.load(Relaxed))
}

/// Passes on the log kept until now.
fn pass_on(log: &[LogLine]) {
    for line in log {
        say_at_once(line);
    }
}

fn without_flood(error: SlaveError) -> SlaveError {
    match error {
        SlaveError::Failed { call, time, status, message } => {
            SlaveError::Failed { call, time, status, message: clipped(message) }
        }
        other => other,
    }
}

/// The start of a text of any length.
fn clipped(text: String) -> String {
    if text.len() <= LONGEST {
        return text;
    }
    let (start, rest) = text.split_at(text.floor_char_boundary(LONGEST));
    format!("{start} … ({} bytes more)", rest.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_texts_are_cut_between_characters() {
        assert_eq!(clipped("µm".into()), "µm");
        let cut = clipped("x".to_owned() + &"µ".repeat(10_000));
        assert!(cut.starts_with("xµ") && cut.ends_with("µ … (12002 bytes more)"), "{}", &cut[cut.len() - 40..]);
    }
}
