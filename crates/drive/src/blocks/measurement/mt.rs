//! M/T method: increments of the encoder over the time that they took.
//!
//! ```text
//! ω(k) = (θ_e(k) − θ_e(k−1))/(t_e(k) − t_e(k−1))          an edge in the cycle
//! |ω(k)| = min(|ω(k−1)|, q/(t(k) − t_e(k)))                none
//! ```
//! θ_e is the position and t_e the time of the last edge before cycle k, in periods τ of a timer. The travel between two edges is a whole
//! number of increments and known exactly, so that only the timer errs: by less than a period at both ends together, |Δω|/ω ≤ τ/(t_m − τ)
//! for the measured time t_m, which is longer than T less one increment's time. A difference of positions errs by up to q/T at every speed.
//! Without an edge the motor cannot have travelled a whole increment q since the last one.
//! Source: Ohmae, Matsuda, Kamiyama, Tachikawa, *A microprocessor-controlled high-accuracy wide-range speed regulator for motor drives*,
//! IEEE Transactions on Industrial Electronics 29(3), 1982. The bound without an edge: by hand.
use super::Edge;
use servobench_base::Stateful;
use servobench_config::Kind::{Motor, Plain};
use servobench_config::quantities::{POSITION, TIME};
use servobench_config::{ParameterError, positive};

servobench_config::parameters! {
    /// A parameter of the M/T method.
    pub enum Parameter {
        /// Period of the timer by which edges are timed
        TIMER "period of the timer" = positive(Plain(&TIME), "100 ns");
        /// Increment of the encoder as the drive knows it
        STEP "increment that is counted" = positive(Motor(&POSITION), "0.1 deg");
    }
}

/// Parameters; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Period of the timer τ (s).
    pub timer: f64,
    /// Increment of the encoder q (rad or m).
    pub step: f64,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct State {
    /// Cycles so far.
    cycles: u64,
    /// Position of the last edge, and its time in periods of the timer.
    last: Option<(f64, f64)>,
    velocity: f64,
}

impl Params {
    /// # Errors
    /// [`ParameterError`] names the first parameter out of its bound.
    pub fn check(&self) -> Result<(), ParameterError> {
        Parameter::TIMER.check(self.timer)?;
        Parameter::STEP.check(self.step).map(|_| ())
    }
}

/// Velocity in a cycle, `h` (s) after the last one, of a motor at `position`; zero until there have been two edges.
pub fn step(p: &Params, x: &mut State, position: f64, edge: Option<Edge>, h: f64) -> f64 {
    let now = x.cycles as f64 * h;
    x.cycles += 1;
    let Some(edge) = edge else { return 0.0 };
    let (place, time) = (position + edge.offset, libm::floor((now - edge.age) / p.timer));
    let Some((last_place, last_time)) = x.last else {
        x.last = Some((place, time));
        return 0.0;
    };
    // Only by rounding is a new edge as old as a cycle; an older one in the same place is the edge of the last cycle.
    let is_new = (place - last_place).abs() > p.step / 2.0 || edge.age < h * (1.0 - 1e-9);
    if is_new {
        x.velocity = (place - last_place) / ((time - last_time).max(1.0) * p.timer);
        x.last = Some((place, time));
    } else {
        let since = (libm::floor(now / p.timer) - last_time).max(1.0) * p.timer;
        let most = p.step / since;
        x.velocity = x.velocity.clamp(-most, most);
    }
    x.velocity
}

#[cfg(test)]
mod tests {
    use super::*;

    const T: f64 = 125e-6;
    const Q: f64 = core::f64::consts::TAU / 4096.0;
    const P: Params = Params { timer: 100e-9, step: Q };

    /// Reading of an encoder of increment Q at `t` for the position `x(t)`, with edges at (n + 1/2)·Q: found by bisection of the last
    /// cycle, for an encoder read at every T.
    struct Encoder<F: Fn(f64) -> f64> {
        x: F,
        edge: Option<(f64, f64)>,
        last: f64,
    }

    impl<F: Fn(f64) -> f64> Encoder<F> {
        fn new(x: F) -> Self {
            let last = x(0.0);
            Self { x, edge: None, last }
        }

