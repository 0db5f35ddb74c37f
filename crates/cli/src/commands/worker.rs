//! `servobench worker`: one scenario in a process of its own.
use crate::args::WorkerArgs;
use crate::engines;
use crate::error::CliError;
use crate::exit::Exit;
use crate::interrupt;
use servobench_suite::worker::{End, Order, serve};
use std::io::Read;

/// Runs the scenario that comes in on standard input; everything that is to be said of it is said by [`serve`].
pub(crate) fn worker(args: &WorkerArgs) -> Result<Exit, CliError> {
    interrupt::end_with_parent()?;
    // Ctrl-C reaches it as well: what it has unpacked goes with it.
    interrupt::watch(&std::env::temp_dir())?;
    let mut text = String::new();
    std::io::stdin().read_to_string(&mut text).map_err(CliError::Listen)?;
    let order = Order {
        name: args.name.clone(),
        path: args.path.clone(),
        overrides: args.set.clone(),
        engine: args.engine,
        durations: args.durations.clone(),
        recording: args.recording.clone(),
    };
    Ok(match serve(&order, &text, &engines::installed(), std::io::stdout().lock()) {
        End::Done => Exit::Passed,
        End::Input(_) => Exit::Input,
        End::Diverged { .. } | End::GaveUp(_) | End::Failed(_) => Exit::Run,
    })
}
