//! The linear loop in `check` and in a run: both report the same.
use servobench::preview::{Doubt, Preview, preview};
use servobench::{Engines, Run};
use servobench_metrics::{Requirement, Standing};
use servobench_plant::{EngineName, Exact};
use servobench_sim::{Analysis, MasterLoop, analyse_stability};
use servobench_stability::Depth;
use servobench_suite::{Job, Source, Workers, execute, jobs};
use std::path::{Path, PathBuf};

const ENGINES: Engines = Engines { installed: &[&Exact], ..Engines::NONE };

fn job(text: String) -> Job {
    let loaded = servobench_scenario::parse("test", &text, None).unwrap_or_else(|error| panic!("{error}"));
    jobs(vec![Source { scenario: loaded.scenario, text }], &[EngineName::Exact]).remove(0)
}

/// A file of `tests/scenarios/requirements`, with `from` replaced by `to`.
fn changed(name: &str, from: &str, to: &str) -> Job {
    let folder: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/scenarios/requirements");
    let text = std::fs::read_to_string(folder.join(name)).unwrap();
    assert!(text.contains(from), "{name}: {from}");
    job(text.replace(from, to))
}

fn previewed(job: &Job) -> Preview {
    preview(&job.scenario, &[job.engine], None).unwrap()
}

fn run(job: &Job) -> Run {
    execute(job, &ENGINES, &Workers::none(), &mut |_| {}).unwrap_or_else(|broken| panic!("{}", broken.error))
}

/// Why the run of `job` is not stable, the linear loop first.
fn reasons(job: &Job) -> (Standing, Vec<String>) {
    let run = run(job);
    let (_, found) = run.verdict.requirements.into_iter().find(|(name, _)| *name == Requirement::Stable).unwrap();
    (found.standing, found.reasons)
}

