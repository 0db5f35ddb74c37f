//! The coupling of a body, by its own keys or by its mode.
use super::*;

const SWAYING: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "linear"
[axis.motor_side]
mass = "20 kg"
[axis.load]
mass = "12 kg"
stiffness = "145.1 N/mm"
damping = "10.6 N s/m"
[motor]
kind = "prescribed"
"#;

fn with(overrides: &[&str]) -> Result<(f64, f64), String> {
    let overrides: Vec<Override> = overrides.iter().map(|one| one.parse().unwrap()).collect();
    match Document::parse("test.toml", SWAYING, None, None).and_then(|document| document.scenario(&overrides)) {
        Ok(loaded) => {
            let link = chain(&loaded.scenario).links()[0];
            Ok((link.stiffness, link.damping))
        }
        Err(error) => Err(error.to_string()),
    }
}

/// Oracle: ω² = k/m and 2ζω = d/m by hand, of the body with the one before it held.
#[test]
fn a_frequency_and_a_damping_ratio_are_another_way_to_say_it() {
    let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
    let omega = TAU * 17.5;
    let (stiffness, damping) = with(&["axis.load.frequency=17.5 Hz"]).unwrap();
    near(stiffness, 12.0 * omega * omega);
    near(damping, 10.6);
    let (stiffness, damping) = with(&["axis.load.frequency=17.5 Hz", "axis.load.damping_ratio=0.4 %"]).unwrap();
    near(stiffness, 12.0 * omega * omega);
    near(damping, 2.0 * 0.004 * omega * 12.0);
    let (stiffness, damping) = with(&["axis.load.damping_ratio=0.1", "axis.load.mass=3 kg"]).unwrap();
    near(stiffness, 145.1e3);
    near(damping, 0.2 * (145.1e3_f64 * 3.0).sqrt());
    // The command line takes precedence over the scenario, by either key.
    assert_eq!(with(&["axis.load.damping=5 N s/m"]).unwrap(), (145.1e3, 5.0));
}

#[test]
fn what_contradicts_itself_or_overflows_is_refused() {
    let twice = SWAYING.replace("stiffness =", "frequency = \"17 Hz\"\nstiffness =");
    let message = parse("test.toml", &twice, None).unwrap_err().to_string();
    assert!(message.contains("`stiffness` and `frequency` give the same quantity"), "{message}");
    let message = with(&["axis.load.frequency=1e20 Hz"]).unwrap_err();
    assert!(message.contains("the stiffness that follows from it: the number is too large"), "{message}");
    let message = with(&["axis.load.mass=1e-20 kg", "axis.load.frequency=1e-9 Hz"]).unwrap_err();
    assert!(message.contains("the stiffness that follows from it: the number is too small"), "{message}");
    let rigid = SWAYING.replace("stiffness = \"145.1 N/mm\"\ndamping =", "damping_ratio = 0.1 #");
    let message = parse("test.toml", &rigid, None).unwrap_err().to_string();
    assert!(message.contains("`damping_ratio` belongs to a coupling that has no `stiffness`"), "{message}");
}
