//! Doors to the operating system: the few folders that may call it by other names than those of `std`.
//!
//! Tests may call it, too: they make FIFOs and send signals. So may the commands of this crate, which run on a developer's machine.
use std::path::Path;

/// Folders that may call the operating system.
const DOORS: [&str; 4] = [
    "crates/files/src/sys/",
    "crates/isolation/src/sys/",
    "crates/fmi/src/library/",
    "crates/engine-mujoco/src/library.rs",
];
/// Packages that may depend on crates of the operating system: those with a door, and the one that only chooses features.
const WITH_CRATES: [&str; 5] =
    ["crates/files/", "crates/isolation/", "crates/fmi/", "crates/engine-mujoco/", "crates/features/"];
/// Packages that are not part of the program: this one, and one for a machine without operating system.
const APART: [&str; 2] = ["crates/xtask/", "crates/bare-metal/"];
/// Folders of tests, and files of them.
const TESTS: [&str; 4] = ["tests/", "benches/", "examples/", "tests.rs"];

/// Crates that call an operating system.
const CRATES: [&str; 8] = ["libc", "libloading", "memmap2", "nix", "rustix", "signal_hook", "winapi", "windows_sys"];
/// Other names that exist on only one kind of operating system.
const NAMES: [&str; 5] = ["std::os::", "os::unix", "os::fd", "pre_exec", "CommandExt"];
/// Words of a condition on the operating system.
const CONDITIONS: [&str; 5] = ["unix", "windows", "target_os", "target_family", "target_env"];
/// Folders, as quoted in source, that exist on only one kind of operating system.
const FOLDERS: [&str; 3] = ["\"/proc", "\"/dev", "\"/sys"];

/// One line per call of the operating system in `text`, of the tracked file `file`, outside of the doors.
pub(super) fn findings(file: &Path, text: &str) -> Vec<String> {
    let name = file.to_string_lossy();
    let is_among = |folders: &[&str]| folders.iter().any(|folder| name.starts_with(folder));
    let is_test = TESTS.iter().any(|part| name.starts_with(part) || name.contains(&format!("/{part}")));
    if !name.starts_with("crates/") || is_among(&APART) || is_test {
        return Vec::new();
    }
    let found = match file.extension().and_then(|extension| extension.to_str()) {
        Some("toml") if name.ends_with("/Cargo.toml") && !is_among(&WITH_CRATES) => in_manifest(text),
        Some("rs") if !is_among(&DOORS) => in_source(text),
        _ => Vec::new(),
    };
    let doors = DOORS.map(|door| format!("`{}`", door.trim_end_matches('/'))).join(", ");
    let finding =
        |(line, call)| format!("{name}:{line}: `{call}` belongs behind a door to the operating system: {doors}");
    found.into_iter().map(finding).collect()
}

/// Calls in the Rust source, each with its line: the first of every line, without comments and the tests at its end.
fn in_source(text: &str) -> Vec<(usize, &'static str)> {
    let lines = text.lines().enumerate().take_while(|(_, line)| *line != "mod tests {");
    let code = lines.filter(|(_, line)| !line.trim_start().starts_with("//") && !line.contains("cfg(all(test,"));
    code.filter_map(|(number, line)| Some((number + 1, call(line)?))).collect()
}

fn call(line: &str) -> Option<&'static str> {
    let is_condition = line.contains("cfg(") || line.contains("cfg_attr(") || line.contains("cfg!(");
    let of_crate = CRATES.into_iter().find(|name| words(line, name).any(|rest| rest.starts_with("::")));
    let condition = || CONDITIONS.into_iter().find(|name| is_condition && words(line, name).next().is_some());
    let name = || NAMES.into_iter().chain(FOLDERS).find(|name| line.contains(name));
    of_crate.or_else(condition).or_else(name)
}

/// The rest of `line` behind each occurrence of `word` as a whole word.
fn words<'a>(line: &'a str, word: &'a str) -> impl Iterator<Item = &'a str> {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    line.match_indices(word).filter_map(move |(at, _)| {
        let rest = &line[at + word.len()..];
        (!line[..at].ends_with(is_part) && !rest.starts_with(is_part)).then_some(rest)
    })
}

/// Dependencies of the program on crates of an operating system in the text of a manifest, and conditions on one.
fn in_manifest(text: &str) -> Vec<(usize, &'static str)> {
    let mut section = "";
    let mut found = Vec::new();
    for (number, line) in text.lines().enumerate() {
        section = if line.starts_with('[') { line } else { section };
        if section.contains("dev-dependencies") {
            continue;
        }
        let name = line.split(['.', ' ', '=']).next().unwrap_or_default().replace('-', "_");
        let dependency = CRATES.into_iter().find(|one| *one == name);
        found.extend(dependency.or_else(|| call(line)).map(|call| (number + 1, call)));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn calls(file: &str, text: &str) -> Vec<String> {
        let found = findings(file.as_ref(), text);
        found.iter().map(|line| line.split(" belongs").next().unwrap().to_owned()).collect()
    }

    #[test]
    fn a_call_is_found_with_its_line_and_not_in_a_door() {
        for (line, call) in [
            ("use rustix::fs::OFlags;", "rustix"),
            ("    unsafe { libc::fork() };", "libc"),
            ("use std::os::unix::fs::symlink;", "std::os::"),
            ("#[cfg(unix)]", "unix"),
            ("#[cfg(all(not(windows), feature = \"fmu\"))]", "windows"),
            ("    if cfg!(target_os = \"linux\") {", "target_os"),
            ("command.pre_exec(|| Ok(()));", "pre_exec"),
            ("let own = Path::new(\"/proc/self\");", "\"/proc"),
        ] {
            let text = format!("//! Text.\n{line}\n");
            assert_eq!(calls("crates/cli/src/a.rs", &text), [format!("crates/cli/src/a.rs:2: `{call}`")], "{line}");
            for fine in ["files/src/sys/unix.rs", "isolation/src/sys/linux/a.rs", "fmi/src/library/open.rs"] {
                assert!(calls(&format!("crates/{fine}"), &text).is_empty(), "{fine}: {line}");
            }
            assert_eq!(calls("crates/files/src/regular.rs", &text).len(), 1, "{line}");
        }
    }

    #[test]
    fn what_is_not_a_call_is_not_found() {
        for line in [
            "/// On Linux `libc::fork` does that.",
            "let unix = text.contains(\"windows\");",
            "#[cfg(feature = \"fmu\")]",
            "let command = std::process::Command::new(viewer);",
            "mod tests {\n    use rustix::fs::OFlags;",
            "#[cfg(all(test, unix))]",
            "my_libc::call();",
        ] {
            assert!(calls("crates/cli/src/a.rs", line).is_empty(), "{line}");
        }
        let call = "libc::fork();";
        for file in ["crates/cli/tests/a.rs", "tests/a.rs", "crates/fmi/examples/a.rs", "crates/xtask/src/a.rs", "a.md"]
        {
            assert!(calls(file, call).is_empty(), "{file}");
        }
    }

    #[test]
    fn a_dependency_is_found_and_one_of_tests_is_not() {
        let text = "[dependencies]\nserde.workspace = true\nsignal-hook.workspace = true\n\
                    [target.'cfg(unix)'.dependencies]\n[dev-dependencies]\nrustix = \"1\"\n";
        let found = calls("crates/cli/Cargo.toml", text);
        assert_eq!(found, ["crates/cli/Cargo.toml:3: `signal_hook`", "crates/cli/Cargo.toml:4: `unix`"]);
        assert!(calls("crates/isolation/Cargo.toml", text).is_empty());
    }
}
