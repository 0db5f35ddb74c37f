//! Real workers: the process is this test program, which serves.
use super::native::MISCHIEF;
use super::*;
use servobench::size::memory;
use servobench_isolation::contain;
use servobench_suite::worker::serve;
use std::ffi::OsString;
use std::os::unix::ffi::OsStringExt;
use std::path::PathBuf;

/// Not a test: the process that the others start.
#[test]
#[ignore = "the process that the other tests start"]
fn worker() {
    // Somebody runs all tests that are ignored.
    if contain().is_ok() {
        let served = std::panic::catch_unwind(|| serve(&ENGINES, &ENGINES).unwrap());
        std::process::exit(if served.is_ok() { 0 } else { 101 });
    }
}

/// Workers whose engine does this.
fn workers_that(mischief: &str, limits: RunLimits) -> (tempfile::TempDir, Workers) {
    let this = std::env::current_exe().unwrap();
    let script =
        format!("{MISCHIEF}={mischief} exec '{}' --exact served::worker --ignored --nocapture", this.to_str().unwrap());
    workers_of(&script, Duration::from_mins(1), limits)
}

fn run_in(workers: &Workers, job: &Job) -> Run {
    execute(job, &ENGINES, workers, &mut |_| {}).unwrap_or_else(|broken| panic!("{}", broken.error))
}

/// End of a worker whose engine does this, in words.
fn end_of(mischief: &str, limits: RunLimits) -> String {
    let broken = broken_in(&workers_that(mischief, limits), &slide(&[EngineName::Mujoco])[0]);
    assert!(broken.until_then.is_none() && !broken.error.is_input());
    let RunError::Worker(WorkerError::Ended { how }) = broken.error else { panic!("{mischief}: {}", broken.error) };
    how
}

#[test]
fn a_worker_that_ends_is_reported_as_what_it_is() {
    for (mischief, says) in [
        ("crash", "signal 11 (SIGSEGV"),
        ("abort", "signal 6 (SIGABRT"),
        ("exit", "exit code 7"),
        ("overflow", "signal 6 (SIGABRT"),
    ] {
        let how = end_of(mischief, GENEROUS);
        assert!(how.starts_with(says), "{mischief}: {how}");
    }
    assert!(end_of("overflow", GENEROUS).contains("overflowed its stack"));
    let how = end_of("hoard", RunLimits { memory: 300_000_000, ..GENEROUS });
    assert!(how.starts_with("it asked for more memory than the 300 MB that it may have"), "{how}");
}

/// Processes that it has started are gone, although they have left session and group; its standard output is kept.
#[test]
fn nothing_is_left_of_a_worker() {
    let sleeping = || {
        let all =
            fs::read_dir("/proc").unwrap().filter_map(|entry| fs::read(entry.unwrap().path().join("cmdline")).ok());
        all.filter(|line| line.as_slice() == b"sleep\x003601\x00").count()
    };
    let before = sleeping();
    let how = end_of("daemon", GENEROUS);
    assert!(how.contains("; it left a process (`s") && how.contains("`), which was ended; its last words: "), "{how}");
    assert!(how.contains("a library speaks on standard output"), "{how}");
    assert_eq!(sleeping(), before);
    // The run that it was left by came to its end.
    let (_folder, workers) = workers_that("quiet-daemon", GENEROUS);
    run_in(&workers, &slide(&[EngineName::Mujoco])[0]);
    while sleeping() == before {
        std::thread::sleep(Duration::from_millis(1));
    }
    assert_eq!(workers.dismiss(), ["it left a process (`sleep`), which was ended"]);
    assert_eq!(sleeping(), before);
}

/// One that is stuck cannot stop itself, and is ended a little later.
#[test]
fn a_limit_of_time_holds_for_one_that_is_stuck() {
    let limits = RunLimits { time: Some(TimeBound::AtMost(0.2)), ..GENEROUS };
    let broken = broken_in(&workers_that("hang", limits), &slide(&[EngineName::Mujoco])[0]);
    let RunError::TimeLimit { limit, reached: 0.0, length, .. } = broken.error else { panic!("{}", broken.error) };
    assert_eq!((limit, length), (Duration::from_millis(200), 0.1));
}

