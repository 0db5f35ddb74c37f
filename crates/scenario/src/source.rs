//! The files that a scenario was read from, and places in them.
use std::ops::Range;
use std::path::PathBuf;

/// One of the files in [`Sources`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceId(usize);

/// The files that a scenario was read from: the scenario itself first, then the models it names.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Sources {
    files: Vec<Source>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Source {
    name: String,
    text: String,
    /// Where each line but the first begins.
    line_starts: Vec<usize>,
    place: Place,
}

/// Where a file is, for the files that it names in turn.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Place {
    /// In this folder of the disk.
    Folder(PathBuf),
    /// In this folder of the embedded models.
    Embedded(PathBuf),
}

/// A range of bytes in one file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Span {
    pub(crate) source: SourceId,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// A value and where it is written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct At<T> {
    pub(crate) value: T,
    pub(crate) span: Span,
}

impl SourceId {
    /// The scenario itself.
    pub(crate) const SCENARIO: Self = Self(0);
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

    /// Ids of all files, the scenario first.
    pub fn ids(&self) -> impl Iterator<Item = SourceId> {
        (0..self.files.len()).map(SourceId)
    }

    /// Name of a file as messages give it: its path, or `<embedded>/…`. Empty for an id of other sources.
    #[must_use]
    pub fn name(&self, id: SourceId) -> &str {
        self.files.get(id.0).map_or("", |file| &file.name)
    }

    /// Text of a file. Empty for an id of other sources.
    #[must_use]
    pub fn text(&self, id: SourceId) -> &str {
        self.files.get(id.0).map_or("", |file| &file.text)
    }

    /// Where a model file belongs below `models/`, such as `motors/x.toml`; `None` for what is no model.
    #[must_use]
    pub fn model(&self, id: SourceId) -> Option<String> {
        let file = self.files.get(id.0).filter(|_| id != SourceId::SCENARIO)?;
        let (Place::Folder(folder) | Place::Embedded(folder)) = &file.place;
        let kind = folder.file_name()?.to_str()?;
        let name = file.name.rsplit(['/', '\\']).next()?;
        Some(format!("{kind}/{name}"))
    }

    /// Line and column of a byte offset, both from 1; columns count characters.
    #[must_use]
    pub fn line_and_column(&self, id: SourceId, offset: usize) -> (usize, usize) {
        let Some(Source { text, line_starts, .. }) = self.files.get(id.0) else { return (1, 1) };
        let before = text.get(..offset).unwrap_or(text);
        let lines = line_starts.partition_point(|start| *start <= before.len());
        let line_start = lines.checked_sub(1).map_or(0, |last| line_starts[last]);
        (lines + 1, before[line_start..].chars().count() + 1)
    }

    pub(crate) fn add(&mut self, name: String, text: String, place: Place) -> SourceId {
        let line_starts = text.match_indices('\n').map(|(at, _)| at + 1).collect();
        self.files.push(Source { name, text, line_starts, place });
        SourceId(self.files.len() - 1)
    }

    pub(crate) fn place(&self, id: SourceId) -> Option<&Place> {
        self.files.get(id.0).map(|file| &file.place)
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
