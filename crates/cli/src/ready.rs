//! Embedded ready scenarios: those in `scenarios` and `scenarios-fmu` of the repository, including the templates of `init`.
use crate::error::CliError;
use crate::sources::SWEEP;
use servobench_files::nearest;
use servobench_scenario::{embedded_demo, embedded_model, written_values};
use std::path::{Component, Path};

/// Tables, sweeps and scenarios without those of the demo: path in the repository, and text.
static FILES: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/ready.rs"));

/// Folder of most ready scenarios.
const SCENARIOS: &str = "scenarios";
/// Folder of the demo.
const DEMO: &str = "scenarios/demo";
/// Folder of the templates of `init`.
const TEMPLATES: &str = "scenarios/templates";
/// Beginning of the line that names the schema by its path in the repository.
const SCHEMA: &str = "#:schema ";

/// A ready scenario or sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Ready {
    /// Folder in the repository.
    folder: &'static str,
    file: &'static str,
    text: &'static str,
}

/// A ready scenario with all files that it names.
#[derive(Debug, Default)]
pub(crate) struct Written {
    /// Files to write beside each other, the scenario first: name and text.
    pub(crate) files: Vec<(String, String)>,
    /// Named files that are not embedded: FMUs.
    pub(crate) missing: Vec<String>,
}

/// Every ready scenario and sweep, sorted by folder and name.
pub(crate) fn all() -> Vec<Ready> {
    let demo = embedded_demo().into_iter().map(|(file, text)| Ready { folder: DEMO, file, text });
    let files = FILES.iter().filter_map(|(path, text)| {
        let (folder, file) = path.rsplit_once('/')?;
        is_kind(file, "toml").then_some(Ready { folder, file, text })
    });
    let mut all: Vec<Ready> = files.chain(demo).collect();
    // Folders within `scenarios` come before its neighbour.
    all.sort_by_cached_key(|ready| (ready.folder.replace('/', " "), ready.name()));
    all
}

/// The templates of `init`.
pub(crate) fn templates() -> impl Iterator<Item = Ready> {
    all().into_iter().filter(|ready| ready.folder == TEMPLATES)
}

/// The scenario called `name`: `figure-3b`, `plc/figure-3b`, or its path in the repository.
///
/// # Errors
/// Lists possible names when none or several match.
pub(crate) fn named(name: &str) -> Result<Ready, CliError> {
    let asked = name.trim_start_matches("scenarios/").trim_end_matches(".toml").trim_end_matches(".sweep");
    let all = all();
    if let Some(exact) = all.iter().find(|ready| ready.full_name() == asked) {
        return Ok(*exact);
    }
    let found: Vec<&Ready> = all.iter().filter(|ready| ready.name() == asked).collect();
    if let [one] = found.as_slice() {
        return Ok(**one);
    }
    if !found.is_empty() {
        let names = found.iter().map(|ready| ready.full_name()).collect();
        return Err(CliError::Several { what: "ready scenarios", name: name.to_owned(), names });
    }
    let names: Vec<String> = all.iter().flat_map(|ready| [ready.full_name(), ready.name().to_owned()]).collect();
    let help = match nearest(asked, names.iter().map(String::as_str)) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "`servobench examples` lists them".to_owned(),
    };
    Err(CliError::NoSuch { what: "ready scenario", name: name.to_owned(), help })
}

impl Ready {
    /// Its folder below `scenarios`; `scenarios` itself and `scenarios-fmu` by their own names.
    pub(crate) fn folder(&self) -> &'static str {
        self.folder.strip_prefix("scenarios/").unwrap_or(self.folder)
    }

    /// Its name in that folder: `figure-3b`.
    pub(crate) fn name(&self) -> &'static str {
        let name = self.file.trim_end_matches(".toml");
        name.trim_end_matches(".sweep")
    }

    /// Folder and name, which together are unique.
    fn full_name(&self) -> String {
        if self.folder == SCENARIOS { self.name().to_owned() } else { format!("{}/{}", self.folder(), self.name()) }
    }

    /// Its path in the repository.
    fn path(&self) -> String {
        format!("{}/{}", self.folder, self.file)
    }

    /// True for a sweep.
    pub(crate) fn is_sweep(&self) -> bool {
        self.file.ends_with(SWEEP)
    }

    /// Its description.
    pub(crate) fn description(&self) -> String {
        let value = written_values(self.text).into_iter().find(|(key, _)| key == "description");
        value.map(|(_, text)| text).unwrap_or_default()
    }

    /// The scenario and every file that it names, with paths adapted to one folder.
    pub(crate) fn written(&self) -> Written {
        let mut written = Written::default();
        gather(&self.path(), self.text, &mut written);
        written
    }
}

