//! The firmware's estimate of the axis and its motor: the plant, with single values overridden.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::resolve::motor::Motor;
use crate::scenario::{Axis, AxisMechanics};
use crate::source::Span;
use servobench_base::Coordinate;
use servobench_drive::Estimate;
use servobench_drive::current::MotorEstimate;
use servobench_plant::{Chain, SourceOutput, pmsm};
use std::f64::consts::TAU;

/// The estimate; true if it contains inertias: for a user's own MJCF file only those given in `[drive.estimate]` are known.
pub(super) struct Belief {
    pub(super) estimate: Estimate,
    pub(super) knows_inertia: bool,
}

/// The firmware's estimate of the axis; `written` is the axis in the file.
pub(super) fn of_axis(
    given: Option<&file::Estimate>,
    written: &file::Axis,
    axis: &Axis,
    report: &mut Report,
) -> Option<Belief> {
    let transmission = match given {
        Some(given) => believed_transmission(given, written, axis, report)?,
        None => axis.transmission,
    };
    let mut estimate = match &axis.mechanics {
        AxisMechanics::Bodies(chain) => two_masses(chain, transmission),
        AxisMechanics::Mjcf(_) | AxisMechanics::InTheFmu => unknown(transmission),
    };
    if let Some(given) = given {
        let values = [
            (&given.motor_inertia, &mut estimate.motor_inertia),
            (&given.load_inertia, &mut estimate.load_inertia),
            (&given.stiffness, &mut estimate.stiffness),
            (&given.motor_viscous, &mut estimate.motor_viscous),
            (&given.load_viscous, &mut estimate.load_viscous),
            (&given.coulomb, &mut estimate.coulomb),
            (&given.bias, &mut estimate.bias),
        ];
        for (slot, value) in values {
            override_with(slot, value);
        }
    }
    let knows_inertia = estimate.motor_inertia > 0.0;
    Some(Belief { estimate, knows_inertia })
}

/// Estimated axis coordinate per motor coordinate: with the estimate's own `lead` or `gear_ratio`.
fn believed_transmission(
    given: &file::Estimate,
    written: &file::Axis,
    axis: &Axis,
    report: &mut Report,
) -> Option<f64> {
    let has_lead = (axis.motion, axis.motor_motion) == (Coordinate::Linear, Coordinate::Rotary);
    let mut refuse = |span: Option<Span>, message: &str| span.map(|span| report.error(span, message, ""));
    if !has_lead && refuse(given.lead.span(), "the axis has no `lead` to estimate").is_some() {
        return None;
    }
    if axis.motor_motion == Coordinate::Linear {
        let refused = refuse(given.gear_ratio.span(), "the axis has no `gear_ratio` to estimate");
        return refused.is_none().then_some(axis.transmission);
    }
    let believed = |estimated: &Slot<f64>, written: &Slot<f64>| match estimated {
        Slot::Absent => Some(written.given().copied()),
        _ => estimated.given().copied().map(Some),
    };
    let gear_ratio = believed(&given.gear_ratio, &written.gear_ratio)?.unwrap_or(1.0);
    let lead = believed(&given.lead, &written.lead)?;
    Some(lead.map_or(1.0, |lead| lead / TAU) / gear_ratio)
}

/// The firmware's estimate of its synchronous motor.
pub(super) fn of_motor(given: Option<&file::Estimate>, motor: &pmsm::Params) -> MotorEstimate {
    // The firmware has a separate copy of the plant's values: both may differ.
    let pmsm::Params { electrical_ratio, resistance, inductance, flux_linkage } = *motor;
    let mut estimate = MotorEstimate { electrical_ratio, resistance, inductance, flux_linkage };
    if let Some(given) = given.and_then(|given| given.motor.given()) {
        override_with(&given.resistance, &mut estimate.resistance);
        override_with(&given.inductance_d, &mut estimate.inductance.d);
        override_with(&given.inductance_q, &mut estimate.inductance.q);
        override_with(&given.flux_linkage, &mut estimate.flux_linkage);
    }
    estimate
}

/// The estimated value; the default is the true one, `truth`.
pub(super) fn or_true(given: Option<&file::Estimate>, slot: fn(&file::Estimate) -> &Slot<f64>, truth: f64) -> f64 {
    given.and_then(|given| slot(given).given().copied()).unwrap_or(truth)
}

/// Refuses estimates of parts that do not exist.
pub(super) fn check_motor(given: &file::Estimate, motor: &Motor, report: &mut Report) {
    let mut refuse = |span, why: &str| {
        if let Some(span) = span {
            report.error(span, why, "");
        }
    };
    if !matches!(motor, Motor::Pmsm { .. }) {
        refuse(given.motor.span(), "the axis has no synchronous motor to estimate");
        refuse(given.dc_link.span(), "the axis has no inverter whose DC link could be estimated");
    }
    match motor {
        Motor::IdealSource { source, .. } if source.output == SourceOutput::Effort => {
            refuse(given.gain.span(), "the output of the source is its effort: it has no `gain` to estimate");
        }
        Motor::IdealSource { .. } => {}
        Motor::Pmsm { .. } | Motor::Prescribed => {
            refuse(given.gain.span(), "the axis has no ideal source whose `gain` could be estimated");
        }
    }
}

fn override_with(slot: &Slot<f64>, value: &mut f64) {
    if let Some(given) = slot.given() {
        *value = *given;
    }
}

const fn unknown(transmission: f64) -> Estimate {
    Estimate {
        transmission,
        motor_inertia: 0.0,
        load_inertia: 0.0,
        stiffness: f64::INFINITY,
        motor_viscous: 0.0,
        load_viscous: 0.0,
        coulomb: 0.0,
        bias: 0.0,
    }
}

/// The chain split at its softest coupling, all in the axis coordinate: an inertia J at the motor is J/r² there, a
/// torque τ is τ/r.
fn two_masses(chain: &Chain, transmission: f64) -> Estimate {
    let bodies = chain.bodies();
    let links = (1..).zip(chain.links());
    let softest = links.min_by(|(_, one), (_, two)| one.stiffness.total_cmp(&two.stiffness));
    let (split, stiffness) = softest.map_or((bodies.len(), f64::INFINITY), |(split, link)| (split, link.stiffness));
    let mut estimate = Estimate { stiffness, ..unknown(transmission) };
    for (i, body) in bodies.iter().enumerate() {
        let r = if i == 0 { transmission } else { 1.0 };
        let (inertia, viscous) = if i < split {
            (&mut estimate.motor_inertia, &mut estimate.motor_viscous)
        } else {
            (&mut estimate.load_inertia, &mut estimate.load_viscous)
        };
        *inertia += body.inertia / (r * r);
        *viscous += body.friction.linear() / (r * r);
        estimate.coulomb += body.friction.constant() / r;
        estimate.bias += body.bias / r;
    }
    estimate
}
