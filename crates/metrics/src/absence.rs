//! Why a metric has no value.
use crate::quantity::Quantity;
use servobench_signals::{Presence, Signal, Unit};
use thiserror::Error;

/// Reasons why a metric has no value. An absent value is never zero.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Absence {
    /// The recording lacks a channel.
    #[error("`{channel}` is not recorded{}", only_where(*channel))]
    NoChannel {
        /// Missing channel.
        channel: Signal,
    },
    /// A channel holds something that is not a number.
    #[error("`{channel}` is not finite at {time} s")]
    NotFinite {
        /// The channel.
        channel: Signal,
        /// First instant at which it is not finite (s).
        time: f64,
    },
    /// The values are finite, but a result computed from them is not.
    #[error("the values are too large to compute with")]
    Overflow,
    /// The metric needs a move, and there is none.
    #[error("the program has no move")]
    NoMove,
    /// The recording has no instant in the part that the metric covers.
    #[error("nothing was recorded {part}")]
    NothingRecorded {
        /// The part, in words.
        part: &'static str,
    },
    /// The run or the pause is too short for a metric of the time after a profile.
    #[error(
        "the load is recorded for {} at rest; this metric needs {}, two periods of its slowest mode and 20 rows",
        Quantity::new(*rest, "s"), Quantity::new(*needed, "s")
    )]
    RestTooShort {
        /// Duration of the recorded rest (s).
        rest: f64,
        /// Minimum duration (s).
        needed: f64,
    },
    /// Rows, each for many ticks, are too far apart.
    #[error(
        "rows at {} are too few to measure: {} at least, or so few channels that every tick has memory for them",
        Quantity::new(*rate, "Hz"), Quantity::new(*needed, "Hz")
    )]
    TooFewRows {
        /// Rate of the rows (Hz).
        rate: f64,
        /// Lowest rate (Hz).
        needed: f64,
    },
    /// A load that never moves is inside the window.
    #[error(
        "the window of ±{} is as large as the distance of `{label}`, {}: a load that never moved would be inside",
        Quantity::new(*window, unit), Quantity::new(*distance, unit)
    )]
    WindowIsTheWay {
        /// Label of the move.
        label: String,
        /// Window (axis unit).
        window: f64,
        /// Distance of the move (axis unit).
        distance: f64,
        /// Axis unit.
        unit: String,
    },
    /// The settling time needs a window.
    #[error("no settling window is given")]
    NoWindow,
    /// The load was outside its window when the recording ended, or shortly before.
    #[error(
        "`{label}` has not settled: the load left its window of ±{} again {} after the profile, of {} recorded",
        Quantity::new(*window, unit), Quantity::new(*exit, "s"), Quantity::new(*watched, "s")
    )]
    NotSettled {
        /// Label of the move.
        label: String,
        /// Window (axis unit).
        window: f64,
        /// Axis unit.
        unit: String,
        /// Last instant at which the load was seen outside, after the profile (s).
        exit: f64,
        /// Recorded time after the profile (s).
        watched: f64,
    },
    /// The last move ends in motion, or another move took over: there is no last target.
    #[error("`{label}`, the last move, does not end at rest")]
    NoLastTarget {
        /// Label of the move.
        label: String,
    },
    /// No move reaches constant velocity.
    #[error("no move has a part at constant velocity")]
    NoCruise,
    /// No move is limited in this derivative.
    #[error("no set-point is planned with a limit of {derivative}")]
    NoLimit {
        /// `velocity`, `acceleration`, `jerk`, `snap`.
        derivative: &'static str,
    },
    /// A limit is given for a derivative that the profile does not bound.
    #[error("the {derivative} of `{label}` is not bounded")]
    Unbounded {
        /// `velocity`, `acceleration`, `jerk`, `snap`.
        derivative: &'static str,
        /// Label of the move.
        label: String,
    },
    /// Two channels that belong together have different units.
    #[error("`{one}` and `{two}` differ in unit")]
    UnitsDiffer {
        /// First channel.
        one: Signal,
        /// Second channel.
        two: Signal,
    },
    /// The load is at rest, or drifts without oscillating.
    #[error("the load does not oscillate")]
    NoVibration,
    /// The record holds too little of the oscillation.
    #[error("{periods:.1} periods were recorded; a mode needs {needed} at least")]
    TooShort {
        /// Periods in the record.
        periods: f64,
        /// Periods that are needed.
        needed: f64,
    },
    /// The motion is not a sum of decaying modes.
    #[error("decaying modes explain only {:.0} % of the motion after the profile", 100.0 * share)]
    NotModal {
        /// Share of the energy that the fitted modes explain, 0 to 1.
        share: f64,
    },
    /// The load holds still where a mode would move it: friction, not vibration.
    #[error("the load sticks and slips instead of oscillating")]
    Sticks,
    /// The drive does not follow points, so that no buffer could fail.
    #[error("the drive follows no points of a trajectory")]
    NoPoints,
    /// The metric needs a drive on a fieldbus.
    #[error("no fieldbus reports the limits of the drive")]
    NoBus,
    /// The scenario orders no fault on its bus.
    #[error("the scenario has no fault of the bus")]
    NoBusFault,
    /// No FMU beside the axis exchanges a continuous signal.
    #[error("no continuous signal is exchanged with an FMU, or too few times")]
    NotCoupled,
    /// The mode dies before it has shown enough periods.
    #[error("the mode is damped so strongly that {periods:.1} of its periods are visible; this needs {needed}")]
    Damped {
        /// Periods until its envelope has fallen to 5 %.
        periods: f64,
        /// Periods that are needed.
        needed: f64,
    },
    /// The motion swings, but no decaying mode could be fitted: its damping depends on its amplitude.
    #[error("amplitude-dependent: no decaying mode could be fitted to the motion after the profile")]
    AmplitudeDependent,
    /// Nothing oscillates at the frequency that the scenario gives for the mode.
    #[error("no mode within {} % of {}", 100.0 * share, Quantity::new(*frequency, "Hz"))]
    NotThere {
        /// Centre of the search (Hz).
        frequency: f64,
        /// Half width of the search, relative.
        share: f64,
    },
}

