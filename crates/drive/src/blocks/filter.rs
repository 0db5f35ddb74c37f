//! Filters in the torque path: low-passes, notches and bi-quads in series between velocity loop and effort limit.
//!
//! ```text
//! H(s) = (s²/ω_z² + 2·ζ_z·s/ω_z + 1)/(s²/ω_p² + 2·ζ_p·s/ω_p + 1)          notch: ω_z = ω_p, depth ζ_z/ζ_p there
//! H(s) = 1/(s²/ω_p² + 2·ζ_p·s/ω_p + 1)        H(s) = 1/(s/ω_p + 1)        low-passes of second and first order
//! s/ω → (z − 1)/(z + 1)/tan(ω·h/2)                                       Tustin, pre-warped
//! y = b_0·u + s_1      s_1 ← b_1·u − a_1·y + s_2      s_2 ← b_2·u − a_2·y    transposed direct form II
//! ```
//! Numerator and denominator are each pre-warped at their own frequency, which both keep exactly. Between the two a bi-quad deviates from
//! H(s) like every bilinear transform, increasingly towards half the rate.
//! Source: Franklin, Powell, Workman, *Digital Control of Dynamic Systems*, 3rd ed., §6.1 (pre-warping); Oppenheim, Schafer, *Discrete-Time
//! Signal Processing*, 3rd ed., §6.3 (transposed form).
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use core::f64::consts::PI;
use servobench_base::{Rate, Stateful};
use servobench_config::Kind::Plain;
use servobench_config::quantities::{FREQUENCY, RATIO};
use servobench_config::{ParameterError, not_negative, positive};

servobench_config::parameters! {
    /// A parameter of a filter in the torque path.
    pub enum Parameter {
        /// Corner frequency of a low-pass, or the centre frequency of a notch
        FREQUENCY "frequency of a filter" = positive(Plain(&FREQUENCY), "420 Hz");
        /// Damping ratio of the poles of a low-pass of second order
        DAMPING "damping of a filter" = positive(Plain(&RATIO), "0.7");
        /// Frequency of the zeros of a bi-quad
        ZERO_FREQUENCY "frequency of a filter's zeros" = positive(Plain(&FREQUENCY), "400 Hz");
        /// Damping ratio of the zeros; 0 removes their frequency entirely
        ZERO_DAMPING "damping of a filter's zeros" = not_negative(Plain(&RATIO), "0.05");
        /// Frequency of the poles of a bi-quad
        POLE_FREQUENCY "frequency of a filter's poles" = positive(Plain(&FREQUENCY), "500 Hz");
        /// Damping ratio of the poles: a larger one makes a notch wider
        POLE_DAMPING "damping of a filter's poles" = positive(Plain(&RATIO), "0.7");
    }
}

/// Most filters in series.
pub const MOST: usize = 4;

/// Specification of a filter: frequencies in Hz, damping ratios ζ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Filter {
    /// 1/(1 + s/ω).
    LowPass {
        /// Corner frequency (Hz).
        frequency: f64,
    },
    /// 1/(1 + 2·ζ·s/ω + s²/ω²).
    SecondOrder {
        /// Natural frequency (Hz).
        frequency: f64,
        /// Damping ratio.
        damping: f64,
    },
    /// Zeros and poles at one frequency.
    Notch {
        /// The frequency (Hz).
        frequency: f64,
        /// Damping ratio of the zeros.
        zero_damping: f64,
        /// Damping ratio of the poles.
        pole_damping: f64,
    },
    /// A pair of zeros and a pair of poles; the gain is 1 at frequency zero.
    BiQuad {
        /// Frequency of the zeros (Hz).
        zero_frequency: f64,
        /// Damping ratio of the zeros.
        zero_damping: f64,
        /// Frequency of the poles (Hz).
        pole_frequency: f64,
        /// Damping ratio of the poles.
        pole_damping: f64,
    },
}

/// A filter at its rate: coefficients of z⁰, z⁻¹ and z⁻², normalised to a leading denominator coefficient of 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Section {
    /// Numerator.
    pub b: [f64; 3],
    /// Denominator without its first coefficient.
    pub a: [f64; 2],
    /// Delay of slow signals (s).
    delay: f64,
}

