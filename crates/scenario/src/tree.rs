//! TOML as a tree in which every key and value has its file and byte range.
mod syntax_error;

use crate::diagnostic::Report;
use crate::source::{SourceId, Span};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use syntax_error::{Kind, SyntaxError};
use toml::de::{DeTable, DeValue};

/// A value.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    Table(Table),
    Array(Vec<Node>),
    Text(String),
    /// A number with a unit from a program, not from a file.
    Quantity {
        /// The text that a file would contain.
        text: String,
        number: f64,
        unit: String,
    },
    Number(Number),
    Bool(bool),
    /// A date or time: valid TOML that no scenario needs.
    Date,
}

/// A bare number.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Number {
    /// The number as written.
    pub(crate) text: String,
    pub(crate) value: f64,
    /// The value, if it is written as an integer and fits.
    pub(crate) whole: Option<i64>,
}

/// A value with its place; a table's place is its header.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Node {
    pub(crate) value: Value,
    pub(crate) span: Span,
}

/// Entries in the order of the file.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Table {
    pub(crate) entries: Vec<Entry>,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Entry {
    pub(crate) key: String,
    pub(crate) key_span: Span,
    pub(crate) node: Node,
}

impl Table {
    pub(crate) fn get(&self, key: &str) -> Option<&Node> {
        self.entries.iter().find(|entry| entry.key == key).map(|entry| &entry.node)
    }

    pub(crate) fn entry_mut(&mut self, key: &str) -> Option<&mut Entry> {
        self.entries.iter_mut().find(|entry| entry.key == key)
    }

    pub(crate) fn get_mut(&mut self, key: &str) -> Option<&mut Node> {
        self.entry_mut(key).map(|entry| &mut entry.node)
    }

    /// Merges `over` into this table: its values take precedence, tables merge key by key.
    pub(crate) fn overlay(&mut self, over: Self) {
        let own = self.entries.len();
        for entry in over.entries {
            let Some(below) = self.entries[..own].iter_mut().find(|below| below.key == entry.key) else {
                self.entries.push(entry);
                continue;
            };
            below.key_span = entry.key_span;
            below.node.span = entry.node.span;
            match (&mut below.node.value, entry.node.value) {
                (Value::Table(below), Value::Table(over)) => below.overlay(over),
                (below, over) => *below = over,
            }
        }
    }
}

impl Node {
    /// The same node with its places in another text.
    pub(crate) fn moved_to(mut self, source: SourceId) -> Self {
        self.move_to(source);
        self
    }

    fn move_to(&mut self, source: SourceId) {
        self.span.source = source;
        match &mut self.value {
            Value::Array(items) => items.iter_mut().for_each(|item| item.move_to(source)),
            Value::Table(table) => {
                for entry in &mut table.entries {
                    entry.key_span.source = source;
                    entry.node.move_to(source);
                }
            }
            Value::Text(_) | Value::Quantity { .. } | Value::Number(_) | Value::Bool(_) | Value::Date => {}
        }
    }
}

impl Value {
    pub(crate) fn as_table(&self) -> Option<&Table> {
        if let Self::Table(table) = self { Some(table) } else { None }
    }

    pub(crate) fn as_text(&self) -> Option<&str> {
        if let Self::Text(text) | Self::Quantity { text, .. } = self { Some(text) } else { None }
    }

    /// Kind of the value, in words.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Table(_) => "a table",
            Self::Array(_) => "a list",
            Self::Text(_) | Self::Quantity { .. } => "a string",
            Self::Number(_) => "a number",
            Self::Bool(_) => "true or false",
            Self::Date => "a date",
        }
    }
}

/// A parsed file and its lines with syntax errors, for which other diagnostics would mislead.
#[derive(Debug)]
pub(crate) struct Parsed {
    pub(crate) table: Table,
    /// None contains another: both starts and ends increase.
    pub(crate) broken: Vec<Range<usize>>,
}

