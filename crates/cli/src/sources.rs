//! Scenario files: from files, from folders, or the demo that is embedded.
use crate::console::say;
use crate::diagnostics::{mistakes, render};
use crate::exit::CliError;
use miette::Severity;
use servobench_scenario::{LoadError, Loaded};
use servobench_suite::Source;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// The scenario files that `paths` name; folders are searched for `.toml` files, sorted by path. Folders called
/// `models` hold no scenarios.
pub(crate) fn files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, CliError> {
    let mut files = Vec::new();
    for path in paths {
        if path.is_dir() {
            let before = files.len();
            search(path, &mut files)?;
            if files.len() == before {
                return Err(CliError::Input(format!("there is no scenario (`*.toml`) in `{}`", path.display())));
            }
        } else {
            files.push(path.clone());
        }
    }
    Ok(files)
}

fn search(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), CliError> {
    let wrong = |error: std::io::Error| CliError::Input(format!("cannot read `{}`: {error}", folder.display()));
    let mut entries = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(wrong)? {
        entries.push(entry.map_err(wrong)?.path());
    }
    entries.sort();
    for entry in entries {
        if entry.is_dir() && entry.file_name() != Some(OsStr::new("models")) {
            search(&entry, files)?;
        } else if entry.extension() == Some(OsStr::new("toml")) {
            files.push(entry);
        }
    }
    Ok(())
}

/// Loads every file; the mistakes of all of them are reported together, and warnings go to standard error.
pub(crate) fn load(paths: &[PathBuf]) -> Result<Vec<Source>, CliError> {
    collect(files(paths)?.iter().map(|path| read(path)))
}

/// Loads one file.
pub(crate) fn read(path: &Path) -> Result<Loaded, CliError> {
    shown(servobench_scenario::load(path))
}

/// The embedded demo.
pub(crate) fn demo() -> Result<Vec<Source>, CliError> {
    let demo = servobench_scenario::embedded_demo();
    collect(demo.into_iter().map(|(name, text)| shown(servobench_scenario::parse(name, text, None))))
}

fn collect(loaded: impl Iterator<Item = Result<Loaded, CliError>>) -> Result<Vec<Source>, CliError> {
    let (mut sources, mut mistakes) = (Vec::new(), Vec::new());
    for loaded in loaded {
        match loaded {
            Ok(loaded) => {
                let text = loaded.sources.text(loaded.sources.scenario()).to_owned();
                sources.push(Source { scenario: loaded.scenario, text });
            }
            Err(error) => mistakes.push(error.to_string()),
        }
    }
    if mistakes.is_empty() { Ok(sources) } else { Err(CliError::Input(mistakes.join("\n"))) }
}

/// Prints the warnings and renders the mistakes.
fn shown(loaded: Result<Loaded, LoadError>) -> Result<Loaded, CliError> {
    match loaded {
        Ok(loaded) => {
            if !loaded.warnings.is_empty() {
                say(&render(&loaded.warnings, &loaded.sources, Severity::Warning));
            }
            Ok(loaded)
        }
        Err(LoadError::Invalid(invalid)) => Err(CliError::Input(mistakes(&invalid.diagnostics, &invalid.sources))),
        Err(error @ LoadError::Read { .. }) => Err(CliError::Input(error.to_string())),
    }
}
