//! Mistakes in a scenario, with their places and corrections.
use crate::access::FileAccess;
use crate::points::Counts;
use crate::source::{SourceId, Sources, Span};
use servobench_base::{AxisName, Coordinate, Rate};
use std::collections::HashSet;
use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;
use thiserror::Error;

/// One mistake or warning, with its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// File.
    pub source: SourceId,
    /// Byte range in that file.
    pub span: Range<usize>,
    /// The mistake, in a lower-case sentence.
    pub message: String,
    /// Correction.
    pub help: Option<String>,
}

/// Reason why a scenario could not be loaded.
#[derive(Debug, Error)]
pub enum LoadError {
    /// The scenario file cannot be read.
    #[error("cannot read `{}`: {error}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        error: std::io::Error,
    },
    /// The file holds mistakes: all of them.
    #[error("{0}")]
    Invalid(Box<Invalid>),
}

impl LoadError {
    /// True if the machine ran short of descriptors, memory or disk space; the scenario may be right.
    #[must_use]
    pub fn is_shortage(&self) -> bool {
        matches!(self, Self::Read { error, .. } if servobench_files::is_shortage(error))
    }
}

/// All mistakes in a scenario and the models it names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Invalid {
    /// The mistakes, at least one, in the order of the files.
    pub diagnostics: Vec<Diagnostic>,
    /// Warnings.
    pub warnings: Vec<Diagnostic>,
    /// The files.
    pub sources: Sources,
}

/// Number of mistakes shown per file.
pub const MOST_MISTAKES: usize = 20;

impl Invalid {
    /// The mistakes as lines of [`Diagnostic::line`], at most [`MOST_MISTAKES`] per file, then the number of further mistakes.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let shown = shown(&self.diagnostics, &self.sources);
        let more = shown.more.iter().map(|(name, count)| format!("{name}: and {count} more"));
        shown.diagnostics.iter().map(|one| one.line(&self.sources)).chain(more).collect()
    }
}

/// The diagnostics shown out of many.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shown<'a> {
    /// At most [`MOST_MISTAKES`] of each file.
    pub diagnostics: Vec<&'a Diagnostic>,
    /// Files with more, and the number of further diagnostics.
    pub more: Vec<(String, usize)>,
}

/// The first [`MOST_MISTAKES`] of `all` in each file of `sources`.
#[must_use]
pub fn shown<'a>(all: &'a [Diagnostic], sources: &Sources) -> Shown<'a> {
    let mut shown = Shown { diagnostics: Vec::new(), more: Vec::new() };
    for source in sources.ids() {
        let of_file = || all.iter().filter(|one| one.source == source);
        shown.diagnostics.extend(of_file().take(MOST_MISTAKES));
        let more = of_file().count().saturating_sub(MOST_MISTAKES);
        if more > 0 {
            shown.more.push((sources.name(source).to_owned(), more));
        }
    }
    shown
}

/// The lines of [`Invalid::lines`], one per mistake: `axis.toml:12:9: message; help`.
impl fmt::Display for Invalid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.lines().join("\n"))
    }
}

impl Diagnostic {
    pub(crate) fn new(span: Span, message: String, help: String) -> Self {
        let (message, help) = (bounded(message), (!help.is_empty()).then(|| bounded(help)));
        Self { source: span.source, span: span.start..span.end, message, help }
    }

    /// The diagnostic in one line: `axis.toml:12:9: message; help`, for an override `--set run.duration=1: message; help`.
    #[must_use]
    pub fn line(&self, sources: &Sources) -> String {
        let help = self.help.as_ref().map(|help| format!("; {help}")).unwrap_or_default();
        format!("{}{help}", self.placed_message(sources))
    }

    /// The message after its place, without the correction.
    #[must_use]
    pub fn placed_message(&self, sources: &Sources) -> String {
        let place = sources.place_in_words(self.source, self.span.start);
        format!("{place}: {}", self.message)
    }
}

/// A file that a scenario names by its path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedFile {
    /// The path as written in the scenario, relative to its folder.
    pub named: String,
    /// The text of the file.
    pub text: Arc<str>,
}

/// Collects the diagnostics of a scenario, and holds the context on which the meaning of units depends.
#[derive(Debug, Clone, Default)]
pub(crate) struct Report {
    pub(crate) errors: Vec<Diagnostic>,
    pub(crate) warnings: Vec<Diagnostic>,
    /// Missing keys; not reported for a file with syntax errors, which may contain them.
    pub(crate) missing: Vec<Diagnostic>,
    /// Tables whose model was not found, which may contain the missing keys.
    pub(crate) without_model: Vec<&'static str>,
    /// Task rates from models.
    pub(crate) rates_of_models: Vec<Rate>,
    /// Access to files.
    pub(crate) files: FileAccess,
    /// Tables of points read so far.
    pub(crate) tables: Vec<NamedFile>,
    /// Names of these tables, with the address of the text.
    pub(crate) known_tables: HashSet<(String, usize)>,
    /// Number of points of all tables.
    pub(crate) points: usize,
    /// Meaning of a count of the bus, once known.
    pub(crate) counts: Option<Counts>,
    /// Name of the axis, once known.
    pub(crate) axis_name: Option<AxisName>,
    /// Coordinate of the axis, once known.
    pub(crate) axis: Option<Coordinate>,
    /// Coordinate of the motor, once known.
    pub(crate) motor: Option<Coordinate>,
}

impl Report {
    pub(crate) fn error(&mut self, span: Span, message: impl Into<String>, help: impl Into<String>) {
        self.errors.push(Diagnostic::new(span, message.into(), help.into()));
    }

    pub(crate) fn warning(&mut self, span: Span, message: impl Into<String>, help: impl Into<String>) {
        self.warnings.push(Diagnostic::new(span, message.into(), help.into()));
    }

    /// Records a table read under this name.
    pub(crate) fn note_table(&mut self, named: &str, text: &Arc<str>) {
        if self.known_tables.insert((named.to_owned(), text.as_ptr().addr())) {
            self.tables.push(NamedFile { named: named.to_owned(), text: Arc::clone(text) });
        }
    }

    /// Reports a missing key that the table at `path` could hold.
    pub(crate) fn lacking(&mut self, path: &str, span: Span, message: impl Into<String>, help: impl Into<String>) {
        let table = path.split('.').next().unwrap_or(path);
        if !self.without_model.contains(&table) {
            self.missing.push(Diagnostic::new(span, message.into(), help.into()));
        }
    }
}

/// Longest message (bytes): a value may be as long as its file.
const LONGEST: usize = 2000;

/// A text with its middle left out if it is longer than [`LONGEST`].
fn bounded(text: String) -> String {
    if text.len() <= LONGEST {
        return text;
    }
    let (before, behind) = (text.floor_char_boundary(LONGEST / 2), text.ceil_char_boundary(text.len() - LONGEST / 2));
    format!("{}…{}", &text[..before], &text[behind..])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse;

    #[test]
    fn of_many_mistakes_twenty_are_shown_and_the_others_counted() {
        let keys = |count: usize| (0..count).map(|k| format!("x{k} = 1\n")).collect::<Vec<_>>().concat();
        let lines = |count| match parse("a.toml", &keys(count), None) {
            Err(LoadError::Invalid(invalid)) => invalid.lines(),
            other => panic!("{other:?}"),
        };
        // Three tables are also missing.
        assert_eq!(lines(17).len(), 20);
        let more = lines(40);
        assert_eq!((more.len(), more.last().map(String::as_str)), (21, Some("a.toml: and 23 more")));
    }
}
