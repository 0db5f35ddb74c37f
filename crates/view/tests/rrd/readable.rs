//! Readable parts: titles, scales, bodies, disturbances.
use crate::axis::{Case, run};
use crate::content::{assert_views_are_fed, compared, written};
use crate::{MAX_INSTANTS, example, options};
use re_sdk::EntityPath;
use servobench_base::Rate;
use servobench_trace::{Channel, ChannelSpec, Recording, Signal};
use servobench_view::ViewOptions;

/// Largest magnitude of `values`.
fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |peak: f64, value| peak.max(value.abs()))
}

/// The number before `unit` after `word` in `title`.
fn number(title: &str, word: &str, unit: &str) -> f64 {
    let rest = &title[title.find(word).unwrap_or_else(|| panic!("no `{word}` in `{title}`")) + word.len()..];
    let text = rest.split(unit).next().unwrap_or_default().trim();
    text.parse().unwrap_or_else(|_| panic!("`{text}` of `{title}` is not a number"))
}

fn add(recording: &mut Recording, name: &str, unit: &str, values: Vec<f64>) {
    let rate = Rate::new(16_000).unwrap();
    let spec = ChannelSpec { axis: None, name: name.into(), unit: unit.into(), writer: "test".into(), rate };
    recording.channels.push(Channel { spec, values: values.into() });
}

/// Oracle: the recording. Three digits are shown.
#[test]
fn titles_say_the_unit_and_the_peak() {
    let recording = example(3);
    let content = written(&recording, &options());
    for (title, channel, unit, factor) in [
        ("Following error (µm), load peak ", "following_error.load", "µm", 1e6),
        ("Motor force (N), peak ", "effort.motor", "N", 1.0),
        ("Current (Apk), q peak ", "current.q", "Apk", 1.0),
        ("Velocity (m/s), load peak ", "load.velocity", "m/s", 1.0),
        ("Set-point acceleration (m/s²), peak ", "setpoint.acceleration", "m/s²", 1.0),
    ] {
        let (said, is) =
            (number(content.title(title), "peak", unit), factor * peak(recording.channel(channel).unwrap()));
        assert!((said - is).abs() <= 0.005 * is, "{title}: {said}, {is}");
    }
    assert_eq!(content.title("Position"), "Position (m)");
}

/// Oracle: the metric's definition, load position minus target from the end of the profile on.
#[test]
fn residual_vibration_is_the_load_minus_its_target() {
    let recording = example(3);
    let content = written(&recording, &ViewOptions { max_instants: usize::MAX, ..options() });
    let (end, target) = (recording.moves[0].end, recording.moves[0].to);
    let first = recording.index_at(end);
    let expected: Vec<f64> = recording.channel("load.position").unwrap()[first..].iter().map(|x| x - target).collect();
    let curve = &content.curves["/residual_vibration/load"];
    assert_eq!(curve.len(), expected.len());
    // The unit is µm: one rounding of a position of a metre is 1e-10 of it.
    assert!(curve.iter().zip(&expected).all(|((_, shown), x)| (shown - 1e6 * x).abs() < 1e-9 + 1e-12 * shown.abs()));
    let (low, high) = expected.iter().fold((0.0, 0.0), |(low, high): (f64, f64), x| (low.min(*x), high.max(*x)));
    let said = number(content.title("Residual vibration after the last move (µm), load p-p "), "p-p", "µm");
    assert!((said - 1e6 * (high - low)).abs() <= 0.005 * said, "{said}");
    let from = number(content.title("Residual"), "from", "s");
    assert!((from - end).abs() <= 0.005 * end, "{from} instead of {end}");
}

#[test]
fn limits_and_windows_are_written_in_one_style() {
    let recording = example(3);
    let titled = |window, current| {
        let limits = vec![("current.q".into(), current), ("following_error.load".into(), 5e-3)];
        let content = written(&recording, &ViewOptions { window: Some(window), limits, ..options() });
        let bound = |title: &str| title.split(", ").find(|part| part.contains('±')).unwrap().to_owned();
        ["Residual", "Current", "Following"].map(|name| bound(content.title(name)))
    };
    // Out of sight, each with the prefix that suits it.
    assert_eq!(titled(10e-3, 18_810.0), ["window ±10 mm", "limit ±18.81 kApk", "limit ±5 mm"]);
}

