//! The modal fit over windows of several lengths and starts: the mode belongs to the axis, whatever part of its ringing is fitted.
//!
//! Linear axes with one dominant mode, a weaker one at least 25 % away, real poles of a loop, noise and counts of an encoder. Each record is
//! measured from the end of the profile to its end, and over shorter windows that begin later or end earlier and show five periods.
use core::f64::consts::PI;
use servobench_metrics::{Mode, Signal, fit_mode};
use servobench_testkit::Random;

/// Axes; more by `SERVOBENCH_SWEEP=3000`.
const AXES: usize = 60;
/// Windows of each.
const WINDOWS: usize = 6;
/// Windows per permitted difference: a fit of four components from a short piece ends beside the best one sometimes, in 1 of 1000.
const FOR_ONE: usize = 500;
/// Largest relative change of the mode by a window, beside the smallest vibration that matters.
const SHARE: f64 = 0.01;
/// Periods in a window.
const PERIODS: f64 = 5.0;
/// Powers of e by which the envelope falls while a mode is visible: to 5 %.
const VISIBLE: f64 = 3.0;

/// `amplitude·e^{−ζωt}·cos(ω_d·t + phase)`.
#[derive(Debug, Clone, Copy)]
struct Ringing {
    amplitude: f64,
    frequency: f64,
    damping: f64,
    phase: f64,
}

impl Ringing {
    /// ζω (1/s).
    fn decay(&self) -> f64 {
        2.0 * PI * self.frequency * self.damping
    }

    fn at(&self, t: f64) -> f64 {
        let damped = 2.0 * PI * self.frequency * (1.0 - self.damping * self.damping).sqrt();
        self.amplitude * (-self.decay() * t).exp() * (damped * t + self.phase).cos()
    }
}

/// A record of an axis after a move.
#[derive(Debug)]
struct Axis {
    dominant: Ringing,
    values: Vec<f64>,
    step: f64,
    /// The largest swing that does not matter: a thousandth of a window, four increments, five standard deviations of the noise.
    least: f64,
    increment: f64,
    /// True if its frequency is compared, too.
    is_given: bool,
}

/// Rows `from`..`to` of a record.
#[derive(Debug, Clone, Copy)]
struct Window {
    from: usize,
    to: usize,
}

/// Nearly normal, of standard deviation 1: the sum of twelve.
fn normal(random: &mut Random) -> f64 {
    (0..12).map(|_| random.unit()).sum::<f64>() - 6.0
}

impl Axis {
    fn drawn(random: &mut Random) -> Self {
        let frequency = random.logarithmic(8.0, 200.0);
        let dominant = Ringing {
            amplitude: random.logarithmic(1e-7, 1e-3),
            frequency,
            damping: if random.once_in(8) { 0.0 } else { random.logarithmic(1e-3, 0.05) },
            phase: random.between(-PI, PI),
        };
        let is_given = random.once_in(2);
        // With its frequency given, a mode may be the smaller one later on; otherwise the weaker one dies sooner.
        let sooner = if is_given { random.logarithmic(0.3, 3.0) } else { random.logarithmic(1.0, 3.0) };
        let beside = if random.once_in(2) { random.between(0.2, 0.7) } else { random.logarithmic(1.4, 5.0) };
        let damping = (sooner * dominant.damping / beside).min(0.3);
        let weaker = Ringing {
            amplitude: if random.once_in(3) { 0.0 } else { dominant.amplitude * random.logarithmic(0.01, 0.5) },
            frequency: beside * frequency,
            damping,
            phase: random.between(-PI, PI),
        };
        let seconds = random.logarithmic(8.0, 60.0) / frequency;
        let tails = [(); 2].map(|()| {
            let height = if random.once_in(2) { 0.0 } else { dominant.amplitude * random.signed() * 10.0 };
            (height, seconds * random.logarithmic(0.05, 1.0))
        });
        let (rate, offset) = (random.one_of(&[8000.0, 16_000.0]), dominant.amplitude * random.signed());
        let noise = if random.once_in(3) { dominant.amplitude * random.logarithmic(1e-5, 1e-2) } else { 0.0 };
        let increment = if random.once_in(3) { dominant.amplitude * random.logarithmic(1e-5, 1e-2) } else { 0.0 };
        let times = (0_u32..).map(|k| f64::from(k) / rate).take_while(|t| *t < seconds);
        let values = times
            .map(|t| {
                let settling: f64 = tails.iter().map(|(height, tau)| height * (-t / tau).exp()).sum();
                let y = offset + settling + dominant.at(t) + weaker.at(t) + noise * normal(random);
                if increment > 0.0 { increment * (y / increment).round() } else { y }
            })
            .collect();
        let least = (4.0 * increment).max(5.0 * noise).max(dominant.amplitude * random.logarithmic(1e-6, 1e-2));
        Self { dominant, values, step: 1.0 / rate, least, increment, is_given }
    }