/// Adds the file at `path` of the repository and those that it names: all in one folder, with names in the text adapted.
fn gather(path: &str, text: &str, written: &mut Written) {
    let mut text =
        text.split_once('\n').filter(|(first, _)| first.starts_with(SCHEMA)).map_or(text, |(_, rest)| rest).to_owned();
    let place = written.files.len();
    written.files.push((file_name(path).to_owned(), String::new()));
    // Tables and MJCF files name no others.
    let values = if is_kind(path, "toml") { written_values(&text) } else { Vec::new() };
    for (_, value) in values {
        let named = beside(path, &value);
        let name = file_name(&named);
        let is_known = written.files.iter().any(|(known, _)| known == name);
        match embedded(&named) {
            Some(inner) => {
                text = text.replace(&format!("\"{value}\""), &format!("\"{name}\""));
                if !is_known {
                    gather(&named, inner, written);
                }
            }
            None if is_kind(&value, "fmu") && !written.missing.contains(&value) => written.missing.push(value),
            _ => {}
        }
    }
    written.files[place].1 = text;
}

/// The embedded file at `path` of the repository.
fn embedded(path: &str) -> Option<&'static str> {
    let file = FILES.iter().find(|(own, _)| *own == path).map(|(_, text)| *text);
    file.or_else(|| embedded_model(path.strip_prefix("models/")?))
}

/// The path of `named`, which the file at `path` names.
fn beside(path: &str, named: &str) -> String {
    let mut parts: Vec<&str> = path.split('/').collect();
    parts.pop();
    for component in Path::new(named).components() {
        match component {
            Component::ParentDir => drop(parts.pop()),
            Component::Normal(part) => parts.extend(part.to_str()),
            _ => {}
        }
    }
    parts.join("/")
}

/// True where the name of the file at `path` ends with this kind.
fn is_kind(path: &str, kind: &str) -> bool {
    Path::new(path).extension().is_some_and(|own| own == kind)
}

fn file_name(path: &str) -> &str {
    path.rsplit_once('/').map_or(path, |(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_scenario::{load, load_sweep};
    use std::collections::HashSet;

    #[test]
    fn names_are_full_or_unambiguous() {
        assert_eq!(named("figure-3b").unwrap().path(), "scenarios/plc/figure-3b.toml");
        assert_eq!(named("scenarios/plc/figure-3b.toml").unwrap(), named("plc/figure-3b").unwrap());
        assert_eq!(named("emps").unwrap().folder(), "scenarios");
        assert!(named("jerk-or-snap").unwrap().is_sweep());
        let wrong = |name: &str| named(name).unwrap_err().to_string();
        insta::assert_snapshot!(
            wrong("buffred"),
            @"there is no ready scenario `buffred`: did you mean `buffered`?"
        );
        insta::assert_snapshot!(
            wrong("dc-link-sag"),
            @"there are several ready scenarios `dc-link-sag`: hardware/dc-link-sag, hardware/faults/dc-link-sag; name the folder, too"
        );
        insta::assert_snapshot!(
            wrong("x"),
            @"there is no ready scenario `x`: `servobench examples` lists them"
        );
    }

    #[test]
    fn every_file_of_the_folders_is_embedded_once() {
        let all = all();
        let paths: HashSet<String> = all.iter().map(Ready::path).collect();
        assert_eq!(paths.len(), all.len());
        let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let mut folders = vec![repository.join(SCENARIOS), repository.join("scenarios-fmu")];
        let mut count = 0;
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|kind| kind == "toml") {
                    let own = path.strip_prefix(&repository).unwrap().to_str().unwrap();
                    assert!(paths.contains(own), "{own}: touch crates/cli/build.rs");
                    count += 1;
                }
            }
        }
        assert_eq!(count, all.len());
    }

    /// The folder holds only the written files, not the repository.
    #[test]
    fn every_one_loads_from_an_empty_folder() {
        for ready in all() {
            let folder = tempfile::tempdir().unwrap();
            let Written { files, missing } = ready.written();
            for (name, text) in &files {
                std::fs::write(folder.path().join(name), text).unwrap();
            }
            let path = folder.path().join(&files[0].0);
            assert_eq!(missing.is_empty(), ready.folder() != "scenarios-fmu", "{}", ready.path());
            assert!(!ready.description().is_empty() && !files[0].1.contains(SCHEMA), "{}", ready.path());
            if ready.is_sweep() {
                load_sweep(&path).unwrap_or_else(|error| panic!("{}: {error}", ready.path()));
            } else if missing.is_empty() {
                load(&path).unwrap_or_else(|error| panic!("{}: {error}", ready.path()));
            }
        }
    }
}
