//! Everything is where it belongs.
use crate::drawn::{Scale, corners, elements, number, text, whole};
use crate::recordings::{aborted, channel, empty, logic, signal, velocity};
use roxmltree::Document;
use servobench_report::{TimingOptions, timing_diagram};

/// Rounding to a hundredth of a pixel, twice, beside that of the labels from which the scale is read.
const ROUNDING: f64 = 0.02;

/// The logic traces of `document` from top to bottom.
fn traces(document: &Document<'_>) -> Vec<Vec<(f64, f64)>> {
    let paths = elements(document, "path", "w");
    paths.into_iter().map(|node| corners(node.attribute("d").unwrap())).collect()
}

/// Where a trace goes up and down.
fn edges(trace: &[(f64, f64)]) -> Vec<f64> {
    trace.windows(2).filter(|pair| (pair[0].1 - pair[1].1).abs() > 1.0).map(|pair| pair[0].0).collect()
}

#[test]
fn every_change_of_a_logic_signal_is_at_its_time() {
    let recording = aborted();
    let svg = timing_diagram(&recording, &TimingOptions { with_idle: true, ..TimingOptions::default() }).unwrap();
    let document = Document::parse(&svg).unwrap();
    let time = Scale::of_time(&document);
    let traces = traces(&document);
    let signals: Vec<_> = recording.signals.iter().filter(|signal| signal.changes[0].1 == "FALSE").collect();
    assert_eq!((traces.len(), signals.len()), (12, 12));
    for (trace, signal) in traces.iter().zip(signals) {
        let (drawn, changes) = (edges(trace), &signal.changes[1..]);
        assert_eq!(drawn.len(), changes.len(), "{}.{}", signal.source, signal.name);
        for (x, (t, _)) in drawn.iter().zip(changes) {
            assert!((x - time.at(*t)).abs() < ROUNDING, "{}.{} at {t} s: {x}", signal.source, signal.name);
        }
        // From the beginning to the end of the recording.
        let (first, last) = (trace[0].0, trace.last().unwrap().0);
        assert!((first - time.at(0.0)).abs() < ROUNDING && (last - time.at(5.0)).abs() < ROUNDING);
    }
}

#[test]
fn every_state_is_a_bar_from_its_change_to_the_next() {
    let recording = aborted();
    let svg = whole(&recording);
    let document = Document::parse(&svg).unwrap();
    let time = Scale::of_time(&document);
    let mut bars: Vec<(f64, f64, f64)> = ["bs", "bo", "bx"]
        .iter()
        .flat_map(|class| elements(&document, "rect", class))
        .map(|node| (number(node, "y"), number(node, "x"), number(node, "width")))
        .collect();
    bars.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.total_cmp(&other.1)));
    let states = recording.signals.iter().filter(|signal| signal.changes[0].1 != "FALSE");
    let stretches = states.flat_map(|signal| {
        let ends = signal.changes.iter().skip(1).map(|(t, _)| *t).chain([5.0]);
        signal.changes.iter().map(|(t, _)| *t).zip(ends)
    });
    let stretches: Vec<(f64, f64)> = stretches.collect();
    assert_eq!(bars.len(), stretches.len());
    for ((_, x, width), (from, to)) in bars.iter().zip(stretches) {
        assert!((x - time.at(from)).abs() < ROUNDING, "{from} s: {x}");
        assert!((x + width - time.at(to)).abs() < ROUNDING, "{to} s: {}", x + width);
    }
}

/// Oracle: the velocity itself. Coordinates of a curve are written to a tenth of a pixel; where it is steep, half of that
/// along time is 0.5 of a pixel and less upright.
#[test]
fn the_curve_of_the_velocity_is_the_velocity() {
    let svg = whole(&aborted());
    let document = Document::parse(&svg).unwrap();
    let time = Scale::of_time(&document);
    let labels = elements(&document, "text", "k");
    let label =
        |name: &str| labels.iter().find(|node| text(**node) == name && node.attribute("text-anchor") == Some("end"));
    let height = |name: &str| number(*label(name).unwrap(), "y") - 4.0;
    let value = Scale::through((0.0, height("0")), (3.0, height("3")));
    let line = corners(elements(&document, "path", "c")[1].attribute("d").unwrap());
    for k in 0..=500 {
        let t = f64::from(k) * 0.01;
        let x = time.at(t);
        let after = line.partition_point(|corner| corner.0 < x).clamp(1, line.len() - 1);
        let ((x0, y0), (x1, y1)) = (line[after - 1], line[after]);
        let y = y0 + (y1 - y0) * (x - x0) / (x1 - x0);
        assert!((y - value.at(velocity(t))).abs() < 0.5, "{t} s: {y} instead of {}", value.at(velocity(t)));
    }
}

