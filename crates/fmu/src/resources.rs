//! Resources of an FMU besides its library: part, scenario, and the models and tables named in the scenario.
//!
//! ```text
//! resources/contents.txt        the part, the place of the scenario, and its overrides, each on a line
//!          /scenario.toml       with as many folders before it as its tables are above it
//!          /models/…            the models named in it
//! ```
use crate::error::FmuError;
use crate::machine::Model;
use crate::part::Part;
use servobench_config::Choice as _;
use servobench_scenario::{Document, Loaded, Override};
use sha2::{Digest, Sha256};
use std::fmt::Write as _;
use std::fs;
use std::path::{Component, Path};

const CONTENTS: &str = "contents.txt";

/// The files, by their path within the folder, sorted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Resources {
    pub(crate) files: Vec<(String, String)>,
}

impl Resources {
    /// The resources of `part` of `loaded`.
    ///
    /// # Errors
    /// [`FmuError::Path`] for a table whose path is absolute or leads above four folders.
    pub(crate) fn of(part: Part, loaded: &Loaded) -> Result<Self, FmuError> {
        let sources = &loaded.sources;
        let mut files = vec![];
        let mut folders = Vec::new();
        for table in &loaded.tables {
            let above = steps_above(&table.named).ok_or_else(|| FmuError::Path { path: table.named.clone() })?;
            folders.resize(folders.len().max(above), "above");
        }
        let within = |path: &str| {
            let mut place = folders.clone();
            for component in path.split('/') {
                match component {
                    ".." => drop(place.pop()),
                    "." | "" => {}
                    name => place.push(name),
                }
            }
            place.join("/")
        };
        let scenario = within("scenario.toml");
        for id in sources.ids() {
            if id == sources.scenario() {
                files.push((scenario.clone(), sources.text(id).to_owned()));
            } else if let Some(model) = sources.model(id) {
                files.push((within(&format!("models/{model}")), sources.text(id).to_owned()));
            }
        }
        for table in &loaded.tables {
            files.push((within(&table.named), table.text.to_string()));
        }
        let overrides = loaded.scenario.overrides.iter().map(ToString::to_string);
        let contents: Vec<String> = [part.name().to_owned(), scenario].into_iter().chain(overrides).collect();
        files.push((CONTENTS.into(), contents.join("\n") + "\n"));
        files.sort();
        files.dedup();
        Ok(Self { files })
    }

    /// The resources in `folder`.
    ///
    /// # Errors
    /// The mistake, in words.
    pub(crate) fn read(folder: &Path) -> Result<Self, String> {
        let mut files = vec![];
        collect(folder, "", 0, &mut files)?;
        files.sort();
        Ok(Self { files })
    }

    /// The model built from the resources in `folder`.
    ///
    /// # Errors
    /// The mistake, in words.
    pub(crate) fn model(&self, folder: &Path) -> Result<Model, String> {
        let contents = self.files.iter().find(|(path, _)| path == CONTENTS).map(|(_, text)| text.lines());
        let mut lines = contents.ok_or_else(|| format!("there is no `{CONTENTS}` in `{}`", folder.display()))?;
        let part = lines.next().and_then(Part::from_name).ok_or_else(|| format!("`{CONTENTS}` names no part"))?;
        let scenario = lines.next().ok_or_else(|| format!("`{CONTENTS}` names no scenario"))?;
        let overrides: Result<Vec<Override>, _> = lines.map(str::parse).collect();
        let overrides = overrides.map_err(|error| format!("`{CONTENTS}`: {error}"))?;
        let loaded = Document::open(&folder.join(scenario), Some(folder))
            .and_then(|document| document.scenario(&overrides))
            .map_err(|error| error.to_string())?;
        Model::new(part, &loaded.scenario).map_err(|error| error.to_string())
    }

    /// Token by which library, description and resources recognise each other: the hash of the resources and of the version of
    /// this crate, in the form of a GUID.
    pub(crate) fn token(&self) -> String {
        let mut hash = Sha256::new();
        hash.update(env!("CARGO_PKG_VERSION"));
        for (path, text) in &self.files {
            for piece in [path, text] {
                hash.update((piece.len() as u64).to_le_bytes());
                hash.update(piece);
            }
        }
        let mut token = String::from("{");
        for (at, byte) in hash.finalize().iter().take(16).enumerate() {
            let dash = if [4, 6, 8, 10].contains(&at) { "-" } else { "" };
            let _ = write!(token, "{dash}{byte:02x}");
        }
        token + "}"
    }
}

