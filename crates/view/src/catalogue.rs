//! Channels that are plotted together, and the names of plots and curves.
use crate::style::{self, Rgb};
use servobench_signals::Signal;

/// Page of the blueprint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Page {
    /// Left column of the first page, under the 3D view.
    Motion,
    /// Right column of the first page.
    Errors,
    /// The set-point.
    SetPoint,
    /// Currents, voltages and powers of the drive.
    Electrical,
    /// Channels that the catalogue does not name.
    Other,
}

/// One curve of a plot.
#[derive(Debug)]
pub(crate) struct Curve {
    /// Channels that can feed it; the first recorded one is used.
    pub(crate) channels: &'static [&'static str],
    /// Name in the legend and last part of the entity path.
    pub(crate) name: &'static str,
    /// Colour when one run is shown.
    pub(crate) colour: Rgb,
    /// Line width (points).
    pub(crate) width: f32,
}

/// Number in a title, computed from the curves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Headline {
    /// Nothing.
    None,
    /// Largest magnitude.
    Peak,
    /// Largest minus smallest value.
    PeakToPeak,
}

impl Headline {
    /// The number for a curve from `low` to `high`.
    pub(crate) fn of(self, (low, high): (f64, f64)) -> f64 {
        match self {
            Self::PeakToPeak => high - low,
            Self::None | Self::Peak => high.max(-low),
        }
    }
}

/// One plot.
#[derive(Debug)]
pub(crate) struct Plot {
    /// Name in the view's title.
    pub(crate) title: &'static str,
    /// Name when the values are forces, where it is another.
    pub(crate) linear_title: Option<&'static str>,
    /// First part of the entity path. A channel that no plot names, but whose name begins with it, is shown here too.
    pub(crate) path: &'static str,
    /// Page of the blueprint.
    pub(crate) page: Page,
    /// Number of the first curve in the title.
    pub(crate) headline: Headline,
    /// True if currents and voltages are amplitudes.
    pub(crate) amplitude: bool,
    /// Values that the axis always includes (SI).
    pub(crate) includes: &'static [f64],
    /// True if a value holds until the next one: a staircase.
    pub(crate) held: bool,
    /// True if it is left out where only zeros were recorded.
    pub(crate) needs_a_value: bool,
    /// Derivative of the position whose limit in the plan bounds it, 0 for velocity.
    pub(crate) derivative: Option<usize>,
    /// Its curves; a comparison shows only the first recorded one.
    pub(crate) curves: &'static [Curve],
}

/// Name of a curve that bounds the others.
pub(crate) const BOUND: &str = "limit";

const fn curve(channels: &'static [&'static str], name: &'static str, colour: Rgb, width: f32) -> Curve {
    Curve { channels, name, colour, width }
}

/// A plot with the usual properties; the others override them.
const PLAIN: Plot = Plot {
    title: "",
    linear_title: None,
    path: "",
    page: Page::Errors,
    headline: Headline::Peak,
    amplitude: false,
    includes: &[0.0],
    held: false,
    needs_a_value: false,
    derivative: None,
    curves: &[],
};

// Curves of one plot often coincide. Rerun draws them in the alphabetical order of their paths: later ones are thinner, so that all of them
// can be seen.
const WIDEST: f32 = 5.0;
const WIDE: f32 = 3.5;
const BROAD: f32 = 2.75;
const MIDDLE: f32 = 2.0;
const SLIM: f32 = 1.5;
const THIN: f32 = 1.0;

