//! An inverter and the synchronous motor on it.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use crate::mechanics::BodyState;
use crate::{inverter, pmsm};
use servobench_base::{AlphaBeta, Dq, ElectricalAngle, KnownRotation, ParamError};
use std::sync::Arc;

/// Inverter, motor and current sensors.
///
/// ```text
/// tick k:  measure (rotor, current) → inverter (voltage over the tick) → motor (current at k+1, mean effort, powers)
/// ```
#[derive(Debug, Clone)]
pub(super) struct Synchronous {
    motor: Arc<pmsm::Ticks>,
    state: pmsm::State,
    /// DC-link voltage (V).
    u_dc: f64,
    /// Motor speed a tick ago (rad/s), to tell the mean over the coming tick.
    last_speed: f64,
    /// Rotor at this tick.
    rotor: KnownRotation,
    /// Whether the inverter gives less voltage than it is asked for.
    shortens: bool,
    /// What the inverter gives over the coming tick, as the rotor meets it in the middle of the tick (V, peak).
    voltage: Dq,
    /// Mean powers of the motor over the tick, where they are wanted.
    power: Option<pmsm::Power>,
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
        })
    }

    /// Brings the rotor to `motor`, and gives the stator current as the drive's sensors see it (A, peak).
    #[inline(always)]
    pub(super) fn measured_current(&mut self, motor: BodyState) -> AlphaBeta {
        let ratio = self.motor.params().electrical_ratio;
        self.rotor = KnownRotation::of(ElectricalAngle::from_mechanical(motor.position, ratio));
        self.state.current.to_alpha_beta(self.rotor.rotation())
    }

    /// Rotor when the current was measured last.
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

    /// Whether the inverter gave less voltage than it was asked for at the last tick.
    #[inline(always)]
    pub(super) const fn shortens(&self) -> bool {
        self.shortens
    }

    /// What the inverter gives over the last tick that was advanced (V, peak).
    #[inline(always)]
    pub(super) const fn voltage(&self) -> Dq {
        self.voltage
    }

    /// Mean powers over that tick (W); zero where nobody wants them.
    #[inline(always)]
    pub(super) fn power(&self) -> pmsm::Power {
        self.power.unwrap_or_default()
    }

    /// Leaves the powers out from now on.
    pub(super) const fn leave_power_out(&mut self) {
        self.power = None;
    }

    /// Goes from tick k to k+1 (`h` s) with the voltage `wanted` of the inverter and returns the mean effort over it (N·m or N).
    #[inline(always)]
    pub(super) fn advance(&mut self, wanted: AlphaBeta, motor: BodyState, h: f64) -> f64 {
        // Straight on from the last two ticks: second order.
        let mean_speed = motor.velocity + (motor.velocity - self.last_speed) / 2.0;
        self.last_speed = motor.velocity;
        let given = inverter::output(wanted, self.u_dc);
        self.shortens = is_shorter(given, wanted);
        let ticks = &self.motor;
        let omega_e = ticks.params().electrical_ratio * mean_speed;
        let input = pmsm::Input { voltage: given, rotor: self.rotor.rotation(), omega_e };
        self.voltage = input.voltage_at_middle(h);
        match &mut self.power {
            None => ticks.step(&mut self.state, &input),
            Some(power) => ticks.step_with_power(&mut self.state, &input, power),
        }
    }

    /// The power goes off, for a tick of `h` (s). The current is gone within the tick, which takes a real inverter some milliseconds,
    /// and its energy back in the DC link; no current flows back as long as the back-EMF is below the DC link.
    #[inline(always)]
    pub(super) fn switch_off(&mut self, motor: BodyState, h: f64) {
        let returned = -self.motor.params().stored_energy(self.state.current) / h;
        self.power = self.power.map(|_| pmsm::Power { electrical: returned, stored: returned, ..Default::default() });
        self.state = pmsm::State::default();
        (self.last_speed, self.shortens, self.voltage) = (motor.velocity, false, Dq::default());
    }
}

/// Whether `given` falls short of `wanted`, by more than the rounding of a drive that keeps to the limit itself.
fn is_shorter(given: AlphaBeta, wanted: AlphaBeta) -> bool {
    let squared = |u: AlphaBeta| u.alpha * u.alpha + u.beta * u.beta;
    given != wanted && squared(given) < (1.0 - 1e-9) * squared(wanted)
}
