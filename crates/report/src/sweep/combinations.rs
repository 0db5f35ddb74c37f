//! A row for each combination of the keys.
use super::dimension::Dimension;
use super::metric::{Measure, at_least, percent};
use super::survey::{CONFIDENCE, Spread, Survey};
use crate::style::{Ink, Style};
use crate::text::{elided, widest, wrapped};
use servobench_sweep::Outcome;

/// Most rows; of more, the best ones.
const MOST_ROWS: usize = 20;
/// Columns between two cells.
const APART: usize = 2;
/// Width of a line of a heading.
const WORD: usize = 10;
/// Largest width of a value: `-814.1 µrad`.
pub(super) const NUMBER: usize = 12;
/// Largest width of a key's column.
const KEY: usize = 18;
/// Most lines of a heading.
const LINES: usize = 4;
/// Columns for which the keys leave room: verdict, time and vibration.
const MAIN: usize = 3;

/// A column of the table.
struct Cells {
    heading: Vec<String>,
    rows: Vec<String>,
    /// True for rows to highlight.
    bad: Vec<bool>,
    is_number: bool,
}

impl Cells {
    fn width(&self) -> usize {
        widest(self.heading.iter().chain(&self.rows).map(String::as_str))
    }

    /// Width with the gap to the next column.
    fn room(&self) -> usize {
        self.width() + APART
    }

    fn aligned(&self, text: &str) -> String {
        let width = self.width();
        if self.is_number { format!("{text:>width$}") } else { format!("{text:width$}") }
    }

    /// Two columns of numbers below one heading.
    fn pair(heading: Vec<String>, [one, other]: [(&str, Vec<String>); 2], bad: Vec<bool>) -> Self {
        let width =
            |(title, cells): &(&str, Vec<String>)| widest(cells.iter().map(String::as_str)).max(title.chars().count());
        let (first, second) = (width(&one), width(&other));
        let row = |(left, right): (&String, &String)| format!("{left:>first$}  {right:>second$}");
        let cells = one.1.iter().zip(&other.1).map(row).collect();
        let titles = format!("{:>first$}  {:>second$}", one.0, other.0);
        let heading = heading.into_iter().chain([titles]).collect();
        Self { heading, rows: cells, bad, is_number: true }
    }
}

/// The table of all combinations; empty if there is only one.
pub(super) fn combinations(survey: &Survey<'_, '_>, style: Style) -> String {
    if survey.dimensions.is_empty() {
        return String::new();
    }
    let (groups, order) = rows(survey);
    let mut numbers: Vec<(Option<usize>, Cells)> = Vec::new();
    if survey.is_judged {
        numbers.push((None, verdicts(survey, &groups)));
    }
    let all = survey.metrics.in_order(&survey.table);
    numbers.extend(all.into_iter().map(|column| (Some(column), metric(survey, column, &groups))));
    let keys = keys(survey, &groups);
    let main: usize = numbers.iter().take(MAIN).map(|(_, cells)| cells.room()).sum();
    let of_keys: usize = keys.iter().map(Cells::room).sum();
    let is_in_row = keys.iter().all(|cells| cells.width() <= KEY) && of_keys + main <= style.width + APART;
    let mut columns = if is_in_row { keys } else { vec![numbers_of(&groups)] };
    let mut left_out = Vec::new();
    let mut room = (style.width + APART).saturating_sub(columns.iter().map(Cells::room).sum());
    for (column, cells) in numbers {
        if cells.room() <= room {
            room -= cells.room();
            columns.push(cells);
        } else {
            left_out.extend(column);
        }
    }
    let mut text = heading(&columns, style);
    for (row, group) in groups.iter().enumerate() {
        if !is_in_row {
            text += &broken(&format!("{}  {}", row + 1, survey.words(*group)), style.width);
        }
        text += &line(&columns, row, style);
    }
    text += &faint(&order, style);
    if !left_out.is_empty() {
        let name = |column: &usize| Measure::of(&survey.table.columns[*column]).name;
        let names: Vec<String> = left_out.iter().map(name).collect();
        text += &faint(&format!("without room here: {}", names.join(", ")), style);
    }
    text
}

/// Groups in the order of the rows, and a description of that order.
fn rows(survey: &Survey<'_, '_>) -> (Vec<usize>, String) {
    let count = survey.table.groups();
    if count <= MOST_ROWS {
        return ((0..count).collect(), format!("{count} combinations in the order of the keys{}", of_draws(survey)));
    }
    let first = survey.metrics.time.or_else(|| survey.metrics.in_order(&survey.table).first().copied());
    let median = |group: &usize| first.and_then(|column| survey.spread(column, *group)).map(|spread| spread.median);
    let key = |group: &usize| (survey.is_marked(*group), median(group).unwrap_or(f64::INFINITY));
    let mut all: Vec<(usize, (bool, f64))> = (0..count).map(|group| (group, key(&group))).collect();
    all.sort_by(|(_, one), (_, other)| one.0.cmp(&other.0).then(one.1.total_cmp(&other.1)));
    let groups = all.into_iter().take(MOST_ROWS).map(|(group, _)| group).collect();
    let by = first.map_or(String::new(), |column| {
        let name = Measure::of(&survey.table.columns[column]).name;
        format!(" by {name}, the smallest first")
    });
    let good = match (survey.is_judged, survey.is_drawn) {
        (true, false) => ", what keeps all limits before the rest",
        (true, true) => ", what at least 95 % of the draws keep all limits with before the rest",
        (false, _) => "",
    };
    let rest = count - MOST_ROWS;
    (groups, format!("{MOST_ROWS} of {count} combinations{by}{good}; {rest} more are not shown{}", of_draws(survey)))
}

