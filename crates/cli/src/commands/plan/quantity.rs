//! Quantities on the command line of a plan. The parser reads each by itself; [`Axis`] combines them: it holds whether the axis is linear
//! or rotary, and the units of the plan.
use super::mistake::PlanMistake;
use clap::builder::TypedValueParser;
use clap::{Arg, Command};
use servobench_base::Coordinate;
use servobench_scenario::{Derivative, axis_quantity};
use std::ffi::OsStr;

/// A position or one of its derivatives, and its option.
#[derive(Debug, Clone)]
pub(crate) struct AxisQuantity {
    option: String,
    text: String,
    derivative: Derivative,
    /// In SI.
    value: f64,
    motion: Coordinate,
}

/// Reads a position or one of its derivatives, of an axis that is linear or rotary.
#[derive(Debug, Clone, Copy)]
pub(crate) struct AxisParser {
    derivative: Derivative,
    is_magnitude: bool,
}

pub(super) const POSITION: AxisParser = AxisParser::of(Derivative::Position);
pub(super) const VELOCITY: AxisParser = AxisParser::of(Derivative::Velocity);
pub(super) const ACCELERATION: AxisParser = AxisParser::of(Derivative::Acceleration);
pub(super) const JERK: AxisParser = AxisParser::of(Derivative::Jerk);
pub(super) const SNAP: AxisParser = AxisParser::of(Derivative::Snap);

impl AxisParser {
    const fn of(derivative: Derivative) -> Self {
        Self { derivative, is_magnitude: false }
    }

    /// The same parser, for values not below zero.
    pub(super) const fn magnitude(self) -> Self {
        Self { is_magnitude: true, ..self }
    }
}

impl TypedValueParser for AxisParser {
    type Value = AxisQuantity;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<AxisQuantity, clap::Error> {
        let Self { derivative, is_magnitude } = *self;
        let option = arg.and_then(Arg::get_long).unwrap_or_default().to_owned();
        let read = move |text: &str| {
            let (value, motion) = axis_quantity(derivative, None, text).map_err(|error| error.message)?;
            if is_magnitude && value < 0.0 {
                return Err("it is a magnitude: write it without a sign".to_owned());
            }
            Ok(AxisQuantity { option: option.clone(), text: text.to_owned(), derivative, value, motion })
        };
        read.parse_ref(command, arg, value)
    }
}

/// Counts of the drive and the distance on the axis that they span.
#[derive(Debug, Clone)]
pub(crate) struct Counts {
    drive: f64,
    axis: AxisQuantity,
}

impl Counts {
    /// Counts as a table uses them.
    pub(super) fn of_axis(&self) -> servobench_scenario::Counts {
        servobench_scenario::Counts { per: self.drive / self.axis.value, motion: self.axis.motion }
    }
}

/// Reads [`Counts`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct CountsParser;

pub(super) const COUNTS: CountsParser = CountsParser;

impl TypedValueParser for CountsParser {
    type Value = Counts;

    fn parse_ref(&self, command: &Command, arg: Option<&Arg>, value: &OsStr) -> Result<Counts, clap::Error> {
        let option = arg.and_then(Arg::get_long).unwrap_or_default().to_owned();
        let read = move |text: &str| {
            let like = "write counts and what they are of the axis, as \"1048576/rev\" or \"10000/5 mm\"";
            let (drive, axis) = text.split_once('/').ok_or(like)?;
            let drive: f64 = drive.trim().parse().map_err(|_| like)?;
            if !drive.is_normal() {
                return Err("the number of counts must be finite and not 0".to_owned());
            }
            let axis = axis.trim();
            let is_number = axis.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-'));
            let text = if is_number { axis.to_owned() } else { format!("1 {axis}") };
            let derivative = Derivative::Position;
            let (value, motion) = axis_quantity(derivative, None, &text).map_err(|error| error.message)?;
            if value == 0.0 {
                return Err("counts of no way mean nothing: write what they are of the axis".to_owned());
            }
            Ok(Counts { drive, axis: AxisQuantity { option: option.clone(), text, derivative, value, motion } })
        };
        read.parse_ref(command, arg, value)
    }
}

/// A time (s), as "1 ms".
pub(super) fn time(text: &str) -> Result<f64, String> {
    servobench_scenario::time(text.trim()).map_err(|error| error.message)
}

/// A time above zero (s).
pub(super) fn positive_time(text: &str) -> Result<f64, String> {
    let value = time(text)?;
    if value > 0.0 { Ok(value) } else { Err("it must be greater than 0, as \"1 ms\"".into()) }
}

/// A frequency (Hz), as "12 Hz".
pub(super) fn frequency(text: &str) -> Result<f64, String> {
    servobench_scenario::frequency(text).map_err(|error| error.message)
}

/// A pure number, as "0.02" or "2 %".
pub(super) fn ratio(text: &str) -> Result<f64, String> {
    servobench_scenario::ratio(text).map_err(|error| error.message)
}

/// A number of percent, with its sign or without.
pub(super) fn percent(text: &str) -> Result<f64, String> {
    let number = text.trim().trim_end_matches('%').trim_end().parse().ok();
    number.filter(|number: &f64| number.is_finite()).ok_or_else(|| "write a number of percent, as 25".into())
}

/// The axis of a plan, as its quantities describe it, and their mistakes.
#[derive(Debug, Default)]
pub(super) struct Axis {
    /// Taken from the first quantity.
    pub(super) motion: Option<Coordinate>,
    pub(super) units: Vec<GivenUnit>,
    pub(super) mistakes: Vec<PlanMistake>,
}

/// A quantity whose unit the plan uses for a derivative of position.
#[derive(Debug)]
pub(super) struct GivenUnit {
    /// 0 for position.
    pub(super) derivative: usize,
    /// As it is written.
    pub(super) text: String,
    /// The same in SI.
    pub(super) value: f64,
}

impl Axis {
    /// The value (SI) of `quantity`; its unit becomes that of its derivative in the plan, unless an earlier one has set it.
    pub(super) fn si(&mut self, quantity: &AxisQuantity) -> f64 {
        self.tell_in(quantity.derivative, &quantity.text, quantity.value);
        self.value(quantity)
    }

    /// The same for an optional quantity.
    pub(super) fn optional(&mut self, quantity: Option<&AxisQuantity>) -> Option<f64> {
        quantity.map(|quantity| self.si(quantity))
    }

    /// The value (SI) of `quantity`, without using its unit for the plan.
    pub(super) fn value(&mut self, quantity: &AxisQuantity) -> f64 {
        let motion = *self.motion.get_or_insert(quantity.motion);
        if let Err(error) = axis_quantity(quantity.derivative, Some(motion), &quantity.text) {
            self.mistakes.push(PlanMistake::OtherAxis { option: quantity.option.clone(), error });
        }
        quantity.value
    }

    /// Counts in a metre or radian.
    pub(super) fn counts(&mut self, counts: &Counts) -> f64 {
        counts.drive / self.value(&counts.axis)
    }

    /// Sets the unit of `derivative` in the plan to that of `text`, whose value is `value` (SI), unless it has one.
    pub(super) fn tell_in(&mut self, derivative: Derivative, text: &str, value: f64) {
        let derivative = match derivative {
            Derivative::Position => 0,
            Derivative::Velocity => 1,
            Derivative::Acceleration => 2,
            Derivative::Jerk => 3,
            Derivative::Snap => 4,
        };
        if value != 0.0 && self.units.iter().all(|other| other.derivative != derivative) {
            self.units.push(GivenUnit { derivative, text: text.to_owned(), value });
        }
    }
}
