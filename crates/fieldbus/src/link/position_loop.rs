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
use servobench_base::{Setpoint, non_negative, positive};
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

/// What the loop commands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law {
    pub(crate) gains: PositionGains,
    /// Share of the velocity of the set-point that goes straight on.
    pub(crate) feedforward: f64,
    /// Largest velocity that is commanded (m/s or rad/s).
    pub(crate) limit: f64,
}

/// A set-point that was put out.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct PutOut {
    /// When (base ticks).
    tick: u64,
    x: f64,
    v: f64,
}

/// The set-points that were put out, and what the axis is off by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PositionLoop {
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
    pub(crate) const OPEN: Self = Self {
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
    pub(crate) fn put_out(&mut self, tick: u64, setpoint: &Setpoint) {
        self.newest = (self.newest + 1) % KEPT;
        self.kept[self.newest] = PutOut { tick, x: setpoint.x, v: setpoint.v };
        self.count = (self.count + 1).min(KEPT);
    }

    /// Takes the position, received `now`, of an axis that should be where the set-point of `tick` was.
    pub(crate) fn receive(&mut self, gains: &PositionGains, position: f64, tick: u64, now: u64, seconds_per_tick: f64) {
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
    pub(crate) fn velocity(&mut self, law: &Law, v: f64, cycle: f64) -> (f64, bool) {
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
mod tests {
    use super::*;

    const TICK: f64 = 1.0 / 16e3;
    const P: PositionGains = PositionGains::proportional(60.0);

    /// Largest gain (1/s) with which a loop over cycles of `cycle` (s) is stable, whose position is `delay` (s) old.
    fn ultimate_gain(cycle: f64, delay: f64) -> f64 {
        2.0 / cycle * libm::tan(core::f64::consts::FRAC_PI_4 * cycle / delay)
    }

    /// Oracle: a cubic, which is its own interpolation.
    #[test]
    fn the_set_point_of_any_tick_that_is_kept_is_found() {
        let motion = |tick: u64| Setpoint { x: 3.0, v: 0.5, a: -4.0, j: 30.0, s: 0.0 }.after(tick as f64 * TICK);
        let mut position_loop = PositionLoop::OPEN;
        for cycle in 0..100 {
            position_loop.put_out(16 * cycle, &motion(16 * cycle));
            let oldest = 16 * cycle.saturating_sub(LONGEST);
            for tick in oldest..=16 * cycle {
                position_loop.receive(&P, 1.0, tick, 0, TICK);
                let error = position_loop.error() - (motion(tick).x - 1.0);
                assert!(error.abs() < 4e-15, "a few roundings at 3 m: {error} at {tick} of {cycle}");
            }
        }
    }

    #[test]
    fn before_the_first_set_point_the_axis_is_on_the_line_to_it() {
        let mut position_loop = PositionLoop::OPEN;
        position_loop.receive(&P, 0.3, 40, 0, TICK);
        assert_eq!(position_loop.error().to_bits(), 0.0_f64.to_bits(), "nothing is followed");
        position_loop.put_out(100, &Setpoint { v: 0.1, ..Setpoint::at_rest(0.5) });
        position_loop.receive(&P, 0.25, 40, 0, TICK);
        // 60 ticks before, at 0.1 m/s.
        assert!((position_loop.error() - (0.25 - 0.1 * 60.0 * TICK)).abs() < 1e-15, "{}", position_loop.error());
        position_loop.receive(&P, 0.25, 100, 0, TICK);
        assert_eq!(position_loop.error().to_bits(), 0.25_f64.to_bits());
        position_loop.open();
        position_loop.receive(&P, 0.3, 200, 0, TICK);
        assert_eq!(position_loop.error().to_bits(), 0.0_f64.to_bits());
    }

    /// Largest gain (1/s) of the loop with integral time and derivative, of a position that is `r` cycles of `cycle` (s) old: where the
    /// phase of everything but the gain is −π, by the frequency response.
    fn ultimate_gain_with(cycle: f64, r: usize, integral_time: Option<f64>, derivative: Option<Derivative>) -> f64 {
        // Complex numbers as pairs.
        let times = |(a, b): (f64, f64), (c, d): (f64, f64)| (a * c - b * d, a * d + b * c);
        let over = |n: (f64, f64), (c, d): (f64, f64)| {
            let (re, im) = times(n, (c, -d));
            (re / (c * c + d * d), im / (c * c + d * d))
        };
        let response = |angle: f64| {
            let z = (angle.cos(), angle.sin());
            let less = (z.0 - 1.0, z.1);
            let mut c = (1.0, 0.0);
            if let Some(time) = integral_time {
                let i = over((cycle / time, 0.0), less);
                c = (c.0 + i.0, c.1 + i.1);
            }
            if let Some(Derivative { time, filter }) = derivative {
                let d = over(
                    (time * less.0, time * less.1),
                    (cycle * z.0 + filter * less.0, cycle * z.1 + filter * less.1),
                );
                c = (c.0 + d.0, c.1 + d.1);
            }
            let plant = over((cycle / 2.0 * (z.0 + 1.0), cycle / 2.0 * z.1), less);
            let late = (r as f64 * angle).sin_cos();
            times(times(c, plant), (late.1, -late.0))
        };
        // The first angle at which it crosses the negative real axis upwards.
        let (mut low, step) = (1e-6, 1e-5);
        let mut before = response(low);
        loop {
            let next = response(low + step);
            if before.1 < 0.0 && next.1 >= 0.0 && next.0 < 0.0 {
                return 1.0 / next.0.hypot(next.1);
            }
            (low, before) = (low + step, next);
            assert!(low < core::f64::consts::PI, "it never crosses");
        }
    }

    /// Largest errors of the loop, run by its own code with an axis that does what it is told, around two fifths and at the end of so many
    /// cycles.
    fn errors(r: usize, gains: PositionGains) -> [f64; 2] {
        let law = Law { gains, feedforward: 1.0, limit: f64::INFINITY };
        let mut position_loop = PositionLoop::OPEN;
        let (mut x, mut velocities, mut positions) = (1e-6, [0.0; 2], [1e-6; 40]);
        let (cycles, mut largest) = (40_000_u64, [0.0_f64; 2]);
        for cycle in 0..cycles {
            let now = 16 * cycle;
            position_loop.put_out(now, &Setpoint::default());
            position_loop.receive(&gains, positions[r - 1], now, now, TICK);
            let (v, _) = position_loop.velocity(&law, 0.0, 1e-3);
            velocities = [velocities[1], v];
            x += 1e-3 / 2.0 * (velocities[0] + velocities[1]);
            positions.rotate_right(1);
            positions[0] = x;
            let half = usize::from(cycle >= cycles / 2);
            if cycle >= cycles / 10 {
                largest[half] = largest[half].max(x.abs());
            }
            if x.abs() > 1e3 {
                largest[1] = f64::INFINITY;
                break;
            }
        }
        largest
    }

    /// Oracles: the frequency response, whose phase is −π at the boundary, against the loop itself, which grows above and fades below; the closed
    /// form for the integral against both.
    #[test]
    fn integral_and_derivative_move_the_boundary_to_where_the_frequency_response_says() {
        let cycle = 1e-3;
        for r in [1_usize, 3, 7] {
            let delay = r as f64 * cycle;
            for (integral_time, derivative) in [
                (None, None),
                (Some(20.0 * delay), None),
                (Some(4.0 * delay), None),
                (None, Some(Derivative { time: 0.3 * delay, filter: 0.1 * delay })),
                (Some(10.0 * delay), Some(Derivative { time: 0.3 * delay, filter: 0.1 * delay })),
                (Some(10.0 * delay), Some(Derivative { time: 0.2 * delay, filter: 0.0 })),
            ] {
                let ultimate = ultimate_gain_with(cycle, r, integral_time, derivative);
                let proportional = ultimate_gain(cycle, delay);
                println!("r {r}, T_i {integral_time:?}, {derivative:?}: {ultimate:.2} of {proportional:.2} 1/s");
                match (integral_time, derivative) {
                    (None, None) => assert!((ultimate / proportional - 1.0).abs() < 1e-4, "{ultimate}"),
                    (Some(time), None) => {
                        let c = cycle / (2.0 * time);
                        // tan(r·θ) − tan(θ/2)·(1 − c)/c changes its sign below π/(2r).
                        let f = |angle: f64| {
                            (r as f64 * angle).sin() * c - (r as f64 * angle).cos() * (angle / 2.0).tan() * (1.0 - c)
                        };
                        let (mut low, mut high) = (1e-9, core::f64::consts::FRAC_PI_2 / r as f64);
                        for _ in 0..200 {
                            let middle = f64::midpoint(low, high);
                            if f(middle) < 0.0 { low = middle } else { high = middle }
                        }
                        let t = (low / 2.0).tan();
                        let closed = 2.0 * t / (cycle * (1.0 - c).hypot(c / t));
                        assert!((ultimate / closed - 1.0).abs() < 1e-4, "{ultimate} {closed}");
                    }
                    _ => {}
                }
                for (share, grows) in [(0.97, false), (1.03, true)] {
                    let largest = errors(r, PositionGains { gain: share * ultimate, integral_time, derivative });
                    assert_eq!(largest[1] > largest[0], grows, "r {r}, {share} of {ultimate}: {largest:?}");
                }
            }
        }
    }

    /// Oracle: x″ + K·x′ + K/T_i·x = 0 without delay: the error of an axis that misses every velocity by d, from rest at t = 0, is
    /// d·(exp(−p·t) − exp(−q·t))/(q − p), p and q its roots. It goes to zero; without the integral it stays at d/K.
    #[test]
    fn the_integral_takes_out_a_velocity_that_the_axis_misses() {
        let (gain, time, missed, cycle) = (20.0, 1.0, 0.05, 1e-4);
        for integral_time in [None, Some(time)] {
            let gains = PositionGains { gain, integral_time, derivative: None };
            let law = Law { gains, feedforward: 1.0, limit: 1.0 };
            let (mut position_loop, mut x) = (PositionLoop::OPEN, 0.0);
            let root = (gain * gain / 4.0 - gain / time).sqrt();
            let (p, q) = (gain / 2.0 - root, gain / 2.0 + root);
            for k in 0..100_000_u64 {
                let t = k as f64 * cycle;
                position_loop.put_out(2 * k, &Setpoint::default());
                position_loop.receive(&gains, x, 2 * k, 2 * k, cycle / 2.0);
                let error = position_loop.error();
                let expected = match integral_time {
                    Some(_) => missed * ((-p * t).exp() - (-q * t).exp()) / (q - p),
                    None => missed / gain * (1.0 - (-gain * t).exp()),
                };
                // Euler with steps of a 500th of 1/K: within that share of the peak.
                assert!((error - expected).abs() < missed / gain * 2.0 * gain * cycle, "{t}: {error} for {expected}");
                let (v, _) = position_loop.velocity(&law, 0.0, cycle);
                x += cycle * (v - missed);
            }
            let left = position_loop.error();
            match integral_time {
                Some(_) => assert!(left.abs() < 1e-6, "{left}"),
                None => assert!((left - missed / gain).abs() < 1e-12, "{left}"),
            }
        }
    }

    /// Oracle: the linear loop that is let go at the limit with an empty integral. Overshoot from ε₀ = limit/K without delay, by the same
    /// closed form; an integral that had wound up for a second would overshoot by many times of it.
    #[test]
    fn at_the_velocity_limit_the_integral_stands() {
        let (gain, time, limit, cycle) = (20.0, 0.5, 0.2, 1e-4);
        let gains = PositionGains { gain, integral_time: Some(time), derivative: None };
        let law = Law { gains, feedforward: 1.0, limit };
        let (mut position_loop, mut x) = (PositionLoop::OPEN, 0.0);
        let (mut overshoot, mut cut) = (0.0_f64, 0.0);
        for k in 0..50_000_u64 {
            position_loop.put_out(2 * k, &Setpoint::at_rest(0.2));
            position_loop.receive(&gains, x, 2 * k, 2 * k, cycle / 2.0);
            let (v, is_cut) = position_loop.velocity(&law, 0.0, cycle);
            assert!(v.abs() <= limit);
            if is_cut {
                assert_eq!(position_loop.integral, Some(0.0), "in cycle {k}");
                cut += cycle;
            }
            x += cycle * v;
            overshoot = overshoot.max(x - 0.2);
        }
        // 0.2 m less the last limit/K at 0.2 m/s.
        assert!((cut - (1.0 - 1.0 / gain)).abs() < 2.0 * cycle, "{cut} s");
        let (start, root) = (limit / gain, (gain * gain / 4.0 - gain / time).sqrt());
        let (p, q) = (gain / 2.0 - root, gain / 2.0 + root);
        // ε(0) = ε₀, ε′(0) = −K·ε₀: ε = ε₀·((q − K)·exp(−p·t) − (p − K)·exp(−q·t))/(q − p), K = p + q.
        let error = |t: f64| start * (q * (-q * t).exp() - p * (-p * t).exp()) / (q - p);
        let expected = (0..50_000).map(|k| -error(f64::from(k) * 1e-4)).fold(0.0, f64::max);
        println!("overshoot {overshoot:.3e} m, {expected:.3e} m");
        assert!((overshoot / expected - 1.0).abs() < 0.02, "{overshoot} {expected}");
    }

    /// Oracle: the filtered difference of a ramp, T_d times its slope with the lag of the filter; after lost frames too.
    #[test]
    fn the_derivative_is_that_of_the_filtered_error() {
        let derivative = Derivative { time: 5e-3, filter: 2e-3 };
        let gains = PositionGains { derivative: Some(derivative), ..P };
        let mut position_loop = PositionLoop::OPEN;
        let mut received = 0;
        for cycle in 0..200_u64 {
            let now = 16 * cycle;
            position_loop.put_out(now, &Setpoint::default());
            // Every third frame is lost.
            if cycle % 3 != 1 {
                let t = now as f64 * TICK;
                position_loop.receive(&gains, -0.3 * t, now, now, TICK);
                received += 1;
            }
        }
        // Fifty time constants later nothing is left of the beginning.
        assert!((position_loop.derivative - 0.3 * 5e-3).abs() < 1e-12, "{} after {received}", position_loop.derivative);
        let law = Law { gains, feedforward: 0.0, limit: 10.0 };
        let (v, _) = position_loop.velocity(&law, 0.0, 1e-3);
        assert!((v - 60.0 * (position_loop.error() + 0.3 * 5e-3)).abs() < 1e-12, "{v}");
    }

    /// Oracle: the recursion of the characteristic equation grows above the gain and
    /// fades below it.
    #[test]
    fn the_ultimate_gain_is_where_the_recursion_neither_grows_nor_fades() {
        for r in [1_usize, 2, 3, 7, 31] {
            let gain = ultimate_gain(1e-3, r as f64 * 1e-3);
            for (share, grows) in [(0.97, false), (1.03, true)] {
                let mut x = [1.0; 40];
                let mut largest = [0.0_f64; 2];
                for step in 0..40_000 {
                    let next = x[0] - share * gain * 1e-3 / 2.0 * (x[r - 1] + x[r]);
                    x.rotate_right(1);
                    x[0] = next;
                    let half = usize::from(step >= 400);
                    if !(400..39_600).contains(&step) {
                        largest[half] = largest[half].max(next.abs());
                    }
                    if next.abs() > 1e6 {
                        largest[1] = next.abs();
                        break;
                    }
                }
                assert_eq!(largest[1] > largest[0], grows, "r {r}, {share} of {gain}: {largest:?}");
            }
        }
    }
}
