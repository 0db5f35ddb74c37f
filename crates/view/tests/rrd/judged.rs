//! Outcome of a run: verdict, limits, settling, calls, limits that were reached, channels beyond the catalogue.
use crate::content::{assert_views_are_fed, compared, written};
use crate::{example, options};
use servobench_base::Rate;
use servobench_metrics::{Name, Question, measure};
use servobench_trace::{Call, CallFate, Channel, ChannelSpec, Event, Recording};
use servobench_view::{Outcome, Verdict, ViewOptions};

fn add(recording: &mut Recording, name: &str, unit: &str, value: impl Fn(usize) -> f64) {
    let spec =
        ChannelSpec { axis: None, name: name.into(), unit: unit.into(), writer: "test".into(), rate: recording.rate };
    let values = (0..recording.len()).map(value).collect();
    recording.channels.retain(|channel| channel.spec.name != name);
    recording.channels.push(Channel { spec, values });
}

#[test]
fn the_verdict_stands_above_every_page() {
    let reasons = vec!["settling_time 35.2 ms, limit 20.0 ms".to_owned()];
    let verdict = Verdict { outcome: Outcome::Failed, reasons, warnings: vec![] };
    let content = written(&example(3), &ViewOptions { verdicts: vec![verdict.clone()], ..options() });
    assert_eq!(content.documents, ["**FAILED**\n- settling\\_time 35.2 ms, limit 20.0 ms"]);
    let heads = content.views.values().filter(|view| view.title == "example on example").count();
    assert_eq!(heads, 4, "axis, set-point, drive, log");
    assert_views_are_fed(&content);
    // Of two runs, each.
    let runs = [example(3), example(4)];
    let passed = Verdict { outcome: Outcome::Passed, ..Verdict::default() };
    let options = ViewOptions { verdicts: vec![verdict, passed], ..options() };
    let text = &compared(&[("jerk", &runs[0]), ("snap", &runs[1])], &options).documents[0];
    assert!(text.starts_with("jerk: **FAILED** · snap: passed\n\njerk\n- settling"), "{text}");
    let unknown = &written(&example(3), &crate::options()).documents[0];
    assert!(unknown.starts_with("no verdict is known"), "{unknown}");
}

/// Oracle: the metric of the same name.
#[test]
fn settling_is_marked_where_the_metric_has_it() {
    let recording = example(3);
    let settled = |window: f64| {
        let metrics = measure(&recording, &Question { window: Some(window), ..Question::default() });
        metrics.run.value(Name::SettlingTime)
    };
    let after = &recording.channel("load.position").unwrap()[recording.index_at(recording.moves[0].end)..];
    let window = 0.3 * after.iter().fold(0.0, |peak: f64, x| peak.max((x - recording.moves[0].to).abs()));
    let time = settled(window).unwrap();
    assert!(time > 0.0, "a window that the load leaves");
    let allowed = vec![(Name::SettlingTime, 0.02), (Name::ResidualVibrationPp, 3e-6)];
    let content = written(&recording, &ViewOptions { window: Some(window), allowed, ..options() });
    let nanoseconds = |time: f64| ((recording.moves[0].end + time) * 1e9).round();
    for (mark, time) in [("settled", time), ("allowed_settling", 0.02)] {
        let line = &content.curves[&format!("/residual_vibration/{mark}")];
        #[expect(clippy::cast_precision_loss, reason = "nanoseconds of a short run")]
        let at = line[0].0 as f64;
        // Upright, from end to end of the axis.
        assert!(line.len() == 2 && line[1].0 - line[0].0 == 1 && (at - nanoseconds(time)).abs() <= 1.0, "{line:?}");
        let [low, high] = content.view("Residual").range.unwrap();
        assert!(line[0].1 <= 0.9 * low && line[1].1 >= 0.9 * high, "{line:?} in {low} to {high}");
    }
    let title = content.title("Residual");
    assert!(title.contains("settled after ") && title.contains("allowed p-p 3 µm"), "{title}");
    // A window that it is never in for good.
    let never = written(&recording, &ViewOptions { window: Some(1e-12), ..options() });
    assert!(never.title("Residual").contains("not settled"), "{}", never.title("Residual"));
    assert!(!never.entities.contains("/residual_vibration/settled"));
}

