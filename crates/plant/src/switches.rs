//! Limit and home switches along the axis, and the index pulse of the motor's encoder.
//!
//! A switch is active or not by the position of the load. Wired normally open, it closes its input while active; wired
//! normally closed, it opens the input then; an input without a switch is open. The index pulse comes once per revolution of the motor and
//! its position is latched, between two ticks too, as in an encoder's hardware.
use core::f64::consts::TAU;
use core::fmt::{self, Display, Formatter};
use core::ops::RangeInclusive;
use servobench_base::{ParamError, finite};

/// Positions and wiring of the switches; constant during a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Switches {
    /// The negative end: active at and below it (axis coordinate).
    pub negative: Option<f64>,
    /// The positive end: active at and above it (axis coordinate).
    pub positive: Option<f64>,
    /// Range in which the home switch is active (axis coordinate).
    pub home: Option<RangeInclusive<f64>>,
    /// Angle of the motor at which the index pulse comes (rad); `None` for a motor without one.
    pub index: Option<f64>,
    /// True if the switches are wired normally closed.
    pub normally_closed: bool,
}

/// Inputs from the switches at a tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SwitchReading {
    /// True if the input for the switch of the negative end is closed.
    pub negative: bool,
    /// True if the input for the switch of the positive end is closed.
    pub positive: bool,
    /// True if the input for the home switch is closed.
    pub home: bool,
    /// Position of the motor at the last index pulse since the tick before (rad); `None` without one.
    pub index: Option<f64>,
}

impl SwitchReading {
    /// The inputs of a drive that counts in this `direction` of the axis, −1 or 1: for −1, negative and positive end are
    /// exchanged.
    #[must_use]
    pub const fn in_direction(self, direction: f64) -> Self {
        if direction < 0.0 { Self { negative: self.positive, positive: self.negative, ..self } } else { self }
    }
}

/// A point of the axis with a switch, or the index pulse.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SwitchPoint {
    /// [`Switches::negative`].
    Negative,
    /// [`Switches::positive`].
    Positive,
    /// Start of [`Switches::home`].
    HomeFrom,
    /// End of [`Switches::home`].
    HomeTo,
    /// [`Switches::index`].
    Index,
}

impl SwitchPoint {
    /// Every point.
    pub const ALL: [Self; 5] = [Self::Negative, Self::Positive, Self::HomeFrom, Self::HomeTo, Self::Index];
}

impl Display for SwitchPoint {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Negative => "position of the negative limit switch",
            Self::Positive => "position of the positive limit switch",
            Self::HomeFrom => "start of the home switch",
            Self::HomeTo => "end of the home switch",
            Self::Index => "angle of the index pulse",
        })
    }
}

impl Switches {
    /// # Errors
    /// [`ParamError`] names the first position that is not finite.
    pub fn check(&self) -> Result<(), ParamError<SwitchPoint>> {
        let home = self.home.as_ref();
        for (point, position) in [
            (SwitchPoint::Negative, self.negative),
            (SwitchPoint::Positive, self.positive),
            (SwitchPoint::HomeFrom, home.map(|home| *home.start())),
            (SwitchPoint::HomeTo, home.map(|home| *home.end())),
            (SwitchPoint::Index, self.index),
        ] {
            position.map_or(Ok(0.0), |position| finite(point, position))?;
        }
        Ok(())
    }

    /// The inputs with the load at `load` (axis coordinate), and a motion of the motor from `before` to `now` (rad).
    #[must_use]
    pub fn read(&self, load: f64, before: f64, now: f64) -> SwitchReading {
        let is_closed = |is_active: bool| is_active != self.normally_closed;
        SwitchReading {
            negative: self.negative.is_some_and(|end| is_closed(load <= end)),
            positive: self.positive.is_some_and(|end| is_closed(load >= end)),
            home: self.home.as_ref().is_some_and(|home| is_closed(home.contains(&load))),
            index: self.index.and_then(|index| last_pulse(index, before, now)),
        }
    }
}

/// The last angle `index` + n·2π in the motion from `before` to `now`, in the half-open interval that
/// excludes `before`: two consecutive motions meet each pulse once.
fn last_pulse(index: f64, before: f64, now: f64) -> Option<f64> {
    let turns = |angle: f64| (angle - index) / TAU;
    if now > before {
        let pulse = index + TAU * libm::floor(turns(now));
        (pulse > before && pulse <= now).then_some(pulse)
    } else {
        let pulse = index + TAU * libm::ceil(turns(now));
        (pulse < before && pulse >= now).then_some(pulse)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a motor that turns ten times passes its index ten times, each a whole number of turns from the next, at
    /// any ticks.
    #[test]
    fn each_pulse_comes_once() {
        let switches = Switches { index: Some(0.3), ..Switches::default() };
        for direction in [1.0, -1.0] {
            let angle = |tick: u32| direction * (0.1 + 10.0 * TAU * f64::from(tick) / 777.0);
            let pulses: Vec<f64> =
                (0..777).filter_map(|tick| switches.read(0.0, angle(tick), angle(tick + 1)).index).collect();
            assert_eq!(pulses.len(), 10, "{pulses:?}");
            for (k, pulse) in pulses.iter().enumerate() {
                let expected = if direction > 0.0 { 0.3 + TAU * k as f64 } else { 0.3 - TAU * (k as f64 + 1.0) };
                // A few roundings of 63 rad.
                assert!((pulse - expected).abs() < 1e-13, "{k}: {pulse}");
            }
        }
    }

    #[test]
    fn a_switch_is_active_beyond_its_end_and_a_home_switch_between_its_ends() {
        let switches =
            Switches { negative: Some(-0.02), positive: Some(0.5), home: Some(0.0..=0.01), ..Switches::default() };
        let at = |load| {
            let reading = switches.read(load, 0.0, 0.0);
            (reading.negative, reading.home, reading.positive)
        };
        for (load, expected) in [
            (-0.1, (true, false, false)),
            (-0.02, (true, false, false)),
            (-0.01, (false, false, false)),
            (0.0, (false, true, false)),
            (0.01, (false, true, false)),
            (0.3, (false, false, false)),
            (0.5, (false, false, true)),
        ] {
            assert_eq!(at(load), expected, "{load}");
            let opened = Switches { normally_closed: true, ..switches.clone() }.read(load, 0.0, 0.0);
            assert_eq!((!opened.negative, !opened.home, !opened.positive), expected, "{load}, normally closed");
        }
        let none = Switches { normally_closed: true, ..Switches::default() };
        assert_eq!(none.read(0.0, 0.0, 100.0), SwitchReading::default(), "an input without a switch is open");
        assert_eq!(Switches::default().read(0.0, 0.0, 100.0), SwitchReading::default());
    }

    #[test]
    fn a_position_that_is_no_number_is_refused() {
        let switches = Switches { home: Some(0.0..=f64::NAN), ..Switches::default() };
        let refusal = switches.check().unwrap_err().to_string();
        assert_eq!(refusal, "`end of the home switch` must be finite, got NaN");
    }
}
