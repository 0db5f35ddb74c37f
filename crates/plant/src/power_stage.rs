//! Power stage: from the drive's command to the effort on the motor body.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
mod synchronous;

use crate::mechanics::BodyState;
use crate::sensor::{CurrentSensor, CurrentSensorState};
use crate::source::IdealSource;
use crate::wiring::Wiring;
use crate::{inverter, pmsm};
use servobench_base::{AlphaBeta, Divider, Dq, KnownRotation, ParamError, PowerCommand, Stateful};
use synchronous::Synchronous;

/// Link between the drive and the mechanics: an inverter with a synchronous motor, an ideal source, or nothing.
#[derive(Debug, Clone, Stateful)]
#[state(fixed)]
pub struct PowerStage(Stage);

#[derive(Debug, Clone, Stateful)]
#[state(fixed)]
enum Stage {
    /// Inverter and synchronous motor.
    Synchronous(Synchronous),
    /// Ideal source: effort = gain · output, |output| ≤ limit.
    Ideal {
        #[state(constant)]
        gain: f64,
        #[state(constant)]
        limit: f64,
    },
    /// Off, or a motor that follows its set-point: no effort.
    Off,
}

impl PowerStage {
    /// No power stage, or one whose motor follows its set-point: no effort.
    pub const OFF: Self = Self(Stage::Off);

    /// An ideal source.
    #[must_use]
    pub const fn ideal(source: &IdealSource) -> Self {
        Self(Stage::Ideal { gain: source.gain, limit: source.limit })
    }

    /// An inverter on `dc_link` (V) and a motor without current that turns at `speed` (its own coordinate, per second), in ticks of `h`
    /// (s).
    ///
    /// # Errors
    /// [`ParamError`] names the parameter of the motor that is out of its bound.
    pub fn pmsm(motor: pmsm::Params, dc_link: f64, speed: f64, h: f64) -> Result<Self, ParamError> {
        Ok(Self(Stage::Synchronous(Synchronous::new(motor, dc_link, speed, h)?)))
    }

    /// Adds `effects` to the motor, in ticks of `h` (s); a stage without a motor stays as it is.
    ///
    /// # Errors
    /// [`ParamError`] names the parameter that is out of its bound.
    pub fn with_effects(self, effects: &pmsm::Effects, h: f64) -> Result<Self, ParamError> {
        Ok(match self.0 {
            Stage::Synchronous(synchronous) => Self(Stage::Synchronous(synchronous.with_effects(effects, h)?)),
            other => Self(other),
        })
    }

    /// Adds sensors with errors, for a current loop that runs every `every` ticks of `h` (s).
    ///
    /// # Errors
    /// [`ParamError`] names the parameter of the sensors that is out of its bound.
    pub fn with_current_sensor(mut self, sensor: CurrentSensor, every: Divider, h: f64) -> Result<Self, ParamError> {
        if let Stage::Synchronous(synchronous) = &mut self.0 {
            synchronous.set_sensor(CurrentSensorState::new(sensor, every, h)?);
        }
        Ok(self)
    }

    /// Sets the parameters of inverter and link, in ticks of `h` (s); a stage without a motor has none.
    ///
    /// # Errors
    /// [`ParamError`] names the parameter of them that is out of its bound.
    pub fn with_inverter(
        mut self,
        inverter: &inverter::Params,
        link: Option<&inverter::LinkParams>,
        h: f64,
    ) -> Result<Self, ParamError> {
        if let Stage::Synchronous(synchronous) = &mut self.0 {
            synchronous.put_on(inverter, link, h)?;
        }
        Ok(self)
    }

    /// Sets the wiring of the motor; a stage without a motor has none.
    ///
    /// # Errors
    /// [`ParamError`] names the parameter of the wiring that is out of its bound.
    pub fn with_wiring(mut self, wiring: Wiring) -> Result<Self, ParamError> {
        if let Stage::Synchronous(synchronous) = &mut self.0 {
            synchronous.put_behind(wiring)?;
        }
        Ok(self)
    }

    /// Stator current measured by the drive's sensors with the motor at `motor` (A, peak).
    #[inline(always)]
    pub fn measured_current(&mut self, motor: BodyState) -> AlphaBeta {
        match &mut self.0 {
            Stage::Synchronous(synchronous) => synchronous.measured_current(motor),
            Stage::Ideal { .. } | Stage::Off => AlphaBeta::default(),
        }
    }

    /// The rotation of the rotor at the last measurement of the current.
    #[inline(always)]
    #[must_use]
    pub fn rotation(&self) -> KnownRotation {
        self.synchronous().map_or_else(KnownRotation::default, Synchronous::rotor)
    }

    /// Converts a voltage in the rotor's frame (V, peak) to the stator's, with the motor at `motor`.
    #[inline]
    #[must_use]
    pub fn in_the_stator(&mut self, voltage: Dq, motor: BodyState) -> AlphaBeta {
        if let Stage::Synchronous(synchronous) = &mut self.0 {
            synchronous.turn_to(motor);
        }
        self.synchronous().map_or_else(AlphaBeta::default, |one| voltage.to_alpha_beta(one.rotor().rotation()))
    }

