//! The worker's side.
use super::message::{End, Message};
use super::order::{Order, Task};
use super::recording;
use crate::error::RunError;
use crate::execute::{Interruption, Loop, run_here};
use servobench::Engines;
use servobench::check::objections;
use servobench::panicked::caught;
use servobench_config::Choice as _;
use servobench_isolation::{Stopwatch, claim_standard_streams, own_memory};
use servobench_metrics::EarlyEnd;
use servobench_plant::EngineName;
use servobench_scenario::Scenario;

use servobench_sim::{Reason, mechanics_at_rest};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Write};
use std::time::Duration;

/// Smallest interval between reports of progress.
const BETWEEN: Duration = Duration::from_millis(50);

/// Carries out orders until there are no more: those to run something with the engines `running`, those to check with `checking`. The
/// standard streams of this process are taken over: output of libraries on standard output goes to standard error.
///
/// # Errors
/// Those of the system.
pub fn serve(running: &Engines, checking: &Engines) -> io::Result<()> {
    let (orders, mut recording) = claim_standard_streams()?;
    let mut out = orders.try_clone()?;
    let mut lines = BufReader::new(orders);
    let mut line = String::new();
    loop {
        line.clear();
        if lines.read_line(&mut line)? == 0 {
            return Ok(());
        }
        let order: Order = serde_json::from_str(&line)?;
        let engines = if matches!(order.task, Task::Run { .. }) { running } else { checking };
        answer(&order, &mut recording, engines, &mut out);
    }
}

/// Carries out `order` and reports to the caller on `out`: progress, and at last the end. The recording goes to `file`. Warnings are not
/// repeated: the caller has seen them.
pub fn answer(order: &Order, file: &mut File, engines: &Engines, mut out: impl Write) -> End {
    // A caller that no longer reads has ended, and this process is no longer needed.
    let mut say = |message: &Message| {
        message.line().map_err(io::Error::from).and_then(|line| out.write_all(line.as_bytes())).ok();
        out.flush().ok();
    };
    let end = caught(|| obey(order, file, engines, &mut say));
    let end = end.unwrap_or_else(|panic| End::Failed(panic.to_string()));
    say(&Message::Holds(own_memory().unwrap_or(0)));
    say(&Message::End(end.clone()));
    end
}

/// Runs or checks.
fn obey(order: &Order, file: &mut File, engines: &Engines, say: &mut dyn FnMut(&Message)) -> End {
    let scenario = match order.scenario() {
        Ok(scenario) => scenario,
        Err(error) => return End::Input(error.to_string()),
    };
    let Some(engine) = EngineName::from_name(&order.engine) else {
        return End::Failed(format!("there is no engine `{}`", order.engine));
    };
    let done = engines.get(engine).map_err(RunError::from).and_then(|engine| match order.task {
        Task::Run { time_limit, records_all } => {
            let built_by = Loop { engine, fmu_opener: engines.fmu_opener, records_all };
            run(&scenario, built_by, time_limit, file, say)
        }
        Task::Linearise => {
            if let Some(found) = mechanics_at_rest(&scenario, engine) {
                say(&Message::AtRest(found));
            }
            Ok(End::Done)
        }
        Task::Check => objections(&scenario, engine, engines.fmu_opener).map_err(RunError::from).map(|all| {
            say(&Message::Objections(all));
            End::Done
        }),
    });
    done.unwrap_or_else(
        |error| {
            if error.is_input() { End::Input(error.to_string()) } else { End::Failed(error.to_string()) }
        },
    )
}

fn run(
    scenario: &Scenario,
    built_by: Loop<'_>,
    time_limit: Option<Duration>,
    file: &mut File,
    say: &mut dyn FnMut(&Message),
) -> Result<End, RunError> {
    let mut last: Option<Stopwatch> = None;
    let (recording, failure) = run_here(scenario, built_by, time_limit, &mut |share| {
        if last.is_none_or(|last| last.elapsed() >= BETWEEN) {
            last = Some(Stopwatch::start());
            say(&Message::Progress(share));
        }
    })?;
    if let Err(error) = recording::write(&recording, file) {
        return Ok(End::Failed(format!("cannot pass the recording on: {error}")));
    }
    let Some(failure) = failure else { return Ok(End::Done) };
    if failure.reason == Reason::Stopped {
        return Ok(End::Stopped(failure.time));
    }
    Ok(match Interruption::from(failure) {
        Interruption::Early(EarlyEnd::Diverged { time, reason }) => End::Diverged { time, reason },
        Interruption::Early(EarlyEnd::GaveUp(why)) => End::GaveUp(why),
        Interruption::Broken(error) => End::Failed(error.to_string()),
    })
}
