//! `[motor]` and `[drive]` together: the actuator of the axis.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::file::{FeedbackEncoder, File};
use crate::list::{Automatic, Share};
use crate::parameter_key::parameter_key;
use crate::resolve::estimate::{self, Belief};
use crate::resolve::motor::Motor;
use crate::resolve::{blocks, current, inverter, loops, need, sensors};
use crate::scenario::{Actuator, Axis, Drive, Feedback, IdleMotor};
use servobench_base::{ParamError, Rate};
use servobench_drive::current::operating_point::Strategy;
use servobench_drive::current::{Gains, q_current, voltage_limit};
use servobench_drive::{Blocks, EffortFeedforward, Estimate, Params, Stage, delay, feedforward};
use servobench_plant::pmsm;

/// Parts resolved so far.
pub(super) struct Known<'a> {
    pub(super) base_rate: Option<Rate>,
    pub(super) axis: Option<&'a Axis>,
    pub(super) motor: Option<&'a Motor>,
}

/// The motor of a power stage that is off, if its teeth or iron act on the axis.
fn idle(motor: &Motor) -> Option<Box<IdleMotor>> {
    let Motor::Pmsm { motor, effects, .. } = motor else { return None };
    let acts = !effects.cogging.is_empty() || effects.iron.is_some();
    acts.then(|| Box::new(IdleMotor { motor: *motor, effects: (**effects).clone() }))
}

pub(super) fn resolve(file: &File, known: &Known<'_>, report: &mut Report) -> Option<Actuator> {
    let given = match &file.drive {
        Slot::Absent => return absent(file, known.motor?, report),
        Slot::Wrong(_) => return None,
        Slot::Given(drive) => &drive.value,
    };
    let enabled = given.enabled.given().copied().unwrap_or(true);
    let is_used = enabled && !matches!(known.motor, Some(Motor::Prescribed));

    let dc_link = dc_link(given, known.motor, is_used, report);
    let estimates = given.estimate.given();
    if let (Some(estimates), Some(motor)) = (estimates, known.motor) {
        estimate::check_motor(estimates, motor, report);
    }
    let current_loop = current::resolve(given, known, is_used, report);
    let inverter = inverter::resolve(given, known, report);
    let link = inverter::link(given, known, dc_link, report);
    let described = current_loop.as_ref().ok().copied().flatten();
    let belief = match (known.axis, file.axis.given()) {
        (Some(axis), Some(written)) => estimate::of_axis(estimates, written, axis, report),
        _ => None,
    };
    let gain = match known.motor {
        Some(Motor::IdealSource { source, .. }) => estimate::or_true(estimates, |given| &given.gain, source.gain),
        _ => 1.0,
    };
    let current_sensor = described.and_then(|described| described.sensor);
    let d_reference = described.map_or(0.0, |described| described.d_reference);
    let strategy = described.map_or(Strategy::default(), |described| described.operation.strategy);
    let max_effort = max_effort(given, known.motor, &Source { gain, d_reference, strategy }, report);
    let belief_of = belief.as_ref();
    let knowledge =
        loops::Knowledge { base_rate: known.base_rate, motor: known.motor, belief: belief_of, max_effort, gain };
    let velocity = loops::velocity(given, &knowledge, described.map(|described| described.rate), is_used, report);
    let velocity_rate = velocity.as_ref().map(|velocity| velocity.rate);
    let position = loops::position(given, known.base_rate, velocity_rate, is_used, report);
    let position_feedback = position_feedback(given, report);
    let feedforward = feedforward(given);
    if let (Some(belief), Some(feedforward)) = (&belief, &feedforward) {
        check_feedforward(given, belief, feedforward.effort, report);
    }

    let (stage, current_tuning) = match known.motor? {
        Motor::Prescribed => return Some(Actuator::Prescribed),
        motor if !enabled => return Some(Actuator::Off(idle(motor))),
        Motor::Pmsm { motor, max_current, .. } => {
            let (described, dc_link, base_rate) = (described?, dc_link?, known.base_rate?);
            let mut params = current_params(&described, estimates, (motor, *max_current, dc_link));
            let believed_dc_link = estimate::or_true(estimates, |given| &given.dc_link, dc_link);
            params.dead_time = blocks::dead_time(given.current.given()?, believed_dc_link).ok()?;
            (Stage::Current { params, every: base_rate.divider(described.rate).ok()? }, Some(described.tuning))
        }
        Motor::IdealSource { .. } => (Stage::Direct { gain }, None),
    };
    let base_rate = known.base_rate?;
    let lag = velocity_rate.map_or(0.0, |rate| lag(rate, base_rate, &stage));
    let has_bus = file.bus.span().is_some();
    let known_here = blocks::Known { motor: known.motor, belief: belief_of, rate: velocity_rate, lag, has_bus };
    let blocks = blocks::resolve(given, &known_here, report);
    let parts = Parts {
        base_rate,
        velocity: velocity?,
        position: position?,
        blocks: blocks.ok()?,
        feedforward: feedforward?,
        stage,
        is_sent: is_sent(file),
    };
    let (position_feedback, estimate) = (position_feedback?, belief?.estimate);
    let params = params(given, parts, &estimate, report)?;
    let drive = Drive { params, position_feedback, estimate, current_tuning, current_sensor };
    match known.motor? {
        Motor::Prescribed => None,
        Motor::Pmsm { motor, effects, wiring, encoder, .. } => Some(Actuator::Pmsm {
            motor: *motor,
            effects: effects.clone(),
            wiring: *wiring,
            encoder: *encoder,
            dc_link: dc_link?,
            inverter: inverter.ok()?,
            link: link.ok()?,
            drive,
        }),
        Motor::IdealSource { source, encoder } => {
            Some(Actuator::IdealSource { source: *source, encoder: *encoder, drive })
        }
    }
}

