//! The two signals of a sine–cosine encoder and the angle that is read from them.
//!
//! ```text
//! φ = 2π·x/P      A = (1 + a)·cos φ + o_A      B = sin(φ + ε) + o_B      φ_m = atan2(B, A)
//! ```
//! The position read is that of the signal period of x, which the evaluation counts, and φ_m within it. Errors repeat
//! with the period, to first order (Heydemann, *Determination and correction of quadrature fringe measurement errors in
//! interferometers*, Applied Optics 20(19), 1981):
//!
//! | error | of the position | exactly, of φ |
//! |---|---|---|
//! | amplitude a | P/(4π)·a, twice per period | asin(a/(2 + a)) |
//! | offset o | P/(2π)·o, once per period | asin(o) |
//! | phase ε | P/(4π)·ε, twice per period, about a mean of P/(4π)·ε | asin(tan(ε/2)) about ε/2 |
//!
//! A lost track has no amplitude: the rest cannot be counted, and the position stays within the period in
//! which that happened. The evaluation monitors the length of (A, B), which is 1 without errors: an error bit is set when it
//! leaves 0.5 to 1.5 (assumed: bounds differ from one evaluation to the next) and stays set.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use super::turn;
use core::f64::consts::TAU;
use servobench_base::{ParamError, Stateful};

servobench_config::choices! {
    /// A signal of a sine–cosine encoder.
    pub enum Track {
        /// the sine
        Sine = "sine",
        /// the cosine
        Cosine = "cosine",
    }
}

/// Signals of a sine–cosine encoder.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Signals {
    /// Signal period (rad or m); meaningless without periodic errors.
    pub period: f64,
    /// Excess of the cosine's amplitude over that of the sine, as a share.
    pub amplitude_error: f64,
    /// Offsets of cosine and sine, as shares of the amplitude.
    pub offset: [f64; 2],
    /// Excess over a right angle of the sine from the cosine (rad, electrical).
    pub phase_error: f64,
    /// A track that fails, and the time of failure (s).
    pub lost: Option<(Track, f64)>,
}

/// Lengths of (A, B) that the evaluation accepts.
const MONITORED: core::ops::RangeInclusive<f64> = 0.5..=1.5;

const PER_TURN: f64 = 1.0 / TAU;

const fn squared(x: f64) -> f64 {
    x * x
}

impl Signals {
    /// Signals without errors.
    #[must_use]
    pub const fn ideal(period: f64) -> Self {
        Self { period, amplitude_error: 0.0, offset: [0.0; 2], phase_error: 0.0, lost: None }
    }

    /// True if there is any error that repeats with their period.
    #[must_use]
    pub fn errs(&self) -> bool {
        *self != Self::ideal(self.period)
    }

    /// Width, from lowest to highest, of the error of the position within a signal period (rad or m), to first order in the errors;
    /// an upper bound, since those once and twice per period need not add.
    #[must_use]
    pub fn error_width(&self) -> f64 {
        let twice = libm::hypot(self.amplitude_error, self.phase_error);
        self.period * PER_TURN * (twice + 2.0 * libm::hypot(self.offset[0], self.offset[1]))
    }

    /// # Errors
    /// [`ParamError`] for errors with which the signals no longer circle zero.
    pub(super) fn check(&self) -> Result<(), ParamError> {
        // The shortest vector of the ellipse, less the offset.
        let shortest = (1.0 + self.amplitude_error).min(1.0) * libm::cos(self.phase_error);
        let left = shortest - libm::hypot(self.offset[0], self.offset[1]);
        if left > 0.0 {
            return Ok(());
        }
        let bound = "small enough for the signals to go round zero";
        Err(ParamError { name: "errors of the encoder's signals", value: left, bound })
    }
}

/// The evaluation of the signals: its state from tick to tick.
#[derive(Debug, Clone, Stateful)]
pub(super) struct Evaluation {
    #[state(constant)]
    signals: Signals,
    /// Periods per position.
    #[state(constant)]
    per_period: f64,
    /// Sine and cosine of the phase error.
    #[state(constant)]
    skew: (f64, f64),
    /// Position read last, in periods.
    last: f64,
    /// Period in which a track was lost.
    held: Option<f64>,
    /// True once the amplitude has been rejected.
    alarm: bool,
}

