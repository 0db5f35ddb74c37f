//! Sequences of impulses: shapers.
use super::difference::blend;
use super::{Vibration, extra_insensitive, humps};
use crate::PlanError;
use crate::limits::in_range;
use core::f64::consts::SQRT_2;
use servobench_base::{ParamError, Setpoint, positive};

/// A part of the input and its delay.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Impulse {
    /// Delay (s).
    pub time: f64,
    /// Part of one.
    pub amplitude: f64,
}

/// Impulses in the order of time, the first at 0, whose amplitudes add up to one: a shaper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impulses {
    impulses: [Impulse; Self::MOST],
    count: usize,
}

impl Impulses {
    /// Maximum number of impulses.
    pub const MOST: usize = 32;

    /// Zero vibration: two impulses.
    #[must_use]
    pub fn zv(vibration: &Vibration) -> Self {
        Self::geometric(vibration, 1.0, [1.0, 1.0])
    }

    /// Modified zero vibration: three impulses over three quarters of a damped period, without residual vibration at the modelled
    /// frequency and slightly more robust than ZV.
    #[must_use]
    pub fn mzv(vibration: &Vibration) -> Self {
        Self::geometric(vibration, 0.75, [1.0, SQRT_2, 1.0])
    }

    /// Zero vibration and derivative: three impulses.
    #[must_use]
    pub fn zvd(vibration: &Vibration) -> Self {
        Self::geometric(vibration, 1.0, [1.0, 2.0, 1.0])
    }

    /// Zero vibration and two derivatives: four impulses.
    #[must_use]
    pub fn zvdd(vibration: &Vibration) -> Self {
        Self::geometric(vibration, 1.0, [1.0, 3.0, 3.0, 1.0])
    }

    /// Extra-insensitive: three impulses over one damped period that leave the part `tolerable` of the vibration at its
    /// modelled frequency, and nothing at two frequencies on both sides of it.
    ///
    /// In between the residual is `tolerable` at most when undamped; the hump of a damped mode has its top a little aside, up
    /// to 1.4 % higher than `tolerable` for damping ratios up to 0.3 and a `tolerable` up to 0.2.
    ///
    /// # Errors
    /// [`PlanError::Parameter`] when `tolerable` is not at least 0.001 and at most 0.5; [`PlanError::NoShaper`] when no
    /// solution is found: never up to a damping ratio of 0.1, nor up to 0.3 with a `tolerable` up to 0.2, nor up to 0.5
    /// with one up to 0.05.
    pub fn ei(vibration: &Vibration, tolerable: f64) -> Result<Self, PlanError> {
        Self::extra_insensitive(vibration, tolerable, extra_insensitive::solve)
    }

    /// Extra-insensitive with two humps: four impulses over about one and a half damped periods that leave nothing at the modelled
    /// frequency and at one on either side of it, and exactly `tolerable` at the tops of the two humps in between, also of a
    /// damped mode.
    ///
    /// # Errors
    /// As [`ei`](Self::ei); a solution is found up to a damping ratio of 0.05 with any `tolerable`, 0.1 with one up to 0.3, 0.2
    /// up to 0.1, 0.3 up to 0.05.
    pub fn two_hump_ei(vibration: &Vibration, tolerable: f64) -> Result<Self, PlanError> {
        Self::extra_insensitive(vibration, tolerable, humps::solve::<4, 10>)
    }

    /// Extra-insensitive with three humps: five impulses over about two damped periods that leave nothing at two frequencies on
    /// either side of the modelled one, and exactly `tolerable` at the tops of the three humps in between, the middle one at the
    /// modelled frequency, also of a damped mode.
    ///
    /// # Errors
    /// As [`ei`](Self::ei); a solution is found undamped with any `tolerable`, up to a damping ratio of 0.05 with one up to 0.3, 0.1
    /// up to 0.2, 0.2 up to 0.05, 0.3 up to 0.02.
    pub fn three_hump_ei(vibration: &Vibration, tolerable: f64) -> Result<Self, PlanError> {
        Self::extra_insensitive(vibration, tolerable, humps::solve::<5, 14>)
    }

    /// The shaper that `solve` finds for a damping ratio and a tolerable residual, in the time unit 1/ω.
    fn extra_insensitive<const N: usize>(
        vibration: &Vibration,
        tolerable: f64,
        solve: impl Fn(f64, f64) -> Option<[Impulse; N]>,
    ) -> Result<Self, PlanError> {
        if !(0.001..=0.5).contains(&tolerable) {
            let bound = "between 0.001 and 0.5 (below it, take a ZVD shaper)";
            return Err(ParamError { name: "tolerable", value: tolerable, bound }.into());
        }
        let zeta = vibration.zeta();
        let shape = solve(zeta, tolerable).ok_or(PlanError::NoShaper { damping_ratio: zeta, tolerable })?;
        Ok(Self::of(shape.map(|impulse| Impulse { time: impulse.time / vibration.omega_n(), ..impulse })))
    }

    /// Amplitudes `coefficient·K^i`, normalised, `half_periods` of the damped vibration apart, in which it decays by K.
    fn geometric<const N: usize>(vibration: &Vibration, half_periods: f64, coefficients: [f64; N]) -> Self {
        let apart = half_periods * vibration.half_period();
        let k = libm::exp(-vibration.decay() * apart);
        let (mut power, mut time) = (1.0, 0.0);
        let impulses = coefficients.map(|coefficient| {
            let impulse = Impulse { time, amplitude: coefficient * power };
            power *= k;
            time += apart;
            impulse
        });
        let sum: f64 = impulses.iter().map(|impulse| impulse.amplitude).sum();
        Self::of(impulses.map(|impulse| Impulse { amplitude: impulse.amplitude / sum, ..impulse }))
    }

