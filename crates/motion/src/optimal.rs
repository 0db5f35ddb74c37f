//! The shortest snap-limited move: the half of it up to the middle.
//!
//! The product of four boxes ([`crate`]) brings jerk to zero at peak velocity. Where velocity does not cruise that is not
//! the shortest: the acceleration may swing straight from +a to −a, crossing zero with the jerk −j. The half move is
//!
//! ```text
//! up:    a from 0 to a_p,   jerk 0 → j_u → 0          α = min(√(a_p/D), J/D)   β = a_p/(D·α)    lasting α + β
//! hold:  a = a_p for η      only at a_p = A
//! down:  a from a_p to 0,   jerk 0 → −j_d → −j        j_d² = min(J², D·a_p + j²/2)
//! ```
//! and the second half is the first one turned about the middle, x(T − t) = X − x(t). Three regions, by what binds at the
//! middle:
//!
//! | | velocity at the middle | jerk −j there |
//! |---|---|---|
//! | swing | below V | the largest, min(J, √(2·D·a_p)) |
//! | touch | V for an instant | between |
//! | cruise | V for t_v | 0: the product of boxes |
//!
//! Everything here is in units in which the distance and the snap limit are one.
use crate::root::increasing;

/// A half move by its parameters; see the module for their meaning. Unit distance, unit snap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Half {
    peak: f64,
    hold: f64,
    /// Lengths of the jerk's and the acceleration's box going up.
    alpha: f64,
    beta: f64,
    /// Jerk at the end, as a magnitude.
    end: f64,
    /// Jerk on the way down, as a magnitude, and how long it is held.
    down: f64,
    down_hold: f64,
}

/// Where a half move ends.
#[derive(Debug, Clone, Copy, PartialEq)]
struct End {
    x: f64,
    v: f64,
}

impl Half {
    /// Acceleration up to `peak`, held for `hold`, and down to zero at the jerk −`end`, within the jerk limit `jerk`;
    /// `end` is at most `jerk` and √(2·`peak`).
    fn new(peak: f64, hold: f64, end: f64, jerk: f64) -> Self {
        let root = libm::sqrt(peak);
        let (alpha, beta) = (root.min(jerk), root.max(peak / jerk));
        let free = libm::sqrt(peak + 0.5 * end * end);
        let (down, down_hold) =
            if free <= jerk { (free, 0.0) } else { (jerk, (peak - jerk * jerk + 0.5 * end * end) / jerk) };
        Self { peak, hold, alpha, beta, end, down, down_hold }
    }

    fn down_time(&self) -> f64 {
        2.0 * self.down + self.down_hold - self.end
    }

    /// The lengths of its seven segments, in which the snap is +1, 0, −1, 0, −1, 0, +1.
    pub(crate) fn lengths(&self) -> [f64; 7] {
        let Self { alpha, beta, hold, down, down_hold, end, .. } = *self;
        [alpha, difference(beta, alpha), alpha, hold, down, down_hold, difference(down, end)]
    }

    /// Largest jerk.
    pub(crate) fn jerk(&self) -> f64 {
        self.alpha.max(self.down)
    }

    /// Largest acceleration.
    pub(crate) const fn acceleration(&self) -> f64 {
        self.peak
    }

    /// Velocity at its end.
    pub(crate) fn velocity(&self) -> f64 {
        self.ends().v
    }

    fn ends(&self) -> End {
        let Self { peak, hold, alpha, beta, down, down_hold, .. } = *self;
        let (up, off) = (alpha + beta, self.down_time());
        // A step through two boxes rises by half the time; the second integral has its variance besides.
        let v_up = 0.5 * peak * up;
        let x_up = peak * (up * up / 8.0 + (alpha * alpha + beta * beta) / 24.0);
        // Snap −1 from the start of the way down, 0 after `down`, +1 after `down_hold` more.
        // Differences of powers by their factors: `down` may be a tiny part of `off`.
        let (rest, last) = (down + down_hold - self.end, down - self.end);
        let cubes = down * (off * off + off * rest + rest * rest) - last * last * last;
        let fourths = down * (off + rest) * (off * off + rest * rest) - last * last * last * last;
        let v = v_up + peak * (hold + off) - cubes / 6.0;
        let x = x_up + v_up * (hold + off) + peak * (0.5 * (hold + off) * (hold + off)) - fourths / 24.0;
        End { x, v }
    }
}

/// `long` − `short`, or zero where that is the rounding of the root that they follow from.
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
    let swinging = swing(limits);
    if swinging.velocity() <= limits.velocity { Some(swinging) } else { touch(limits) }
}

/// As if there were no limit of velocity.
fn swing(limits: &Scaled) -> Half {
    let Scaled { acceleration, jerk, .. } = *limits;
    let steepest = |peak: f64| Half::new(peak, 0.0, libm::sqrt(2.0 * peak).min(jerk), jerk);
    // x = a_p²·(17/12 + √2) as long as no jerk is held.
    let free = libm::sqrt(0.5 / (17.0 / 12.0 + core::f64::consts::SQRT_2));
    if free <= acceleration.min(0.5 * jerk * jerk) {
        return steepest(free);
    }
    // Going up alone, in 2·√a_p at least, covers a_p²/2: the peak is at most one.
    let highest = acceleration.min(1.0);
    let at_highest = steepest(highest);
    let short = 0.5 - at_highest.ends().x;
    if short <= 0.0 {
        let lowest = highest.min(0.5 * jerk * jerk).min(free);
        return steepest(increasing(lowest, highest, |peak| steepest(peak).ends().x - 0.5));
    }
    // The hold adds its own a_p·η²/2, and η times what is constant in time around it: v going up, a_p on the way down.
    let v = highest * (0.5 * (at_highest.alpha + at_highest.beta) + at_highest.down_time());
    Half { hold: 2.0 * short / (v + libm::sqrt(v * v + 2.0 * highest * short)), ..at_highest }
}

/// The velocity limit is reached for an instant in the middle; `None` when it is reached before.
fn touch(limits: &Scaled) -> Option<Half> {
    let Scaled { velocity, acceleration, jerk } = *limits;
    let reaching = |end: f64| {
        // Going up alone gains a_p^(3/2) at least.
        let highest = acceleration.min(libm::cbrt(velocity * velocity));
        let lowest = (0.5 * end * end).min(highest);
        let top = Half::new(highest, 0.0, end, jerk);
        let short = velocity - top.ends().v;
        if short >= 0.0 {
            return Half { hold: short / highest, ..top };
        }
        Half::new(
            increasing(lowest, highest, |peak| Half::new(peak, 0.0, end, jerk).ends().v - velocity),
            0.0,
            end,
            jerk,
        )
    };
    if reaching(0.0).ends().x <= 0.5 {
        return None;
    }
    // With j = √(2·a_p) the velocity is a_p^(3/2)·(1 + 2√2/3), as long as no jerk is held.
    let cubed = velocity / (1.0 + 2.0 * core::f64::consts::SQRT_2 / 3.0);
    let most = jerk.min(core::f64::consts::SQRT_2 * libm::cbrt(cubed)).min(libm::sqrt(2.0 * acceleration));
    Some(reaching(increasing(0.0, most, |end| 0.5 - reaching(end).ends().x)))
}
