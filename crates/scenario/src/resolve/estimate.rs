//! What the firmware believes of the axis: the plant as two masses, with single values overridden.
use crate::diagnostic::Report;
use crate::field::Slot;
use crate::file;
use crate::scenario::{Axis, AxisMechanics, Body, Coupling, Estimate, Motor, Pmsm};

/// The estimate and whether it holds inertias at all: of a user's own MJCF file only what `[drive.estimate]` says is
/// known.
pub(super) struct Belief {
    pub(super) estimate: Estimate,
    pub(super) knows_inertia: bool,
}

pub(super) fn resolve(slot: &Slot<file::Estimate>, axis: &Axis, motor: &Motor, report: &mut Report) -> Option<Belief> {
    let mut estimate = match &axis.mechanics {
        AxisMechanics::Bodies(bodies) => two_masses(bodies, axis.transmission),
        AxisMechanics::Mjcf(_) => unknown(),
    };
    if let Motor::Pmsm(motor) = motor {
        estimate.motor = Some(motor.clone());
    }
    if let Some(given) = slot.optional().ok()? {
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
        override_motor(&given.motor, estimate.motor.as_mut(), report);
    }
    let knows_inertia = estimate.motor_inertia > 0.0;
    Some(Belief { estimate, knows_inertia })
}

fn override_with(slot: &Slot<f64>, value: &mut f64) {
    if let Some(given) = slot.given() {
        *value = *given;
    }
}

fn override_motor(slot: &Slot<file::EstimatedMotor>, motor: Option<&mut Pmsm>, report: &mut Report) {
    let Some(at) = slot.at() else { return };
    let Some(motor) = motor else {
        report.error(at.span, "there is no synchronous motor to estimate", "");
        return;
    };
    let given = &at.value;
    override_with(&given.resistance, &mut motor.resistance);
    override_with(&given.inductance_d, &mut motor.inductance_d);
    override_with(&given.inductance_q, &mut motor.inductance_q);
    override_with(&given.flux_linkage, &mut motor.flux_linkage);
}

const fn unknown() -> Estimate {
    Estimate {
        motor_inertia: 0.0,
        load_inertia: 0.0,
        stiffness: f64::INFINITY,
        motor_viscous: 0.0,
        load_viscous: 0.0,
        coulomb: 0.0,
        bias: 0.0,
        motor: None,
    }
}

/// The chain split at its softest coupling, all in the axis coordinate: an inertia J at the motor is J/r² there, a
/// torque τ is τ/r.
fn two_masses(bodies: &[Body], transmission: f64) -> Estimate {
    let softest = bodies
        .iter()
        .enumerate()
        .filter_map(|(i, body)| body.coupling.map(|Coupling { stiffness, .. }| (i, stiffness)))
        .min_by(|(_, one), (_, two)| one.total_cmp(two));
    let (split, stiffness) = softest.unwrap_or((bodies.len(), f64::INFINITY));
    let mut estimate = Estimate { stiffness, ..unknown() };
    for (i, body) in bodies.iter().enumerate() {
        let r = if i == 0 { transmission } else { 1.0 };
        let (inertia, viscous) = if i < split {
            (&mut estimate.motor_inertia, &mut estimate.motor_viscous)
        } else {
            (&mut estimate.load_inertia, &mut estimate.load_viscous)
        };
        *inertia += body.inertia / (r * r);
        *viscous += body.viscous / (r * r);
        estimate.coulomb += body.coulomb / r;
        estimate.bias += body.bias / r;
    }
    estimate
}
