//! Position encoder: ideal, with a resolution, or with the errors of a real one.
//!
//! ```text
//! x at the earlier time → eccentricity → signals → zero → noise → increments → turns
//! ```
//! - **Latency**: x is the position a time `latency` earlier.
//! - **Eccentricity** of a disc, e off its centre, that is read at radius r by one head: θ + (e/r)·sin(θ − θ₀).
//! - **Signals**: the errors of a sine and a cosine, see [`Signals`].
//! - **Zero** and **noise** are added; the noise is that of one reading, white and Gaussian.
//! - **Increments**: the nearest one, an error of variance q²/12 where the motion passes many.
//! - **Turns**: an absolute encoder counts 2ⁿ of them and starts again.
//!
//! An ideal encoder also gives the velocity; one with errors does so if these are only zero, turns or commutation.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use super::edge::{Edge, Timing};
use super::latency::Past;
use super::noise::Noise;
use super::signals::{Evaluation, Signals};
use super::turn;
use crate::mechanics::BodyState;
use servobench_base::{ElectricalAngle, ParamError, Stateful};
use servobench_config::Kind::{Axis, Plain};
use servobench_config::quantities::{POSITION, RATIO, TIME};
use servobench_config::{Bound, Measure, any, not_negative, positive};

const fn share(example: &'static str) -> Measure {
    Measure { kind: Plain(&RATIO), bound: Bound::Within(-0.9, 0.9), example }
}

servobench_config::parameters! {
    /// A parameter of an encoder, on the load in the axis coordinate, on the motor in the motor coordinate.
    pub enum EncoderParameter {
        /// One increment
        STEP "encoder step" = positive(Axis(&POSITION), "0.1 um");
        /// Length of a period of the signals sine and cosine
        SIGNAL_PERIOD "signal period of the encoder" = positive(Axis(&POSITION), "20 um");
        /// Share by which the amplitude of the cosine is larger than that of the sine
        AMPLITUDE_ERROR "amplitude error of the encoder" = share("0.01");
        /// Offset of the sine, as a share of its amplitude
        OFFSET_SINE "offset of the encoder's sine" = share("0.01");
        /// Offset of the cosine, as a share of the amplitude
        OFFSET_COSINE "offset of the encoder's cosine" = share("-0.005");
        /// Phase between sine and cosine in excess of 90°
        PHASE_ERROR "phase error of the encoder" = Measure { kind: Plain(&POSITION.rotary), bound: Bound::Within(-1.5, 1.5), example: "1 deg" };
        /// Time from which a track is lost
        LOST_AT "loss of the encoder's track" = not_negative(Plain(&TIME), "0.2 s");
        /// Distance of the disc's centre from the axis of rotation
        ECCENTRICITY "eccentricity of the encoder" = not_negative(Plain(&POSITION.linear), "10 um");
        /// Radius at which the disc is read
        RADIUS "radius of the encoder's disc" = positive(Plain(&POSITION.linear), "20 mm");
        /// Angle at which the eccentricity causes no error
        ECCENTRICITY_ANGLE "angle of the encoder's eccentricity" = any(Plain(&POSITION.rotary), "30 deg");
        /// Reading of the encoder at zero
        ZERO_OFFSET "zero offset of the encoder" = any(Axis(&POSITION), "5 um");
        /// Noise of each reading, RMS value
        NOISE "noise of the encoder" = not_negative(Axis(&POSITION), "10 nm");
        /// Electrical angle error of the drive's commutation
        COMMUTATION_OFFSET "commutation offset of the encoder" = any(Plain(&POSITION.rotary), "5 deg");
        /// Age of the position that is read
        LATENCY "latency of the encoder" = Measure { kind: Plain(&TIME), bound: Bound::Within(0.0, 0.01), example: "40 us" };
    }
}

/// A position encoder.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Encoder {
    /// One increment (rad or m).
    pub increment: Option<f64>,
    /// Its errors; `None` for none.
    pub errors: Option<EncoderErrors>,
}

