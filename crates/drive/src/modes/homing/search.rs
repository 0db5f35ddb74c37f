//! Progress of a search: the present leg, and its evaluation of switches and index pulse.
use super::Params;
use super::leg::{Direction, Event, Leg, Switch};
use super::method::{Method, Start};
use crate::modes::{Actual, Moment};
use servobench_base::Stateful;

/// Progress of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Stateful)]
pub(super) struct Search {
    method: Method,
    start: Start,
    leg: usize,
    /// The switch of the method at the last look.
    was_on: bool,
}

/// Result of a step of the search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Finding {
    /// This leg continues, or has just begun.
    Leg(Leg),
    /// The reference is at this position.
    Reference(f64),
    /// A limit switch was met that the method does not expect.
    Limit(Switch),
}

impl Search {
    /// Begins a search at the present position.
    pub(super) fn begin(method: Method, actual: &Actual) -> Self {
        let was_on = method.switch().is_some_and(|switch| switch.is_on(actual));
        Self { method, start: if was_on { Start::On } else { Start::Off }, leg: 0, was_on }
    }

    /// Restarts the search at the present position.
    pub(super) fn restart(&mut self, actual: &Actual) {
        *self = Self::begin(self.method, actual);
    }

    pub(super) fn look(&mut self, params: &Params, moment: &Moment) -> Finding {
        let actual = &moment.actual;
        let is_on = self.method.switch().is_some_and(|switch| switch.is_on(actual));
        let was_on = core::mem::replace(&mut self.was_on, is_on);
        let Some(leg) = self.present() else { return Finding::Reference(actual.position) };
        let event = match leg.until {
            Event::On => (is_on && !was_on).then_some(actual.position),
            Event::Off => (was_on && !is_on).then_some(actual.position),
            Event::Index => actual.index,
        };
        if let Some(position) = event.filter(|_| moves(params, moment, leg.direction)) {
            self.leg += 1;
            return self.present().map_or(Finding::Reference(position), Finding::Leg);
        }
        let limit = leg.direction.limit_switch();
        let is_sought = self.method.switch() == Some(limit);
        if is_sought || !limit.is_on(actual) {
            return Finding::Leg(leg);
        }
        if !self.method.turns_at_limit() || self.start != Start::Off || self.leg > 0 {
            return Finding::Limit(limit);
        }
        self.start = Start::AtLimit;
        self.present().map_or(Finding::Limit(limit), Finding::Leg)
    }

    fn present(&self) -> Option<Leg> {
        self.method.leg(self.start, self.leg)
    }
}

/// True if the axis moves in a direction: by its demand, unless it is measured moving back, as a lagging axis may. Velocity noise in the
/// slowest motion does not count as moving back.
fn moves(params: &Params, moment: &Moment, direction: Direction) -> bool {
    let sign = direction.sign();
    moment.demanded.v * sign > 0.0 && moment.actual.velocity * sign > -0.5 * params.zero_speed
}
