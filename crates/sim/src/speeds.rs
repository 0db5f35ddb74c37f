//! Speeds of the motor that the task requests, and the time spent at them.
use crate::bench::Bench;
use crate::error::BuildError;
use crate::program::Program;
use servobench_scenario::Scenario;
use servobench_signals::Signal;
use servobench_trace::Recording;
use std::ops::Range;

/// Most instants at which a program is sampled.
const MOST_PLACES: f64 = 1e6;

/// Speeds of the motor (rad/s or m/s) requested by the task, at equal intervals in time.
#[derive(Debug, Clone, PartialEq)]
pub struct Speeds {
    /// Time from one to the next (s).
    step: f64,
    values: Vec<f64>,
}

impl Speeds {
    /// Speeds of the planned moves; `None` for a program of function blocks, whose moves are known only after a run.
    ///
    /// # Errors
    /// [`BuildError`] for a program that cannot be planned.
    pub fn planned(scenario: &Scenario) -> Result<Option<Self>, BuildError> {
        if scenario.plc.is_some() {
            return Ok(None);
        }
        // Interpolated set-points are delayed; the plan has the request.
        let mut program = Program::new(&Scenario { interpolation: None, ..scenario.clone() })?;
        let base_rate = f64::from(scenario.base_rate.hertz());
        let ticks = (Bench::length(scenario)? * base_rate).floor();
        let stride = (ticks / MOST_PLACES).ceil().max(1.0);
        let (mut tick, mut values) = (0.0, Vec::new());
        while tick <= ticks {
            values.push((program.at(tick / base_rate).v / scenario.axis.transmission).abs());
            tick += stride;
        }
        Ok(Some(Self { step: stride / base_rate, values }))
    }

    /// Speeds of a run on an axis with `transmission` axis coordinates per motor coordinate; `None` if they were not recorded.
    #[must_use]
    pub fn recorded(recording: &Recording, transmission: f64) -> Option<Self> {
        let velocities = recording.channel(Signal::RequestVelocity)?;
        let values = velocities.iter().map(|velocity| (velocity / transmission).abs()).collect();
        Some(Self { step: recording.time_of(1) - recording.time_of(0), values })
    }

    /// The longest continuous time (s) for which the speed is within `range`.
    #[must_use]
    pub fn longest_within(&self, range: &Range<f64>) -> f64 {
        let runs = self.values.split(|speed| !range.contains(speed));
        runs.map(|run| run.len() as f64 * self.step).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: by hand.
    #[test]
    fn the_longest_stay_counts() {
        let speeds = Speeds { step: 0.5, values: vec![0.0, 1.0, 2.0, 2.0, 3.0, 2.0, 2.5, 2.9, 0.0] };
        for (range, expected) in [(2.0..3.0, 1.5), (3.0..f64::INFINITY, 0.5), (1.0..9.0, 3.5), (4.0..9.0, 0.0)] {
            assert!((speeds.longest_within(&range) - expected).abs() < 1e-15, "{range:?}");
        }
    }
}