/// Time from an effort of a velocity loop of the rate `velocity` to its effect (s): half of its hold time beyond a period of the
/// current loop, and the lag of the current loop.
fn lag(velocity: Rate, base_rate: Rate, stage: &Stage) -> f64 {
    match stage {
        Stage::Direct { .. } => velocity.period() / 2.0,
        Stage::Current { params, every } => {
            let period = f64::from(every.ticks()) * base_rate.period();
            (velocity.period() - period) / 2.0 + params.motor.inductance.q / params.gains.k_p.q
        }
    }
}

/// True if the master sends an effort. The reference then waits for it, as for that of the drive's own feedforward.
fn is_sent(file: &File) -> bool {
    let offset = file.bus.given().and_then(|bus| bus.effort_offset.given());
    offset.is_some_and(|offset| *offset != EffortFeedforward::Off)
}

/// The current loop `described` in the file for this motor, with its largest current (A) and DC link (V).
fn current_params(
    described: &current::CurrentLoop,
    estimates: Option<&file::Estimate>,
    (motor, max_current, dc_link): (&pmsm::Params, f64, f64),
) -> servobench_drive::current::Params {
    let motor = estimate::of_motor(estimates, motor);
    let believed_dc_link = estimate::or_true(estimates, |given| &given.dc_link, dc_link);
    servobench_drive::current::Params {
        motor,
        gains: Gains::tuned(&motor, described.tuning, described.integral_times),
        d_reference: described.d_reference,
        max_current,
        max_voltage: voltage_limit(believed_dc_link),
        operation: described.operation,
        dead_time: None,
    }
}

/// Components of the firmware.
struct Parts {
    base_rate: Rate,
    velocity: loops::VelocityLoop,
    position: loops::PositionLoop,
    blocks: Blocks,
    feedforward: Feedforward,
    stage: Stage,
    /// True if the master sends an effort.
    is_sent: bool,
}