/// Number of folders that a path leads above its own; `None` for one that is absolute or leads too far.
fn steps_above(path: &str) -> Option<usize> {
    let (mut depth, mut most) = (0_usize, 0_usize);
    for component in Path::new(path).components() {
        match component {
            Component::ParentDir if depth == 0 => most += 1,
            Component::ParentDir => depth -= 1,
            Component::Normal(_) => depth += 1,
            Component::CurDir => {}
            Component::RootDir | Component::Prefix(_) => return None,
        }
    }
    (most <= 4).then_some(most)
}

/// All files of `folder`, which is `prefix` within the whole.
fn collect(folder: &Path, prefix: &str, depth: usize, files: &mut Vec<(String, String)>) -> Result<(), String> {
    let failed = |error: &dyn std::fmt::Display| format!("cannot read `{}`: {error}", folder.display());
    if depth > 16 {
        return Err(failed(&"its folders are nested too deep"));
    }
    for entry in fs::read_dir(folder).map_err(|error| failed(&error))? {
        let entry = entry.map_err(|error| failed(&error))?;
        let name = entry.file_name().into_string().map_err(|_| failed(&"a name is no UTF-8"))?;
        let path = if prefix.is_empty() { name } else { format!("{prefix}/{name}") };
        if entry.file_type().map_err(|error| failed(&error))?.is_dir() {
            collect(&entry.path(), &path, depth + 1, files)?;
        } else {
            files.push((path, fs::read_to_string(entry.path()).map_err(|error| failed(&error))?));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_leads_above_as_often_as_it_goes_up_without_having_gone_down() {
        let cases =
            [("a.csv", Some(0)), ("x/../a.csv", Some(0)), ("../a.csv", Some(1)), ("x/../../y/../../a.csv", Some(2))];
        for (path, above) in cases {
            assert_eq!(steps_above(path), above, "{path}");
        }
        assert_eq!(steps_above("/etc/a.csv"), None);
        assert_eq!(steps_above("../../../../../a.csv"), None);
    }

    /// Oracle: the scenario itself. It is found with its table above it and its models in a separate folder, wherever it is
    /// unpacked, and the token is the same only for the same files.
    #[test]
    fn what_a_scenario_names_is_packed_where_it_is_looked_for() {
        let room = tempfile::tempdir().unwrap();
        let all = Path::new("../../scenarios/setpoints");
        let text = fs::read_to_string(all.join("pvt.toml")).unwrap().replace("\"points.csv\"", "\"../points.csv\"");
        let folder = room.path().join("a/b");
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("pvt.toml"), text).unwrap();
        fs::copy(all.join("points.csv"), room.path().join("a/points.csv")).unwrap();
        let load =
            |overrides: &[Override]| Document::open(&folder.join("pvt.toml"), Some(room.path()))?.scenario(overrides);
        let loaded = load(&[]).unwrap_or_else(|error| panic!("{error}"));
        let resources = Resources::of(Part::Axis, &loaded).unwrap();
        let names: Vec<&str> = resources.files.iter().map(|(path, _)| path.as_str()).collect();
        assert!(names.contains(&"above/scenario.toml") && names.contains(&"points.csv"), "{names:?}");
        assert!(names.iter().any(|name| name.starts_with("above/models/axes/")), "{names:?}");

        let elsewhere = tempfile::tempdir().unwrap();
        for (path, text) in &resources.files {
            let path = elsewhere.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let read = Resources::read(elsewhere.path()).unwrap();
        assert_eq!((&read, read.token()), (&resources, resources.token()));
        let model = read.model(elsewhere.path()).unwrap();
        assert_eq!(model.scenario.program, loaded.scenario.program);
        assert_eq!(model.scenario.axis, loaded.scenario.axis);

        // Overrides are packed as well, and make another FMU.
        let overrides = ["axis.load.mass=7 kg".parse().unwrap()];
        let overridden = load(&overrides).unwrap_or_else(|error| panic!("{error}"));
        let other = Resources::of(Part::Axis, &overridden).unwrap();
        assert_ne!(other.token(), resources.token());
        let model = other.model(elsewhere.path()).unwrap();
        assert_eq!(model.scenario.axis, overridden.scenario.axis);
        assert_ne!(model.scenario.axis, loaded.scenario.axis);

        fs::write(elsewhere.path().join("points.csv"), "t").unwrap();
        assert_ne!(Resources::read(elsewhere.path()).unwrap().token(), resources.token());
    }
}
