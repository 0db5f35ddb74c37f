//! The engines against each other.
use servobench_metrics::Name;
use servobench_plant::{Engine, Exact};
use servobench_scenario::Scenario;
use servobench_tests::{engines, measured, run, scenario, value};

/// A flexible axis with ideal encoder and viscous friction only, moved 250 mm by a synchronous motor on a screw.
fn smooth_axis(base_rate: &str) -> Scenario {
    scenario(&format!(
        r#"
[run]
base_rate = "{base_rate}"
[axis]
motion = "linear"
lead = "10 mm"
[axis.motor_side]
inertia = "2e-4 kg m2"
viscous = "1e-3 Nm s/rad"
[axis.table]
mass = "40 kg"
stiffness = "80 N/um"
damping = "4000 N s/m"
viscous = "200 N s/m"
[axis.load]
mass = "12 kg"
stiffness = "0.3 N/um"
damping = "40 N s/m"
[motor]
model = "teknic-m2310p"
[drive]
dc_link = "75 V"
[drive.current]
rate = "16 kHz"
bandwidth = "1 kHz"
[drive.velocity]
rate = "8 kHz"
bandwidth = "60 Hz"
[drive.position]
rate = "4 kHz"
gain = "60 1/s"
[drive.feedforward]
velocity = true
effort = "rigid"
[setpoint]
order = 3
velocity = "0.2 m/s"
acceleration = "1 m/s2"
jerk = "20 m/s3"
[[program]]
move_to = "250 mm"
[measure]
window = "10 um"
"#
    ))
}

/// Bar: 1 % or 10 nm, whichever is larger, at one inner step per 62.5 µs.
#[test]
fn following_error_and_residual_vibration_agree() {
    let axis = smooth_axis("16 kHz");
    let reference = measured(&axis, &run(&axis, &Exact));
    for engine in engines() {
        let metrics = measured(&axis, &run(&axis, engine));
        for name in [
            Name::FollowingErrorPeakMotor,
            Name::FollowingErrorPeakLoad,
            Name::FollowingErrorRmsMotor,
            Name::FollowingErrorRmsLoad,
            Name::FollowingErrorCruiseMotor,
            Name::FollowingErrorCruiseLoad,
            Name::ResidualVibrationPp,
            Name::ResidualVibrationRms,
            Name::ResidualVibrationAmplitude,
        ] {
            let (expected, found) = (value(&reference, name), value(&metrics, name));
            let bar = (0.01 * expected.abs()).max(10e-9);
            assert!((found - expected).abs() <= bar, "{name} on {}: {found} against {expected}", engine.name());
        }
    }
}

/// Largest distance of the load from that of `exact` over the run, at the same base rate.
fn distance_from_exact(engine: &dyn Engine, base_rate: &str) -> f64 {
    let axis = smooth_axis(base_rate);
    let (exact, other) = (run(&axis, &Exact), run(&axis, engine));
    let [exact, other] = [&exact, &other].map(|recording| recording.channel("load.position").unwrap());
    exact.iter().zip(other).map(|(one, two)| (one - two).abs()).fold(0.0, f64::max)
}

/// The tasks of the drive keep their rates while the tick is halved, so that only the integration of the mechanics
/// differs. Rapier documents second order. MuJoCo runs on RK4, fourth order, and is at rounding here already.
#[test]
fn halving_the_step_quarters_the_error_of_rapier() {
    let rapier: &dyn Engine = &servobench_engine_rapier::Rapier;
    let errors = ["16 kHz", "32 kHz", "64 kHz"].map(|rate| distance_from_exact(rapier, rate));
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((order - 2.0).abs() < 0.2, "observed order {order}, errors {errors:?}");
    }
}

#[cfg(feature = "mujoco")]
#[test]
fn mujoco_follows_exact_with_fourth_order() {
    let mujoco: &dyn Engine = &servobench_engine_mujoco::Mujoco;
    let error = distance_from_exact(mujoco, "16 kHz");
    // (ω·h)⁴/120 of the deflection of the stiffest mode per radian, a few radians of it: far below a nanometre.
    assert!(error < 1e-9, "{error}");
}

/// A gantry that shakes at `frequency` (Hz), damped by `damping_ratio`, measured as `measure` says in addition.
fn gantry(frequency: f64, damping_ratio: f64, measure: &str) -> Scenario {
    scenario(&format!(
        r#"
[run]
base_rate = "8 kHz"
duration = "2 s"
[axis]
motion = "linear"
lead = "20 mm"
motor_side = {{ inertia = "3e-4 kg m2", viscous = "2e-4 Nm s/rad" }}
load = {{ mass = "60 kg", frequency = "{frequency} Hz", damping_ratio = {damping_ratio} }}
[motor]
model = "wittenstein-premo-1f"
[drive]
dc_link = "320 V"
max_torque = "6 Nm"
current = {{ rate = "8 kHz", bandwidth = "800 Hz" }}
velocity = {{ rate = "8 kHz", bandwidth = "40 Hz" }}
position = {{ rate = "4 kHz", bandwidth = "8 Hz" }}
feedforward = {{ velocity = true, effort = "rigid" }}
[setpoint]
order = 3
velocity = "1 m/s"
acceleration = "5 m/s2"
jerk = "100 m/s3"
[[program]]
move_to = "600 mm"
[measure]
window = "50 um"
mode = "{frequency} Hz"
{measure}
"#
    ))
}

/// A mode that the loop damps to ζ = 0.25 has an amplitude as one of ζ = 0.005 has, on every engine, and it does not matter from when on it
/// is measured. Bar: 1 %, and the thousandth of the window below which nobody asks for a vibration.
#[test]
fn the_amplitude_of_a_mode_comes_whatever_its_damping() {
    let amplitude = Name::ResidualVibrationAmplitude;
    let near = |one: f64, two: f64| (one - two).abs() <= 0.01 * one.max(two) + 50e-9;
    for frequency in [10.0, 14.0, 17.0, 22.0, 26.0, 30.0] {
        for damping_ratio in [0.002, 0.03] {
            let on = |engine: &'static dyn Engine, more: &str| {
                let axis = gantry(frequency, damping_ratio, more);
                measured(&axis, &run(&axis, engine)).run.value(amplitude)
            };
            let found: Vec<_> = engines().into_iter().map(|engine| on(engine, "").unwrap()).collect();
            assert!(found.iter().all(|other| near(*other, found[0])), "{frequency} Hz, {damping_ratio}: {found:?}");
            let later = on(&Exact, "from = \"1.05 s\"").unwrap();
            // Where five periods are visible from then on.
            assert!(frequency > 20.0 || near(later, found[0]), "{frequency} Hz, {damping_ratio}: {later} {found:?}");
        }
    }
}
