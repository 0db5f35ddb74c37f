//! Time events, announced by the FMU with `nextEventTime` (FMI 3.0.2, §2.3.5). A step that would pass one ends there if the FMU takes
//! steps of any length; otherwise the event is handled at the next communication point.

/// Times closer than this (relative) are equal: rounding of the time.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;
/// Relative rest of a step that is not taken separately: the caller treats it as rounding.
const REST: f64 = 1e-9;

/// Time of the next event.
#[derive(Debug, Clone, Copy)]
pub(super) struct TimeEvent {
    /// (s)
    next: Option<f64>,
    /// True if steps may be of any length.
    variable_step: bool,
    /// Limit of event times (s).
    stop: f64,
}

/// A step to take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Leg {
    /// (s)
    pub(super) length: f64,
    /// True if it ends early, at an event.
    pub(super) is_cut: bool,
}

impl TimeEvent {
    pub(super) fn new(variable_step: bool, stop: Option<f64>) -> Self {
        Self { next: None, variable_step, stop: stop.unwrap_or(f64::INFINITY) }
    }

    /// Replaces the time of the next event by the one the FMU reports.
    pub(super) fn announce(&mut self, next: Option<f64>) {
        self.next = next.filter(|next| next.is_finite() && *next <= self.stop);
    }

    /// True if the event is at `now` (s) or has been passed.
    pub(super) fn is_due(&self, now: f64) -> bool {
        self.next.is_some_and(|next| next <= now + ROUNDINGS * now.abs())
    }

    /// Part to take now of a step from `time` by `length` (s).
    pub(super) fn leg(&self, time: f64, length: f64) -> Leg {
        let whole = Leg { length, is_cut: false };
        let end = time + length;
        let ahead = self.next.filter(|next| self.variable_step && !self.is_due(time) && *next <= end + ROUNDINGS * end);
        match ahead {
            Some(next) if next < end - REST * length => Leg { length: up_to(time, next), is_cut: true },
            // Slightly further: the FMU may overlook an event that is a rounding ahead.
            Some(next) if next > end => Leg { length: up_to(time, next), is_cut: false },
            _ => whole,
        }
    }
}

/// A length (s) such that a step from `time` does not end before `end`.
fn up_to(time: f64, end: f64) -> f64 {
    let length = end - time;
    if time + length < end { length.next_up() } else { length }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn event(next: f64) -> TimeEvent {
        TimeEvent { next: Some(next), ..TimeEvent::new(true, None) }
    }

    #[test]
    fn a_step_ends_at_an_event_within_it() {
        assert_eq!(event(1.25).leg(1.0, 0.5), Leg { length: 0.25, is_cut: true });
        let whole = Leg { length: 0.5, is_cut: false };
        for elsewhere in [1.0, 0.75, 1.5, 2.0] {
            assert_eq!(event(elsewhere).leg(1.0, 0.5), whole, "{elsewhere}");
        }
        assert_eq!(TimeEvent { variable_step: false, ..event(1.25) }.leg(1.0, 0.5), whole);
        assert_eq!(TimeEvent::new(true, None).leg(1.0, 0.5), whole);
    }

    /// An FMU that compares its time with that of the event finds it reached.
    #[test]
    fn no_step_to_an_event_ends_before_it() {
        for numerator in 1..1000 {
            let (time, next) = (f64::from(numerator) * 0.001, f64::from(numerator) * 0.001 + 1.0 / 3.0);
            let leg = event(next).leg(time, 0.5);
            assert!(leg.is_cut && time + leg.length >= next, "{time}");
        }
        let (time, next) = (0.0, 0.3_f64.next_up());
        assert_eq!(
            event(next).leg(time, 0.3),
            Leg { length: next, is_cut: false },
            "an event at the end, but for a rounding"
        );
        assert!(event(next).is_due(0.3));
    }

    #[test]
    fn what_is_no_time_is_no_event() {
        let mut event = event(1.0);
        event.announce(Some(f64::NAN));
        assert_eq!(event.leg(0.0, 2.0), Leg { length: 2.0, is_cut: false });
        assert!(!event.is_due(f64::MAX));
    }
}