/// The firmware composed of `parts`, with the estimate `estimate` of the axis.
fn params(drive: &file::Drive, parts: Parts, estimate: &Estimate, report: &mut Report) -> Option<Params> {
    let Parts { base_rate, velocity, position, blocks, feedforward, stage, is_sent } = parts;
    let compensated = |value: f64| if feedforward.friction { value } else { 0.0 };
    let mut params = Params {
        base_rate,
        transmission: estimate.transmission,
        position_gain: position.gain,
        position_every: base_rate.divider(position.rate).ok()?,
        velocity: velocity.params,
        velocity_every: base_rate.divider(velocity.rate).ok()?,
        velocity_filter_time: velocity.filter_time,
        feedforward: feedforward::Params {
            velocity: feedforward.velocity,
            interpolate: feedforward.interpolate,
            model: estimate.model(feedforward.effort),
            coulomb: compensated(estimate.coulomb),
            bias: compensated(estimate.bias),
        },
        blocks,
        reference_delay: delay::Params::default(),
        stage,
    };
    // Without effort feedforward, the drive's or the master's, the reference does not wait.
    let is_waited_for = feedforward.effort != EffortFeedforward::Off || is_sent;
    let path = if is_waited_for { params.effort_path_delay() } else { 0.0 };
    match delay::Params::new(feedforward.delay.unwrap_or(path), params.period(params.position_every)) {
        Ok(delay) => params.reference_delay = delay,
        Err(ParamError { name, value, bound }) => {
            let span = drive.feedforward.given().and_then(|feedforward| feedforward.delay.span());
            let message = format!("`{}` must be {bound}, got {value}", parameter_key(name));
            report.error(span.unwrap_or(drive.span), message, "");
            return None;
        }
    }
    Some(params)
}

/// Without `[drive]`: valid only for a prescribed motion.
fn absent(file: &File, motor: &Motor, report: &mut Report) -> Option<Actuator> {
    if matches!(motor, Motor::Prescribed) {
        return Some(Actuator::Prescribed);
    }
    if let Some(motor) = file.motor.given() {
        report.missing("", "drive", motor.span);
    }
    None
}

fn dc_link(drive: &file::Drive, motor: Option<&Motor>, is_used: bool, report: &mut Report) -> Option<f64> {
    if is_used && matches!(motor, Some(Motor::Pmsm { .. })) {
        return need(&drive.dc_link, "drive", "dc_link", drive.span, report);
    }
    drive.dc_link.given().copied()
}

/// Use of the motor by the drive: estimated effort per output of an ideal source, d-axis current (A), and the strategy for choosing it.
struct Source {
    gain: f64,
    d_reference: f64,
    strategy: Strategy,
}

/// Largest effort of the motor with such a drive (motor coordinate).
fn strength(motor: &Motor, used: &Source) -> f64 {
    match motor {
        Motor::Pmsm { motor, max_current, .. } => {
            let i_d = match used.strategy {
                Strategy::DReference => used.d_reference,
                Strategy::Mtpa => estimate::of_motor(None, motor).mtpa_at_current(*max_current),
            };
            motor.effort_constant(i_d) * q_current(*max_current, i_d)
        }
        Motor::IdealSource { source, .. } => source.gain * source.limit,
        Motor::Prescribed => f64::INFINITY,
    }
}

/// The effort limit of the velocity loop: as given, at most the effort of an ideal source at the estimated gain.
fn max_effort(drive: &file::Drive, motor: Option<&Motor>, used: &Source, report: &mut Report) -> Option<f64> {
    use servobench_base::Coordinate::{Linear, Rotary};
    let turns = report.motor == Some(Rotary);
    let (slot, other) =
        if turns { (&drive.max_torque, &drive.max_force) } else { (&drive.max_force, &drive.max_torque) };
    if let (Some(span), Some(motion)) = (other.span(), report.motor) {
        let (wrong, right) = if motion == Linear { ("max_torque", "max_force") } else { ("max_force", "max_torque") };
        let kind = if turns { "a motor that turns" } else { "a linear motor" };
        report.error(span, format!("{kind} has no `{wrong}`"), format!("give `{right}`"));
        return None;
    }
    let motor = motor?;
    let available = match motor {
        Motor::IdealSource { source, .. } => used.gain * source.limit,
        Motor::Pmsm { .. } | Motor::Prescribed => f64::INFINITY,
    };
    let strength = strength(motor, used);
    match slot {
        Slot::Absent => Some(available),
        Slot::Wrong(_) => None,
        // Equal values may differ by the rounding of the product.
        Slot::Given(at) if at.value > strength * (1.0 + 1e-9) => {
            let (name, unit) = if turns { ("max_torque", "N m") } else { ("max_force", "N") };
            let message = format!("`{name}` is more than the motor gives, {strength:.5} {unit}");
            let help = match motor {
                Motor::Pmsm { .. } if used.d_reference != 0.0 => {
                    "that is 1.5·p·(ψ + (L_d − L_q)·i_d) times what `d_reference` leaves of `max_current`"
                }
                Motor::Pmsm { .. } if used.strategy == Strategy::Mtpa => {
                    "that is 1.5·p·(ψ + (L_d − L_q)·i_d)·i_q with the i_d of maximum torque per ampere at `max_current`"
                }
                Motor::Pmsm { .. } if turns => "that is 1.5·p·ψ·`max_current`",
                Motor::Pmsm { .. } => "that is 1.5·(π/τ_p)·ψ·`max_current`",
                _ => "that is `gain` times `limit`",
            };
            report.error(at.span, message, help);
            None
        }
        Slot::Given(at) => Some(available.min(at.value)),
    }
}

