//! The worker's side.
use super::message::{End, Message};
use crate::check::objections;
use crate::engines::Engines;
use crate::error::RunError;
use crate::execute::{Interruption, run_here};
use crate::job::slow_to;
use crate::panicked::caught;
use servobench_metrics::EarlyEnd;
use servobench_plant::{Engine, EngineName};
use servobench_scenario::{LoadError, Override, Scenario};
use servobench_sim::FmuOpener;
use std::io::Write;
use std::path::{Path, PathBuf};

/// What a worker is told beside the text of the scenario.
#[derive(Debug, Clone)]
pub struct Order {
    /// Name of the scenario.
    pub name: String,
    /// File that it came from: models are looked up from there.
    pub path: Option<PathBuf>,
    /// Keys with another value than the text gives them.
    pub overrides: Vec<Override>,
    /// The engine.
    pub engine: EngineName,
    /// Durations that the moves are slowed to (s); empty: as they are.
    pub durations: Vec<f64>,
    /// Where the recording goes. Without one nothing runs, and only what keeps the scenario from being built is told.
    pub recording: Option<PathBuf>,
}

/// Runs the scenario in `text` as `order` says, and tells the caller on `out`: progress, and at last how it ended.
/// Warnings are not repeated: the caller has seen them.
pub fn serve(order: &Order, text: &str, engines: &Engines, mut out: impl Write) -> End {
    // A caller that no longer listens has ended, and nobody needs this process any longer.
    let mut say = |message: &Message| {
        message.line().map_err(std::io::Error::from).and_then(|line| out.write_all(line.as_bytes())).ok();
        out.flush().ok();
    };
    let end = caught(|| obey(order, text, engines, &mut say));
    let end = end.unwrap_or_else(|panic| End::Failed(panic.to_string()));
    say(&Message::End(end.clone()));
    end
}

/// Runs or checks.
fn obey(order: &Order, text: &str, engines: &Engines, say: &mut dyn FnMut(&Message)) -> End {
    let scenario = match read(order, text) {
        Ok(scenario) => scenario,
        Err(error) => return End::Input(error.to_string()),
    };
    let done = engines.get(order.engine).map_err(RunError::from).and_then(|engine| match &order.recording {
        Some(path) => run(&scenario, (engine, engines.fmu_opener), path, say),
        None => objections(&scenario, engine, engines.fmu_opener).map(|all| {
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
    loop_of: (&dyn Engine, &dyn FmuOpener),
    path: &Path,
    say: &mut dyn FnMut(&Message),
) -> Result<End, RunError> {
    let (recording, interruption) = run_here(scenario, loop_of, &mut |share| say(&Message::Progress(share)))?;
    Ok(match (interruption, recording.write_parquet(path)) {
        (Some(Interruption::Broken(error)), _) => End::Failed(error.to_string()),
        (_, Err(error)) => End::Failed(error.to_string()),
        (Some(Interruption::Early(EarlyEnd::Diverged { time, reason })), Ok(())) => End::Diverged { time, reason },
        (Some(Interruption::Early(EarlyEnd::GaveUp(why))), Ok(())) => End::GaveUp(why),
        (None, Ok(())) => End::Done,
    })
}

/// The scenario as the caller has it.
fn read(order: &Order, text: &str) -> Result<Scenario, LoadError> {
    let file = order.path.as_ref().map_or_else(|| format!("{}.toml", order.name), |path| path.display().to_string());
    let folder = order.path.as_deref().and_then(Path::parent);
    let mut scenario = servobench_scenario::parse_with(&file, text, folder, &order.overrides)?.scenario;
    scenario.name.clone_from(&order.name);
    scenario.path.clone_from(&order.path);
    slow_to(&mut scenario, &order.durations);
    Ok(scenario)
}
