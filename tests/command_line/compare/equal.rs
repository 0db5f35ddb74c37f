//! Equal terms, each against a calculation that is not the bench's.
use super::{compare, compared, duration, fits, metric};
use crate::{SLIDE, code, folder, said};
use std::f64::consts::PI;

/// The boxes of the jerk-limited and of the snap-limited move of Lambrechts, 1 m long.
const BOXES: [f64; 4] = [1.0, 0.2, 0.1, 0.05];
/// √(c/m) of 6e5 N/m and 10 kg (rad/s).
const OMEGA: f64 = 244.948_974_278_317_8;

/// Amplitude (m) of an undamped load behind a base that makes the move in `s` times its time.
fn undamped(boxes: &[f64], s: f64) -> f64 {
    boxes.iter().map(|length| OMEGA * length * s / 2.0).map(|half| (half.sin() / half).abs()).product()
}

/// What stands behind `label` in the list of what was slowed.
fn factor(text: &str, label: &str) -> f64 {
    let line = text.lines().find(|line| line.trim_start().starts_with(label) && line.contains("moves last")).unwrap();
    let words: Vec<&str> = line.split_whitespace().collect();
    words[words.iter().position(|word| *word == "last").unwrap() + 1].parse().unwrap()
}

/// Oracle: with c/m of the load the closed form of an undamped load behind a move of 1.35/1.30 of the time. The fit of the mode is
/// right to 1e-6 as long as it rings with more than a tenth of a micrometre.
#[test]
fn equal_duration_stretches_every_box_alike() {
    let work = tempfile::tempdir().unwrap();
    let files = ["scenarios/vibration-jerk.toml", "scenarios/vibration-snap.toml"];
    let (runs, _) = compared(&work.path().join("out"), &[&files[..], &["--equal", "duration"]].concat());
    for run in &runs {
        assert!((duration(run, 0) - 1.35).abs() < 1e-12 && (metric(run, "move_time") - 1.35).abs() < 1e-12);
    }
    let expected = undamped(&BOXES[..3], 1.35 / 1.3);
    let found = metric(&runs[0], "residual_vibration_amplitude");
    assert!((found / expected - 1.0).abs() < 1e-6, "{found} against {expected}");
    // A run of 3 s goes on as long as before: 1.65 s behind 1.35 s, and 1.70 s behind what was 1.30 s.
    let ends = runs.iter().map(|run| run["duration"].as_f64().unwrap()).collect::<Vec<_>>();
    assert!((ends[0] - 3.05).abs() < 1e-9 && (ends[1] - 3.0).abs() < 1e-9, "{ends:?}");
    // What was slowed is no longer judged by limits that were made for another move.
    assert_eq!((&runs[0]["verdict"], &runs[1]["verdict"]), (&"unjudged".into(), &"passed".into()));
    let (runs, text) = compared(&work.path().join("out"), &[&files[..], &["--equal", "duration=1.4s"]].concat());
    assert!(runs.iter().all(|run| (duration(run, 0) - 1.4).abs() < 1e-12), "{text}");
    assert!(
        text.contains("slowed to a duration of 1.40 s") && (factor(&text, "jerk") - 1.4 / 1.3).abs() < 1e-6,
        "{text}"
    );
}

