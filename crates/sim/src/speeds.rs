//! Speeds that the task asks of the motor, and how long it stays with them.
use crate::bench::Bench;
use crate::error::BuildError;
use crate::program::Program;
use servobench_scenario::Scenario;
use servobench_signals::Signal;
use servobench_trace::Recording;
use std::ops::Range;

/// Places in which a program is looked at, at most.
const MOST_PLACES: f64 = 1e6;

/// Speeds of the motor (rad/s or m/s) that the task asks for, at even distances in time.
#[derive(Debug, Clone, PartialEq)]
pub struct Speeds {
    /// From one to the next (s).
    step: f64,
    values: Vec<f64>,
}

impl Speeds {
    /// Those of the planned moves; `None` for a program of function blocks, whose moves only a run makes.
    ///
    /// # Errors
    /// [`BuildError`] of a program that cannot be planned.
    pub fn planned(scenario: &Scenario) -> Result<Option<Self>, BuildError> {
        if scenario.plc.is_some() {
            return Ok(None);
        }
        // What is interpolated comes later; what was planned is what was asked for.
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

    /// Those of a run on an axis with so many axis coordinates per motor coordinate; `None` where they were not recorded.
    #[must_use]
    pub fn recorded(recording: &Recording, transmission: f64) -> Option<Self> {
        let velocities = recording.channel(Signal::RequestVelocity)?;
        let values = velocities.iter().map(|velocity| (velocity / transmission).abs()).collect();
        Some(Self { step: recording.time_of(1) - recording.time_of(0), values })
    }

    /// The longest time (s) for which the speed is within `range`.
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
