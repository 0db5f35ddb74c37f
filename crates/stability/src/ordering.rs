//! Bandwidths of the loops with the true parameters of the axis, and loops that are faster than the one below.
use crate::model::{Loop, PositionFeedback, Source};
use crate::report::{LoopName, Warning};
use servobench_drive::Stage;
use std::f64::consts::TAU;

impl Loop {
    /// Frequency at which the open loop, with everything below it ideal, has the gain 1 (Hz): K_v/2π, k_p/(2π·J) and k_p/(2π·L) with
    /// the true gain and inertia of the axis, not the drive's estimates; `None` without this loop.
    pub(crate) fn bandwidth(&self, name: LoopName) -> Option<f64> {
        let p = &self.drive;
        let omega = match name {
            LoopName::Position if !self.closes_position => return None,
            LoopName::Position => match self.position_feedback {
                PositionFeedback::Motor => p.position_gain,
                PositionFeedback::Load => p.position_gain * self.mechanics.transmission() / p.transmission,
            },
            LoopName::Velocity => p.velocity.k_p * self.effort_ratio() / self.mechanics.inertia(),
            LoopName::Current => match (&p.stage, &self.source) {
                (Stage::Current { params, .. }, Source::Pmsm(motor)) => params.gains.k_p.q / motor.inductance.q,
                _ => return None,
            },
        };
        (omega > 0.0).then_some(omega / TAU)
    }

    /// Loops that are faster than the one below: a cascade relies on each loop seeing the one below it as settled.
    pub(crate) fn warnings(&self) -> Vec<Warning> {
        [(LoopName::Position, LoopName::Velocity), (LoopName::Velocity, LoopName::Current)]
            .into_iter()
            .filter_map(|(outer, inner)| {
                let (outer_bandwidth, inner_bandwidth) = (self.bandwidth(outer)?, self.bandwidth(inner)?);
                (outer_bandwidth > inner_bandwidth).then_some(Warning {
                    outer,
                    outer_bandwidth,
                    inner,
                    inner_bandwidth,
                })
            })
            .collect()
    }
}
