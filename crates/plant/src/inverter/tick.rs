//! A tick of an inverter and the winding on it, for every kind of modulation.
use crate::pmsm;
use servobench_base::{AlphaBeta, Rotation, Stateful};

/// Inputs from tick k to k+1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Input {
    /// Requested voltage (V).
    pub(crate) wanted: AlphaBeta,
    /// Voltage of the link (V).
    pub(crate) u_dc: f64,
    /// Rotor at tick k.
    pub(crate) rotor: Rotation,
    /// Mean electrical speed over the tick (rad/s).
    pub(crate) omega_e: f64,
}

/// Results of a tick beside the current.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Tick {
    /// Mean torque (N·m).
    pub(crate) torque: f64,
    /// Mean powers of the motor (W).
    pub(crate) power: pmsm::Power,
    /// Mean loss of the devices (W).
    pub(crate) loss: f64,
    /// Mean voltage at the motor's terminals, without the drop over the resistance of the devices (V).
    pub(crate) voltage: AlphaBeta,
    /// True if the voltage was less than requested.
    pub(crate) shortened: bool,
    /// The current between the ends of the tick, if the inverter follows it.
    pub(crate) ripple: Ripple,
}

/// Length of the current vector over a tick, including the ripple of a switching inverter (A); zero with an averaged one.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Ripple {
    /// Largest at the edges of the switches and the ends of the tick.
    pub peak: f64,
    /// Root of its mean square; zero where the powers of the motor are left out.
    pub rms: f64,
}

impl Tick {
    /// Result of a tick of `h` (s) of a winding behind `resistance` (Ω), whose field gained `stored` (J), on a mean voltage;
    /// without `POWER` the powers and the loss are left out.
    #[expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
    #[inline(always)]
    pub(super) fn of<const POWER: bool, W: pmsm::Winding>(
        winding: &W,
        sums: &pmsm::Sums,
        stored: f64,
        (resistance, omega_e, h): (f64, f64, f64),
        (voltage, shortened): (AlphaBeta, bool),
    ) -> Self {
        let pmsm::Output { torque, power } = sums.output(stored, winding.electrical_ratio(), omega_e, h);
        if !POWER {
            return Self { torque, voltage, shortened, ..Self::default() };
        }
        let per = 1.0 / h;
        let ohmic = 1.5 * resistance * sums.square * per;
        let power = pmsm::Power { electrical: power.electrical - ohmic, ..power };
        Self { torque, power, loss: ohmic + 1.5 * sums.other * per, voltage, shortened, ripple: Ripple::default() }
    }
}
