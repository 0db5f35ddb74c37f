//! Sensors that err, in the closed loop.
mod axis;
mod current;
mod encoder;
mod velocity;
