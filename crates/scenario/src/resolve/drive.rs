//! `[drive]`: loops, with gains derived from bandwidths.
use crate::diagnostic::Report;
use crate::field::{Either, Reported, Slot};
use crate::file;
use crate::file::{File, VelocityKind};
use crate::list::{AutoTime, Share};
use crate::resolve::estimate::{self, Belief};
use crate::resolve::motor::resolution;
use crate::resolve::{Way, need, one_way, task_rate};
use crate::scenario::{
    Axis, CurrentLoop, Drive, EffortFeedforward, Encoder, Feedback, Feedforward, Motor, PositionLoop, VelocityLoop,
};
use crate::source::Span;
use servobench_base::Rate;

/// The parts that are known by now.
pub(super) struct Known<'a> {
    pub(super) base_rate: Option<Rate>,
    pub(super) axis: Option<&'a Axis>,
    pub(super) motor: Option<&'a Motor>,
}

const NO_FEEDFORWARD: Feedforward =
    Feedforward { velocity: 0.0, effort: EffortFeedforward::Off, friction: false, delay: None };

pub(super) fn resolve(file: &File, known: &Known<'_>, report: &mut Report) -> Option<Drive> {
    let drive = match &file.drive {
        Slot::Absent => return absent(file, known, report),
        Slot::Wrong(_) => return None,
        Slot::Given(drive) => &drive.value,
    };
    let enabled = drive.enabled.given().copied().unwrap_or(true);
    let is_used = enabled && !matches!(known.motor, Some(Motor::Prescribed));
    let ideal = matches!(known.motor, Some(Motor::IdealSource(_)));

    let dc_link = dc_link(drive, known.motor, is_used, report);
    let max_effort = max_effort(drive, known.motor, report);
    let load_encoder = load_encoder(drive, report);
    let position_feedback = position_feedback(drive, report);
    let feedforward = feedforward(drive);
    let position = position(drive, known.base_rate, is_used, report);
    let current = if ideal {
        if let Some(span) = drive.current.span() {
            report.warning(span, "the current loop is not used: an ideal source has no current", "");
        }
        Ok(None)
    } else {
        current(drive, known, is_used, report)
    };
    let belief = match (known.axis, known.motor) {
        (Some(axis), Some(motor)) => estimate::resolve(&drive.estimate, axis, motor, report),
        _ => None,
    };
    let velocity = velocity(drive, known, belief.as_ref(), is_used, report);
    if let (Some(belief), Some(feedforward)) = (&belief, &feedforward) {
        check_feedforward(drive, belief, feedforward.effort, report);
    }
    Some(Drive {
        enabled,
        dc_link: dc_link?,
        max_effort: max_effort?,
        current: current.ok()?,
        velocity: velocity?,
        position: position?,
        feedforward: feedforward?,
        estimate: belief?.estimate,
        load_encoder: load_encoder.ok()?,
        position_feedback: position_feedback?,
    })
}

/// Without `[drive]`: right for a prescribed motion only.
fn absent(file: &File, known: &Known<'_>, report: &mut Report) -> Option<Drive> {
    if !matches!(known.motor?, Motor::Prescribed) {
        if let Some(motor) = file.motor.given() {
            report.missing("", "drive", motor.span);
        }
        return None;
    }
    let rate = known.base_rate?;
    Some(Drive {
        enabled: false,
        dc_link: f64::INFINITY,
        max_effort: f64::INFINITY,
        current: None,
        velocity: VelocityLoop { rate, gain: 0.0, integral_time: None, filter_time: 0.0 },
        position: PositionLoop { rate, gain: 0.0 },
        feedforward: NO_FEEDFORWARD,
        estimate: estimate::resolve(&Slot::Absent, known.axis?, known.motor?, report)?.estimate,
        load_encoder: None,
        position_feedback: Feedback::Motor,
    })
}

fn dc_link(drive: &file::Drive, motor: Option<&Motor>, is_used: bool, report: &mut Report) -> Option<f64> {
    match (&drive.dc_link, motor) {
        (Slot::Absent, Some(Motor::Pmsm(_))) if is_used => need(&drive.dc_link, "drive", "dc_link", drive.span, report),
        (Slot::Absent, _) => Some(f64::INFINITY),
        (slot, _) => slot.given().copied(),
    }
}

/// Largest effort the motor can give (motor coordinate).
fn strength(motor: &Motor) -> f64 {
    match motor {
        Motor::Pmsm(motor) => motor.effort_constant() * motor.max_current,
        Motor::IdealSource(source) => source.gain * source.limit,
        Motor::Prescribed => f64::INFINITY,
    }
}

