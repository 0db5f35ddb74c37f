//! Transitions from any state, against oracles that share no code with the planner.

mod chained;
mod outside;
mod passing;
mod ramps;
mod random;
mod rest;
mod ruckig;
mod trapezoid;
