//! The texts of a scenario, files and overrides of the command line, and places in them.
use crate::models::EMBEDDED;
use std::ops::Range;
use std::path::PathBuf;

/// One of the texts in [`Sources`]. A lesser id takes precedence: overrides over the scenario, the scenario over its models.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceId(Kind);

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Kind {
    Override(usize),
    /// Index of the file, the scenario first.
    File(usize),
}

/// Origin of a value; the lesser takes precedence.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Authority {
    CommandLine,
    Scenario,
    Model,
}

/// The texts of a scenario: overrides of the command line, the scenario itself, then the models it names.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Sources {
    overrides: Vec<Source>,
    files: Vec<Source>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Source {
    name: String,
    text: String,
    /// Byte offsets of all lines but the first.
    line_starts: Vec<usize>,
    place: Place,
    /// True if messages may show its lines.
    is_shown: bool,
}

/// Folder of a file, for the files that it names in turn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Place {
    /// Folder on disk.
    Folder(PathBuf),
    /// Folder in the embedded models.
    Embedded(PathBuf),
}

/// A range of bytes in one file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Span {
    pub(crate) source: SourceId,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// A value and its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct At<T> {
    pub(crate) value: T,
    pub(crate) span: Span,
}

impl SourceId {
    /// The scenario itself.
    pub(crate) const SCENARIO: Self = Self(Kind::File(0));

    /// Origin of the values in this text.
    pub(crate) const fn authority(self) -> Authority {
        match self.0 {
            Kind::Override(_) => Authority::CommandLine,
            Kind::File(0) => Authority::Scenario,
            Kind::File(_) => Authority::Model,
        }
    }

    /// True for an override of the command line, false for a file.
    #[must_use]
    pub const fn is_override(self) -> bool {
        matches!(self.authority(), Authority::CommandLine)
    }
}

impl Span {
    pub(crate) const fn new(source: SourceId, range: &Range<usize>) -> Self {
        Self { source, start: range.start, end: range.end }
    }
}

impl Sources {
    /// Id of the scenario file itself.
    #[must_use]
    pub const fn scenario(&self) -> SourceId {
        SourceId::SCENARIO
    }

    /// All ids: overrides, the scenario, its models.
    pub fn ids(&self) -> impl Iterator<Item = SourceId> {
        let overrides = (0..self.overrides.len()).map(Kind::Override);
        overrides.chain((0..self.files.len()).map(Kind::File)).map(SourceId)
    }

    /// Name of a file in messages: its path, or `<embedded>/…`; for an override the text of the command line. Empty for an id of other
    /// sources.
    #[must_use]
    pub fn name(&self, id: SourceId) -> &str {
        self.get(id).map_or("", |source| &source.name)
    }

    /// Text of a file or an override. Empty for an id of other sources.
    #[must_use]
    pub fn text(&self, id: SourceId) -> &str {
        self.get(id).map_or("", |source| &source.text)
    }

    /// True if messages may show its lines: the scenario, overrides and embedded files. Any other file that a scenario names may be
    /// foreign.
    #[must_use]
    pub fn may_be_shown(&self, id: SourceId) -> bool {
        self.get(id).is_some_and(|source| source.is_shown)
    }

    /// A place as shown in messages: `axis.toml:12:9`, or the override that contains it.
    pub(crate) fn place_in_words(&self, id: SourceId, offset: usize) -> String {
        let name = self.name(id);
        if id.is_override() {
            return name.to_owned();
        }
        let (line, column) = self.line_and_column(id, offset);
        format!("{name}:{line}:{column}")
    }

    /// Path of a model file below `models/`, such as `motors/x.toml`; `None` for other texts.
    #[must_use]
    pub fn model(&self, id: SourceId) -> Option<String> {
        let file = self.get(id).filter(|_| id.authority() == Authority::Model)?;
        let (Place::Folder(folder) | Place::Embedded(folder)) = &file.place;
        let kind = folder.file_name()?.to_str()?;
        let name = file.name.rsplit(['/', '\\']).next()?;
        Some(format!("{kind}/{name}"))
    }

    /// Line and column of a byte offset, both from 1; columns count characters.
    #[must_use]
    pub fn line_and_column(&self, id: SourceId, offset: usize) -> (usize, usize) {
        let Some(Source { text, line_starts, .. }) = self.get(id) else { return (1, 1) };
        let before = text.get(..offset).unwrap_or(text);
        let lines = line_starts.partition_point(|start| *start <= before.len());
        let line_start = lines.checked_sub(1).map_or(0, |last| line_starts[last]);
        (lines + 1, before[line_start..].chars().count() + 1)
    }

    pub(crate) fn add(&mut self, name: String, text: String, place: Place) -> SourceId {
        let is_shown = self.files.is_empty() || name.starts_with(EMBEDDED);
        self.files.push(Source::new(name, text, place, is_shown));
        SourceId(Kind::File(self.files.len() - 1))
    }

    /// Adds the text of an override; files that it names are looked up from the scenario's folder.
    pub(crate) fn add_override(&mut self, words: String) -> SourceId {
        let place = self.place(SourceId::SCENARIO).cloned().unwrap_or_else(|| Place::Embedded(PathBuf::new()));
        self.overrides.push(Source::new(words.clone(), words, place, true));
        SourceId(Kind::Override(self.overrides.len() - 1))
    }

    pub(crate) fn place(&self, id: SourceId) -> Option<&Place> {
        self.get(id).map(|source| &source.place)
    }

    fn get(&self, id: SourceId) -> Option<&Source> {
        match id.0 {
            Kind::Override(index) => self.overrides.get(index),
            Kind::File(index) => self.files.get(index),
        }
    }
}

impl Source {
    fn new(name: String, text: String, place: Place, is_shown: bool) -> Self {
        let line_starts = text.match_indices('\n').map(|(at, _)| at + 1).collect();
        Self { name, text, line_starts, place, is_shown }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters() {
        let mut sources = Sources::default();
        let id = sources.add("a".into(), "x\nµm = ä\n".into(), Place::Folder(PathBuf::new()));
        assert_eq!(sources.line_and_column(id, 0), (1, 1));
        assert_eq!(sources.line_and_column(id, "x\nµm = ".len()), (2, 6));
        assert_eq!(sources.line_and_column(id, 10_000), (3, 1), "past the end: the end");
        assert_eq!(sources.line_and_column(id, 3), (3, 1), "inside a character: the end");
    }
}
