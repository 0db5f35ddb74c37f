//! PLCopen motion control, part 1: function blocks and the axis that they command.
//!
//! `no_std`, no heap.
#![cfg_attr(not(test), no_std)]