/// Parses as much as possible; every syntax error goes to `report`, but only one for a text that is not TOML at all.
pub(crate) fn parse(source: SourceId, text: &str, report: &mut Report) -> Parsed {
    if let Some(looks_like) = another_format(text) {
        return nothing_of(source, text, 0..0, looks_like, report);
    }
    if let Some((at, _)) = text.bytes().enumerate().filter(|(_, byte)| MARKS.contains(byte)).nth(MOST_MARKS) {
        let message = format!(
            "the file has more than {MOST_MARKS} brackets, equals signs, commas, points, quotation marks and line ends"
        );
        let help = "split it, or put many moves into a table of points";
        report.error(Span::new(source, &(at..at)), message, help);
        return Parsed { table: Table::default(), broken: std::iter::once(0..text.len()).collect() };
    }
    let (table, errors) = parse_to_the_end(source, text);
    if is_hardly_toml(text, &errors) {
        let first = errors.first().map_or(0..0, |error| error.span.clone());
        return nothing_of(source, text, first, "most of its lines are neither `key = value` nor `[table]`", report);
    }
    let mut broken: Vec<Range<usize>> = Vec::new();
    let mut places = None;
    for error in errors {
        // Errors after the first one in a line are mostly its consequences. They come in the order of their lines.
        if broken.last().is_some_and(|last| error.span.end <= last.end) {
            continue;
        }
        let lines = lines_around(text, &error.span);
        let line = part(text, &lines);
        let is_duplicate = error.kind == Kind::Duplicate;
        // Keys after an unreadable header would seem to belong to the previous table.
        let takes_its_keys = line.trim_start().starts_with('[') && !is_duplicate;
        let end = if takes_its_keys { end_of_table(text, lines.end) } else { lines.end };
        broken.push(lines.start..end);
        let (message, help) = if is_duplicate {
            places.get_or_insert_with(|| Places::of(text, &table)).duplicate(
                part(text, &error.span),
                line,
                error.span.start,
            )
        } else {
            let is_unquoted = error.kind == Kind::Unquoted;
            let help = if is_unquoted { "write texts and quantities as in \"250 mm\"" } else { "" };
            (error.message, help.to_owned())
        };
        report.error(Span::new(source, &error.span), message, help);
    }
    Parsed { table, broken }
}

/// Separators between the elements of a file. Each costs up to half a kilobyte until the file is a scenario.
const MARKS: &[u8] = b"[]{}=,.\"'\n";
/// Largest number of separators in a file: that of 20 000 moves with a limit each.
const MOST_MARKS: usize = 300_000;

/// Description of a text whose first character cannot begin a TOML file.
fn another_format(text: &str) -> Option<&'static str> {
    match text.trim_start_matches('\u{feff}').trim_start().chars().next()? {
        '{' => Some("it looks like JSON"),
        '<' => Some("it looks like XML or HTML"),
        '\0' => Some("it is not text"),
        _ => None,
    }
}

/// Smallest number of unreadable lines for a text that is not TOML; fewer are separate mistakes in a scenario.
const HARDLY_TOML: usize = 8;

/// True if more than half of the lines with contents cannot be read.
fn is_hardly_toml(text: &str, errors: &[SyntaxError]) -> bool {
    let wrong = errors.iter().filter(|error| error.kind != Kind::Duplicate);
    let starts: BTreeSet<usize> = wrong.map(|error| lines_around(text, &error.span).start).collect();
    let is_said = |line: &&str| !line.trim().is_empty() && !line.trim_start().starts_with('#');
    starts.len() >= HARDLY_TOML && 2 * starts.len() > text.lines().filter(is_said).count()
}

/// A single mistake for a text that is not TOML.
fn nothing_of(source: SourceId, text: &str, place: Range<usize>, why: &str, report: &mut Report) -> Parsed {
    let message = format!("this is not TOML: {why}");
    report.error(Span::new(source, &place), message, "a scenario is a TOML file: see docs/scenario.md");
    Parsed { table: Table::default(), broken: std::iter::once(0..text.len()).collect() }
}

