//! Axes at one time do not see each other: each of them is the run of its scenario alone, bit for bit.
use crate::ball_screw::{AXIS, BLOCKS, BUS, MOVE};
use crate::rig::{bench, run};
use servobench_sim::{Bench, MultiAxisBench, MultiAxisOutcome, NotAtOneTime};
use servobench_trace::Recording;

const PUSH: &str = "[[disturbance]]\non = \"load\"\nstart = \"50 ms\"\nduration = \"100 ms\"\nforce = \"40 N\"\n";

/// A move, for 0.31 s.
fn x() -> String {
    format!("{AXIS}{MOVE}").replace("0.3 s", "0.31 s")
}

/// The same axis, pushed while function blocks move it over a fieldbus, for 0.27 s.
fn y() -> String {
    format!("{AXIS}{PUSH}{BUS}{BLOCKS}").replace("0.3 s", "0.27 s").replace("50 mm", "33 mm")
}

#[test]
fn two_axes_at_one_time_are_two_runs_alone_bit_for_bit() {
    for texts in [[x(), y()], [y(), x()]] {
        // The shorter run goes on to the end of the longer one.
        let texts = texts.map(|text| text.replace("0.27 s", "0.31 s"));
        let axes = texts.iter().map(|text| bench(text)).collect();
        let together = MultiAxisBench::new(axes).unwrap_or_else(|error| panic!("{error}"));
        let MultiAxisOutcome { recordings, failure } = together.run(&mut |_| {});
        assert_eq!(failure, None);
        let expected: Vec<Recording> = texts.iter().map(|text| run(text)).collect();
        assert_eq!(recordings, expected);
        let bits = |recording: &Recording| -> Vec<u64> {
            recording.channels.iter().flat_map(|channel| channel.values.iter().map(|value| value.to_bits())).collect()
        };
        assert!(recordings.iter().map(bits).eq(expected.iter().map(bits)), "−0 and 0 are two");
        assert_ne!(recordings[0].channels, recordings[1].channels, "two axes that differ");
    }
}

#[test]
fn a_run_lasts_as_long_as_its_longest_axis() {
    let together = MultiAxisBench::new(vec![bench(&y()), bench(&x())]).unwrap_or_else(|error| panic!("{error}"));
    let recordings = together.run(&mut |_| {}).recordings;
    let short = run(&y());
    for (channel, expected) in recordings[0].channels.iter().zip(&short.channels) {
        assert_eq!(channel.values[..expected.values.len()], *expected.values, "{}", expected.spec.name);
        assert_eq!(channel.values.len(), recordings[1].channels[0].values.len());
    }
}

/// Oracle: the same disturbance in a scenario that lasts as long.
#[test]
fn what_lasts_to_the_end_lasts_to_that_of_the_longest_axis() {
    let endless = |text: &str| text.replace("duration = \"100 ms\"\nforce", "force");
    let short = endless(&y());
    assert_ne!(short, y());
    let together = MultiAxisBench::new(vec![bench(&short), bench(&x())]).unwrap_or_else(|error| panic!("{error}"));
    let recordings = together.run(&mut |_| {}).recordings;
    assert_eq!(recordings[0].channels, run(&short.replace("0.27 s", "0.31 s")).channels);
}

#[test]
fn axes_that_do_not_fit_are_named() {
    let refusal = |axes: Vec<Bench>| MultiAxisBench::new(axes).map(|_| ()).unwrap_err().to_string();
    assert_eq!(MultiAxisBench::new(vec![]).map(|_| ()), Err(NotAtOneTime::NoAxis));
    let faster = x().replace("16 kHz", "32 kHz");
    assert_eq!(
        refusal(vec![bench(&x()), bench(&faster)]),
        "axis 2 has a base rate of 32000 Hz, axis 1 one of 16000 Hz; give all axes the same `run.base_rate`"
    );
}
