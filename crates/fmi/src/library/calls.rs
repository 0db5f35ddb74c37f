//! The function of an FMU in progress: the last trace of a process that ended or hangs.
use std::sync::OnceLock;

/// The observer of calls.
static NOTE: OnceLock<fn(&'static str)> = OnceLock::new();

/// Sets the observer of calls: `note` receives the name of each function of an FMU before it is called, and an empty name on return. For
/// a process watched by another one. Only the first observer counts.
pub fn note_calls(note: fn(&'static str)) {
    NOTE.get_or_init(|| note);
}

/// Calls a function of this name and notifies the observer.
pub(super) fn during<T>(name: &'static str, call: impl FnOnce() -> T) -> T {
    let Some(note) = NOTE.get() else { return call() };
    note(name);
    let answer = call();
    note("");
    answer
}
