//! Which channels are plotted together, under which name.
use crate::style::{self, Rgb};

/// Page of the blueprint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Page {
    /// Left column of the first page, under the 3D view.
    Motion,
    /// Right column of the first page.
    Errors,
    /// What was asked for.
    SetPoint,
    /// Motor and inverter.
    Electrical,
}

/// One curve of a plot.
#[derive(Debug)]
pub(crate) struct Curve {
    /// Channels that can feed it; the first that was recorded does.
    pub(crate) channels: &'static [&'static str],
    /// Name in the legend and last part of the entity path.
    pub(crate) name: &'static str,
    /// Colour when one run is shown.
    pub(crate) colour: Rgb,
    /// Line width (points).
    pub(crate) width: f32,
}

/// One plot.
#[derive(Debug)]
pub(crate) struct Plot {
    /// Name in the view's title.
    pub(crate) title: &'static str,
    /// First part of the entity path.
    pub(crate) path: &'static str,
    /// Where it stands.
    pub(crate) page: Page,
    /// Its curves, the one that a comparison shows first: the first of them that was recorded.
    pub(crate) curves: &'static [Curve],
}

/// Name of a curve that bounds the others.
pub(crate) const BOUND: &str = "limit";

const fn curve(channels: &'static [&'static str], name: &'static str, colour: Rgb, width: f32) -> Curve {
    Curve { channels, name, colour, width }
}

// Curves of one plot often coincide. What is drawn later is thinner, so that all of them can be seen.
const WIDE: f32 = 4.0;
const MIDDLE: f32 = 2.0;
const THIN: f32 = 1.0;

/// All plots in the order of the page.
pub(crate) const PLOTS: &[Plot] = &[
    Plot {
        title: "Position",
        path: "position",
        page: Page::Motion,
        curves: &[
            curve(&["load.position"], "load", style::LOAD, WIDE),
            curve(&["motor.position"], "motor", style::MOTOR, MIDDLE),
            curve(&["table.position"], "table", style::TABLE, MIDDLE),
            curve(&["reference.position", "setpoint.position"], "reference", style::REFERENCE, THIN),
        ],
    },
    Plot {
        title: "Velocity",
        path: "velocity",
        page: Page::Motion,
        curves: &[
            curve(&["load.velocity"], "load", style::LOAD, WIDE),
            curve(&["motor.velocity"], "motor", style::MOTOR, MIDDLE),
            curve(&["velocity.reference", "setpoint.velocity"], "reference", style::REFERENCE, THIN),
        ],
    },
    Plot {
        title: "Following error",
        path: "following_error",
        page: Page::Errors,
        curves: &[
            curve(&["following_error.load"], "load", style::LOAD, MIDDLE),
            curve(&["following_error.motor"], "motor", style::MOTOR, MIDDLE),
        ],
    },
    Plot {
        title: "Effort of the motor",
        path: "effort",
        page: Page::Errors,
        curves: &[
            curve(&["effort.motor"], "motor", style::MOTOR, MIDDLE),
            curve(&["effort.reference"], "reference", style::REFERENCE, THIN),
        ],
    },
    Plot {
        title: "Current",
        path: "current",
        page: Page::Errors,
        curves: &[
            curve(&["current.q"], "q", style::MOTOR, MIDDLE),
            curve(&["current.d"], "d", style::AUXILIARY, MIDDLE),
            curve(&["current.q_reference"], "q reference", style::REFERENCE, THIN),
        ],
    },
    Plot {
        title: "Output of the drive",
        path: "output",
        page: Page::Errors,
        curves: &[curve(&["command.output"], "output", style::MOTOR, MIDDLE)],
    },
    Plot {
        title: "Set-point velocity",
        path: "setpoint_velocity",
        page: Page::SetPoint,
        curves: &[curve(&["setpoint.velocity"], "velocity", style::REFERENCE, MIDDLE)],
    },
    Plot {
        title: "Set-point acceleration",
        path: "setpoint_acceleration",
        page: Page::SetPoint,
        curves: &[curve(&["setpoint.acceleration"], "acceleration", style::MOTOR, MIDDLE)],
    },
    Plot {
        title: "Set-point jerk",
        path: "setpoint_jerk",
        page: Page::SetPoint,
        curves: &[curve(&["setpoint.jerk"], "jerk", style::TABLE, MIDDLE)],
    },
    Plot {
        title: "Set-point snap",
        path: "setpoint_snap",
        page: Page::SetPoint,
        curves: &[curve(&["setpoint.snap"], "snap", style::AUXILIARY, MIDDLE)],
    },
    Plot {
        title: "Voltage",
        path: "voltage",
        page: Page::Electrical,
        curves: &[
            curve(&["voltage.magnitude"], "magnitude", style::TABLE, MIDDLE),
            curve(&["voltage.q"], "q", style::MOTOR, MIDDLE),
            curve(&["voltage.d"], "d", style::AUXILIARY, MIDDLE),
            curve(&["voltage.limit"], BOUND, style::LIMIT, THIN),
        ],
    },
    Plot {
        title: "Saturated share of control ticks",
        path: "saturation",
        page: Page::Electrical,
        curves: &[
            curve(&["saturation.current"], "current", style::LOAD, MIDDLE),
            curve(&["saturation.voltage"], "voltage", style::MOTOR, MIDDLE),
        ],
    },
];
