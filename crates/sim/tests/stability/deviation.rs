//! Runs with an initial deviation: whether it grows, and how fast.
//!
//! Without friction, limits and quantisation a run of a deviation of 1e-9 is linear: what is not, currents times angles, is smaller
//! by 1e-9. So it may grow and fall by many orders of magnitude.
use servobench_plant::Exact;
use servobench_scenario::Scenario;
use servobench_sim::{Bench, External, Stepper};

/// Ticks over which the largest deviation is taken.
const WINDOW: usize = 2_000;
/// Windows of the longest run.
const LONGEST: usize = 2_400;

/// The largest change of velocity within a tick, of each window, as a logarithm: slow modes count less in it, and the motor is
/// pushed in the first tick, so that fast ones are there from the beginning.
pub(crate) struct Deviation {
    stepper: Stepper,
    last: [f64; 2],
    /// Channels that are looked at.
    channels: [usize; 2],
    pub(crate) logarithms: Vec<f64>,
}

impl Deviation {
    pub(crate) fn new(scenario: &Scenario) -> Self {
        let bench = Bench::new(scenario, &Exact).unwrap_or_else(|error| panic!("{error}"));
        let stepper = bench.into_stepper();
        let index = |name: &str| stepper.channels().iter().position(|spec| spec.name == name);
        let channels = ["motor.velocity", "load.velocity"].map(|name| index(name).unwrap_or_else(|| panic!("{name}")));
        Self { stepper, last: [0.0; 2], channels, logarithms: Vec::new() }
    }

    pub(crate) fn window(&mut self) {
        let mut largest = 0.0_f64;
        for _ in 0..WINDOW {
            // What grows beyond all numbers within a window ends the run.
            let motor_effort = if self.stepper.tick().0 == 0 { 1e-7 } else { 0.0 };
            if self.stepper.step(&External { motor_effort, ..External::default() }).is_err() {
                largest = f64::INFINITY;
                break;
            }
            let values = self.stepper.values();
            let now = self.channels.map(|channel| values[channel]);
            largest = now.iter().zip(self.last).map(|(now, last)| (now - last).abs()).fold(largest, f64::max);
            self.last = now;
        }
        self.logarithms.push(largest.ln());
    }

    /// Growth from window to window by least squares over the last half.
    pub(crate) fn slope(&self) -> f64 {
        slope(&self.logarithms[self.logarithms.len() / 2..])
    }

    /// Seconds of a window.
    pub(crate) fn seconds(&self) -> f64 {
        WINDOW as f64 * self.stepper.base_rate().period()
    }
}

fn slope(logarithms: &[f64]) -> f64 {
    let middle = (logarithms.len() - 1) as f64 / 2.0;
    let (mut above, mut below) = (0.0, 0.0);
    for (i, logarithm) in logarithms.iter().enumerate() {
        above += (i as f64 - middle) * logarithm;
        below += (i as f64 - middle).powi(2);
    }
    above / below
}

/// Growth of a deviation of `scenario` in the long run, from window to window; `None` where even the longest run hardly tells,
/// since other modes fade as slowly.
pub(crate) fn growth(scenario: &Scenario) -> Option<f64> {
    let mut deviation = Deviation::new(scenario);
    let mut largest = f64::NEG_INFINITY;
    for count in 1..=LONGEST {
        deviation.window();
        let logarithms = &deviation.logarithms;
        let now = logarithms[count - 1];
        // Of a deviation of 1e-9: has become large, or is 43 orders of magnitude below what it was.
        if now > (1e-2_f64).ln() {
            return Some(if now.is_finite() && count > 8 { deviation.slope() } else { f64::INFINITY });
        }
        if count > 8 && now < largest - 100.0 {
            return Some(deviation.slope());
        }
        largest = largest.max(now);
        if count >= 100 && count.is_multiple_of(100) {
            let quarter = count / 4;
            let [third, last] = [2, 3].map(|i| slope(&logarithms[i * quarter..(i + 1) * quarter]));
            // One mode is left, and it has changed by more than what is beside it can have.
            if (third - last).abs() < 0.1 * last.abs() && last.abs() * quarter as f64 > 0.5 {
                return Some(last);
            }
        }
    }
    None
}
