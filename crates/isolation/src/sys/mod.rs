//! The door to the operating system for processes: functions for which `std` has no portable name.
//!
//! Other modules and crates use processes by `std` and by this crate. Processes are contained on Linux; on another system [`elsewhere`]
//! refuses that, and names the supported system.

#[cfg(not(target_os = "linux"))]
mod elsewhere;
#[cfg(target_os = "linux")]
mod linux;
#[cfg(not(unix))]
mod not_unix;
#[cfg(unix)]
mod unix;

#[cfg(not(target_os = "linux"))]
pub use elsewhere::{
    Channel, Contained, MemoryFile, SharedMemory, claim_standard_streams, contain, end_all, keep_freed_memory,
    leave_at_once, memory_of_machine, own_memory,
};
#[cfg(not(target_os = "linux"))]
pub(crate) use elsewhere::{sleep_while, wake};
#[cfg(target_os = "linux")]
pub use linux::{
    Channel, Contained, MemoryFile, SharedMemory, claim_standard_streams, contain, end_all, keep_freed_memory,
    leave_at_once, memory_of_machine, own_memory,
};
#[cfg(target_os = "linux")]
pub(crate) use linux::{sleep_while, wake};
#[cfg(not(unix))]
pub(crate) use not_unix::signal_of;
#[cfg(not(unix))]
pub use not_unix::{Interrupt, Interrupts, allow_open_files, refuse_large_files};
#[cfg(unix)]
pub(crate) use unix::signal_of;
#[cfg(unix)]
pub use unix::{Interrupt, Interrupts, allow_open_files, refuse_large_files};
