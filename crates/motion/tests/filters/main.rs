//! Interpolators, shapers and averages, against oracles that share no code with them.

mod averages;
mod humps;
mod interpolation;
mod random;
mod robustness;
mod shapers;
mod streams;
