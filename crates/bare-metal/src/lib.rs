//! An axis on a machine with neither operating system nor heap, as far as linking goes.
//!
//! A static library needs an allocator as soon as anything in it could ask for memory, and here is none: that it is made for
//! such a machine (`cargo xtask test` does it) shows that planning and sampling, the function blocks of a PLC, the link to a drive
//! and the drive's state machine do without. For a machine with an operating system it is empty.
#![cfg_attr(target_os = "none", no_std)]

#[cfg(target_os = "none")]
mod axis;
#[cfg(target_os = "none")]
mod station;
