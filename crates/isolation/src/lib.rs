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
//! Two processes speak by a [`Channel`], a socket, or by [`SharedMemory`] with a [`Doorbell`] for each direction, which costs less than a
//! microsecond where both are awake.
//!
//! The module `sys` is the door to the operating system: no crate above calls it for processes by other names than those of `std` and of
//! this crate. Processes are contained on Linux (5.4 or later); elsewhere [`Contained::start`] refuses.

mod doorbell;
mod ending;
mod error;
mod memory;
mod program;
mod stopwatch;
mod stream;
mod sys;

pub use doorbell::{Doorbell, Listener};
pub use ending::Ending;
pub use error::ContainError;
pub use memory::in_words;
pub use program::{Limits, Program};
pub use stopwatch::Stopwatch;
pub use stream::{Output, Stream};
pub use sys::{
    Channel, Contained, Interrupt, Interrupts, MemoryFile, SharedMemory, allow_open_files, claim_standard_streams,
    contain, end_all, keep_freed_memory, leave_at_once, memory_of_machine, own_memory, refuse_large_files,
};
