//! A tick of an inverter and the winding on it, however its voltage is made.
use crate::pmsm;
use servobench_base::{AlphaBeta, Rotation, Stateful};

/// What acts from tick k to k+1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Input {
    /// Voltage that is asked for (V).
    pub(crate) wanted: AlphaBeta,
    /// Voltage of the link (V).
    pub(crate) u_dc: f64,
    /// Rotor at tick k.
    pub(crate) rotor: Rotation,
    /// Mean electrical speed over the tick (rad/s).
    pub(crate) omega_e: f64,
}

/// What a tick gives beside the current.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Tick {
    /// Mean torque (N·m).
    pub(crate) torque: f64,
    /// Mean powers of the motor (W).
    pub(crate) power: pmsm::Power,
    /// Mean loss of the devices (W).
    pub(crate) loss: f64,
    /// Mean voltage at the motor's terminals but for what a resistance of the devices takes (V).
    pub(crate) voltage: AlphaBeta,
    /// Whether there was less than what was asked for.
    pub(crate) shortened: bool,
    /// The current between the ends of the tick, where the inverter follows it.
    pub(crate) ripple: Ripple,
}

/// Length of the current vector over a tick, the ripple of an inverter that switches included (A); zero with one that is averaged.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct Ripple {
    /// Largest at the edges of the switches and the ends of the tick.
    pub peak: f64,
    /// Root of its mean square; zero where the powers of the motor are left out.
    pub rms: f64,
}

impl Tick {
    /// Of what happened in a tick of `h` (s) to a winding behind `resistance` (Ω), in whose field `stored` (J) went, on a mean voltage;
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
