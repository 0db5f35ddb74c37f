//! Position loop of the master (csv), with a reference delayed like the position from the bus.
//!
//! # The delayed reference
//!
//! The axis reaches a velocity that is output at kT when the drive's interpolation ends, a cycle after the arrival of the frame. The first
//! answer that reflects it is formed then, from positions that are [`Settings::answer_age`] old, and is received at (k + round trip)·T. So
//! for the set-points s(t), the position x received at t is that of an axis which should be at
//!
//! ```text
//! s(t − D),     D = round_trip·T + answer_age,     and v(t) = K·(s(t − D) − x) + f·ds/dt(t)
//! ```
//!
//! Compared with s(t), an axis in the right place would have an apparent error of velocity × D, and the loop would push it that far ahead.
//! If no answer comes, the last difference is kept: position and set-point are those of the same time.
//!
//! Predicting the position by D would also be correct. That needs a model of the axis inside the loop, which changes its stability. The
//! delay of a reference is outside of the loop.
//!
//! # Stability
//!
//! The velocity is linear from one value to the next, so the axis covers T·(v(k) + v(k−1))/2 in a cycle, and the received position is D
//! old. Without answer age, D = rT, the characteristic equation is
//!
//! ```text
//! (z − 1)·z^r + K·T/2·(z + 1) = 0,     at z = exp(iθ):  i·tan(θ/2)·exp(i·r·θ) = −K·T/2   ⇒   θ = π/(2r)
//! K_u = 2/T·tan(π·T/(4D))      gain margin = K_u/K > π/(2·K·D)
//! ```
//!
//! K_u is exact for ages of whole cycles, and in between within 3 % for D < 2T and 0.1 % above. π/(2D) is the gain at which an integrator
//! with a dead time D oscillates (Hayes 1950). A drive whose velocity loop lags by τ adds it to D.
//!
//! # Remaining error
//!
//! With f = 1 the error ε obeys dε/dt = −K·ε(t − D) + d(t), where d is the deviation of the axis from the velocity that is fed forward. Up
//! to K·D = 1/e = 0.37 such a loop does not oscillate: its impulse response stays positive (Győri & Ladas 1991, ch. 2), and its integral is
//! 1/K, so that
//!
//! ```text
//! |ε| ≤ max|d|/K,     |d| ≤ |a|·τ + |j|·T²/12 + half a unit of velocity
//! ```
//!
//! a·τ if the velocity lags by τ, j·T²/12 as the drive ramps linearly between velocities which lie on a parabola. At constant velocity only
//! the units of the bus remain, at every velocity. With f below 1, (1 − f)·v/K remains.
//!
//! The master does not detect late cycles: with jitter the error is velocity × jitter.
//!
//! # Integral and derivative
//!
//! With T_i and T_d the loop is
//!
//! ```text
//! v = K·(ε + I + D) + f·ds/dt, within ±limit     I(k+1) = I(k) + T/T_i·ε(k)     D(k) = (T_f·D(k−1) + T_d·(ε(k) − ε(k−1)))/(T_f + h)
//! ```
//!
//! (Åström & Murray, *Feedback Systems*, 2nd ed., §11.5), where h is the time from one position to the next, more than T after lost frames.
//! The integral removes constant errors: a velocity that the axis misses by a constant share, and the lag (1 − f)·v/K. While the velocity
//! is at its limit, and the error would drive it further, the integral is held, so that it does not wind up.
//!
//! Without derivative, θ at the boundary of stability, and with it K_u, obeys
//!
//! ```text
//! c = T/(2·T_i),  t = tan(θ/2):    tan(r·θ) = t·(1 − c)/c     K_u = 2·t/(T·√((1 − c)² + (c/t)²))
//! ```
//!
//! which for T ≪ D is tan(ω·D) = ω·T_i, K_u = ω·sin(ω·D): no stable gain for T_i ≤ D. With both, C(z) = 1 + T/T_i/(z − 1) + T_d·(z −
//! 1)/(T·z + T_f·(z − 1)) multiplies T/2·(z + 1)/((z − 1)·z^r), and K_u is 1/|…| where its phase is −π.
//!
//! [`Settings::answer_age`]: super::Settings::answer_age
use crate::FieldbusError;
use servobench_base::{Setpoint, Stateful, non_negative, positive};
use servobench_motion::interpolate::{Interval, Mode, Sample};

/// Number of stored set-points: as many as the cycles of the longest round trip of a frame, and two for the age.
const KEPT: usize = 34;

/// Largest age of the compared values (bus cycles).
pub(crate) const LONGEST: u64 = KEPT as u64 - 1;

/// Gains of the position loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionGains {
    /// Proportional gain K (1/s).
    pub gain: f64,
    /// Integral time T_i (s); `None` without an integral.
    pub integral_time: Option<f64>,
    /// Derivative of the error; `None` without one.
    pub derivative: Option<Derivative>,
}

/// Derivative of the filtered error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Derivative {
    /// Derivative time T_d (s).
    pub time: f64,
    /// Time constant T_f of the low-pass before it (s); 0 for none.
    pub filter: f64,
}

impl PositionGains {
    /// Gains without integral and derivative.
    #[must_use]
    pub const fn proportional(gain: f64) -> Self {
        Self { gain, integral_time: None, derivative: None }
    }

