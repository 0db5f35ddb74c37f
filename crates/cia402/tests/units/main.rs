//! Counters, and factors against integer arithmetic written out a second time.

mod counter;
mod factor_group;
mod messages;
mod random;
mod ratio;
