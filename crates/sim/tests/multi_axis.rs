//! Axes at one time do not see each other: each of them is the run of its scenario alone, bit for bit.
use servobench_plant::Exact;
use servobench_sim::{Bench, MultiAxisBench, MultiAxisOutcome, NotAtOneTime, Outcome};
use servobench_trace::Recording;

/// A stiff axis with a position move, and a belt that is pushed while function blocks move it over a fieldbus.
const X: &str = r#"
[run]
base_rate = "16 kHz"
duration = "0.31 s"
[axis]
model = "ball-screw"
[motor]
model = "wittenstein-premo-1f"
encoder = { counts_per_rev = 1048576 }
[drive]
model = "servo-16khz"
dc_link = "320 V"
max_torque = "6.09 Nm"
[setpoint]
order = 4
velocity = "30 m/min"
acceleration = "5 m/s2"
jerk = "100 m/s3"
snap = "5000 m/s4"
[[program]]
move_to = "50 mm"
"#;

fn y() -> String {
    let push = "[[disturbance]]\non = \"load\"\nstart = \"50 ms\"\nduration = \"100 ms\"\nforce = \"40 N\"\n";
    let blocks = "[bus]\ncycle = \"1 ms\"\nvelocity_offset = true\n[plc]\nhoming_required = false\n\
                  [[call]]\nblock = \"MC_Power\"\nname = \"power\"\n\
                  [[call]]\nblock = \"MC_MoveAbsolute\"\nname = \"move\"\nstart = \"power.Status\"\nposition = \"33 mm\"\n";
    let text = X.replace("[[program]]\nmove_to = \"50 mm\"\n", "").replace("0.31 s", "0.27 s");
    format!("{text}{push}{blocks}")
}

fn bench(text: &str) -> Bench {
    let parsed = servobench_scenario::parse("multi-axis", text, None).unwrap_or_else(|error| panic!("{error}"));
    Bench::new(&parsed.scenario, &Exact).unwrap_or_else(|error| panic!("{error}"))
}

fn alone(text: &str) -> Recording {
    let Outcome { recording, failure } = bench(text).run(&mut |_| {});
    assert_eq!(failure, None);
    recording
}

#[test]
fn two_axes_at_one_time_are_two_runs_alone_bit_for_bit() {
    for texts in [[X.to_owned(), y()], [y(), X.to_owned()]] {
        // The shorter run goes on to the end of the longer one.
        let texts = texts.map(|text| text.replace("0.27 s", "0.31 s"));
        let axes = texts.iter().map(|text| bench(text)).collect();
        let together = MultiAxisBench::new(axes).unwrap_or_else(|error| panic!("{error}"));
        let MultiAxisOutcome { recordings, failure } = together.run(&mut |_| {});
        assert_eq!(failure, None);
        let expected: Vec<Recording> = texts.iter().map(|text| alone(text)).collect();
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
    let together = MultiAxisBench::new(vec![bench(&y()), bench(X)]).unwrap_or_else(|error| panic!("{error}"));
    let recordings = together.run(&mut |_| {}).recordings;
    let short = alone(&y());
    for (channel, expected) in recordings[0].channels.iter().zip(&short.channels) {
        assert_eq!(channel.values[..expected.values.len()], expected.values, "{}", expected.spec.name);
        assert_eq!(channel.values.len(), recordings[1].channels[0].values.len());
    }
}

#[test]
fn axes_that_do_not_fit_are_named() {
    let refusal = |axes: Vec<Bench>| MultiAxisBench::new(axes).map(|_| ()).unwrap_err().to_string();
    assert_eq!(MultiAxisBench::new(vec![]).map(|_| ()), Err(NotAtOneTime::NoAxis));
    let faster = X.replace("16 kHz", "32 kHz");
    assert_eq!(
        refusal(vec![bench(X), bench(&faster)]),
        "axis 2 has a base rate of 32000 Hz, axis 1 one of 16000 Hz; give all axes the same `run.base_rate`"
    );
}
