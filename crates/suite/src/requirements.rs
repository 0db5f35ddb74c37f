//! From a scenario to what its run is held to beside its limits.
use servobench_metrics::{Driven, EarlyEnd, LinearLoop, Rules};
use servobench_scenario::{Actuator, Feedback, Scenario};
use servobench_sim::{Analysis, analyse_stability};
use servobench_stability::Depth;

/// What the run of `scenario`, which ended early if it says so, is held to.
pub(crate) fn rules(scenario: &Scenario, linear_loop: LinearLoop, ended: Option<EarlyEnd>) -> Rules<'_> {
    Rules {
        lifted: &scenario.requirements.lifted,
        expected: &scenario.requirements.expected,
        window: scenario.measure.window,
        increment: increment(scenario),
        modulo: scenario.axis.modulo,
        driven: match scenario.actuator {
            Actuator::Prescribed => Driven::Exactly,
            Actuator::Off => Driven::Not,
            Actuator::Pmsm { .. } | Actuator::IdealSource { .. } => Driven::ByLoops,
        },
        linear_loop,
        ended,
    }
}

/// What the analysis of the linear loop of `scenario` says. Where it is stable, its boundaries are nobody's concern.
pub(crate) fn linear_loop(scenario: &Scenario) -> LinearLoop {
    match analyse_stability(scenario, Depth::Verdict) {
        Ok(Analysis::Done { report, .. }) => match report.instability {
            Some(instability) => LinearLoop::Unstable(instability.to_string()),
            None => LinearLoop::Stable,
        },
        Ok(Analysis::NotPossible(_)) | Err(_) => LinearLoop::NotAnalysed,
    }
}

/// One increment of the encoder that closes the position loop (axis unit); 0 for an ideal one, or none.
fn increment(scenario: &Scenario) -> f64 {
    let motor = match &scenario.actuator {
        Actuator::Pmsm { motor, .. } => motor.encoder,
        Actuator::IdealSource { source, .. } => source.encoder,
        Actuator::Prescribed | Actuator::Off => return 0.0,
    };
    match scenario.actuator.drive().map(|drive| drive.position_feedback) {
        Some(Feedback::Load(encoder)) => encoder.resolution.unwrap_or_default(),
        _ => scenario.axis.transmission * motor.resolution.unwrap_or_default(),
    }
}
