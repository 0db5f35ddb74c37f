//! Exit code and messages of `--deny` and `--strict`.
use crate::args::DenyArgs;
use crate::console::{say, style};
use crate::error::CliError;
use crate::exit::Exit;
use servobench_report::{denials, wrapped};
use servobench_results::Runs;

/// Reports denied findings of `runs` and their places; with `quiet` one line for each kind.
pub(crate) fn deny(runs: &dyn Runs, args: &DenyArgs, quiet: bool) -> Result<Exit, CliError> {
    let lines = denials(runs, &args.kinds())?;
    for line in &lines {
        let line = format!("servobench: denied: {line}");
        let text = if quiet { line } else { wrapped(&line, style().width.saturating_sub(2)).join("\n  ") };
        say(&format!("{text}\n"));
    }
    Ok(if lines.is_empty() { Exit::Passed } else { Exit::Failed })
}
