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
//! [`Settings::answer_age`]: super::Settings::answer_age
use servobench_base::Setpoint;
use servobench_motion::interpolate::{Interval, Mode, Sample};

/// Set-points that are kept: of as many cycles as a frame may be on its way, there and back, and of two for the age.
const KEPT: usize = 34;

/// How old what is compared is (bus cycles), at most.
pub(crate) const LONGEST: u64 = KEPT as u64 - 1;

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
}

impl PositionLoop {
    pub(crate) const OPEN: Self =
        Self { kept: [PutOut { tick: 0, x: 0.0, v: 0.0 }; KEPT], newest: 0, count: 0, error: 0.0 };

    /// Forgets what was put out: the axis is where it is.
    pub(crate) const fn open(&mut self) {
        (self.count, self.error) = (0, 0.0);
    }

    /// Takes what is put out at `tick`.
    pub(crate) fn put_out(&mut self, tick: u64, setpoint: &Setpoint) {
        self.newest = (self.newest + 1) % KEPT;
        self.kept[self.newest] = PutOut { tick, x: setpoint.x, v: setpoint.v };
        self.count = (self.count + 1).min(KEPT);
    }

    /// Takes the position of an axis that should be where the set-point of `tick` was.
    pub(crate) fn receive(&mut self, position: f64, tick: u64, seconds_per_tick: f64) {
        self.error = self.at(tick, seconds_per_tick).map_or(0.0, |reference| reference - position);
    }

    /// Set-point less position, of the same time.
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
                position_loop.receive(1.0, tick, TICK);
                let error = position_loop.error() - (motion(tick).x - 1.0);
                assert!(error.abs() < 4e-15, "a few roundings at 3 m: {error} at {tick} of {cycle}");
            }
        }
    }

    #[test]
    fn before_the_first_set_point_the_axis_is_on_the_line_to_it() {
        let mut position_loop = PositionLoop::OPEN;
        position_loop.receive(0.3, 40, TICK);
        assert_eq!(position_loop.error().to_bits(), 0.0_f64.to_bits(), "nothing is followed");
        position_loop.put_out(100, &Setpoint { v: 0.1, ..Setpoint::at_rest(0.5) });
        position_loop.receive(0.25, 40, TICK);
        // 60 ticks before, at 0.1 m/s.
        assert!((position_loop.error() - (0.25 - 0.1 * 60.0 * TICK)).abs() < 1e-15, "{}", position_loop.error());
        position_loop.receive(0.25, 100, TICK);
        assert_eq!(position_loop.error().to_bits(), 0.25_f64.to_bits());
        position_loop.open();
        position_loop.receive(0.3, 200, TICK);
        assert_eq!(position_loop.error().to_bits(), 0.0_f64.to_bits());
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
