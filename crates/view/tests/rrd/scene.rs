//! The 3D view by numbers: places of bodies, and the labels beside them.
use crate::axis::{Case, run};
use crate::content::{Content, compared, written};
use crate::{example, options};
use servobench_view::ViewOptions;

/// Reading of the ruler at a place along the rail: the line through its first and its last tick.
fn reading(content: &Content, place: f32) -> f64 {
    let value = |label: &str| label.split(' ').next().unwrap().parse::<f64>().unwrap();
    let (first, last) = (&content.ticks[0], content.ticks.last().unwrap());
    let part = f64::from(place - first.0) / f64::from(last.0 - first.0);
    value(&first.1) + part * (value(&last.1) - value(&first.1))
}

/// Oracle: the recording. Places are `f32` of travels: 1e-7 of the travel, and the ruler's two ends the same again.
#[test]
fn a_body_stands_above_the_mark_of_its_position() {
    let recording = example(3);
    let content = written(&recording, &ViewOptions { exaggeration: Some(1.0), ..options() });
    let (motor, load) = (recording.channel("motor.position").unwrap(), recording.channel("load.position").unwrap());
    let mut early = 0;
    for (body, positions) in [("/axis/motor", motor), ("/axis/load", load)] {
        for (time, place) in &content.places[body] {
            #[expect(clippy::cast_precision_loss, reason = "nanoseconds of a short run")]
            let position = positions[recording.index_at(*time as f64 * 1e-9 - 1e-9)];
            // The ruler of a metre is in metres.
            let read = reading(&content, place[0]);
            assert!((read - position).abs() < 1e-6, "{body} at {time} ns stands at {read} m instead of {position} m");
            early += usize::from(body == "/axis/load" && (0.000_5..0.002).contains(&position));
        }
    }
    assert!(early > 10, "the load at about 1.1 mm is among them: {early}");
}

/// Only the deflection relative to the motor is enlarged; the pointer at the ruler is not.
#[test]
fn only_the_deflection_is_enlarged() {
    let recording = example(4);
    let content = written(&recording, &ViewOptions { exaggeration: Some(7.0), ..options() });
    let at = |body: &str, index: usize| reading(&content, content.places[body][index].1[0]);
    for index in (0..content.places["/axis/load"].len()).step_by(97) {
        let deflection = at("/axis/load_position", index) - at("/axis/motor", index);
        let drawn = at("/axis/load", index) - at("/axis/motor", index);
        assert!((drawn - 7.0 * deflection).abs() < 2e-6, "{drawn} instead of 7 × {deflection}");
    }
    assert!(content.title("Axis").starts_with("Axis, deflection × 7: "));
}

/// An axis that stands still with a reference of 250 mm stands at the mark of 0, on a ruler of 250 mm.
#[test]
fn the_ruler_is_as_long_as_what_was_asked_for() {
    let mut recording = example(3);
    for channel in &mut recording.channels {
        if ["motor.position", "load.position"].contains(&channel.spec.name.as_str()) {
            channel.values.to_mut().iter_mut().for_each(|x| *x *= 1e-9);
        }
    }
    let content = written(&recording, &ViewOptions { exaggeration: Some(1.0), ..options() });
    assert_eq!(content.ticks.last().unwrap().1, "1 m");
    assert!(content.places["/axis/load"].iter().all(|(_, place)| reading(&content, place[0]).abs() < 1e-6));
}

#[test]
fn every_body_of_a_comparison_says_of_which_run_it_is() {
    for rotary in [false, true] {
        let runs = [3, 4].map(|order| run(Case { name: "example", order, rotary, duration: 1.5 }));
        let content = compared(&[("jerk", &runs[0]), ("snap", &runs[1])], &options());
        let labels: Vec<String> = content.labels.into_values().collect();
        assert_eq!(labels, ["jerk load", "jerk motor", "snap load", "snap motor"], "rotary: {rotary}");
    }
}

/// Names of three runs and more stand one above the other, each beside its rail and clear of the next.
#[test]
fn each_of_three_runs_has_one_name() {
    for rotary in [false, true] {
        let recordings = [3, 4, 3].map(|order| run(Case { name: "example", order, rotary, duration: 1.5 }));
        let runs: Vec<_> = ["one", "two", "three"].into_iter().zip(&recordings).collect();
        let labels: Vec<String> = compared(&runs, &options())
            .labels
            .into_iter()
            .map(|(entity, label)| format!("{entity}: {label}"))
            .collect();
        assert_eq!(
            labels,
            ["/one/axis/name: one", "/three/axis/name: three", "/two/axis/name: two"],
            "rotary: {rotary}"
        );
    }
}