/// Errors of an encoder.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EncoderErrors {
    /// Signals of a sine–cosine encoder.
    pub signals: Signals,
    /// Eccentricity of the disc (m).
    pub eccentricity: f64,
    /// Radius at which the disc is read (m); meaningless without eccentricity.
    pub radius: f64,
    /// Angle at which the eccentricity causes no error (rad).
    pub eccentricity_angle: f64,
    /// Reading at zero (rad or m). The drive knows it for its commutation, but takes the axis to be there.
    pub zero: f64,
    /// Commutation error of the drive (rad or m).
    pub commutation: f64,
    /// Noise of each reading (rad or m, effective).
    pub noise: f64,
    /// Seed of the noise.
    pub seed: u32,
    /// Age of the position that is read (s).
    pub latency: f64,
    /// Travel after which an absolute encoder starts again at zero (rad).
    pub range: Option<f64>,
}

impl EncoderErrors {
    /// True if there is any error.
    #[must_use]
    pub fn errs(&self) -> bool {
        let Self { signals, radius, eccentricity_angle, seed, .. } = *self;
        let signals = Signals::ideal(signals.period);
        *self != Self { signals, radius, eccentricity_angle, seed, ..Self::default() }
    }

    /// The part in the linear loop. Every field is named here: a new one does not compile until its treatment is decided.
    fn linearised(&self) -> Self {
        let Self {
            signals: _,
            eccentricity: _,
            radius: _,
            eccentricity_angle: _,
            zero: _,
            commutation,
            noise: _,
            seed: _,
            latency,
            range: _,
        } = *self;
        Self { commutation, latency, ..Self::default() }
    }

    /// True if the reading is the motion of its body, except for a constant.
    fn is_faithful(&self) -> bool {
        !self.signals.errs() && self.eccentricity == 0.0 && self.noise == 0.0 && self.latency == 0.0
    }
}

/// Reading of an encoder for the drive at tick k.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reading {
    /// Position (rad or m).
    pub position: f64,
    /// Velocity (rad/s or m/s), from an ideal encoder only; otherwise the drive forms differences.
    pub velocity: Option<f64>,
    /// Offset that the drive adds to the position for its commutation, if any (rad or m).
    pub to_rotor: Option<f64>,
    /// The last edge, if edges are timed and there was one.
    pub edge: Option<Edge>,
    /// True if the encoder has found that its signals cannot be trusted; it latches.
    pub error: bool,
}

impl Encoder {
    /// # Errors
    /// [`ParamError`] names the parameter that is out of its bound.
    pub fn check(&self) -> Result<(), ParamError> {
        use EncoderParameter as P;
        self.increment.map_or(Ok(()), |increment| P::STEP.check_in_words(increment).map(|_| ()))?;
        let Some(errors) = self.errors else { return Ok(()) };
        for (parameter, value) in [
            (P::ECCENTRICITY, errors.eccentricity),
            (P::ECCENTRICITY_ANGLE, errors.eccentricity_angle),
            (P::ZERO_OFFSET, errors.zero),
            (P::NOISE, errors.noise),
            (P::LATENCY, errors.latency),
        ] {
            parameter.check_in_words(value)?;
        }
        if errors.eccentricity > 0.0 {
            P::RADIUS.check_in_words(errors.radius)?;
            if errors.eccentricity >= errors.radius {
                let bound = "less than the radius of the disc";
                return Err(ParamError { name: P::ECCENTRICITY.name, value: errors.eccentricity, bound });
            }
        }
        if errors.signals.errs() {
            P::SIGNAL_PERIOD.check_in_words(errors.signals.period)?;
            errors.signals.check()?;
        }
        Ok(())
    }

    /// The encoder with its latency and commutation error alone: without increments, noise and periodic errors. If the
    /// original gives positions only, the result must be read in the same way.
    #[must_use]
    pub fn linearised(&self) -> Self {
        let Self { increment: _, errors } = *self;
        Self { increment: None, errors: errors.as_ref().map(EncoderErrors::linearised) }
    }

    /// Distance of two positions that can be distinguished: an increment or, if that is wider, the error of its signals within a period; 0
    /// for an encoder that is ideal except for noise.
    #[must_use]
    pub fn resolution(&self) -> f64 {
        self.increment.unwrap_or_default().max(self.errors.map_or(0.0, |errors| errors.signals.error_width()))
    }

