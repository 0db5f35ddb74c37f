//! Rounding errors count as zero, or one of them would be reported as a third less than another.
use crate::extremes::most_of;
use crate::metric::{MetricSet, Metrics};
use crate::name::Name;
use servobench_trace::Recording;

/// Metrics that are differences of positions.
const DIFFERENCES: [Name; 11] = [
    Name::Overshoot,
    Name::SteadyStateError,
    Name::FollowingErrorPeakMotor,
    Name::FollowingErrorPeakLoad,
    Name::FollowingErrorRmsMotor,
    Name::FollowingErrorRmsLoad,
    Name::FollowingErrorCruiseMotor,
    Name::FollowingErrorCruiseLoad,
    Name::ResidualVibrationPp,
    Name::ResidualVibrationRms,
    Name::ResidualVibrationAmplitude,
];
/// Last places of a position within which the difference of two may be rounding.
const PLACES: f64 = 8.0;
/// Damping ratio below which the fit cannot distinguish a mode from an undamped one.
const UNDAMPED: f64 = 1e-9;

/// Sets metrics to zero that the recorded positions cannot show.
pub(crate) fn clear(metrics: &mut Metrics, recording: &Recording) {
    let positions = recording.channels.iter().filter(|channel| channel.spec.name.ends_with(".position"));
    let largest = positions.fold(0.0, |largest, channel| {
        let of_channel = most_of([&*channel.values], |[x]| x.abs());
        channel.values.release();
        of_channel.max(largest)
    });
    let floor = PLACES * f64::EPSILON * largest;
    let moves = metrics.moves.iter_mut().map(|made| &mut made.metrics);
    for set in moves.chain([&mut metrics.run]) {
        clear_set(set, floor);
    }
}

fn clear_set(set: &mut MetricSet, floor: f64) {
    for name in DIFFERENCES {
        set.clear(name, floor);
    }
    set.clear(Name::ResidualVibrationDamping, UNDAMPED);
}

#[cfg(test)]
mod tests {
    use crate::measure::{Question, measure};
    use crate::name::Name;
    use crate::synthetic::{Build, planned};
    use servobench_signals::Signal;

    /// Beside 1 m, 3e-16 m is one or two roundings; a picometre is not.
    #[test]
    fn rounding_is_zero_and_a_picometre_is_not() {
        for (error, reported) in [(3.3e-16, 0.0), (1e-12, 1e-12)] {
            let recording = Build::new(1000, 2000)
                .channel(Signal::LoadPosition, "m", |t| t.min(1.0))
                .channel(Signal::FollowingErrorLoad, "m", |_| error)
                .moves([planned(0.0, 1.0, 0.0, 1.0).made()])
                .finish();
            let metrics = measure(&recording, &Question::default());
            assert_eq!(metrics.run.value(Name::FollowingErrorPeakLoad), Some(reported));
            assert_eq!(metrics.moves[0].metrics.value(Name::FollowingErrorPeakLoad), Some(reported));
        }
    }
}
