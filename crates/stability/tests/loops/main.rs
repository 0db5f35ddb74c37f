//! The analysis against closed forms, known axes and its own structure.
mod axes;
mod closed_forms;
mod known;
mod structure;
