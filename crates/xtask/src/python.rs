//! Standard tools of Python that the developer commands run: pip, `venv`, `zipfile`.
use std::process::Command;

/// Runs `command`, a use of `tool`, in silence.
///
/// # Errors
/// The cause in one line: the last one that names an error, else the last that it wrote.
pub(crate) fn run(tool: &str, command: &mut Command) -> Result<(), String> {
    let done = command.output().map_err(|e| format!("`python3` cannot be started: {e}"))?;
    if done.status.success() {
        return Ok(());
    }
    let messages = String::from_utf8_lossy(&done.stderr);
    let mut lines = messages.lines().rev().map(str::trim).filter(|line| !line.is_empty());
    let last = lines.clone().next().unwrap_or("it gave no message");
    let cause = lines.find(|line| line.starts_with("ERROR")).unwrap_or(last);
    Err(format!("{tool}: {}", cause.trim_start_matches("ERROR: ")))
}
