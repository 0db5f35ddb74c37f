//! Variables by causality.
use super::value::{range, start};
use super::{MOST, fitted, others, plain};
use crate::style::{Ink, Style};
use crate::text::widest;
use servobench_fmi::{Causality, Choice, DataType, Dimension, ModelDescription, Variability, Variable, Version};
use std::collections::HashMap;

const GROUPS: [(Causality, &str); 7] = [
    (Causality::Input, "INPUTS"),
    (Causality::Output, "OUTPUTS"),
    (Causality::StructuralParameter, "STRUCTURAL PARAMETERS"),
    (Causality::Parameter, "PARAMETERS"),
    (Causality::CalculatedParameter, "CALCULATED PARAMETERS"),
    (Causality::Local, "LOCAL VARIABLES"),
    (Causality::Independent, "INDEPENDENT VARIABLES"),
];

/// Name, type, unit, start value, range.
const COLUMNS: usize = 5;
const TITLES: [&str; COLUMNS] = ["NAME", "TYPE", "UNIT", "START", "RANGE"];
/// Widest columns, so that all of them fit into 80. A longer name gets a separate line, any other longer
/// text goes below the description.
const WIDEST: [usize; COLUMNS] = [24, 14, 9, 12, 17];
/// A description in a narrower column would not be readable: it goes below.
const NARROWEST_NOTE: usize = 22;
/// Indentation of lines below a variable.
const INDENT: usize = 4;
/// Most variables named in a note.
const MOST_NAMES: usize = 4;

/// All groups that have variables.
pub(super) fn variables(description: &ModelDescription, style: Style) -> String {
    if description.variables.is_empty() {
        return "\nIt has no variables.\n".into();
    }
    let feedthrough = Feedthrough::of(description);
    GROUPS
        .iter()
        .map(|(causality, title)| Group::of(description, *causality, title, &feedthrough))
        .filter(|group| group.count > 0)
        .map(|group| group.text(style))
        .collect()
}

/// Variables of one causality.
struct Group<'a> {
    title: &'a str,
    count: usize,
    /// Remark that holds for all of them.
    remark: &'static str,
    rows: Vec<Row>,
}

impl<'a> Group<'a> {
    fn of(description: &ModelDescription, causality: Causality, title: &'a str, feedthrough: &Feedthrough) -> Self {
        let all = || description.variables.iter().enumerate().filter(|(_, one)| one.causality == causality);
        let rows = all().take(MOST).map(|(at, one)| Row::of(description, one, feedthrough.note(description, at)));
        let remark = if causality == Causality::Output { feedthrough.remark() } else { "" };
        Self { title, count: all().count(), remark, rows: rows.collect() }
    }

    fn text(&self, style: Style) -> String {
        let columns = Columns::of(&self.rows, style);
        let title = format!("{} ({})", self.title, self.count);
        let mut text = format!("\n{}\n", style.paint(Ink::Heading, &title));
        for line in fitted(self.remark, style.width) {
            text += &(line + "\n");
        }
        text += &(style.paint(Ink::Faint, columns.titles().trim_end()) + "\n");
        for row in &self.rows {
            text += &columns.row(row);
        }
        text + &others(self.count, style)
    }
}

/// A variable in words.
struct Row {
    cells: [String; COLUMNS],
    note: String,
}

impl Row {
    fn of(description: &ModelDescription, variable: &Variable, feedthrough: String) -> Self {
        let unit = description.unit(variable).map_or_else(String::new, |unit| plain(&unit.name));
        let data_type = data_type(description, variable);
        let mut cells = [plain(&variable.name), data_type, unit, start(description, variable), range(variable)];
        let mut notes = vec![plain(&variable.description)];
        if variable.variability != usual(variable) {
            notes.push(variable.variability.name().to_owned());
        }
        notes.push(sizes(description, variable));
        if let Some(state) = variable.derivative_of.and_then(|at| description.variables.get(at)) {
            notes.push(format!("derivative of {}", plain(&state.name)));
        }
        if !variable.aliases.is_empty() {
            notes.push(format!("also called {}", names(variable.aliases.iter().map(|alias| alias.name.as_str()))));
        }
        notes.push(feedthrough);
        for (at, word) in [(1, "type"), (2, "unit"), (3, "start"), (4, "range")] {
            if cells[at].chars().count() > WIDEST[at] {
                notes.push(format!("{word} {}", std::mem::replace(&mut cells[at], "…".into())));
            }
        }
        notes.retain(|note| !note.is_empty());
        Self { cells, note: notes.join("; ") }
    }
}

/// Name of the type in this FMI version, or of the enumeration; with the shape of an array.
fn data_type(description: &ModelDescription, variable: &Variable) -> String {
    let name = match (description.enumeration(variable), description.version, variable.data_type) {
        (Some(enumeration), ..) => plain(&enumeration.name),
        (None, Version::Two, DataType::Float64) => "Real".into(),
        (None, Version::Two, DataType::Int32) => "Integer".into(),
        (None, _, data_type) => data_type.name().into(),
    };
    if variable.dimensions.is_empty() {
        return name;
    }
    let extents: Vec<String> = description.shape(variable).iter().map(u64::to_string).collect();
    format!("{name}[{}]", extents.join(","))
}

