//! A drive over a fieldbus on which things go wrong, and counters that wrap, end to end.
mod ahead;
mod counters;
mod faults;
mod homing_steps;
mod modes;
mod position_loop;
mod put_out;
mod reversed;
mod taking_over;
mod task;
