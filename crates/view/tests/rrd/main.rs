//! Content of a file, read back with Rerun's own decoder.
#[path = "../../examples/two_mass/axis.rs"]
mod axis;
mod content;
mod judged;
mod motor;
mod program;
mod readable;
mod scene;

use axis::{Case, run};
use content::{assert_views_are_fed, compared, read, written};
use servobench_base::{Rate, Severity, Tick};
use servobench_trace::{LogEntry, Recording};
use servobench_view::{ViewOptions, comparison_rrd, run_rrd};
use std::collections::BTreeSet;

/// Fewer than the recorded instants of a curve, so that curves are thinned.
const MAX_INSTANTS: usize = 2_000;

fn example(order: u8) -> Recording {
    run(Case { name: "example", order, rotary: false, duration: 1.5 })
}

fn options() -> ViewOptions {
    ViewOptions { max_instants: MAX_INSTANTS, ..ViewOptions::default() }
}

#[test]
fn a_run_is_all_there_on_one_timeline() {
    let content = written(&example(4), &options());
    assert_eq!(content.timelines, BTreeSet::from(["time".to_owned()]));
    for entity in [
        "/position/load",
        "/position/motor",
        "/position/reference",
        "/velocity/load",
        "/following_error/load",
        "/following_error/motor",
        "/residual_vibration/load",
        "/effort/motor",
        "/current/q",
        "/current/q_reference",
        "/voltage_magnitude/applied",
        "/setpoint_snap/snap",
    ] {
        assert!(content.curves.contains_key(entity), "{entity} is missing in {:?}", content.curves.keys());
    }
    for entity in ["/axis/motor", "/axis/load", "/axis/bed", "/axis/spring/load", "/axis/reference", "/moves", "/log"] {
        assert!(content.entities.contains(entity), "{entity} is missing in {:?}", content.entities);
    }
    assert_views_are_fed(&content);
}

/// `recording` of an axis called `name`.
fn of_axis(mut recording: Recording, name: &str) -> Recording {
    for channel in &mut recording.channels {
        channel.spec.axis = Some(name.parse().unwrap());
    }
    recording
}

#[test]
fn entities_of_an_axis_with_a_name_are_below_it() {
    let unnamed = written(&example(4), &options());
    let named = written(&of_axis(example(4), "x"), &options());
    assert_views_are_fed(&named);
    let own = |entity: &&String| unnamed.entities.contains(entity.as_str());
    let shared: Vec<_> = named.entities.iter().filter(own).collect();
    assert!(!shared.iter().any(|entity| entity.contains("load")), "{shared:?}");
    for (entity, curve) in &unnamed.curves {
        let below = format!("/x{entity}");
        assert_eq!(named.curves.get(&below).or(named.curves.get(entity)), Some(curve), "{entity}");
    }
    for entity in ["/x/position/load", "/x/axis/motor", "/x/axis/spring/load", "/x/moves"] {
        assert!(named.entities.contains(entity), "{entity} is missing in {:?}", named.entities);
    }
    // The name of a plane of the motor's would put the run into it.
    let taken = written(&of_axis(example(4), "current_plane"), &options());
    assert!(taken.entities.contains("/axis-current_plane/position/load"), "{:?}", taken.entities);
    assert_views_are_fed(&taken);
}

#[test]
fn a_derivative_that_is_no_more_than_impulses_has_no_plot() {
    let content = written(&example(3), &options());
    assert!(!content.curves.contains_key("/setpoint_snap/snap"), "{:?}", content.curves.keys());
    assert!(content.curves.contains_key("/setpoint_jerk/jerk"));
    assert_views_are_fed(&content);
}

