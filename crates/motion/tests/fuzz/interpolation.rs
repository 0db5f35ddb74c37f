//! Between a slow task and a fast one.
use crate::{is_finite, refused};
use servobench_fuzz::{Number, ValueGenerator, check, fuzz, produce};
use servobench_motion::PlanError;
use servobench_motion::interpolate::{Interpolator, Interval, Mode, Sample};

fn samples() -> impl ValueGenerator<Output = Vec<Sample>> {
    let sample = [Number::any(); 4].map_gen(|[x, v, a, torque]| [x, v, a, torque]);
    produce::<Vec<[f64; 4]>>()
        .with()
        .len(0..10_usize)
        .values(sample)
        .map_gen(|samples| samples.into_iter().map(|[x, v, a, torque]| Sample { x, v, a, torque }).collect())
}

#[test]
fn intervals() {
    let requests = (0..7_usize, Number::magnitude(), samples(), Number::magnitude());
    fuzz(check!(), 20_000, requests, |(mode, period, samples, fraction)| {
        let mode = Mode::ALL[*mode];
        let mut axis = match Interpolator::new(mode, *period) {
            Ok(axis) => axis,
            Err(error) => return refused(error, 0),
        };
        let mut taken: Vec<Sample> = vec![];
        for sample in samples {
            let before = axis;
            match axis.push(*sample) {
                Ok(()) => taken.push(*sample),
                Err(error) => {
                    assert_eq!(axis, before, "a refusal changes nothing");
                    refused(error, 0);
                }
            }
            assert_eq!(axis.interval().copied(), Interval::new(mode, *period, &taken).ok());
            for fraction in [*fraction, fraction / 1e3, 0.0, 1.0] {
                match axis.at(fraction) {
                    Ok(command) => {
                        assert!((0.0..=1.0).contains(&fraction) && taken.len() >= mode.points());
                        assert!(is_finite(command.setpoint) && command.torque.is_finite(), "{command:?} of {axis:?}");
                    }
                    Err(PlanError::Waiting { received, needed }) => {
                        assert_eq!((received, needed), (taken.len(), mode.points()));
                    }
                    Err(error) => refused(error, 0),
                }
            }
            let passes_through = !matches!(mode, Mode::CubicBSpline | Mode::QuinticBSpline);
            if let (Ok(start), true, [.., one, _]) = (axis.at(0.0), passes_through, &taken[..]) {
                assert_eq!((start.setpoint.x + 0.0).to_bits(), (one.x + 0.0).to_bits(), "{axis:?}");
            }
        }
    });
}
