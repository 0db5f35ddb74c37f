//! From a scenario to what its run is held to beside its limits.
use servobench_metrics::{Driven, EarlyEnd, LinearLoop, Oscillation, Poles, Rules};
use servobench_scenario::{Actuator, Feedback, Scenario};
use servobench_sim::{Analysis, NotAnalysed, analyse_stability};
use servobench_stability::{Depth, Report, StabilityError};

/// What the run of `scenario`, which ended early if it says so, is held to.
pub(crate) fn rules(scenario: &Scenario, ended: Option<EarlyEnd>) -> Rules<'_> {
    let (linear_loop, poles, not_analysed) = linear_loop(scenario);
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
        poles,
        not_analysed,
        ended,
    }
}

/// What the analysis of the linear loop of `scenario` says, its poles, and what is not in it. Where it is stable, its boundaries are
/// nobody's concern.
fn linear_loop(scenario: &Scenario) -> (LinearLoop, Option<Poles>, Option<String>) {
    match analyse_stability(scenario, Depth::Verdict) {
        Ok(Analysis::Done { report, without }) => {
            let poles = Some(poles(&report));
            match report.instability {
                Some(instability) => (LinearLoop::Unstable(instability.to_string()), poles, None),
                None => (LinearLoop::Stable, poles, without.map(|what| what.to_string())),
            }
        }
        // What grows beyond all numbers within a period is not stable, though its poles cannot be computed.
        Ok(Analysis::NotPossible(NotAnalysed::Failed(error @ StabilityError::Overflow { .. }))) => {
            (LinearLoop::Unstable(error.to_string()), None, None)
        }
        Ok(Analysis::NotPossible(why)) => {
            (LinearLoop::NotAnalysed, None, Some(format!("the run alone is judged: {why}")))
        }
        Err(error) => (LinearLoop::NotAnalysed, None, Some(format!("the run alone is judged: {error}"))),
    }
}

/// The slowest poles of a report.
fn poles(report: &Report) -> Poles {
    let oscillating = report.slowest_oscillating;
    Poles {
        oscillating: oscillating.map(|pole| Oscillation { frequency: pole.frequency, decay: -pole.growth }),
        slowest_real: report.slowest_real.map(|pole| -pole.growth),
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
