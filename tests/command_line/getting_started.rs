//! `docs/getting-started.md` as a new user follows it: its files in an empty folder, its commands as printed, and what they print.
//!
//! `SERVOBENCH_WRITE_DOCS=1 cargo test -p servobench-cli --test command_line getting_started` writes the outputs anew.
use crate::repository;
use std::fmt::Write as _;
use std::fs;
use std::process::{Command, Output};

const PAGE: &str = "docs/getting-started.md";

/// A part of the page.
enum Part {
    /// Text, with its fences.
    Text(String),
    /// A file that the user writes, or that a command before it has written.
    File { name: String, text: String },
    /// Commands, each with what it prints.
    Session(Vec<(String, String)>),
}

/// The parts of the page: a fence `toml` below a line that is a file's name in bold is that file, a fence `console` a session.
fn parts(page: &str) -> Vec<Part> {
    let mut parts = Vec::new();
    let (mut text, mut lines) = (String::new(), page.lines().peekable());
    let mut name = None;
    while let Some(line) = lines.next() {
        let fence = line.strip_prefix("```");
        match (fence, name.take()) {
            (Some(kind), file) if !kind.is_empty() => {
                let body: Vec<&str> = lines.by_ref().take_while(|line| *line != "```").collect();
                let body = body.iter().fold(String::new(), |body, line| body + line + "\n");
                parts.push(Part::Text(std::mem::take(&mut text)));
                match (kind, file) {
                    ("toml", Some(name)) => parts.push(Part::File { name, text: body }),
                    ("console", _) => parts.push(Part::Session(session(&body))),
                    _ => parts.push(Part::Text(format!("{line}\n{body}```\n"))),
                }
            }
            (_, file) => {
                // A blank line may stand between the name and the fence.
                name = line.strip_prefix("**`").and_then(|rest| rest.strip_suffix("`**")).map(str::to_owned);
                name = name.or(file.filter(|_| line.is_empty()));
                text = text + line + "\n";
            }
        }
    }
    parts.push(Part::Text(text));
    parts
}

/// The commands of a session, which begin with `$`, and what follows each.
fn session(body: &str) -> Vec<(String, String)> {
    let mut commands: Vec<(String, String)> = Vec::new();
    for line in body.lines() {
        match (line.strip_prefix("$ "), commands.last_mut()) {
            (Some(command), _) => commands.push((command.to_owned(), String::new())),
            (None, Some((_, output))) => *output = format!("{output}{line}\n"),
            (None, None) => panic!("{PAGE}: `{line}` is printed by no command"),
        }
    }
    commands
}

fn written(parts: &[Part]) -> String {
    let mut page = String::new();
    for part in parts {
        match part {
            Part::Text(text) => page += text,
            Part::File { text, .. } => write!(page, "```toml\n{text}```\n").unwrap(),
            Part::Session(commands) => {
                page += "```console\n";
                for (command, output) in commands {
                    write!(page, "$ {command}\n{output}").unwrap();
                }
                page += "```\n";
            }
        }
    }
    page
}

/// What a user sees who types `command` in `folder`; with the exit code where it is not zero.
fn typed(command: &str, folder: &std::path::Path) -> String {
    let words = shlex::split(command).unwrap_or_default();
    assert_eq!(words.first().map(String::as_str), Some("servobench"), "{command}");
    let program = env!("CARGO_BIN_EXE_servobench");
    let output: Output = Command::new(program)
        .args(&words[1..])
        .current_dir(folder)
        .env("COLUMNS", "80")
        .env_remove("NO_COLOR")
        .output()
        .unwrap();
    // Progress, with its times, goes to standard error.
    let mut text = String::from_utf8_lossy(&output.stdout).replace(program, "servobench");
    match output.status.code() {
        Some(0) => {}
        code => writeln!(text, "(exit code {})", code.unwrap()).unwrap(),
    }
    text
}

#[test]
fn each_command_prints_what_the_page_says() {
    let path = repository().join(PAGE);
    let page = fs::read_to_string(&path).unwrap();
    let mut parts = parts(&page);
    assert_eq!(written(&parts), page, "the page is read whole");
    let folder = tempfile::tempdir().unwrap();
    let mut commands = 0;
    for part in &mut parts {
        match part {
            Part::Text(_) => {}
            Part::File { name, text } => {
                let path = folder.path().join(name);
                match fs::read_to_string(&path) {
                    // A command has written it.
                    Ok(written) => *text = written,
                    Err(_) => fs::write(path, text).unwrap(),
                }
            }
            Part::Session(session) => {
                for (command, output) in session {
                    *output = typed(command, folder.path());
                    commands += 1;
                }
            }
        }
    }
    assert!(commands >= 5, "{commands}");
    let found = written(&parts);
    if std::env::var_os("SERVOBENCH_WRITE_DOCS").is_some() {
        fs::write(&path, &found).unwrap();
    }
    assert!(
        found == page,
        "{PAGE} is not what its commands print; write it anew as the head of this test says:\n{found}"
    );
}
