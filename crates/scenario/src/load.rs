//! From a file or a text to a scenario, or to everything that is wrong with it.
use crate::access::FileAccess;
use crate::diagnostic::{Diagnostic, Invalid, LoadError, NamedFile, Report};
use crate::display_units::display_units;
use crate::field::Field;
use crate::file::{File, MotorKind};
use crate::models::lay_on_models;
use crate::overrides::{Override, Overriding};
use crate::parameters::parameters;
use crate::resolve;
use crate::scenario::{AxisMechanics, Scenario};
use crate::source::{Place, SourceId, Sources, Span};
use crate::tree::{self, Node, Table, Value};
use crate::{foreign, format};
use servobench_base::Coordinate;
use servobench_config::Choice;
use std::ops::Range;
use std::path::Path;

/// A scenario and what is worth knowing about its files.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// The scenario.
    pub scenario: Scenario,
    /// What is doubtful in it.
    pub warnings: Vec<Diagnostic>,
    /// The files it came from.
    pub sources: Sources,
    /// Tables of points that it names.
    pub tables: Vec<NamedFile>,
    /// What the files say, the scenario laid on its models.
    pub(crate) root: Node,
    /// The MJCF file that it names.
    pub(crate) mjcf: Option<SourceId>,
}

/// Loads the scenario file at `path`; models are looked up in `models/` beside it, in up to four folders above, and
/// among the embedded ones.
///
/// # Errors
/// [`LoadError::Read`] when the file cannot be read, [`LoadError::Invalid`] with every mistake in it.
pub fn load(path: &Path) -> Result<Loaded, LoadError> {
    load_with(path, &[])
}

/// Loads as [`load`] does, with the values of `overrides` in place of those of the file.
///
/// # Errors
/// As [`load`], and what is wrong with the overrides.
pub fn load_with(path: &Path, overrides: &[Override]) -> Result<Loaded, LoadError> {
    load_within(path, overrides, None)
}

/// Loads as [`load_with`] does. The scenario and every file that it names must be below the folder `root`, links resolved; without it
/// below the nearest folder from the scenario upwards that has a `.git`, or else below that of the scenario.
///
/// # Errors
/// As [`load_with`].
pub fn load_within(path: &Path, overrides: &[Override], root: Option<&Path>) -> Result<Loaded, LoadError> {
    let unreadable = |error| LoadError::Read { path: path.to_owned(), error };
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    let mut files = access(path, folder, root)?;
    let text = files.scenario(path).map_err(unreadable)?;
    let mut loaded = parse_from(&path.display().to_string(), &text, Some(folder), overrides, files)?;
    loaded.scenario.path = Some(path.to_owned());
    Ok(loaded)
}

/// What the scenario at `path`, in `folder`, may read.
fn access(path: &Path, folder: &Path, root: Option<&Path>) -> Result<FileAccess, LoadError> {
    FileAccess::of_folder(folder, root).map_err(|error| {
        let path = root.unwrap_or(path).to_owned();
        LoadError::Read { path, error }
    })
}

/// Reads a scenario from `text`; `name` stands for the file in messages, and its stem names a scenario that has no name
/// of its own. Models are looked up from `folder` as [`load`] does; without one among the embedded models only.
///
/// # Errors
/// [`LoadError::Invalid`] with every mistake in it.
pub fn parse(name: &str, text: &str, folder: Option<&Path>) -> Result<Loaded, LoadError> {
    parse_with(name, text, folder, &[])
}

/// Reads as [`parse`] does, with the values of `overrides` in place of those of the text.
///
/// # Errors
/// As [`parse`], and what is wrong with the overrides.
pub fn parse_with(name: &str, text: &str, folder: Option<&Path>, overrides: &[Override]) -> Result<Loaded, LoadError> {
    parse_within(name, text, folder, overrides, None)
}

/// Reads as [`parse_with`] does; files that it names are below `root`, as [`load_within`] has it.
///
/// # Errors
/// As [`parse_with`], and [`LoadError::Read`] when there is no such folder.
pub fn parse_within(
    name: &str,
    text: &str,
    folder: Option<&Path>,
    overrides: &[Override],
    root: Option<&Path>,
) -> Result<Loaded, LoadError> {
    let mut files = match folder {
        // In a folder that is not there is no file to read.
        Some(folder) if root.is_some() || folder.as_os_str().is_empty() || folder.exists() => {
            access(Path::new(name), folder, root)?
        }
        _ => FileAccess::default(),
    };
    let own = Path::new(name).file_name().map_or_else(|| name.into(), std::ffi::OsStr::to_string_lossy);
    files.note_scenario(&own, text);
    parse_from(name, text, folder, overrides, files)
}

