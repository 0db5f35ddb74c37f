//! Overrides of keys of a file: `setpoint.jerk=200 m/s3` on the command line.
//!
//! ```text
//! override = key "=" value
//! key      = part { "." part }        part = name [ "[" index "]" ]      name = bare | "quoted" | 'quoted'
//! value    = a number, true, false, [list], {table} or "string" of TOML; otherwise the text itself as a string
//! ```
//! An index counts from 0; `program.0` is `program[0]`, as in results.
mod path;
mod value;

use crate::diagnostic::Report;
use crate::source::{SourceId, Sources, Span};
use crate::tree::{Entry, Node, Table, Value};
use path::Part;
use servobench_files::suggestion;
use servobench_sweep as sweep;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// Option before an override on the command line, and so before its text in messages.
const OPTION: &str = "--set ";
/// Tables that can refer to a model.
const MODELLED: [&str; 3] = ["axis", "motor", "drive"];

/// A key of a scenario in the notation of `--set`: `setpoint.jerk`, `program[0].move_to`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Key {
    /// The text of the command line up to the value.
    words: String,
    /// Its parts, with their bytes in the words.
    path: Vec<Part>,
}

/// A key of a scenario with the value that replaces the file's.
#[derive(Debug, Clone, PartialEq)]
pub struct Override {
    key: Key,
    /// The text of the command line: `--set setpoint.jerk=200 m/s3`.
    words: String,
    /// The value, with its byte range in the text.
    value: Node,
}

/// Reason why a text is not an override.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct OverrideError(pub(crate) String);

impl FromStr for Key {
    type Err = OverrideError;

    fn from_str(text: &str) -> Result<Self, OverrideError> {
        let words = format!("{OPTION}{}=", one_line(text)?);
        let (path, value_at) = path::read(&words, OPTION.len()).map_err(OverrideError)?;
        if value_at < words.len() {
            return Err(OverrideError("a key has no `=`".to_owned()));
        }
        Ok(Self { words, path })
    }
}

impl Key {
    /// True of a key that is this one, in whatever words.
    #[must_use]
    pub fn is(&self, other: &Self) -> bool {
        self.path.len() == other.path.len()
            && self.path.iter().zip(&other.path).all(|(own, other)| own.name == other.name)
    }

    /// The key from its first part to the one with this index: `program[1].move_to`.
    fn up_to(&self, last: usize) -> String {
        path::written(&self.path[..=last])
    }
}

impl FromStr for Override {
    type Err = OverrideError;

    fn from_str(text: &str) -> Result<Self, OverrideError> {
        let words = format!("{OPTION}{}", one_line(text)?);
        let (path, value_at) = path::read(&words, OPTION.len()).map_err(OverrideError)?;
        let value = value::read(&words, value_at).map_err(OverrideError)?;
        Ok(Self { key: Key { words: words[..value_at].to_owned(), path }, words, value })
    }
}

/// `text` without surrounding spaces.
fn one_line(text: &str) -> Result<&str, OverrideError> {
    let text = text.trim();
    match text.chars().find(|c| c.is_control() && *c != '\t') {
        Some(control) => Err(OverrideError(format!("it must be on one line, without {control:?}"))),
        None => Ok(text),
    }
}

/// As given: `setpoint.jerk=200 m/s3`.
impl fmt::Display for Override {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.words.strip_prefix(OPTION).unwrap_or(&self.words))
    }
}

impl Override {
    /// The key that it sets.
    #[must_use]
    pub const fn key(&self) -> &Key {
        &self.key
    }

    /// `key` with `value`, which is not read from a text again where it is a number.
    ///
    /// # Errors
    /// [`OverrideError`] for a text that cannot be a value.
    pub fn new(key: &Key, value: &sweep::Value) -> Result<Self, OverrideError> {
        let (start, text) = (key.words.len(), value.written());
        let words = format!("{}{}", key.words, one_line(&text)?);
        let value = match value {
            sweep::Value::Number(number, unit) => value::number(text, *number, unit, start),
            sweep::Value::Text(_) => value::read(&words, start).map_err(OverrideError)?,
        };
        Ok(Self { key: key.clone(), words, value })
    }

    /// True if the choice of a table's model depends on it.
    pub(crate) fn chooses_a_model(&self) -> bool {
        let mut names = self.key.path.iter().map(|part| part.name.as_str());
        names.next().is_some_and(|table| MODELLED.contains(&table)) && names.next().is_none_or(|key| key == "model")
    }
}

/// Overrides to be applied to a scenario.
pub(crate) struct Overriding<'a> {
    all: Vec<(&'a Override, SourceId)>,
}

