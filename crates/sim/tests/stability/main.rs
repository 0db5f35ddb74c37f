//! The analysis of the linear loop against runs.
mod deviation;
mod files;
mod master;
mod modes;
mod random;
mod sweep;