    /// Stator current in the rotor frame (A, peak).
    #[inline(always)]
    #[must_use]
    pub fn current(&self) -> Dq {
        self.synchronous().map_or_else(Dq::default, Synchronous::current)
    }

    /// Output of an ideal source after its limit; 0 for others.
    #[inline(always)]
    #[must_use]
    pub fn output(&self, command: PowerCommand) -> f64 {
        match (&self.0, command) {
            (Stage::Ideal { limit, .. }, PowerCommand::Output(output)) => output.clamp(-limit, *limit),
            _ => 0.0,
        }
    }

    /// True if the inverter gave less voltage than requested at the last tick.
    #[inline(always)]
    #[must_use]
    pub fn shortens_voltage(&self) -> bool {
        self.synchronous().is_some_and(Synchronous::shortens)
    }

    /// Voltage of the inverter over the last tick that was advanced, in the frame of the rotor in the middle of that tick (V).
    #[inline(always)]
    #[must_use]
    pub fn voltage(&self) -> Dq {
        self.synchronous().map_or_else(Dq::default, Synchronous::voltage)
    }

    /// Mean powers of the motor over that tick (W); zero if they are left out.
    #[inline(always)]
    #[must_use]
    pub fn power(&self) -> pmsm::Power {
        self.synchronous().map_or_else(pmsm::Power::default, Synchronous::power)
    }

    /// Temperatures of the motor at this tick (°C); zero without warming.
    #[inline(always)]
    #[must_use]
    pub fn temperatures(&self) -> pmsm::Temperatures {
        self.synchronous().map_or_else(pmsm::Temperatures::default, Synchronous::temperatures)
    }

    /// Mean loss of the inverter over that tick (W); zero if left out, or without a loss.
    #[inline(always)]
    #[must_use]
    pub fn inverter_loss(&self) -> f64 {
        self.synchronous().map_or(0.0, Synchronous::inverter_loss)
    }

    /// Length of the current vector over that tick, including the ripple of a switching inverter (A); zero with any other.
    #[inline(always)]
    #[must_use]
    pub fn ripple(&self) -> inverter::Ripple {
        self.synchronous().map_or_else(inverter::Ripple::default, Synchronous::ripple)
    }

    /// Voltage of the DC link (V), and its mean powers over that tick (W); zero without one.
    #[inline(always)]
    #[must_use]
    pub fn link(&self) -> (f64, inverter::LinkPower) {
        self.synchronous().map_or_else(Default::default, Synchronous::link)
    }

    /// True if the DC link has less than half of its voltage without load.
    #[inline(always)]
    #[must_use]
    pub fn link_has_collapsed(&self) -> bool {
        self.synchronous().is_some_and(Synchronous::link_has_collapsed)
    }

    /// Leaves the powers of the motor out from now on.
    #[inline]
    pub fn leave_power_out(&mut self) {
        if let Stage::Synchronous(synchronous) = &mut self.0 {
            synchronous.leave_power_out();
        }
    }

    /// Advances from tick k to k+1 (`h` s) and returns the mean effort over it (N·m or N).
    #[inline(always)]
    pub fn advance(&mut self, command: PowerCommand, motor: BodyState, h: f64) -> f64 {
        let output = self.output(command);
        match (&mut self.0, command) {
            (Stage::Synchronous(synchronous), PowerCommand::Voltage(wanted)) => synchronous.advance(wanted, motor, h),
            (Stage::Synchronous(synchronous), PowerCommand::Off) => synchronous.switch_off(motor, h),
            (Stage::Ideal { gain, .. }, PowerCommand::Output(_)) => *gain * output,
            _ => 0.0,
        }
    }

