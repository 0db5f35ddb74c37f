//! Fuzz targets: whatever is in a `results.json` or a journal, it is refused, or it is written again as it was read.
//! `docs/testing.md` says how to run more of them.
use servobench_fuzz::{Splice, check, fuzz};
use servobench_results::{
    Finished, Journal, JournalError, Kept, Results, Runs as _, Unfinished, files_of_results, read_journal,
};
use std::fs;
use std::path::Path;
use twox_hash::XxHash64;

const FILES: [&str; 2] = [
    r#"{"schema":"servobench-results/1","generator":"servobench 0.1.0","scenarios":[]}"#,
    r#"{"schema":"servobench-results/1","generator":"servobench 0.1.0","scenarios":[{"name":"jerk","file":"jerk.toml",
    "engine":"exact","verdict":"failed","duration":1.8,"reasons":["settling_time is 60 ms, the limit is 50 ms"],"metrics":
    {"settling_time":{"value":0.06,"unit":"s","limit":0.05,"pass":false},"following_error_cruise_load":{"value":null,
    "unit":"m","limit":1e-6,"limit_min":-1e-6,"pass":false}},"absent":{"following_error_cruise_load":"no cruise"},"moves":
    [{"label":"move","start":0.1,"end":1.4,"metrics":{"move_time":{"value":1.3,"unit":"s","limit":null,"pass":null}}}],
    "events":[{"start":0.2,"end":0.3,"source":"drive","message":"voltage limit"}],
    "log":[{"source":"FMU load","severity":"warning","start":0.2,"end":0.3,"times":3,"text":"stiff"}],"recording":null},
    {"name":"broken","file":null,"engine":"mujoco","verdict":"error","duration":0.0,"reasons":["diverged"],"metrics":{},
    "absent":{},"moves":[],"events":[],"recording":"broken.parquet"}]}"#,
];

const WORDS: &[&str] = &[
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    "\"",
    "\\",
    "\\u0000",
    "\\ud800",
    "null",
    "true",
    "false",
    "NaN",
    "1e400",
    "-0.0",
    "5e-324",
    "18446744073709551616",
    "servobench-results/2",
    "passed",
    "failed",
    "error",
    "value",
    "unit",
    "limit",
    "pass",
    "name",
    "metrics",
    "\"value\":1,",
    "\u{1f600}",
    "\u{0}",
];

#[test]
fn results_files() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results.json");
    fuzz(check!(), 2_000, Splice::text(&FILES, WORDS), |text: &String| match Results::from_json(text) {
        Ok(results) => {
            // Who asks for the files alone is told the same ones.
            fs::write(&path, text).unwrap();
            let files: Vec<String> = results.scenarios.iter().flat_map(|run| run.files.clone()).collect();
            assert_eq!(files_of_results(&path).unwrap(), files);
            let written = results.to_json().unwrap();
            let again = Results::from_json(&written).unwrap();
            assert_eq!(again, results);
            assert_eq!(again.to_json().unwrap(), written);
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    });
}

/// Records of a journal without their digests.
const RECORDS: [&str; 1] = [
    r#"{"suite":{"version":1,"suite":"ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad","command":["run","a.toml"],"folder":"here","stems":["a.exact"]}}
{"finished":{"index":0,"seconds":0.25,"result":{"name":"a","file":"a.toml","engine":"exact","verdict":"passed","duration":1.8,"reasons":[],"metrics":{"settling_time":{"value":0.06,"unit":"s","limit":0.07,"pass":true}},"absent":{},"moves":[],"events":[],"recording":"a.exact.parquet"}}}
{"finished":{"index":1,"seconds":0.5,"result":{"name":"b","file":null,"engine":"mujoco","verdict":"error","duration":0.0,"reasons":["diverged"],"metrics":{},"absent":{},"moves":[],"events":[],"recording":null}}}"#,
];

/// Each line with the digest that fits, so that what is behind it is read.
fn with_digests(text: &str) -> String {
    let line = |line: &str| format!("{:016x} {line}\n", XxHash64::oneshot(0, line.as_bytes()));
    text.split('\n').map(line).collect::<Vec<_>>().concat()
}

/// Names that lead out of a folder, or that no run leaves.
const PLACES: &[&str] = &[
    "../",
    "..",
    "/etc/passwd",
    "/",
    "\\\\",
    "a/b.parquet",
    ".parquet",
    "\"recording\":\"../x.parquet\"",
    "\"files\":[\"/tmp/x.rrd\",\"a.exact.parquet\"]",
    "\"stems\":[\"../a\"]",
    "\"folder\":\"/\"",
    "--junit",
    "--root",
    "\u{0}",
];

/// Whatever a journal says, nothing that it names is outside of its folder once it is resumed.
#[test]
fn hostile_journals() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results.journal");
    let with_files = RECORDS[0].replace("\"events\":[]", "\"events\":[],\"files\":[\"a.exact.parquet\"]");
    let is_beside = |name: &str| {
        Path::new(name).file_name().is_some_and(|file| file == name) && !name.contains(['/', '\\']) && name != ".."
    };
    fuzz(check!(), 1_000, Splice::text(&[RECORDS[0], &with_files], PLACES), |text: &String| {
        fs::write(&path, with_digests(text)).unwrap();
        let mut told = Vec::new();
        match Kept::resume(path.clone(), |one| {
            told_names(one).for_each(|name| assert!(is_beside(name), "{name}"));
            true
        }) {
            Ok((_, suite)) => told.extend(suite.stems),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
        assert!(told.iter().all(|stem| is_beside(&format!("{stem}.parquet"))), "{told:?}");
    });
}

/// Names of files of a run.
fn told_names(one: &Finished) -> impl Iterator<Item = &str> {
    one.result.recording.iter().chain(&one.result.files).map(String::as_str)
}

#[test]
fn journals() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results.journal");
    let all_in = |text: &str| {
        let mut all = Vec::new();
        read_journal(text.as_bytes(), Path::new("x"), |one, _| all.push(one)).map(|suite| (suite, all))
    };
    assert_eq!(all_in(&with_digests(RECORDS[0])).unwrap().1.len(), 2);
    fuzz(check!(), 500, Splice::text(&RECORDS, WORDS), |text: &String| {
        // Without digests no line is whole.
        assert!(all_in(text).is_err());
        match all_in(&with_digests(text)) {
            Ok((suite, finished)) => {
                let mut journal = Journal::create(path.clone(), &suite).unwrap();
                let places: Vec<_> = finished.iter().map(|one| journal.append(one).unwrap()).collect();
                for (one, place) in finished.iter().zip(places) {
                    assert_eq!(&journal.at(place).unwrap(), one);
                }
                assert_eq!(all_in(&fs::read_to_string(&path).unwrap()).unwrap(), (suite.clone(), finished.clone()));
                // The last record of a run is the one that counts. One that leads outside is read, and not resumed.
                let (mut kept, again) = match Kept::resume(path.clone(), |_| true) {
                    Ok(resumed) => resumed,
                    Err(JournalError::Outside { .. }) => return,
                    Err(error) => panic!("{error}"),
                };
                assert_eq!(again, suite);
                kept.plan(vec![Unfinished { name: String::new(), file: None, engine: String::new(), axis: None }; 2]);
                for head in kept.heads() {
                    let last = finished.iter().rfind(|one| one.index == head.index).unwrap();
                    assert_eq!(*kept.result(head.index).unwrap(), last.result);
                }
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    });
}