impl Evaluation {
    pub(super) fn new(signals: Signals) -> Self {
        let per_period = 1.0 / signals.period;
        Self { signals, per_period, skew: libm::sincos(signals.phase_error), last: 0.0, held: None, alarm: false }
    }

    /// Reading of the true position `x` at the time `t` (s).
    #[inline(always)]
    pub(super) fn read(&mut self, x: f64, t: f64) -> f64 {
        let Signals { amplitude_error, offset, lost, .. } = self.signals;
        let periods = x * self.per_period;
        let within = periods - turn::whole(periods);
        let rotation = turn::rotation(within);
        let (sine, cosine) = (rotation.sin * self.skew.1 + rotation.cos * self.skew.0, rotation.cos);
        let lost = lost.and_then(|(track, at)| (t >= at).then_some(track));
        let of = |track, amplitude: f64| if lost == Some(track) { 0.0 } else { amplitude };
        let a = of(Track::Cosine, (1.0 + amplitude_error) * cosine) + offset[0];
        let b = of(Track::Sine, sine) + offset[1];
        self.alarm |= !(squared(*MONITORED.start())..=squared(*MONITORED.end())).contains(&(a * a + b * b));
        let found = if lost.is_some() {
            let read = libm::atan2(b, a) * PER_TURN;
            read + *self.held.get_or_insert(turn::whole(self.last - read))
        } else {
            // The angle between reading and true position: within half a period, and small.
            let (across, along) = (b * rotation.cos - a * rotation.sin, a * rotation.cos + b * rotation.sin);
            periods + libm::atan2(across, along) * PER_TURN
        };
        self.last = found;
        found * self.signals.period
    }

