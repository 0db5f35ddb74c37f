//! Counters, factors and differences against integer arithmetic written out a second time.

mod counter;
mod difference;
mod factor_group;
mod messages;
mod random;
mod ratio;
