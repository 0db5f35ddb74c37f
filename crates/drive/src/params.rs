//! Constant parameters of the firmware: gains, limits, rates and its own estimates of the axis.
use crate::{Blocks, current, delay, feedforward, velocity};
use servobench_base::{Divider, Rate};
use servobench_config::Kind::{Motor, Plain};
use servobench_config::quantities::{FREQUENCY, POSITION_GAIN, RATIO, SOURCE_GAIN, TIME};
use servobench_config::{ParameterError, not_negative, positive};

servobench_config::parameters! {
    /// A parameter of the firmware that is shared by its loops.
    pub enum Parameter {
        /// Axis coordinate per motor coordinate
        TRANSMISSION "transmission" = positive(Plain(&RATIO), "0.0016");
        /// Proportional gain K_v of the position loop
        POSITION_GAIN "gain of the position loop" = not_negative(Plain(&POSITION_GAIN), "160 1/s");
        /// Rate of the position loop
        POSITION_RATE "rate of the position loop" = positive(Plain(&FREQUENCY), "4 kHz");
        /// Rate of the velocity loop
        VELOCITY_RATE "rate of the velocity loop" = positive(Plain(&FREQUENCY), "8 kHz");
        /// Time constant of the low-pass on the measured velocity
        VELOCITY_FILTER_TIME "time constant of the velocity filter" = not_negative(Plain(&TIME), "0.1 ms");
        /// Force or torque per volt of an ideal source
        DIRECT_GAIN "gain of the direct output" = positive(Motor(&SOURCE_GAIN), "35.1507 N/V");
    }
}

/// Conversion of the effort reference into effort.
#[derive(Debug, Clone, PartialEq)]
pub enum Stage {
    /// Current loop of a synchronous motor.
    Current {
        /// Parameters of the loop.
        params: current::Params,
        /// Period of the loop in base ticks.
        every: Divider,
    },
    /// An ideal amplifier: output = effort / gain.
    Direct {
        /// Assumed effort per unit of output (N/V, or 1).
        gain: f64,
    },
}

/// Gains, limits, rates and estimates; constant during a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Params {
    /// Base rate of the run.
    pub base_rate: Rate,
    /// Assumed axis coordinate per motor coordinate (m/rad, or 1).
    pub transmission: f64,
    /// Position gain, K_v (1/s).
    pub position_gain: f64,
    /// Period of the position loop in base ticks; a whole number of periods of the velocity loop.
    pub position_every: Divider,
    /// Velocity loop.
    pub velocity: velocity::Params,
    /// Period of the velocity loop in base ticks; a whole number of periods of the current loop.
    pub velocity_every: Divider,
    /// Time constant of the low-pass on the measured velocity (s); 0 for none.
    pub velocity_filter_time: f64,
    /// Feedforward.
    pub feedforward: feedforward::Params,
    /// Blocks for real hardware.
    pub blocks: Blocks,
    /// Delay of the reference to match the feedforward effort.
    pub reference_delay: delay::Params,
    /// Current loop or direct output.
    pub stage: Stage,
}

impl Params {
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParameterError> {
        Parameter::TRANSMISSION.check(self.transmission)?;
        Parameter::POSITION_GAIN.check(self.position_gain)?;
        Parameter::VELOCITY_FILTER_TIME.check(self.velocity_filter_time)?;
        match &self.stage {
            Stage::Direct { gain } => Parameter::DIRECT_GAIN.check(*gain).map(|_| ()),
            Stage::Current { params, .. } => params.check(),
        }?;
        self.velocity.check()?;
        self.feedforward.check()?;
        self.blocks.check()?;
        self.check_rates()
    }

    /// Checks the rates: cycles of a slower loop must coincide with cycles of the faster one, or its output would wait for a time that
    /// changes from cycle to cycle.
    fn check_rates(&self) -> Result<(), ParameterError> {
        let coincides = |name, slower: Divider, faster: Divider, bound| {
            let value = f64::from(self.base_rate.hertz()) / f64::from(slower.ticks());
            if slower.is_multiple_of(faster) { Ok(()) } else { Err(ParameterError { name, value, bound }) }
        };
        let bound = "a whole fraction of the velocity loop's rate";
        coincides(Parameter::POSITION_RATE, self.position_every, self.velocity_every, bound)?;
        match self.stage {
            Stage::Direct { .. } => Ok(()),
            Stage::Current { every, .. } => coincides(
                Parameter::VELOCITY_RATE,
                self.velocity_every,
                every,
                "a whole fraction of the current loop's rate",
            ),
        }
    }

    /// Rate of the position loop.
    #[must_use]
    pub const fn position_rate(&self) -> Rate {
        self.base_rate.of_task(self.position_every)
    }

    /// Rate of the velocity loop.
    #[must_use]
    pub const fn velocity_rate(&self) -> Rate {
        self.base_rate.of_task(self.velocity_every)
    }

    /// Largest effort reference (N·m or N): the lower of the velocity loop's limit and that of the current limit.
    #[must_use]
    pub fn max_effort(&self) -> f64 {
        match &self.stage {
            Stage::Direct { .. } => self.velocity.max_effort,
            Stage::Current { params, .. } => self.velocity.max_effort.min(params.max_effort()),
        }
    }