    /// True if it also gives the velocity.
    #[must_use]
    pub fn gives_velocity(&self) -> bool {
        self.increment.is_none() && self.errors.is_none_or(|errors| errors.is_faithful())
    }

    /// Reads, to the nearest increment, `position` and `velocity` of its body, without errors.
    #[inline(always)]
    #[must_use]
    pub fn read(&self, position: f64, velocity: f64) -> Reading {
        match self.increment {
            None => Reading { position, velocity: Some(velocity), ..Reading::default() },
            Some(step) => Reading { position: libm::floor(position / step + 0.5) * step, ..Reading::default() },
        }
    }
}

/// An encoder at work: its state from tick to tick.
#[derive(Debug, Clone, Stateful)]
pub struct EncoderState {
    #[state(constant)]
    encoder: Encoder,
    #[state(fixed)]
    erring: Option<Box<Erring>>,
}

#[derive(Debug, Clone, Stateful)]
struct Erring {
    #[state(constant)]
    errors: EncoderErrors,
    #[state(constant)]
    noise: Noise,
    #[state(fixed)]
    past: Option<Past>,
    #[state(fixed)]
    evaluation: Option<Evaluation>,
    timing: Option<Timing>,
    #[state(constant)]
    gives_velocity: bool,
    /// Offset that the drive adds to the position for its commutation.
    #[state(constant)]
    to_rotor: f64,
    /// Readings so far.
    taken: u64,
    #[state(constant)]
    h: f64,
}

impl EncoderState {
    /// The state before the first tick of `h` (s); each encoder of an axis has a separate `number`, and thereby separate noise.
    ///
    /// # Errors
    /// [`ParamError`] names the parameter that is out of its bound.
    pub fn new(encoder: Encoder, number: u32, h: f64) -> Result<Self, ParamError> {
        encoder.check()?;
        Ok(Self { encoder, erring: encoder.errors.map(|errors| Box::new(Erring::new(encoder, errors, number, h))) })
    }

    /// Adds the timing of edges; only an encoder with increments has them.
    #[must_use]
    pub fn with_timed_edges(self, number: u32, h: f64) -> Self {
        let encoder = self.encoder;
        let mut erring =
            self.erring.unwrap_or_else(|| Box::new(Erring::new(encoder, EncoderErrors::default(), number, h)));
        erring.timing = encoder.increment.map(|_| Timing::default());
        Self { encoder, erring: Some(erring) }
    }

    /// Reads its `body`. To be called once at each tick.
    #[inline(always)]
    pub fn read(&mut self, body: BodyState) -> Reading {
        match &mut self.erring {
            None => self.encoder.read(body.position, body.velocity),
            Some(erring) => erring.read(body, self.encoder.increment),
        }
    }

    /// True if it has errors.
    #[inline(always)]
    #[must_use]
    pub const fn errs(&self) -> bool {
        self.erring.is_some()
    }
}

impl Erring {
    fn new(encoder: Encoder, errors: EncoderErrors, number: u32, h: f64) -> Self {
        Self {
            errors,
            noise: Noise::new(errors.seed, 2 + number),
            past: (errors.latency > 0.0).then(|| Past::new(errors.latency, h)),
            evaluation: errors.signals.errs().then(|| Evaluation::new(errors.signals)),
            timing: None,
            gives_velocity: encoder.gives_velocity(),
            to_rotor: errors.commutation - errors.zero,
            taken: 0,
            h,
        }
    }

