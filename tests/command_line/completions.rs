//! `servobench completions`
use crate::{code, said, servobench};
use std::fs;
use std::process::Command;

fn script(shell: &str) -> String {
    let output = servobench(&["completions", shell]);
    assert_eq!(code(&output), 0, "{}", said(&output));
    String::from_utf8(output.stdout).unwrap()
}

/// Commands that the program starts itself are nobody's to type.
#[test]
fn every_shell_completes_the_commands_of_users() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = script(shell);
        assert!(script.contains("compare") && script.contains("worker-timeout") && script.contains("keep"), "{shell}");
        assert!(!script.contains("fmu-host") && !script.contains("durations"), "{shell}");
    }
    let unknown = servobench(&["completions", "tcsh"]);
    assert!(code(&unknown) == 2 && said(&unknown).contains("bash"), "{}", said(&unknown));
}

/// Oracle: bash itself.
#[cfg(unix)]
#[test]
fn bash_completes_commands_options_and_values() {
    let file = tempfile::NamedTempFile::new().unwrap();
    fs::write(file.path(), script("bash")).unwrap();
    let completed = |line: &str| {
        let words: Vec<&str> = line.split(' ').collect();
        let (last, before) = (words[words.len() - 1], words[words.len() - 2]);
        let ask = format!(
            "source {}; COMP_WORDS=({line}); COMP_CWORD={}; _servobench servobench '{last}' '{before}'; echo ${{COMPREPLY[@]}}",
            file.path().display(),
            words.len() - 1
        );
        // Not every machine has it.
        let output = Command::new("bash").args(["--norc", "-c", &ask]).output().ok()?;
        Some(String::from_utf8(output.stdout).unwrap().trim().to_owned())
    };
    for (line, expected) in [
        ("servobench ru", "run"),
        ("servobench comp", "compare completions"),
        ("servobench run --worker", "--worker-timeout"),
        ("servobench run --keep f", "failed"),
        ("servobench plan rock", "rockwell"),
        ("servobench objects --format e", "eds"),
    ] {
        assert!(completed(line).is_none_or(|found| found == expected), "{line}: {:?}", completed(line));
    }
}