    /// The current loop and its rate, if there is one.
    #[must_use]
    pub const fn current_loop(&self) -> Option<(&current::Params, Rate)> {
        match &self.stage {
            Stage::Direct { .. } => None,
            Stage::Current { params, every } => Some((params, self.base_rate.of_task(*every))),
        }
    }

    /// Period of the task that runs every `every` base ticks (s).
    #[inline]
    #[must_use]
    pub fn period(&self, every: Divider) -> f64 {
        f64::from(every.ticks()) * self.base_rate.period()
    }

    /// Delay until an effort reference acts, and thus of the reference (s): half the position period for which the reference is held, plus
    /// the lag of the current loop (see [`current`]: 1/α for a ramp, from sample to sample, so that only the excess of the position period
    /// over the current period counts as held). The velocity loop holds nothing longer, since its period is not above that of the position
    /// loop. Filters add their delay of a ramp.
    #[must_use]
    pub fn effort_path_delay(&self) -> f64 {
        let position = self.period(self.position_every);
        let path = match &self.stage {
            Stage::Direct { .. } => position / 2.0,
            Stage::Current { params, every } => {
                (position - self.period(*every)) / 2.0 + params.motor.inductance.q / params.gains.k_p.q
            }
        };
        (path + self.blocks.effort_delay()).max(0.0)
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::current::{Gains, MotorEstimate};
    use servobench_base::Dq;

    pub(crate) const BASE: u32 = 16_000;

    pub(crate) fn every(hz: u32) -> Divider {
        let rate = |hz| Rate::new(hz).unwrap();
        rate(BASE).divider(rate(hz)).unwrap()
    }

    /// The EMPS axis' controller: u = kv·(kp·e − v), 1 kHz, without feedforward.
    pub(crate) fn emps() -> Params {
        Params {
            base_rate: Rate::new(BASE).unwrap(),
            transmission: 1.0,
            position_gain: 160.18,
            position_every: every(1_000),
            velocity: velocity::Params { k_p: 35.1507 * 243.45, integral_time: None, max_effort: 351.507 },
            velocity_every: every(1_000),
            velocity_filter_time: 0.0,
            feedforward: feedforward::Params {
                velocity: 0.0,
                interpolate: true,
                model: feedforward::Model::Off,
                coulomb: 0.0,
                bias: 0.0,
            },
            blocks: Blocks::default(),
            reference_delay: delay::Params::default(),
            stage: Stage::Direct { gain: 35.1507 },
        }
    }

    /// The 2.2 kW motor under loops of 16, 8 and 4 kHz, current-limited to 9 A.
    pub(crate) fn synchronous() -> Params {
        let inductance = Dq { d: 36e-3, q: 51e-3 };
        let motor = MotorEstimate { electrical_ratio: 3.0, resistance: 3.6, inductance, flux_linkage: 0.545 };
        let gains = Gains::from_bandwidth(&motor, 6_000.0);
        let operation = current::operating_point::Params::default();
        let (d_reference, max_current, max_voltage) = (0.0, 9.0, 300.0);
        let params =
            current::Params { motor, gains, d_reference, max_current, max_voltage, operation, dead_time: None };
        Params {
            position_every: every(4_000),
            velocity: velocity::Params { k_p: 3.0, integral_time: Some(0.01), max_effort: f64::INFINITY },
            velocity_every: every(8_000),
            stage: Stage::Current { params, every: every(16_000) },
            ..emps()
        }
    }

    /// Oracle: by hand. Half of 1 ms; half of the excess of 250 µs over 62.5 µs, and 1/α.
    #[test]
    fn the_delay_of_the_effort_path_is_half_the_hold_and_the_lag_of_the_current() {
        assert!((emps().effort_path_delay() - 0.5e-3).abs() < 1e-15);
        assert!((synchronous().effort_path_delay() - (93.75e-6 + 1.0 / 6_000.0)).abs() < 1e-15);
    }

    #[test]
    fn a_loop_turns_with_the_faster_one_below_it() {
        assert_eq!((emps().check(), synchronous().check()), (Ok(()), Ok(())));
        let said = |params: Params| params.check().unwrap_err().to_string();
        let hasty = Params { position_every: every(2_000), ..emps() };
        assert_eq!(
            said(hasty),
            "`rate of the position loop` must be a whole fraction of the velocity loop's rate, got 2000"
        );
        let uneven = Params { position_every: every(3_200), ..synchronous() };
        assert_eq!(
            said(uneven),
            "`rate of the position loop` must be a whole fraction of the velocity loop's rate, got 3200"
        );
        let Stage::Current { params, .. } = synchronous().stage else { panic!() };
        let slow = Params { stage: Stage::Current { params, every: every(4_000) }, ..synchronous() };
        assert_eq!(
            said(slow),
            "`rate of the velocity loop` must be a whole fraction of the current loop's rate, got 8000"
        );
    }

    #[test]
    fn the_parameters_of_every_loop_are_checked() {
        let said = |params: Params| params.check().unwrap_err().to_string();
        let no_gain = Params { stage: Stage::Direct { gain: 0.0 }, ..emps() };
        assert_eq!(said(no_gain), "`gain of the direct output` must be finite and positive, got 0");
        let Stage::Current { params, every } = synchronous().stage else { panic!() };
        let no_current = current::Params { max_current: f64::NAN, ..params };
        let starved = Params { stage: Stage::Current { params: no_current, every }, ..synchronous() };
        assert_eq!(said(starved), "`largest current` must be positive, got NaN");
    }
}
