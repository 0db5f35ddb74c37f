//! What is said: results on standard output, everything else on standard error.
use crate::error::CliError;
use servobench_report::Style;
use std::io::{ErrorKind, IsTerminal, Write};

/// Prints `text` on standard output. A reader that went away (`| head`) has what it wanted; what cannot be written for
/// any other reason is an error.
pub(crate) fn print(text: &str) -> Result<(), CliError> {
    print_bytes(text.as_bytes())
}

/// The same with what is no text.
pub(crate) fn print_bytes(bytes: &[u8]) -> Result<(), CliError> {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(CliError::Print(error)),
        _ => Ok(()),
    }
}

/// Says `text` on standard error. When that is closed or full, there is nobody to tell.
pub(crate) fn say(text: &str) {
    std::io::stderr().lock().write_all(text.as_bytes()).ok();
}

/// This program as it was started, for commands to be pasted.
pub(crate) fn program() -> String {
    std::env::args().next().unwrap_or_else(|| "servobench".into())
}

/// How tables are shown on standard output.
pub(crate) fn style() -> Style {
    let colour = std::io::stdout().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    Style { colour, ..Style::default() }
}
