//! Fuzz targets: whatever is in a `results.json` or a journal, it is refused, or it is written again as it was read.
//! `docs/testing.md` says how to run more of them.
use servobench_fuzz::{Splice, check, fuzz};
use servobench_results::{Journal, Results, read_journal};
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
    fuzz(check!(), 2_000, Splice::text(&FILES, WORDS), |text| match Results::from_json(text) {
        Ok(results) => {
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
    r#"{"suite":{"version":1,"suite":"ab","command":["run","a.toml"],"folder":"here","stems":["a.exact"]}}
{"finished":{"index":0,"seconds":0.25,"result":{"name":"a","file":"a.toml","engine":"exact","verdict":"passed","duration":1.8,"reasons":[],"metrics":{"settling_time":{"value":0.06,"unit":"s","limit":0.07,"pass":true}},"absent":{},"moves":[],"events":[],"recording":"a.exact.parquet"}}}
{"finished":{"index":1,"seconds":0.5,"result":{"name":"b","file":null,"engine":"mujoco","verdict":"error","duration":0.0,"reasons":["diverged"],"metrics":{},"absent":{},"moves":[],"events":[],"recording":null}}}"#,
];

/// Each line with the digest that fits, so that what is behind it is read.
fn with_digests(text: &str) -> String {
    let line = |line: &str| format!("{:016x} {line}\n", XxHash64::oneshot(0, line.as_bytes()));
    text.split('\n').map(line).collect::<Vec<_>>().concat()
}

#[test]
fn journals() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("results.journal");
    assert_eq!(read_journal(with_digests(RECORDS[0]).as_bytes(), &path).unwrap().1.len(), 2);
    fuzz(check!(), 500, Splice::text(&RECORDS, WORDS), |text: &String| {
        // Without digests no line is whole.
        assert!(read_journal(text.as_bytes(), Path::new("x")).is_err());
        match read_journal(with_digests(text).as_bytes(), Path::new("x")) {
            Ok((suite, finished)) => {
                assert!(finished.windows(2).all(|pair| pair[0].index < pair[1].index));
                let mut journal = Journal::create(path.clone(), &suite).unwrap();
                finished.iter().try_for_each(|one| journal.append(one)).unwrap();
                let (_, again, runs) = Journal::resume(path.clone()).unwrap();
                assert_eq!((again, runs), (suite, finished));
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    });
}
