//! What contains a process that can crash, hang, or take all memory: native code of engines and FMUs, loaders of foreign files.
//!
//! [`Contained::start`] starts a program, which calls [`contain`] before it does anything else. From there on it is two processes:
//!
//! ```text
//! this process ── control: closed by its end, or to end it ── keeper ── the contained process ── what it starts
//!              ←─ report: how it ended, what it left ───────
//!              ←─ standard output and error of the contained process
//! ```
//! The *keeper* does nothing but watch. It is in a process group of its own, so that no key of a terminal and no signal to the group of
//! this process reaches it or what it keeps. All that the contained process starts becomes the keeper's when its parent ends (it is a
//! child subreaper, prctl(2)), also where it has left group and session (setsid). The keeper hears of the end of this process by the
//! control socket, however that ends, and ends everything.
//!
//! | what happens | what is done |
//! |---|---|
//! | the contained process ends | what it has started and left behind is ended, and the report names it |
//! | this process ends, also by SIGKILL | the keeper ends everything, and itself |
//! | the keeper is ended | the contained process ends with it (`PR_SET_PDEATHSIG`) |
//! | it asks for memory without end | private memory has a hard bound (`RLIMIT_DATA`); the keeper adds up private and shared memory, memfd and files in `/dev/shm`, of all its processes, and ends them above the bound |
//! | it prints without end | the last of it is kept ([`Stream`]) |
//!
//! Foreign code ([`Limits::is_foreign`]) is in a PID namespace of its own where the system allows that: there it sees no other
//! process, can send a signal to none, and the kernel ends all of them together.
//!
//! Times are measured by [`Stopwatch`], which stands still while this process does not run (SIGSTOP, Ctrl-Z, a paused machine).
//!
//! Linux only (5.4 or later). Elsewhere nothing can be contained, and says so.

#[cfg(target_os = "linux")]
mod contain;
#[cfg(target_os = "linux")]
mod crash;
#[cfg(target_os = "linux")]
mod descendants;
#[cfg(not(target_os = "linux"))]
mod elsewhere;
#[cfg(unix)]
mod ending;
mod error;
#[cfg(target_os = "linux")]
mod keeper;
mod machine;
mod memory;
#[cfg(target_os = "linux")]
mod namespace;
#[cfg(target_os = "linux")]
mod note;
#[cfg(unix)]
mod output;
mod program;
#[cfg(target_os = "linux")]
mod sample;
#[cfg(unix)]
mod settings;
mod stopwatch;
#[cfg(unix)]
mod streams;
#[cfg(target_os = "linux")]
mod supervisor;

#[cfg(target_os = "linux")]
pub use contain::contain;
#[cfg(not(target_os = "linux"))]
pub use elsewhere::{contain, end_all};
#[cfg(unix)]
pub use ending::Ending;
pub use error::ContainError;
pub use machine::memory_of_machine;
pub use memory::in_words;
#[cfg(target_os = "linux")]
pub use memory::own_memory;
#[cfg(unix)]
pub use output::Stream;
pub use program::{Limits, Program};
pub use stopwatch::Stopwatch;
#[cfg(unix)]
pub use streams::claim_standard_streams;
#[cfg(target_os = "linux")]
pub use supervisor::{Contained, Output, end_all};
