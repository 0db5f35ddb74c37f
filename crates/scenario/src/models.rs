//! Motors, drives and axes by name: beside the scenario, in a folder above, or embedded.
use crate::access::{FileAccess, RELATIVE, Refused};
use crate::diagnostic::Report;
use crate::source::{Place, Sources};
use crate::tree::{self, Node, Table, Value};
use include_dir::{Dir, include_dir};
use servobench_files::{FileRole, suggestion};
use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

static MODELS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../../models");
static DEMO: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../../scenarios/demo");

/// Tables that can name a model, and the folders of `models/` that hold them.
const MODELLED: [(&str, &str, FileRole); 3] = [
    ("axis", "axes", FileRole::AxisModel),
    ("motor", "motors", FileRole::MotorModel),
    ("drive", "drives", FileRole::DriveModel),
];

/// Number of folders above the scenario's own that are searched for `models/`.
const LEVELS: usize = 4;

/// Prefix of the names of embedded files in messages.
pub(crate) const EMBEDDED: &str = "<embedded>";

/// The demo's scenarios from `scenarios/demo`: file name and text, in the order of names.
#[must_use]
pub fn embedded_demo() -> Vec<(&'static str, &'static str)> {
    texts(&DEMO, "toml")
}

/// The embedded models: path within `models/` and text, in the order of paths.
#[must_use]
pub fn embedded_models() -> Vec<(&'static str, &'static str)> {
    let mut all: Vec<_> = MODELS.dirs().flat_map(|folder| texts(folder, "toml")).collect();
    all.sort_unstable();
    all
}

/// The embedded file at `path` within `models/`: a model, or an MJCF file that a scenario may name.
#[must_use]
pub fn embedded_model(path: &str) -> Option<&'static str> {
    MODELS.get_file(path).and_then(include_dir::File::contents_utf8)
}

fn texts(folder: &'static Dir<'static>, extension: &str) -> Vec<(&'static str, &'static str)> {
    let wanted = folder.files().filter(|file| file.path().extension().is_some_and(|own| own == extension));
    let mut all: Vec<_> = wanted.filter_map(|file| Some((file.path().to_str()?, file.contents_utf8()?))).collect();
    all.sort_unstable();
    all
}

/// A model file.
struct Model {
    name: String,
    text: String,
    place: Place,
    /// True if it differs from the embedded model of the same name.
    displaces: bool,
}

/// Merges each table of `root` that names a model with that model; the table takes precedence. Syntax errors of model files go to
/// `syntax`; returns the lines that have them.
pub(crate) fn lay_on_models(
    root: &mut Table,
    sources: &mut Sources,
    report: &mut Report,
    syntax: &mut Report,
) -> Vec<(crate::SourceId, Range<usize>)> {
    let mut broken = Vec::new();
    for (key, folder, role) in MODELLED {
        let Some(Node { value: Value::Table(table), .. }) = root.get_mut(key) else { continue };
        let Some(Node { value: Value::Text(name), span }) = table.get("model") else { continue };
        let (name, span) = (name.clone(), *span);
        let model = match find((folder, role), &name, sources.place(span.source), &mut report.files) {
            Ok(model) => model,
            Err((message, help)) => {
                report.error(span, message, help);
                report.without_model.push(key);
                continue;
            }
        };
        if model.displaces {
            let message = format!("`{}` replaces the built-in model `{name}`, and differs from it", model.name);
            report.warning(span, message, "give it another name if the built-in one is meant");
        }
        let id = sources.add(model.name, model.text, model.place);
        let text = sources.text(id).to_owned();
        let parsed = tree::parse(id, &text, syntax);
        broken.extend(parsed.broken.into_iter().map(|line| (id, line)));
        let mut below = parsed.table;
        if let Some(entry) = below.entries.iter().find(|entry| entry.key == "model") {
            report.error(entry.key_span, "a model cannot be based on another model", "give its values here");
        }
        below.overlay(std::mem::take(table));
        *table = below;
    }
    broken
}