/// Oracle: the recording itself. The curve is thinned, its extremes are not, in value and in time.
#[test]
fn thinning_keeps_the_extremes_at_their_instants() {
    let recording = example(3);
    let content = written(&recording, &options());
    for (entity, channel, factor) in [
        ("/following_error/load", "following_error.load", 1e6),
        ("/velocity/load", "load.velocity", 1.0),
        ("/current/q", "current.q", 1.0),
    ] {
        let curve = &content.curves[entity];
        let values = recording.channel(channel).unwrap();
        assert!(values.len() > MAX_INSTANTS && curve.len() <= MAX_INSTANTS, "{entity}: {}", curve.len());
        for sign in [1.0, -1.0] {
            let first_largest =
                (0..values.len()).rev().max_by(|a, b| (sign * values[*a]).total_cmp(&(sign * values[*b])));
            let at = first_largest.unwrap();
            #[expect(clippy::cast_possible_truncation, reason = "seconds of a short run in nanoseconds")]
            let nanoseconds = (recording.rate.time(Tick(at as u64)) * 1e9).round() as i64;
            assert!(
                curve
                    .iter()
                    .any(|(time, value)| *time == nanoseconds
                        && (value - factor * values[at]).abs() <= 1e-12 * value.abs()),
                "{entity} lost {} at {nanoseconds} ns",
                values[at]
            );
        }
        assert!(curve.windows(2).all(|pair| pair[0].0 < pair[1].0), "{entity} runs forward");
    }
}

#[test]
fn a_short_run_is_not_thinned() {
    let recording = example(3);
    let content = written(&recording, &ViewOptions::default());
    let instants = recording.len();
    assert!(instants > 20_000 && content.curves["/position/load"].len() <= 20_000);
    let content = written(&recording, &ViewOptions { max_instants: instants, ..options() });
    assert_eq!(content.curves["/position/load"].len(), instants);
}

#[test]
fn residual_vibration_starts_at_the_end_of_the_last_profile() {
    let mut recording = example(4);
    let start = |recording: &Recording, options: &ViewOptions| {
        written(recording, options).curves.get("/residual_vibration/load").map(|curve| curve[0].0)
    };
    assert_eq!(start(&recording, &options()), Some(1_350_000_000));
    recording.moves.clear();
    assert_eq!(start(&recording, &options()), None);
    assert_eq!(start(&recording, &ViewOptions { residual_from: Some(0.5), ..options() }), Some(500_000_000));
}

#[test]
fn limits_are_lines_where_they_can_be_seen_and_words_where_not() {
    let recording = example(3);
    let limits = |current, effort| ViewOptions {
        limits: vec![("current.q".into(), current), ("effort.motor".into(), effort)],
        window: Some(5e-6),
        ..options()
    };
    let content = written(&recording, &limits(5.0, 9_000.0));
    let line = |entity: &str| content.curves[entity].iter().map(|(_, value)| *value).collect::<Vec<_>>();
    assert_eq!(line("/limit/current/upper"), [5.0, 5.0]);
    assert_eq!(line("/limit/current/lower"), [-5.0, -5.0]);
    assert_eq!(line("/window/residual_vibration/upper"), [5.0, 5.0]);
    assert!(!content.entities.contains("/limit/effort/upper"));
    assert_eq!(content.title("Motor force").split(", ").last(), Some("limit ±9 kN"));
    // The voltage limit is a recorded channel, here far above the voltage.
    assert_eq!(content.title("Voltage magnitude").split(", ").last(), Some("limit 311.8 Vpk"));
    assert_views_are_fed(&content);
}

#[test]
fn runs_of_a_comparison_lie_over_each_other() {
    let (jerk, snap) = (example(3), example(4));
    let content = compared(&[("jerk", &jerk), ("snap", &snap)], &options());
    for entity in ["position/load", "following_error/load", "residual_vibration/load", "current/q"] {
        for run in ["jerk", "snap"] {
            assert!(content.curves.contains_key(&format!("/{run}/{entity}")), "/{run}/{entity}");
            assert!(content.queries.contains(&format!("/{run}/{entity}")), "no view shows /{run}/{entity}");
        }
    }
    assert_eq!(content.curves["/jerk/position/load"][0].0, 0);
    assert_eq!(content.curves["/snap/position/load"][0].0, 0);
    assert_views_are_fed(&content);
}

#[test]
fn any_channel_may_be_missing() {
    let whole = example(3);
    for missing in 0..whole.channels.len() {
        let mut recording = whole.clone();
        let name = recording.channels.remove(missing).spec.name;
        let content = written(&recording, &options());
        assert!(!content.curves.is_empty(), "without {name}");
        assert_views_are_fed(&content);
    }
    for kept in 0..whole.channels.len() {
        let mut recording = whole.clone();
        recording.channels = vec![recording.channels.swap_remove(kept)];
        assert_views_are_fed(&written(&recording, &options()));
    }
}

