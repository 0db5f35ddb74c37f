//! Parameters: values of the scenario that may be set before the simulation begins.
use servobench_drive::{Params, Stage, current};
use servobench_planner::Generator;
use servobench_plant::{Body, Chain, Link};
use servobench_scenario::{Actuator, AxisMechanics, Scenario, Step};

/// A parameter.
#[derive(Debug)]
pub(crate) struct Parameter {
    pub(crate) name: &'static str,
    pub(crate) description: &'static str,
    /// Symbol of its unit on the axis.
    pub(crate) unit: fn(&Scenario) -> String,
    /// Least value: above zero, zero, or any.
    pub(crate) least: Least,
    get: fn(&Scenario) -> Option<f64>,
    set: fn(&mut Scenario, f64),
}

/// Least value of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Least {
    Any,
    Zero,
    Positive,
}

impl Parameter {
    /// Its value in `scenario`; `None` if it does not apply there.
    pub(crate) fn value(&self, scenario: &Scenario) -> Option<f64> {
        (self.get)(scenario).filter(|value| value.is_finite())
    }

    /// Sets it to `value` in `scenario`.
    pub(crate) fn apply(&self, scenario: &mut Scenario, value: f64) {
        (self.set)(scenario, value);
    }
}

fn axis(scenario: &Scenario) -> &'static str {
    scenario.axis.motion.unit()
}

fn motor(scenario: &Scenario) -> &'static str {
    scenario.axis.motor_motion.unit()
}

/// Symbol of an effort in the coordinate with this unit.
pub(crate) fn effort(unit: &str) -> &'static str {
    if unit == "rad" { "N m" } else { "N" }
}

fn drive(scenario: &Scenario) -> Option<&Params> {
    scenario.actuator.drive().map(|drive| &drive.params)
}

fn drive_mut(scenario: &mut Scenario) -> Option<&mut Params> {
    match &mut scenario.actuator {
        Actuator::Prescribed | Actuator::Off(_) => None,
        Actuator::Pmsm { drive, .. } | Actuator::IdealSource { drive, .. } => Some(&mut drive.params),
    }
}

fn current_mut(scenario: &mut Scenario) -> Option<&mut current::Params> {
    match &mut drive_mut(scenario)?.stage {
        Stage::Current { params, .. } => Some(params),
        Stage::Direct { .. } => None,
    }
}

fn chain(scenario: &Scenario) -> Option<&Chain> {
    match &scenario.axis.mechanics {
        AxisMechanics::Bodies(chain) => Some(chain),
        AxisMechanics::Mjcf(_) | AxisMechanics::InTheFmu => None,
    }
}

fn chain_mut(scenario: &mut Scenario) -> Option<&mut Chain> {
    match &mut scenario.axis.mechanics {
        AxisMechanics::Bodies(chain) => Some(chain),
        AxisMechanics::Mjcf(_) | AxisMechanics::InTheFmu => None,
    }
}

/// The load, if it is a separate body.
fn load(scenario: &Scenario) -> Option<&Body> {
    chain(scenario)?.bodies()[1..].last()
}

fn load_mut(scenario: &mut Scenario) -> Option<&mut Body> {
    chain_mut(scenario)?.bodies_mut()[1..].last_mut()
}

/// The coupling before the load.
fn coupling(scenario: &Scenario) -> Option<&Link> {
    chain(scenario)?.links().last()
}

fn coupling_mut(scenario: &mut Scenario) -> Option<&mut Link> {
    chain_mut(scenario)?.links_mut().last_mut()
}

/// Limits of velocity, acceleration and jerk of the first move that has all of them.
pub(crate) fn limits_of_moves(scenario: &Scenario) -> Option<[f64; 3]> {
    scenario.program.iter().find_map(|step| match step {
        Step::Move(step) if !matches!(step.request.generator, Generator::Rockwell(_)) => {
            let [velocity, acceleration, jerk, _] = step.request.generator.limits();
            [velocity, acceleration, jerk].iter().all(|limit| limit.is_finite()).then_some([
                velocity,
                acceleration,
                jerk,
            ])
        }
        _ => None,
    })
}

