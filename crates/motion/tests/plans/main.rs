//! Plans against oracles that share no code with the planner.

mod cascade;
mod closed_forms;
mod double_double;
mod evaluation;
mod fewest;
mod optimal;
mod paper;
mod requests;
mod rockwell;
#[cfg(feature = "std")]
mod shortest;
mod sweep;
