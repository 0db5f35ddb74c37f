//! One interval between two slow samples.
use super::Mode;
use super::polynomial::Polynomial;
use crate::PlanError;
use crate::limits::in_range;
use servobench_base::{ParamError, Setpoint, Stateful, positive};

/// Command of the slow task at one of its ticks.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Sample {
    /// Position (m or rad).
    pub x: f64,
    /// Velocity (m/s or rad/s).
    pub v: f64,
    /// Acceleration (m/s² or rad/s²).
    pub a: f64,
    /// Torque or force feedforward (N·m or N).
    pub torque: f64,
}

impl Sample {
    /// Largest accepted magnitude (SI): values computed from it stay finite.
    const HIGHEST: f64 = 1e30;

    /// The sample, if all its values are finite and at most 1e30 in magnitude.
    pub(super) fn checked(self, index: u64) -> Result<Self, PlanError> {
        let Self { x, v, a, torque } = self;
        for (name, value) in [("x", x), ("v", v), ("a", a), ("torque", torque)] {
            if !(-Self::HIGHEST..=Self::HIGHEST).contains(&value) {
                return Err(PlanError::Sample { index, name, value, highest: Self::HIGHEST });
            }
        }
        Ok(self)
    }
}

/// Command read by the fast task.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Command {
    /// Position and its derivatives; jerk and snap are the derivatives of the acceleration within the interval.
    pub setpoint: Setpoint,
    /// Torque or force feedforward (N·m or N).
    pub torque: f64,
}

/// The polynomials of one interval, computed once and read as often as needed.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Interval {
    x: Polynomial,
    v: Polynomial,
    a: Polynomial,
    j: Polynomial,
    s: Polynomial,
    torque: Polynomial,
}

impl Interval {
    /// The interval in the middle of the last [`Mode::points`] of `samples`, `period` (s) apart, the oldest first.
    ///
    /// # Errors
    /// [`PlanError::Waiting`] when there are too few samples; [`PlanError::Sample`] with the index in `samples`, from 0, of
    /// one that is used and has a value that is not finite or above 1e30 in magnitude; [`PlanError`] for a period that is
    /// not between 1e-30 and 1e30 s.
    pub fn new(mode: Mode, period: f64, samples: &[Sample]) -> Result<Self, PlanError> {
        let period = checked_period(period)?;
        let waiting = PlanError::Waiting { received: samples.len(), needed: mode.points() };
        let mut window = [Sample::default(); 6];
        let first = samples.len().checked_sub(mode.points()).ok_or(waiting)?;
        for ((slot, sample), index) in window[6 - mode.points()..].iter_mut().zip(&samples[first..]).zip(first as u64..)
        {
            *slot = sample.checked(index)?;
        }
        Ok(Self::of_window(mode, period, &window))
    }

    /// The interval in the middle of the last [`Mode::points`] of the six, all checked.
    pub(super) fn of_window(mode: Mode, period: f64, window: &[Sample; 6]) -> Self {
        let [.., e, f] = *window;
        let (x, v, a) = ([e.x, f.x], [e.v, f.v], [e.a, f.a]);
        let by_u = |pair: [f64; 2], scale: f64| pair.map(|y| y * scale);
        match mode {
            Mode::Linear => Self::derived(Polynomial::linear(e.x, f.x), period, e, f),
            Mode::Cubic => Self::derived(Polynomial::cubic(x, by_u(v, period)), period, e, f),
            Mode::Quintic => {
                let x = Polynomial::quintic(x, by_u(v, period), by_u(a, period * period));
                Self::derived(x, period, e, f)
            }
            Mode::CubicBSpline => {
                let [_, _, c, d, e, f] = *window;
                Self::derived(Polynomial::cubic_b_spline(&[c, d, e, f]), period, d, e)
            }
            Mode::QuinticBSpline => Self::derived(Polynomial::quintic_b_spline(window), period, window[2], window[3]),
            Mode::AllLinear => {
                let [x, v] = [Polynomial::linear(e.x, f.x), Polynomial::linear(e.v, f.v)];
                Self::independent(x, v, Polynomial::linear(e.a, f.a), period, e, f)
            }
            Mode::AllCubic => {
                let v_of_u = Polynomial::cubic(v, by_u(a, period));
                let x = Polynomial::cubic(x, by_u(v, period));
                Self::independent(x, v_of_u, v_of_u.rate(period), period, e, f)
            }
        }
    }

    /// Velocity and acceleration are the derivatives of the position; the torque changes from `start` to `end`.
    fn derived(x: Polynomial, period: f64, start: Sample, end: Sample) -> Self {
        let v = x.rate(period);
        Self::independent(x, v, v.rate(period), period, start, end)
    }

    fn independent(x: Polynomial, v: Polynomial, a: Polynomial, period: f64, start: Sample, end: Sample) -> Self {
        let j = a.rate(period);
        Self { x, v, a, j, s: j.rate(period), torque: Polynomial::linear(start.torque, end.torque) }
    }

    /// The command at `fraction` of the interval, 0 to 1.
    ///
    /// # Errors
    /// [`PlanError::Parameter`] when the fraction is not between 0 and 1, where the polynomial is not valid.
    #[inline]
    pub fn at(&self, fraction: f64) -> Result<Command, PlanError> {
        if !(0.0..=1.0).contains(&fraction) {
            return Err(ParamError { name: "fraction", value: fraction, bound: "between 0 and 1" }.into());
        }
        let [x, v, a] = [&self.x, &self.v, &self.a].map(|p| p.at(fraction));
        let [j, s, torque] = [&self.j, &self.s, &self.torque].map(|p| p.at(fraction));
        Ok(Command { setpoint: Setpoint { x, v, a, j, s }, torque })
    }
}

pub(super) fn checked_period(period: f64) -> Result<f64, PlanError> {
    in_range("period", positive("period", period)?, "correct its unit")
}
