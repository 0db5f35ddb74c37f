//! Current sensors on two phases and the converter behind them.
//!
//! ```text
//! i_m = quantised((1 + g)·i(t − s) + o + noise)  of the phases a and b      i_c = −(i_a + i_b)
//! ```
//! sampled at each cycle of the current loop, and reported `delay` cycles later. If the current loop is fast enough to hold
//! the measured current at its reference, the motor has the error with the opposite sign:
//!
//! - Offsets o_a, o_b are a vector that stands in the stator, of length (2/√3)·√(o_a² + o_a·o_b + o_b²): torque at f_e.
//! - Gain errors g_a, g_b turn a current I into itself times (g_a + g_b)/2 and a vector of length I·|g_a − g_b|/√3 that turns
//!   against the rotor: torque at 2·f_e. The true currents are those of 1/(1 + g) − 1 in place of g.
//! - A delay of `τ` leaves the measured current behind by ω_e·τ: the motor's current leads the measured one by this angle.
//!
//! Source: Chung and Sul, *Analysis and Compensation of Current Measurement Error in Vector-Controlled AC Motor Drives*, IEEE
//! Transactions on Industry Applications 34(2), 1998. The formulas are derived again in docs/sensors.md.
//!
//! A sample between two ticks is interpolated linearly in the rotor frame, which is of second order in the tick.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use super::noise::Noise;
use super::turn;
use servobench_base::{AlphaBeta, Countdown, Divider, Dq, ElectricalAngle, ParamError, Rotation, Stateful};
use servobench_config::Kind::Plain;
use servobench_config::quantities::{CURRENT_NOISE, CURRENT_OF_A_PHASE, RATIO, TIME};
use servobench_config::{Bound, Measure, any, not_negative, positive};

servobench_config::parameters! {
    /// A parameter of the current sensors.
    pub enum CurrentSensorParameter {
        /// Reading of the sensor of phase a without current
        OFFSET_A "offset of the current sensor a" = any(Plain(&CURRENT_OF_A_PHASE), "0.05 A");
        /// Reading of the sensor of phase b without current
        OFFSET_B "offset of the current sensor b" = any(Plain(&CURRENT_OF_A_PHASE), "-0.02 A");
        /// Share by which the sensor of phase a reads too high
        GAIN_ERROR_A "gain error of the current sensor a" = Measure { kind: Plain(&RATIO), bound: Bound::Within(-0.9, 9.0), example: "0.01" };
        /// Share by which the sensor of phase b reads too high
        GAIN_ERROR_B "gain error of the current sensor b" = Measure { kind: Plain(&RATIO), bound: Bound::Within(-0.9, 9.0), example: "-0.01" };
        /// Noise of each sample, RMS value
        NOISE "noise of the current sensors" = not_negative(Plain(&CURRENT_NOISE), "20 mA");
        /// Largest current of the converter, in both directions
        RANGE "range of the current sensors" = positive(Plain(&CURRENT_OF_A_PHASE), "30 A");
        /// Time before its tick at which the current is sampled
        SHIFT "sampling shift of the current sensors" = not_negative(Plain(&TIME), "5 us");
    }
}

/// Most cycles of the current loop that a sample may wait.
const MOST_CYCLES: u32 = 2;

/// Two sensors, on the phases a and b.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CurrentSensor {
    /// Readings without current (A).
    pub offset: [f64; 2],
    /// Relative gain errors, positive for too large readings.
    pub gain_error: [f64; 2],
    /// Noise of each sample (A, effective).
    pub noise: f64,
    /// Seed of the noise.
    pub seed: u32,
    /// Converter; `None` for one without steps and range.
    pub converter: Option<Converter>,
    /// Delay of a sample, in cycles of the current loop.
    pub delay: u32,
    /// Sampling time before the tick (s), less than a tick.
    pub shift: f64,
}

/// An analogue-to-digital converter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Converter {
    /// Its bits, of both directions together.
    pub bits: u32,
    /// Largest current in both directions (A).
    pub range: f64,
}

impl Converter {
    /// The nearest of its values, of 2^bits from −range to a step below range.
    #[inline(always)]
    fn convert(self, current: f64) -> f64 {
        let half = (1_u64 << (self.bits - 1)) as f64;
        let step = self.range / half;
        turn::whole(current / step).clamp(-half, half - 1.0) * step
    }
}

impl CurrentSensor {
    /// The sensor with its delays and gains alone: without offsets, noise, steps and range.
    #[must_use]
    pub fn linearised(&self) -> Self {
        let Self { offset: _, gain_error, noise: _, seed: _, converter: _, delay, shift } = *self;
        Self { gain_error, delay, shift, ..Self::default() }
    }

