//! Mistakes in a requested move that the parser of the command line cannot find.
use servobench_motion::PlanError;
use servobench_report::{ReportError, Unsent};
use servobench_scenario::{ArgumentError, PointsError};
use std::fmt;
use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// A mistake, with its option and the remedy.
#[derive(Debug, Error)]
pub(crate) enum PlanMistake {
    /// A linear quantity on a rotary axis, or the other way round.
    #[error("--{option} {error}")]
    OtherAxis { option: String, error: ArgumentError },
    /// A derivative at the start that may jump at this order.
    #[error(
        "--{option} is not used by a move of order {order}, whose {quantity} may jump: leave it out, or choose --order \
         {lowest}"
    )]
    Jumps { option: &'static str, quantity: &'static str, order: usize, lowest: usize },
    /// A move from a state of motion has no samples.
    #[error(
        "--sample-time is not used by a move from a state of motion: leave it out; --csv-step says how far the rows of a \
         table are apart"
    )]
    NotSampled,
    #[error("--sampling is for --method published: the shortest move has the fewest samples of all; leave it out")]
    SamplingOfTheShortest,
    #[error("--shape trapezoid takes all of --maximum-jerk: choose s-curve, or leave the other jerks out")]
    JerkOfTrapezoid,
    #[error("--jerk is missing: or --jerk-percent-of-time, or another way to say it: an S-curve needs one")]
    NoJerk,
    #[error("--maximum-jerk is missing: {why}, as \"1000 m/s3\"")]
    NoMaximumJerk { why: &'static str },
    #[error("--master-speed is not used: no jerk is given in master units; leave it out")]
    UnusedMasterSpeed,
    #[error("--maximum-jerk is not used: no jerk of this S-curve is a part of it; leave it out")]
    UnusedMaximumJerk,
    #[error("--plateau auto is chosen by limits: give --velocity and --acceleration, as \"0.5 m/s\" and \"5 m/s2\"")]
    NoLimits,
    #[error("--velocity and --acceleration choose the share of --plateau auto: choose that, or leave them out")]
    UnusedLimits,
    #[error("--passes are those of --velocities smooth: choose that, or leave them out")]
    PassesOfOthers,
    #[error("--shaper-tolerable is for the EI shapers: the others leave nothing at the frequency")]
    TolerableOfOthers,
    #[error("--shaper-frequency has {frequencies} values and --shaper {shapers}: give a frequency for each shaper")]
    Frequencies { frequencies: usize, shapers: usize },
    #[error("--{option} has {values} values for {count} {what}: give one for all, or one for each")]
    OtherCount { option: &'static str, values: usize, count: usize, what: &'static str },
    #[error("--shaper: {0}")]
    Shaper(PlanError),
    #[error("--points: cannot read `{}`: {error}", .file.display())]
    Unreadable { file: PathBuf, error: io::Error },
    #[error("{}:{error}", .file.display())]
    Points { file: PathBuf, error: PointsError },
    /// Refusal by the planner.
    #[error("{}", ByOptions(.0))]
    Refused(PlanError),
    #[error("--words: {0}")]
    Unsent(Unsent),
    #[error("--csv would write {0}")]
    TooManyRows(ReportError),
    #[error("--from, --to: {0}")]
    NotDrawn(ReportError),
}

/// A planner's error with options in place of the fields of its request.
struct ByOptions<'a>(&'a PlanError);

impl fmt::Display for ByOptions<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            PlanError::Parameter(error) => {
                write!(f, "{} must be {}, got {}", option(error.name), error.bound, error.value)
            }
            PlanError::OutOfRange { name, value, lowest, highest, remedy } => {
                let name = option(name);
                write!(f, "{name} must be between {lowest:e} and {highest:e} (SI), got {value:e}: {remedy}")
            }
            PlanError::TooShort { duration, shortest } => write!(
                f,
                "--duration must be at least {shortest} s, got {duration} s: stretch to a longer time or raise the limits"
            ),
            other => other.fmt(f),
        }
    }
}

/// Fields of a request whose options have other names.
const FIELDS: [(&str, &str); 14] = [
    ("alpha", "plateau"),
    ("rate", "command-rate"),
    ("allowed", "allowed-error"),
    ("speed", "velocity"),
    ("target.x", "distance"),
    ("target.v", "end-velocity"),
    ("from.x", "start-position"),
    ("from.v", "start-velocity"),
    ("from.a", "start-acceleration"),
    ("from.j", "start-jerk"),
    ("velocity.above", "velocity"),
    ("velocity.below", "negative-velocity"),
    ("acceleration.above", "acceleration"),
    ("acceleration.below", "negative-acceleration"),
];

/// The option of a field of a request.
fn option(field: &str) -> String {
    let named = FIELDS.iter().find(|(other, _)| *other == field);
    format!("--{}", named.map_or_else(|| field.replace('_', "-"), |(_, option)| (*option).to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_base::ParamError;

    #[test]
    fn a_planner_speaks_of_options() {
        let refused = |name| {
            let error = ParamError { name, value: 2.0, bound: "above 0" };
            PlanMistake::Refused(error.into()).to_string()
        };
        assert_eq!(refused("alpha"), "--plateau must be above 0, got 2");
        assert_eq!(refused("sample_time"), "--sample-time must be above 0, got 2");
        let other = PlanError::TooFewPoints { points: 1 };
        assert_eq!(PlanMistake::Refused(other).to_string(), other.to_string());
    }
}
