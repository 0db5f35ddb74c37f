//! The position loop of the master (csv): what a position that is on its way for some cycles is compared with.
//!
//! # The delayed reference
//!
//! A velocity that is put out at kT is reached by the axis when the drive's interpolation ends, a cycle after the frame is
//! there. The first answer that knows of it is gathered then, of positions that are [`Settings::answer_age`] old, and is received
//! at (k + round trip)·T. So where set-points s(t) are put out, the position x that is received at t is that of an axis which
//! should be at
//!
//! ```text
//! s(t − D),     D = round_trip·T + answer_age,     and v(t) = K·(s(t − D) − x) + f·ds/dt(t)
//! ```
//!
//! Compared with s(t), an axis that is where it should be would be off by velocity × D, and the loop would push it that far
//! ahead. When no answer comes, the last difference stands: position and set-point are those of the same time.
//!
//! The axis would also be right if the position were predicted by D. That needs a model of the axis and puts it into the loop:
//! it changes what is stable. The delay of a reference is outside of the loop.
//!
//! # Stability
//!
//! Linear from one velocity to the next, the axis covers T·(v(k) + v(k−1))/2 in a cycle, and what is received is D old. Without age,
//! D = rT, the characteristic equation is
//!
//! ```text
//! (z − 1)·z^r + K·T/2·(z + 1) = 0,     at z = exp(iθ):  i·tan(θ/2)·exp(i·r·θ) = −K·T/2   ⇒   θ = π/(2r)
//! K_u = 2/T·tan(π·T/(4D))      gain margin = K_u/K > π/(2·K·D)
//! ```
//!
//! K_u holds for ages of whole cycles exactly, in between within 3 % for D < 2T and 0.1 % above. π/(2D) is the gain at which
//! an integrator with a dead time D oscillates (Hayes 1950). A drive whose velocity loop lags by τ adds it to D.
//!
//! # What is left
//!
//! With f = 1 the error ε obeys dε/dt = −K·ε(t − D) + d(t), where d is by how much the axis misses the velocity that it is fed
//! forward with. Up to K·D = 1/e = 0.37 such a loop does not swing: its impulse response stays positive (Győri & Ladas 1991,
//! ch. 2), and its integral is 1/K, so that
//!
//! ```text
//! |ε| ≤ max|d|/K,     |d| ≤ |a|·τ + |j|·T²/12 + half a unit of velocity
//! ```
//!
//! a·τ where the velocity lags by τ, j·T²/12 as the drive goes in lines between velocities which lie on a parabola. Nothing of
//! it is left at constant velocity but the units of the bus, whatever the velocity. With f below 1, (1 − f)·v/K is left.
//!
//! Cycles that come late are not known to the master: with jitter the error is velocity × jitter.
//!
//! # Integral and derivative
//!
//! With T_i and T_d the loop is
//!
//! ```text
//! v = K·(ε + I + D) + f·ds/dt, within ±limit     I(k+1) = I(k) + T/T_i·ε(k)     D(k) = (T_f·D(k−1) + T_d·(ε(k) − ε(k−1)))/(T_f + h)
//! ```
//!
//! (Åström & Murray, *Feedback Systems*, 2nd ed., §11.5), h being the time from one position to the next, after lost frames more than T.
//! The integral takes out whatever is constant: a velocity that the axis misses by a constant share, and the lag (1 − f)·v/K. While the
//! velocity is at its limit, and the error would drive it further, the integral stands, so that it does not wind up.
//!
//! Without derivative the boundary of stability is where θ, and with it K_u, obeys
//!
//! ```text
//! c = T/(2·T_i),  t = tan(θ/2):    tan(r·θ) = t·(1 − c)/c     K_u = 2·t/(T·√((1 − c)² + (c/t)²))
//! ```
//!
//! which for T ≪ D is tan(ω·D) = ω·T_i, K_u = ω·sin(ω·D): none at all for T_i ≤ D. With both, C(z) = 1 + T/T_i/(z − 1) +
//! T_d·(z − 1)/(T·z + T_f·(z − 1)) multiplies T/2·(z + 1)/((z − 1)·z^r), and K_u is 1/|…| where its phase is −π.
//!
//! [`Settings::answer_age`]: super::Settings::answer_age
use crate::FieldbusError;
use servobench_base::{Setpoint, Stateful, non_negative, positive};
use servobench_motion::interpolate::{Interval, Mode, Sample};

/// Set-points that are kept: of as many cycles as a frame may be on its way, there and back, and of two for the age.
const KEPT: usize = 34;

/// How old what is compared is (bus cycles), at most.
pub(crate) const LONGEST: u64 = KEPT as u64 - 1;

/// Gains of the position loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PositionGains {
    /// Proportional gain K (1/s).
    pub gain: f64,
    /// Integral time T_i (s); `None` without an integral.
    pub integral_time: Option<f64>,
    /// Derivative of the error; `None` without.
    pub derivative: Option<Derivative>,
}

/// Derivative of a filtered error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Derivative {
    /// Derivative time T_d (s).
    pub time: f64,
    /// Time constant T_f of the low-pass before it (s); 0 for none.
    pub filter: f64,
}

impl PositionGains {
    /// Neither integral nor derivative.
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

/// Law of the position loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    /// Its gains.
    pub gains: PositionGains,
    /// Share of the velocity of the set-point that goes straight on.
    pub feedforward: f64,
    /// Largest velocity that is commanded (m/s or rad/s).
    pub limit: f64,
}

/// A set-point that was put out.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
struct PutOut {
    /// When (base ticks).
    tick: u64,
    x: f64,
    v: f64,
}

/// The set-points that were put out, and what the axis is off by.
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct PositionLoop {
    kept: [PutOut; KEPT],
    newest: usize,
    count: usize,
    error: f64,
    /// When the position of that was received (base ticks); `None` before the first one.
    received: Option<u64>,
    /// I, once it has begun (m or rad).
    integral: Option<f64>,
    /// D (m or rad).
    derivative: f64,
}

impl PositionLoop {
    /// Nothing put out, nothing received.
    pub const OPEN: Self = Self {
        kept: [PutOut { tick: 0, x: 0.0, v: 0.0 }; KEPT],
        newest: 0,
        count: 0,
        error: 0.0,
        received: None,
        integral: None,
        derivative: 0.0,
    };

    /// Forgets what was put out: the axis is where it is.
    pub(crate) const fn open(&mut self) {
        (self.count, self.error) = (0, 0.0);
        (self.received, self.integral, self.derivative) = (None, None, 0.0);
    }

    /// Takes what is put out at `tick`.
    pub fn put_out(&mut self, tick: u64, setpoint: &Setpoint) {
        self.newest = (self.newest + 1) % KEPT;
        self.kept[self.newest] = PutOut { tick, x: setpoint.x, v: setpoint.v };
        self.count = (self.count + 1).min(KEPT);
    }

    /// Takes the position, received `now`, of an axis that should be where the set-point of `tick` was.
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

    /// The velocity that is commanded over a cycle of `cycle` (s) while the set-point goes at `v`, and whether the limit cut it. The
    /// integral begins with what keeps the axis at its velocity.
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

    /// What was put out at `tick`, between two cycles the cubic by positions and velocities; before the first of them on the line
    /// that leads to it, as an axis moves that begins to be followed.
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
    // What was put out is finite.
    cubic.and_then(|cubic| cubic.at(fraction)).map_or(from.x, |command| command.setpoint.x)
}

#[cfg(test)]
mod tests;