impl<'a> Overriding<'a> {
    /// Collects `overrides` and reports keys that are set twice; the first counts.
    pub(crate) fn new(overrides: &'a [Override], sources: &mut Sources, report: &mut Report) -> Self {
        let mut all: Vec<(&Override, SourceId)> = Vec::new();
        for one in overrides {
            let source = sources.add_override(one.words.clone());
            let is_again = |(other, _): &&(&Override, SourceId)| {
                one.key.path.iter().zip(&other.key.path).all(|(own, other)| own.name == other.name)
            };
            if let Some((other, _)) = all.iter().find(is_again) {
                let last = one.key.path.len() - 1;
                let message = format!("`{}` is set twice", one.key.up_to(last));
                report.error(span(source, &one.key.path), message, format!("the other is `{}`", other.words));
            } else {
                all.push((one, source));
            }
        }
        Self { all }
    }

    /// Applies the overrides that decide a table's model, before the merge with that model.
    pub(crate) fn choose_models(&self, root: &mut Table, report: &mut Report) {
        self.apply(root, report, Override::chooses_a_model);
    }

    /// Applies all other overrides, also to values from models.
    pub(crate) fn set(&self, root: &mut Table, report: &mut Report) {
        self.apply(root, report, |one| !one.chooses_a_model());
    }

    fn apply(&self, root: &mut Table, report: &mut Report, is_wanted: impl Fn(&Override) -> bool) {
        for (of, source) in self.all.iter().filter(|(one, _)| is_wanted(one)) {
            let value = of.value.clone().moved_to(*source);
            Setting { of: &of.key, source: *source, report }.in_table(root, 0, value);
        }
    }
}

/// An override that is being applied.
struct Setting<'a> {
    of: &'a Key,
    source: SourceId,
    report: &'a mut Report,
}

impl Setting<'_> {
    /// Sets `node` in `table` under the part `index` and the parts after it.
    fn in_table(&mut self, table: &mut Table, index: usize, node: Node) {
        let part = &self.of.path[index];
        let key_span = Span::new(self.source, &part.place);
        let is_last = index + 1 == self.of.path.len();
        if part.is_index {
            self.refuse(index, "is a table, not a list");
            return;
        }
        if let Some(entry) = table.entry_mut(&part.name) {
            if is_last {
                *entry = Entry { key: part.name.clone(), key_span, node };
            } else {
                self.in_node(&mut entry.node, index + 1, node);
            }
            return;
        }
        if self.of.path.get(index + 1).is_some_and(|next| next.is_index) {
            let keys: Vec<&str> = table.entries.iter().map(|entry| entry.key.as_str()).collect();
            let help = suggestion(&part.name, keys);
            self.report.lacking(&part.name, key_span, format!("unknown list `{}`", self.of.up_to(index)), help);
            return;
        }
        let mut entry = Entry { key: part.name.clone(), key_span, node };
        if !is_last {
            let mut inner = Table::default();
            self.in_table(&mut inner, index + 1, entry.node);
            entry.node = Node { value: Value::Table(inner), span: key_span };
        }
        table.entries.push(entry);
    }

    /// Sets `node` in `into` under the part `index` and the parts after it.
    fn in_node(&mut self, into: &mut Node, index: usize, node: Node) {
        let part = &self.of.path[index];
        match &mut into.value {
            Value::Table(table) => self.in_table(table, index, node),
            Value::Array(items) => {
                let count = items.len();
                let Ok(at) = part.name.parse::<usize>() else {
                    let help = format!("choose an element: `{}[0].{}`", self.of.up_to(index - 1), part.name);
                    self.refuse_with(index, "is a list", &help);
                    return;
                };
                let Some(item) = items.get_mut(at) else {
                    self.beyond(index, count);
                    return;
                };
                if index + 1 == self.of.path.len() {
                    *item = node;
                } else {
                    self.in_node(item, index + 1, node);
                }
            }
            other => {
                let is = format!("is {} and has no parts", other.kind());
                self.refuse(index, &is);
            }
        }
    }

    /// Reports that the list before the part `index` has no such element.
    fn beyond(&mut self, index: usize, count: usize) {
        let part = &self.of.path[index];
        let list = self.of.up_to(index - 1);
        let help = match count {
            0 => format!("`{list}` is empty"),
            1 => format!("`{list}` has one element, `{list}[0]`"),
            _ => format!("`{list}` has {count} elements, `{list}[0]` to `{list}[{}]`", count - 1),
        };
        let place = Span::new(self.source, &part.place);
        self.report.lacking(&self.of.path[0].name, place, format!("`{}` does not exist", self.of.up_to(index)), help);
    }

    /// Reports that the value before the part `index` cannot have it.
    fn refuse(&mut self, index: usize, is: &str) {
        self.refuse_with(index, is, "");
    }

    fn refuse_with(&mut self, index: usize, is: &str, help: &str) {
        let place = Span::new(self.source, &self.of.path[index].place);
        // A key does not begin with an index.
        self.report.error(place, format!("`{}` {is}", self.of.up_to(index.saturating_sub(1))), help);
    }
}

/// The span from the first to the last part.
fn span(source: SourceId, path: &[Part]) -> Span {
    let start = path.first().map_or(0, |part| part.place.start);
    let end = path.last().map_or(start, |part| part.place.end);
    Span::new(source, &(start..end))
}