/// Oracle: what PLCopen's figure shows: First begins, Second begins as First is aborted, Second is done.
#[test]
fn guides_are_where_blocks_begin_and_end() {
    let svg = whole(&aborted());
    let document = Document::parse(&svg).unwrap();
    let time = Scale::of_time(&document);
    for (class, t, what) in
        [("gb", 0.2, "First.Execute"), ("gc", 1.5, "First.CommandAborted, Second.Execute"), ("ge", 4.55, "Second.Done")]
    {
        let lines = elements(&document, "path", class);
        let line = lines.iter().find(|node| node.first_element_child().is_some()).unwrap();
        assert_eq!(line.first_element_child().unwrap().text(), Some(what));
        let foot = *corners(line.attribute("d").unwrap()).last().unwrap();
        assert!((foot.0 - time.at(t)).abs() < ROUNDING, "{what}: {foot:?}");
    }
    let times: Vec<_> = elements(&document, "text", "e").into_iter().map(text).collect();
    assert_eq!(times, ["0.20", "1.50", "4.55"]);
    // A dot at each edge: four of them, two at once.
    assert_eq!(elements(&document, "circle", "o").len(), 4);
}

/// A tenth of a second of five: what is shown fills the panels, to their edges.
#[test]
fn a_stretch_of_time_fills_the_panels() {
    let options = TimingOptions { from: Some(1.4504), to: Some(1.55), width: 1200, ..TimingOptions::default() };
    let svg = timing_diagram(&aborted(), &options).unwrap();
    let document = Document::parse(&svg).unwrap();
    let time = Scale::of_time(&document);
    for class in ["c", "a"] {
        for line in elements(&document, "path", class).into_iter().skip(1) {
            let corners = corners(line.attribute("d").unwrap());
            // Tenths of a pixel.
            assert!((corners[0].0 - time.at(1.4504)).abs() < 0.1, "{corners:?}");
            assert!((corners.last().unwrap().0 - time.at(1.55)).abs() < 0.1, "{corners:?}");
        }
    }
    let aborted = traces(&document).into_iter().find_map(|trace| edges(&trace).first().copied()).unwrap();
    assert!((aborted - time.at(1.5)).abs() < ROUNDING);
}

/// 20 s at 1 kHz, in it one sample of 5 m/s; a pulse of a cycle; a signal that changes at every millisecond.
#[test]
fn what_is_short_is_seen_in_a_long_recording() {
    let mut velocity = vec![0.0; 20_001];
    velocity[12_345] = 5.0;
    let clock: Vec<f64> = (1..20_000).map(|k| f64::from(k) * 1e-3).collect();
    let recording = servobench_trace::Recording {
        channels: vec![channel("setpoint.velocity", "m/s", velocity)],
        signals: vec![logic("block", "Done", &[12.0, 12.001]), logic("block", "clock", &clock)],
        ..empty()
    };
    let svg = whole(&recording);
    assert!(svg.len() < 10_000, "{} bytes", svg.len());
    let document = Document::parse(&svg).unwrap();
    let line = corners(elements(&document, "path", "c")[1].attribute("d").unwrap());
    let highest = line.iter().copied().min_by(|one, other| one.1.total_cmp(&other.1)).unwrap();
    let time = Scale::of_time(&document);
    // Tenths of a pixel.
    assert!((highest.0 - time.at(12.345)).abs() < 0.1 && highest.1 < line[0].1 - 90.0, "{highest:?}");
    assert_eq!(edges(&traces(&document)[0]).len(), 2);
    assert_eq!(elements(&document, "path", "q").len(), 1, "the clock is a block");
}

/// An hour at 16 kHz would be 58 million instants; a tenth of it is not larger than the whole of a short one. Noise is the
/// worst of curves.
#[test]
fn the_size_of_a_diagram_is_bounded() {
    let noise = |seed: u64| -> Vec<f64> {
        let next = |state: &mut u64, _: u32| {
            *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            Some((*state >> 11) as f64)
        };
        (0..1_000_000).scan(seed, next).collect()
    };
    let names = ["setpoint.velocity", "load.velocity", "setpoint.position", "load.position"];
    let values = ["a", "b", "c"].into_iter().cycle();
    let states: Vec<(f64, &str)> = (0..100_000).zip(values).map(|(k, value)| (f64::from(k) * 0.01, value)).collect();
    let recording = servobench_trace::Recording {
        channels: (1..).zip(names).map(|(seed, name)| channel(name, "m", noise(seed))).collect(),
        signals: vec![signal("drive", "state", &states)],
        ..empty()
    };
    // Two points of 13 bytes for each of 860 columns and four curves are 90 kB.
    let svg = whole(&recording);
    assert!(svg.len() < 100_000, "{} bytes", svg.len());
}

/// 25 edges 10 ms apart do not fit beside each other; those that are written do not overlap.
#[test]
fn times_do_not_overlap() {
    let pulses = |name: &str, shift: f64| {
        let times: Vec<f64> = (0..40).map(|k| 1.0 + shift + 0.02 * f64::from(k)).collect();
        logic("block", name, &times)
    };
    let recording =
        servobench_trace::Recording { signals: vec![pulses("Execute", 0.0), pulses("Done", 0.01)], ..aborted() };
    let svg = whole(&recording);
    let document = Document::parse(&svg).unwrap();
    let times = elements(&document, "text", "e");
    let places: Vec<f64> = times.iter().map(|node| number(*node, "x")).collect();
    // `1.00` in bold letters of 11 pixels is 28 pixels wide.
    assert!(!places.is_empty() && places.windows(2).all(|pair| pair[1] - pair[0] > 30.0), "{places:?}");
}
