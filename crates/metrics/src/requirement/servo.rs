//! Response of the linear rigid loop to the request, row by row.
//!
//! ```text
//! v_ref = K·(e + I) + g·v_r        e = x_r − y        dI/dt = e/T_p
//! dv/dt = ω_v·(b·v_ref + i − v) − β·v + α·a_r + γ·v_r
//! di/dt = (v_ref − v)/T_i          dy/dt = v
//! ```
//! ω_v = k_p/M is the bandwidth of the velocity loop, β = B/M the viscous friction, α and γ are the shares of inertia and viscous
//! friction that are fed forward, b weighs the reference. The velocity loop is discretised exactly for inputs that are constant over a
//! row, with φ = exp(−(ω_v + β)·h), so that no bandwidth makes it unstable; the position follows from the mean velocity of the row.
//! Source: Åström & Wittenmark, *Computer-Controlled Systems*, 3rd ed., §2.3.

/// The linear rigid loop of an axis: bandwidths and shares, axis coordinate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Servo {
    /// Position gain K (1/s); 0 where no loop is closed over the position.
    pub gain: f64,
    /// Integral time of the position loop (s); `None` without an integral.
    pub position_integral_time: Option<f64>,
    /// Share of the requested velocity that is fed forward.
    pub velocity_feedforward: f64,
    /// Bandwidth k_p/M of the velocity loop (rad/s).
    pub bandwidth: f64,
    /// Weight of the reference in its proportional part.
    pub reference_weight: f64,
    /// Its integral time (s); `None` without an integral.
    pub integral_time: Option<f64>,
    /// Share of the inertia that is fed forward.
    pub inertia_feedforward: f64,
    /// Viscous friction by inertia, B/M (1/s).
    pub viscous: f64,
    /// Viscous friction that is fed forward, by inertia (1/s).
    pub viscous_feedforward: f64,
    /// True if the load's own encoder closes the position loop, and not the motor's.
    pub is_closed_at_the_load: bool,
}

impl Servo {
    /// The slower of its loops (1/s): the position loop if there is one.
    pub(super) fn slowest_rate(&self) -> f64 {
        if self.gain > 0.0 { self.gain.min(self.bandwidth) } else { self.bandwidth }
    }
}

/// Largest share of the distance to the request that a row covers: a gain beyond it follows at once.
const MOST_PER_ROW: f64 = 0.5;
/// Largest share of itself that an integral gathers within a row.
const MOST_GATHERED: f64 = 0.5;

/// A [`Servo`] discretised, with its state.
#[derive(Debug, Clone)]
pub(super) struct Response {
    servo: Servo,
    h: f64,
    gain: f64,
    /// φ, and the velocity gained from a constant input of one.
    keeps: f64,
    gives: f64,
    /// Shares that the integrals gather in a row.
    gathers: f64,
    position_gathers: f64,
    position: f64,
    velocity: f64,
    integral: f64,
    position_integral: f64,
}

impl Response {
    /// At rest at zero; a row lasts `h` (s).
    pub(super) fn new(servo: Servo, h: f64) -> Self {
        let rate = servo.bandwidth + servo.viscous;
        let keeps = (-rate * h).exp();
        let gives = if rate > 0.0 { (1.0 - keeps) / rate } else { h };
        let share = |time: Option<f64>| time.map_or(0.0, |time| (h / time).min(MOST_GATHERED));
        Self {
            servo,
            h,
            gain: servo.gain.min(MOST_PER_ROW / h),
            keeps,
            gives,
            gathers: share(servo.integral_time),
            position_gathers: share(servo.position_integral_time),
            position: 0.0,
            velocity: 0.0,
            integral: 0.0,
            position_integral: 0.0,
        }
    }

    /// Position of the response.
    pub(super) const fn position(&self) -> f64 {
        self.position
    }

    /// Puts the response at `position` with `velocity`. If it `goes_on`, the integrals keep their values.
    pub(super) fn put(&mut self, position: f64, velocity: f64, goes_on: bool) {
        (self.position, self.velocity) = (position, velocity);
        if !goes_on {
            (self.integral, self.position_integral) = (0.0, 0.0);
        }
    }

    /// True if the load's own encoder closes the position loop.
    pub(super) const fn is_closed_at_the_load(&self) -> bool {
        self.servo.is_closed_at_the_load
    }

