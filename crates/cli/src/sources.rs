//! Scenario files: from files, from folders, from standard input, or the demo that is embedded.
use crate::args::OverrideArgs;
use crate::console::say;
use crate::diagnostics::{mistakes, render};
use crate::error::CliError;
use crate::fmu_trust::trusted;
use crate::outputs::{reads, reads_stdin};
use miette::Severity;
use servobench_files::FileId;
use servobench_scenario::{Document, LoadError, Loaded, MOST_OF_A_SCENARIO, Override, root_of};
use servobench_suite::Source;
use std::collections::HashSet;
use std::ffi::OsStr;
use std::fmt;
use std::io::{ErrorKind, IsTerminal, Read};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// Standard input among the scenarios.
const STDIN: &str = "-";
/// Name of a scenario from standard input, and of its text in messages.
const NAME_OF_STDIN: &str = "stdin";

/// Suffix of sweep files, which lie beside scenarios.
pub(crate) const SWEEP: &str = ".sweep.toml";

/// Text from standard input, or in its place: it can be read only once.
static TEXT_OF_STDIN: OnceLock<String> = OnceLock::new();

/// The text from standard input, if it was read.
pub(crate) fn stdin() -> Option<String> {
    TEXT_OF_STDIN.get().cloned()
}

/// Sets `text` in place of standard input.
pub(crate) fn give_stdin(text: String) {
    // Text that was read already stays.
    TEXT_OF_STDIN.set(text).ok();
}

/// True if `path` means standard input.
pub(crate) fn is_stdin(path: &Path) -> bool {
    path.as_os_str() == STDIN
}

/// The name of `path` in messages.
pub(crate) fn named(path: &Path) -> String {
    if is_stdin(path) { NAME_OF_STDIN.to_owned() } else { path.display().to_string() }
}

/// The scenario files that `paths` name; folders are searched for `.toml` files, sorted by path. Folders called
/// `models` hold no scenarios. Links are followed within the root of the named folder, and each folder is searched once.
pub(crate) fn files(paths: &[PathBuf], root: Option<&Path>) -> Result<Vec<PathBuf>, CliError> {
    if paths.iter().filter(|path| is_stdin(path)).count() > 1 {
        return Err(CliError::StdinTwice);
    }
    let mut files = Vec::new();
    for path in paths {
        if path.is_dir() && !is_stdin(path) {
            let before = files.len();
            let wrong = |error| CliError::Read { path: root.unwrap_or(path).to_owned(), error };
            let mut searched = Searched { root: root_of(path, root).map_err(wrong)?, folders: HashSet::new() };
            searched.search(path, &mut files)?;
            if files.len() == before {
                return Err(CliError::NoScenario { folder: path.clone() });
            }
        } else {
            files.push(path.clone());
        }
    }
    Ok(files)
}

/// True if the file at `path` is a sweep, by its name.
fn is_sweep(path: &Path) -> bool {
    path.file_name().and_then(OsStr::to_str).is_some_and(|name| name.ends_with(SWEEP))
}

/// Folders that were searched: a link may lead back to one of them.
struct Searched {
    /// Boundary of the search.
    root: PathBuf,
    folders: HashSet<FileId>,
}

impl Searched {
    fn search(&mut self, folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), CliError> {
        let wrong = |error| CliError::Read { path: folder.to_owned(), error };
        // A system without identifiers of folders has no such links.
        if FileId::of(folder).is_ok_and(|id| !self.folders.insert(id)) {
            return Ok(());
        }
        let mut entries = Vec::new();
        for entry in std::fs::read_dir(folder).map_err(wrong)? {
            entries.push(entry.map_err(wrong)?.path());
        }
        entries.sort();
        for entry in entries {
            if entry.is_dir() && entry.file_name() != Some(OsStr::new("models")) {
                if entry.canonicalize().is_ok_and(|real| real.starts_with(&self.root)) {
                    self.search(&entry, files)?;
                } else {
                    let (entry, root) = (entry.display(), self.root.display());
                    say(&format!(
                        "`{entry}` is not searched: it leads out of `{root}`; `--root DIR` allows a folder that holds both\n"
                    ));
                }
            } else if entry.extension() == Some(OsStr::new("toml")) && !is_sweep(&entry) {
                files.push(entry);
            }
        }
        Ok(())
    }
}

