//! External efforts on the axis.
use servobench_scenario::{Disturbance, DisturbedBody};
use std::f64::consts::TAU;

/// Sum of the disturbing efforts on the body `on` at `t` (s), held over the tick.
pub(crate) fn effort_at(disturbances: &[Disturbance], on: DisturbedBody, t: f64) -> f64 {
    disturbances
        .iter()
        .filter(|disturbance| disturbance.on == on)
        .map(|disturbance| {
            let since = t - disturbance.start;
            if since < 0.0 || since >= disturbance.duration {
                return 0.0;
            }
            disturbance.effort * disturbance.frequency.map_or(1.0, |f| libm::sin(TAU * f * since))
        })
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_lasts_as_long_as_it_says_and_a_sine_starts_at_zero() {
        let step = Disturbance { on: DisturbedBody::Load, start: 0.5, duration: 0.2, effort: 7.0, frequency: None };
        let sine = Disturbance { start: 0.0, duration: f64::INFINITY, frequency: Some(10.0), ..step.clone() };
        let both = [step, sine];
        let at = |t| effort_at(&both, DisturbedBody::Load, t);
        assert!(at(0.0).abs() < 1e-15 && (at(0.025) - 7.0).abs() < 1e-12);
        assert!((at(0.625) - 14.0).abs() < 1e-10 && (at(0.725) - 7.0).abs() < 1e-10);
        assert!(effort_at(&both, DisturbedBody::Motor, 0.6).abs() < 1e-15);
    }
}