    /// Steps to the next row: `x` and `v` are the requested values now, `gained` is the change of the requested velocity until then; the
    /// position loop measures `measured`.
    pub(super) fn step(&mut self, x: f64, v: f64, gained: f64, measured: f64) {
        let Servo {
            bandwidth, reference_weight, velocity_feedforward, inertia_feedforward, viscous_feedforward, ..
        } = self.servo;
        let error = x - measured;
        let reference = self.gain * (error + self.position_integral) + velocity_feedforward * v;
        let before = self.velocity;
        let input = bandwidth * (reference_weight * reference + self.integral) + viscous_feedforward * v;
        self.velocity = self.keeps * before + self.gives * input + inertia_feedforward * gained;
        self.integral += self.gathers * (reference - before);
        self.position_integral += self.position_gathers * error;
        self.position += self.h * (before + self.velocity) / 2.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A PI velocity loop without feedforward.
    const SOFT: Servo = Servo {
        gain: 10.0,
        position_integral_time: None,
        velocity_feedforward: 0.0,
        bandwidth: 200.0,
        reference_weight: 1.0,
        integral_time: None,
        inertia_feedforward: 0.0,
        viscous: 0.0,
        viscous_feedforward: 0.0,
        is_closed_at_the_load: false,
    };

    /// Request and response after `end` (s) of a request that moves at `v(t)`.
    fn after(servo: Servo, h: f64, end: f64, v: impl Fn(f64) -> f64) -> (f64, f64) {
        let mut response = Response::new(servo, h);
        let (mut x, mut t) = (0.0, 0.0);
        while t < end - h / 2.0 {
            response.step(x, v(t), v(t + h) - v(t), response.position());
            x += h * (v(t) + v(t + h)) / 2.0;
            t += h;
        }
        (x, response.position())
    }

    /// Oracle: a P loop follows a ramp v/K late, reduced by the feedforward; an integral leaves no lag; viscous friction in a loop
    /// without integral adds β·v/(ω_v·K).
    #[test]
    fn the_lag_behind_a_ramp_is_that_of_the_textbook() {
        let cases = [
            (SOFT, 0.3 / 10.0),
            (Servo { velocity_feedforward: 0.7, ..SOFT }, 0.3 * 0.3 / 10.0),
            (Servo { viscous: 20.0, ..SOFT }, 0.3 * 1.1 / 10.0),
            (Servo { viscous: 20.0, viscous_feedforward: 20.0, ..SOFT }, 0.3 / 10.0),
            (Servo { viscous: 20.0, integral_time: Some(0.05), ..SOFT }, 0.3 / 10.0),
            (Servo { position_integral_time: Some(0.5), ..SOFT }, 0.0),
            (Servo { velocity_feedforward: 1.0, inertia_feedforward: 1.0, ..SOFT }, 0.0),
        ];
        for (servo, lag) in cases {
            let (x, y) = after(servo, 1e-4, 10.0, |_| 0.3);
            // A row late, half a row of the trapezoid.
            assert!((x - y - lag).abs() < 0.3 * 3e-4, "{servo:?}: {} for {lag}", x - y);
        }
    }

    /// Oracle: the step response of K·ω_v/(s² + ω_v·s + K·ω_v) with ω_v = 4·K: both poles at −2·K.
    #[test]
    fn a_step_is_followed_as_the_poles_say() {
        let servo = Servo { bandwidth: 40.0, ..SOFT };
        let mut response = Response::new(servo, 1e-4);
        (0..2_000).for_each(|_| response.step(1.0, 0.0, 0.0, response.position()));
        let (a, t) = (20.0_f64, 0.2);
        let exact = 1.0 - (1.0 + a * t) * (-a * t).exp();
        assert!((response.position() - exact).abs() < 1e-3, "{} {exact}", response.position());
    }

    #[test]
    fn no_bandwidth_makes_it_unstable() {
        let stiff = Servo { gain: 1e7, bandwidth: 1e9, integral_time: Some(0.05), ..SOFT };
        let mut response = Response::new(stiff, 1e-3);
        (0..500).for_each(|_| response.step(1.0, 0.0, 0.0, response.position()));
        assert!((response.position() - 1.0).abs() < 0.05, "{}", response.position());
    }
}