    pub(crate) fn check(&self) -> Result<(), FieldbusError> {
        non_negative("control.gains.gain", self.gain)?;
        if let Some(time) = self.integral_time {
            positive("control.gains.integral_time", time)?;
        }
        if let Some(Derivative { time, filter }) = self.derivative {
            positive("control.gains.derivative.time", time)?;
            non_negative("control.gains.derivative.filter", filter)?;
        }
        Ok(())
    }
}

/// Control law of the position loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// Gains.
    pub gains: PositionGains,
    /// Share of the set-point's velocity that is fed forward.
    pub feedforward: f64,
    /// Largest commanded velocity (m/s or rad/s).
    pub limit: f64,
}

/// A set-point that was output.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
struct PutOut {
    /// Time of output (base ticks).
    tick: u64,
    x: f64,
    v: f64,
}

/// Past set-points, and the position error.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct PositionLoop {
    kept: [PutOut; KEPT],
    newest: usize,
    count: usize,
    error: f64,
    /// Time at which the position of that error was received (base ticks); `None` before the first one.
    received: Option<u64>,
    /// I, once begun (m or rad).
    integral: Option<f64>,
    /// D (m or rad).
    derivative: f64,
}

impl PositionLoop {
    /// Initial state: no set-points and no position.
    pub const OPEN: Self = Self {
        kept: [PutOut { tick: 0, x: 0.0, v: 0.0 }; KEPT],
        newest: 0,
        count: 0,
        error: 0.0,
        received: None,
        integral: None,
        derivative: 0.0,
    };

    /// Forgets the past set-points: the axis is where it should be.
    pub(crate) const fn open(&mut self) {
        (self.count, self.error) = (0, 0.0);
        (self.received, self.integral, self.derivative) = (None, None, 0.0);
    }

    /// Stores the set-point that is output at `tick`.
    pub fn put_out(&mut self, tick: u64, setpoint: &Setpoint) {
        self.newest = (self.newest + 1) % KEPT;
        self.kept[self.newest] = PutOut { tick, x: setpoint.x, v: setpoint.v };
        self.count = (self.count + 1).min(KEPT);
    }

    /// Takes the position, received at `now`, of an axis that should have been at the set-point of `tick`.
    pub fn receive(&mut self, gains: &PositionGains, position: f64, tick: u64, now: u64, seconds_per_tick: f64) {
        let before = self.error;
        self.error = self.at(tick, seconds_per_tick).map_or(0.0, |reference| reference - position);
        if let (Some(Derivative { time, filter }), Some(then)) = (gains.derivative, self.received) {
            let h = now.saturating_sub(then) as f64 * seconds_per_tick;
            if h > 0.0 {
                self.derivative = (filter * self.derivative + time * (self.error - before)) / (filter + h);
            }
        }
        self.received = Some(now);
    }

    /// Velocity command for a cycle of `cycle` (s) while the set-point moves at `v`, and true if the limit cut it. The integral begins with
    /// the value that keeps the axis at its velocity.
    pub fn velocity(&mut self, law: &Law, v: f64, cycle: f64) -> (f64, bool) {
        let Law { gains: PositionGains { gain, integral_time, derivative }, feedforward, limit } = *law;
        let mut wanted = gain * self.error + feedforward * v;
        if derivative.is_some() {
            wanted += gain * self.derivative;
        }
        let integral = integral_time.filter(|_| gain > 0.0).map(|time| {
            let begun = *self.integral.get_or_insert((1.0 - feedforward) * v / gain);
            wanted += gain * begun;
            (begun, cycle / time)
        });
        let is_cut = wanted.abs() > limit;
        if let Some((begun, share)) = integral
            && !(is_cut && wanted * self.error > 0.0)
        {
            self.integral = Some(begun + share * self.error);
        }
        (wanted.clamp(-limit, limit), is_cut)
    }

    /// Set-point less position, of the same time.
    #[cfg(test)]
    pub(crate) const fn error(&self) -> f64 {
        self.error
    }

    /// Set-point that was output at `tick`: between two cycles the cubic by positions and velocities; before the first of them the line
    /// that leads to it, like the motion of an axis when following begins.
    fn at(&self, tick: u64, seconds_per_tick: f64) -> Option<f64> {
        let ago = |cycles: usize| self.kept[(self.newest + KEPT - cycles) % KEPT];
        let mut later: Option<PutOut> = None;
        for cycles in 0..self.count {
            let earlier = ago(cycles);
            if earlier.tick <= tick {
                return Some(later.map_or(earlier.x, |later| between(&earlier, &later, tick, seconds_per_tick)));
            }
            later = Some(earlier);
        }
        later.map(|first| first.x - first.v * ((first.tick - tick) as f64 * seconds_per_tick))
    }
}

fn between(from: &PutOut, to: &PutOut, tick: u64, seconds_per_tick: f64) -> f64 {
    if tick == from.tick {
        return from.x;
    }
    let sample = |at: &PutOut| Sample { x: at.x, v: at.v, a: 0.0, torque: 0.0 };
    let ticks = (to.tick - from.tick) as f64;
    let fraction = (tick - from.tick) as f64 / ticks;
    let cubic = Interval::new(Mode::Cubic, ticks * seconds_per_tick, &[sample(from), sample(to)]);
    // Past set-points are finite.
    cubic.and_then(|cubic| cubic.at(fraction)).map_or(from.x, |command| command.setpoint.x)
}

#[cfg(test)]
mod tests;
