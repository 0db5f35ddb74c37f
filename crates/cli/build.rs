//! Lists the ready scenarios that the program embeds.
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// Folders of ready scenarios in the repository. The demo is embedded with the models.
const READY: [&str; 2] = ["scenarios", "scenarios-fmu"];
const DEMO: &str = "scenarios/demo";
/// Extensions of scenarios and the files that they name. FMUs beside them are made by commands stated in the scenarios.
const KINDS: [&str; 2] = ["toml", "csv"];

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=build.rs");
    let folder = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let repository = folder.join("../..").canonicalize()?;
    let mut files = Vec::new();
    for ready in READY {
        list(&repository.join(ready), &repository, &mut files)?;
    }
    files.sort();
    let mut text = String::from("&[\n");
    for file in &files {
        let (path, own) = (repository.join(file).display().to_string(), file.display().to_string().replace('\\', "/"));
        println!("cargo::rerun-if-changed={path}");
        let _ = writeln!(text, "    ({own:?}, include_str!({path:?})),");
    }
    text += "]\n";
    fs::write(PathBuf::from(env::var_os("OUT_DIR").unwrap_or_default()).join("ready.rs"), text)
}

/// Adds the files of `folder` and below, by their paths in the repository.
fn list(folder: &Path, repository: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    if folder.ends_with(DEMO) {
        return Ok(());
    }
    // An FMU that is made there must not start a build.
    if !folder.ends_with("scenarios-fmu") {
        println!("cargo::rerun-if-changed={}", folder.display());
    }
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            list(&path, repository, files)?;
        } else if path.extension().is_some_and(|own| KINDS.iter().any(|kind| own == *kind)) {
            files.extend(path.strip_prefix(repository).ok().map(Path::to_owned));
        }
    }
    Ok(())
}
