//! Shapers, averages, and both as filters of a stream.
use crate::{is_finite, refused};
use servobench_base::Setpoint;
use servobench_config::Choice as _;
use servobench_fuzz::{Number, ValueGenerator, check, fuzz, produce};
use servobench_motion::PlanError;
use servobench_motion::shape::{Impulses, MovingAverage, MovingAverages, Shaper, ShaperKind, ShapingFilter, Vibration};

/// Shapers of all kinds for one mode.
fn shapers(vibration: &Vibration, tolerable: f64) -> impl Iterator<Item = Result<Impulses, PlanError>> {
    ShaperKind::ALL.iter().map(move |(_, kind, _)| Shaper::new(*kind, tolerable).impulses(vibration))
}

fn set_point() -> impl ValueGenerator<Output = Setpoint> {
    [Number::any(); 5].map_gen(|[x, v, a, j, s]| Setpoint { x, v, a, j, s })
}

fn is_usable(s: Setpoint) -> bool {
    [s.x, s.v, s.a, s.j, s.s].iter().all(|value| value.abs() <= 1e150)
}

/// Parts of one that leave no more vibration than there was.
fn holds(shaper: &Impulses, vibration: &Vibration) {
    let mut last = -1.0;
    for impulse in shaper.iter() {
        assert!(impulse.time > last && impulse.time.is_finite(), "{shaper:?}");
        assert!((0.0..1.0 + 1e-15).contains(&impulse.amplitude), "{shaper:?}");
        last = impulse.time;
    }
    // A sum of up to 32 parts of one.
    assert!((shaper.iter().map(|impulse| impulse.amplitude).sum::<f64>() - 1.0).abs() < 4e-15, "{shaper:?}");
    assert!(shaper.duration() >= shaper.delay() * (1.0 - 1e-14) && shaper.delay() >= 0.0, "{shaper:?}");
    assert!(shaper.residual(vibration) <= 1.0 + 1e-12, "{shaper:?}");
}

#[test]
fn impulses() {
    let damping =
        || (Number::any(), produce::<bool>()).map_gen(|(zeta, tame)| if tame { zeta.abs() / 100.0 } else { zeta });
    let requests = ([Number::magnitude(); 2], (damping(), damping()), [Number::magnitude(); 2], Number::any());
    fuzz(check!(), 20_000, requests, |([omega, other_omega], (zeta, other_zeta), [tolerable, sample_time], t)| {
        let [vibration, other] = [(omega, zeta), (other_omega, other_zeta)].map(|(w, z)| Vibration::new(*w, *z));
        let (vibration, other) = match (vibration, other) {
            (Ok(vibration), Ok(other)) => (vibration, other),
            (Err(error), _) | (_, Err(error)) => return refused(error, 0),
        };
        let second = Impulses::zvd(&other);
        for shaper in shapers(&vibration, *tolerable) {
            let shaper = match shaper {
                Ok(shaper) => shaper,
                Err(error) => return refused(error, 0),
            };
            holds(&shaper, &other);
            for made in [shaper.and(&second), shaper.on_grid(*sample_time)] {
                match made {
                    Ok(made) => holds(&made, &other),
                    Err(error) => refused(error, 0),
                }
            }
            let step = |t: f64| if t >= 0.0 { Setpoint::at_rest(*omega) } else { Setpoint::default() };
            assert!(is_finite(shaper.shape(*t, step)), "at {t:e} of {shaper:?}");
            assert_eq!(shaper.shape(shaper.duration().next_up(), step), step(0.0), "{shaper:?}");
        }
    });
}

#[test]
fn streams() {
    let requests = (
        produce::<Vec<[f64; 5]>>().with().len(0..24_usize).values([Number::any(); 5]),
        1..17_usize,
        [Number::magnitude(); 2],
        set_point(),
    );
    fuzz(check!(), 10_000, requests, |(stream, length, [omega, sample_time], rest)| {
        let Ok(vibration) = Vibration::new(*omega, 0.1) else { return };
        let filters = (
            MovingAverage::over(vec![*rest; *length], *rest),
            ShapingFilter::<16>::new(&Impulses::zvd(&vibration), *sample_time, *rest),
        );
        let (mut mean, mut shaped) = match filters {
            (Ok(mean), Ok(shaped)) => (mean, shaped),
            (Err(error), _) | (_, Err(error)) => return refused(error, 0),
        };
        assert!(is_usable(*rest));
        for [x, v, a, j, s] in stream {
            let set_point = Setpoint { x: *x, v: *v, a: *a, j: *j, s: *s };
            let before = (mean.clone(), shaped);
            match (mean.next(set_point), shaped.next(set_point)) {
                (Ok(one), Ok(other)) => {
                    assert!(
                        is_usable(set_point) && is_finite(one) && is_finite(other),
                        "{set_point:?}: {one:?} {other:?}"
                    );
                }
                (Err(one), Err(other)) => {
                    assert!(
                        !is_usable(set_point) && mean == before.0 && shaped == before.1,
                        "a refusal changes nothing"
                    );
                    assert_eq!(one.to_string(), other.to_string());
                }
                (one, other) => panic!("one filter refuses what the other takes: {one:?} {other:?}"),
            }
        }
        // A rest as long as both of them gives exactly its value.
        for k in 0..16 {
            let out = [mean.next(*rest), shaped.next(*rest)].map(Result::unwrap);
            assert!(k < 15 || out == [*rest; 2], "{out:?} {rest:?}");
        }
    });
}

fn averages<const N: usize>(lengths: [f64; N], t: f64, distance: f64, vibration: Option<&Vibration>) {
    let averages = match MovingAverages::new(lengths) {
        Ok(averages) => averages,
        Err(error) => return refused(error, 0),
    };
    let duration = averages.duration();
    for t in [t, t * duration, 0.0, 0.5 * duration, duration.next_down(), duration, f64::INFINITY, f64::NAN] {
        match averages.of_step(t, distance) {
            Ok(at) => assert!(is_finite(at), "at {t:e}: {at:?} of {averages:?}"),
            Err(error) => refused(error, 0),
        }
    }
    if let Ok(end) = averages.of_step(duration.next_up(), distance) {
        assert_eq!(end, Setpoint::at_rest(distance + 0.0), "{averages:?}");
    }
    if let Some(vibration) = vibration {
        let residual = averages.residual(vibration);
        assert!((0.0..=1.0 + 1e-12).contains(&residual), "{residual} of {averages:?} {vibration:?}");
    }
}

#[test]
fn averages_of_a_step() {
    let requests = ([Number::magnitude(); 4], [Number::any(); 2], [Number::magnitude(); 2]);
    fuzz(check!(), 20_000, requests, |([one, two, three, four], [t, distance], [omega, zeta])| {
        let vibration = Vibration::new(*omega, zeta / 1e3).ok();
        averages([*one], *t, *distance, vibration.as_ref());
        averages([*one, *two], *t, *distance, vibration.as_ref());
        averages([*one, *two, *three], *t, *distance, vibration.as_ref());
        averages([*one, *two, *three, *four], *t, *distance, vibration.as_ref());
    });
}
