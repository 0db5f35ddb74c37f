//! The analysis of the linear loop against runs.
mod deviation;
mod files;
mod random;
mod sweep;