#[test]
fn what_is_allowed_is_drawn_at_the_curve_that_it_bounds() {
    let recording = example(3);
    let peak = |channel: &str| recording.channel(channel).unwrap().iter().fold(0.0, |peak: f64, x| peak.max(x.abs()));
    let (load, motor) = (0.5 * peak("following_error.load"), 100.0 * peak("following_error.load"));
    let allowed = vec![
        (Name::FollowingErrorPeakLoad, load),
        (Name::FollowingErrorPeakMotor, motor),
        (Name::TorquePeak, peak("effort.motor")),
        (Name::TorqueRms, 1.0),
    ];
    let limits = vec![("effort.reference".to_owned(), 2.0 * peak("effort.motor"))];
    let content = written(&recording, &ViewOptions { allowed, limits, ..options() });
    let line = &content.curves["/allowed/following_error/load/upper"];
    assert!((line[0].1 * 1e-6 - load).abs() < 1e-12, "{line:?}, in µm");
    assert!(content.curves.contains_key("/allowed/following_error/load/lower"));
    // Out of sight, and said with whose it is.
    assert!(!content.entities.contains("/allowed/following_error/motor/upper"));
    assert!(content.title("Following error").contains("allowed motor ±"), "{}", content.title("Following error"));
    // Beside what the drive bounds.
    for entity in ["/allowed/effort/upper", "/limit/effort/upper"] {
        assert!(content.queries.contains(entity), "{entity} in {:?}", content.queries);
    }
    assert_views_are_fed(&content);
}

/// Bands of one plot hid each other: each limit has a lane, except those that were never reached.
#[test]
fn limits_that_cut_have_a_lane_each() {
    let mut recording = example(3);
    add(&mut recording, "saturation.voltage", "", |k| if (3_984..5_568).contains(&k) { 1.0 } else { 0.0 });
    add(&mut recording, "saturation.effort", "", |k| [0.0, 1.0][k % 2]);
    let content = written(&recording, &options());
    let lane = &content.lanes["/limit_reached/voltage"];
    let said: Vec<_> = lane.iter().map(|(time, state)| (*time / 1_000_000, state.as_str())).collect();
    assert_eq!(said, [(0, "not reached"), (249, "at every tick"), (348, "not reached")]);
    assert!(content.lanes["/limit_reached/effort"].iter().any(|(_, state)| state == "at most ticks"));
    assert!(!content.lanes.contains_key("/limit_reached/current"), "it never cut");
    // 24 000 rows at 16 kHz, in stretches of 24: 1 584 of them, and half of them.
    assert_eq!(content.title("Limits reached"), "Limits reached: voltage for 99 ms, effort for 0.75 s");
    assert!(!content.curves.keys().any(|curve| curve.contains("saturation")), "{:?}", content.curves.keys());
    let none = written(&example(3), &options());
    assert!(none.lanes.keys().all(|lane| !lane.starts_with("/limit_reached")), "{:?}", none.lanes.keys());
}

