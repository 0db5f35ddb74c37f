//! I²t: the thermal load of motor or drive, first order in the square of the current.
//!
//! ```text
//! dΘ/dt = ((i/I_n)² − Θ)/τ       Θ = 1: steady state of the continuous current I_n
//! t(Θ = 1) = −τ·ln(1 − I_n²/I²)  from cold, at the constant current I > I_n
//! ```
//! Between two cycles of the velocity loop the current is taken as constant, for which the step is exact. At Θ = 1 the drive limits the
//! current to the continuous one until the load is below [`RELEASE`], or reports a fault (CiA 402: 2350h).
//! Source: IEC 60034-1, 2022, §4.2 (thermal equilibrium of duty types) for the lag of first order; by hand for its step.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use servobench_base::{Dq, Stateful};
use servobench_config::Kind::Plain;
use servobench_config::quantities::{CURRENT, TIME};
use servobench_config::{ParameterError, positive};

servobench_config::parameters! {
    /// A parameter of an I²t model.
    pub enum Parameter {
        /// Current that may flow continuously
        CONTINUOUS_CURRENT "continuous current" = positive(Plain(&CURRENT), "5 Arms");
        /// Thermal time constant
        TIME_CONSTANT "thermal time constant" = positive(Plain(&TIME), "30 s");
        /// Time for which the largest current of the motor may flow from cold, instead of the time constant
        PEAK_TIME "time of the largest current" = positive(Plain(&TIME), "2 s");
    }
}

servobench_config::choices! {
    /// Reaction of the drive to a load of 1.
    pub enum Reaction default Derate {
        /// limits the current to the continuous current
        Derate = "derate",
        /// reports a fault, 2350h of CiA 402
        Fault = "fault",
    }
}

/// Load below which a drive that is limited to the continuous current is released.
pub const RELEASE: f64 = 0.95;

/// Parameters of the model; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Continuous current I_n (A, peak).
    pub continuous_current: f64,
    /// Time constant τ (s).
    pub time_constant: f64,
    /// Reaction at Θ = 1.
    pub reaction: Reaction,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct State {
    /// Load Θ.
    pub load: f64,
    /// True if the load has reached 1 and has not been below [`RELEASE`] since.
    pub is_reached: bool,
}

impl Params {
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParameterError> {
        Parameter::CONTINUOUS_CURRENT.check(self.continuous_current)?;
        Parameter::TIME_CONSTANT.check(self.time_constant).map(|_| ())
    }

    /// Time from cold until the load is 1 at the current `current` (A, peak) (s); infinite up to the continuous current.
    #[must_use]
    pub fn time(&self, current: f64) -> f64 {
        let share = self.continuous_current / current;
        if share < 1.0 { -self.time_constant * libm::log1p(-share * share) } else { f64::INFINITY }
    }

    /// Time constant with which the current `current` (A, peak) may flow for `time` (s) from cold; `None` if it is not above the continuous
    /// current.
    #[must_use]
    pub fn time_constant_of(continuous_current: f64, current: f64, time: f64) -> Option<f64> {
        let share = continuous_current / current;
        (share < 1.0).then(|| -time / libm::log1p(-share * share))
    }
}

/// Advances `x` by `h` (s) with the square of the current (A², peak).
pub fn step(p: &Params, x: &mut State, square: f64, h: f64) {
    let nominal = p.continuous_current * p.continuous_current;
    x.load -= libm::expm1(-h / p.time_constant) * (square / nominal - x.load);
    x.is_reached = x.load >= 1.0 || x.is_reached && x.load > RELEASE;
}

/// Largest current (A, peak), at most `most`, permitted by the thermal loads of motor and drive, which carry the measured `current` for `h`
/// (s).
#[inline(always)]
pub(crate) fn limit(loads: [Option<&Params>; 2], states: &mut [State; 2], current: Dq, most: f64, h: f64) -> f64 {
    let Dq { d, q } = current;
    let mut limit = most;
    for (load, state) in loads.into_iter().zip(states) {
        let Some(load) = load else { continue };
        step(load, state, d * d + q * q, h);
        if state.is_reached && load.reaction == Reaction::Derate {
            limit = limit.min(load.continuous_current);
        }
    }
    limit
}

#[cfg(test)]
mod tests {
    use super::*;

    const P: Params = Params { continuous_current: 4.7, time_constant: 3.3, reaction: Reaction::Derate };

    /// Number of cycles until the load is 1.
    fn cycles(p: &Params, current: f64, h: f64) -> u32 {
        let mut x = State::default();
        (1..1_000_000)
            .find(|_| {
                step(p, &mut x, current * current, h);
                x.is_reached
            })
            .unwrap()
    }

    /// Oracle: t = −τ·ln(1 − I_n²/I²), within its cycle, at every rate.
    #[test]
    fn the_limit_comes_after_the_time_of_the_closed_form() {
        for h in [125e-6, 1e-3, 7.3e-3] {
            for current in [4.9, 6.1, 9.4, 23.0] {
                let exact = -3.3 * (1.0 - (4.7_f64 / current).powi(2)).ln();
                let found = f64::from(cycles(&P, current, h)) * h;
                assert!((-1e-9..h + 1e-9).contains(&(found - exact)), "{h} {current}: {found} {exact}");
                assert!((P.time(current) / exact - 1.0).abs() < 1e-12);
                let back = Params::time_constant_of(4.7, current, exact).unwrap();
                assert!((back / 3.3 - 1.0).abs() < 1e-12);
            }
        }
        assert_eq!((P.time(4.7), Params::time_constant_of(4.7, 4.7, 1.0)), (f64::INFINITY, None));
    }

    /// Oracle: the exponential. At the continuous current the load rises to 1 and not above; it is released at 0.95 after −τ·ln(0.95)
    /// without current, and not before.
    #[test]
    fn a_reached_limit_is_released_below() {
        let mut x = State { load: 1.0, is_reached: true };
        for _ in 0..8_000 {
            step(&P, &mut x, 4.7 * 4.7 * 0.98, 125e-6);
            assert!(x.is_reached && x.load <= 1.0, "a little less is not enough");
        }
        let mut x = State { load: 1.0, is_reached: true };
        let mut cycles = 0;
        while x.is_reached {
            step(&P, &mut x, 0.0, 125e-6);
            cycles += 1;
        }
        let exact = -3.3 * 0.95_f64.ln();
        assert!((0.0..125e-6).contains(&(f64::from(cycles) * 125e-6 - exact)), "{cycles} {exact}");
    }

    #[test]
    fn errors_name_the_parameter() {
        assert_eq!(P.check(), Ok(()));
        let said = Params { time_constant: 0.0, ..P }.check().unwrap_err().to_string();
        assert_eq!(said, "`thermal time constant` must be finite and positive, got 0");
    }
}