/// Places of headers and keys, which may be duplicated.
struct Places<'a> {
    /// Offset of each line.
    lines: Vec<usize>,
    /// First line of each header, from 1.
    headers: BTreeMap<String, usize>,
    /// Keys and their offsets.
    keys: BTreeSet<(&'a str, usize)>,
}

impl<'a> Places<'a> {
    fn of(text: &str, table: &'a Table) -> Self {
        let mut places = Self { lines: Vec::new(), headers: BTreeMap::new(), keys: BTreeSet::new() };
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            places.lines.push(start);
            places.headers.entry(header(line)).or_insert(places.lines.len());
            start += line.len();
        }
        places.add(table);
        places
    }

    fn add(&mut self, table: &'a Table) {
        for Entry { key, key_span, node } in &table.entries {
            self.keys.insert((key, key_span.start));
            match &node.value {
                Value::Table(inner) => self.add(inner),
                Value::Array(items) => {
                    items.iter().filter_map(|item| item.value.as_table()).for_each(|item| self.add(item));
                }
                _ => {}
            }
        }
    }

    /// Message for a second `key` at `at` in `line`, and a help with the place of the first.
    fn duplicate(&self, key: &str, line: &str, at: usize) -> (String, String) {
        let line_at = |at: usize| self.lines.partition_point(|start| *start <= at);
        let header = header(line);
        let (what, first) = if header.starts_with('[') {
            let first = self.headers.get(&header).copied().filter(|first| *first < line_at(at));
            (format!("a second table `{header}`"), first)
        } else {
            // Keys of one table are adjacent: the nearest one before is the first of two.
            let first = self.keys.range((key, 0)..(key, at)).next_back().map(|(_, first)| line_at(*first));
            (format!("duplicate key `{key}`"), first)
        };
        (what, first.map_or(String::new(), |first| format!("the first one is on line {first}")))
    }
}

/// A header line without comment and spaces, in which two headers of one table may differ.
fn header(line: &str) -> String {
    line.split('#').next().unwrap_or(line).split_whitespace().collect()
}

/// A part of the text. The parser may have seen spaces in place of other characters: a range that begins or ends within a
/// character yields an empty part.
fn part<'a>(text: &'a str, range: &Range<usize>) -> &'a str {
    text.get(range.clone()).unwrap_or_default()
}

/// End of the last line before the next header after `from`, or of the text.
fn end_of_table(text: &str, from: usize) -> usize {
    let mut at = from;
    for line in part(text, &(from..text.len())).split_inclusive('\n') {
        if line.trim_start().starts_with('[') {
            return at.saturating_sub(1).max(from);
        }
        at += line.len();
    }
    text.len()
}

/// Number of repetitions: the parser stops at a key without a value; it then gets the text without that line.
const MAX_GIVEN_UP: usize = 64;
/// Largest number of bytes that are parsed again for this, in total.
const MOST_PARSED_AGAIN: usize = 1 << 20;

fn parse_to_the_end(source: SourceId, text: &str) -> (Table, Vec<SyntaxError>) {
    let mut text = text.to_owned();
    let mut given_up = Vec::new();
    loop {
        let (root, errors) = DeTable::parse_recoverable(&text);
        let table = table(source, root.get_ref());
        let mut errors: Vec<SyntaxError> = errors.iter().map(SyntaxError::of).collect();
        errors.sort_by_key(|error| error.span.start);
        let stop = errors.iter().find(|error| error.kind == Kind::KeyWithoutValue).cloned();
        let line = stop.as_ref().map(|stop| lines_around(&text, &stop.span));
        let may_go_on = given_up.len() < MAX_GIVEN_UP && given_up.len() * text.len() < MOST_PARSED_AGAIN;
        if let (Some(stop), Some(line), true) = (stop, line, may_go_on) {
            // Spaces keep the offsets of all other bytes.
            text.replace_range(line.clone(), &" ".repeat(line.len()));
            given_up.push(stop);
            continue;
        }
        errors.extend(given_up);
        let mut errors = at_the_opening(errors, &table);
        errors.sort_by_key(|error| error.span.start);
        return (table, errors);
    }
}

