//! The axis of a scenario as its requirements use it: the linear rigid loop, and its displacement by efforts.
use servobench_base::HeldMode;
use servobench_drive::feedforward::Model;
use servobench_drive::{Params, Stage};
use servobench_metrics::{Deflection, Servo};
use servobench_plant::{Chain, pmsm};
use servobench_scenario::{Actuator, AxisMechanics, Bus, BusMode, Feedback, LoopSignal, Scenario};

/// Effort missing from every model, as a share of the drive's largest effort.
const NOT_MODELLED: f64 = 0.05;

/// The linear rigid loop; `None` where there is none, where an FMU replaces it, and where the inertia is unknown.
pub(super) fn servo(scenario: &Scenario) -> Option<Servo> {
    let is_foreign = scenario.fmus.iter().flat_map(|fmu| &fmu.outputs).any(|(_, signal)| replaces_the_drive(*signal));
    let drive = scenario.actuator.drive().filter(|_| !is_foreign)?;
    let params = &drive.params;
    let [inertia, viscous] = inertia_and_viscous(scenario)?;
    let at_the_motor = params.transmission.powi(2) * inertia;
    // The lowest gains of a schedule: a faster response lies nearer to the set-point and meets the requirement, too.
    let lowest = params.blocks.schedule.map_or((1.0, 1.0), |gains| (gains.position.min(1.0), gains.velocity.min(1.0)));
    let bandwidth = lowest.1 * effort_ratio(&scenario.actuator, params) * params.velocity.k_p / at_the_motor;
    if !(bandwidth > 0.0 && bandwidth.is_finite()) {
        return None;
    }
    let bus = scenario.bus.as_ref();
    let position = params.blocks.position.as_ref().and_then(|shaping| shaping.integral_time);
    let (gain, position_integral_time, of_velocity) = match bus.map(|bus| (bus.mode, &bus.position_loop)) {
        Some((BusMode::CyclicVelocity, Some(gains))) => (gains.gain, gains.integral_time, velocity_offset(bus)),
        Some((BusMode::CyclicVelocity | BusMode::ProfileVelocity, _)) => (0.0, None, 1.0),
        _ => (lowest.0 * params.position_gain, position, params.feedforward.velocity + velocity_offset(bus)),
    };
    let fed_forward = [Some(params.feedforward.model), bus.map(|bus| drive.estimate.model(bus.effort_offset))];
    let (fed_inertia, fed_viscous) =
        fed_forward.into_iter().flatten().map(modelled).fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
    Some(Servo {
        gain,
        position_integral_time,
        velocity_feedforward: of_velocity,
        bandwidth,
        reference_weight: params.blocks.reference_weight,
        integral_time: params.velocity.integral_time,
        inertia_feedforward: fed_inertia / inertia,
        viscous: viscous / inertia,
        viscous_feedforward: fed_viscous / inertia,
        is_closed_at_the_load: matches!(drive.position_feedback, Feedback::Load(_)),
    })
}

/// The modes in which the load follows the motor; none where the mechanics are not those of a chain.
pub(super) fn held_modes(scenario: &Scenario) -> Vec<HeldMode> {
    chain(scenario).map(Chain::held_modes).unwrap_or_default()
}

