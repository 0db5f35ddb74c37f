//! Homing: what every method finds on an ideal axis, against what manuals print of the profile's drawings.
mod axis;
mod bits;
mod fuzz;
mod methods;
mod published;
mod table;
