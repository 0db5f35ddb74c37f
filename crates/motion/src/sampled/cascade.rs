//! The forward-Euler cascade, (72)–(75) of Pietrusewicz, Waszczuk & Kubicki (2019).
use super::Run;
use crate::limits::in_range;
use crate::{Order, PlanError};
use servobench_base::{Setpoint, Stateful, positive};

/// A chain of integrators, each of which adds the value that the next one had at the sample before.
///
/// ```
/// use servobench_motion::{Limits, Order, Profile, sampled::Cascade};
/// let limits = Limits { velocity: 1.0, acceleration: 5.0, jerk: 50.0, snap: 1000.0 };
/// let plan = Profile::plan_fewest(Order::Fourth, 1.0, &limits, 1e-3)?;
/// let mut cascade = Cascade::at_rest(Order::Fourth, 0.0, 1e-3)?;
/// for set_point in cascade.along(plan.runs()) {
///     assert!(set_point.v <= 1.0 + 1e-12);
/// }
/// assert!((cascade.state().x - 1.0).abs() < 1e-9);
/// cascade.settle(1.0);
/// # Ok::<(), servobench_motion::PlanError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Stateful)]
pub struct Cascade {
    order: Order,
    sample_time: f64,
    /// The highest derivative is that of the last step.
    state: Setpoint,
}

impl Cascade {
    /// At rest at `x` (m or rad), for samples that are `sample_time` (s) apart.
    ///
    /// # Errors
    /// [`PlanError`] when `sample_time` is not positive or outside 1e-30 … 1e30 s.
    pub fn at_rest(order: Order, x: f64, sample_time: f64) -> Result<Self, PlanError> {
        let sample_time = in_range("sample_time", positive("sample_time", sample_time)?, "correct its unit")?;
        Ok(Self { order, sample_time, state: Setpoint::at_rest(x) })
    }

    /// The set-point of this sample, at which `highest` is sent (acceleration, jerk or snap by order, SI); then the chain
    /// advances to the next one.
    #[inline]
    pub fn step(&mut self, highest: f64) -> Setpoint {
        let now = self.sending(highest);
        self.state = after(now, self.sample_time, 1.0);
        now
    }

    /// The set-point `steps` samples later, with the same `highest` sent in all of them: in closed form, so that the rounding
    /// of a long run is that of one step.
    #[inline]
    #[must_use]
    pub fn ahead(&self, highest: f64, steps: u64) -> Setpoint {
        after(self.sending(highest), self.sample_time, steps as f64)
    }

    /// Advances by all samples of `run`.
    pub fn skip(&mut self, run: Run) {
        self.state = self.ahead(run.value, run.count);
    }

    /// The set-point of the next sample, its highest derivative zero.
    #[must_use]
    pub const fn state(&self) -> Setpoint {
        self.sending(0.0)
    }

    /// Comes to rest at `x` (m or rad), where a move has ended: its rounding in velocity, acceleration and
    /// jerk would otherwise last for ever.
    pub const fn settle(&mut self, x: f64) {
        self.state = Setpoint::at_rest(x);
    }

    /// The set-points of the samples of `runs` in the order of time. Within a run they come in closed form from its start:
    /// the rounding of a long move is that of its runs, not of its samples.
    pub const fn along<R: Iterator<Item = Run>>(&mut self, runs: R) -> Along<'_, R> {
        Along { cascade: self, runs, start: Setpoint::at_rest(0.0), done: 0, count: 0 }
    }

    const fn sending(&self, highest: f64) -> Setpoint {
        let mut now = self.state;
        match self.order {
            Order::Second => now.a = highest,
            Order::Third => now.j = highest,
            Order::Fourth => now.s = highest,
        }
        now
    }
}

/// `start` after `steps` samples of `ts` with a constant highest derivative: m steps of an Euler chain add up
/// to binomial coefficients where Taylor's series has powers.
#[inline]
pub(crate) fn after(start: Setpoint, ts: f64, steps: f64) -> Setpoint {
    let Setpoint { x, v, a, j, s } = start;
    // C(m, k + 1) = C(m, k)·(m − k)/(k + 1)
    let (one, two, three, four) =
        (steps * ts, (steps - 1.0) / 2.0 * ts, (steps - 2.0) / 3.0 * ts, (steps - 3.0) / 4.0 * ts);
    Setpoint {
        x: x + one * (v + two * (a + three * (j + four * s))),
        v: v + one * (a + two * (j + three * s)),
        a: a + one * (j + two * s),
        j: j + one * s,
        s,
    }
}

/// The set-points of [`Cascade::along`].
#[derive(Debug)]
pub struct Along<'a, R> {
    cascade: &'a mut Cascade,
    runs: R,
    start: Setpoint,
    done: u64,
    count: u64,
}

impl<R: Iterator<Item = Run>> Iterator for Along<'_, R> {
    type Item = Setpoint;

    fn next(&mut self) -> Option<Setpoint> {
        while self.done == self.count {
            let Run { value, count } = self.runs.next()?;
            (self.start, self.done, self.count) = (self.cascade.sending(value), 0, count);
        }
        let ts = self.cascade.sample_time;
        let now = after(self.start, ts, self.done as f64);
        self.done += 1;
        self.cascade.state = after(self.start, ts, self.done as f64);
        Some(now)
    }
}