/// One that is only slow stops itself, and leaves what it has.
#[test]
fn a_limit_of_time_leaves_a_recording() {
    let limits = RunLimits { time: Some(TimeBound::AtMost(0.1)), ..GENEROUS };
    let endless = SLIDE.replace("0.1 s", "1e6 s") + "[record]\nrate = \"1 Hz\"\n";
    let broken = broken_in(&workers_that("nothing", limits), &job_of("endless", &endless, &[EngineName::Mujoco])[0]);
    let RunError::TimeLimit { reached, .. } = broken.error else { panic!("{}", broken.error) };
    let (recording, _) = broken.until_then.unwrap();
    assert!(!recording.is_empty() && reached > 0.0, "{reached}");
}

/// Oracle: the same run in this process. Names and paths are whatever they are, durations and overrides arrive, and a worker that has
/// served before gives the same bits as a new one.
#[test]
fn a_run_in_a_worker_is_the_run_here() {
    let (folder, workers) = workers_that("nothing", GENEROUS);
    let program = "[setpoint]\norder = 3\nvelocity = \"1 m/s\"\nacceleration = \"1 m/s2\"\njerk = \"50 m/s3\"\n\
                   [[program]]\nmove_to = \"10 mm\"\n";
    let text = SLIDE.replace("0.1 s", "2 s") + program;
    let overrides = ["drive.velocity.bandwidth=15 Hz", "program[0].move_to='-5 mm'"].map(|text| text.parse().unwrap());
    let scenario = servobench_scenario::Document::parse("x.toml", &text, None, None)
        .and_then(|document| document.scenario(&overrides));
    let mut scenario = scenario.unwrap_or_else(|error| panic!("{error}")).scenario;
    for name in ["-fast", "--engine", "a\nb", "µ \"x\"", "../up"] {
        scenario.name = name.into();
        scenario.path = Some(PathBuf::from(OsString::from_vec(b"-folder/\xff.toml".to_vec())));
        let source = Source { scenario: scenario.clone(), text: text.clone() };
        let [mut here, mut there] = jobs(vec![source], &[EngineName::Exact, EngineName::Mujoco]).try_into().unwrap();
        here.slow_to(vec![1.0 + 1.0 / 3.0]);
        there.slow_to(vec![1.0 + 1.0 / 3.0]);
        let (mut here, there) = (run_in(&workers, &here), run_in(&workers, &there));
        here.recording.about.engine.clone_from(&there.recording.about.engine);
        assert!(here.recording == there.recording, "{name}");
        assert!((there.recording.moves[0].end - 4.0 / 3.0).abs() < 1e-9, "{:?}", there.recording.moves[0]);
        assert_eq!(there.recording.about.overrides.len(), 2);
        assert_eq!(there.recording.about.scenario, name);
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// Several at once, each used again and again: results are those of a separate worker for each.
#[test]
fn workers_that_serve_again_give_the_same() {
    let all: Vec<Job> = (1..=12)
        .flat_map(|k| {
            let text = SLIDE.replace("20 Hz", &format!("{} Hz", 10 + k));
            let text = text + "[[disturbance]]\non = \"load\"\nstart = \"10 ms\"\nforce = \"7 N\"\n";
            job_of(&format!("run {k}"), &text, &[EngineName::Mujoco])
        })
        .collect();
    let (_folder, workers) = workers_that("nothing", GENEROUS);
    let limit = AtATime { jobs: 3, memory: u64::MAX };
    let together =
        map_in_parallel(&all, limit, |job| ((), memory(&job.scenario)), |job, ()| run_in(&workers, job).recording);
    for (job, together) in all.iter().zip(together).step_by(4) {
        let (_folder, alone) = workers_that("nothing", GENEROUS);
        assert!(run_in(&alone, job).recording == together.unwrap());
    }
}
