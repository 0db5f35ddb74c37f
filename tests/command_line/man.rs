//! `servobench man`
use crate::{code, said, servobench};
use std::fs;

#[test]
fn there_is_a_page_for_each_command_of_users() {
    let work = tempfile::tempdir().unwrap();
    let folder = work.path().join("man1");
    let output = servobench(&["man", "--out", folder.to_str().unwrap()]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    let mut names: Vec<_> =
        fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    for name in
        ["servobench.1", "servobench-run.1", "servobench-plan.1", "servobench-plan-rockwell.1", "servobench-man.1"]
    {
        assert!(names.iter().any(|own| own == name), "{name} in {names:?}");
    }
    assert!(
        !names.iter().any(|name| name.contains("worker") || name.contains("host") || name.contains("help")),
        "{names:?}"
    );
    let run = fs::read_to_string(folder.join("servobench-run.1")).unwrap();
    for expected in [".TH servobench-run 1", "keep", "jerk", "MOVE is the set"] {
        assert!(run.contains(expected), "{expected} in:\n{run}");
    }
    let whole = fs::read(folder.join("servobench.1")).unwrap();
    assert_eq!(servobench(&["man"]).stdout, whole, "the page of the program is that on standard output");
}