/// Displacement of the axis by efforts.
pub(super) fn deflection(scenario: &Scenario) -> Deflection {
    let chain = chain(scenario);
    let r = scenario.axis.transmission.abs();
    let of_bodies: f64 = match (chain, scenario.actuator.drive()) {
        (Some(chain), _) => {
            let bodies = chain.bodies().iter();
            bodies.map(|body| (body.bias.abs() + body.friction.breakaway()) * r / body.transmission.abs()).sum()
        }
        // Of bodies in a file the drive knows it.
        (None, Some(drive)) => r * (drive.estimate.bias.abs() + drive.estimate.coulomb),
        (None, None) => 0.0,
    };
    let max_effort = scenario.actuator.rated_effort().unwrap_or(f64::INFINITY);
    let not_modelled = if max_effort.is_finite() { NOT_MODELLED * max_effort } else { 0.0 };
    let initial = &scenario.initial;
    let mut all = Deflection {
        effort: of_bodies + cogging(&scenario.actuator) + not_modelled,
        max_effort,
        initial: initial.load_position.abs(),
        ..chain.map_or_else(Deflection::default, springs)
    };
    let Some((servo, drive)) = servo(scenario).zip(scenario.actuator.drive()) else { return all };
    let has_integral = servo.integral_time.is_some();
    let k_p = effort_ratio(&scenario.actuator, &drive.params) * drive.params.velocity.k_p;
    all.velocity_per_effort = if has_integral { 0.0 } else { r / k_p };
    all.has_integral = has_integral || servo.position_integral_time.is_some();
    if servo.gain > 0.0 {
        all.per_effort = r / (k_p * servo.gain);
        all.initial += initial.load_velocity.abs() / servo.gain;
    } else {
        // Without a loop over the position an effort displaces the axis for as long as the velocity loop takes.
        all.per_effort = r / (k_p * servo.bandwidth);
    }
    all
}

/// Deflection of springs under the bodies behind them.
fn springs(chain: &Chain) -> Deflection {
    let mut all = Deflection::default();
    for (k, link) in chain.links().iter().enumerate() {
        let behind = &chain.bodies()[k + 1..];
        let sum = |value: fn(&servobench_plant::Body) -> f64| behind.iter().map(value).sum::<f64>();
        let friction = sum(|body| body.friction.breakaway() / body.transmission.abs());
        let bias = sum(|body| body.bias.abs() / body.transmission.abs());
        all.elastic += (bias + friction) / link.stiffness;
        all.stick += friction / link.stiffness;
        all.elastic_per_effort += 1.0 / link.stiffness;
    }
    all
}

const fn chain(scenario: &Scenario) -> Option<&Chain> {
    match &scenario.axis.mechanics {
        AxisMechanics::Bodies(chain) => Some(chain),
        AxisMechanics::Mjcf(_) | AxisMechanics::InTheFmu => None,
    }
}

/// Inertia and viscous friction in the axis coordinate: of the bodies, or by the drive's estimate.
fn inertia_and_viscous(scenario: &Scenario) -> Option<[f64; 2]> {
    if let Some(chain) = chain(scenario) {
        let sum = |value: fn(&servobench_plant::Body) -> f64| {
            chain.bodies().iter().map(|body| value(body) / body.transmission.powi(2)).sum::<f64>()
        };
        return Some([sum(|body| body.inertia), sum(|body| body.friction.linear())]);
    }
    let estimate = &scenario.actuator.drive()?.estimate;
    let inertia = estimate.motor_inertia + estimate.load_inertia;
    (inertia > 0.0).then_some([inertia, estimate.motor_viscous + estimate.load_viscous])
}

/// Inertia and viscous friction of a model.
const fn modelled(model: Model) -> (f64, f64) {
    match model {
        Model::Off => (0.0, 0.0),
        Model::Rigid { inertia, viscous } => (inertia, viscous),
        Model::TwoMass { motor_inertia, load_inertia, motor_viscous, load_viscous, .. } => {
            (motor_inertia + load_inertia, motor_viscous + load_viscous)
        }
    }
}

fn velocity_offset(bus: Option<&Bus>) -> f64 {
    if bus.is_some_and(|bus| bus.velocity_offset) { 1.0 } else { 0.0 }
}

/// Effort of the source per effort that the drive requests.
fn effort_ratio(actuator: &Actuator, params: &Params) -> f64 {
    match (actuator, &params.stage) {
        (Actuator::IdealSource { source, .. }, Stage::Direct { gain }) => source.gain / gain,
        _ => 1.0,
    }
}

fn cogging(actuator: &Actuator) -> f64 {
    let Actuator::Pmsm { effects, .. } = actuator else { return 0.0 };
    let pmsm::Effects { cogging, .. } = &**effects;
    cogging.iter().map(|one| one.amplitude.abs()).sum()
}

const fn replaces_the_drive(signal: LoopSignal) -> bool {
    matches!(signal, LoopSignal::Effort | LoopSignal::VoltageD | LoopSignal::VoltageQ)
}
