//! Resources of the machine that the program takes beyond the usual: memory that it keeps, files that it has open.
use servobench_isolation::{allow_open_files, keep_freed_memory};

/// Bytes that stay with the program for its next run: the recordings of a suite's runs have some ten megabytes.
const KEPT: i32 = 64 << 20;
/// Bytes of one piece up to which it is kept, as many as the allocator allows.
const PIECE: i32 = 32 << 20;

/// Files that may be open at once, if the machine allows as many: a long run has one for each channel, and as many runs as there are
/// processors go side by side. A thousand and twenty-four are usual.
const FILES: u64 = 1 << 16;

/// Takes them, before anything else runs.
pub(crate) fn take() {
    keep_freed_memory(KEPT, PIECE);
    allow_open_files(FILES);
}
