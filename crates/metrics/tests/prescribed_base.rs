//! A whole recording with a closed form: an undamped mode behind a base that follows the profile exactly.
//!
//! The load is computed segment by segment from the exact solution of `z̈ + ω²z = −ẍ`, z = load − base, with a
//! piecewise polynomial ẍ; the measures are checked against the product of sines, which does not contain time.
use core::f64::consts::PI;
use servobench_base::{Rate, Setpoint};
use servobench_metrics::{Limit, Name, Question, measure, undamped_residual};
use servobench_trace::{About, Channel, ChannelSpec, Ending, Move, Recording};

const RATE: u32 = 16_000;

/// A profile of order 3 or 4 as the convolution of moving averages, shortest last; every bound is reached.
struct Profile {
    distance: f64,
    boxes: Vec<f64>,
}

/// Base and load at the start of a segment.
#[derive(Clone, Copy)]
struct Knot {
    time: f64,
    base: Setpoint,
    z: f64,
    z_dot: f64,
}

impl Profile {
    fn end(&self) -> f64 {
        self.boxes.iter().sum()
    }

    /// Peak of each derivative: the distance divided by the lengths of the moving averages one after the other.
    fn peaks(&self) -> Vec<f64> {
        let mut peak = self.distance.abs();
        self.boxes
            .iter()
            .map(|length| {
                peak /= length;
                peak
            })
            .collect()
    }

    /// The highest derivative as steps (time, change).
    fn steps(&self) -> Vec<(f64, f64)> {
        let height = self.distance / self.boxes.iter().product::<f64>();
        let mut steps = vec![(0.0, height)];
        for length in &self.boxes {
            let later: Vec<_> = steps.iter().map(|(t, change)| (t + length, -change)).collect();
            steps.extend(later);
        }
        steps.sort_by(|one, two| one.0.total_cmp(&two.0));
        steps
    }

    fn knots(&self, omega: f64) -> Vec<Knot> {
        let rest = Knot { time: 0.0, base: Setpoint::at_rest(0.0), z: 0.0, z_dot: 0.0 };
        let mut knots = vec![rest];
        for (time, change) in self.steps() {
            let mut knot = after(knots[knots.len() - 1], time, omega);
            if self.boxes.len() == 4 {
                knot.base.s += change;
            } else {
                knot.base.j += change;
            }
            knots.push(knot);
        }
        let last = knots.len() - 1;
        let landed = knots[last].base.x;
        assert!((landed - self.distance).abs() < 1e-12, "the test's own profile lands at {landed}");
        knots[last].base = Setpoint::at_rest(self.distance);
        knots
    }
}

/// Exact solution from `knot` to `time`: `z_p = −(ẍ − s/ω²)/ω²` plus the free oscillation.
fn after(knot: Knot, time: f64, omega: f64) -> Knot {
    let t = time - knot.time;
    let base = knot.base.after(t);
    let particular = |at: &Setpoint| -(at.a - at.s / (omega * omega)) / (omega * omega);
    let (c, s) = ((omega * t).cos(), (omega * t).sin());
    let z0 = knot.z - particular(&knot.base);
    let v0 = knot.z_dot + knot.base.j / (omega * omega);
    let z = particular(&base) + z0 * c + v0 / omega * s;
    let z_dot = -base.j / (omega * omega) - z0 * omega * s + v0 * c;
    Knot { time, base, z, z_dot }
}

fn recording(profile: &Profile, omega: f64) -> Recording {
    let rate = Rate::new(RATE).unwrap();
    let knots = profile.knots(omega);
    let at = |t: f64| {
        let segment = knots.partition_point(|knot| knot.time <= t);
        after(knots[segment.max(1) - 1], t, omega)
    };
    let rows = 2 * RATE;
    let states: Vec<Knot> = (0..rows).map(|k| at(f64::from(k) * rate.period())).collect();
    let channel = |name: &str, value: &dyn Fn(&Knot) -> f64| Channel {
        spec: ChannelSpec { axis: None, name: name.into(), unit: "m".into(), writer: "closed form".into(), rate },
        values: states.iter().map(value).collect(),
    };
    let peaks = profile.peaks();
    let peak = |k: usize| peaks.get(k).copied().unwrap_or(f64::INFINITY);
    Recording {
        about: About {
            scenario: "prescribed base".into(),
            engine: "closed form".into(),
            axis_unit: "m".into(),
            bodies: vec!["motor".into(), "load".into()],
            overrides: vec![],
        },
        rate,
        channels: vec![
            channel("load.position", &|knot| knot.base.x + knot.z),
            channel("following_error.load", &|knot| -knot.z),
        ],
        moves: vec![Move {
            label: "move to 1 m".into(),
            start: 0.0,
            end: profile.end(),
            from: 0.0,
            to: profile.distance,
            peaks: [peak(0), peak(1), peak(2), peak(3)],
            limits: [Some(1.0), Some(5.0), Some(50.0), (peaks.len() == 4).then_some(1000.0)],
            cruise: (0.3, 0.7),
            ending: Ending::AtRest,
        }],
        events: vec![],
        signals: vec![],
        calls: vec![],
        limit_reversals: vec![],
        log: vec![],
        coupling: None,
    }
}

fn jerk_limited() -> Profile {
    Profile { distance: 1.0, boxes: vec![1.0, 0.2, 0.1] }
}

fn snap_limited() -> Profile {
    Profile { distance: 1.0, boxes: vec![1.0, 0.2, 0.1, 0.05] }
}

