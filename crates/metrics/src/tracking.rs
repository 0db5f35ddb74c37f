//! Following error: reference minus actual, on the motor and on the load; velocity error.
use crate::absence::Absence;
use crate::metric::MetricSet;
use crate::name::Name;
use crate::span::{Checked, Phase, channel, largest, largest_magnitude, root_mean, unit};
use servobench_signals::Signal;
use servobench_trace::Move;
use std::ops::Range;

/// One side of the axis.
struct Side {
    channel: Signal,
    peak: Name,
    rms: Name,
    cruise: Name,
}

const SIDES: [Side; 2] = [
    Side {
        channel: Signal::FollowingErrorMotor,
        peak: Name::FollowingErrorPeakMotor,
        rms: Name::FollowingErrorRmsMotor,
        cruise: Name::FollowingErrorCruiseMotor,
    },
    Side {
        channel: Signal::FollowingErrorLoad,
        peak: Name::FollowingErrorPeakLoad,
        rms: Name::FollowingErrorRmsLoad,
        cruise: Name::FollowingErrorCruiseLoad,
    },
];

/// Notes the errors: peaks over `rows`; RMS and cruise value during the profiles of `phases`, the RMS over `rows` when
/// there are no moves.
pub(crate) fn note(set: &mut MetricSet, recording: &Checked<'_>, rows: Range<usize>, phases: &[Phase<'_>]) {
    for side in &SIDES {
        let (error, unit) = (channel(recording, side.channel), unit(recording, side.channel));
        let peak = |e: &[f64]| largest_magnitude(&e[rows.clone()], "");
        let rms = |e: &[f64]| match phases {
            [] => root_mean(e[rows.clone()].iter().map(|e| e * e), ""),
            _ => {
                root_mean(phases.iter().flat_map(|phase| &e[phase.profile.clone()]).map(|e| e * e), "during a profile")
            }
        };
        let cruise = |e: &[f64]| largest_cruise(recording, e, phases);
        set.note(side.peak, unit, error.clone().and_then(peak));
        set.note(side.rms, unit, error.clone().and_then(rms));
        set.note(side.cruise, unit, error.and_then(cruise));
    }
    let velocity = velocity_error_peak(recording, rows);
    set.note(Name::VelocityErrorPeak, unit(recording, MOTOR_VELOCITY), velocity);
}

/// The cruise value with the largest magnitude among the moves.
fn largest_cruise(recording: &Checked<'_>, error: &[f64], phases: &[Phase<'_>]) -> Result<f64, Absence> {
    if phases.is_empty() {
        return Err(Absence::NoMove);
    }
    let values = phases.iter().filter(|phase| phase.made.cruise.1 > 0.0);
    values
        .map(|phase| cruise(recording, error, phase.made))
        .reduce(|one, two| match (one, two) {
            (Ok(one), Ok(two)) => Ok(if two.abs() > one.abs() { two } else { one }),
            (one, two) => one.or(two),
        })
        .unwrap_or(Err(Absence::NoCruise))
}

/// Mean error over the second half of the part at constant velocity. The first half is left to the transient at
/// its start; the mean removes vibrations.
fn cruise(recording: &Checked<'_>, error: &[f64], made: &Move) -> Result<f64, Absence> {
    let (start, length) = made.cruise;
    let rows = recording.index_at(start + length / 2.0)..recording.index_at(start + length);
    let values = error.get(rows).unwrap_or_default();
    if values.is_empty() {
        return Err(Absence::NothingRecorded { part: "at constant velocity" });
    }
    Ok(values.iter().sum::<f64>() / values.len() as f64)
}

const MOTOR_VELOCITY: Signal = Signal::MotorVelocity;
const VELOCITY_REFERENCE: Signal = Signal::VelocityReference;

fn velocity_error_peak(recording: &Checked<'_>, rows: Range<usize>) -> Result<f64, Absence> {
    let reference = channel(recording, VELOCITY_REFERENCE)?;
    let actual = channel(recording, MOTOR_VELOCITY)?;
    if unit(recording, VELOCITY_REFERENCE) != unit(recording, MOTOR_VELOCITY) {
        return Err(Absence::UnitsDiffer { one: VELOCITY_REFERENCE, two: MOTOR_VELOCITY });
    }
    // Between two cycles of the position loop its output is held: there it is the velocity that the motor should have had, not the
    // one that it should have.
    let written = written(recording, VELOCITY_REFERENCE, rows);
    let error = written.map(|row| (reference[row] - actual[row]).abs());
    largest(error, "at a cycle of the position loop")
}