impl Absence {
    /// True if the axis only lacks equipment that few axes have, so that the absence needs no report unless the metric was requested.
    #[must_use]
    pub fn is_of_rare_equipment(&self) -> bool {
        match self {
            Self::NoChannel { channel } => matches!(
                channel.presence(),
                Presence::WithInverter | Presence::WithLink | Presence::WithEndStops | Presence::WithThermalModel
            ),
            Self::NoPoints | Self::NoBus | Self::NoBusFault | Self::NotCoupled => true,
            _ => false,
        }
    }
}

/// Equipment that an axis must have for a signal, as the end of a message; empty for a signal of every axis.
fn only_where(signal: Signal) -> &'static str {
    match (signal.presence(), signal) {
        (Presence::WithCurrentLoop, Signal::SaturationVoltage) => "; only a PMSM has a voltage",
        (Presence::WithCurrentLoop, _) => "; only a PMSM has a current",
        (Presence::WithCurrents, _) => match signal.unit() {
            Unit::Ampere => "; only a PMSM has a current",
            Unit::Watt => "; only a PMSM has electrical power",
            _ => "; only a PMSM has a voltage",
        },
        (Presence::WithSwitching, _) => "; only an inverter that switches has ripple",
        (Presence::WithInverter, _) => "; only an inverter that is not ideal has losses",
        (Presence::WithLink, _) => "; only a link with a capacitor changes",
        (Presence::WithEndStops, _) => "; only an axis with end stops has it",
        (Presence::WithThermalModel, _) => "; only a motor with a thermal model warms up",
        _ => "",
    }
}
