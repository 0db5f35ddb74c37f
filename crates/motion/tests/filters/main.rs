//! Interpolators, shapers and averages, against oracles that share no code with them.

mod averages;
mod interpolation;
mod random;
mod shapers;
mod streams;
