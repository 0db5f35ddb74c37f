//! The master with blocks of which all is known.
mod delays;
mod discrete;
mod estimate;
mod events;
mod linear;
mod loops;
mod newmark;
mod orders;
mod oscillator;
mod properties;
mod servo;
mod single;
mod stability;
mod start;
