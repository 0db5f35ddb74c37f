//! From a scenario to what its run is held to beside its limits.
use servobench_metrics::{Driven, EarlyEnd, LinearLoop, Rules};
use servobench_scenario::{Actuator, Feedback, Scenario};
use servobench_sim::{Analysis, NotAnalysed, analyse_stability};
use servobench_stability::{Depth, StabilityError};

/// What the run of `scenario`, which ended early if it says so, is held to.
pub(crate) fn rules(scenario: &Scenario, ended: Option<EarlyEnd>) -> Rules<'_> {
    let (linear_loop, not_analysed) = linear_loop(scenario);
    Rules {
        lifted: &scenario.requirements.lifted,
        expected: &scenario.requirements.expected,
        window: scenario.measure.window,
        increment: increment(scenario),
        modulo: scenario.axis.modulo,
        transmission: scenario.axis.transmission,
        driven: match scenario.actuator {
            Actuator::Prescribed => Driven::Exactly,
            Actuator::Off => Driven::Not,
            Actuator::Pmsm { .. } | Actuator::IdealSource { .. } => Driven::ByLoops,
        },
        linear_loop,
        not_analysed,
        ended,
    }
}

/// What the analysis of the linear loop of `scenario` says, and what is not in it. Where it is stable, its boundaries are nobody's
/// concern.
fn linear_loop(scenario: &Scenario) -> (LinearLoop, Option<String>) {
    match analyse_stability(scenario, Depth::Verdict) {
        Ok(Analysis::Done { report, without }) => match report.instability {
            Some(instability) => (LinearLoop::Unstable(instability.to_string()), None),
            None => (LinearLoop::Stable, without.map(|what| what.to_string())),
        },
        // What grows beyond all numbers within a period is not stable, though its poles cannot be computed.
        Ok(Analysis::NotPossible(NotAnalysed::Failed(error @ StabilityError::Overflow { .. }))) => {
            (LinearLoop::Unstable(error.to_string()), None)
        }
        Ok(Analysis::NotPossible(why)) => (LinearLoop::NotAnalysed, Some(format!("the run alone is judged: {why}"))),
        Err(error) => (LinearLoop::NotAnalysed, Some(format!("the run alone is judged: {error}"))),
    }
}

/// One increment of the encoder that closes the position loop (axis unit); 0 for an ideal one, or none.
fn increment(scenario: &Scenario) -> f64 {
    let motor = match &scenario.actuator {
        Actuator::Pmsm { encoder, .. } | Actuator::IdealSource { encoder, .. } => encoder,
        Actuator::Prescribed | Actuator::Off => return 0.0,
    };
    match scenario.actuator.drive().map(|drive| drive.position_feedback) {
        Some(Feedback::Load(encoder)) => encoder.increment.unwrap_or_default(),
        _ => scenario.axis.transmission * motor.increment.unwrap_or_default(),
    }
}
