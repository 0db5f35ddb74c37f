//! Containment of a process that can crash, hang, or take all memory: native code of engines and FMUs, loaders of foreign files.
//!
//! [`Contained::start`] starts a program, which calls [`contain`] before it does anything else. From then on it is two processes:
//!
//! ```text
//! this process ── control: closed at its end, or to kill it ── keeper ── the contained process ── its child processes
//!              ←─ report: how it ended, what it left ───────
//!              ←─ standard output and error of the contained process
//! ```
//! The *keeper* only watches. It is in a separate process group, so that no key of a terminal and no signal to the group of this process
//! reaches it or the processes that it keeps. All descendants of the contained process become the keeper's children when their parent ends
//! (it is a child subreaper, prctl(2)), also where they have left group and session (setsid). The keeper detects the end of this process by
//! the control socket, however that ends, and kills everything.
//!
//! | event | action |
//! |---|---|
//! | the contained process ends | processes that it has started and left behind are killed, and the report names them |
//! | this process ends, also by SIGKILL | the keeper kills everything, and ends |
//! | the keeper is killed | the contained process ends with it (`PR_SET_PDEATHSIG`) |
//! | it requests memory without end | private memory has a hard bound (`RLIMIT_DATA`); the keeper adds up private and shared memory, memfd and files in `/dev/shm`, of all its processes, and kills them above the bound |
//! | it prints without end | the end of its output is kept ([`Stream`]) |
//!
//! Foreign code ([`Limits::is_foreign`]) is in a separate PID namespace where the system allows that: there it sees no other process, can
//! send a signal to none, and the kernel kills all of them together.
//!
//! Times are measured by [`Stopwatch`], which stands still while this process does not run (SIGSTOP, Ctrl-Z, a paused machine).
//!
//! Two processes communicate by a [`Channel`], a socket, or by [`SharedMemory`] with a [`Doorbell`] for each direction, which costs less
//! than a microsecond where both are awake.
//!
//! The module `sys` is the only door to the operating system: crates above use processes by `std` and this crate only. Processes are
//! contained on Linux (5.4 or later); elsewhere [`Contained::start`] refuses.

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
