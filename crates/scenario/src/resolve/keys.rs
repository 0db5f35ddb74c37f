//! Keys of the profile, in a move or in `[setpoint]` for all moves.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::list::{Many, OneOrMany};
use crate::source::{At, Span};
use servobench_motion::online::Effort;
use servobench_motion::sampled::Execution;
use servobench_motion::{Limits, Order};
use servobench_planner::{Method, Sampling};
use std::collections::BTreeSet;

/// Keys of the limits, velocity first.
pub(super) const LIMITS: [&str; 4] = ["velocity", "acceleration", "jerk", "snap"];

/// The keys that moves and `[setpoint]` share.
#[derive(Clone, Copy)]
pub(super) struct Keys<'a> {
    pub(super) order: &'a Slot<u32>,
    pub(super) limits: [&'a Slot<f64>; 4],
    pub(super) method: &'a Slot<Method>,
    pub(super) sample_time: &'a Slot<f64>,
    pub(super) sampling: &'a Slot<Sampling>,
    pub(super) execution: &'a Slot<Execution>,
    pub(super) online: &'a Slot<Effort>,
    pub(super) negative: [&'a Slot<f64>; 2],
    pub(super) rockwell: &'a Slot<file::Rockwell>,
    pub(super) shaper: &'a Slot<OneOrMany<file::Shaper>>,
    pub(super) averages: &'a Slot<Many<f64>>,
}

/// Mistakes of `[setpoint]` reported so far: each is reported once for all moves.
#[derive(Default)]
pub(super) struct Reported {
    missing: Vec<&'static str>,
    places: BTreeSet<Span>,
}

/// The keys of a table that has them all.
macro_rules! keys_of {
    ($table:expr) => {
        Keys {
            order: &$table.order,
            limits: [&$table.velocity, &$table.acceleration, &$table.jerk, &$table.snap],
            method: &$table.method,
            sample_time: &$table.sample_time,
            sampling: &$table.sampling,
            execution: &$table.execution,
            online: &$table.online,
            negative: [&$table.negative_velocity, &$table.negative_acceleration],
            rockwell: &$table.rockwell,
            shaper: &$table.shaper,
            averages: &$table.averages,
        }
    };
}

impl<'a> Keys<'a> {
    pub(super) const fn of_step(step: &'a file::ProgramStep) -> Self {
        keys_of!(step)
    }

    pub(super) const fn of_setpoint(setpoint: &'a file::Setpoint) -> Self {
        keys_of!(setpoint)
    }

    /// These keys, with those of `defaults` where absent.
    pub(super) fn or(&self, defaults: Option<&Self>) -> Self {
        let Some(defaults) = defaults else { return *self };
        Self {
            order: either(self.order, defaults.order),
            limits: std::array::from_fn(|i| either(self.limits[i], defaults.limits[i])),
            method: either(self.method, defaults.method),
            sample_time: either(self.sample_time, defaults.sample_time),
            sampling: either(self.sampling, defaults.sampling),
            execution: either(self.execution, defaults.execution),
            online: either(self.online, defaults.online),
            negative: std::array::from_fn(|i| either(self.negative[i], defaults.negative[i])),
            rockwell: either(self.rockwell, defaults.rockwell),
            shaper: either(self.shaper, defaults.shaper),
            averages: either(self.averages, defaults.averages),
        }
    }

    /// Their names and places.
    pub(super) fn named(&self) -> impl Iterator<Item = (&'static str, Option<Span>)> {
        let limits = LIMITS.into_iter().zip(self.limits).map(|(key, slot)| (key, slot.span()));
        limits.chain([
            ("order", self.order.span()),
            ("method", self.method.span()),
            ("sample_time", self.sample_time.span()),
            ("sampling", self.sampling.span()),
            ("execution", self.execution.span()),
            ("online", self.online.span()),
            ("negative_velocity", self.negative[0].span()),
            ("negative_acceleration", self.negative[1].span()),
            ("rockwell", self.rockwell.span()),
            ("shaper", self.shaper.span()),
            ("averages", self.averages.span()),
        ])
    }

    /// The order, and the limits that it needs; `header` is the header of the move.
    pub(super) fn order_and_limits(
        &self,
        header: Span,
        said: &mut Reported,
        report: &mut Report,
    ) -> Option<(Order, Limits)> {
        let order = self.order.given().and_then(|order| Order::from_derivative(u8::try_from(*order).ok()?));
        let Some(order) = order else {
            if matches!(self.order, Slot::Absent) {
                said.missing("order", header, "2, 3 or 4", report);
            }
            // Any order needs these limits.
            for (key, slot) in LIMITS.into_iter().zip(self.limits).take(2) {
                if matches!(slot, Slot::Absent) {
                    said.missing(key, header, "every move needs it", report);
                }
            }
            return None;
        };
        let needed = order.derivative();
        let limits = self.limits(needed, needed, &format!("a move of order {needed}"), header, said, report);
        let [velocity, acceleration, jerk, snap] = limits?;
        Some((order, Limits { velocity, acceleration, jerk, snap }))
    }

    /// The limits; the first `needed` are required, the first `used` are allowed; `what` describes the move.
    pub(super) fn limits(
        &self,
        needed: usize,
        used: usize,
        what: &str,
        header: Span,
        said: &mut Reported,
        report: &mut Report,
    ) -> Option<[f64; 4]> {
        let mut limits = [f64::INFINITY; 4];
        let mut is_complete = true;
        for (i, slot) in self.limits.into_iter().enumerate() {
            match slot {
                Slot::Given(at) if i < used => limits[i] = at.value,
                Slot::Given(At { span, .. }) => {
                    let message = format!("`{}` is not used by {what}", LIMITS[i]);
                    said.once(*span, |report| report.warning(*span, message, ""), report);
                }
                Slot::Absent if i < needed => {
                    said.missing(LIMITS[i], header, &format!("{what} needs it"), report);
                    is_complete = false;
                }
                Slot::Wrong(_) => is_complete = false,
                Slot::Absent => {}
            }
        }
        is_complete.then_some(limits)
    }
}

/// The value of the move, or `default` if absent.
fn either<'a, T>(own: &'a Slot<T>, default: &'a Slot<T>) -> &'a Slot<T> {
    if matches!(own, Slot::Absent) { default } else { own }
}

impl Reported {
    pub(super) fn missing(&mut self, key: &'static str, header: Span, why: &str, report: &mut Report) {
        if !self.missing.contains(&key) {
            self.missing.push(key);
            report.missing_with_help("setpoint", key, header, why);
        }
    }

    pub(super) fn once(&mut self, place: Span, say: impl FnOnce(&mut Report), report: &mut Report) {
        if self.places.insert(place) {
            say(report);
        }
    }
}
