//! The kept part of a recording has no influence on the measurements.
use servobench::{Engines, Run};
use servobench_metrics::Name;
use servobench_plant::EngineName;
use servobench_suite::{Source, Workers, execute, jobs};

/// A load on a spring behind a base that moves 10 mm exactly: √(k/m)/2π = 84.2 Hz with k = 10 kg·(2π·84.2 Hz)².
const RINGS: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "linear"
[axis.motor_side]
mass = "20 kg"
[axis.load]
mass = "10 kg"
stiffness = "2798855 N/m"
[motor]
kind = "prescribed"
[setpoint]
order = 3
velocity = "1 m/s"
acceleration = "5 m/s2"
jerk = "500 m/s3"
[[program]]
move_to = "10 mm"
[measure]
window = "1 mm"
"#;

fn run(text: &str) -> Run {
    let engines = Engines { installed: &[&servobench_plant::Exact], ..Engines::NONE };
    let scenario = servobench_scenario::parse("rings", text, None).unwrap_or_else(|error| panic!("{error}")).scenario;
    let job = jobs(vec![Source { scenario, text: text.into() }], &[EngineName::Exact]).remove(0);
    execute(&job, &engines, &Workers::none(), &mut |_| {}).unwrap()
}

/// Kept at 100 Hz, 84.2 Hz would be seen as 15.8 Hz.
#[test]
fn a_mode_is_measured_at_every_tick() {
    let (whole, thin) = (run(RINGS), run(&format!("{RINGS}[record]\nrate = \"100 Hz\"\n")));
    let frequency = thin.metrics.run.value(Name::ResidualVibrationFrequency).unwrap();
    // The set-point is held over a tick: nothing of that changes the frequency of a free oscillation.
    assert!((frequency / 84.2 - 1.0).abs() < 1e-5, "{frequency} Hz");
    assert_eq!(whole.metrics, thin.metrics);
    assert_eq!((whole.recording.rate.hertz(), thin.recording.rate.hertz()), (16_000, 100));
    assert_eq!(thin.recording.len(), whole.recording.len().div_ceil(160));
    let [whole, thin] = [&whole, &thin].map(|run| run.recording.channel("load.position").unwrap());
    assert!(thin.iter().zip(whole.iter().step_by(160)).all(|(one, two)| one.to_bits() == two.to_bits()));
}
