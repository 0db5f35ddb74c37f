//! Transitions from any state, against oracles that share no code with the planner.

mod arrival;
mod chained;
mod cruise;
mod outside;
mod passing;
mod ramps;
mod random;
mod replan;
mod request;
mod rest;
mod ruckig;
mod trapezoid;
mod turning;