/// An unclosed list or table consumes the following lines: one error at its opening bracket replaces and covers all errors that
/// follow from it.
fn at_the_opening(errors: Vec<SyntaxError>, table: &Table) -> Vec<SyntaxError> {
    let unclosed = |error: &SyntaxError| {
        let is_value = error.kind == Kind::Unclosed;
        is_value.then(|| widest_value_up_to(error.span.start, table)).flatten()
    };
    let swallowed: Vec<Span> = errors.iter().filter_map(unclosed).collect();
    let is_free =
        |error: &SyntaxError| !swallowed.iter().any(|span| (span.start..=span.end).contains(&error.span.start));
    let mut kept: Vec<SyntaxError> = errors.into_iter().filter(is_free).collect();
    kept.extend(swallowed.iter().map(|span| {
        let message = "this bracket is not closed".to_owned();
        SyntaxError { span: span.start..span.end, kind: Kind::Unclosed, message }
    }));
    kept
}

/// The widest list or inline table that ends at `end`.
fn widest_value_up_to(end: usize, table: &Table) -> Option<Span> {
    table
        .entries
        .iter()
        .filter_map(|entry| match &entry.node.value {
            Value::Array(_) | Value::Table(_) if entry.node.span.end == end => Some(entry.node.span),
            Value::Table(inner) => widest_value_up_to(end, inner),
            _ => None,
        })
        .min_by_key(|span| span.start)
}

/// The range with its lines completed on both sides.
fn lines_around(text: &str, range: &Range<usize>) -> Range<usize> {
    let bytes = text.as_bytes();
    let (first, last) = (range.start.min(bytes.len()), range.end.min(bytes.len()));
    let start = bytes[..first].iter().rposition(|&b| b == b'\n').map_or(0, |i| i + 1);
    let end = bytes[last..].iter().position(|&b| b == b'\n').map_or(bytes.len(), |i| last + i);
    start..end
}

fn table(source: SourceId, from: &DeTable<'_>) -> Table {
    let mut entries: Vec<Entry> = from
        .iter()
        .map(|(key, value)| Entry {
            key: key.get_ref().to_string(),
            key_span: Span::new(source, &key.span()),
            node: Node { value: self::value(source, value.get_ref()), span: Span::new(source, &value.span()) },
        })
        .collect();
    entries.sort_by_key(|entry| entry.key_span);
    Table { entries }
}

/// The value of the one key of `text`, `key = value`.
///
/// # Errors
/// The message of the parser, or that the text is not a single value.
pub(crate) fn parse_one(source: SourceId, text: &str) -> Result<Node, String> {
    let root = DeTable::parse(text).map_err(|error| error.message().to_owned())?;
    let mut entries = table(source, root.get_ref()).entries;
    match (entries.pop(), entries.is_empty()) {
        (Some(entry), true) => Ok(entry.node),
        _ => Err("it is not a single value".to_owned()),
    }
}

fn value(source: SourceId, from: &DeValue<'_>) -> Value {
    match from {
        DeValue::Table(from) => Value::Table(table(source, from)),
        DeValue::Array(from) => Value::Array(
            from.iter()
                .map(|item| Node { value: value(source, item.get_ref()), span: Span::new(source, &item.span()) })
                .collect(),
        ),
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Boolean(value) => Value::Bool(*value),
        DeValue::Datetime(_) => Value::Date,
        DeValue::Float(number) => {
            let text = number.as_str().to_owned();
            Value::Number(Number { value: text.parse().unwrap_or(f64::NAN), text, whole: None })
        }
        DeValue::Integer(number) => {
            let text = number.as_str().to_owned();
            let whole = i64::from_str_radix(&text, number.radix()).ok();
            // An integer beyond 64 bits is far outside of every bound.
            Value::Number(Number { value: whole.map_or(f64::INFINITY, |whole| whole as f64), text, whole })
        }
    }
}

#[cfg(test)]
mod tests;
