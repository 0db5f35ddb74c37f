//! Metrics of next to nothing are absent and refused; those of a program are of every rest.
use servobench::check::Objection;
use servobench::preview::preview;
use servobench::{Engines, Run};
use servobench_metrics::{Absence, Metrics, Name};
use servobench_plant::{EngineName, Exact};
use servobench_suite::{Job, Source, Workers, check, execute, jobs};

const ENGINES: Engines = Engines { installed: &[&Exact], ..Engines::NONE };

/// A load of 3 Hz behind a motor that follows its set-point: it rings by 47 mm peak to peak.
const SLOW: &str = r#"
[run]
base_rate = "8 kHz"
duration = "3 s"
[axis]
motion = "linear"
motor_side = { mass = "10 kg" }
load = { mass = "20 kg", frequency = "3 Hz", damping_ratio = 0.002 }
[motor]
kind = "prescribed"
[setpoint]
order = 3
velocity = "0.5 m/s"
acceleration = "4 m/s2"
jerk = "100 m/s3"
[[program]]
move_to = "200 mm"
[limits]
residual_vibration_pp = "5 mm"
"#;

fn job(text: &str) -> Job {
    let scenario = servobench_scenario::parse("test", text, None).unwrap_or_else(|error| panic!("{error}")).scenario;
    jobs(vec![Source { scenario, text: text.to_owned() }], &[EngineName::Exact]).remove(0)
}

fn run(text: &str) -> Run {
    execute(&job(text), &ENGINES, &Workers::none(), &mut |_| {}).unwrap_or_else(|broken| panic!("{}", broken.error))
}

fn objections(text: &str) -> Vec<Objection> {
    check(&job(text), &ENGINES, &Workers::none()).unwrap_or_else(|error| panic!("{error}"))
}

fn value(metrics: &Metrics, name: Name) -> f64 {
    metrics.run.value(name).unwrap_or_else(|| panic!("{name}: {:?}", metrics.run.absence(name)))
}

#[test]
fn a_run_of_two_periods_is_measured() {
    assert_eq!(objections(SLOW), []);
    let pp = value(&run(SLOW).metrics, Name::ResidualVibrationPp);
    assert!((pp - 47e-3).abs() < 1e-3, "{pp}");
}

/// One row after the profile, and 2 ms at the end of a run that shows more than two seconds.
#[test]
fn less_than_two_periods_is_absent_and_refused() {
    let one_row = SLOW.replace("\"3 s\"", "\"0.565 s\"").replace("\"200 mm\"", "\"200 mm\"\nduration = \"0.565 s\"");
    let two_ms = SLOW.replace("[limits]", "[measure]\nfrom = \"2.998 s\"\n[limits]");
    // Two periods are 0.667 s.
    for (text, enough) in
        [(one_row, "give `run.duration` at least 1.232 s"), (two_ms, "give `run.duration` at least 3.665 s")]
    {
        let found = objections(&text);
        let [Objection { key, message, help, .. }] = found.as_slice() else { panic!("{found:?}") };
        assert_eq!((key.as_str(), help.as_str()), ("limits.residual_vibration_pp", enough));
        assert!(message.contains("measured over 0.667 s, two periods of 3.00 Hz"), "{message}");
        let run = run(&text);
        let why = run.metrics.run.absence(Name::ResidualVibrationPp);
        assert!(matches!(why, Some(Absence::RestTooShort { .. })), "{why:?}");
        assert_eq!(run.verdict.misses.len(), 1);
        // What the help says is enough.
        let duration = enough.split_whitespace().nth(4).unwrap();
        let longer = if text.contains("0.565 s\"\n[axis]") {
            text.replacen("0.565 s", &format!("{duration} s"), 1)
        } else {
            text.replacen("3 s", &format!("{duration} s"), 1)
        };
        assert_eq!(objections(&longer), []);
        assert!(self::run(&longer).metrics.run.get(Name::ResidualVibrationPp).is_some());
    }
}

/// The mode that the scenario names counts, not the lowest one; a rigid axis needs 20 ms.
#[test]
fn what_is_asked_for_says_how_long() {
    let fast = SLOW.replace("\"3 s\"", "\"0.7 s\"").replace("[limits]", "[measure]\nmode = \"20 Hz\"\n[limits]");
    assert_eq!(objections(&fast), []);
    let slow = SLOW.replace("\"3 s\"", "\"0.7 s\"");
    assert_eq!(objections(&slow).len(), 1);
    let rigid = slow.replace("load = { mass = \"20 kg\", frequency = \"3 Hz\", damping_ratio = 0.002 }\n", "");
    assert_eq!(objections(&rigid), []);
}

/// Rows at 1 Hz of a run that is too long for every tick: 20 rows in two periods of 3 Hz are 30 Hz.
#[test]
fn rows_that_are_too_far_apart_are_not_measured() {
    let long = SLOW
        .replace("\"3 s\"", "\"8000 s\"")
        .replace("[limits]", "[record]\nrate = \"1 Hz\"\n[limits]\nfollowing_error_peak_load = \"20 mm\"");
    let found = objections(&long);
    let keys: Vec<_> = found.iter().map(|found| found.key.as_str()).collect();
    assert_eq!(keys, ["limits.following_error_peak_load", "limits.residual_vibration_pp"], "{found:?}");
    assert!(found[0].message.contains("rows at 1.00 Hz") && found[0].message.contains("30.0 Hz"), "{found:?}");
    assert_eq!(objections(&long.replace("\"1 Hz\"", "\"50 Hz\"")), []);
}