/// √(6e5/10) rad/s is the mode of the Lambrechts axis, beside a zero of the sines; the others ring with 14 to 300 µm
/// jerk-limited.
#[test]
fn amplitude_is_the_product_of_sines() {
    for omega in [6e4_f64.sqrt(), 2.0 * PI * 4.3, 2.0 * PI * 7.4, 2.0 * PI * 12.6] {
        for profile in [jerk_limited(), snap_limited()] {
            let exact = undamped_residual(profile.distance, omega, &profile.boxes);
            let metrics = measure(&recording(&profile, omega), &Question::default());
            let value = |name| metrics.run.value(name).unwrap();
            let amplitude = value(Name::ResidualVibrationAmplitude);
            // Rounding of positions at 1 m, 1e-16, against 6 nm averages out to below 1e-9; the test's own chain of
            // knots adds the rounding of its polynomials, 1e-14 m.
            assert!((amplitude / exact - 1.0).abs() < 1e-5, "{omega}: {amplitude} {exact}");
            let frequency = value(Name::ResidualVibrationFrequency);
            assert!((2.0 * PI * frequency / omega - 1.0).abs() < 1e-6, "{omega}: {frequency}");
            assert!(value(Name::ResidualVibrationDamping).abs() < 1e-5);
            // The crest of a cosine is met to (ω·h/2)²/2 = 3e-5 at most.
            assert!((value(Name::ResidualVibrationPp) / (2.0 * exact) - 1.0).abs() < 1e-4);
            // Not a whole number of periods: at n periods the RMS about the mean is off by 1/(4πn), n ≥ 2.6.
            let rms = value(Name::ResidualVibrationRms) * 2_f64.sqrt() / exact;
            let periods = (2.0 - profile.end()) * omega / (2.0 * PI);
            assert!((rms - 1.0).abs() < 1.0 / (4.0 * PI * periods) + 0.6 / (PI * periods).powi(2), "{rms} {periods}");
        }
    }
}

#[test]
fn the_published_move_is_within_its_limits() {
    let mut metrics =
        measure(&recording(&snap_limited(), 6e4_f64.sqrt()), &Question { window: Some(1e-6), ..Question::default() });
    for name in ["setpoint_velocity_ratio", "setpoint_acceleration_ratio", "setpoint_jerk_ratio", "setpoint_snap_ratio"]
    {
        let ratio = metrics.run.value(name.parse().unwrap()).unwrap();
        assert!((ratio - 1.0).abs() < 1e-12, "{name} {ratio}");
    }
    assert!((metrics.run.value(Name::MoveTime).unwrap() - 1.35).abs() < 1e-12);
    let verdict = metrics.judge(&[
        Limit::at_most(Name::ResidualVibrationAmplitude, 7e-9),
        Limit::at_most(Name::ResidualVibrationPp, 12e-9),
        Limit::at_most(Name::MoveAndSettlingTime, 1.4),
        Limit::at_most(Name::FollowingErrorPeakMotor, 1.0),
    ]);
    let missed: Vec<_> = verdict.misses.iter().map(ToString::to_string).collect();
    assert_eq!(
        missed,
        [
            "residual_vibration_pp 12.5 nm, limit 12.0 nm",
            "following_error_peak_motor could not be measured: `following_error.motor` is not recorded",
        ]
    );
    assert_eq!(metrics.moves.len(), 1);
    assert_eq!(metrics.moves[0].metrics.value(Name::MoveTime), metrics.run.value(Name::MoveTime));
}

/// The same from `measure.from` without a move: time 0 of the amplitude is that instant.
#[test]
fn ring_down_without_a_move() {
    let mut ringing = recording(&jerk_limited(), 6e4_f64.sqrt());
    let with_move = measure(&ringing, &Question::default());
    ringing.moves.clear();
    let question = Question { from: Some(1.3), ..Question::default() };
    let metrics = measure(&ringing, &question);
    for name in [Name::ResidualVibrationAmplitude, Name::ResidualVibrationFrequency, Name::ResidualVibrationPp] {
        let ratio = metrics.run.value(name).unwrap() / with_move.run.value(name).unwrap();
        assert!((ratio - 1.0).abs() < 1e-7, "{name} {ratio}");
    }
    let why = metrics.run.absence(Name::SettlingTime).unwrap().to_string();
    assert_eq!(why, "the program has no move");
    let metrics = measure(&ringing, &Question::default());
    assert!(metrics.run.get(Name::ResidualVibrationPp).is_none());
}

/// A load that stands still does not vibrate, bit for bit.
#[test]
fn a_load_at_rest_has_no_vibration() {
    let mut still = recording(&jerk_limited(), 100.0);
    still.channels[0].values.to_mut().fill(0.1 + 0.2);
    let metrics = measure(&still, &Question::default());
    assert_eq!(metrics.run.value(Name::ResidualVibrationPp), Some(0.0));
    assert_eq!(metrics.run.value(Name::ResidualVibrationRms), Some(0.0));
    assert_eq!(metrics.run.value(Name::ResidualVibrationAmplitude), Some(0.0));
    for name in [Name::ResidualVibrationFrequency, Name::ResidualVibrationDamping] {
        assert_eq!(metrics.run.absence(name).unwrap().to_string(), "the load does not oscillate");
    }
}

#[test]
fn an_empty_recording_has_reasons_only() {
    let mut empty = recording(&jerk_limited(), 100.0);
    empty.channels.clear();
    empty.moves.clear();
    let metrics =
        measure(&empty, &Question { window: Some(1e-6), from: Some(0.5), mode: Some(10.0), ..Question::default() });
    assert_eq!(metrics.run.iter().count(), 0);
    assert_eq!(metrics.run.absences().count(), Name::ALL.len());
}
