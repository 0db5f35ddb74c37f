//! `docs/compare.md`: its commands print what stands there.
//!
//! `SERVOBENCH_WRITE_DOCS=1 cargo test -p servobench-cli --test command_line documented` writes the outputs anew.
use super::{compare, fits};
use crate::{repository, said};
use std::fs;

const FENCE: &str = "```console\n$ servobench compare ";

#[test]
fn the_page_shows_what_its_commands_print() {
    let path = repository().join("docs/compare.md");
    let page = fs::read_to_string(&path).unwrap();
    let work = tempfile::tempdir().unwrap();
    let mut parts = page.split(FENCE);
    let mut written = parts.next().unwrap().to_owned();
    let mut sessions = 0;
    for part in parts {
        let (session, text) = part.split_once("```").unwrap();
        let command = session.lines().next().unwrap();
        let arguments: Vec<&str> = command.split_whitespace().collect();
        let output = compare(&work.path().join("out"), &arguments);
        let printed = String::from_utf8(output.stdout.clone()).unwrap();
        fits(&printed);
        // The last line is the folder of this test.
        let printed = printed.rsplit_once("look at it: ").unwrap_or_else(|| panic!("{}", said(&output))).0.trim_end();
        written.extend([FENCE, command, "\n", printed, "\n```", text]);
        sessions += 1;
    }
    assert_eq!(sessions, 2);
    if std::env::var_os("SERVOBENCH_WRITE_DOCS").is_some() {
        fs::write(&path, &written).unwrap();
    }
    assert_eq!(fs::read_to_string(&path).unwrap(), written);
}
