//! Which function of an FMU is under way: what a process that ended, or does not come back, was last seen in.
use std::sync::OnceLock;

/// Who is told.
static NOTE: OnceLock<fn(&'static str)> = OnceLock::new();

/// Has `note` called with the name of each function of an FMU before it is called, and with an empty name when it has come back.
/// For a process that somebody else watches. The first call counts.
pub fn note_calls(note: fn(&'static str)) {
    NOTE.get_or_init(|| note);
}

/// Calls a function of this name.
pub(super) fn during<T>(name: &'static str, call: impl FnOnce() -> T) -> T {
    let Some(note) = NOTE.get() else { return call() };
    note(name);
    let answer = call();
    note("");
    answer
}