#[test]
fn calls_that_did_not_come_to_their_end_say_why() {
    let mut recording = example(3);
    let call = |name: &str, is_optional, fate| Call { name: name.into(), block: "MC_Halt".into(), is_optional, fate };
    recording.calls = vec![
        call("first", false, CallFate::Executed),
        call("second", false, CallFate::NeverExecuted("`first.Done` did not become TRUE".into())),
        call("third", true, CallFate::NeverExecuted("no error".into())),
        call("fourth", false, CallFate::Failed { time: 0.25, id: 7, message: "out of range".into() }),
    ];
    let message = "`first.Done` did not become TRUE".to_owned();
    recording.events.push(Event::new(1.0, 1.0, "PLC", message));
    let content = written(&recording, &options());
    let of_second = content.log.iter().filter(|(_, line)| line.contains("`first.Done`")).count();
    assert_eq!(of_second, 1, "said of the call, and not again as an event: {:?}", content.log);
    assert_eq!(content.lanes["/blocks/2.second/never_executed"], [(0, "`first.Done` did not become TRUE".to_owned())]);
    let failed = [(0, "no error".to_owned()), (250_000_000, "out of range".to_owned())];
    assert_eq!(content.lanes["/blocks/4.fourth/failed"], failed);
    assert!(!content.lanes.keys().any(|lane| lane.contains("first")));
    content.view("Calls that were never executed, or failed");
    let said = |level: &str, text: &str| content.log.iter().any(|(l, line)| l == level && line.contains(text));
    assert!(said("ERROR", "`second` (MC_Halt) was never executed: `first.Done` did not become TRUE"));
    assert!(
        said("INFO", "`third` (MC_Halt) was never executed") && said("ERROR", "0.2500 s  `fourth` (MC_Halt) failed")
    );
    assert_views_are_fed(&content);
}

#[test]
fn channels_that_nobody_expected_are_plotted_with_their_group() {
    let mut recording = example(3);
    recording.rate = Rate::new(16_000).unwrap();
    for (name, unit) in [
        ("power.electrical", "W"),
        ("power.shaft", "W"),
        ("power.mystery", "W"),
        ("power.factor", ""),
        ("cutting.force_x", "N"),
        ("cutting.force_y", "N"),
        ("voltage.q_reference", "V"),
        ("lonely", "K"),
    ] {
        add(&mut recording, name, unit, |k| k as f64);
    }
    let content = written(&recording, &options());
    for curve in [
        "/power/electrical",
        "/power/shaft",
        "/power/mystery",
        "/other/power.factor",
        "/other/cutting.force_x",
        "/other/cutting.force_y",
        "/voltage/q_reference",
        "/other/lonely",
    ] {
        assert!(content.queries.contains(curve), "{curve} in {:?}", content.queries);
    }
    assert!(content.title("Power (kW)").starts_with("Power (kW), electrical peak 24 kW"), "{}", content.title("Power"));
    assert!(content.title("Cutting").starts_with("Cutting (kN), force x peak"), "{}", content.title("Cutting"));
    content.view("Power: factor");
    content.view("Lonely (kK)");
    assert_views_are_fed(&content);
}

#[test]
fn a_magnitude_has_an_axis_from_zero() {
    let mut recording = example(3);
    let q: Vec<f64> = recording.channel("current.q").unwrap().to_vec();
    add(&mut recording, "voltage.q", "V", |k| 10.0 * q[k]);
    add(&mut recording, "voltage.d", "V", |k| -q[k].abs());
    let content = written(&recording, &options());
    let [low, high] = content.view("Voltage magnitude").range.unwrap();
    // The room below a curve is 3 % of the axis.
    assert!(low <= 0.0 && -low < 0.04 * (high - low), "{low} to {high}");
    let [low, _] = content.view("Voltage (").range.unwrap();
    assert!(low < -1.0, "of both signs: {low}");
}

#[test]
fn a_jerk_limited_move_has_impulses_of_snap_and_no_peak_of_zero() {
    let runs = [example(3), example(4)];
    let content = compared(&[("jerk", &runs[0]), ("snap", &runs[1])], &options());
    assert_eq!(content.title("Set-point snap"), "Set-point snap (m/s⁴), peak 1000 m/s⁴, impulses (jerk)");
    assert!(!content.entities.contains("/jerk/setpoint_snap/snap"), "a line at zero would be wrong");
    // A bus need not carry the acceleration: nothing but zero is no curve.
    let mut bus = example(4);
    add(&mut bus, "setpoint.acceleration", "m/s²", |_| 0.0);
    assert!(written(&bus, &options()).views.values().all(|view| !view.title.contains("acceleration")));
    // Some rounding in the channel is no snap either.
    let mut noisy = example(3);
    add(&mut noisy, "setpoint.snap", "m/s⁴", |k| 1e-9 * (k % 3) as f64);
    assert!(written(&noisy, &options()).views.values().all(|view| !view.title.contains("snap")));
}
