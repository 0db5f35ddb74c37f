//! The arguments of a plan, taken one by one: what is wrong with them and what nobody has taken is told in one go.
use crate::args::PlanArgs;
use crate::exit::CliError;
use servobench_base::Coordinate;
use servobench_scenario::{ArgumentError, Derivative, axis_quantity, frequency, ratio, time};
use std::collections::BTreeSet;

/// The arguments that not every family uses.
#[derive(Debug)]
pub(super) struct Arguments<'a> {
    /// Names without their dashes, and texts; empty for those that are choices.
    given: Vec<(&'static str, &'a str)>,
    taken: BTreeSet<&'static str>,
    mistakes: Vec<String>,
    /// Of the axis, as soon as a quantity says so.
    motion: Option<Coordinate>,
    units: Vec<Told>,
}

/// A quantity in whose unit a derivative of position is told.
#[derive(Debug)]
pub(super) struct Told {
    /// 0 for position.
    pub(super) derivative: usize,
    /// As it is written.
    pub(super) text: String,
    /// The same in SI.
    pub(super) value: f64,
}

/// How a flag is to be written that is not used, and where it is.
const ELSEWHERE: [(&[&str], &str); 6] = [
    (
        &["order", "snap", "method", "sampling", "execution", "online", "to-velocity", "end-velocity"],
        "or choose --profile point-to-point",
    ),
    (
        &[
            "start-position",
            "start-velocity",
            "start-acceleration",
            "start-jerk",
            "negative-velocity",
            "negative-acceleration",
        ],
        "or choose --profile point-to-point",
    ),
    (&["distance", "velocity", "acceleration", "jerk"], "the table says where the move goes"),
    (&["points", "velocities", "passes"], "or choose --profile pvt"),
    (&["plateau", "command-rate", "allowed-error", "command-cycle", "commands"], "or choose --profile position"),
    (&["sample-time"], "--csv-step says how far the rows of a table are apart"),
];

impl<'a> Arguments<'a> {
    pub(super) fn of(args: &'a PlanArgs) -> Self {
        let all = [
            ("distance", args.distance.as_deref()),
            ("velocity", args.velocity.as_deref()),
            ("acceleration", args.acceleration.as_deref()),
            ("jerk", args.jerk.as_deref()),
            ("snap", args.snap.as_deref()),
            ("duration", args.duration.as_deref()),
            ("order", args.order.map(|_| "")),
            ("method", args.method.map(|_| "")),
            ("sample-time", args.sample_time.as_deref()),
            ("sampling", args.sampling.map(|_| "")),
            ("execution", args.execution.map(|_| "")),
            ("online", args.online.map(|_| "")),
            ("start-position", args.start_position.as_deref()),
            ("start-velocity", args.start_velocity.as_deref()),
            ("start-acceleration", args.start_acceleration.as_deref()),
            ("start-jerk", args.start_jerk.as_deref()),
            ("end-velocity", args.end_velocity.as_deref()),
            ("to-velocity", args.to_velocity.as_deref()),
            ("negative-velocity", args.negative_velocity.as_deref()),
            ("negative-acceleration", args.negative_acceleration.as_deref()),
            ("shape", args.shape.map(|_| "")),
            ("deceleration", args.deceleration.as_deref()),
            ("jerk-percent-of-time", args.jerk_percent_of_time.as_deref()),
            ("jerk-percent-of-maximum", args.jerk_percent_of_maximum.as_deref()),
            ("deceleration-jerk", args.deceleration_jerk.as_deref()),
            ("deceleration-jerk-percent-of-time", args.deceleration_jerk_percent_of_time.as_deref()),
            ("deceleration-jerk-percent-of-maximum", args.deceleration_jerk_percent_of_maximum.as_deref()),
            ("maximum-jerk", args.maximum_jerk.as_deref()),
            ("points", args.points.as_ref().map(|_| "")),
            ("velocities", args.velocities.map(|_| "")),
            ("passes", args.passes.map(|_| "")),
            ("plateau", args.plateau.as_deref()),
            ("command-rate", args.command_rate.as_deref()),
            ("allowed-error", args.allowed_error.as_deref()),
            ("command-cycle", args.command_cycle.as_deref()),
            ("commands", args.commands.as_ref().map(|_| "")),
            ("shaper", args.shaper.map(|_| "")),
            ("shaper-frequency", args.shaper_frequency.as_deref()),
            ("shaper-damping", args.shaper_damping.as_deref()),
            ("shaper-tolerable", args.shaper_tolerable.as_deref()),
            ("averages", args.averages.as_deref()),
            ("csv-step", args.csv_step.as_deref()),
        ];
        let given = all.into_iter().filter_map(|(name, text)| Some((name, text?))).collect();
        Self { given, taken: BTreeSet::new(), mistakes: Vec::new(), motion: None, units: Vec::new() }
    }

    pub(super) fn is_given(&self, name: &str) -> bool {
        self.given.iter().any(|(given, _)| *given == name)
    }