fn of_draws(survey: &Survey<'_, '_>) -> String {
    let draws = survey.table.sweep.draws_of_each();
    if survey.is_drawn { format!("; of {draws} draws each") } else { String::new() }
}

/// Columns of the keys.
fn keys(survey: &Survey<'_, '_>, groups: &[usize]) -> Vec<Cells> {
    let of = |dimension: &Dimension| {
        let cells: Vec<String> = groups.iter().map(|group| dimension.label(*group).to_owned()).collect();
        let heading = parts(&dimension.name, &['.', ',', '_'], WORD.max(widest(cells.iter().map(String::as_str))));
        Cells { heading, bad: vec![false; cells.len()], is_number: dimension.numbers.is_some(), rows: cells }
    };
    survey.dimensions.iter().map(of).collect()
}

/// Numbers of the rows, if the keys do not fit.
fn numbers_of(groups: &[usize]) -> Cells {
    let cells = vec![String::new(); groups.len()];
    Cells { heading: Vec::new(), bad: vec![false; cells.len()], is_number: false, rows: cells }
}

/// Outcomes of the runs; for draws the share that keeps all limits and its lower bound.
fn verdicts(survey: &Survey<'_, '_>, groups: &[usize]) -> Cells {
    let bad: Vec<bool> = groups.iter().map(|group| survey.is_marked(*group)).collect();
    if survey.is_drawn {
        let share = groups.iter().map(|group| percent(survey.kept(*group).share())).collect();
        let bound = groups.iter().map(|group| at_least(survey.kept(*group).at_least(CONFIDENCE))).collect();
        return Cells::pair(vec!["ALL LIMITS KEPT".to_owned()], [("BY", share), ("AT LEAST", bound)], bad);
    }
    let word = |group: &usize| {
        let has = |outcome| survey.table.count_of(outcome, *group) > 0;
        match () {
            () if has(Outcome::Failed) || has(Outcome::Broken) => "FAILED".to_owned(),
            () if has(Outcome::Good) => "passed".to_owned(),
            () => "none".to_owned(),
        }
    };
    Cells { heading: vec!["VERDICT".to_owned()], rows: groups.iter().map(word).collect(), bad, is_number: false }
}

/// A metric; for draws its median and the bound that 95 % of them keep.
fn metric(survey: &Survey<'_, '_>, column: usize, groups: &[usize]) -> Cells {
    let measure = Measure::of(&survey.table.columns[column]);
    let spreads: Vec<Option<Spread>> = groups.iter().map(|group| survey.with_never(column, *group)).collect();
    let cells = |pick: fn(&Spread) -> f64| -> Vec<String> {
        let cell = |spread: &Spread| elided(&measure.text(pick(spread)), NUMBER);
        spreads.iter().map(|spread| spread.as_ref().map_or("–".to_owned(), cell)).collect()
    };
    let bad = vec![false; groups.len()];
    let heading = |width| parts(&measure.name, &['_', '.'], width);
    if survey.is_drawn {
        let columns = [("MEDIAN", cells(|spread| spread.median)), ("95 %", cells(|spread| spread.high))];
        return Cells::pair(heading(2 * WORD), columns, bad);
    }
    let cells = cells(|spread| spread.median);
    Cells { heading: heading(WORD), rows: cells, bad, is_number: true }
}

/// The headings above each other, their last lines level.
fn heading(columns: &[Cells], style: Style) -> String {
    let lines = columns.iter().map(|cells| cells.heading.len()).max().unwrap_or(0);
    let mut text = String::new();
    for line in 0..lines {
        let cell = |cells: &Cells| {
            let before = lines - cells.heading.len();
            let word = line.checked_sub(before).map_or("", |at| cells.heading[at].as_str());
            cells.aligned(word)
        };
        let row: Vec<String> = columns.iter().map(cell).collect();
        text += &style.paint(Ink::Heading, row.join("  ").trim_end());
        text.push('\n');
    }
    text
}

fn line(columns: &[Cells], row: usize, style: Style) -> String {
    let cell = |cells: &Cells| {
        let cell = cells.aligned(&cells.rows[row]);
        if cells.bad[row] { style.paint(Ink::Bad, &cell) } else { cell }
    };
    let row: Vec<String> = columns.iter().map(cell).collect();
    format!("{}\n", row.join("  ").trim_end())
}

/// A name in lines of at most `width` characters, broken after one of `breaks`; the middle of a longer part is left out.
pub(super) fn parts(name: &str, breaks: &[char], width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in name.split_inclusive(breaks) {
        let part = elided(part.trim_start(), width);
        match lines.last_mut() {
            Some(line) if line.chars().count() + part.chars().count() <= width => line.push_str(&part),
            _ => lines.push(part),
        }
    }
    if lines.len() > LINES {
        let end = lines.split_off(lines.len() - LINES / 2);
        lines.truncate(LINES - LINES / 2 - 1);
        lines.push("…".to_owned());
        lines.extend(end);
    }
    lines
}

/// `text` in lines of at most `width` characters, broken between words, and within longer words.
pub(super) fn broken(text: &str, width: usize) -> String {
    let mut out = String::new();
    for line in wrapped(text, width.saturating_sub(2)) {
        let characters: Vec<char> = line.chars().collect();
        for part in characters.chunks(width.saturating_sub(2).max(1)) {
            let indent = if out.is_empty() { "" } else { "  " };
            out += indent;
            out.extend(part);
            out.push('\n');
        }
    }
    out
}

/// A note below a table.
pub(super) fn faint(text: &str, style: Style) -> String {
    painted(text, Ink::Faint, style)
}

/// `text` in one colour, wrapped.
pub(super) fn painted(text: &str, ink: Ink, style: Style) -> String {
    let lines = broken(text, style.width);
    let lines = lines.lines().map(|line| style.paint(ink, line) + "\n");
    lines.collect()
}