/// Oracle: a rigid axis without friction needs m·a, and with every time s times as long a is 1/s² of what it was: s = √(F0/F1). The loops
/// add what the sampled set-point leaves them, some 1e-5 of the force.
#[test]
fn equal_torque_is_the_square_root_of_the_forces() {
    let work = folder(&[("slide.toml", SLIDE)]);
    let [slide, out] = ["slide.toml", "out"].map(|name| work.path().join(name));
    let slide = slide.to_str().unwrap();
    let variants = ["--variant", "slow: setpoint.acceleration=2m/s2", "--variant", "fast:"];
    let arguments = [&[slide][..], &variants].concat();
    let (at_limits, _) = compared(&out, &arguments);
    let force = |run| metric(run, "torque_peak");
    let own = [force(&at_limits[0]), force(&at_limits[1])];
    assert!((own[0] / 40.0 - 1.0).abs() < 1e-4 && (own[1] / 100.0 - 1.0).abs() < 1e-4, "20 kg: {own:?}");
    let (runs, text) = compared(&out, &[&arguments[..], &["--equal", "torque"]].concat());
    assert!((force(&runs[0]) - own[0]).abs() == 0.0, "the gentlest is as it was");
    assert!((force(&runs[1]) / own[0] - 1.0).abs() < 1e-6, "{text}");
    let expected = (own[1] / own[0]).sqrt();
    let found = duration(&runs[1], 0) / duration(&at_limits[1], 0);
    assert!((found / expected - 1.0).abs() < 1e-4, "{found} against {expected}");
    assert!((factor(&text, "fast") - found).abs() < 1e-6, "{text}");
    assert!(text.contains("that of slow; found by "), "{text}");
    fits(&text);
    // As asked for: 30 N.
    let (runs, text) = compared(&out, &[&arguments[..], &["--equal", "torque=30N"]].concat());
    assert!(runs.iter().all(|run| (force(run) / 30.0 - 1.0).abs() < 2e-6), "{text}");
    let expected = (own[1] / 30.0).sqrt();
    assert!((factor(&text, "fast") / expected - 1.0).abs() < 1e-4, "{text}");
    // 60 N: the slow one stays as it is, below.
    let (runs, text) = compared(&out, &[&arguments[..], &["--equal", "torque=60N"]].concat());
    assert_eq!(force(&runs[0]).to_bits(), own[0].to_bits());
    assert!(text.contains("slow  at its own limits, 33 % less: 40.001 N"), "{text}");
    // The same again gives the same, to the last byte.
    assert_eq!(compared(&out, &[&arguments[..], &["--equal", "torque=60N"]].concat()).1, text);
}

/// Oracle: without friction the torque, and with it the current, is proportional to the acceleration, whose mean square over a move of
/// duration T·s is 1/s⁴ of what it was; over a recording of the move and 0.5 s behind it I² = K/(s³·(T·s + 0.5)), which is solved by
/// bisection. Current ripple and the torque in which the loops differ from m·a are below 1e-3.
#[test]
fn equal_current_is_that_of_the_mean_square_over_the_recording() {
    let work = folder(&[("axis.toml", PMSM)]);
    let [axis, out] = ["axis.toml", "out"].map(|name| work.path().join(name));
    let variants = ["--variant", "slow: setpoint.acceleration=2m/s2", "--variant", "fast:"];
    let arguments = [&[axis.to_str().unwrap()][..], &variants].concat();
    let (at_limits, _) = compared(&out, &arguments);
    let current = |run| metric(run, "current_rms");
    let (target, own, lasts) = (current(&at_limits[0]), current(&at_limits[1]), duration(&at_limits[1], 0));
    let square = |s: f64| own * own * (lasts + 0.5) / (s.powi(3) * (lasts * s + 0.5));
    let (mut low, mut high) = (1.0, 4.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if square(middle) > target * target { low = middle } else { high = middle }
    }
    let (runs, text) = compared(&out, &[&arguments[..], &["--equal", "current"]].concat());
    assert!((current(&runs[1]) / target - 1.0).abs() < 1e-6, "{text}");
    let found = duration(&runs[1], 0) / lasts;
    assert!((found / low - 1.0).abs() < 1e-3, "{found} against {low}");
    assert!(text.contains("electrical energy") && text.contains("copper loss"), "{text}");
}