/// Oracle: Rerun labels multiples of a power of ten, at a distance of 21 points or more.
#[test]
fn every_value_axis_has_two_labels_at_least() {
    for recording in [example(3), example(4), run(Case { name: "turntable", order: 4, rotary: true, duration: 1.5 })] {
        let content = written(&recording, &options());
        let ranges = content.views.values().filter_map(|view| Some((&view.title, view.range?)));
        let mut count = 0;
        for (title, [low, high]) in ranges {
            let labelled = (-12..12).any(|k| {
                let tick = 10_f64.powi(k);
                (high / tick).floor() - (low / tick).ceil() >= 1.0 && (high - low) / tick <= 340.0 / 21.0
            });
            assert!(labelled, "{title}: {low} to {high}");
            count += 1;
        }
        assert!(count >= 10, "{count} plots");
    }
}

#[test]
fn a_comparison_says_the_peak_of_each_run() {
    let (jerk, snap) = (example(3), example(4));
    let content = compared(&[("jerk", &jerk), ("snap", &snap)], &options());
    let title = content.title("Following error");
    let of = |recording: &Recording| 1e6 * peak(recording.channel("following_error.load").unwrap());
    let (said_of_jerk, said_of_snap) = (number(title, "peak", "(jerk)"), number(title, "(jerk), ", "(snap)"));
    assert!((said_of_jerk - of(&jerk)).abs() <= 0.005 * of(&jerk), "{title}: {}", of(&jerk));
    assert!((said_of_snap - of(&snap)).abs() <= 0.005 * of(&snap), "{title}: {}", of(&snap));
    assert!(content.title("Voltage magnitude").ends_with("(snap), limit 311.8 Vpk"), "a bound of all runs");
    // All runs were planned with one acceleration, but only one of them with a limit of the snap.
    assert!(content.entities.contains("/limit/setpoint_acceleration/upper"));
    assert!(!content.entities.contains("/limit/setpoint_snap/upper"));
}

#[test]
fn one_body_is_drawn_as_one() {
    let mut recording = example(3);
    recording.about.bodies = vec!["axis".into()];
    let motor = recording.channel("motor.position").unwrap().to_vec();
    recording
        .channels
        .iter_mut()
        .filter(|one| one.spec.name == "load.position")
        .for_each(|one| one.values = motor.clone().into());
    let content = written(&recording, &options());
    let bodies: Vec<_> = content.entities.iter().filter(|entity| entity.starts_with("/axis/")).collect();
    assert_eq!(bodies, ["/axis/bed", "/axis/body", "/axis/reference", "/axis/ruler"]);
    assert_eq!(content.title("Axis"), "Axis: example on example");
    assert!(!content.queries.contains("/following_error/motor"), "the same curve twice");
    assert!(content.queries.contains("/following_error/load"));
    assert_views_are_fed(&content);
}

#[test]
fn a_disturbance_has_a_plot_a_lane_and_an_arrow() {
    let mut recording = example(3);
    let pushed = |k: usize| if (3_200..11_200).contains(&k) { -300.0 } else { 0.0 };
    let force = (0..recording.len()).map(pushed).collect();
    add(&mut recording, "disturbance.load", "N", force);
    let content = written(&recording, &options());
    assert_eq!(content.title("Disturbance"), "Disturbance on the load (N), peak 300 N");
    for entity in ["/load_disturbance", "/load_disturbance/load", "/axis/load/disturbance"] {
        assert!(content.entities.contains(entity), "{entity} is missing in {:?}", content.entities);
    }
    assert!(content.queries.contains("/load_disturbance"), "no view shows the lane");
    assert_views_are_fed(&content);
}