    /// True once the amplitude of the signals has been rejected.
    pub(super) const fn alarm(&self) -> bool {
        self.alarm
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD: f64 = 20e-6;

    /// Largest and smallest error over a period, in rad of the signal, away from the grid of periods.
    fn extremes(signals: Signals) -> [f64; 2] {
        let mut evaluation = Evaluation::new(signals);
        let errors = (0..200_000).map(|k| {
            let x = 37.0 * PERIOD + f64::from(k) * PERIOD / 200_000.0;
            (evaluation.read(x, 0.0) - x) / PERIOD * TAU
        });
        errors.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], e| [low.min(e), high.max(e)])
    }

    /// To the grid of 200 000 points, at whose distance from the peak the error is (π/1e5)²/2 = 5e-10 of itself lower, and 1e-11 for
    /// the rounding of 37 periods.
    fn close(found: f64, expected: f64) -> bool {
        (found / expected - 1.0).abs() < 1e-8
    }

    /// Oracle: the closed forms of the module, exact and to first order.
    #[test]
    fn each_error_has_its_size() {
        let none = Signals::ideal(PERIOD);
        for a in [0.02, -0.013, 0.31] {
            let [low, high] = extremes(Signals { amplitude_error: a, ..none });
            let expected = (a / (2.0 + a)).asin().abs();
            assert!(close(high, expected) && close(-low, expected), "{a}: {low} {high} {expected}");
            assert!((expected / (a / 2.0).abs() - 1.0).abs() < a.abs(), "P/(4π)·a to first order");
        }
        for o in [[0.017, 0.0], [0.0, 0.03], [0.02, -0.05]] {
            let [low, high] = extremes(Signals { offset: o, ..none });
            let expected = o[0].hypot(o[1]).asin();
            assert!(close(high, expected) && close(-low, expected), "{o:?}: {low} {high} {expected}");
        }
        for e in [0.017, 0.2_f64] {
            let [low, high] = extremes(Signals { phase_error: e, ..none });
            let expected = (e / 2.0).tan().asin();
            assert!(close(high - e / 2.0, expected) && close(e / 2.0 - low, expected), "{e}: {low} {high} {expected}");
        }
    }

    /// Oracle: the errors themselves. For one kind the width is that of the first order; together it is an upper bound, by a third at most.
    #[test]
    fn the_width_is_that_of_the_errors() {
        let none = Signals::ideal(PERIOD);
        let kinds = [
            Signals { amplitude_error: -0.02, ..none },
            Signals { offset: [0.004, -0.003], ..none },
            Signals { amplitude_error: 0.01, phase_error: -0.007, ..none },
            Signals { amplitude_error: -0.02, phase_error: -0.0077, offset: [0.0, -0.004], ..none },
        ];
        for (number, signals) in kinds.into_iter().enumerate() {
            let [low, high] = extremes(signals);
            let ratio = signals.error_width() / ((high - low) * PERIOD / TAU);
            let most = if number < 3 { 1.02 } else { 4.0 / 3.0 };
            assert!((0.98..most).contains(&ratio), "{signals:?}: {ratio}");
        }
    }

    /// Oracle: once or twice per period, by the fit of a Fourier series.
    #[test]
    fn each_error_has_its_harmonic() {
        let none = Signals::ideal(PERIOD);
        let share = |signals: Signals, order: f64| {
            let (mut evaluation, mut sum) = (Evaluation::new(signals), [0.0; 2]);
            for k in 0..1000 {
                let phase = TAU * f64::from(k) / 1000.0;
                let error = evaluation.read(PERIOD * phase / TAU, 0.0) / PERIOD * TAU - phase;
                let (sine, cosine) = (order * phase).sin_cos();
                sum = [sum[0] + error * cosine / 500.0, sum[1] + error * sine / 500.0];
            }
            sum[0].hypot(sum[1])
        };
        // The remainder beyond the first order has the size of the error.
        let small = 0.01;
        let amplitude = Signals { amplitude_error: small, ..none };
        assert!((share(amplitude, 2.0) / (small / 2.0) - 1.0).abs() < small && share(amplitude, 1.0) < 1e-12);
        let offset = Signals { offset: [small, 0.0], ..none };
        assert!((share(offset, 1.0) / small - 1.0).abs() < small && share(offset, 2.0) < small * small);
        let phase = Signals { phase_error: small, ..none };
        assert!((share(phase, 2.0) / (small / 2.0) - 1.0).abs() < small && share(phase, 1.0) < 1e-12);
    }

    #[test]
    fn without_errors_it_is_the_position() {
        let mut evaluation = Evaluation::new(Signals::ideal(PERIOD));
        for k in -5000..5000 {
            let x = f64::from(k) * 0.173 * PERIOD;
            assert!(
                (evaluation.read(x, 0.0) - x).abs() < 1e-15 * 2000.0 * PERIOD,
                "{k}: a few roundings of 865 periods"
            );
        }
        assert!(!evaluation.alarm());
    }

    /// The position stays in its period however far the scale moves, and the amplitude reports the loss.
    #[test]
    fn a_lost_track_is_not_counted_any_more() {
        for track in [Track::Sine, Track::Cosine] {
            let mut evaluation = Evaluation::new(Signals { lost: Some((track, 1.0)), ..Signals::ideal(PERIOD) });
            let start = 12.3 * PERIOD;
            assert!((evaluation.read(start, 0.99) - start).abs() < 1e-15 && !evaluation.alarm());
            for k in 0..5_000 {
                let x = start + f64::from(k) * 0.01 * PERIOD;
                let read = evaluation.read(x, 1.0 + f64::from(k));
                assert!((read - start).abs() < PERIOD, "{track:?} {k}: {}", (read - start) / PERIOD);
            }
            assert!(evaluation.alarm());
        }
    }

    #[test]
    fn signals_go_round_zero() {
        let none = Signals::ideal(PERIOD);
        assert_eq!(none.check(), Ok(()));
        for wrong in [
            Signals { offset: [0.8, 0.7], ..none },
            Signals { amplitude_error: -1.0, ..none },
            Signals { phase_error: 1.6, ..none },
            Signals { phase_error: f64::NAN, ..none },
        ] {
            assert!(wrong.check().unwrap_err().to_string().contains("go round zero"), "{wrong:?}");
        }
    }
}