/// The preview as one line.
fn screen(job: &Job) -> String {
    previewed(job).screen().split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn what_check_warns_of_is_what_the_run_breaks() {
    for (name, key, begins) in [
        ("schedule-too-high-at-speed.toml", "drive.gain_schedule", "the loop is unstable at 0.2 m/s of the motor"),
        ("schedule-too-low-at-speed.toml", "drive.gain_schedule", "the loop is unstable at 0.002 m/s of the motor"),
        ("late-encoder.toml", "drive.velocity.gain", "the loop is unstable: velocity loop"),
        (
            "master-beyond-its-bound.toml",
            "bus.position_gain",
            "the loop is unstable: position loop of the master, gain 520 1/s",
        ),
    ] {
        let job = changed(name, "breaks", "breaks");
        let (standing, reasons) = reasons(&job);
        println!("{name}: {reasons:?}");
        assert!(standing == Standing::Broken && reasons[0].starts_with(begins), "{name}: {reasons:?}");
        let doubts = previewed(&job).doubts;
        let warned = doubts.iter().any(|Doubt { key: at, message, .. }| at == key && *message == reasons[0]);
        assert!(warned, "{name}: {doubts:?}");
        assert!(screen(&job).contains("stable unstable"), "{name}: {}", screen(&job));
    }
}

/// The gains of speed count for as long as the set-point has them.
#[test]
fn a_moment_at_an_unstable_speed_is_none() {
    let low = |distance: &str| changed("schedule-too-low-at-speed.toml", "move_to = \"400 mm\"", distance);
    assert_eq!(reasons(&low("move_to = \"1 mm\"")).0, Standing::Met, "a tenth of a second");
    assert_eq!(reasons(&low("move_to = \"5 mm\"")).0, Standing::Broken, "two periods of 9 Hz");
    assert!(previewed(&low("move_to = \"1 mm\"")).doubts.is_empty());
    assert_eq!(reasons(&low("move_to = \"-400 mm\"")).0, Standing::Broken, "backwards");
}

#[test]
fn the_loop_that_is_shown_is_the_one_that_is_closed() {
    let name = "master-beyond-its-bound.toml";
    let stable = changed(name, "520 1/s", "230 1/s");
    let screen_of = screen(&stable);
    assert!(screen_of.contains("master's position gain 230 1/s to 2.0"), "{screen_of}");
    assert!(screen_of.contains("master's position 36.6 Hz at 1.00 kHz"), "{screen_of}");
    assert!(!screen_of.contains("position 10.0 Hz") && reasons(&stable).0 == Standing::Met, "{screen_of}");
    let of_drive = changed(name, "mode = \"csv\"\ndelay = 1\nposition_gain = \"520 1/s\"", "mode = \"csp\"\ndelay = 1");
    assert!(screen(&of_drive).contains(", position 10.0 Hz at 8.00 kHz"), "{}", screen(&of_drive));
}

/// Oracle: runs 0.5 % to both sides of the bound, over which a deviation fades or grows; 2 % with a derivative, since below that the increments
/// of the bus are larger than what grows.
#[test]
fn a_master_is_stable_up_to_its_bound_as_runs_are() {
    let text = changed("master-beyond-its-bound.toml", "axis = \"0.1 um\"", "axis = \"1 nm\"").text;
    let text = text.replace("[run]\n", "[run]\nduration = \"3 s\"\n");
    for (velocity, cycle, gains, share) in [
        ("bandwidth = \"600 Hz\", kind = \"p\"", "1 ms", "", 0.005),
        ("bandwidth = \"60 Hz\", kind = \"p\"", "1 ms", "", 0.005),
        ("bandwidth = \"100 Hz\", integral_time = \"20 ms\"", "2 ms", "", 0.005),
        ("bandwidth = \"200 Hz\", kind = \"p\"", "1 ms", "position_integral_time = \"30 ms\"\n", 0.005),
        (
            "bandwidth = \"200 Hz\", kind = \"p\"",
            "2 ms",
            "position_integral_time = \"60 ms\"\nposition_derivative_time = \"1 ms\"\n",
            0.02,
        ),
    ] {
        let with = |gain: f64| {
            let text = text
                .replace("bandwidth = \"600 Hz\"", velocity)
                .replace("cycle = \"1 ms\"", &format!("cycle = \"{cycle}\""))
                .replace("mode = \"csv\"\n", &format!("mode = \"csv\"\n{gains}"));
            job(text.replace("520 1/s", &format!("{gain} 1/s")))
        };
        let analysis = analyse_stability(&with(100.0).scenario, Depth::Boundaries, None, None).unwrap();
        let Analysis::Done { master: Some(MasterLoop { largest: Some(largest), .. }), .. } = analysis else {
            panic!("{analysis:?}")
        };
        for factor in [1.0 / (1.0 + share), 1.0 + share] {
            let recording = run(&with(factor * largest)).recording;
            let positions = recording.channel("load.position").unwrap();
            let swing = |tenths: std::ops::Range<usize>| {
                let part = &positions[positions.len() / 10 * tenths.start..positions.len() / 10 * tenths.end];
                part.iter().fold(f64::NEG_INFINITY, |high, x| high.max(*x))
                    - part.iter().copied().fold(f64::INFINITY, f64::min)
            };
            let [earlier, later] = [swing(5..7), swing(8..10)];
            let what = format!("{velocity} {cycle} {gains:?}: {factor} of {largest}: {earlier:e} m, {later:e} m");
            println!("{what}");
            assert_eq!(later > earlier, factor > 1.0, "{what}");
        }
    }
}

/// Everything that is left out, in the same words.
#[test]
fn what_is_left_out_is_told_by_both() {
    let turned = "latency = \"0.1 ms\", commutation_offset = \"3 deg\"";
    let text = changed("late-encoder.toml", "latency = \"2 ms\"", turned).text;
    let text = text.replace("bandwidth = \"1.2 kHz\" }", "bandwidth = \"1.2 kHz\", d_reference = \"-1 Apk\" }");
    let job = job(text);
    let warnings = run(&job).verdict.warnings;
    let words = "a commutation that is off turns the current that the d axis has at standstill";
    assert!(warnings.iter().any(|warning| warning.contains(words)), "{warnings:?}");
    assert!(screen(&job).contains(words), "{}", screen(&job));
}
