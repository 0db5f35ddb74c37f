//! The first half of the shortest snap-limited move.
//!
//! The product of four moving averages ([`crate`]) brings jerk to zero at peak velocity. Without a cruise that is not
//! the shortest: the acceleration may swing directly from +a to −a, crossing zero with the jerk −j. The half move is
//!
//! ```text
//! up:    a from 0 to a_p,   jerk 0 → α → 0          α = min(√a_p, J)     β = a_p/α     lasting α + β
//! hold:  a = a_p for η      only at a_p = A
//! down:  a from a_p to 0,   jerk 0 → −δ → −j        δ = min(√P, J)       ε = P/δ       lasting δ + ε − j
//! ```
//! Reversed in time, the way down is the rest of a way up to P = a_p + j²/2 after its first j seconds, in which
//! the jerk has risen to j and the acceleration to j²/2. A way up is a step through averages of lengths α and β: it rises by half
//! of its time, and the second integral also has its variance.
//!
//! ```text
//! v_up = a_p·(α+β)/2                          x_up = a_p·((α+β)²/8 + (α²+β²)/24)
//! v_down = (P − j²)·(δ+ε)/2 + j³/3            ∂v/∂a_p = α/2 + β + δ/2 + ε − j²/(2δ)
//! ```
//! The second half is the first one rotated about the middle, x(T − t) = X − x(t). Three regions, by the binding limit there:
//!
//! | | velocity at the middle | jerk −j there |
//! |---|---|---|
//! | swing | below V | the largest, min(J, √(2·a_p)) |
//! | touch | V for an instant | between |
//! | cruise | V for t_v | 0: the product of moving averages |
//!
//! The more jerk remains in the middle, the shorter is the distance to V: two half moves to V, without jerk and with the
//! largest, distinguish the regions.
//!
//! Everything here is in units in which the distance and the snap limit are one.
use crate::root::{between, increasing};
use core::f64::consts::SQRT_2;

/// v/a_p^(3/2) and x/a_p² of a half move whose jerk is not limited, with the largest jerk in the middle.
const FREE_SWING: (f64, f64) = (1.0 + 2.0 * SQRT_2 / 3.0, 17.0 / 12.0 + SQRT_2);

/// A half move; see the module for its parts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Half {
    peak: f64,
    up: Swell,
    hold: f64,
    down: Swell,
    /// Jerk in the middle, as a magnitude.
    end: f64,
}

/// The acceleration rises from 0 to a peak, without jerk at both ends.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Swell {
    /// Length of the shorter average, and largest jerk.
    jerk: f64,
    /// Length of the longer average.
    rise: f64,
}

impl Swell {
    fn new(peak: f64, most_jerk: f64) -> Self {
        let root = libm::sqrt(peak);
        Self { jerk: root.min(most_jerk), rise: root.max(peak / most_jerk) }
    }

    const fn time(&self) -> f64 {
        self.jerk + self.rise
    }

    /// Its second integral for a peak of one.
    const fn second(&self) -> f64 {
        let Self { jerk, rise } = *self;
        self.time() * self.time() / 8.0 + (jerk * jerk + rise * rise) / 24.0
    }
}

impl Half {
    /// Acceleration up to `peak` and immediately down to zero at the jerk −`end`, within the jerk limit `jerk`; `end` is at
    /// most `jerk` and √(2·`peak`).
    fn new(peak: f64, end: f64, jerk: f64) -> Self {
        Self { peak, up: Swell::new(peak, jerk), hold: 0.0, down: Swell::new(peak + 0.5 * end * end, jerk), end }
    }

    /// The lengths of its seven segments, in which the snap is +1, 0, −1, 0, −1, 0, +1.
    pub(crate) fn lengths(&self) -> [f64; 7] {
        let Self { up, hold, down, end, .. } = *self;
        [
            up.jerk,
            difference(up.rise, up.jerk),
            up.jerk,
            hold,
            down.jerk,
            difference(down.rise, down.jerk),
            difference(down.jerk, end),
        ]
    }

    /// Largest jerk.
    pub(crate) fn jerk(&self) -> f64 {
        self.up.jerk.max(self.down.jerk)
    }

    /// Largest acceleration.
    pub(crate) const fn acceleration(&self) -> f64 {
        self.peak
    }

    /// Velocity in the middle.
    const fn v(&self) -> f64 {
        let Self { peak, up, hold, down, end } = *self;
        let v_down = 0.5 * (peak - 0.5 * end * end) * down.time() + end * end * end / 3.0;
        peak * (0.5 * up.time() + hold) + v_down
    }

