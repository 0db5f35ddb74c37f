//! An inverter and the synchronous motor on it.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
mod real;

use crate::mechanics::BodyState;
use crate::sensor::CurrentSensorState;
use crate::wiring::{Cable, Wiring, WiringParameter};
use crate::{inverter, pmsm};
use real::RealInverter;
use servobench_base::{AlphaBeta, Dq, ElectricalAngle, KnownRotation, ParamError, Stateful};
use std::sync::Arc;

/// Inverter, motor and current sensors.
///
/// ```text
/// tick k:  measure (rotor, current) → inverter (voltage over the tick) → motor (current at k+1, mean effort, powers)
/// ```
#[derive(Debug, Clone, Stateful)]
pub(super) struct Synchronous {
    #[state(constant)]
    motor: Arc<pmsm::Ticks>,
    state: pmsm::State,
    /// DC-link voltage (V).
    u_dc: f64,
    /// Motor speed a tick ago (rad/s), for the mean over the coming tick.
    last_speed: f64,
    /// Rotor at this tick.
    #[state(derived)]
    rotor: KnownRotation,
    /// True if the inverter gives less voltage than requested.
    shortens: bool,
    /// Voltage of the inverter over the coming tick, in the frame of the rotor in the middle of the tick (V, peak).
    voltage: Dq,
    /// Mean powers of the motor over the tick, unless they are left out.
    power: Option<pmsm::Power>,
    /// Effects of the motor beside its equations.
    #[state(fixed)]
    effects: Option<Box<pmsm::RealMotor>>,
    /// Effects of inverter and link; `None` for ideal ones.
    #[state(fixed)]
    inverter: Option<Box<RealInverter>>,
    /// The current sensors, if they have errors.
    #[state(fixed)]
    sensor: Option<Box<CurrentSensorState>>,
    /// The cable, if it has faults.
    #[state(fixed)]
    cable: Option<Box<Cable>>,
}

impl Synchronous {
    /// A motor without current that turns at `speed`, on `dc_link` (V), in ticks of `h` (s).
    ///
    /// # Errors
    /// [`ParamError`] names the parameter of the motor that is out of its bound.
    pub(super) fn new(motor: pmsm::Params, dc_link: f64, speed: f64, h: f64) -> Result<Self, ParamError> {
        motor.check()?;
        Ok(Self {
            motor: Arc::new(pmsm::Ticks::new(motor, h)),
            state: pmsm::State::default(),
            u_dc: dc_link,
            last_speed: speed,
            rotor: KnownRotation::default(),
            shortens: false,
            voltage: Dq::default(),
            power: Some(pmsm::Power::default()),
            effects: None,
            inverter: None,
            sensor: None,
            cable: None,
        })
    }

    /// Adds `effects` to the motor, in ticks of `h` (s).
    ///
    /// # Errors
    /// [`ParamError`] names the parameter that is out of its bound.
    pub(super) fn with_effects(self, effects: &pmsm::Effects, h: f64) -> Result<Self, ParamError> {
        effects.check()?;
        let params = *self.motor.params();
        let real = pmsm::RealMotor::new(&params, effects, h).map(Box::new);
        let warm = effects.at_the_beginning(&params);
        warm.check()?;
        let motor = if warm == params { self.motor } else { Arc::new(pmsm::Ticks::new(warm, h)) };
        Ok(Self { motor, effects: real, ..self })
    }

    /// Sets the parameters of inverter and link, in ticks of `h` (s), after the motor has its effects.
    ///
    /// # Errors
    /// [`ParamError`] names the parameter of them that is out of its bound.
    pub(super) fn put_on(
        &mut self,
        inverter: &inverter::Params,
        link: Option<&inverter::LinkParams>,
        h: f64,
    ) -> Result<(), ParamError> {
        self.inverter = RealInverter::new(inverter, link, self.motor.params(), h)?.map(Box::new);
        Ok(())
    }

    pub(super) fn set_sensor(&mut self, sensor: CurrentSensorState) {
        self.sensor = Some(Box::new(sensor));
    }

    /// Puts the motor behind a cable with this wiring.
    ///
    /// # Errors
    /// [`ParamError`] names its parameter that is out of its bound, or a lost phase of a motor that saturates.
    pub(super) fn put_behind(&mut self, wiring: Wiring) -> Result<(), ParamError> {
        if let (Some((_, at)), true) = (wiring.open, self.effects.as_ref().is_some_and(|real| real.saturates())) {
            return Err(ParamError {
                name: WiringParameter::OPEN_AT.name,
                value: at,
                bound: "that of a motor that does not saturate",
            });
        }
        self.cable = if wiring.is_right() { None } else { Some(Box::new(Cable::new(wiring)?)) };
        Ok(())
    }

    /// Turns the rotor to `motor`, and returns its electrical angle.
    #[inline(always)]
    pub(super) fn turn_to(&mut self, motor: BodyState) -> ElectricalAngle {
        let angle = ElectricalAngle::from_mechanical(motor.position, self.motor.params().electrical_ratio);
        self.rotor = KnownRotation::of(angle);
        angle
    }

    /// Turns the rotor to `motor`, and returns the stator current measured by the drive's sensors (A, peak).
    #[inline(always)]
    pub(super) fn measured_current(&mut self, motor: BodyState) -> AlphaBeta {
        let angle = self.turn_to(motor);
        let rotor = self.rotor.rotation();
        if self.cable.is_some() {
            return self.measured_at_the_legs(angle);
        }
        match &mut self.sensor {
            None => self.state.current.to_alpha_beta(rotor),
            Some(sensor) => sensor.read(self.state.current, angle, rotor),
        }
    }

