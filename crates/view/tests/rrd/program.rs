//! The program `servobench-view`, as `servobench` and others start it.
use crate::content::{assert_views_are_fed, read};
use crate::example;
use servobench_view::{Outcome, Verdict, ViewOptions};
use servobench_view_request::{CONTAINED, Request, VERSION};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

const PROGRAM: &str = env!("CARGO_BIN_EXE_servobench-view");

/// Its answer to `arguments` in `folder`, with `request` on standard input.
fn answer(folder: &Path, arguments: &[&str], request: &str) -> Output {
    let mut command = Command::new(PROGRAM);
    command.args(arguments).current_dir(folder).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    // One that has ended with a mistake reads nothing.
    child.stdin.take().unwrap().write_all(request.as_bytes()).ok();
    child.wait_with_output().unwrap()
}

#[test]
fn it_draws_recordings_as_the_request_says() {
    let folder = tempfile::tempdir().unwrap();
    for (name, order) in [("jerk.parquet", 3), ("snap.parquet", 4)] {
        example(order).write_parquet(folder.path().join(name)).unwrap();
    }
    let one = answer(folder.path(), &["jerk.parquet"], "");
    assert!(one.status.success(), "{}", String::from_utf8_lossy(&one.stderr));
    let content = read(&one.stdout);
    assert!(content.documents[0].starts_with("no verdict is known"), "{:?}", content.documents);
    assert_views_are_fed(&content);

    let failed = Verdict { outcome: Outcome::Failed, reasons: vec!["too slow".into()], ..Verdict::default() };
    let options = ViewOptions { verdicts: vec![failed], max_instants: crate::MAX_INSTANTS, ..ViewOptions::default() };
    let request = Request { labels: vec!["jerk".into(), "snap".into()], options }.to_json().unwrap();
    let both = answer(folder.path(), &["jerk.parquet", "snap.parquet"], &request);
    assert!(both.status.success(), "{}", String::from_utf8_lossy(&both.stderr));
    let content = read(&both.stdout);
    assert!(content.entities.contains("/jerk/position/load") && content.entities.contains("/snap/position/load"));
    assert!(content.documents[0].starts_with("jerk: **FAILED**"), "{:?}", content.documents);
    assert_eq!(folder.path().read_dir().unwrap().count(), 2, "it writes no file");
}

#[test]
fn it_names_its_version_and_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    example(3).write_parquet(folder.path().join("a.parquet")).unwrap();
    std::fs::write(folder.path().join("b.parquet"), "no recording").unwrap();
    let version = answer(folder.path(), &["--version"], "");
    assert_eq!(String::from_utf8(version.stdout).unwrap(), format!("{VERSION}\n"));
    let later = r#"{"format": "servobench-view/2"}"#;
    let labelled = r#"{"format": "servobench-view/1", "labels": ["limit", "a"]}"#;
    for (arguments, request, said) in [
        (&[][..], "", "servobench-view: name a recording"),
        (&["--verison"], "", "there is no option `--verison`"),
        (&["none.parquet"], "", "none.parquet"),
        (&["b.parquet"], "", "`b.parquet` is not a Parquet file"),
        (&["a.parquet"], "{", "standard input is not a request"),
        (&["a.parquet"], later, "`servobench-view/2`"),
        (&["a.parquet", "a.parquet"], "", "2 recordings and 0 labels"),
        (&["a.parquet", "a.parquet"], labelled, "the label `limit`, which is reserved"),
    ] {
        let output = answer(folder.path(), arguments, request);
        let words = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {words}");
        assert!(words.contains(said) && output.stdout.is_empty(), "{said} in: {words}");
    }
}

/// Started by `servobench` it is contained: it ends with that, whatever it waits for.
#[cfg(target_os = "linux")]
#[test]
fn it_is_contained() {
    use servobench_isolation::{Contained, Limits, Program};
    let file = tempfile::tempfile().unwrap();
    let (stdin, to_stdin) = std::io::pipe().unwrap();
    let program =
        Program { program: PROGRAM.into(), args: vec![CONTAINED.into(), "none.parquet".into()], env: Vec::new() };
    let limits = Limits { memory: u64::MAX, is_foreign: false };
    let mut process = Contained::start(&program, stdin.into(), Some(file.into()), limits, || ()).unwrap();
    // It waits for its request.
    let ending = process.end().unwrap();
    assert!(!ending.is_orderly() && ending.status.and_then(|status| status.code()).is_none(), "{ending:?}");
    drop(to_stdin);
}