/// All plots in the order of the page.
pub(crate) const PLOTS: &[Plot] = &[
    Plot {
        title: "Position",
        path: "position",
        page: Page::Motion,
        headline: Headline::None,
        includes: &[],
        curves: &[
            curve(&[Signal::LoadPosition.name()], "load", style::LOAD, WIDEST),
            curve(&[Signal::MotorPosition.name()], "motor", style::MOTOR, WIDE),
            curve(&[Signal::TablePosition.name()], "table", style::TABLE, THIN),
            curve(&[Signal::MeasuredLoadPosition.name()], "load as measured", style::DISTURBANCE, SLIM),
            curve(&[Signal::MeasuredMotorPosition.name()], "motor as measured", style::AUXILIARY, SLIM),
            curve(
                &[Signal::ReferencePosition.name(), Signal::SetpointPosition.name()],
                "reference",
                style::REFERENCE,
                MIDDLE,
            ),
            curve(&[Signal::RequestPosition.name()], "request", style::REQUEST, THIN),
        ],
        ..PLAIN
    },
    Plot {
        title: "Velocity",
        path: "velocity",
        page: Page::Motion,
        curves: &[
            curve(&[Signal::LoadVelocity.name()], "load", style::LOAD, WIDEST),
            curve(&[Signal::MotorVelocity.name()], "motor", style::MOTOR, WIDE),
            curve(&[Signal::MeasuredMotorVelocity.name()], "motor as measured", style::AUXILIARY, SLIM),
            curve(&[Signal::TableVelocity.name()], "table", style::TABLE, THIN),
            curve(
                &[Signal::VelocityReference.name(), Signal::SetpointVelocity.name()],
                "reference",
                style::REFERENCE,
                MIDDLE,
            ),
            curve(&[Signal::RequestVelocity.name()], "request", style::REQUEST, THIN),
        ],
        ..PLAIN
    },
    Plot {
        title: "Following error",
        path: "following_error",
        curves: &[
            curve(&[Signal::FollowingErrorLoad.name()], "load", style::LOAD, MIDDLE),
            curve(&[Signal::FollowingErrorMotor.name()], "motor", style::MOTOR, MIDDLE),
        ],
        ..PLAIN
    },
    Plot {
        title: "Disturbance on the load",
        path: "load_disturbance",
        held: true,
        needs_a_value: true,
        curves: &[curve(&[Signal::DisturbanceLoad.name()], "load", style::DISTURBANCE, MIDDLE)],
        ..PLAIN
    },
    Plot {
        title: "End stops on the load",
        path: "end_stops",
        held: true,
        needs_a_value: true,
        curves: &[curve(&[Signal::EffortEndStop.name()], "load", style::DISTURBANCE, MIDDLE)],
        ..PLAIN
    },
    Plot {
        title: "Disturbance on the motor",
        path: "motor_disturbance",
        held: true,
        needs_a_value: true,
        curves: &[curve(&[Signal::DisturbanceMotor.name()], "motor", style::DISTURBANCE, MIDDLE)],
        ..PLAIN
    },
    Plot {
        title: "Motor torque",
        linear_title: Some("Motor force"),
        path: "effort",
        curves: &[
            curve(&[Signal::EffortMotor.name()], "motor", style::MOTOR, WIDE),
            curve(&[Signal::EffortReference.name()], "reference", style::REFERENCE, THIN),
            curve(&[Signal::RequestEffort.name()], "request", style::REQUEST, THIN),
        ],
        ..PLAIN
    },
    Plot {
        title: "Current",
        path: "current",
        page: Page::Electrical,
        amplitude: true,
        curves: &[
            curve(&[Signal::CurrentQ.name()], "q", style::MOTOR, WIDE),
            curve(&[Signal::CurrentD.name()], "d", style::AUXILIARY, MIDDLE),
            curve(&[Signal::CurrentQReference.name()], "q reference", style::REFERENCE, THIN),
            curve(&[Signal::CurrentPeak.name()], "largest in a tick", style::MARK, THIN),
            curve(&[Signal::CurrentRms.name()], "RMS of a phase in a tick", style::AUXILIARY, THIN),
        ],
        ..PLAIN
    },
    Plot {
        title: "Output of the drive",
        path: "output",
        page: Page::Electrical,
        curves: &[curve(&[Signal::CommandOutput.name()], "output", style::MOTOR, MIDDLE)],
        ..PLAIN
    },
    // The path of the set-point: from the motion task over the bus to the motor's reference, and the output and input of the master.
    Plot {
        title: "Set-point position",
        path: "setpoint_position",
        page: Page::SetPoint,
        headline: Headline::None,
        includes: &[],
        curves: &[
            curve(&[Signal::SetpointPosition.name()], "set-point", style::REFERENCE, THIN),
            curve(&[Signal::ReferenceMotorPosition.name()], "motor reference", style::MOTOR, MIDDLE),
            curve(&[Signal::TaskPosition.name()], "motion task", style::TABLE, WIDE),
            curve(&[Signal::BusPosition.name()], "master reads", style::AUXILIARY, WIDEST),
            curve(&[Signal::LinkPosition.name()], "put out by the master", style::LOAD, SLIM),
        ],
        ..PLAIN
    },
    Plot {
        title: "Set-point velocity",
        path: "setpoint_velocity",
        derivative: Some(0),
        page: Page::SetPoint,
        curves: &[
            curve(&[Signal::SetpointVelocity.name()], "set-point", style::REFERENCE, MIDDLE),
            curve(&[Signal::TaskVelocity.name()], "motion task", style::TABLE, WIDE),
            curve(&[Signal::LinkVelocity.name()], "put out by the master", style::LOAD, BROAD),
        ],
        ..PLAIN
    },
    Plot {
        title: "Set-point acceleration",
        path: "setpoint_acceleration",
        derivative: Some(1),
        page: Page::SetPoint,
        curves: &[
            curve(&[Signal::SetpointAcceleration.name()], "acceleration", style::MOTOR, MIDDLE),
            curve(&[Signal::LinkAcceleration.name()], "put out by the master", style::LOAD, THIN),
        ],
        ..PLAIN
    },
    Plot {
        title: "Set-point jerk",
        path: "setpoint_jerk",
        held: true,
        derivative: Some(2),
        page: Page::SetPoint,
        curves: &[curve(&[Signal::SetpointJerk.name()], "jerk", style::TABLE, MIDDLE)],
        ..PLAIN
    },
    Plot {
        title: "Set-point snap",
        path: "setpoint_snap",
        held: true,
        derivative: Some(3),
        page: Page::SetPoint,
        curves: &[curve(&[Signal::SetpointSnap.name()], "snap", style::AUXILIARY, MIDDLE)],
        ..PLAIN
    },
    Plot {
        title: "Torque of the master",
        linear_title: Some("Force of the master"),
        path: "setpoint_effort",
        page: Page::SetPoint,
        needs_a_value: true,
        held: true,
        curves: &[curve(&[Signal::LinkEffort.name()], "put out by the master", style::LOAD, MIDDLE)],
        ..PLAIN
    },
    Plot {
        title: "Voltage",
        path: "voltage",
        amplitude: true,
        page: Page::Electrical,
        curves: &[
            curve(&[Signal::VoltageQ.name()], "q", style::MOTOR, WIDE),
            curve(&[Signal::VoltageD.name()], "d", style::AUXILIARY, WIDE),
            curve(&[Signal::VoltageQReference.name()], "q reference", style::REFERENCE, THIN),
            curve(&[Signal::VoltageDReference.name()], "d reference", style::DISTURBANCE, THIN),
        ],
        ..PLAIN
    },
    // A magnitude is never negative: its axis begins at 0.
    Plot {
        title: "Voltage magnitude",
        path: "voltage_magnitude",
        amplitude: true,
        page: Page::Electrical,
        curves: &[
            curve(&[Signal::VoltageMagnitude.name()], "applied", style::TABLE, MIDDLE),
            curve(&["voltage.limit"], BOUND, style::LIMIT, THIN),
        ],
        ..PLAIN
    },
    Plot {
        title: "Power",
        path: "power",
        page: Page::Electrical,
        curves: &[
            curve(&[Signal::PowerElectrical.name()], "electrical", style::MOTOR, WIDE),
            curve(&[Signal::PowerAirGap.name()], "air gap", style::TABLE, WIDEST),
            curve(&[Signal::PowerShaft.name()], "shaft", style::LOAD, THIN),
            curve(&[Signal::PowerCopper.name()], "copper", style::DISTURBANCE, MIDDLE),
            curve(&[Signal::PowerIron.name()], "iron", style::IRON, THIN),
            curve(&[Signal::PowerStored.name()], "stored", style::AUXILIARY, THIN),
            curve(&[Signal::PowerResidual.name()], "residual", style::REFERENCE, MIDDLE),
            curve(&[Signal::PowerInverter.name()], "inverter", style::MARK, THIN),
        ],
        ..PLAIN
    },
    Plot {
        title: "DC link",
        path: "dc_link",
        page: Page::Electrical,
        includes: &[],
        curves: &[curve(&[Signal::VoltageDcLink.name()], "voltage", style::MOTOR, WIDE)],
        ..PLAIN
    },
    Plot {
        title: "Power of the DC link",
        path: "dc_link_power",
        page: Page::Electrical,
        curves: &[
            curve(&[Signal::PowerMains.name()], "from the mains", style::MOTOR, WIDE),
            curve(&[Signal::PowerBrake.name()], "brake resistor", style::LOAD, THIN),
        ],
        ..PLAIN
    },
    Plot {
        title: "Temperature",
        path: "temperature",
        page: Page::Electrical,
        includes: &[],
        curves: &[
            curve(&[Signal::TemperatureWinding.name()], "winding", style::LOAD, WIDE),
            curve(&[Signal::TemperatureHousing.name()], "housing", style::MOTOR, THIN),
        ],
        ..PLAIN
    },
    Plot {
        title: "Current as it is measured",
        path: "measured_current",
        amplitude: true,
        page: Page::Electrical,
        curves: &[
            curve(&[Signal::MeasuredCurrentQ.name()], "q", style::MOTOR, WIDE),
            curve(&[Signal::MeasuredCurrentD.name()], "d", style::AUXILIARY, THIN),
        ],
        ..PLAIN
    },
];