    /// The text of an argument that is used; whether it is given, of a choice.
    pub(super) fn take(&mut self, name: &'static str) -> Option<&'a str> {
        self.taken.insert(name);
        self.given.iter().find(|(given, _)| *given == name).map(|(_, text)| *text)
    }

    pub(super) fn mistake(&mut self, message: impl Into<String>) {
        self.mistakes.push(message.into());
    }

    /// That the argument `name` is needed.
    pub(super) fn missing(&mut self, name: &str, why: &str) {
        self.mistake(format!("--{name} is missing: {why}"));
    }

    /// A quantity of the axis (SI).
    pub(super) fn axis(&mut self, name: &'static str, derivative: Derivative) -> Option<f64> {
        let text = self.take(name)?;
        let (value, motion) = self.unless(name, axis_quantity(derivative, self.motion, text))?;
        self.motion.get_or_insert(motion);
        self.tell_in(derivative, text, value);
        Some(value)
    }

    /// The same, which must be given.
    pub(super) fn needed_axis(&mut self, name: &'static str, derivative: Derivative, why: &str) -> Option<f64> {
        if !self.is_given(name) {
            self.missing(name, why);
        }
        self.axis(name, derivative)
    }

    /// The same as a magnitude.
    pub(super) fn magnitude(&mut self, name: &'static str, derivative: Derivative) -> Option<f64> {
        let value = self.axis(name, derivative)?;
        if value < 0.0 {
            self.mistake(format!("--{name} is a magnitude: write it without a sign"));
        }
        Some(value.abs())
    }

    /// A time (s).
    pub(super) fn time(&mut self, name: &'static str) -> Option<f64> {
        let text = self.take(name)?;
        self.unless(name, time(text))
    }

    /// A time above zero (s).
    pub(super) fn positive_time(&mut self, name: &'static str) -> Option<f64> {
        let value = self.time(name)?;
        if value <= 0.0 {
            self.mistake(format!("--{name} must be longer than nothing, as \"1 ms\""));
            return None;
        }
        Some(value)
    }

    /// Times (s), separated by commas.
    pub(super) fn times(&mut self, name: &'static str) -> Option<Vec<f64>> {
        let text = self.take(name)?;
        text.split(',').map(|one| self.unless(name, time(one.trim()))).collect()
    }

    /// A frequency (Hz).
    pub(super) fn frequency(&mut self, name: &'static str) -> Option<f64> {
        let text = self.take(name)?;
        self.unless(name, frequency(text))
    }

    /// A pure number.
    pub(super) fn ratio(&mut self, name: &'static str) -> Option<f64> {
        let text = self.take(name)?;
        self.unless(name, ratio(text))
    }

    /// A number of percent, with its sign or without.
    pub(super) fn percent(&mut self, name: &'static str) -> Option<f64> {
        let text = self.take(name)?;
        let number =
            text.trim().trim_end_matches('%').trim_end().parse::<f64>().ok().filter(|number| number.is_finite());
        if number.is_none() {
            self.mistake(format!("--{name} `{text}`: write a number of percent, as 25"));
        }
        number
    }

    /// Tells quantities of `derivative` in the unit of `text`, whose value is `value` (SI), unless it has a unit.
    pub(super) fn tell_in(&mut self, derivative: Derivative, text: &str, value: f64) {
        let derivative = match derivative {
            Derivative::Position => 0,
            Derivative::Velocity => 1,
            Derivative::Acceleration => 2,
            Derivative::Jerk => 3,
            Derivative::Snap => 4,
        };
        if value != 0.0 && self.units.iter().all(|other| other.derivative != derivative) {
            self.units.push(Told { derivative, text: text.to_owned(), value });
        }
    }

    pub(super) const fn set_motion(&mut self, motion: Coordinate) {
        self.motion = Some(motion);
    }

    pub(super) const fn motion(&self) -> Option<Coordinate> {
        self.motion
    }

    /// The value of the argument `name`, unless it is wrong.
    fn unless<T>(&mut self, name: &str, value: Result<T, ArgumentError>) -> Option<T> {
        value.map_err(|error| self.mistakes.push(format!("--{name} {error}"))).ok()
    }

    /// The motion of the axis and the units in which it is told, if nothing is wrong and everything has been taken.
    pub(super) fn finish(mut self) -> Result<(Option<Coordinate>, Vec<Told>), CliError> {
        for (name, _) in self.given.iter().filter(|(name, _)| !self.taken.contains(name)) {
            let elsewhere = ELSEWHERE.iter().find(|(names, _)| names.contains(name));
            let help = elsewhere.map_or("or choose --profile rockwell", |(_, help)| help);
            self.mistakes
                .push(format!("--{name} is not used by this move: leave it out; {help}").replace("; or", ", or"));
        }
        if self.mistakes.is_empty() {
            Ok((self.motion, self.units))
        } else {
            Err(CliError::Input(self.mistakes.join("\n")))
        }
    }
}