    /// Not inlined into the tick, whose registers it would occupy.
    #[inline(never)]
    fn read(&mut self, body: BodyState, increment: Option<f64>) -> Reading {
        let errors = &self.errors;
        let mut position = match &mut self.past {
            None => body.position,
            Some(past) => past.position(body),
        };
        if errors.eccentricity > 0.0 {
            let from_centre = ElectricalAngle(position - errors.eccentricity_angle).rotation();
            position += errors.eccentricity / errors.radius * from_centre.sin;
        }
        if let Some(evaluation) = &mut self.evaluation {
            position = evaluation.read(position, self.taken as f64 * self.h);
        }
        position += errors.zero;
        if errors.noise > 0.0 {
            position += errors.noise * self.noise.value(self.taken);
        }
        let mut edge = None;
        if let Some(step) = increment {
            let count = turn::whole(position / step);
            if let Some(timing) = &mut self.timing {
                edge = timing.read(position, count, step, self.h);
            }
            position = count * step;
        }
        if let Some(range) = errors.range
            && !(0.0..range).contains(&position)
        {
            position -= range * libm::floor(position / range);
        }
        self.taken += 1;
        Reading {
            position,
            velocity: self.gives_velocity.then_some(body.velocity),
            to_rotor: (self.to_rotor != 0.0).then_some(self.to_rotor),
            edge,
            error: self.evaluation.as_ref().is_some_and(Evaluation::alarm),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::TAU;

    const H: f64 = 1.0 / 16e3;

    #[test]
    fn a_resolution_rounds_to_the_nearest_increment_and_hides_the_velocity() {
        let encoder = Encoder { increment: Some(0.25), errors: None };
        for (position, read) in [(0.37, 0.25), (0.38, 0.5), (-0.12, 0.0), (-0.13, -0.25)] {
            assert_eq!(encoder.read(position, 1.0), Reading { position: read, ..Reading::default() }, "{position}");
        }
        let ideal = Reading { position: 0.1, velocity: Some(2.0), ..Reading::default() };
        assert_eq!(Encoder::default().read(0.1, 2.0), ideal);
        assert!(Encoder { increment: Some(0.0), errors: None }.check().is_err());
    }

    /// Oracle: by hand, 20 µm·0.02/2π = 63.7 nm.
    #[test]
    fn what_it_tells_apart_is_an_increment_or_the_error_of_its_signals() {
        let signals = Signals { amplitude_error: 0.02, ..Signals::ideal(20e-6) };
        let errors = Some(EncoderErrors { signals, ..EncoderErrors::default() });
        let resolution = |increment, errors| Encoder { increment, errors }.resolution();
        for (increment, expected) in [(None, 0.0), (Some(1e-9), 1e-9)] {
            assert!((resolution(increment, None) - expected).abs() < 1e-24);
        }
        assert!((resolution(Some(1e-9), errors) / 63.66e-9 - 1.0).abs() < 1e-4);
        assert!((resolution(Some(1e-6), errors) / 1e-6 - 1.0).abs() < 1e-15);
    }

    fn erring(increment: Option<f64>, errors: EncoderErrors) -> EncoderState {
        EncoderState::new(Encoder { increment, errors: Some(errors) }, 0, H).unwrap()
    }

    fn at(position: f64) -> BodyState {
        BodyState { position, velocity: 3.0 }
    }

    /// Oracle: the position of a line that is read at the radius r, off its centre by e, by geometry: (r·cos θ + e, r·sin θ) turns
    /// by θ + (e/r)·sin θ about the centre of the disc to first order in e/r, with an error below (e/r)²/2.
    #[test]
    fn eccentricity_is_an_error_once_per_turn() {
        let ratio = 6e-4;
        let mut encoder =
            erring(None, EncoderErrors { eccentricity: ratio * 0.02, radius: 0.02, ..EncoderErrors::default() });
        for k in 0..100 {
            let angle = 0.0711 * f64::from(k);
            let geometric = angle - (ratio * angle.sin()).atan2(1.0 + ratio * angle.cos());
            let (found, mirrored) = (encoder.read(at(angle)).position, 2.0 * angle - geometric);
            assert!((found - mirrored).abs() < ratio * ratio / 2.0 * 1.001, "{angle}: {found} {mirrored}");
        }
        let mut turned = erring(
            None,
            EncoderErrors { eccentricity: ratio, radius: 1.0, eccentricity_angle: 0.4, ..EncoderErrors::default() },
        );
        assert!((turned.read(at(0.4)).position - 0.4).abs() < 1e-16);
        assert!((turned.read(at(0.4 + TAU / 4.0)).position - 0.4 - TAU / 4.0 - ratio).abs() < 1e-15);
    }

    /// Oracle: q²/12 about the true position, and for the difference of two readings q²·f·(1 − f) with the fraction f of an increment
    /// that is passed in between, in any case: at a constant velocity the difference is one of two neighbours.
    #[test]
    fn increments_make_a_twelfth_of_their_square_and_differences_of_neighbours() {
        let (step, many) = (1e-3, 200_000);
        for passed in [3.618_034, 0.287_1, 17.5003] {
            let mut encoder = erring(Some(step), EncoderErrors { seed: 1, ..EncoderErrors::default() });
            let (mut of_position, mut of_difference, mut last) = (0.0, 0.0, None);
            for k in 0..many {
                let position = passed * step * f64::from(k);
                let found = encoder.read(at(position)).position;
                of_position += (found - position).powi(2);
                if let Some(last) = last.replace(found) {
                    of_difference += (found - last - passed * step).powi(2);
                }
            }
            let [position, difference] = [of_position, of_difference].map(|sum| sum / f64::from(many));
            let fraction = passed.fract();
            assert!((position / (step * step / 12.0) - 1.0).abs() < 0.01, "{passed}: {position}");
            assert!((difference / (step * step * fraction * (1.0 - fraction)) - 1.0).abs() < 0.01, "{difference}");
        }
    }

    #[test]
    fn noise_is_as_strong_as_it_says_and_each_encoder_has_its_own() {
        let noisy = Encoder {
            increment: None,
            errors: Some(EncoderErrors { noise: 2e-6, seed: 5, ..EncoderErrors::default() }),
        };
        let [mut motor, mut again, mut load] = [0, 0, 1].map(|number| EncoderState::new(noisy, number, H).unwrap());
        let (many, mut sum, mut common) = (100_000, 0.0, 0.0);
        for _ in 0..many {
            let [motor, again, load] = [&mut motor, &mut again, &mut load].map(|one| one.read(at(0.0)).position / 2e-6);
            assert_eq!(motor.to_bits(), again.to_bits());
            (sum, common) = (sum + motor * motor / f64::from(many), common + motor * load / f64::from(many));
        }
        // Five standard deviations.
        let bound = 5.0 / f64::from(many).sqrt();
        assert!((sum - 1.0).abs() < bound * 2.0_f64.sqrt() && common.abs() < bound, "{sum} {common}");
    }

    #[test]
    fn an_absolute_encoder_begins_again_and_a_zero_shifts_it() {
        let errors = EncoderErrors { range: Some(4.0 * TAU), zero: 0.5, ..EncoderErrors::default() };
        let mut encoder = erring(None, errors);
        for (position, read) in [(0.0, 0.5), (-0.6, 4.0 * TAU - 0.1), (4.0 * TAU, 0.5), (9.0 * TAU, TAU + 0.5)] {
            let found = encoder.read(at(position));
            assert!((found.position - read).abs() < 1e-14, "{position}: {found:?}");
            assert_eq!((found.velocity, found.to_rotor), (Some(3.0), Some(-0.5)), "a constant takes no velocity");
        }
    }

    /// Oracle: x − v·τ.
    #[test]
    fn a_latency_is_a_position_of_before() {
        let mut encoder = erring(None, EncoderErrors { latency: 2.3 * H, ..EncoderErrors::default() });
        for k in 0..20 {
            let found = encoder.read(at(3.0 * H * f64::from(k)));
            assert!((found.position - 3.0 * H * (f64::from(k) - 2.3)).abs() < 1e-17, "{k}");
            assert_eq!(found.velocity, None);
        }
    }

    #[test]
    fn errors_name_the_parameter() {
        let said =
            |errors: EncoderErrors| Encoder { increment: None, errors: Some(errors) }.check().unwrap_err().to_string();
        let none = EncoderErrors::default();
        assert_eq!(
            said(EncoderErrors { noise: -1.0, ..none }),
            "`noise of the encoder` must be finite and not negative, got -1"
        );
        assert!(said(EncoderErrors { latency: 0.02, ..none }).contains("`latency of the encoder`"));
        assert!(said(EncoderErrors { eccentricity: 0.02, radius: 0.02, ..none }).contains("less than the radius"));
        let signals = Signals { offset: [2.0, 0.0], ..Signals::ideal(1e-3) };
        assert!(said(EncoderErrors { signals, ..none }).contains("go round zero"));
    }
}