#[test]
fn what_an_fmu_said_is_in_the_log_at_its_time() {
    let mut recording = example(3);
    let said = |severity, start, end, times, text: &str| LogEntry {
        source: "FMU load".into(),
        severity,
        start,
        end,
        times,
        text: text.into(),
    };
    recording.log = vec![
        said(Severity::Info, 0.0, 0.0, 1, "Gear, order 5"),
        said(Severity::Warning, 0.25, 0.75, 3, "stiff"),
        said(Severity::Error, 0.5, 0.5, 1, "leak"),
    ];
    let content = written(&recording, &options());
    let said: Vec<_> = content.log.iter().filter(|(_, text)| text.contains("FMU")).collect();
    let line = |level: &str, text: &str| (level.to_owned(), text.to_owned());
    let lines = [
        line("INFO", "0.0000 s  FMU load: Gear, order 5"),
        line("WARN", "0.2500 s  FMU load: stiff (3 times until 0.7500 s)"),
        line("ERROR", "0.5000 s  FMU load: leak"),
    ];
    assert_eq!(said, lines.iter().collect::<Vec<_>>());
    assert_views_are_fed(&content);
}

#[test]
fn nothing_recorded_is_no_error() {
    let mut recording = example(3);
    recording.channels.iter_mut().for_each(|channel| channel.values.to_mut().clear());
    assert_views_are_fed(&written(&recording, &options()));
    recording.channels.clear();
    recording.moves.clear();
    recording.events.clear();
    assert!(written(&recording, &options()).entities.is_empty());
}

#[test]
fn what_is_not_finite_is_left_out() {
    let mut recording = example(3);
    for channel in &mut recording.channels {
        channel.values.to_mut()[100] = f64::NAN;
        channel.values.to_mut()[200] = f64::INFINITY;
    }
    let content = written(&recording, &ViewOptions { max_instants: usize::MAX, ..options() });
    assert_eq!(content.curves["/position/load"].len(), recording.len() - 2);
    assert!(content.curves.values().flatten().all(|(_, value)| value.is_finite()));
    assert_eq!(content.title("Position"), "Position (m)", "an infinite value must not choose the unit");
}

#[test]
fn a_rotary_axis_and_an_axis_at_rest_have_a_3d_view() {
    let rotary = written(&run(Case { name: "turntable", order: 4, rotary: true, duration: 1.5 }), &options());
    assert!(rotary.entities.contains("/axis/shaft") && rotary.title("Position") == "Position (rad)");
    assert!(rotary.title("Motor torque").starts_with("Motor torque (N·m), peak "));
    let mut recording = example(3);
    recording.channels.iter_mut().for_each(|channel| channel.values.to_mut().fill(0.0));
    assert!(written(&recording, &options()).entities.contains("/axis/load"));
}

#[test]
fn labels_and_numbers_of_runs_are_checked() {
    let recording = example(3);
    let refusal = |runs: &[(&str, &Recording)]| comparison_rrd(runs, &options()).unwrap_err().to_string();
    assert_eq!(
        refusal(&[("one", &recording)]),
        "a comparison needs at least two runs, got 1; a single run has no label"
    );
    assert_eq!(
        refusal(&[("one", &recording), ("one", &recording)]),
        "run 2 of the comparison has the label `one`, which an earlier run has already; give every run its own short label"
    );
    assert!(refusal(&[("", &recording), ("one", &recording)]).contains("which is empty"));
    assert!(refusal(&[("limit", &recording), ("one", &recording)]).contains("which is reserved"));
    assert!(refusal(&[("current_plane", &recording), ("one", &recording)]).contains("which is reserved"));
}

/// 60 s at 16 kHz and 22 channels: the file must stay one that opens at once.
#[test]
fn a_long_run_makes_a_small_file() {
    let mut recording = example(3);
    for channel in &mut recording.channels {
        channel.spec.rate = Rate::new(16_000).unwrap();
        let once = channel.values.clone();
        (0..39).for_each(|_| channel.values.to_mut().extend_from_slice(&once));
    }
    assert_eq!(recording.len(), 960_000);
    let rrd = run_rrd(&recording, &ViewOptions::default()).unwrap();
    assert!(rrd.len() < 15_000_000, "{} bytes", rrd.len());
    // As long as the file has a curve per channel, and each is bounded, this bound is that of any longer run.
    let content = read(&rrd);
    assert!(content.curves.values().all(|curve| curve.len() <= 20_000));
}
