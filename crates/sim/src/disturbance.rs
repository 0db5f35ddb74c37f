//! External efforts on the axis, in whole ticks.
use crate::error::BuildError;
use servobench_base::{Rate, Tick};
use servobench_scenario::{Disturbance, DisturbedBody, LONGEST_RUN};
use std::f64::consts::TAU;
use std::ops::Range;

/// The disturbances of a run, on the motor and on the load.
#[derive(Debug, Clone)]
pub(crate) struct Disturbances {
    base_rate: Rate,
    on_motor: Vec<Disturbing>,
    on_load: Vec<Disturbing>,
}

/// A single disturbance.
#[derive(Debug, Clone)]
struct Disturbing {
    /// The ticks from each of which it acts until the next one.
    ticks: Range<u64>,
    effort: f64,
    /// Frequency of a sine that is zero at the first of these ticks (Hz).
    frequency: Option<f64>,
}

impl Disturbances {
    /// Places `all` on the ticks of a run of `ticks` ticks. A tick belongs to a disturbance when it is not before its
    /// start and before its end.
    ///
    /// # Errors
    /// [`BuildError::IdleDisturbance`] for one that acts on no tick.
    pub(crate) fn new(all: &[Disturbance], base_rate: Rate, ticks: u64) -> Result<Self, BuildError> {
        let mut placed = Self { base_rate, on_motor: Vec::new(), on_load: Vec::new() };
        // A disturbance to the end of the run lasts on if the axis runs longer than its program: stepped, or beside another axis.
        let tick_at = |time: f64| if time < LONGEST_RUN { base_rate.tick_at(time).0 } else { u64::MAX };
        for (index, one) in all.iter().enumerate() {
            let acting = tick_at(one.start)..tick_at(one.start + one.duration);
            // The last tick is the end of the run: nothing moves after it.
            let last = ticks - 1;
            if acting.is_empty() || acting.start >= last {
                let (start, duration, end_of_run) = (one.start, one.duration, base_rate.time(Tick(last)));
                return Err(BuildError::IdleDisturbance { index, start, duration, end_of_run });
            }
            let on = match one.on {
                DisturbedBody::Motor => &mut placed.on_motor,
                DisturbedBody::Load => &mut placed.on_load,
            };
            on.push(Disturbing { ticks: acting, effort: one.effort, frequency: one.frequency });
        }
        Ok(placed)
    }

    /// Sum of the efforts on the body `on` from tick `k` to the next one, held over it.
    pub(crate) fn effort_at(&self, on: DisturbedBody, k: u64) -> f64 {
        let all = match on {
            DisturbedBody::Motor => &self.on_motor,
            DisturbedBody::Load => &self.on_load,
        };
        let acting = all.iter().filter(|one| one.ticks.contains(&k));
        let effort = |one: &Disturbing| {
            let since = self.base_rate.time(Tick(k - one.ticks.start));
            one.effort * one.frequency.map_or(1.0, |f| libm::sin(TAU * f * since))
        };
        acting.map(effort).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: Disturbance =
        Disturbance { on: DisturbedBody::Load, start: 0.0, duration: f64::INFINITY, effort: 7.0, frequency: None };

    fn hz(hz: u32) -> Rate {
        Rate::new(hz).unwrap()
    }

    /// The ticks of a run of `ticks` ticks in which `one` acts.
    fn acting(one: &Disturbance, base_rate: Rate, ticks: u64) -> Vec<u64> {
        let all = Disturbances::new(std::slice::from_ref(one), base_rate, ticks).unwrap();
        (0..ticks).filter(|k| all.effort_at(one.on, *k) != 0.0).collect()
    }

    /// Oracle: in whole milliseconds at 1 kHz the ticks are those milliseconds.
    #[test]
    fn every_round_start_and_length_is_met_to_the_tick() {
        for start in 0..20_u64 {
            for length in 1..20_u64 {
                let step = Disturbance { start: start as f64 / 10.0, duration: length as f64 / 10.0, ..STEP };
                let expected: Vec<u64> = (100 * start..100 * (start + length)).collect();
                assert_eq!(acting(&step, hz(1_000), 4_000), expected, "{step:?}");
            }
        }
    }

    #[test]
    fn times_between_ticks_wait_for_the_next_one() {
        let step = Disturbance { start: 0.003_2, duration: 0.002, ..STEP };
        assert_eq!(acting(&step, hz(1_000), 10), [4, 5]);
        assert_eq!(acting(&Disturbance { start: 0.008, ..STEP }, hz(1_000), 10), [8, 9], "recorded up to the end");
    }

    #[test]
    fn what_acts_on_no_tick_is_refused() {
        let refusal = |start, duration| {
            let one = Disturbance { start, duration, ..STEP };
            Disturbances::new(&[STEP, one], hz(1_000), 11).unwrap_err().to_string()
        };
        assert_eq!(
            refusal(0.003_2, 0.000_5),
            "disturbance 2 acts on no tick of the run, which ends at 0.01 s: it starts at 0.0032 s and lasts 0.0005 s"
        );
        for (start, duration) in [(0.01, 1.0), (0.011, 1.0), (1e300, f64::INFINITY), (f64::MAX, f64::MAX)] {
            assert!(refusal(start, duration).contains("acts on no tick"), "{start} s");
        }
    }

    /// Oracle: the sine itself, at the times of the ticks; beside a step.
    #[test]
    fn disturbances_add_up_and_a_sine_starts_at_zero() {
        let sine = Disturbance { start: 0.002, duration: 0.02, frequency: Some(50.0), ..STEP };
        let on_motor = Disturbance { on: DisturbedBody::Motor, effort: 1.0, ..STEP };
        let all = Disturbances::new(&[STEP, sine, on_motor], hz(1_000), 100).unwrap();
        for k in 0..100_u32 {
            let sine = if (2..22).contains(&k) { (TAU * f64::from(k - 2) / 20.0).sin() } else { 0.0 };
            let found = all.effort_at(DisturbedBody::Load, k.into());
            // A few roundings of an angle of up to 2π, times 7.
            assert!((found - 7.0 * (1.0 + sine)).abs() < 1e-13, "tick {k}: {found}");
            assert!((all.effort_at(DisturbedBody::Motor, k.into()) - 1.0).abs() < 1e-15);
        }
    }
}