/// Oracle: the first s at which the closed form X·∏|sin(ωT_k·s/2)/(ωT_k·s/2)| is not above what the snap-limited move leaves, found in
/// steps of 1e-6 and by bisection. The amplitude is measured to some 1e-6, and at equality it changes by its own size within 1 % of s.
#[test]
fn equal_vibration_is_where_the_closed_form_comes_down_first() {
    let work = tempfile::tempdir().unwrap();
    let files = ["scenarios/vibration-jerk.toml", "scenarios/vibration-snap.toml"];
    for (wanted, target, boxes) in [
        ("vibration", undamped(&BOXES, 1.0), [&BOXES[..3], &[]]),
        ("vibration=1nm", 1e-9, [&BOXES[..3], &BOXES]),
        ("vibration=100nm", 1e-7, [&BOXES[..3], &[]]),
    ] {
        let (runs, text) = compared(&work.path().join("out"), &[&files[..], &["--equal", wanted]].concat());
        for (run, boxes) in runs.iter().zip(boxes).filter(|(_, boxes)| !boxes.is_empty()) {
            let (mut low, mut high) = (1.0, 1.0);
            while undamped(boxes, high) > target {
                (low, high) = (high, high + 1e-6);
            }
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if undamped(boxes, middle) > target { low = middle } else { high = middle }
            }
            let found = duration(run, 0) / boxes.iter().sum::<f64>();
            assert!((found - high).abs() < 1e-7, "{wanted}: {found} against {high}\n{text}");
            let amplitude = metric(run, "residual_vibration_amplitude");
            assert!((amplitude / target - 1.0).abs() < 1e-4, "{wanted}: {amplitude} m");
            // The longest box has a zero every 2π/(ωT): no other lobe was jumped over.
            assert!((found - 1.0) * OMEGA * boxes[0] < 2.0 * PI * 1.1, "{wanted}: {found}");
        }
        fits(&text);
    }
}

#[test]
fn what_cannot_be_made_equal_is_said_with_the_way_out() {
    let table = SLIDE.replace("move_to = \"50 mm\"", "table = { file = \"t.csv\" }");
    let points = "time [s],position [mm],velocity [mm/s]\n0,0,0\n0.1,5,100\n0.2,10,0\n";
    let work = folder(&[("a.toml", SLIDE), ("table.toml", &table), ("t.csv", points)]);
    let [a, table, out] = ["a.toml", "table.toml", "out"].map(|name| work.path().join(name));
    let (a, table) = (a.to_str().unwrap(), table.to_str().unwrap());
    let slow = ["--variant", "slow: setpoint.acceleration=2m/s2", "--variant", "fast:"];
    for (file, equal, part) in [
        (a, "speed", "it is one of limits, duration, torque, current and vibration"),
        (a, "limits=2", "limits takes no value"),
        (a, "torque=5Nm", "a force is needed, this is a torque"),
        (a, "torque=5", "a force needs its unit"),
        (a, "vibration=20N", "a length is needed, this is a force"),
        (a, "vibration=0um", "it must be greater than 0"),
        (a, "duration=10ms", "`slow` takes 326.39 ms at its own limits"),
        (a, "torque=1mN", "`slow` does not come down to peak torque or force 1.00 mN"),
        (a, "current", "only a PMSM has a current"),
        (a, "vibration", "the residual vibration of `slow` is 0 m: no other run can be slowed to nothing"),
        (table, "torque", "`slow` cannot be slowed: its move 1 follows a table"),
        ("scenarios/plc/figure-3b.toml", "torque", "function blocks"),
    ] {
        let variants: &[&str] =
            if file.starts_with("scenarios") { &["--variant", "slow:", "--variant", "fast:"] } else { &slow };
        let output = compare(&out, &[&[file][..], variants, &["--equal", equal]].concat());
        assert_eq!(code(&output), 2, "{equal}: {}", said(&output));
        let words = said(&output).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.contains(part), "{equal}: {words}");
    }
}

/// A rigid axis behind a screw without friction and a real motor.
const PMSM: &str = r#"
[run]
base_rate = "16 kHz"
[axis]
motion = "linear"
lead = "10 mm"
motor_side = { inertia = "5e-5 kg m2" }
table = { mass = "60 kg" }
[motor]
model = "wittenstein-premo-1f"
[drive]
dc_link = "320 V"
current = { rate = "16 kHz", bandwidth = "1 kHz" }
velocity = { rate = "8 kHz", bandwidth = "50 Hz" }
position = { rate = "4 kHz", bandwidth = "20 Hz" }
feedforward = { velocity = true, effort = "rigid" }
[setpoint]
order = 3
velocity = "30 m/min"
acceleration = "5 m/s2"
jerk = "100 m/s3"
[[program]]
move_to = "200 mm"
"#;
