//! Runs with an initial deviation: whether it grows, and how fast.
//!
//! Without friction, limits and quantisation a run of a deviation of 1e-9 is linear: what is not, currents times angles, is smaller
//! by 1e-9. So it may grow and fall by many orders of magnitude.
//!
//! Whether it grows in the long run is read from the modes that it shows ([`modes`]): the largest growth among them, found alike in
//! the third and in the last quarter of the run so far. It counts when it has changed the deviation by a good deal, so that what is
//! small beside it has had time to show; at the end of the longest run, when it is more than rounding. No single number, as the
//! largest deviation, tells: a fast mode that fades slowly hides a slow one that grows.
use crate::modes;
use servobench_base::Rate;
use servobench_plant::Exact;
use servobench_scenario::Scenario;
use servobench_sim::{Bench, External, Stepper};

/// Ticks over which the largest deviation is taken.
const WINDOW: usize = 2_000;
/// Windows of the longest run.
const LONGEST: usize = 2_400;
/// Windows after which a run is looked at first.
const FIRST: usize = 8;
/// Samples that are kept: every second one is dropped when there are more.
const MOST_SAMPLES: usize = 4_096;
/// By how much two quarters may differ about the growth.
const ALIKE: f64 = 0.1;
/// e to this is what the growth has made of the deviation by now, at least; or its inverse.
const TELLING: f64 = 0.2;
/// The same at the end of the longest run. Modes on the circle show what rounding alone makes of them: 1e-11 1/s, 4e-9 in 400 s.
const TELLING_AT_THE_END: f64 = 1e-6;
/// Channels in which modes are looked for. Positions have a pole at 1 where no position loop is closed.
const SHOWN: [&str; 5] =
    ["motor.velocity", "table.velocity", "load.velocity", "velocity.reference", "effort.reference"];

/// The largest change of velocity within a tick, of each window, as a logarithm: slow modes count less in it, and the motor is
/// pushed in the first tick, so that fast ones are there from the beginning.
pub(crate) struct Deviation {
    stepper: Stepper,
    last: [f64; 2],
    /// Channels that are looked at.
    channels: [usize; 2],
    pub(crate) logarithms: Vec<f64>,
    /// Channels of the samples.
    shown: Vec<usize>,
    samples: Vec<Vec<f64>>,
    /// Ticks from sample to sample, a multiple of the common period of the loops.
    stride: u64,
}

impl Deviation {
    pub(crate) fn new(scenario: &Scenario) -> Self {
        let bench = Bench::new(scenario, &Exact).unwrap_or_else(|error| panic!("{error}"));
        let stepper = bench.into_stepper();
        let index = |name: &str| stepper.channels().iter().position(|spec| spec.name == name);
        let channels = ["motor.velocity", "load.velocity"].map(|name| index(name).unwrap_or_else(|| panic!("{name}")));
        let shown = SHOWN.into_iter().filter_map(index).collect();
        let (samples, stride) = (Vec::new(), common_period(scenario));
        Self { stepper, last: [0.0; 2], channels, logarithms: Vec::new(), shown, samples, stride }
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
            let tick = self.stepper.tick().0;
            let values = self.stepper.values();
            if tick.is_multiple_of(self.stride) {
                self.samples.push(self.shown.iter().map(|channel| values[*channel]).collect());
            }
            let now = self.channels.map(|channel| values[channel]);
            largest = now.iter().zip(self.last).map(|(now, last)| (now - last).abs()).fold(largest, f64::max);
            self.last = now;
            if self.samples.len() == MOST_SAMPLES {
                let mut is_kept = true;
                self.samples.retain(|_| {
                    is_kept = !is_kept;
                    is_kept
                });
                self.stride *= 2;
            }
        }
        self.logarithms.push(largest.ln());
    }

    /// Growth from window to window by least squares over the last half.
    pub(crate) fn slope(&self) -> f64 {
        slope(&self.logarithms[self.logarithms.len() / 2..])
    }

    /// Growth of the mode that grows most, from window to window.
    ///
    /// # Errors
    /// [`NotTold`] where the run does not tell it by now.
    fn growth(&self, telling: f64) -> Result<f64, NotTold> {
        let quarter = self.samples.len() / 4;
        let per_second = f64::from(self.stepper.base_rate().hertz()) / self.stride as f64;
        let found = [2, 3].map(|i| modes::largest(&self.samples[i * quarter..(i + 1) * quarter]));
        let quarters = found.map(|mode| mode.map_or(f64::NAN, |mode| mode.growth * per_second));
        let [third, last] = quarters;
        let seconds = self.logarithms.len() as f64 * self.seconds();
        let tells = (third - last).abs() < ALIKE * last.abs() && last.abs() * seconds > telling;
        if tells { Ok(last * self.seconds()) } else { Err(NotTold { quarters, seconds }) }
    }

    /// Seconds of a window.
    pub(crate) fn seconds(&self) -> f64 {
        WINDOW as f64 * self.stepper.base_rate().period()
    }
}

/// Base ticks after which all loops of `scenario` are due together again.
fn common_period(scenario: &Scenario) -> u64 {
    let drive = scenario.actuator.drive().unwrap_or_else(|| panic!("a motor with a drive"));
    let params = &drive.params;
    let mut rates = vec![params.velocity_rate(), params.position_rate()];
    rates.extend(params.current_loop().map(|(_, rate)| rate));
    let every = |rate: &Rate| u64::from(scenario.base_rate.hertz() / rate.hertz());
    let every: Vec<u64> = rates.iter().map(every).collect();
    let mut period = 1;
    while !every.iter().all(|every| u64::is_multiple_of(period, *every)) {
        period += 1;
    }
    period
}

/// A run that does not tell whether a deviation grows.
#[derive(Debug, Clone, Copy)]
#[expect(dead_code, reason = "it is shown")]
pub(crate) struct NotTold {
    /// The largest growth that its third and its last quarter show (1/s).
    quarters: [f64; 2],
    /// How long it is (s).
    seconds: f64,
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

/// Growth of a deviation of `scenario` in the long run, from window to window.
///
/// # Errors
/// [`NotTold`] where even the longest run hardly tells.
pub(crate) fn growth(scenario: &Scenario) -> Result<f64, NotTold> {
    let mut deviation = Deviation::new(scenario);
    let (mut largest, mut next) = (f64::NEG_INFINITY, FIRST);
    for count in 1..=LONGEST {
        deviation.window();
        let now = deviation.logarithms[count - 1];
        // Of a deviation of 1e-9: has become large, or is 43 orders of magnitude below what it was.
        if now > (1e-2_f64).ln() {
            return Ok(if now.is_finite() && count > FIRST { deviation.slope() } else { f64::INFINITY });
        }
        if count > FIRST && now < largest - 100.0 {
            return Ok(deviation.slope());
        }
        largest = largest.max(now);
        if count == next {
            next += next.div_ceil(2);
            if let Ok(growth) = deviation.growth(TELLING) {
                return Ok(growth);
            }
        }
    }
    deviation.growth(TELLING_AT_THE_END)
}