    fn of<const N: usize>(first: [Impulse; N]) -> Self {
        let mut impulses = [Impulse::default(); Self::MOST];
        impulses[..N].copy_from_slice(&first);
        Self { impulses, count: N }
    }

    /// This shaper behind `other`, for two modes of the axis: all products, those at the same instant added.
    ///
    /// # Errors
    /// [`PlanError::TooManyImpulses`] when there would be more than [`MOST`](Self::MOST).
    pub fn and(&self, other: &Self) -> Result<Self, PlanError> {
        let mut both = Self { impulses: [Impulse::default(); Self::MOST], count: 0 };
        for one in self.iter() {
            for two in other.iter() {
                both.add(Impulse { time: one.time + two.time, amplitude: one.amplitude * two.amplitude })
                    .map_err(|capacity| PlanError::TooManyImpulses { impulses: self.count * other.count, capacity })?;
            }
        }
        Ok(both)
    }

    /// The shaper with its times on whole multiples of `sample_time` (s): each impulse is split between the two samples
    /// beside it so that the sum and the first moment ΣA·t, the delay of a ramp, do not change.
    ///
    /// Its [`residual`](Self::residual) is that of the [`ShapingFilter`](super::ShapingFilter).
    ///
    /// # Errors
    /// [`PlanError`] when the sample time is not between 1e-30 and 1e30 s, [`PlanError::FilterTooLong`] when the shaper
    /// spans more than 2³² of them, [`PlanError::TooManyImpulses`] when there would be more than [`MOST`](Self::MOST).
    pub fn on_grid(&self, sample_time: f64) -> Result<Self, PlanError> {
        let sample_time = in_range("sample_time", positive("sample_time", sample_time)?, "correct its unit")?;
        // In samples until all are split, so that equal ones compare equal.
        let mut grid = Self { impulses: [Impulse::default(); Self::MOST], count: 0 };
        for impulse in self.iter() {
            let samples = impulse.time / sample_time;
            if samples >= f64::from(LONGEST) {
                return Err(PlanError::FilterTooLong { samples, capacity: LONGEST as usize });
            }
            let before = libm::floor(samples);
            let part = samples - before;
            for (time, part) in [(before, 1.0 - part), (before + 1.0, part)] {
                if part > 0.0 {
                    grid.add(Impulse { time, amplitude: impulse.amplitude * part })
                        .map_err(|capacity| PlanError::TooManyImpulses { impulses: 2 * self.count, capacity })?;
                }
            }
        }
        for impulse in &mut grid.impulses[..grid.count] {
            impulse.time *= sample_time;
        }
        Ok(grid)
    }

    /// Adds an impulse at its time, or to the one that is there; `Err` with the capacity when it is full.
    fn add(&mut self, impulse: Impulse) -> Result<(), usize> {
        let place = self.iter().take_while(|known| known.time < impulse.time).count();
        // The first that is not earlier; if it is not later either, it is the same instant.
        if place < self.count && self.impulses[place].time <= impulse.time {
            self.impulses[place].amplitude += impulse.amplitude;
            return Ok(());
        }
        if self.count == Self::MOST {
            return Err(Self::MOST);
        }
        self.impulses[place..=self.count].rotate_right(1);
        self.impulses[place] = impulse;
        self.count += 1;
        Ok(())
    }

    /// The impulses in the order of time.
    #[must_use]
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Impulse> + '_ {
        self.impulses[..self.count].iter().copied()
    }

    /// Time that it adds to a move (s): that of the last impulse.
    #[must_use]
    pub const fn duration(&self) -> f64 {
        self.impulses[self.count - 1].time
    }

    /// Delay of a ramp, ΣA·t (s).
    #[must_use]
    pub fn delay(&self) -> f64 {
        self.iter().map(|impulse| impulse.amplitude * impulse.time).sum()
    }

    /// The shaped set-point at `t` (s): Σ A_i·`setpoint`(t − t_i), position and all derivatives.
    ///
    /// Exact, and exactly at the target `duration` after the move's end. The amplitude of the undelayed part is computed as
    /// one minus the others.
    #[must_use]
    pub fn shape(&self, t: f64, setpoint: impl Fn(f64) -> Setpoint) -> Setpoint {
        blend(setpoint(t), self.iter().skip(1).map(|Impulse { time, amplitude }| (amplitude, setpoint(t - time))))
    }

    /// Residual vibration of a mode, relative to that without a shaper: `e^(−ζω·t_n)·|Σ A_i·e^((ζω + jω_d)·t_i)|`.
    ///
    /// As a function of the mode's frequency it is the sensitivity curve of the shaper.
    #[must_use]
    pub fn residual(&self, vibration: &Vibration) -> f64 {
        let (omega_d, last) = (vibration.omega_d(), self.duration());
        let (mut re, mut im) = (0.0, 0.0);
        for Impulse { time, amplitude } in self.iter() {
            let magnitude = amplitude * libm::exp(-vibration.decay() * (last - time));
            re += magnitude * libm::cos(omega_d * time);
            im += magnitude * libm::sin(omega_d * time);
        }
        libm::hypot(re, im)
    }
}

/// Samples that a shaper may span: whole numbers of them are exact, and fit a `usize` of 32 bits.
const LONGEST: u32 = u32::MAX;