    /// True if both have the same gain error and no others, so that it applies to the vector.
    fn errs_alike(&self) -> bool {
        let Self { offset, gain_error: [a, b], noise, seed: _, converter, delay: _, shift: _ } = *self;
        offset.iter().all(|offset| *offset == 0.0) && a.to_bits() == b.to_bits() && noise == 0.0 && converter.is_none()
    }

    /// Checks the parameters in ticks of `h` (s).
    ///
    /// # Errors
    /// [`ParamError`] names the parameter that is out of its bound.
    pub fn check(&self, h: f64) -> Result<(), ParamError> {
        use CurrentSensorParameter as P;
        for (parameter, value) in [
            (P::OFFSET_A, self.offset[0]),
            (P::OFFSET_B, self.offset[1]),
            (P::GAIN_ERROR_A, self.gain_error[0]),
            (P::GAIN_ERROR_B, self.gain_error[1]),
            (P::NOISE, self.noise),
            (P::SHIFT, self.shift),
        ] {
            parameter.check_in_words(value)?;
        }
        if self.shift >= h {
            return Err(ParamError { name: P::SHIFT.name, value: self.shift, bound: "less than a base tick" });
        }
        if self.delay > MOST_CYCLES {
            let (name, value) = ("delay of the current sensors", f64::from(self.delay));
            return Err(ParamError { name, value, bound: "at most two cycles of the current loop" });
        }
        let Some(Converter { bits, range }) = self.converter else { return Ok(()) };
        P::RANGE.check_in_words(range)?;
        if !(2..=32).contains(&bits) {
            let (name, value) = ("bits of the current sensors", f64::from(bits));
            return Err(ParamError { name, value, bound: "from 2 to 32" });
        }
        Ok(())
    }
}

/// Current sensors at work: their state from tick to tick.
#[derive(Debug, Clone, Stateful)]
pub(crate) struct State {
    #[state(constant)]
    params: CurrentSensor,
    #[state(constant)]
    noise: Noise,
    #[state(constant)]
    every: Divider,
    turn: Countdown,
    /// Samples so far.
    taken: u64,
    /// Current and electrical angle a tick ago.
    before: Option<(Dq, ElectricalAngle)>,
    /// The last samples, the newest first.
    samples: [AlphaBeta; MOST_CYCLES as usize + 1],
}

impl State {
    /// The state before the first tick; the current loop runs every `every` ticks of `h` (s).
    ///
    /// # Errors
    /// [`ParamError`] names the parameter that is out of its bound.
    pub(crate) fn new(params: CurrentSensor, every: Divider, h: f64) -> Result<Self, ParamError> {
        params.check(h)?;
        Ok(Self {
            params: CurrentSensor { shift: params.shift / h, ..params },
            noise: Noise::new(params.seed, 1),
            every,
            turn: Countdown::default(),
            taken: 0,
            before: None,
            samples: [AlphaBeta::default(); MOST_CYCLES as usize + 1],
        })
    }

    /// Current reported to the drive at this tick; `current` is the true one of a rotor at `angle`, whose rotation is `rotor`. To
    /// be called once at each tick. Before a sample is old enough, the first one is reported.
    #[inline(always)]
    pub(crate) fn read(&mut self, current: Dq, angle: ElectricalAngle, rotor: Rotation) -> AlphaBeta {
        if self.turn.is_due(self.every) {
            let sample = self.sample(current, angle, rotor);
            self.samples = if self.taken == 0 { [sample; 3] } else { [sample, self.samples[0], self.samples[1]] };
            self.taken += 1;
        }
        self.before = Some((current, angle));
        self.samples[self.params.delay as usize]
    }

    /// Not inlined into the tick, whose registers it would occupy.
    #[inline(never)]
    fn sample(&self, current: Dq, angle: ElectricalAngle, rotor: Rotation) -> AlphaBeta {
        let p = &self.params;
        let sampled = match self.before {
            Some((before, ElectricalAngle(angle_before))) if p.shift > 0.0 => {
                let between = |now: f64, before: f64| now + p.shift * (before - now);
                let current = Dq { d: between(current.d, before.d), q: between(current.q, before.q) };
                current.to_alpha_beta(ElectricalAngle(between(angle.0, angle_before)).rotation())
            }
            _ => current.to_alpha_beta(rotor),
        };
        if p.errs_alike() {
            let gain = 1.0 + p.gain_error[0];
            return AlphaBeta { alpha: gain * sampled.alpha, beta: gain * sampled.beta };
        }
        let noise = if p.noise > 0.0 { [0, 1].map(|k| self.noise.value(2 * self.taken + k)) } else { [0.0; 2] };
        let mut phases = phases(sampled);
        for (k, phase) in phases.iter_mut().enumerate() {
            let wrong = (1.0 + p.gain_error[k]) * *phase + p.offset[k] + p.noise * noise[k];
            *phase = p.converter.map_or(wrong, |converter| converter.convert(wrong));
        }
        of_phases(phases)
    }
}