        /// Reads the encoder; the motion keeps its direction within the cycle.
        fn read(&mut self, t: f64) -> (f64, Option<Edge>) {
            let at = (self.x)(t);
            let (now, before) = ((at / Q).round(), (self.last / Q).round());
            self.last = at;
            if (now - before).abs() > 0.5 {
                let border = if now > before { now - 0.5 } else { now + 0.5 };
                let (mut low, mut high) = (t - T, t);
                for _ in 0..60 {
                    let middle = f64::midpoint(low, high);
                    let is_beyond =
                        if now > before { (self.x)(middle) >= border * Q } else { (self.x)(middle) <= border * Q };
                    *(if is_beyond { &mut high } else { &mut low }) = middle;
                }
                self.edge = Some((high, border * Q));
            }
            let position = now * Q;
            (position, self.edge.map(|(time, place)| Edge { age: t - time, offset: place - position }))
        }
    }

    fn velocities(x: impl Fn(f64) -> f64, cycles: u32) -> Vec<f64> {
        let (mut encoder, mut state) = (Encoder::new(x), State::default());
        let cycle = |k| {
            let (position, edge) = encoder.read(f64::from(k) * T);
            step(&P, &mut state, position, edge, T)
        };
        (0..cycles).map(cycle).collect()
    }

    /// Oracle: |Δω|/ω ≤ τ/(t_m − τ), where t_m spans the whole increments that pass in T, or one: the times of two edges are each rounded
    /// down by less than τ. The bound is not idle: a third of it is reached. Speeds are off any grid, from one edge in three cycles up.
    #[test]
    fn it_errs_by_the_timer_alone() {
        for omega in [5.237_f64, -13.71, 24.913, 101.77, -377.31] {
            let found = velocities(|t| 0.3 * Q + omega * t, 40_000);
            let per_edge = Q / omega.abs();
            let measured = per_edge * (T / per_edge).floor().max(1.0);
            let bound = P.timer / (measured - P.timer);
            // After three edges at the slowest of the speeds.
            let worst = found[20..].iter().map(|v| (v / omega - 1.0).abs()).fold(0.0, f64::max);
            // 4e4 cycles are 5 s: rounding of the time is 1e-9 periods of the timer.
            assert!(worst <= bound * (1.0 + 1e-6) && worst > bound / 3.0, "{omega}: {worst} {bound}");
            // A difference errs by the fraction of an increment that passes in a cycle, or its complement.
            let passed = (T / per_edge).fract();
            let of_differences = passed.max(1.0 - passed) * Q / T / omega.abs();
            assert!(of_differences > 20.0 * worst, "{omega}: {worst} {of_differences}");
        }
    }

    /// Oracle: by hand. After a stop the measured speed falls as one increment over the time since the last edge.
    #[test]
    fn without_an_edge_it_is_bounded_by_one_increment() {
        let omega = 31.7;
        let stop = 0.1003;
        let found = velocities(|t: f64| omega * t.min(stop), 2_000);
        let last_edge = ((omega * stop / Q - 0.5).floor() + 0.5) * Q / omega;
        for (k, v) in found.iter().enumerate().skip(810) {
            let since = k as f64 * T - last_edge;
            assert!((v * since / Q - 1.0).abs() < 2.0 * P.timer / since, "{k}: {v}");
        }
        assert!((found[790] / omega - 1.0).abs() < 2e-3);
    }

    /// An edge that is passed back and forth is not a motion.
    #[test]
    fn to_and_fro_over_one_edge_is_no_velocity() {
        let amplitude = 0.2 * Q;
        let found = velocities(|t: f64| 0.5 * Q + amplitude * (core::f64::consts::PI * (t / T + 0.5)).sin(), 500);
        assert!(found.iter().all(|v| *v == 0.0), "{found:?}");
        assert!(velocities(|_| 0.1, 50).iter().all(|v| *v == 0.0));
    }

    /// Oracle: of a ramp, the mean speed between the edges is that at their middle.
    #[test]
    fn a_ramp_is_measured_between_its_edges() {
        let acceleration = 731.0;
        let found = velocities(|t: f64| acceleration * t * t / 2.0, 4_000);
        for (k, v) in found.iter().enumerate().skip(1_000) {
            let t = k as f64 * T;
            let late = (acceleration * t - v) / acceleration;
            // The middle of two edges lies T/2 before the cycle, or earlier by up to the time between two edges.
            let per_edge = Q / (acceleration * t);
            assert!(
                late > T / 2.0 - P.timer * t / T * 2.0 && late < T / 2.0 + per_edge + P.timer * t / T * 2.0,
                "{k}: {late}"
            );
        }
    }

    #[test]
    fn errors_name_the_parameter() {
        let said = Params { timer: 0.0, ..P }.check().unwrap_err().to_string();
        assert_eq!(said, "`period of the timer` must be finite and positive, got 0");
        assert!(Params { step: f64::NAN, ..P }.check().is_err());
    }
}
