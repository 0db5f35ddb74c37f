//! The master with blocks of which all is known.
mod delays;
mod events;
mod linear;
mod loops;
mod orders;
mod oscillator;
mod properties;
mod stability;