const SQRT_3: f64 = 1.732_050_807_568_877_2;

/// The phases a and b of a current without zero sequence.
#[inline]
fn phases(AlphaBeta { alpha, beta }: AlphaBeta) -> [f64; 2] {
    [alpha, (SQRT_3 * beta - alpha) / 2.0]
}

/// The vector of the phases a and b, with −(a + b) on the third one.
#[inline]
fn of_phases([a, b]: [f64; 2]) -> AlphaBeta {
    AlphaBeta { alpha: a, beta: (a + 2.0 * b) / SQRT_3 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use servobench_base::Rate;

    const H: f64 = 1.0 / 16e3;

    fn every(ticks: u32) -> Divider {
        let rate = |hz| Rate::new(hz).unwrap();
        rate(16_000).divider(rate(16_000 / ticks)).unwrap()
    }

    fn sensor(params: CurrentSensor, ticks: u32) -> State {
        State::new(params, every(ticks), H).unwrap()
    }

    /// Reading of a vector of 3.7 A that turns by `turn` per tick, at tick `k`.
    fn read(sensor: &mut State, turn: f64, k: u32) -> AlphaBeta {
        let angle = ElectricalAngle(turn * f64::from(k) + 0.3);
        sensor.read(Dq { d: 0.0, q: 3.7 }, angle, angle.rotation())
    }

    fn length(one: AlphaBeta, other: AlphaBeta) -> f64 {
        (one.alpha - other.alpha).hypot(one.beta - other.beta)
    }

    fn truth(turn: f64, k: f64) -> AlphaBeta {
        Dq { d: 0.0, q: 3.7 }.to_alpha_beta(ElectricalAngle(turn * k + 0.3).rotation())
    }

    /// Oracle: the definition of the phases, a along α, b a third of a turn ahead of it.
    #[test]
    fn phases_are_projections_and_come_back() {
        for angle in [0.0, 0.4, 2.0, -1.3, 5.0_f64] {
            let vector = AlphaBeta { alpha: 2.3 * angle.cos(), beta: 2.3 * angle.sin() };
            let [a, b] = phases(vector);
            // A few roundings of numbers up to 2.3.
            assert!((a - 2.3 * angle.cos()).abs() < 1e-15);
            assert!((b - 2.3 * (angle - 2.0 * PI / 3.0).cos()).abs() < 2e-15, "{b}");
            assert!(length(of_phases([a, b]), vector) < 2e-15);
        }
    }

    /// Oracle: (2/√3)·√(a² + a·b + b²), by the definition of the Clarke transformation with three phases.
    #[test]
    fn an_offset_is_a_vector_that_stands() {
        let (a, b) = (0.11, -0.037_f64);
        let mut sensor = sensor(CurrentSensor { offset: [a, b], ..Default::default() }, 1);
        let expected = 2.0 / 3.0_f64.sqrt() * (a * a + a * b + b * b).sqrt();
        for k in 0..100 {
            let error = length(read(&mut sensor, 0.037, k), truth(0.037, f64::from(k)));
            assert!((error - expected).abs() < 1e-14, "a handful of roundings of 3.7 A: {error} {expected}");
        }
    }

    /// Oracle: by hand, 3 bits of ±4 A are steps of 1 A from −4 to 3.
    #[test]
    fn a_converter_rounds_and_saturates() {
        let converter = Converter { bits: 3, range: 4.0 };
        for (current, read) in
            [(0.49, 0.0), (0.51, 1.0), (-0.51, -1.0), (2.7, 3.0), (3.6, 3.0), (99.0, 3.0), (-99.0, -4.0)]
        {
            assert_eq!(converter.convert(current).to_bits(), f64::to_bits(read), "{current}");
        }
    }

    /// Oracle: q²/12 of a uniform error, in both phases; the converter's steps are small against the current, whose turns are not a
    /// fraction of its ticks. The variance of a sum of n squares of uniform errors is known to √(4/5)/√n: five times that allowed.
    #[test]
    fn a_step_makes_a_twelfth_of_its_square() {
        let mut sensor =
            sensor(CurrentSensor { converter: Some(Converter { bits: 12, range: 10.0 }), ..Default::default() }, 1);
        let (step, many) = (20.0 / 4096.0, 200_000);
        let mut sum = [0.0; 2];
        for k in 0..many {
            let (found, truth) = (phases(read(&mut sensor, 0.618_034, k)), phases(truth(0.618_034, f64::from(k))));
            for phase in 0..2 {
                sum[phase] += (found[phase] - truth[phase]).powi(2) / f64::from(many);
            }
        }
        let bound = 5.0 * 0.8_f64.sqrt() / f64::from(many).sqrt();
        for variance in sum {
            assert!((variance / (step * step / 12.0) - 1.0).abs() < bound, "{variance}");
        }
    }

    #[test]
    fn noise_is_as_strong_as_it_says_and_the_same_again() {
        let noisy = CurrentSensor { noise: 0.02, seed: 3, ..Default::default() };
        let [mut first, mut second] = [sensor(noisy, 1), sensor(noisy, 1)];
        let many = 100_000;
        let mut sum = [0.0; 2];
        for k in 0..many {
            let found = read(&mut first, 0.1, k);
            assert_eq!(found, read(&mut second, 0.1, k));
            let truth = phases(truth(0.1, f64::from(k)));
            for (phase, found) in phases(found).into_iter().enumerate() {
                sum[phase] += (found - truth[phase]).powi(2) / f64::from(many);
            }
        }
        for variance in sum {
            // Five standard deviations √(2/n) of a variance.
            assert!((variance / 4e-4 - 1.0).abs() < 5.0 * (2.0 / f64::from(many)).sqrt(), "{variance}");
        }
    }

    /// Oracle: the vector of so many cycles ago; before there is one, that of the beginning.
    #[test]
    fn a_delay_is_of_whole_cycles_of_the_current_loop() {
        for (delay, ticks) in [(0, 1), (1, 1), (2, 1), (1, 2), (2, 4)] {
            let mut sensor = sensor(CurrentSensor { delay, ..Default::default() }, ticks);
            for k in 0..40 {
                let sampled_at = (k / ticks * ticks).saturating_sub(delay * ticks);
                let found = read(&mut sensor, 0.2, k);
                assert!(length(found, truth(0.2, f64::from(sampled_at))) < 1e-14, "{delay} {ticks} {k}");
            }
        }
    }

    /// Oracle: the vector at that instant, exactly where current and speed are constant in the rotor's frame.
    #[test]
    fn a_shift_is_a_time_within_the_tick() {
        let mut sensor = sensor(CurrentSensor { shift: 0.37 * H, ..Default::default() }, 1);
        for k in 0..40 {
            let found = read(&mut sensor, 0.2, k);
            let at = if k == 0 { 0.0 } else { f64::from(k) - 0.37 };
            assert!(length(found, truth(0.2, at)) < 1e-13, "tick {k}");
        }
    }

    /// The interpolation is of second order: if the current is not linear, half the tick leaves a quarter of the error.
    #[test]
    fn a_shift_is_of_second_order_in_the_tick() {
        let error = |ticks_per_second: f64| {
            let h = 1.0 / ticks_per_second;
            let mut sensor = State::new(CurrentSensor { shift: 0.43 * h, ..Default::default() }, every(1), h).unwrap();
            let current = |t: f64| Dq { d: 0.0, q: (700.0 * t).sin() };
            let angle = |t: f64| ElectricalAngle(40.0 * t + 9e3 * t * t);
            let mut largest = 0.0_f64;
            for k in 0..400 {
                let t = f64::from(k) * h;
                let found = sensor.read(current(t), angle(t), angle(t).rotation());
                let then = t - 0.43 * h;
                if k > 0 && t > 0.01 && t < 0.02 {
                    largest = largest.max(length(found, current(then).to_alpha_beta(angle(then).rotation())));
                }
            }
            largest
        };
        let ratio = error(8e3) / error(16e3);
        assert!((3.7..4.3).contains(&ratio), "{ratio}");
    }

    #[test]
    fn errors_name_the_parameter() {
        let said = |params: CurrentSensor| params.check(H).unwrap_err().to_string();
        let none = CurrentSensor::default();
        assert_eq!(none.check(H), Ok(()));
        assert_eq!(
            said(CurrentSensor { offset: [0.0, f64::NAN], ..none }),
            "`offset of the current sensor b` must be finite, got NaN"
        );
        assert_eq!(
            said(CurrentSensor { gain_error: [-1.0, 0.0], ..none }),
            "`gain error of the current sensor a` must be within its range, got -1"
        );
        assert!(said(CurrentSensor { shift: H, ..none }).contains("less than a base tick"));
        assert!(said(CurrentSensor { delay: 3, ..none }).contains("at most two cycles"));
        let of = |bits, range| CurrentSensor { converter: Some(Converter { bits, range }), ..none };
        assert!(said(of(1, 3.0)).contains("from 2 to 32") && said(of(12, 0.0)).contains("range"));
        assert_eq!(of(12, 30.0).check(H), Ok(()));
    }
}