/// Loads every file; the mistakes of all of them are reported together, and warnings go to standard error.
pub(crate) fn load(paths: &[PathBuf], with: &OverrideArgs) -> Result<Vec<Source>, CliError> {
    let mut mistakes = Vec::new();
    let mut sources = Vec::new();
    for found in each(paths, with)? {
        match found? {
            Ok(source) => sources.push(source),
            Err(unusable) => mistakes.push(unusable),
        }
    }
    if mistakes.is_empty() { Ok(sources) } else { Err(CliError::Scenarios(mistakes)) }
}

/// A file that cannot be used, and why.
#[derive(Debug)]
pub(crate) struct Unusable {
    /// The file.
    pub(crate) path: PathBuf,
    error: LoadError,
}

impl Unusable {
    /// Mistakes, one line each.
    pub(crate) fn reasons(&self) -> Vec<String> {
        reasons(&self.error)
    }
}

/// Reasons why a scenario could not be loaded, one line for each mistake.
pub(crate) fn reasons(error: &LoadError) -> Vec<String> {
    match error {
        LoadError::Invalid(invalid) => invalid.lines(),
        error @ LoadError::Read { .. } => vec![error.to_string()],
    }
}

/// All mistakes as readable text, with an empty line at the end.
impl fmt::Display for Unusable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let end = if matches!(self.error, LoadError::Read { .. }) { "\n" } else { "" };
        write!(f, "{}{end}", told(&self.error))
    }
}

/// Loads every file by itself, when its turn comes: an unusable one does not stop the others.
pub(crate) fn each(
    paths: &[PathBuf],
    with: &OverrideArgs,
) -> Result<impl Iterator<Item = Result<Result<Source, Unusable>, CliError>>, CliError> {
    let files = files(paths, with.root.as_deref())?;
    Ok(files.into_iter().map(|path| match loaded(&path, with).and_then(trusted) {
        Ok(loaded) => {
            warn(&loaded);
            Ok(Ok(source(loaded)))
        }
        // A suite whose scenarios cannot be read for lack of resources would be another one when they can.
        Err(error) if error.is_shortage() => Err(CliError::Shortage(error)),
        Err(error) => Ok(Err(Unusable { path, error })),
    }))
}

/// Reads a file again, without noting it or repeating its warnings.
pub(crate) fn again(path: &Path, with: &OverrideArgs) -> Result<Source, LoadError> {
    parsed(path, with).and_then(trusted).map(source)
}

/// The scenario of `document` with the values of `overrides`.
pub(crate) fn varied(document: &Document, overrides: &[Override]) -> Result<Source, LoadError> {
    document.scenario(overrides).and_then(trusted).map(source)
}

/// The scenario file at `path`, to be varied, and the scenario with the values of `overrides`: its files are noted, and its warnings
/// reported. It and all files that it names are below `root`.
pub(crate) fn base(path: &Path, overrides: &[Override], root: &Path) -> Result<(Document, Source), LoadError> {
    reads(path, format_args!("the scenario {}", path.display()));
    let document = Document::open(path, Some(root))?;
    let loaded = document.scenario(overrides).and_then(trusted)?;
    note_files(&loaded, path, Some(root));
    warn(&loaded);
    Ok((document, source(loaded)))
}

/// Reads a file again with the values of `overrides` beside those of `with`: its files are noted, and its warnings reported unless they
/// are in `said` already.
pub(crate) fn variant(
    path: &Path,
    with: &OverrideArgs,
    overrides: &[Override],
    said: &mut HashSet<String>,
) -> Result<Source, LoadError> {
    let overrides = with.overrides.iter().chain(overrides).cloned().collect();
    let with = OverrideArgs { overrides, root: with.root.clone() };
    let loaded = parsed(path, &with).and_then(trusted)?;
    note_files(&loaded, path, with.root.as_deref());
    if !loaded.warnings.is_empty() {
        let words = render(&loaded.warnings, &loaded.sources, Severity::Warning);
        if said.insert(words.clone()) {
            say(&words);
        }
    }
    Ok(source(loaded))
}

