//! Bounds on the signals of an axis.
use servobench_plant::inverter;
use servobench_scenario::{Actuator, Scenario};
use servobench_signals::Signal;

/// Signals with the largest magnitude that motor and drive allow them (SI); those without a bound are left out.
#[must_use]
pub fn channel_limits(scenario: &Scenario) -> Vec<(Signal, f64)> {
    let effort = (Signal::EffortReference, scenario.actuator.max_effort());
    let limits = match &scenario.actuator {
        Actuator::Pmsm { dc_link, drive, .. } => {
            let voltage = inverter::voltage_limit(*dc_link);
            let current = drive.params.current_loop().map_or(f64::INFINITY, |(current, _)| current.max_current);
            vec![effort, (Signal::CurrentQ, current), (Signal::VoltageMagnitude, voltage)]
        }
        Actuator::IdealSource { source, .. } => vec![effort, (Signal::CommandOutput, source.limit)],
        Actuator::Prescribed | Actuator::Off(_) => Vec::new(),
    };
    limits.into_iter().filter(|(_, limit)| limit.is_finite()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inverter_bounds_the_voltage_and_the_motor_its_current() {
        let (_, demo) = servobench_scenario::embedded_demo().into_iter().next().unwrap();
        let demo = servobench_scenario::parse("demo", demo, None).unwrap_or_else(|e| panic!("{e}")).scenario;
        let limits = channel_limits(&demo);
        let of = |signal| limits.iter().find(|(limited, _)| *limited == signal).map(|(_, limit)| *limit);
        // `dc_link = "320 V"`: 320 V/√3 without overmodulation; `max_torque = "6.09 Nm"`.
        assert!((of(Signal::VoltageMagnitude).unwrap() - 184.752_086).abs() < 1e-6, "{limits:?}");
        assert_eq!((of(Signal::EffortReference), limits.len()), (Some(6.09), 3));
        let free = Scenario { actuator: Actuator::Prescribed, ..demo };
        assert_eq!(channel_limits(&free), []);
    }
}
