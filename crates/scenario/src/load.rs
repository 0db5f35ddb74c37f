//! Loads a file or a text as a scenario, or returns all mistakes in it.
use crate::diagnostic::{Diagnostic, LoadError, NamedFile, Report};
use crate::document::Document;
use crate::file::MotorKind;
use crate::resolve;
use crate::scenario::Scenario;
use crate::source::{SourceId, Sources};
use crate::tree::{Node, Table};
use servobench_base::Coordinate;
use servobench_config::Choice;
use std::ops::Range;
use std::path::Path;

/// A scenario with its files and warnings.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// The scenario.
    pub scenario: Scenario,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
    /// The files it came from.
    pub sources: Sources,
    /// Tables of points that it names.
    pub tables: Vec<NamedFile>,
    /// The merged contents of the scenario and its models.
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
    Document::open(path, None)?.scenario(&[])
}

/// Reads a scenario from `text`, as [`Document::parse`] does.
///
/// # Errors
/// [`LoadError::Invalid`] with every mistake in it.
pub fn parse(name: &str, text: &str, folder: Option<&Path>) -> Result<Loaded, LoadError> {
    Document::parse(name, text, folder, None)?.scenario(&[])
}

/// All mistakes. On a line with a syntax error only the syntax error is reported, and no key is reported as missing from a file that
/// could not be read completely. The lines are in the order of the files and do not overlap.
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

pub(crate) fn in_order(mut all: Vec<Diagnostic>) -> Vec<Diagnostic> {
    all.sort_by_key(|one| (one.source, one.span.start));
    all.dedup();
    all
}

/// Coordinates of axis and motor, on which the meaning of units depends, before anything else is read.
pub(crate) fn motions(root: &Table) -> (Option<Coordinate>, Option<Coordinate>) {
    let table = |key| root.get(key).and_then(|node: &Node| node.value.as_table());
    let own = table("motor").and_then(motor_by_its_keys);
    let Some(axis) = table("axis") else { return (None, own) };
    let motion = named::<Coordinate>(axis, "motion");
    (motion, motion.map(|motion| resolve::motor_motion(motion, axis.get("lead").is_some(), own)).or(own))
}

/// Coordinate of a synchronous motor, from its keys: `pole_pairs` for a rotary, `pole_pitch` for a linear one. The command line takes
/// precedence over the scenario, and the scenario over the model.
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

/// The named value of a key, if it is valid.
fn named<T: Choice>(table: &Table, key: &str) -> Option<T> {
    let text = table.get(key).and_then(|node| node.value.as_text())?;
    T::ALL.iter().find(|(name, ..)| *name == text).map(|(_, value, _)| *value)
}
