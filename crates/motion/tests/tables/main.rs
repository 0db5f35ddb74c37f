//! Moves through tables of points, against oracles that share no code with them.

mod clocked;
mod drive;
mod evaluation;
mod plateaus;
mod random;
mod stepped;
mod velocities;
mod worked;