/// All parameters of a part with a drive.
pub(crate) const OF_DRIVE: &[Parameter] = &[
    Parameter {
        name: "drive.position_gain",
        description: "proportional gain of the position loop, K_v",
        unit: |_| "1/s".into(),
        least: Least::Zero,
        get: |scenario| Some(drive(scenario)?.position_gain),
        set: |scenario, value| drive_mut(scenario).into_iter().for_each(|drive| drive.position_gain = value),
    },
    Parameter {
        name: "drive.velocity_gain",
        description: "proportional gain of the velocity loop, effort per velocity of the motor coordinate",
        unit: |scenario| format!("{} s/{}", effort(motor(scenario)), motor(scenario)),
        least: Least::Zero,
        get: |scenario| Some(drive(scenario)?.velocity.k_p),
        set: |scenario, value| drive_mut(scenario).into_iter().for_each(|drive| drive.velocity.k_p = value),
    },
    Parameter {
        name: "drive.velocity_integral_time",
        description: "integral time of the velocity loop",
        unit: |_| "s".into(),
        least: Least::Positive,
        get: |scenario| drive(scenario)?.velocity.integral_time,
        set: |scenario, value| {
            if let Some(drive) = drive_mut(scenario) {
                drive.velocity.integral_time = Some(value);
            }
        },
    },
    Parameter {
        name: "drive.velocity_feedforward",
        description: "share of the reference velocity that is fed forward",
        unit: |_| String::new(),
        least: Least::Zero,
        get: |scenario| Some(drive(scenario)?.feedforward.velocity),
        set: |scenario, value| drive_mut(scenario).into_iter().for_each(|drive| drive.feedforward.velocity = value),
    },
    Parameter {
        name: "drive.max_effort",
        description: "largest torque or force that the velocity loop asks for",
        unit: |scenario| effort(motor(scenario)).into(),
        least: Least::Positive,
        get: |scenario| Some(drive(scenario)?.velocity.max_effort),
        set: |scenario, value| drive_mut(scenario).into_iter().for_each(|drive| drive.velocity.max_effort = value),
    },
    Parameter {
        name: "drive.max_current",
        description: "largest current reference, amplitude",
        unit: |_| "A".into(),
        least: Least::Positive,
        get: |scenario| drive(scenario)?.current_loop().map(|(current, _)| current.max_current),
        set: |scenario, value| current_mut(scenario).into_iter().for_each(|current| current.max_current = value),
    },
];

/// All parameters of a part with the mechanics.
pub(crate) const OF_MECHANICS: &[Parameter] = &[
    Parameter {
        name: "load.inertia",
        description: "mass or inertia of the load; the drive's estimate of it stays as it is",
        unit: |scenario| if axis(scenario) == "rad" { "kg m²".into() } else { "kg".into() },
        least: Least::Positive,
        get: |scenario| Some(load(scenario)?.inertia),
        set: |scenario, value| load_mut(scenario).into_iter().for_each(|load| load.inertia = value),
    },
    Parameter {
        name: "load.stiffness",
        description: "stiffness of the coupling before the load",
        unit: |scenario| format!("{}/{}", effort(axis(scenario)), axis(scenario)),
        least: Least::Positive,
        get: |scenario| Some(coupling(scenario)?.stiffness),
        set: |scenario, value| coupling_mut(scenario).into_iter().for_each(|coupling| coupling.stiffness = value),
    },
    Parameter {
        name: "load.damping",
        description: "damping of the coupling before the load",
        unit: |scenario| format!("{} s/{}", effort(axis(scenario)), axis(scenario)),
        least: Least::Zero,
        get: |scenario| Some(coupling(scenario)?.damping),
        set: |scenario, value| coupling_mut(scenario).into_iter().for_each(|coupling| coupling.damping = value),
    },
    Parameter {
        name: "initial.load_position",
        description: "position of the load when the simulation begins",
        unit: |scenario| axis(scenario).into(),
        least: Least::Any,
        get: |scenario| Some(scenario.initial.load_position),
        set: |scenario, value| scenario.initial.load_position = value,
    },
    Parameter {
        name: "initial.load_velocity",
        description: "velocity of the load when the simulation begins",
        unit: |scenario| format!("{}/s", axis(scenario)),
        least: Least::Any,
        get: |scenario| Some(scenario.initial.load_velocity),
        set: |scenario, value| scenario.initial.load_velocity = value,
    },
];
