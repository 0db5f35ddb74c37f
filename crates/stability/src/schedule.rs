//! Gains over speed: the loop with the gains at every speed of the drive's schedule, as if they were constant.
//!
//! Speeds are sampled so that no gain changes by more than [`RATIO`] from one to the next. A run of unstable neighbours is
//! a range of speeds. It counts if the set-point stays in it long enough: in less time than a period of the
//! pole no oscillation builds up. Frozen at its fastest, a pole does not describe gains that change as fast as it oscillates.
use crate::analyse::Analysis;
use crate::error::StabilityError;
use crate::model::Loop;
use crate::pole::Pole;
use crate::report::Instability;
use servobench_drive::schedule;
use servobench_linear::Running;
use std::ops::Range;

/// Largest ratio of gains (5 %) from one speed to the next: margins of a loop change by less than 0.5 dB.
const RATIO: f64 = 1.05;
/// Fewest speeds, without standstill.
const FEWEST: usize = 8;
/// Most speeds for each of both gains: gains that change by more than a factor of 500 are sampled in coarser steps.
const MOST: usize = 128;

/// A speed, the gains there, and their fastest growing pole.
struct At {
    speed: f64,
    factors: (f64, f64),
    pole: Option<Pole>,
}

/// The reason why the loop is unstable at a speed at which the set-point stays for longer than a period of the pole. `stays` gives,
/// for a range of speeds (rad/s or m/s, of the motor), the longest time for which the set-point is within it (s). Standstill is
/// covered by [`analyse`](crate::analyse).
///
/// # Errors
/// [`StabilityError`], as of [`analyse`](crate::analyse).
pub fn analyse_schedule<'a>(
    model: &'a Loop,
    running: Box<dyn Running + 'a>,
    stays: impl Fn(Range<f64>) -> f64,
) -> Result<Option<Instability>, StabilityError> {
    model.check()?;
    let Some(schedule) = &model.drive.blocks.schedule else { return Ok(None) };
    let mut analysis = Analysis::new(model, running)?;
    let mut speeds = Vec::new();
    for share in shares(schedule) {
        let speed = schedule.from + share * (schedule.to - schedule.from);
        let factors = schedule.factors(speed);
        speeds.push(At { speed, factors, pole: analysis.unstable_at(factors)? });
    }
    let mut worst: Option<&At> = None;
    for unstable in ranges(&speeds) {
        let growth = |at: &At| at.pole.map_or(f64::NEG_INFINITY, |pole| pole.growth);
        let Some(fastest) = speeds[unstable.clone()].iter().max_by(|a, b| growth(a).total_cmp(&growth(b))) else {
            continue;
        };
        let within = edge(&speeds, unstable.start)..edge(&speeds, unstable.end);
        if stays(within) > fastest.pole.map_or(f64::INFINITY, period)
            && worst.is_none_or(|at| growth(fastest) > growth(at))
        {
            worst = Some(fastest);
        }
    }
    let Some(At { speed, factors, pole: Some(pole) }) = worst else { return Ok(None) };
    analysis.instability_at(*factors, *speed, *pole).map(Some)
}

/// A period of `pole` (s), which grows; without oscillation the time in which it grows by e.
fn period(pole: Pole) -> f64 {
    if pole.frequency > 0.0 { 1.0 / pole.frequency } else { 1.0 / pole.growth }
}

/// Runs of unstable neighbours.
fn ranges(speeds: &[At]) -> Vec<Range<usize>> {
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for (index, _) in speeds.iter().enumerate().filter(|(_, at)| at.pole.is_some()) {
        match ranges.last_mut() {
            Some(last) if last.end == index => last.end += 1,
            _ => ranges.push(index..index + 1),
        }
    }
    ranges
}

/// Midpoint between the speed `index` and the one before; the first speed below it, infinity above the last.
fn edge(speeds: &[At], index: usize) -> f64 {
    match (index.checked_sub(1).map(|before| speeds[before].speed), speeds.get(index)) {
        (Some(before), Some(at)) => f64::midpoint(before, at.speed),
        (None, Some(at)) => at.speed,
        (_, None) => f64::INFINITY,
    }
}

/// Shares of the range of gains, without 0, at which neither gain differs by more than [`RATIO`] from the one before.
fn shares(schedule: &schedule::Params) -> Vec<f64> {
    let mut shares: Vec<f64> = [schedule.position, schedule.velocity].into_iter().flat_map(of_factor).collect();
    shares.sort_by(f64::total_cmp);
    shares.dedup();
    shares
}

/// Shares for a gain that becomes `factor` times as large: 1 + s·(f − 1) = f^u, with u in equal steps.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
fn of_factor(factor: f64) -> Vec<f64> {
    let steps = ((factor.ln().abs() / RATIO.ln()).ceil() as usize).clamp(FEWEST, MOST);
    let share = |i: usize| {
        let u = i as f64 / steps as f64;
        if i == steps {
            1.0
        } else if (factor - 1.0).abs() < RATIO - 1.0 {
            u
        } else {
            (factor.powf(u) - 1.0) / (factor - 1.0)
        }
    };
    (1..=steps).map(share).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_gain_jumps_from_speed_to_speed() {
        for (position, velocity) in [(1.0, 70.0), (0.08, 1.0), (0.3, 12.0), (1.0, 1.0), (1.02, 0.99)] {
            let schedule = schedule::Params { from: 2.0, to: 5.0, position, velocity };
            let shares = shares(&schedule);
            assert!(shares.len() >= FEWEST && (shares[shares.len() - 1] - 1.0).abs() < 1e-15, "{shares:?}");
            let mut last = (1.0, 1.0);
            for share in shares {
                let now = schedule.factors(2.0 + 3.0 * share);
                for (before, after) in [(last.0, now.0), (last.1, now.1)] {
                    assert!((after / before).ln().abs() <= RATIO.ln() * (1.0 + 1e-9), "{schedule:?}: {last:?} {now:?}");
                }
                last = now;
            }
        }
    }
}