fn parse_from(
    name: &str,
    text: &str,
    folder: Option<&Path>,
    overrides: &[Override],
    files: FileAccess,
) -> Result<Loaded, LoadError> {
    let mut sources = Sources::default();
    let place = folder.map_or_else(|| Place::Embedded("".into()), |folder| Place::Folder(folder.to_owned()));
    let id = sources.add(name.to_owned(), text.to_owned(), place);

    let mut syntax = Report::default();
    let mut parsed = tree::parse(id, text, &mut syntax);
    let mut broken: Vec<(SourceId, Range<usize>)> = parsed.broken.drain(..).map(|line| (id, line)).collect();
    let mut report = Report { files, ..Report::default() };
    if let Some(diagnostic) = format::newer(&parsed.table) {
        // Whatever else is said of a file that this build does not know would mislead.
        let (diagnostics, warnings) = (vec![diagnostic], Vec::new());
        return Err(LoadError::Invalid(Box::new(Invalid { diagnostics, warnings, sources })));
    }
    format::warn_of_older(&parsed.table, &mut report);
    let overriding = Overriding::new(overrides, &mut sources, &mut report);
    overriding.choose_models(&mut parsed.table, &mut report);
    broken.extend(lay_on_models(&mut parsed.table, &mut sources, &mut report, &mut syntax));
    overriding.set(&mut parsed.table, &mut report);

    (report.axis, report.motor) = motions(&parsed.table);
    let root = Node { value: Value::Table(parsed.table), span: Span::new(id, &(0..0)) };
    let scenario =
        File::decode("", &root, &(), &mut report).and_then(|file| resolve::scenario(&file, &sources, &mut report));

    let mut diagnostics = all_errors(syntax, &mut report, &broken);
    let mut warnings = in_order(std::mem::take(&mut report.warnings));
    foreign::shorten(&mut diagnostics, &sources);
    foreign::shorten(&mut warnings, &sources);
    // What the machine kept from being read is no mistake of the scenario.
    if !diagnostics.is_empty()
        && let Some((path, error)) = report.files.shortage()
    {
        return Err(LoadError::Read { path, error });
    }
    match scenario {
        Some(mut scenario) if diagnostics.is_empty() => {
            if scenario.name.is_empty() {
                scenario.name = Path::new(name).file_stem().unwrap_or_default().to_string_lossy().into_owned();
            }
            if let Value::Table(table) = &root.value {
                scenario.parameters = parameters(table, &sources);
                scenario.units = display_units(&scenario.parameters, scenario.axis.motion);
            }
            scenario.overrides = overrides.to_vec();
            scenario.warnings = warnings.iter().map(|warning| warning.placed_message(&sources)).collect();
            scenario.root = report.files.root().map(Path::to_owned);
            scenario.made_of = report.files.into_made_of();
            let mjcf = match &scenario.axis.mechanics {
                AxisMechanics::Mjcf(mjcf) => {
                    Some(sources.add(mjcf.path.display().to_string(), mjcf.xml.clone(), Place::Embedded("".into())))
                }
                AxisMechanics::Bodies(_) | AxisMechanics::InTheFmu => None,
            };
            Ok(Loaded { scenario, warnings, sources, tables: report.tables, root, mjcf })
        }
        _ => Err(LoadError::Invalid(Box::new(Invalid { diagnostics, warnings, sources }))),
    }
}

/// Everything that is wrong. On lines with wrong syntax only that is said, and nothing is missing from a file that
/// could not be read completely. The lines are in the order of the files, none within another.
pub(crate) fn all_errors(syntax: Report, report: &mut Report, broken: &[(SourceId, Range<usize>)]) -> Vec<Diagnostic> {
    let mut all = syntax.errors;
    let is_whole = |one: &Diagnostic| {
        let before = |(source, line): &(SourceId, Range<usize>)| (*source, line.end) < (one.source, one.span.start);
        let next = broken.get(broken.partition_point(before));
        !next.is_some_and(|(source, line)| *source == one.source && line.start <= one.span.end)
    };
    all.extend(std::mem::take(&mut report.errors).into_iter().filter(is_whole));
    if broken.is_empty() {
        all.append(&mut report.missing);
    }
    in_order(all)
}

fn in_order(mut all: Vec<Diagnostic>) -> Vec<Diagnostic> {
    all.sort_by_key(|one| (one.source, one.span.start));
    all.dedup();
    all
}

/// Coordinates of axis and motor, on which the meaning of units depends, before anything else is read.
fn motions(root: &Table) -> (Option<Coordinate>, Option<Coordinate>) {
    let table = |key| root.get(key).and_then(|node: &Node| node.value.as_table());
    let own = table("motor").and_then(motor_by_its_keys);
    let Some(axis) = table("axis") else { return (None, own) };
    let motion = named::<Coordinate>(axis, "motion");
    (motion, motion.map(|motion| resolve::motor_motion(motion, axis.get("lead").is_some(), own)).or(own))
}

/// Whether a synchronous motor turns or is linear: its poles are counted in pairs around a shaft, or have a pitch along a
/// line. What the command line says displaces what the scenario says, and that what the model says.
fn motor_by_its_keys(motor: &Table) -> Option<Coordinate> {
    if named(motor, "kind") != Some(MotorKind::Pmsm) {
        return None;
    }
    let authority = |key| motor.get(key).map(|node| node.span.source.authority());
    match (authority("pole_pairs"), authority("pole_pitch")) {
        (None, None) => None,
        (Some(_), None) => Some(Coordinate::Rotary),
        (None, Some(_)) => Some(Coordinate::Linear),
        (Some(pairs), Some(pitch)) => Some(if pitch < pairs { Coordinate::Linear } else { Coordinate::Rotary }),
    }
}

/// One of a few names, as far as it is right.
fn named<T: Choice>(table: &Table, key: &str) -> Option<T> {
    let text = table.get(key).and_then(|node| node.value.as_text())?;
    T::ALL.iter().find(|(name, ..)| *name == text).map(|(_, value, _)| *value)
}