/// The load rings by millimetres at the first stop and is calm at the last, which it reaches slowly: 5.65 mm peak to peak.
#[test]
fn the_value_of_a_run_is_the_largest_of_its_rests() {
    let text = r#"
        run = { base_rate = "16 kHz" }
        axis = { motion = "linear", motor_side.mass = "10 kg", load = { mass = "10 kg", frequency = "12 Hz", damping_ratio = 0.01 } }
        motor.kind = "prescribed"
        setpoint = { order = 2, velocity = "1 m/s", acceleration = "5 m/s2" }
        [[program]]
        move_to = "210 mm"
        [[program]]
        wait = "1 s"
        [[program]]
        move_to = "0 mm"
        duration = "8 s"
        [measure]
        window = "5 mm"
        [limits]
        residual_vibration_pp = "0.5 mm"
    "#;
    let run = run(text);
    let (pp, amplitude) = (Name::ResidualVibrationPp, Name::ResidualVibrationAmplitude);
    let of = |made: usize, name| run.metrics.moves[made].metrics.value(name).unwrap();
    assert!((of(0, pp) - 5.65e-3).abs() < 0.01e-3 && of(1, pp) < 10e-6, "{} {}", of(0, pp), of(1, pp));
    assert_eq!((value(&run.metrics, pp), value(&run.metrics, amplitude)), (of(0, pp), of(0, amplitude)));
    assert!((value(&run.metrics, Name::ResidualVibrationFrequency) - 12.0).abs() < 0.01);
    assert_eq!(run.verdict.misses.len(), 1);
    // From the second stop on only that one counts.
    let later = text.replace("window = \"5 mm\"", "window = \"5 mm\"\nfrom = \"9.7 s\"");
    assert!(value(&self::run(&later).metrics, pp) < 10e-6);
    // From before the first one on, both.
    let sooner = text.replace("window = \"5 mm\"", "window = \"5 mm\"\nfrom = \"0.7 s\"");
    assert!(value(&self::run(&sooner).metrics, pp) > 4e-3, "it has died away by a fifth");
}

/// A window as large as the distance holds a load that never moved: settling is not judged, and `check` reports why.
#[test]
fn a_window_as_large_as_the_way_judges_nothing() {
    let text = SLOW.replace(
        "[limits]\nresidual_vibration_pp = \"5 mm\"",
        "[measure]\nwindow = \"0.2 m\"\n[limits]\nsettling_time = \"1 ms\"",
    );
    let doubts = preview(&job(&text).scenario, &[EngineName::Exact], None).unwrap().doubts;
    assert!(doubts.iter().any(|doubt| doubt.key == "measure.window"), "{doubts:?}");
    let run = run(&text);
    for name in [Name::SettlingTime, Name::MoveAndSettlingTime, Name::ProgramTime] {
        let why = run.metrics.run.absence(name);
        assert!(matches!(why, Some(Absence::WindowIsTheWay { .. })), "{name} {why:?}");
    }
    assert_eq!(run.verdict.misses.len(), 1);
    let smaller = text.replace("0.2 m\"", "0.19 m\"");
    let doubts = preview(&job(&smaller).scenario, &[EngineName::Exact], None).unwrap().doubts;
    assert!(doubts.iter().all(|doubt| doubt.key != "measure.window"), "{doubts:?}");
    assert!(self::run(&smaller).metrics.run.get(Name::SettlingTime).is_some());
}

/// A rigid axis rests: its vibration is 0, and limits on it are kept.
#[test]
fn a_load_at_rest_keeps_a_limit_of_vibration() {
    let text = r#"
        run = { base_rate = "8 kHz", duration = "1.5 s" }
        axis = { motion = "linear", motor_side = { mass = "15 kg", viscous = "20 N s/m" } }
        motor = { kind = "ideal-source", limit = "400 N" }
        [drive]
        velocity = { rate = "8 kHz", bandwidth = "40 Hz" }
        position = { rate = "4 kHz", bandwidth = "10 Hz" }
        feedforward = { velocity = true, effort = "rigid" }
        [setpoint]
        order = 3
        velocity = "0.8 m/s"
        acceleration = "6 m/s2"
        jerk = "100 m/s3"
        [[program]]
        move_to = "180 mm"
        [measure]
        window = "1 mm"
        [limits]
        residual_vibration_amplitude = "1 um"
    "#;
    for mode in ["", "mode = \"18 Hz\"\n"] {
        let run = run(&text.replace("[limits]", &format!("{mode}[limits]")));
        assert_eq!(run.metrics.run.value(Name::ResidualVibrationAmplitude), Some(0.0));
        assert!(run.verdict.misses.is_empty(), "{:?}", run.verdict.misses);
    }
}