fn max_effort(drive: &file::Drive, motor: Option<&Motor>, report: &mut Report) -> Option<f64> {
    use crate::scenario::Motion::{Linear, Rotary};
    let turns = report.motor == Some(Rotary);
    let (slot, other) =
        if turns { (&drive.max_torque, &drive.max_force) } else { (&drive.max_force, &drive.max_torque) };
    if let (Some(span), Some(motion)) = (other.span(), report.motor) {
        let (wrong, right) = if motion == Linear { ("max_torque", "max_force") } else { ("max_force", "max_torque") };
        let kind = if turns { "a motor that turns" } else { "a linear motor" };
        report.error(span, format!("{kind} has no `{wrong}`"), format!("give `{right}`"));
        return None;
    }
    let strength = strength(motor?);
    match slot {
        Slot::Absent => Some(strength),
        Slot::Wrong(_) => None,
        // Equal values may differ by the rounding of the product.
        Slot::Given(at) if at.value > strength * (1.0 + 1e-9) => {
            let (name, unit) = if turns { ("max_torque", "N m") } else { ("max_force", "N") };
            let message = format!("`{name}` is more than the motor gives, {strength:.5} {unit}");
            let help = match motor? {
                Motor::Pmsm(_) if turns => "that is 1.5·p·ψ·`max_current`",
                Motor::Pmsm(_) => "that is 1.5·(π/τ_p)·ψ·`max_current`",
                _ => "that is `gain` times `limit`",
            };
            report.error(at.span, message, help);
            None
        }
        Slot::Given(at) => Some(at.value),
    }
}

fn load_encoder(drive: &file::Drive, report: &mut Report) -> Result<Option<Encoder>, Reported> {
    let Some(encoder) = drive.load_encoder.optional()? else { return Ok(None) };
    resolution(&encoder.step, &encoder.counts_per_rev, report.axis, report).ok_or(Reported).map(Some)
}

fn position_feedback(drive: &file::Drive, report: &mut Report) -> Option<Feedback> {
    match &drive.position_feedback {
        Slot::Absent => Some(Feedback::Motor),
        Slot::Wrong(_) => None,
        Slot::Given(at) => {
            if at.value == Feedback::Load && matches!(drive.load_encoder, Slot::Absent) {
                report.error(at.span, "there is no encoder on the load", "add `[drive.load_encoder]`");
                return None;
            }
            Some(at.value)
        }
    }
}

fn feedforward(drive: &file::Drive) -> Option<Feedforward> {
    let Some(given) = drive.feedforward.optional().ok()? else { return Some(NO_FEEDFORWARD) };
    Some(Feedforward {
        velocity: given.velocity.optional().ok()?.map_or(0.0, |Share(share)| *share),
        effort: given.effort.optional().ok()?.copied().unwrap_or(EffortFeedforward::Off),
        friction: given.friction.optional().ok()?.copied().unwrap_or(false),
        delay: match given.delay.optional().ok()? {
            Some(AutoTime::Time(delay)) => Some(*delay),
            Some(AutoTime::Auto) | None => None,
        },
    })
}

/// The model of the effort feedforward must have what it computes with.
fn check_feedforward(drive: &file::Drive, belief: &Belief, model: EffortFeedforward, report: &mut Report) {
    let Some(span) = drive.feedforward.given().and_then(|feedforward| feedforward.effort.span()) else { return };
    if model != EffortFeedforward::Off && !belief.knows_inertia {
        report.error(span, "the drive knows no inertia of this axis", "give `motor_inertia` in `[drive.estimate]`");
    }
    let is_elastic = belief.estimate.stiffness.is_finite() && belief.estimate.load_inertia > 0.0;
    if model == EffortFeedforward::TwoMass && belief.knows_inertia && !is_elastic {
        let help = "write \"rigid\", or give `stiffness` and `load_inertia` in `[drive.estimate]`";
        report.error(span, "the axis is rigid: there are no two masses", help);
    }
}

fn position(drive: &file::Drive, base_rate: Option<Rate>, is_used: bool, report: &mut Report) -> Option<PositionLoop> {
    let given = match &drive.position {
        Slot::Absent if is_used => {
            report.missing("drive", "position", drive.span);
            return None;
        }
        Slot::Absent => return Some(PositionLoop { rate: base_rate?, gain: 0.0 }),
        Slot::Wrong(_) => return None,
        Slot::Given(given) => &given.value,
    };
    let path = "drive.position";
    need(&given.rate, path, "rate", given.span, report);
    let rate = task_rate(&given.rate, base_rate, report);
    let gain = match one_way(&[("bandwidth", given.bandwidth.span()), ("gain", given.gain.span())], report) {
        Way::Use(0) => given.bandwidth.given().copied(),
        Way::Use(_) => given.gain.given().copied(),
        Way::Contradiction => None,
        Way::None => {
            report.missing_with_help(path, "bandwidth", given.span, "or `gain`");
            None
        }
    };
    Some(PositionLoop { rate: rate?, gain: gain? })
}