/// Filters in series; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Params {
    sections: [Section; MOST],
    count: usize,
}

/// State from tick to tick: s_1 and s_2 of each filter (N·m or N).
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct State {
    /// One pair for each filter.
    pub memory: [[f64; 2]; MOST],
}

/// Numerator or denominator of a filter in falling powers of z: 1 + 2·ζ·s/ω + s²/ω² times (z + 1)², or 1 + s/ω times z + 1. A filter of
/// first order has no second z + 1 in both: it would be a state that never fades.
struct Polynomial {
    coefficients: [f64; 3],
    /// Phase per angular frequency at frequency zero (s).
    lead: f64,
}

impl Polynomial {
    const ONE: Self = Self { coefficients: [1.0, 2.0, 1.0], lead: 0.0 };
    const ONE_OF_FIRST_ORDER: Self = Self { coefficients: [1.0, 1.0, 0.0], lead: 0.0 };

    /// Polynomial of second order; `linear` is 2·ζ.
    fn new(frequency: f64, linear: f64, h: f64) -> Self {
        let c = 1.0 / libm::tan(PI * frequency * h);
        let (once, twice) = (linear * c, c * c);
        Self { coefficients: [twice + once + 1.0, 2.0 - 2.0 * twice, twice - once + 1.0], lead: once * h / 2.0 }
    }

    fn of_first_order(frequency: f64, h: f64) -> Self {
        let c = 1.0 / libm::tan(PI * frequency * h);
        Self { coefficients: [c + 1.0, 1.0 - c, 0.0], lead: c * h / 2.0 }
    }
}

impl Filter {
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound: each frequency has to be below half of `rate`.
    fn at(&self, rate: Rate) -> Result<Section, ParameterError> {
        let (h, half) = (rate.period(), f64::from(rate.hertz()) / 2.0);
        let below_half = |name: &'static servobench_config::Parameter, value: f64| {
            name.check(value)?;
            let bound = "below half of the velocity loop's rate";
            if value < half { Ok(()) } else { Err(ParameterError { name, value, bound }) }
        };
        let (zeros, poles) = match *self {
            Self::LowPass { frequency } => {
                below_half(Parameter::FREQUENCY, frequency)?;
                (Polynomial::ONE_OF_FIRST_ORDER, Polynomial::of_first_order(frequency, h))
            }
            Self::SecondOrder { frequency, damping } => {
                below_half(Parameter::FREQUENCY, frequency)?;
                Parameter::DAMPING.check(damping)?;
                (Polynomial::ONE, Polynomial::new(frequency, 2.0 * damping, h))
            }
            Self::Notch { frequency, zero_damping, pole_damping } => {
                below_half(Parameter::FREQUENCY, frequency)?;
                Parameter::ZERO_DAMPING.check(zero_damping)?;
                Parameter::POLE_DAMPING.check(pole_damping)?;
                let of = |damping: f64| Polynomial::new(frequency, 2.0 * damping, h);
                (of(zero_damping), of(pole_damping))
            }
            Self::BiQuad { zero_frequency, zero_damping, pole_frequency, pole_damping } => {
                below_half(Parameter::ZERO_FREQUENCY, zero_frequency)?;
                Parameter::ZERO_DAMPING.check(zero_damping)?;
                below_half(Parameter::POLE_FREQUENCY, pole_frequency)?;
                Parameter::POLE_DAMPING.check(pole_damping)?;
                let of = |frequency, damping: f64| Polynomial::new(frequency, 2.0 * damping, h);
                (of(zero_frequency, zero_damping), of(pole_frequency, pole_damping))
            }
        };
        let [first, a1, a2] = poles.coefficients;
        let delay = poles.lead - zeros.lead;
        Ok(Section { b: zeros.coefficients.map(|b| b / first), a: [a1 / first, a2 / first], delay })
    }
}

impl Params {
    /// Parameters for these filters, in series, in a velocity loop of the rate `rate`.
    ///
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    ///
    /// # Panics
    /// With more than [`MOST`] filters.
    pub fn new(filters: &[Filter], rate: Rate) -> Result<Self, ParameterError> {
        assert!(filters.len() <= MOST, "{MOST} filters at most");
        let mut params = Self { count: filters.len(), ..Self::default() };
        for (section, filter) in params.sections.iter_mut().zip(filters) {
            *section = filter.at(rate)?;
        }
        Ok(params)
    }

