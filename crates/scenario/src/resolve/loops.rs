//! `[drive.velocity]` and `[drive.position]`: the outer loops, with gains derived from bandwidths.
use crate::diagnostic::Report;
use crate::field::{Either, Reported, Slot};

use crate::file;
use crate::file::VelocityKind;
use crate::resolve::estimate::Belief;
use crate::resolve::motor::Motor;
use crate::resolve::{Alternative, need, one_of, task_rate};
use servobench_base::{Rate, RateError};
use servobench_drive::velocity;

/// A velocity loop.
pub(super) struct VelocityLoop {
    pub(super) rate: Rate,
    pub(super) params: velocity::Params,
    /// Time constant of the low-pass on the measured velocity (s).
    pub(super) filter_time: f64,
}

/// A position loop: its rate and gain, `K_v` (1/s).
pub(super) struct PositionLoop {
    pub(super) rate: Rate,
    pub(super) gain: f64,
}

/// Values from which the gains follow.
pub(super) struct Knowledge<'a> {
    pub(super) base_rate: Option<Rate>,
    pub(super) motor: Option<&'a Motor>,
    pub(super) belief: Option<&'a Belief>,
    /// Largest effort that the drive requests.
    pub(super) max_effort: Option<f64>,
    /// Effort per unit of output of an ideal source, as estimated by the drive.
    pub(super) gain: f64,
}

/// The velocity loop above a current loop of the rate `current`; `None` if there is none or it has a mistake.
pub(super) fn velocity(
    drive: &file::Drive,
    known: &Knowledge<'_>,
    current: Option<Rate>,
    is_used: bool,
    report: &mut Report,
) -> Option<VelocityLoop> {
    let Some(given) = drive.velocity.given() else {
        if is_used && matches!(drive.velocity, Slot::Absent) {
            report.missing("drive", "velocity", drive.span);
        }
        return None;
    };
    let path = "drive.velocity";
    need(&given.rate, path, "rate", given.span, report);
    let rate = outer_rate(&given.rate, known.base_rate, current.map(|rate| ("current", rate)), report);
    // Inertia at the motor as estimated by the drive, τ/α = r²·M.
    let known_inertia = known.belief.filter(|belief| belief.knows_inertia);
    let inertia = known_inertia.map(|belief| belief.estimate.inertia_at_the_motor());
    let gain = match one_of(&[("bandwidth", given.bandwidth.span()), ("gain", given.gain.span())], report) {
        Alternative::Use(0) => {
            if known.belief.is_some() && inertia.is_none() {
                let span = given.bandwidth.span().unwrap_or(given.span);
                let help = "give `motor_inertia` in `[drive.estimate]`, or `gain` here";
                report.error(span, "the inertia of this axis is unknown to the drive", help);
            }
            given.bandwidth.given().zip(inertia).map(|(omega, inertia)| omega * inertia)
        }
        Alternative::Use(_) => velocity_gain(&given.gain, known, report),
        Alternative::Contradiction => None,
        Alternative::None => {
            report.missing_with_help(path, "bandwidth", given.span, "or `gain`");
            None
        }
    };
    let filter_time = given.filter_time.optional().ok().map(|time| time.copied().unwrap_or_default());
    let integral_time = integral_time(given, gain.zip(inertia).map(|(gain, inertia)| gain / inertia), report);
    let params = velocity::Params { k_p: gain?, integral_time: integral_time.ok()?, max_effort: known.max_effort? };
    Some(VelocityLoop { rate: rate?, params, filter_time: filter_time? })
}

fn velocity_gain(gain: &Slot<Either>, known: &Knowledge<'_>, report: &mut Report) -> Option<f64> {
    let at = gain.at()?;
    match (at.value, known.motor?) {
        (Either::First(gain), _) => Some(gain),
        // For an amplifier in volts, the estimated force per volt converts to effort.
        (Either::Second(volts), Motor::IdealSource { .. }) => Some(volts * known.gain),
        (Either::Second(_), _) => {
            report.error(at.span, "a gain in volts belongs to an ideal source", "give torque per velocity");
            None
        }
    }
}

/// Integral time of a PI: as given, or 4/ω with the bandwidth `omega`; `None` for a P.
fn integral_time(given: &file::Velocity, omega: Option<f64>, report: &mut Report) -> Result<Option<f64>, Reported> {
    let kind = given.kind.optional()?.copied().unwrap_or(VelocityKind::Pi);
    let time = given.integral_time.optional()?.copied();
    match (kind, time, omega) {
        (VelocityKind::P, None, _) => Ok(None),
        (VelocityKind::P, Some(_), _) => {
            let span = given.integral_time.span().unwrap_or(given.span);
            report.error(span, "a P loop has no `integral_time`", "write `kind = \"pi\"` or leave it out");
            Err(Reported)
        }
        (VelocityKind::Pi, Some(time), _) => Ok(Some(time)),
        (VelocityKind::Pi, None, Some(omega)) => Ok(Some(4.0 / omega)),
        (VelocityKind::Pi, None, None) => {
            // With a bandwidth, the missing inertia has already been reported.
            if given.gain.given().is_some() {
                let help = "it cannot be derived: the inertia of this axis is unknown to the drive";
                report.missing_with_help("drive.velocity", "integral_time", given.span, help);
            }
            Err(Reported)
        }
    }
}

/// The position loop above a velocity loop of the rate `velocity`; `None` if there is none or it has a mistake.
pub(super) fn position(
    drive: &file::Drive,
    base_rate: Option<Rate>,
    velocity: Option<Rate>,
    is_used: bool,
    report: &mut Report,
) -> Option<PositionLoop> {
    let Some(given) = drive.position.given() else {
        if is_used && matches!(drive.position, Slot::Absent) {
            report.missing("drive", "position", drive.span);
        }
        return None;
    };
    let path = "drive.position";
    need(&given.rate, path, "rate", given.span, report);
    let rate = outer_rate(&given.rate, base_rate, velocity.map(|rate| ("velocity", rate)), report);
    let gain = match one_of(&[("bandwidth", given.bandwidth.span()), ("gain", given.gain.span())], report) {
        Alternative::Use(0) => given.bandwidth.given().copied(),
        Alternative::Use(_) => given.gain.given().copied(),
        Alternative::Contradiction => None,
        Alternative::None => {
            report.missing_with_help(path, "bandwidth", given.span, "or `gain`");
            None
        }
    };
    Some(PositionLoop { rate: rate?, gain: gain? })
}

/// A rate of a loop that commands `inner`: each of its turns must coincide with one of `inner`.
fn outer_rate(
    slot: &Slot<Rate>,
    base_rate: Option<Rate>,
    inner: Option<(&str, Rate)>,
    report: &mut Report,
) -> Option<Rate> {
    let rate = task_rate(slot, base_rate, report)?;
    let Some((name, inner)) = inner else { return Some(rate) };
    let message = match inner.divider(rate) {
        Ok(_) => return Some(rate),
        Err(RateError::NotDividing { task, base, below, above }) => {
            format!("{task} Hz does not divide the rate of the {name} loop, {base} Hz; {below} Hz and {above} Hz do")
        }
        Err(_) => format!("{} Hz is faster than the {name} loop, {} Hz", rate.hertz(), inner.hertz()),
    };
    let help = format!("each turn hands its output to the {name} loop in the same tick");
    report.error(slot.span()?, message, help);
    None
}