/// Finds a model; the error is a message and a help.
fn find(
    (folder, role): (&str, FileRole),
    name: &str,
    place: Option<&Place>,
    files: &mut FileAccess,
) -> Result<Model, (String, String)> {
    if name.is_empty() || !name.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c)) || name.starts_with('.')
    {
        return Err((format!("`{name}` is not a model name"), "a name has letters, digits, `-`, `_` and `.`".into()));
    }
    let file_name = format!("{name}.toml");
    let folders: Vec<PathBuf> = match place {
        Some(Place::Folder(base)) => {
            let within = upwards(base).filter(|above| files.has_folder(above));
            within.map(|above| above.join("models").join(folder)).collect()
        }
        _ => Vec::new(),
    };
    let built_in = Path::new(folder).join(&file_name);
    let built_in_text = MODELS.get_file(&built_in).and_then(include_dir::File::contents_utf8);
    for folder in &folders {
        let path = folder.join(&file_name);
        let refused = |Refused { message, help }| (message, if help == RELATIVE { "" } else { help }.to_owned());
        if !files.has_file(&path, role).map_err(refused)? {
            continue;
        }
        let text = files.text(&path, role).map_err(refused)?.to_string();
        let displaces = built_in_text.is_some_and(|built_in| built_in != text);
        return Ok(Model { name: path.display().to_string(), text, place: Place::Folder(folder.clone()), displaces });
    }
    if let Some(text) = built_in_text {
        let name = format!("{EMBEDDED}/models/{}", built_in.display());
        files.embedded(name.clone(), role, text);
        return Ok(Model { name, text: text.to_owned(), place: Place::Embedded(folder.into()), displaces: false });
    }
    let known = known(folder, &folders);
    Err((format!("unknown model `{name}` in `models/{folder}`"), suggestion(name, known.iter().map(String::as_str))))
}

/// The folder itself and [`LEVELS`] folders above it.
fn upwards(base: &Path) -> impl Iterator<Item = PathBuf> {
    std::iter::successors(Some(base.to_owned()), |folder| {
        let mut above = folder.clone();
        if folder.file_name().is_some() {
            above.pop();
        } else if folder.has_root() {
            return None;
        } else {
            above.push("..");
        }
        Some(above)
    })
    .take(LEVELS + 1)
}

/// Names of the models of one kind.
fn known(folder: &str, folders: &[PathBuf]) -> BTreeSet<String> {
    let on_disk = folders.iter().filter_map(|folder| std::fs::read_dir(folder).ok()).flatten().flatten();
    let embedded = MODELS.get_dir(folder).into_iter().flat_map(Dir::files).map(|file| file.path().to_owned());
    on_disk
        .map(|entry| entry.path())
        .chain(embedded)
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .collect()
}

/// Reads the text of `file`, named by a file at `place`; returns its path, for messages and for files it includes, and the text.
pub(crate) fn read_beside(
    file: &str,
    role: FileRole,
    place: &Place,
    files: &mut FileAccess,
) -> Result<(PathBuf, Arc<str>), Refused> {
    match place {
        Place::Folder(folder) => {
            let path = folder.join(file);
            files.text(&path, role).map(|text| (path, text))
        }
        Place::Embedded(folder) => {
            let path = folder.join(file);
            let Some(text) = MODELS.get_file(&path).and_then(include_dir::File::contents_utf8) else {
                let message = format!("missing embedded file `{}`", path.display());
                return Err(Refused { message, help: RELATIVE });
            };
            let path = Path::new(EMBEDDED).join("models").join(path);
            let text = files.embedded(path.display().to_string(), role, text);
            Ok((path, text))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_above_are_searched_also_from_relative_paths() {
        let all = |base: &str| upwards(Path::new(base)).map(|path| path.display().to_string()).collect::<Vec<_>>();
        assert_eq!(all("scenarios/demo"), ["scenarios/demo", "scenarios", "", "..", "../.."]);
        assert_eq!(all("../x"), ["../x", "..", "../..", "../../..", "../../../.."]);
        assert_eq!(all("/a/b"), ["/a/b", "/a", "/"]);
    }

    #[test]
    fn names_cannot_leave_the_folder() {
        for name in ["", "../motors/x", "a/b", ".hidden", "/etc/passwd", "C:x"] {
            let found = find(("motors", FileRole::MotorModel), name, None, &mut FileAccess::default());
            assert!(found.is_err_and(|(message, _)| message.contains("not a model name")));
        }
    }
}