/// Parameters that set the extents of an array.
fn sizes(description: &ModelDescription, variable: &Variable) -> String {
    let structural = variable.dimensions.iter().filter_map(|dimension| match dimension {
        Dimension::Fixed(_) => None,
        Dimension::Structural(at) => description.variables.get(*at).map(|parameter| parameter.name.as_str()),
    });
    let names = names(structural);
    if names.is_empty() { names } else { format!("size set by {names}") }
}

/// Usual variability, which is not listed.
fn usual(variable: &Variable) -> Variability {
    match variable.causality {
        Causality::Parameter | Causality::StructuralParameter | Causality::CalculatedParameter => Variability::Fixed,
        _ if variable.data_type.is_float() => Variability::Continuous,
        _ => Variability::Discrete,
    }
}

/// The first names, and the number of the others.
fn names<'a>(mut all: impl Iterator<Item = &'a str>) -> String {
    let first: Vec<String> = all.by_ref().take(MOST_NAMES).map(plain).collect();
    let names = first.join(", ");
    match all.count() {
        0 => names,
        others => format!("{names} and {others} more"),
    }
}

/// Inputs that each output follows directly, by position of the output; none where the file does not state it.
struct Feedthrough(HashMap<usize, Option<Vec<usize>>>);

impl Feedthrough {
    /// Without inputs there is no feedthrough.
    fn of(description: &ModelDescription) -> Self {
        let is = |at: usize, causality| description.variables.get(at).is_some_and(|one| one.causality == causality);
        if !(0..description.variables.len()).any(|at| is(at, Causality::Input)) {
            return Self(HashMap::new());
        }
        let outputs = (0..description.variables.len()).filter(|at| is(*at, Causality::Output));
        let mut all: HashMap<_, _> = outputs.map(|at| (at, None)).collect();
        for unknown in &description.structure.outputs {
            let inputs = unknown.dependencies.as_ref().map(|dependencies| {
                dependencies.iter().map(|(at, _)| *at).filter(|at| is(*at, Causality::Input)).collect()
            });
            if let Some(known) = all.get_mut(&unknown.variable) {
                *known = inputs;
            }
        }
        Self(all)
    }

    /// Feedthrough that all outputs have in common.
    fn remark(&self) -> &'static str {
        if self.0.is_empty() {
            ""
        } else if self.0.values().all(Option::is_none) {
            "The file does not say which inputs they follow at once: it may be all."
        } else if self.0.values().all(|known| known.as_ref().is_some_and(Vec::is_empty)) {
            "They follow no input without a step in between."
        } else {
            ""
        }
    }

    /// Inputs that this variable follows, unless the remark covers it.
    fn note(&self, description: &ModelDescription, at: usize) -> String {
        match self.0.get(&at) {
            Some(_) if !self.remark().is_empty() => String::new(),
            None => String::new(),
            Some(None) => "may follow any input at once".into(),
            Some(Some(inputs)) if inputs.is_empty() => "follows no input at once".into(),
            Some(Some(inputs)) => {
                format!("follows {} at once", names(inputs.iter().map(|at| description.variables[*at].name.as_str())))
            }
        }
    }
}

/// Widths of the columns.
struct Columns {
    widths: [usize; COLUMNS],
    /// Width of the column of notes; `None` if they go below.
    note: Option<usize>,
    total: usize,
}

impl Columns {
    /// Columns as wide as these rows need.
    fn of(rows: &[Row], style: Style) -> Self {
        let width = |column: usize| match widest(rows.iter().map(|row| row.cells[column].as_str())) {
            0 => 0,
            widest => widest.max(TITLES[column].len()).min(WIDEST[column]),
        };
        let widths: [usize; COLUMNS] = std::array::from_fn(width);
        let taken: usize = widths.iter().filter(|width| **width > 0).map(|width| width + 1).sum();
        let note = style.width.checked_sub(taken).filter(|rest| *rest >= NARROWEST_NOTE);
        Self { widths, note, total: style.width }
    }

    /// Texts of all columns except empty ones.
    fn line(&self, texts: [&str; COLUMNS]) -> String {
        let cells = self.widths.iter().zip(texts).filter(|(width, _)| **width > 0);
        cells.map(|(width, text)| format!("{text:width$} ")).collect::<Vec<_>>().concat()
    }

    fn titles(&self) -> String {
        self.line(TITLES) + if self.note.is_some() { "DESCRIPTION" } else { "" }
    }

    fn row(&self, row: &Row) -> String {
        let [name, data_type, unit, start, range] = row.cells.each_ref().map(String::as_str);
        let mut text = String::new();
        let mut first = name;
        if name.chars().count() > self.widths[0] {
            let characters: Vec<char> = name.chars().collect();
            for part in characters.chunks(self.total.max(1)) {
                text += &(part.iter().collect::<String>() + "\n");
            }
            first = "";
        }
        let beside = self.note.map(|width| fitted(&row.note, width)).unwrap_or_default();
        let empty = [""; COLUMNS];
        for at in 0..beside.len().max(1) {
            let cells = self.line(if at == 0 { [first, data_type, unit, start, range] } else { empty });
            let note = beside.get(at).map_or("", String::as_str);
            text += &(format!("{cells}{note}").trim_end().to_owned() + "\n");
        }
        if self.note.is_none() {
            for line in fitted(&row.note, self.total.saturating_sub(INDENT)) {
                text = text + &" ".repeat(INDENT) + &line + "\n";
            }
        }
        text
    }
}
