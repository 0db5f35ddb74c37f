//! An axis whose runs have a closed form: an undamped mode behind a base that follows the profile oscillates with X·∏|sin(ωT/2)/(ωT/2)|,
//! with T the moving averages of the profile; a zero-vibration shaper for f₀ after it multiplies that by |cos(πf/2f₀)|.
use servobench_advise::{Bench, Family, Machines, Question, Range, Reading, SetPoint, Stretch};
use servobench_motion::Limits;
use std::f64::consts::{PI, TAU};

/// Parameters and limits of the axis.
#[derive(Debug, Clone)]
pub(crate) struct Axis {
    pub(crate) distance: f64,
    pub(crate) ceiling: Limits,
    /// Lowest and highest frequency of the mode (Hz), and payload (kg).
    pub(crate) frequencies: [f64; 2],
    pub(crate) payloads: [f64; 2],
    /// Largest vibration (m), force (N) and following error (m); the latter is the velocity divided by the gain (1/s).
    pub(crate) vibration: f64,
    pub(crate) force: f64,
    pub(crate) following: f64,
    pub(crate) gain: f64,
    pub(crate) families: Vec<Family>,
    pub(crate) runs: usize,
}

/// A kind of set-point: its order, with or without a shaper.
pub(crate) fn family(order: u32, is_shaped: bool) -> Family {
    let shaper = is_shaped.then(|| "zv".to_owned());
    Family { order, shaper, settings: vec![], name: format!("order {order}{}", if is_shaped { ", zv" } else { "" }) }
}

impl Axis {
    pub(crate) fn middle(&self) -> f64 {
        f64::midpoint(self.frequencies[0], self.frequencies[1])
    }

    /// The moving averages of the profile, the longest first; `None` for a profile that does not reach its limits.
    fn boxes(&self, point: &SetPoint) -> Option<Vec<f64>> {
        let boxes: Vec<f64> = point.boxes(self.distance).into_iter().filter(|length| *length > 0.0).collect();
        let later = |k: usize| boxes[k + 1..].iter().sum::<f64>();
        // Limits are rounded.
        (0..boxes.len()).all(|k| boxes[k] >= 0.998 * later(k)).then_some(boxes)
    }

    fn is_shaped(&self, point: &SetPoint) -> bool {
        self.families[point.family].shaper.is_some()
    }

    /// Duration of a move (s).
    pub(crate) fn duration(&self, point: &SetPoint) -> Option<f64> {
        let shaper = if self.is_shaped(point) { 0.5 / self.middle() } else { 0.0 };
        self.boxes(point).map(|boxes| boxes.iter().sum::<f64>() + shaper)
    }

    /// A run on a machine: frequency and payload.
    pub(crate) fn reading(&self, point: &SetPoint, machine: &[f64]) -> Reading {
        let boxes = self.boxes(point).unwrap();
        let [frequency, payload] = machine else { panic!("{machine:?}") };
        let ring = |length: &f64| {
            let half = 0.5 * TAU * frequency * length;
            (half.sin() / half).abs()
        };
        let shaper = if self.is_shaped(point) { (0.5 * PI * frequency / self.middle()).cos().abs() } else { 1.0 };
        let vibration = self.distance * boxes.iter().map(ring).product::<f64>() * shaper;
        let [velocity, acceleration, ..] = point.limits;
        let usage = vec![
            vibration / self.vibration,
            payload * acceleration / self.force,
            velocity / self.gain / self.following,
        ];
        // Nothing carries a tonne.
        Reading { time: self.duration(point).unwrap(), usage, is_sound: *payload < 1_000.0 }
    }

    /// The time of a set-point, if it meets all limits on machines a hundredth of the frequency range apart.
    pub(crate) fn time_of(&self, point: &SetPoint) -> Option<f64> {
        let [low, high] = self.frequencies;
        let time = self.duration(point)?;
        let keeps = (0..=100).all(|k| {
            let frequency = low + 0.01 * f64::from(k) * (high - low);
            let reading = self.reading(point, &[frequency, self.payloads[1]]);
            // Between the machines of the verification a maximum is higher by at most 0.11 %: (π·0.03/2)²/2 of a lobe.
            reading.usage.iter().all(|usage| *usage <= 1.0011)
        });
        keeps.then_some(time)
    }

    pub(crate) fn question(&self) -> Question {
        let range = |key: &str, ends, stretch| Range { key: key.into(), ends, unit: String::new(), stretch };
        Question {
            families: self.families.clone(),
            ceiling: self.ceiling,
            machines: Machines::new(vec![
                range("frequency", self.frequencies, Stretch::Frequency),
                range("payload", self.payloads, Stretch::None),
            ]),
            frequency: self.middle(),
            limits: 3,
            distance: self.distance,
            priced: None,
            share: 0.99,
            draws: 1_000,
            seed: 1,
        }
    }
}

impl Bench for Axis {
    fn durations(&mut self, points: &[SetPoint]) -> Vec<Option<f64>> {
        points.iter().map(|point| self.duration(point)).collect()
    }

    fn run(&mut self, runs: &[(SetPoint, &[f64])]) -> Vec<Reading> {
        self.runs += runs.len();
        runs.iter().map(|(point, machine)| self.reading(point, machine)).collect()
    }
}