    #[inline(always)]
    const fn synchronous(&self) -> Option<&Synchronous> {
        match &self.0 {
            Stage::Synchronous(synchronous) => Some(synchronous),
            Stage::Ideal { .. } | Stage::Off => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_base::Rotation;

    /// Saarakkala/Hinkkanen, 2.2 kW.
    const MOTOR: pmsm::Params = pmsm::Params {
        electrical_ratio: 3.0,
        resistance: 3.6,
        inductance: Dq { d: 36e-3, q: 51e-3 },
        flux_linkage: 0.545,
    };
    const H: f64 = 1.0 / 16e3;

    /// On 540 V, a tick after it turned at `last_speed` (rad/s).
    fn stage(last_speed: f64) -> PowerStage {
        PowerStage::pmsm(MOTOR, 540.0, last_speed, H).unwrap()
    }

    /// Oracle: in the stator frame the back-EMF of a motor at constant speed, ψ·ω_e·[−sin θ, cos θ], averaged over the
    /// tick in closed form; a motor on that voltage has no current.
    #[test]
    fn a_motor_on_its_own_back_emf_takes_no_current_from_its_first_tick_on() {
        let speed = 100.0;
        let (omega_e, mut stage) = (3.0 * speed, stage(speed));
        for k in 0..50 {
            let motor = BodyState { position: speed * f64::from(k) * H, velocity: speed };
            let [theta, next] = [0.0, 1.0].map(|tick| omega_e * H * (f64::from(k) + tick));
            let scale = MOTOR.flux_linkage / H;
            let voltage =
                AlphaBeta { alpha: scale * (next.cos() - theta.cos()), beta: scale * (next.sin() - theta.sin()) };
            stage.measured_current(motor);
            let effort = stage.advance(PowerCommand::Voltage(voltage), motor, H);
            // Within a tick the held voltage and the turning back-EMF differ, by 163 V·ω_e·h/2 = 1.5 V at its ends; the
            // current of that drops over the resistance and makes 0.7 µN·m more at each tick. A first tick at half the speed too much
            // would make 250 mN·m.
            assert!(effort.abs() < 1e-4, "tick {k}: {effort} N·m");
        }
    }

    /// Oracle: under constant acceleration the mean speed of a tick is that in its middle.
    #[test]
    fn the_mean_speed_is_exact_under_constant_acceleration() {
        let (v0, acceleration) = (50.0, 2e4);
        let velocity = |k: f64| v0 + acceleration * k * H;
        let motor = BodyState { position: 0.0, velocity: velocity(1.0) };
        let voltage = AlphaBeta { alpha: 20.0, beta: 90.0 };
        let mut stage = stage(velocity(0.0));
        stage.measured_current(motor);
        let effort = stage.advance(PowerCommand::Voltage(voltage), motor, H);

        let (rotor, omega_e) = (Rotation::default(), 3.0 * velocity(1.5));
        let mut state = pmsm::State::default();
        let expected = pmsm::step(&MOTOR, &mut state, pmsm::Input { voltage, rotor, omega_e }, H);
        // Two roundings of the speed, and a dozen of the motor's tick, which is solved by another method.
        assert!((effort / expected - 1.0).abs() < 1e-13, "{effort} {expected}");
        assert!((stage.current().q / state.current.q - 1.0).abs() < 1e-13);
    }

    #[test]
    fn the_measured_current_is_in_the_stator_frame() {
        let mut stage = stage(0.0);
        let Stage::Synchronous(synchronous) = &mut stage.0 else { panic!("a motor") };
        synchronous.set_current(Dq { d: 0.0, q: 2.0 });
        // A sixth of a turn times three pole pairs: half a turn electrical, q against β.
        let motor = BodyState { position: std::f64::consts::PI / 3.0, velocity: 0.0 };
        let AlphaBeta { alpha, beta } = stage.measured_current(motor);
        assert!(alpha.abs() < 1e-14 && (beta + 2.0).abs() < 1e-14, "{alpha} {beta}");
    }

    /// A drive that keeps to the limit itself meets it to a rounding or two, which is not a cut.
    #[test]
    fn a_voltage_beyond_the_dc_link_is_known() {
        let limit = 540.0 / 3.0_f64.sqrt();
        let mut stage = stage(0.0);
        for (length, shortened) in [(0.9, false), (1.0 + 4e-16, false), (1.001, true), (0.5, false)] {
            let (alpha, beta) = (0.6 * limit * length, -0.8 * limit * length);
            stage.advance(PowerCommand::Voltage(AlphaBeta { alpha, beta }), BodyState::default(), H);
            assert_eq!(stage.shortens_voltage(), shortened, "{length}");
        }
    }

    /// EMPS: 35.15 N/V, ±10 V.
    #[test]
    fn an_ideal_source_saturates_its_output() {
        let mut stage = PowerStage(Stage::Ideal { gain: 35.15, limit: 10.0 });
        for (asked, output) in [(4.0, 4.0), (12.0, 10.0), (-1e9, -10.0)] {
            let command = PowerCommand::Output(asked);
            assert!((stage.output(command) - output).abs() < 1e-15, "{asked}");
            assert!((stage.advance(command, BodyState::default(), H) - 35.15 * output).abs() < 1e-12, "{asked}");
        }
        assert_eq!(stage.current(), Dq::default());
    }

    #[test]
    fn off_is_off() {
        let (mut stage, motor) = (PowerStage::OFF, BodyState { position: 1.0, velocity: 10.0 });
        for command in [PowerCommand::Output(5.0), PowerCommand::Voltage(AlphaBeta { alpha: 5.0, beta: 5.0 })] {
            assert_eq!(stage.advance(command, motor, H).to_bits(), 0.0_f64.to_bits());
            assert_eq!(stage.output(command).to_bits(), 0.0_f64.to_bits());
        }
        assert_eq!(stage.measured_current(motor), AlphaBeta::default());
    }
}
