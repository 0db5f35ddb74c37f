//! Requirements on the run of a scenario beside its limits.
mod axle;

use servobench_metrics::{Disturbance, Driven, EarlyEnd, LinearLoop, Oscillation, Poles, Readings, Rules};
use servobench_plant::Encoder;
use servobench_scenario::{Actuator, DisturbedBody, Feedback, LoopSignal, Scenario};
use servobench_signals::Signal;
use servobench_sim::{Analysis, MasterLoop, MechanicsAtRest, NotAnalysed, Speeds, analyse_stability};
use servobench_stability::{Depth, Slowest, StabilityError};
use servobench_trace::Recording;

/// Requirements on `recording`, a run of `scenario` that may have ended early; `model` is an MJCF file around its rest.
pub(crate) fn rules<'a>(
    scenario: &'a Scenario,
    recording: &Recording,
    ended: Option<EarlyEnd>,
    model: Option<&MechanicsAtRest>,
) -> Rules<'a> {
    let (linear_loop, poles, not_analysed) = linear_loop(scenario, recording, model);
    Rules {
        lifted: &scenario.requirements.lifted,
        expected: &scenario.requirements.expected,
        window: scenario.measure.window,
        home_at: scenario.measure.home_at,
        increment: increment(scenario),
        noise: noise(scenario),
        motor: motor_readings(scenario),
        disturbances: disturbances(scenario),
        excited: excited(scenario),
        transmission: scenario.axis.transmission,
        bus_unit: scenario.bus.as_ref().map_or(0.0, |bus| bus.units.axis.abs() / f64::from(bus.units.drive)),
        servo: axle::servo(scenario),
        held_modes: axle::held_modes(scenario),
        deflection: axle::deflection(scenario),
        tolerances: scenario.requirements.tolerances,
        driven: match scenario.actuator {
            Actuator::Prescribed => Driven::Exactly,
            Actuator::Off(_) => Driven::Not,
            Actuator::Pmsm { .. } | Actuator::IdealSource { .. } => Driven::ByLoops,
        },
        linear_loop,
        poles,
        not_analysed,
        ended,
        winding_limit: winding_limit(&scenario.actuator),
    }
}

/// Highest temperature that the winding bears (°C), where it warms up.
fn winding_limit(actuator: &Actuator) -> Option<f64> {
    let Actuator::Pmsm { effects, .. } = actuator else { return None };
    effects.temperature?.network.map(|network| network.winding_limit)
}

/// Verdict of the analysis of the linear loop of `scenario`, its poles, and the parts not analysed. Where the loop is stable, its
/// boundaries are not used.
fn linear_loop(
    scenario: &Scenario,
    recording: &Recording,
    model: Option<&MechanicsAtRest>,
) -> (LinearLoop, Option<Poles>, Option<String>) {
    let is_scheduled = scenario.actuator.drive().is_some_and(|drive| drive.params.blocks.schedule.is_some());
    let speeds = is_scheduled.then(|| Speeds::recorded(recording, scenario.axis.transmission)).flatten();
    analysed(scenario, speeds.as_ref(), model)
}

/// Reason why the linear loop of `scenario` is unstable, whatever its moves; `None` where it is stable, or not analysed. `model` is an MJCF
/// file around its rest.
#[must_use]
pub fn instability(scenario: &Scenario, model: Option<&MechanicsAtRest>) -> Option<String> {
    match analysed(scenario, None, model).0 {
        LinearLoop::Unstable(why) => Some(why),
        LinearLoop::Stable | LinearLoop::NotAnalysed => None,
    }
}