fn position_feedback(drive: &file::Drive, report: &mut Report) -> Option<Feedback> {
    let encoder = match drive.load_encoder.optional().ok()? {
        Some(encoder) => Some(sensors::encoder(encoder, report.axis, report).ok()?),
        None => None,
    };
    match (&drive.position_feedback, encoder) {
        (Slot::Wrong(_), _) => None,
        (Slot::Given(at), None) if at.value == FeedbackEncoder::Load => {
            report.error(at.span, "the load has no encoder", "add `[drive.load_encoder]`");
            None
        }
        (Slot::Given(at), Some(encoder)) if at.value == FeedbackEncoder::Load => Some(Feedback::Load(encoder)),
        (Slot::Absent | Slot::Given(_), encoder) => {
            if let (Some(_), Some(span)) = (encoder, drive.load_encoder.span()) {
                let help = "write `position_feedback = \"load\"` in `[drive]`";
                report.warning(span, "the encoder on the load is not used", help);
            }
            Some(Feedback::Motor)
        }
    }
}

/// The feedforward of the file.
struct Feedforward {
    /// Share of the reference velocity that is fed forward, 0 to 1.
    velocity: f64,
    interpolate: bool,
    effort: EffortFeedforward,
    /// True if estimated Coulomb friction and bias are also fed forward.
    friction: bool,
    /// Delay of the reference for the feedforward path (s); `None`: the delay of the effort path.
    delay: Option<f64>,
}

const NO_FEEDFORWARD: Feedforward =
    Feedforward { velocity: 0.0, interpolate: true, effort: EffortFeedforward::Off, friction: false, delay: None };

fn feedforward(drive: &file::Drive) -> Option<Feedforward> {
    let Some(given) = drive.feedforward.optional().ok()? else { return Some(NO_FEEDFORWARD) };
    Some(Feedforward {
        velocity: given.velocity.optional().ok()?.map_or(0.0, |Share(share)| *share),
        interpolate: given.interpolate.optional().ok()?.copied().unwrap_or(true),
        effort: given.effort.optional().ok()?.copied().unwrap_or(EffortFeedforward::Off),
        friction: given.friction.optional().ok()?.copied().unwrap_or(false),
        delay: match given.delay.optional().ok()? {
            Some(Automatic::Given(delay)) => Some(*delay),
            Some(Automatic::Auto) | None => None,
        },
    })
}

/// Checks that the estimate contains all that the model of the effort feedforward needs.
fn check_feedforward(drive: &file::Drive, belief: &Belief, model: EffortFeedforward, report: &mut Report) {
    let Some(span) = drive.feedforward.given().and_then(|feedforward| feedforward.effort.span()) else { return };
    if model != EffortFeedforward::Off && !belief.knows_inertia {
        report.error(
            span,
            "the inertia of this axis is unknown to the drive",
            "give `motor_inertia` in `[drive.estimate]`",
        );
    }
    let is_elastic = belief.estimate.stiffness.is_finite() && belief.estimate.load_inertia > 0.0;
    if model == EffortFeedforward::TwoMass && belief.knows_inertia && !is_elastic {
        let help = "write \"rigid\", or give `stiffness` and `load_inertia` in `[drive.estimate]`";
        report.error(span, "the axis is rigid: it is a single mass", help);
    }
}
