//! What is wrong with a scenario, where, and what to do about it.
use crate::access::FileAccess;
use crate::points::Counts;
use crate::source::{SourceId, Sources, Span};
use servobench_base::{Coordinate, Rate};
use std::collections::HashSet;
use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;
use thiserror::Error;

/// One mistake or doubt, at its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// File it is in.
    pub source: SourceId,
    /// Bytes of that file.
    pub span: Range<usize>,
    /// What is wrong, in a lower-case sentence.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
}

/// Why a scenario could not be loaded.
#[derive(Debug, Error)]
pub enum LoadError {
    /// The scenario file cannot be read.
    #[error("cannot read `{}`: {error}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system says.
        error: std::io::Error,
    },
    /// The file holds mistakes: all of them.
    #[error("{0}")]
    Invalid(Box<Invalid>),
}

impl LoadError {
    /// Whether the machine had too little of something, and the scenario may be right: descriptors, memory, room on a disk.
    #[must_use]
    pub fn is_shortage(&self) -> bool {
        matches!(self, Self::Read { error, .. } if servobench_files::is_shortage(error))
    }
}

/// Everything that is wrong with a scenario and the models it names.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Invalid {
    /// The mistakes, at least one, in the order of the files.
    pub diagnostics: Vec<Diagnostic>,
    /// What is doubtful besides.
    pub warnings: Vec<Diagnostic>,
    /// The files.
    pub sources: Sources,
}

/// Mistakes that are shown of one file; nobody reads the hundredth.
pub const MOST_MISTAKES: usize = 20;

impl Invalid {
    /// The mistakes in lines as [`Diagnostic::line`] has them, of each file [`MOST_MISTAKES`] at most, then how many more
    /// there are.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let shown = shown(&self.diagnostics, &self.sources);
        let more = shown.more.iter().map(|(name, count)| format!("{name}: and {count} more"));
        shown.diagnostics.iter().map(|one| one.line(&self.sources)).chain(more).collect()
    }
}

/// What is shown of many diagnostics.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shown<'a> {
    /// Of each file [`MOST_MISTAKES`] at most.
    pub diagnostics: Vec<&'a Diagnostic>,
    /// Names of the files with more, and how many more.
    pub more: Vec<(String, usize)>,
}

/// Of each file of `sources` the first [`MOST_MISTAKES`] of `all`.
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

/// `axis.toml:12:9: message; help`, a line for each mistake, as [`Invalid::lines`] has them.
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

    /// The diagnostic in one line: `axis.toml:12:9: message; help`, of an override `--set run.duration=1: message; help`.
    #[must_use]
    pub fn line(&self, sources: &Sources) -> String {
        let help = self.help.as_ref().map(|help| format!("; {help}")).unwrap_or_default();
        format!("{}{help}", self.placed_message(sources))
    }

    /// The message behind its place, without what to do about it.
    #[must_use]
    pub fn placed_message(&self, sources: &Sources) -> String {
        let place = sources.place_in_words(self.source, self.span.start);
        format!("{place}: {}", self.message)
    }
}

/// A file that a scenario names by its path.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NamedFile {
    /// The path as the scenario has it, relative to its folder.
    pub named: String,
    /// The text of the file.
    pub text: Arc<str>,
}

/// Collects what is found while a scenario is read, and knows what a unit's meaning depends on.
#[derive(Debug, Clone, Default)]
pub(crate) struct Report {
    pub(crate) errors: Vec<Diagnostic>,
    pub(crate) warnings: Vec<Diagnostic>,
    /// What is missing; not said of a file with wrong syntax, where it may well be there.
    pub(crate) missing: Vec<Diagnostic>,
    /// Tables whose model was not found: what they lack may well be in it.
    pub(crate) without_model: Vec<&'static str>,
    /// Task rates that models give.
    pub(crate) rates_of_models: Vec<Rate>,
    /// What the scenario may read, and what was.
    pub(crate) files: FileAccess,
    /// Tables of points that were read.
    pub(crate) tables: Vec<NamedFile>,
    /// Their names, and which texts these are.
    pub(crate) known_tables: HashSet<(String, usize)>,
    /// Points of all of them.
    pub(crate) points: usize,
    /// What a count of the bus is, once known.
    pub(crate) counts: Option<Counts>,
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

    /// Notes a table that is read under this name.
    pub(crate) fn note_table(&mut self, named: &str, text: &Arc<str>) {
        if self.known_tables.insert((named.to_owned(), text.as_ptr().addr())) {
            self.tables.push(NamedFile { named: named.to_owned(), text: Arc::clone(text) });
        }
    }

    /// Notes that something is missing which the table `path` could hold.
    pub(crate) fn lacking(&mut self, path: &str, span: Span, message: impl Into<String>, help: impl Into<String>) {
        let table = path.split('.').next().unwrap_or(path);
        if !self.without_model.contains(&table) {
            self.missing.push(Diagnostic::new(span, message.into(), help.into()));
        }
    }
}

/// Bytes of a message: a value may be as long as its file.
const LONGEST: usize = 2000;

/// A text with its middle left out when it is longer than anybody reads.
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
        // Three tables are missing besides.
        assert_eq!(lines(17).len(), 20);
        let more = lines(40);
        assert_eq!((more.len(), more.last().map(String::as_str)), (21, Some("a.toml: and 23 more")));
    }
}