#[test]
fn without_a_disturbance_there_is_none_of_it() {
    let mut recording = example(3);
    let none = vec![0.0; recording.len()];
    add(&mut recording, "disturbance.load", "N", none);
    let content = written(&recording, &options());
    assert!(!content.queries.iter().any(|query| query.starts_with("/load_disturbance")), "{:?}", content.queries);
    assert_views_are_fed(&content);
}

/// A viewer shows a large file while it reads it.
#[test]
fn names_colours_and_bodies_come_before_the_curves() {
    let content = written(&example(3), &options());
    let first_curve = content.order.iter().position(|entity| entity == "/position/load").unwrap();
    let is_early = |entity: &str| content.order.iter().position(|other| other == entity).unwrap() <= first_curve;
    // The first chunk of a curve's entity is its style; its values, of which there are as many as are kept, come later.
    assert!(is_early("/axis/load") && is_early("/voltage_magnitude/applied") && is_early("/moves"));
    assert!(content.curves["/position/load"].len() <= MAX_INSTANTS);
}

/// On the page of a program the plots are low: their axes go as far as two labels need.
#[test]
fn a_low_plot_has_an_axis_of_its_own() {
    let mut recording = example(3);
    let velocities = (0..recording.len()).map(|k| 0.258 * (k as f64 * 1e-3).sin() + 0.06).collect();
    recording.channels.retain(|channel| !["velocity.reference", "load.velocity"].contains(&channel.spec.name.as_str()));
    add(&mut recording, "load.velocity", "m/s", velocities);
    let changes = vec![(0.0, "FALSE".to_owned()), (0.5, "TRUE".to_owned())];
    for k in 0..20 {
        recording.signals.push(Signal { source: format!("block{k}"), name: "Done".into(), changes: changes.clone() });
    }
    let content = written(&recording, &options());
    let ranges: Vec<_> = content.views.values().filter(|view| view.title.starts_with("Velocity")).collect();
    assert_eq!(ranges.len(), 2, "one on the page of the axis, one on that of the program");
    for view in ranges {
        let [low, high] = view.range.unwrap();
        let labels = |tick: f64| (high / tick).floor() - (low / tick).ceil() + 1.0;
        // The lower of the two is 125 points high, of which a label takes 21.
        let is_labelled = |tick: f64| labels(tick) >= 2.0 && tick / (high - low) * 125.0 >= 21.0;
        assert!([10.0, 100.0, 1000.0, 0.1, 1.0].into_iter().any(is_labelled), "{low} to {high}");
    }
}

/// The viewer sorts lanes by their entity paths: as paths are sorted, blocks stand in the order of the program, the tenth below the second.
#[test]
fn lanes_of_blocks_are_in_the_order_of_the_program() {
    let names = ["power", "home", "go", "back", "again", "b", "a", "d", "c", "stop", "reset"];
    let changes = vec![(0.0, "FALSE".to_owned()), (0.5, "TRUE".to_owned())];
    let mut recording = example(3);
    recording.signals.push(Signal {
        source: "axis".into(),
        name: "state".into(),
        changes: vec![(0.0, "Standstill".into())],
    });
    for name in names {
        recording.signals.push(Signal { source: name.into(), name: "Done".into(), changes: changes.clone() });
    }
    let content = written(&recording, &options());
    let mut paths: Vec<EntityPath> = content.lanes.keys().map(|path| EntityPath::parse_forgiving(path)).collect();
    paths.sort();
    let blocks: Vec<String> =
        paths.iter().map(ToString::to_string).filter(|path| path.starts_with("/blocks")).collect();
    let expected: Vec<String> =
        (1..).zip(names).map(|(number, name)| format!("/blocks/{number}.{name}/Done")).collect();
    assert_eq!(blocks, expected);
    // What is FALSE says nothing, what is TRUE says so.
    let words = [(" ".to_owned(), "FALSE"), ("TRUE".to_owned(), "TRUE")].map(|(word, value)| (value.to_owned(), word));
    assert_eq!(content.words["/blocks/1.power/Done"], words);
    assert_eq!(content.words["/axis/state"], [("Standstill".to_owned(), "Standstill".to_owned())]);
    assert_views_are_fed(&content);
}