fn analysed(
    scenario: &Scenario,
    speeds: Option<&Speeds>,
    model: Option<&MechanicsAtRest>,
) -> (LinearLoop, Option<Poles>, Option<String>) {
    match analyse_stability(scenario, Depth::Verdict, speeds, model) {
        Ok(Analysis::Done { report, master, without }) => {
            let slowest = master.map_or(Some(report.slowest), |master| master.slowest);
            let of_master = master.filter(MasterLoop::is_unstable).map(|master| master.to_string());
            match report.instability.map(|instability| instability.to_string()).or(of_master) {
                Some(why) => (LinearLoop::Unstable(why), slowest.map(poles), None),
                None => (LinearLoop::Stable, slowest.map(poles), listed(&without)),
            }
        }
        // A response that overflows within a period is unstable, though its poles cannot be computed.
        Ok(Analysis::NotPossible(NotAnalysed::Failed(error @ StabilityError::Overflow { .. }))) => {
            (LinearLoop::Unstable(error.to_string()), None, None)
        }
        Ok(Analysis::NotPossible(why)) => {
            (LinearLoop::NotAnalysed, None, Some(format!("the run alone is judged: {why}")))
        }
        Err(error) => (LinearLoop::NotAnalysed, None, Some(format!("the run alone is judged: {error}"))),
    }
}

/// Parts that are not analysed, in one line; `None` where all are.
fn listed(without: &[NotAnalysed]) -> Option<String> {
    let words: Vec<String> = without.iter().map(ToString::to_string).collect();
    (!words.is_empty()).then(|| words.join("; "))
}

fn poles(slowest: Slowest) -> Poles {
    Poles {
        oscillating: slowest.oscillating.map(|pole| Oscillation { frequency: pole.frequency, decay: -pole.growth }),
        slowest_real: slowest.real.map(|pole| -pole.growth),
    }
}

/// Increment of the encoder that closes the position loop (axis unit); 0 for an ideal one, or none.
#[must_use]
pub fn increment(scenario: &Scenario) -> f64 {
    of_encoder(scenario, Encoder::resolution)
}

/// Noise of that encoder (axis unit, effective).
fn noise(scenario: &Scenario) -> f64 {
    of_encoder(scenario, |encoder| encoder.errors.map_or(0.0, |errors| errors.noise))
}

/// Resolution and noise of the encoder at the motor (axis unit): it closes the velocity loop.
fn motor_readings(scenario: &Scenario) -> Readings {
    let of_motor = |length: fn(&Encoder) -> f64| {
        scenario.actuator.encoder().map_or(0.0, |motor| scenario.axis.transmission.abs() * length(&motor))
    };
    Readings {
        increment: of_motor(Encoder::resolution),
        noise: of_motor(|encoder| encoder.errors.map_or(0.0, |errors| errors.noise)),
    }
}

/// A length of the encoder that closes the position loop, in the axis unit; 0 without one.
fn of_encoder(scenario: &Scenario, length: impl Fn(&Encoder) -> f64) -> f64 {
    let Some(motor) = scenario.actuator.encoder() else { return 0.0 };
    match scenario.actuator.drive().map(|drive| drive.position_feedback) {
        Some(Feedback::Load(encoder)) => length(&encoder),
        _ => scenario.axis.transmission.abs() * length(&motor),
    }
}

/// Disturbances that the scenario orders, as efforts of the motor.
fn disturbances(scenario: &Scenario) -> Vec<Disturbance> {
    let all = scenario.disturbances.iter().map(|one| Disturbance {
        start: one.start,
        end: one.start + one.duration,
        effort: match one.on {
            DisturbedBody::Motor => one.effort,
            DisturbedBody::Load => scenario.axis.transmission * one.effort,
        },
        frequency: one.frequency,
    });
    all.collect()
}

/// Channels in which FMUs excite the axis, each with its factor to an effort of the motor.
fn excited(scenario: &Scenario) -> Vec<(Signal, f64)> {
    let exciting = scenario.fmus.iter().filter(|fmu| fmu.excites).flat_map(servobench_scenario::Fmu::efforts);
    let scaled = exciting.map(|effort| {
        let scale = if effort == LoopSignal::LoadEffort { scenario.axis.transmission } else { 1.0 };
        (effort.signal(), scale)
    });
    scaled.collect()
}