    /// Rotor at the last measurement of the current.
    #[inline(always)]
    pub(super) const fn rotor(&self) -> KnownRotation {
        self.rotor
    }

    /// Stator current in the rotor frame (A, peak).
    #[inline(always)]
    pub(super) const fn current(&self) -> Dq {
        self.state.current
    }

    #[cfg(test)]
    pub(super) const fn set_current(&mut self, current: Dq) {
        self.state.current = current;
    }

    /// True if the inverter gave less voltage than requested at the last tick.
    #[inline(always)]
    pub(super) const fn shortens(&self) -> bool {
        self.shortens
    }

    /// Voltage of the inverter over the last tick that was advanced (V, peak).
    #[inline(always)]
    pub(super) const fn voltage(&self) -> Dq {
        self.voltage
    }

    /// Mean powers over that tick (W); zero if they are left out.
    #[inline(always)]
    pub(super) fn power(&self) -> pmsm::Power {
        self.power.unwrap_or_default()
    }

    /// Temperatures at this tick; zero without warming.
    #[inline(always)]
    pub(super) fn temperatures(&self) -> pmsm::Temperatures {
        self.effects.as_ref().and_then(|effects| effects.temperatures()).unwrap_or_default()
    }

    /// Mean loss of the inverter over that tick (W); zero if left out.
    #[inline(always)]
    pub(super) fn inverter_loss(&self) -> f64 {
        self.inverter.as_ref().map_or(0.0, |inverter| inverter.loss())
    }

    /// Length of the current over that tick; zero without a switching inverter.
    #[inline(always)]
    pub(super) fn ripple(&self) -> inverter::Ripple {
        self.inverter.as_ref().map_or_else(inverter::Ripple::default, |inverter| inverter.ripple())
    }

    /// Voltage of the DC link (V), and its mean powers over that tick (W).
    #[inline(always)]
    pub(super) fn link(&self) -> (f64, inverter::LinkPower) {
        (self.u_dc, self.inverter.as_ref().map_or_else(inverter::LinkPower::default, |inverter| inverter.link_power()))
    }

    /// True if the link has less than half of its voltage without load (assumed: drives trip somewhere between half and three quarters).
    #[inline(always)]
    pub(super) fn link_has_collapsed(&self) -> bool {
        self.inverter
            .as_ref()
            .is_some_and(|inverter| inverter.link_voltage().is_some_and(|full| self.u_dc < 0.5 * full))
    }

    /// Leaves the powers out from now on, unless a link has to supply them.
    pub(super) fn leave_power_out(&mut self) {
        if !self.inverter.as_ref().is_some_and(|inverter| inverter.has_link()) {
            self.power = None;
        }
    }

    /// Advances from tick k to k+1 (`h` s) with the voltage `wanted` of the inverter and returns the mean effort over it (N·m or N).
    #[inline(always)]
    pub(super) fn advance(&mut self, wanted: AlphaBeta, motor: BodyState, h: f64) -> f64 {
        let mean_speed = self.mean_speed(motor);
        self.last_speed = motor.velocity;
        if self.effects.is_some() || self.inverter.is_some() || self.cable.is_some() {
            return self.advance_real(wanted, pmsm::Travel { position: motor.position, speed: mean_speed }, h);
        }
        let given = inverter::output(wanted, self.u_dc);
        self.shortens = inverter::falls_short(given, wanted);
        let ticks = &self.motor;
        let omega_e = ticks.params().electrical_ratio * mean_speed;
        let input = pmsm::Input { voltage: given, rotor: self.rotor.rotation(), omega_e };
        self.voltage = input.voltage_at_middle(h);
        match &mut self.power {
            None => ticks.step(&mut self.state, &input),
            Some(power) => ticks.step_with_power(&mut self.state, &input, power),
        }
    }

    /// Mean speed of the coming tick: extrapolated from the last two ticks, of second order.
    #[inline(always)]
    fn mean_speed(&self, motor: BodyState) -> f64 {
        motor.velocity + (motor.velocity - self.last_speed) / 2.0
    }

    /// Switches the power off for a tick of `h` (s); returns the mean effort of the motor over it. The current is gone within the tick,
    /// which takes a real inverter some milliseconds, and its energy back in the DC link; no current flows back as long as the back-EMF is
    /// below the DC link.
    #[inline(always)]
    pub(super) fn switch_off(&mut self, motor: BodyState, h: f64) -> f64 {
        let (params, current) = (self.motor.params(), self.state.current);
        let effects = self.effects.as_ref();
        let energy = effects.map_or_else(|| params.stored_energy(current), |real| real.stored_energy(params, current));
        let returned = -energy / h;
        let power = pmsm::Power { electrical: returned, stored: returned, ..Default::default() };
        let mut output = pmsm::Output { torque: 0.0, power };
        if self.effects.is_some() || self.inverter.is_some() {
            let travel = pmsm::Travel { position: motor.position, speed: self.mean_speed(motor) };
            output = self.rest(output, travel, h);
        }
        if let Some(cable) = &mut self.cable {
            cable.rest();
        }
        self.power = self.power.map(|_| output.power);
        self.state = pmsm::State::default();
        (self.last_speed, self.shortens, self.voltage) = (motor.velocity, false, Dq::default());
        output.torque
    }
}

#[cfg(test)]
mod tests;
