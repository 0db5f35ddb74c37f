//! A shaper on a stream of set-points.
use super::Impulses;
use super::difference::{blend, checked};
use crate::PlanError;
use servobench_base::Setpoint;

/// A shaper at a fixed sample time, with a memory of `N` set-points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapingFilter<const N: usize> {
    /// Delay in samples and amplitude, `count` of them.
    taps: [(usize, f64); Impulses::MOST],
    count: usize,
    memory: [Setpoint; N],
    /// Index of the newest set-point.
    newest: usize,
    received: u64,
}

impl<const N: usize> ShapingFilter<N> {
    /// The shaper with its impulses on the grid of samples ([`Impulses::on_grid`]), after a long rest at `rest`.
    ///
    /// # Errors
    /// As [`Impulses::on_grid`]; [`PlanError::FilterTooLong`] when it spans more than `N` samples; [`PlanError::Sample`] for
    /// a rest that [`next`](Self::next) would refuse.
    pub fn new(impulses: &Impulses, sample_time: f64, rest: Setpoint) -> Result<Self, PlanError> {
        let rest = checked(0, rest)?;
        let grid = impulses.on_grid(sample_time)?;
        let mut taps = [(0, 0.0); Impulses::MOST];
        let mut count = 0;
        for (tap, impulse) in taps.iter_mut().zip(grid.iter()) {
            let samples = libm::round(impulse.time / sample_time);
            if samples >= N as f64 {
                let samples = libm::round(grid.duration() / sample_time) + 1.0;
                return Err(PlanError::FilterTooLong { samples, capacity: N });
            }
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number below N")]
            {
                *tap = (samples as usize, impulse.amplitude);
            }
            count += 1;
        }
        Ok(Self { taps, count, memory: [rest; N], newest: 0, received: 0 })
    }

    /// Takes the next set-point and returns the shaped one of the same instant.
    ///
    /// # Errors
    /// [`PlanError::Sample`] with the number of the set-point, from 0, when a value is not finite or above 1e150 in
    /// magnitude. Nothing changes then.
    pub fn next(&mut self, setpoint: Setpoint) -> Result<Setpoint, PlanError> {
        let setpoint = checked(self.received, setpoint)?;
        self.received += 1;
        self.newest = if self.newest + 1 < N { self.newest + 1 } else { 0 };
        self.memory[self.newest] = setpoint;
        let before = |delay: usize| {
            // Both below N, which a `usize` holds twice: a set-point takes 40 bytes.
            let place = self.newest + N - delay;
            self.memory[if place < N { place } else { place - N }]
        };
        // The first tap has no delay.
        let later = self.taps[1..self.count].iter().map(|(delay, amplitude)| (*amplitude, before(*delay)));
        Ok(blend(setpoint, later))
    }
}
