//! Sweeps with results that are made up: time and vibration of an axis with a resonance.
use servobench_sweep::{
    Arrangement, Axis, Column, Distribution, Drawn, Draws, Method, Outcome, Spacing, Sweep, Table, Value,
};

/// A sweep with its engines, of which a table is made.
pub(crate) struct Sample {
    pub(crate) sweep: Sweep,
    pub(crate) engines: Vec<String>,
}

/// What a run gave: numbers in the order of [`METRICS`], and how it ended.
pub(crate) type Run = ([f64; 4], Outcome);

pub(crate) const METRICS: [(&str, &str); 4] = [
    ("move_and_settling_time", "s"),
    ("residual_vibration_amplitude", "m"),
    ("following_error_peak_load", "m"),
    ("torque_peak", "N m"),
];

impl Sample {
    pub(crate) fn new(axes: Vec<Axis>, arrangement: Arrangement, draws: Option<Draws>) -> Self {
        let sweep = Sweep::new(axes, arrangement, draws).unwrap();
        Self { sweep, engines: vec!["exact".to_owned()] }
    }

    /// The table of `run` of the engine's place and the point's settings.
    pub(crate) fn table(&self, run: impl Fn(usize, &[Value]) -> Run) -> Table<'_> {
        let rows = self.engines.len() * self.sweep.points();
        let runs: Vec<Run> = (0..rows)
            .map(|row| {
                let point = self.sweep.point(row % self.sweep.points());
                run(row / self.sweep.points(), &point.into_iter().map(|setting| setting.value).collect::<Vec<_>>())
            })
            .collect();
        let column = |(k, (name, unit)): (usize, &(&str, &str))| Column {
            name: (*name).to_owned(),
            unit: (*unit).to_owned(),
            values: runs.iter().map(|run| run.0[k]).collect(),
        };
        let columns = METRICS.iter().enumerate().map(column).collect();
        let outcomes = runs.iter().map(|run| run.1).collect();
        Table { sweep: &self.sweep, engines: &self.engines, columns, outcomes }
    }
}

pub(crate) fn names(key: &str, names: &[&str]) -> Axis {
    Axis { key: key.to_owned(), values: names.iter().map(|name| Value::Text((*name).to_owned())).collect() }
}

pub(crate) fn jerk(count: usize) -> Axis {
    Axis::range("setpoint.jerk", [10.0, 1000.0], "m/s3", count, Spacing::Logarithmic).unwrap()
}

pub(crate) fn mass(count: usize) -> Axis {
    Axis::range("axis.load.mass", [2.0, 8.0], "kg", count, Spacing::Linear).unwrap()
}

pub(crate) fn tolerances(count: u32) -> Draws {
    let of = |key: &str, unit: &str, distribution| Drawn { key: key.to_owned(), unit: unit.to_owned(), distribution };
    let keys = vec![
        of("axis.load.mass", "kg", Distribution::Normal { mean: 5.0, sigma: 0.15 }),
        of("axis.spring.stiffness", "N/m", Distribution::Uniform { low: 45_000.0, high: 55_000.0 }),
        of("axis.friction.coulomb", "N", Distribution::Triangular { low: 5.0, mode: 8.0, high: 14.0 }),
    ];
    Draws::new(count, 1, Method::LatinHypercube, keys).unwrap()
}

/// What a move with this jerk does to a load on a spring, of this order: the more jerk the sooner it is there and the more it rings, with zeros
/// where the ramps are as long as the period.
pub(crate) fn ringing(jerk: f64, mass: f64, stiffness: f64, order: f64) -> Run {
    let omega = (stiffness / mass).sqrt();
    let ramp = (20.0 / jerk).cbrt() / 2.0;
    let duration = 0.35 + 2.0 * ramp + 0.05 * (order - 3.0);
    let shape = (omega * ramp / 2.0).sin().abs() + 0.02;
    let amplitude = 1e-3 * shape * (1.0 / (omega * ramp)).powf(order - 1.0);
    let settling = 0.04 * (1.0 + (amplitude / 5e-6)).ln();
    let error = 2e-5 * jerk.powf(0.3) * mass / 5.0;
    let outcome = if amplitude > 2.5e-6 { Outcome::Failed } else { Outcome::Good };
    ([duration + settling, amplitude, error, mass * jerk.powf(0.5) * 0.01], outcome)
}

/// The number of setting `k`.
pub(crate) fn number(settings: &[Value], k: usize) -> f64 {
    settings[k].number().unwrap()
}

/// Writes `text` into the folder that `SERVOBENCH_SHOW` names, for whoever wants to look at it.
pub(crate) fn shown(name: &str, text: String) -> String {
    if let Some(folder) = std::env::var_os("SERVOBENCH_SHOW") {
        let folder = std::path::PathBuf::from(folder);
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join(name), &text).unwrap();
    }
    text
}
