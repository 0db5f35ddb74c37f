//! Contained processes and shared objects of two processes, on Linux (5.4 or later).

mod channel;
mod contain;
mod crash;
mod descendants;
mod futex;
mod keeper;
mod leave;
mod machine;
mod memory;
mod namespace;
mod note;
mod sample;
mod settings;
mod shared_memory;
mod supervisor;

pub use channel::{Channel, claim_standard_streams};
pub use contain::contain;
pub(crate) use futex::{sleep_while, wake};
pub use leave::leave_at_once;
pub use machine::{keep_freed_memory, memory_of_machine};
pub use memory::own_memory;
pub use shared_memory::{MemoryFile, SharedMemory};
pub use supervisor::{Contained, end_all};