/// The `rows` at whose instant `signal` was written; at the others it was held.
fn written(recording: &Checked<'_>, signal: Signal, rows: Range<usize>) -> impl Iterator<Item = usize> + use<> {
    let of = recording.find(signal);
    let row_rate = recording.rate.hertz();
    let rate = of.map_or(row_rate, |channel| channel.spec.rate.hertz());
    // Row k is one when k·rate is a multiple of the rate of the rows.
    let every = (row_rate / greatest_common_divisor(row_rate, rate)) as usize;
    (rows.start.next_multiple_of(every)..rows.end).step_by(every)
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::span::phases;
    use crate::synthetic::{Build, planned};
    use servobench_trace::Recording;

    /// e(t) = v/k_p·(1 − exp(−k_p·t)) at constant velocity: the loop of the EMPS axis without friction.
    const K_P: f64 = 160.18;

    fn lag(t: f64, v: f64) -> f64 {
        v / K_P * (1.0 - (-K_P * t).exp())
    }

    fn two_moves() -> Recording {
        let there = planned(0.0, 1.0, 0.0, 0.1).cruising(0.2, 0.6);
        let back = planned(2.0, 3.0, 0.1, 0.0).cruising(2.2, 0.6);
        Build::new(1000, 4000)
            .channel(Signal::FollowingErrorMotor, "m", |t| match t {
                0.2..0.8 => lag(t - 0.2, 0.12),
                2.2..2.8 => -lag(t - 2.2, 0.15),
                _ => 0.0,
            })
            .moves([there.made(), back.made()])
            .finish()
    }

    /// The transient has died to e⁻⁴⁸ in the second half of the cruise: the remainder is v/k_p to rounding.
    #[test]
    fn cruise_is_the_stationary_error_with_its_sign() {
        let recording = two_moves();
        let mut set = MetricSet::default();
        note(&mut set, &Checked::of(&recording), 0..4000, &phases(&recording));
        let cruise = set.value(Name::FollowingErrorCruiseMotor).unwrap();
        assert!((cruise + 0.15 / K_P).abs() < 1e-15, "{cruise}");
        let mut first = MetricSet::default();
        note(&mut first, &Checked::of(&recording), 0..2000, &phases(&recording)[..1]);
        let cruise = first.value(Name::FollowingErrorCruiseMotor).unwrap();
        assert!((cruise - 0.12 / K_P).abs() < 1e-15, "{cruise}");
        let peak = set.value(Name::FollowingErrorPeakMotor).unwrap();
        assert!((peak - 0.15 / K_P).abs() < 1e-15, "{peak}");
    }

    /// RMS of a sine of amplitude 1 over whole periods is 1/√2; the standstill outside the profile does not count.
    #[test]
    fn rms_is_taken_during_the_profile() {
        let recording = Build::new(1000, 4000)
            .channel(Signal::FollowingErrorLoad, "m", |t| {
                if (1.0..2.0).contains(&t) { (2.0 * core::f64::consts::PI * 5.0 * t).sin() } else { 0.0 }
            })
            .moves([planned(1.0, 2.0, 0.0, 1.0).made()])
            .finish();
        let mut set = MetricSet::default();
        note(&mut set, &Checked::of(&recording), 0..4000, &phases(&recording));
        let rms = set.value(Name::FollowingErrorRmsLoad).unwrap();
        assert!((rms - 0.5_f64.sqrt()).abs() < 1e-12, "{rms}");
        note(&mut set, &Checked::of(&recording), 0..4000, &[]);
        let rms = set.value(Name::FollowingErrorRmsLoad).unwrap();
        assert!((rms - 0.125_f64.sqrt()).abs() < 1e-12, "over the whole recording: {rms}");
    }

    #[test]
    fn what_is_missing_is_absent_with_a_reason() {
        let recording = Build::new(1000, 100)
            .channel(Signal::FollowingErrorLoad, "m", |t| if t > 0.05 { f64::NAN } else { 0.0 })
            .finish();
        let mut set = MetricSet::default();
        note(&mut set, &Checked::of(&recording), 0..100, &[]);
        let why = |name| set.absence(name).unwrap().to_string();
        assert_eq!(why(Name::FollowingErrorPeakLoad), "`following_error.load` is not finite at 0.051 s");
        assert_eq!(why(Name::FollowingErrorCruiseMotor), "`following_error.motor` is not recorded");
        assert_eq!(why(Name::VelocityErrorPeak), "`velocity.reference` is not recorded");
    }

    #[test]
    fn velocity_error_is_commanded_minus_actual() {
        let recording = Build::new(1000, 1000)
            .channel(Signal::VelocityReference, "m/s", |t| t)
            .channel(Signal::MotorVelocity, "m/s", |t| 0.75 * t)
            .finish();
        let mut set = MetricSet::default();
        note(&mut set, &Checked::of(&recording), 0..1000, &[]);
        let peak = set.value(Name::VelocityErrorPeak).unwrap();
        assert!((peak - 0.25 * 0.999).abs() < 1e-15, "{peak}");
    }

    /// A motor that is 1 mm/s behind on a ramp of 1 m/s², commanded every 8 ms and recorded every millisecond: held for 7 ms,
    /// the command is up to 8 mm/s off.
    #[test]
    fn a_held_velocity_command_is_no_error() {
        let mut recording = Build::new(1000, 1000)
            .channel(Signal::VelocityReference, "m/s", |t| (t * 125.0 + 1e-9).floor() / 125.0)
            .channel(Signal::MotorVelocity, "m/s", |t| t - 1e-3)
            .finish();
        recording.channels[0].spec.rate = servobench_base::Rate::new(125).unwrap();
        let mut set = MetricSet::default();
        note(&mut set, &Checked::of(&recording), 0..1000, &[]);
        let peak = set.value(Name::VelocityErrorPeak).unwrap();
        assert!((peak - 1e-3).abs() < 1e-12, "{peak}");
    }
}