    /// Filters at their rate.
    #[inline]
    #[must_use]
    pub fn sections(&self) -> &[Section] {
        &self.sections[..self.count]
    }

    /// Total delay of slow signals (s): Σ ζ_p·h/tan(ω_p·h/2) − ζ_z·h/tan(ω_z·h/2).
    #[must_use]
    pub fn delay(&self) -> f64 {
        self.sections().iter().map(|section| section.delay).sum()
    }
}

/// Returns the output of the filters for `input` at tick k, then advances `x` to tick k+1.
#[inline(always)]
pub fn step(p: &Params, x: &mut State, input: f64) -> f64 {
    p.sections().iter().zip(&mut x.memory).fold(input, |u, (section, memory)| section.step(memory, u))
}

impl Section {
    /// Returns the output for the input `u`, then advances s_1 and s_2.
    #[inline(always)]
    #[must_use]
    pub fn step(&self, memory: &mut [f64; 2], u: f64) -> f64 {
        let Self { b: [b0, b1, b2], a: [a1, a2], .. } = *self;
        let y = b0 * u + memory[0];
        *memory = [b1 * u - a1 * y + memory[1], b2 * u - a2 * y];
        y
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::TAU;

    const RATES: [u32; 3] = [8_000, 4_000, 12_500];
    const FILTERS: [Filter; 5] = [
        Filter::LowPass { frequency: 317.3 },
        Filter::SecondOrder { frequency: 541.7, damping: 0.63 },
        Filter::Notch { frequency: 418.9, zero_damping: 0.07, pole_damping: 0.81 },
        Filter::Notch { frequency: 1234.5, zero_damping: 0.0, pole_damping: 0.3 },
        Filter::BiQuad { zero_frequency: 611.1, zero_damping: 0.11, pole_frequency: 873.3, pole_damping: 0.57 },
    ];

    type Complex = (f64, f64);

    fn over((a, b): Complex, (c, d): Complex) -> Complex {
        let square = c * c + d * d;
        ((a * c + b * d) / square, (b * c - a * d) / square)
    }

    /// H at the frequency (Hz) to which the bilinear transform maps `f`: tan(πfh)/tan(πf₀h) in place of f/f₀, separately in the numerator
    /// and the denominator.
    fn closed_form(filter: Filter, f: f64, h: f64) -> Complex {
        let warped = |of: f64| (PI * f * h).tan() / (PI * of * h).tan();
        let second = |of: f64, damping: f64| (1.0 - warped(of) * warped(of), 2.0 * damping * warped(of));
        match filter {
            Filter::LowPass { frequency } => over((1.0, 0.0), (1.0, warped(frequency))),
            Filter::SecondOrder { frequency, damping } => over((1.0, 0.0), second(frequency, damping)),
            Filter::Notch { frequency, zero_damping, pole_damping } => {
                over(second(frequency, zero_damping), second(frequency, pole_damping))
            }
            Filter::BiQuad { zero_frequency, zero_damping, pole_frequency, pole_damping } => {
                over(second(zero_frequency, zero_damping), second(pole_frequency, pole_damping))
            }
        }
    }

    /// Response to e^{j2πft}, real and imaginary part each through a separate filter, once transients have decayed.
    fn measured(filter: Filter, f: f64, rate: Rate) -> Complex {
        let p = Params::new(&[filter], rate).unwrap();
        let (mut re, mut im) = (State::default(), State::default());
        let mut out = (0.0, 0.0);
        let mut angle = 0.0_f64;
        for k in 0..20_000 {
            angle = TAU * (f * f64::from(k) * rate.period()).fract();
            out = (step(&p, &mut re, angle.cos()), step(&p, &mut im, angle.sin()));
        }
        over(out, (angle.cos(), angle.sin()))
    }

    /// Oracle: magnitude and phase of the bilinear transform in closed form, from frequency zero to near half the rate.
    #[test]
    fn magnitude_and_phase_are_those_of_the_bilinear_transform() {
        for hertz in RATES {
            let rate = Rate::new(hertz).unwrap();
            for filter in FILTERS {
                for f in [0.0, 3.7, 118.3, 317.3, 418.9, 612.7, 879.1, 1501.9, 1987.3] {
                    let (found, exact) = (measured(filter, f, rate), closed_form(filter, f, rate.period()));
                    let off = (found.0 - exact.0).hypot(found.1 - exact.1);
                    // The angle of the last sample is 2π times some thousand turns, rounded to 1e-16 of itself.
                    assert!(off < 1e-11, "{hertz} {filter:?} at {f}: {found:?} {exact:?}");
                }
            }
        }
    }

    /// Oracle: the definition. At its own frequency a low-pass of first order is 1/(1 + j), one of second order 1/(2jζ), a notch ζ_z/ζ_p,
    /// at every rate: that is the purpose of pre-warping.
    #[test]
    fn pre_warping_keeps_the_frequency_of_the_filter() {
        for hertz in RATES {
            let rate = Rate::new(hertz).unwrap();
            for (filter, f, (re, im)) in [
                (FILTERS[0], 317.3, (0.5, -0.5)),
                (FILTERS[1], 541.7, (0.0, -0.5 / 0.63)),
                (FILTERS[2], 418.9, (0.07 / 0.81, 0.0)),
                (FILTERS[3], 1234.5, (0.0, 0.0)),
            ] {
                let found = measured(filter, f, rate);
                assert!((found.0 - re).hypot(found.1 - im) < 1e-11, "{hertz} {filter:?}: {found:?}");
            }
        }
    }

    /// Oracle: a ramp, which filters of unit gain delay by their delay.
    #[test]
    fn a_ramp_is_late_by_the_delay_of_all_filters() {
        let rate = Rate::new(8_000).unwrap();
        let p = Params::new(&FILTERS[..4], rate).unwrap();
        let mut x = State::default();
        let last = (0..4_000).fold((0.0, 0.0), |_, k| {
            let t = f64::from(k) * rate.period();
            (t, step(&p, &mut x, t))
        });
        assert!((last.0 - last.1 - p.delay()).abs() < 1e-12, "{last:?} {}", p.delay());
        // Far below half the rate that is Σ 2·(ζ_p − ζ_z)/ω.
        let slow = Filter::Notch { frequency: 11.3, zero_damping: 0.1, pole_damping: 0.7 };
        let delay = Params::new(&[slow], rate).unwrap().delay();
        assert!((delay / (1.2 / (TAU * 11.3)) - 1.0).abs() < 1e-5, "{delay}");
    }

    /// No pole of a filter is on the unit circle, not even a cancelled one: the state fades, rounding included.
    #[test]
    fn what_a_filter_holds_fades() {
        for (filter, hertz) in FILTERS.iter().flat_map(|filter| RATES.map(|hertz| (filter, hertz))) {
            let p = Params::new(&[*filter], Rate::new(hertz).unwrap()).unwrap();
            let mut x = State::default();
            for k in 0..1_001 {
                step(&p, &mut x, if k % 2 == 0 { 1.7 } else { -1.3 });
            }
            for _ in 0..8 * hertz {
                step(&p, &mut x, 0.0);
            }
            let left = x.memory[0].map(f64::abs);
            assert!(left.iter().all(|held| *held < 1e-20), "{filter:?} at {hertz} Hz holds {left:?}");
        }
    }

    #[test]
    fn none_leaves_every_bit() {
        let mut x = State::default();
        for u in [0.1, -0.0, f64::MIN_POSITIVE, 1e300] {
            assert_eq!(step(&Params::default(), &mut x, u).to_bits(), u.to_bits());
        }
        assert_eq!(x, State::default());
    }

    #[test]
    fn a_frequency_is_below_half_the_rate() {
        let said = |filter| Params::new(&[filter], Rate::new(8_000).unwrap()).unwrap_err().to_string();
        assert_eq!(
            said(Filter::LowPass { frequency: 4e3 }),
            "`frequency of a filter` must be below half of the velocity loop's rate, got 4000"
        );
        let undamped = Filter::Notch { frequency: 100.0, zero_damping: 0.1, pole_damping: 0.0 };
        assert_eq!(said(undamped), "`damping of a filter's poles` must be finite and positive, got 0");
    }
}