    /// Its derivative by the peak.
    const fn v_by_peak(&self) -> f64 {
        let Self { up, hold, down, end, .. } = *self;
        0.5 * (up.jerk + down.jerk - end * end / down.jerk) + up.rise + hold + down.rise
    }

    /// Position in the middle.
    const fn x(&self) -> f64 {
        let Self { peak, up, hold, down, end } = *self;
        let off = down.time() - end;
        // Back from the middle the velocity falls by the integral of the rest of the way up.
        let begun = end * end * (end * end / 24.0 + off * (end / 6.0 + off / 4.0));
        let fallen = (peak + 0.5 * end * end) * down.second() - begun;
        peak * (up.second() + 0.5 * hold * (up.time() + hold)) + self.v() * off - fallen
    }
}

/// `long` − `short`, or zero if that is the rounding of the root from which they follow.
fn difference(long: f64, short: f64) -> f64 {
    if long <= short * (1.0 + 1e-13) { 0.0 } else { long - short }
}

/// Limits of velocity, acceleration and jerk in units of the distance and the snap limit; each may be infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Scaled {
    pub(crate) velocity: f64,
    pub(crate) acceleration: f64,
    pub(crate) jerk: f64,
}

/// The first half of the shortest move over a unit distance at unit snap; `None` when it cruises.
pub(crate) fn half(limits: &Scaled) -> Option<Half> {
    // The way up alone covers a_p²/2 at least, so a_p < 1. From v down to zero at −a_p covers v²/(2·a_p), so v < 1.
    let limits = Scaled { velocity: limits.velocity.min(1.0), acceleration: limits.acceleration.min(1.0), ..*limits };
    let cubed = limits.velocity / FREE_SWING.0;
    let steepest = limits.jerk.min(SQRT_2 * libm::cbrt(cubed)).min(libm::sqrt(2.0 * limits.acceleration));
    // The distance is stationary at the steepest: almost a linear function of the square of the missing jerk.
    let reaching = |square: f64| reaching(steepest * (1.0 - libm::sqrt(square)), &limits);
    let beyond = |square: f64| off_middle(reaching(square).x());
    let longest = beyond(1.0);
    if longest <= 0.0 {
        return None;
    }
    let shortest = beyond(0.0);
    if shortest >= 0.0 {
        return Some(swing(&limits));
    }
    Some(reaching(between((0.0, shortest), (1.0, longest), beyond)))
}

/// Offset of a position from the middle of the distance, or zero if that is rounding.
fn off_middle(x: f64) -> f64 {
    let off = x - 0.5;
    if off.abs() < 4.0 * f64::EPSILON { 0.0 } else { off }
}

/// The half move to the velocity limit in the middle, with the jerk −`end` there.
fn reaching(end: f64, limits: &Scaled) -> Half {
    /// Last step, relative to the peak: its square, the remainder, is rounding.
    const LAST: f64 = 1e-8;
    let Scaled { velocity, acceleration, jerk } = *limits;
    // From above: v is at least that of the free swing, and at least a_p²/J.
    let free = libm::cbrt(velocity / FREE_SWING.0);
    let mut peak = acceleration.min(free * free).min(libm::sqrt(velocity * jerk));
    let mut step = f64::INFINITY;
    while step > LAST * peak {
        let half = Half::new(peak, end, jerk);
        let short = velocity - half.v();
        if short >= 0.0 {
            let hold = if peak < acceleration { 0.0 } else { short / peak };
            return Half { hold, ..half };
        }
        // The velocity grows ever faster with the peak: Newton's method descends to the root and does not pass it.
        step = -short / half.v_by_peak();
        peak -= step;
    }
    Half::new(peak, end, jerk)
}

/// The half move without a limit of velocity.
fn swing(limits: &Scaled) -> Half {
    let Scaled { acceleration: highest, jerk, .. } = *limits;
    let steepest = |peak: f64| Half::new(peak, libm::sqrt(2.0 * peak).min(jerk), jerk);
    let free = libm::sqrt(0.5 / FREE_SWING.1);
    if free <= highest.min(0.5 * jerk * jerk) {
        return steepest(free);
    }
    let at_highest = steepest(highest);
    let short = 0.5 - at_highest.x();
    if short <= 0.0 {
        let lowest = highest.min(0.5 * jerk * jerk).min(free);
        return steepest(increasing(lowest, highest, |peak| off_middle(steepest(peak).x())));
    }
    // The hold adds its own a_p·η²/2, and η times the velocity gained on the way up plus a_p times the duration of the way down.
    let v = highest * (0.5 * at_highest.up.time() + at_highest.down.time() - at_highest.end);
    Half { hold: 2.0 * short / (v + libm::sqrt(v * v + 2.0 * highest * short)), ..at_highest }
}