/// The current loop of a synchronous motor; `None` where there is none and none is needed.
fn current(
    drive: &file::Drive,
    known: &Known<'_>,
    is_used: bool,
    report: &mut Report,
) -> Result<Option<CurrentLoop>, Reported> {
    let Some(given) = drive.current.optional()? else {
        if is_used && known.motor.is_some() {
            report.missing("drive", "current", drive.span);
            return Err(Reported);
        }
        return Ok(None);
    };
    let (path, header) = ("drive.current", given.span);
    need(&given.rate, path, "rate", header, report);
    let rate = task_rate(&given.rate, known.base_rate, report);
    let by_gain = given.gain_d.span().or(given.gain_q.span());
    let gain = match one_way(&[("bandwidth", given.bandwidth.span()), ("gain_d", by_gain)], report) {
        Way::Use(0) => None,
        Way::Use(_) => Some(pair(("gain_d", &given.gain_d), ("gain_q", &given.gain_q), path, header, report)?),
        Way::Contradiction => return Err(Reported),
        Way::None => {
            report.missing_with_help(path, "bandwidth", header, "or `gain_d` and `gain_q`");
            return Err(Reported);
        }
    };
    let times = [("integral_time_d", &given.integral_time_d), ("integral_time_q", &given.integral_time_q)];
    let integral_time = if times.iter().any(|(_, slot)| slot.span().is_some()) {
        Some(pair(times[0], times[1], path, header, report)?)
    } else {
        None
    };
    let bandwidth = match (gain, known.motor) {
        (None, _) => given.bandwidth.given().copied(),
        // k_p = α·L the other way round; without an integral time it sets that too.
        (Some((_, q)), Some(Motor::Pmsm(motor))) => Some(q / motor.inductance_q),
        (Some(_), _) => None,
    };
    Ok(Some(CurrentLoop { rate: rate.ok_or(Reported)?, bandwidth: bandwidth.ok_or(Reported)?, gain, integral_time }))
}

/// Two keys that go together.
fn pair(
    (d_key, d): (&str, &Slot<f64>),
    (q_key, q): (&str, &Slot<f64>),
    path: &str,
    header: Span,
    report: &mut Report,
) -> Result<(f64, f64), Reported> {
    let d = need(d, path, d_key, header, report);
    let q = need(q, path, q_key, header, report);
    d.zip(q).ok_or(Reported)
}

fn velocity(
    drive: &file::Drive,
    known: &Known<'_>,
    belief: Option<&Belief>,
    is_used: bool,
    report: &mut Report,
) -> Option<VelocityLoop> {
    let given = match &drive.velocity {
        Slot::Absent if is_used => {
            report.missing("drive", "velocity", drive.span);
            return None;
        }
        Slot::Absent => {
            return Some(VelocityLoop { rate: known.base_rate?, gain: 0.0, integral_time: None, filter_time: 0.0 });
        }
        Slot::Wrong(_) => return None,
        Slot::Given(given) => &given.value,
    };
    let path = "drive.velocity";
    need(&given.rate, path, "rate", given.span, report);
    let rate = task_rate(&given.rate, known.base_rate, report);
    // Inertia as the motor feels it, τ/α = r²·M.
    let inertia = belief.filter(|belief| belief.knows_inertia).zip(known.axis).map(|(belief, axis)| {
        axis.transmission * axis.transmission * (belief.estimate.motor_inertia + belief.estimate.load_inertia)
    });
    let gain = match one_way(&[("bandwidth", given.bandwidth.span()), ("gain", given.gain.span())], report) {
        Way::Use(0) => {
            if belief.is_some() && inertia.is_none() {
                let span = given.bandwidth.span().unwrap_or(given.span);
                let help = "give `motor_inertia` in `[drive.estimate]`, or `gain` here";
                report.error(span, "the drive knows no inertia of this axis", help);
            }
            given.bandwidth.given().zip(inertia).map(|(omega, inertia)| omega * inertia)
        }
        Way::Use(_) => velocity_gain(&given.gain, known.motor, report),
        Way::Contradiction => None,
        Way::None => {
            report.missing_with_help(path, "bandwidth", given.span, "or `gain`");
            None
        }
    };
    let filter_time = given.filter_time.optional().ok().map(|time| time.copied().unwrap_or_default());
    let integral_time = integral_time(given, gain.zip(inertia).map(|(gain, inertia)| gain / inertia), report);
    Some(VelocityLoop { rate: rate?, gain: gain?, integral_time: integral_time.ok()?, filter_time: filter_time? })
}

fn velocity_gain(gain: &Slot<Either>, motor: Option<&Motor>, report: &mut Report) -> Option<f64> {
    let at = gain.at()?;
    match (at.value, motor?) {
        (Either::First(gain), _) => Some(gain),
        // An amplifier in volts: the force per volt makes it effort.
        (Either::Second(volts), Motor::IdealSource(source)) => Some(volts * source.gain),
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
            // With a bandwidth the missing inertia has been said already.
            if given.gain.given().is_some() {
                let help = "it cannot be derived: the drive knows no inertia of this axis";
                report.missing_with_help("drive.velocity", "integral_time", given.span, help);
            }
            Err(Reported)
        }
    }
}
