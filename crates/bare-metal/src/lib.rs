//! An axis for a machine with neither operating system nor heap, as far as linking shows it.
//!
//! A static library needs an allocator as soon as anything in it could allocate, and this one has none: its build for such a machine (by
//! `cargo xtask test`) shows that planning and sampling, the function blocks of a PLC, the link to a drive and the drive's state machine
//! work without. For a machine with an operating system it is empty.
#![cfg_attr(target_os = "none", no_std)]

#[cfg(target_os = "none")]
mod axis;
#[cfg(target_os = "none")]
mod station;