    fn whole(&self) -> Window {
        Window { from: 0, to: self.values.len() }
    }

    fn seconds(&self, rows: usize) -> f64 {
        rows as f64 * self.step
    }

    /// Periods that `window` shows: while the envelope is above 5 % of its value at the end of the profile, and above the smallest
    /// vibration that matters.
    fn visible(&self, window: Window) -> f64 {
        let height = (self.dominant.amplitude / self.least).ln().min(VISIBLE);
        let [from, to] = [window.from, window.to].map(|row| self.seconds(row));
        let lasts = to.min(height / self.dominant.decay()) - from;
        (self.dominant.frequency * lasts).max(0.0)
    }

    /// Envelope of the dominant mode at the beginning of `window`.
    fn envelope(&self, window: Window) -> f64 {
        self.dominant.amplitude * (-self.dominant.decay() * self.seconds(window.from)).exp()
    }

    fn mode(&self, window: Window) -> Result<Mode, String> {
        let signal = Signal {
            values: &self.values[window.from..window.to],
            start: self.seconds(window.from),
            step: self.step,
            resolution: self.increment,
            least: self.least,
        };
        fit_mode(&signal, self.is_given.then_some(self.dominant.frequency)).map_err(|why| why.to_string())
    }

    /// Distance of the mode of `window` from that of the `whole`, relative to the tolerance: amplitude, frequency and envelope at the end.
    ///
    /// The swing that does not matter is a part of the envelope where the window begins.
    fn away(&self, window: Window, mode: &Mode, whole: &Mode) -> f64 {
        let granted = SHARE + self.least / self.envelope(window);
        let periods = self.visible(window);
        let amplitude = (mode.amplitude / whole.amplitude - 1.0).abs();
        let frequency = (mode.frequency / whole.frequency - 1.0).abs();
        let fading = 2.0 * PI * periods * (mode.damping - whole.damping).abs();
        amplitude.max(frequency).max(fading) / granted
    }
}

/// Windows that begin later and others that end earlier, each with five visible periods.
fn windows(axis: &Axis, random: &mut Random) -> Vec<Window> {
    let rows = axis.values.len();
    let all = (0..20 * WINDOWS).map(|k| {
        let (from, to) = (random.index(rows), 1 + random.index(rows));
        match k % 3 {
            0 => Window { from, to: rows },
            1 => Window { from: 0, to },
            _ => Window { from: from.min(to - 1), to: to.max(from + 1) },
        }
    });
    all.filter(|window| axis.visible(*window) >= PERIODS).take(WINDOWS).collect()
}

#[test]
fn a_mode_does_not_depend_on_the_window() {
    let axes = std::env::var("SERVOBENCH_SWEEP").ok().and_then(|size| size.parse().ok()).unwrap_or(AXES);
    let mut random = Random::seeded(31);
    let (mut compared, mut wrong) = (0, Vec::new());
    let mut farthest = 0.0_f64;
    while compared < axes * WINDOWS {
        let axis = Axis::drawn(&mut random);
        if axis.visible(axis.whole()) < PERIODS {
            continue;
        }
        let windows = windows(&axis, &mut random);
        compared += windows.len();
        let described = || {
            let Axis { dominant, step, least, increment, is_given, values } = &axis;
            format!(
                "{dominant:?}, {} rows of {step} s, r {least:e}, increment {increment:e}, given {is_given}",
                values.len()
            )
        };
        let whole = match axis.mode(axis.whole()) {
            Ok(whole) => whole,
            Err(why) => {
                wrong.push(format!("{}: no mode over the whole: {why}", described()));
                continue;
            }
        };
        for window in windows {
            match axis.mode(window) {
                Ok(mode) => {
                    let away = axis.away(window, &mode, &whole);
                    farthest = farthest.max(away);
                    if away > 1.0 {
                        wrong.push(format!("{}: {window:?} {mode:?} is not {whole:?}", described()));
                    }
                }
                Err(why) => wrong.push(format!("{}: {window:?}: {why}", described())),
            }
        }
    }
    println!("{compared} windows: {} differ; the farthest at {farthest:.3} of what is granted", wrong.len());
    assert!(wrong.len() * FOR_ONE <= compared, "{} of {compared}: {:#?}", wrong.len(), &wrong[..wrong.len().min(12)]);
}