fn source(loaded: Loaded) -> Source {
    let text = loaded.sources.text(loaded.sources.scenario()).to_owned();
    Source { scenario: loaded.scenario, text }
}

/// Loads one file.
pub(crate) fn read(path: &Path, with: &OverrideArgs) -> Result<Loaded, LoadError> {
    loaded(path, with).inspect(warn)
}

/// Reads a file, or standard input, and notes all files that are read.
fn loaded(path: &Path, with: &OverrideArgs) -> Result<Loaded, LoadError> {
    if !is_stdin(path) {
        reads(path, format_args!("the scenario {}", path.display()));
    }
    parsed(path, with).inspect(|loaded| note_files(loaded, path, with.root.as_deref()))
}

/// Reads a file, or standard input: files named there are looked for in the current folder.
fn parsed(path: &Path, with: &OverrideArgs) -> Result<Loaded, LoadError> {
    let OverrideArgs { overrides, root } = with;
    if !is_stdin(path) {
        return Document::open(path, root.as_deref())?.scenario(overrides);
    }
    let text = if let Some(text) = TEXT_OF_STDIN.get() {
        text.clone()
    } else {
        let text = read_stdin().map_err(|error| LoadError::Read { path: NAME_OF_STDIN.into(), error })?;
        TEXT_OF_STDIN.get_or_init(|| text).clone()
    };
    Document::parse(NAME_OF_STDIN, &text, Some(Path::new("")), root.as_deref())?.at(path).scenario(overrides)
}

/// Notes the files that the scenario at `path` is made of, so that they are not overwritten.
fn note_files(loaded: &Loaded, path: &Path, given: Option<&Path>) {
    let folder = if is_stdin(path) { Path::new("") } else { path.parent().unwrap_or(Path::new("")) };
    // Without a root nothing was read.
    let Ok(root) = root_of(folder, given) else { return };
    let what = format!("a file of the scenario {}", named(path));
    // Names of built-in files are not paths.
    for file in &loaded.scenario.made_of {
        reads(&root.join(&file.path), &what);
    }
}

fn read_stdin() -> std::io::Result<String> {
    reads_stdin();
    let stdin = std::io::stdin();
    if stdin.is_terminal() {
        say(
            "reading a scenario (TOML) from standard input: type or paste it, and end it with Ctrl-D on a line of its own\n",
        );
    }
    let mut text = String::new();
    stdin.take(MOST_OF_A_SCENARIO + 1).read_to_string(&mut text)?;
    if text.len() as u64 > MOST_OF_A_SCENARIO {
        let most = MOST_OF_A_SCENARIO >> 20;
        return Err(std::io::Error::new(
            ErrorKind::FileTooLarge,
            format!("it has more than {most} MB, the most that is read"),
        ));
    }
    Ok(text)
}

/// The embedded demo.
pub(crate) fn demo(with: &OverrideArgs) -> Result<Vec<Source>, LoadError> {
    let demo = servobench_scenario::embedded_demo().into_iter();
    let loaded = demo.map(|(name, text)| Document::parse(name, text, None, None)?.scenario(&with.overrides));
    loaded.map(|loaded| loaded.inspect(warn).map(source)).collect()
}

/// True if warnings of files are left to the report.
static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// Suppresses warnings when files are read: the report counts them.
pub(crate) fn leave_warnings_to_the_report() {
    IS_QUIET.store(true, Ordering::Relaxed);
}

fn warn(loaded: &Loaded) {
    if !loaded.warnings.is_empty() && !IS_QUIET.load(Ordering::Relaxed) {
        say(&render(&loaded.warnings, &loaded.sources, Severity::Warning));
    }
}

/// Reasons why a scenario could not be loaded, as readable text.
pub(crate) fn told(error: &LoadError) -> String {
    match error {
        LoadError::Invalid(invalid) => mistakes(&invalid.diagnostics, &invalid.sources),
        LoadError::Read { .. } => error.to_string(),
    }
}
