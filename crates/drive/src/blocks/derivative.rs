//! The filtered derivative of a PID.
//!
//! ```text
//! D(s) = T_d·s/(1 + T_f·s)        d(k) = T_f/(T_f + h)·d(k−1) + (u(k) − u(k−1))/(T_f + h)      D = T_d·d
//! ```
//! Backward Euler: stable for every time constant; without a filter it is the difference of two values. First order in h.
//! Source: Åström & Hägglund, *Advanced PID Control*, 2006, §3.4 and §13.4 (T_f = T_d/N with N about 10).
use servobench_base::Stateful;
use servobench_config::Kind::Plain;
use servobench_config::ParameterError;
use servobench_config::quantities::TIME;
use servobench_config::{not_negative, positive};

servobench_config::parameters! {
    /// A parameter of a derivative part.
    pub enum Parameter {
        /// Derivative time of the position loop
        POSITION_TIME "derivative time of the position loop" = positive(Plain(&TIME), "2 ms");
        /// Time constant of the filter on the derivative of the position error
        POSITION_FILTER_TIME "derivative filter of the position loop" = not_negative(Plain(&TIME), "0.5 ms");
        /// Derivative time of the velocity loop: the measured acceleration acts as an additional inertia, gain × time
        VELOCITY_TIME "derivative time of the velocity loop" = positive(Plain(&TIME), "0.5 ms");
        /// Time constant of the filter on the measured acceleration
        VELOCITY_FILTER_TIME "derivative filter of the velocity loop" = not_negative(Plain(&TIME), "0.2 ms");
    }
}

/// Default time constant of the filter, as a share of the derivative time.
pub const FILTER_SHARE: f64 = 0.1;

/// Parameters; constant during a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Params {
    /// Derivative time T_d (s).
    pub time: f64,
    /// Time constant of the filter T_f (s).
    pub filter_time: f64,
}

/// State from tick to tick.
#[derive(Debug, Clone, Copy, PartialEq, Default, Stateful)]
pub struct State {
    /// Value of the last cycle; `None` before the first one.
    pub last: Option<f64>,
    /// Filtered rate of change d (per second).
    pub rate: f64,
}

/// T_d·d in a cycle with the value `u`, `h` (s) after the last one.
pub fn step(p: &Params, x: &mut State, u: f64, h: f64) -> f64 {
    let last = x.last.replace(u).unwrap_or(u);
    x.rate = (p.filter_time * x.rate + (u - last)) / (p.filter_time + h);
    p.time * x.rate
}

impl Params {
    pub(crate) fn check(
        &self,
        [time, filter]: [&'static servobench_config::Parameter; 2],
    ) -> Result<(), ParameterError> {
        time.check(self.time)?;
        filter.check(self.filter_time).map(|_| ())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: for a step of 1, T_d/T_f·exp(−t/T_f), to first order in h; for a ramp, T_d times its slope in the end.
    #[test]
    fn it_converges_with_order_one() {
        let p = Params { time: 3.1e-3, filter_time: 0.7e-3 };
        let error = |n: u32| {
            let (mut x, h) = (State { last: Some(0.0), rate: 0.0 }, 1.3e-3 / f64::from(n));
            // The step comes at time 0, the value at the end of the first cycle.
            let last = (0..n).map(|_| step(&p, &mut x, 1.0, h)).last().unwrap();
            let exact = p.time / p.filter_time * (-1.3e-3 / p.filter_time).exp();
            (last / exact - 1.0).abs()
        };
        let order = (error(1_000) / error(2_000)).log2();
        assert!((order - 1.0).abs() < 0.01, "{order}");
        let mut x = State::default();
        let last = (0..10_000).map(|k| step(&p, &mut x, 2.7 * f64::from(k) * 125e-6, 125e-6)).last().unwrap();
        assert!((last - 2.7 * p.time).abs() < 1e-12, "{last}");
    }

    #[test]
    fn without_a_filter_it_is_a_difference_and_begins_at_rest() {
        let (p, mut x) = (Params { time: 2.0, filter_time: 0.0 }, State::default());
        let found = [3.0, 3.5, 3.5].map(|u| step(&p, &mut x, u, 0.25).to_bits());
        assert_eq!(found, [0.0, 4.0, 0.0].map(f64::to_bits));
    }
}
