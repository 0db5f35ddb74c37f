//! Homing: the reference of every method on an ideal axis, against the profile's drawings as printed in manuals.
mod axis;
mod bits;
mod fuzz;
mod methods;
mod published;
mod table;
