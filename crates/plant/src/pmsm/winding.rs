//! The winding of a motor between two changes of its voltage: over a whole tick, or from edge to edge of a switching inverter.
#![expect(clippy::inline_always, reason = "what is inlined is compiled for the registers of its caller")]
use super::{Input, Output, Power, State};
use servobench_base::{AlphaBeta, Dq, Rotation};

/// A time at constant speed on a voltage that is constant in the stator frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Span {
    /// Voltage at the terminals (V, peak, phase to neutral).
    pub(crate) voltage: AlphaBeta,
    /// Drop of the devices before the terminals, for its work alone (V).
    pub(crate) drop: AlphaBeta,
    /// Rotor at the beginning.
    pub(crate) rotor: Rotation,
    /// Electrical speed (rad/s).
    pub(crate) omega: f64,
    /// Length (s).
    pub(crate) time: f64,
}

/// Means over a time, times that time, in amplitudes of dq; they are added up. 3/2 of each is that of the three phases.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Sums {
    /// Torque, per pole pair.
    pub(crate) torque: f64,
    /// Loss in the resistance of the motor.
    pub(crate) copper: f64,
    /// i_d² + i_q².
    pub(crate) square: f64,
    /// Work of the voltage.
    pub(crate) work: f64,
    /// Work of the drop of the devices.
    pub(crate) other: f64,
}

impl Sums {
    /// Mean torque and powers over a tick of `h` (s) at the electrical speed `omega_e` (rad/s), in which the field takes `stored` (J).
    pub(crate) fn output(&self, stored: f64, electrical_ratio: f64, omega_e: f64, h: f64) -> Output {
        let per = 1.0 / h;
        let torque = 1.5 * electrical_ratio * self.torque * per;
        let power = Power {
            electrical: 1.5 * self.work * per,
            copper: 1.5 * self.copper * per,
            iron: 0.0,
            stored: stored * per,
            air_gap: torque * omega_e / electrical_ratio,
        };
        Output { torque, power }
    }

    pub(crate) fn add(&mut self, more: &Self) {
        self.torque += more.torque;
        self.copper += more.copper;
        self.square += more.square;
        self.work += more.work;
        self.other += more.other;
    }

    pub(crate) const NAN: Self =
        Self { torque: f64::NAN, copper: f64::NAN, square: f64::NAN, work: f64::NAN, other: f64::NAN };
}

/// A winding that can be advanced by any time.
pub(crate) trait Winding {
    /// The current at the end of `over`, which begins with `i` (A, peak). Results are added to `sums`; without `POWER` the torque alone.
    fn advance<const POWER: bool>(&self, i: Dq, over: &Span, sums: &mut Sums) -> Dq;

    /// Electrical angle per motor coordinate.
    fn electrical_ratio(&self) -> f64;

    /// Increase of the field energy from the current `before` to `after` (J).
    fn stored(&self, before: Dq, after: Dq) -> f64;

    /// Advances the currents by a tick of `h` (s) and returns mean torque and powers.
    fn step(&self, x: &mut State, u: &Input, h: f64) -> Output {
        let over = Span { voltage: u.voltage, drop: AlphaBeta::default(), rotor: u.rotor, omega: u.omega_e, time: h };
        let (before, mut sums) = (x.current, Sums::default());
        x.current = self.advance::<true>(before, &over, &mut sums);
        sums.output(self.stored(before, x.current), self.electrical_ratio(), u.omega_e, h)
    }
}

/// Increase (J) of the field energy of constant inductances `l` (H) from `before` to `after`: by Δ(i²) = Δi·(i + i + Δi), which keeps
/// the digits of Δi.
#[inline(always)]
pub(super) fn stored(l: Dq, before: Dq, after: Dq) -> f64 {
    0.75 * (l.d * (after.d - before.d) * (after.d + before.d) + l.q * (after.q - before.q) * (after.q + before.q))
}
