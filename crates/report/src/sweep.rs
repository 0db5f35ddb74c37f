//! What a sweep gave: tables, and drawings over what varied.
//!
//! ```text
//! Table of runs → Survey: dimensions (what varies), spread of each metric in each group
//!     ↳ combinations, quantiles, sensitivities, front                       in words
//!     ↳ heat maps over two dimensions, lines over one, distributions of draws, time against vibration     as SVG
//! ```
mod cells;
mod colours;
mod combinations;
mod dimension;
mod distributions;
mod heat;
mod layers;
mod lines;
mod metric;
mod scale;
mod scatter;
mod sections;

mod sheet;
mod survey;

use crate::style::Style;
use servobench_sweep::{Sweep, Table};
use std::borrow::Cow;
use survey::Survey;

/// What a reader of a sweep looks at.
#[derive(Debug, Clone, Copy, Default)]
pub struct SweepOptions<'a> {
    /// What the sweep is called: headline of drawings.
    pub title: &'a str,
    /// What the numbers are, below the headline: `each at its worst over axis.load.frequency`.
    pub note: &'a str,
    /// The metric that is time; `None`: `move_and_settling_time`, else `move_time`.
    pub time: Option<&'a str>,
    /// The metric that is vibration; `None`: `residual_vibration_amplitude`, else `residual_vibration_pp`.
    pub vibration: Option<&'a str>,
    /// Whether runs are judged by limits. If they are not, nothing is said of how many keep them.
    pub judged: bool,
    /// Vibrations that differ by no more are equal (axis unit).
    pub equal_length: f64,
    /// Key of a seed of random numbers of which too few values were run to tell a difference from chance; empty without one.
    pub seed: &'a str,
}

/// Combinations to choose from: the keys of the machine and the engines are given there.
struct Choice<'a> {
    sweep: Option<Sweep>,
    /// Keys that are given: `axis.load.frequency`.
    given: Vec<&'a str>,
}

impl<'a> Choice<'a> {
    fn of(table: &Table<'a>) -> Self {
        let sweep: &'a Sweep = table.sweep;
        let engines = (table.engines.len() > 1).then_some("the engines");
        let given: Vec<&str> = sweep.machine_keys().iter().map(String::as_str).chain(engines).collect();
        let chosen = if given.is_empty() { None } else { sweep.chosen_for_a_machine() };
        Self { sweep: chosen, given }
    }

    /// The table of what is chosen; `None` where nothing is.
    fn table<'t>(&'t self, table: &'t Table<'a>) -> Option<Cow<'t, Table<'t>>>
    where
        'a: 't,
    {
        match &self.sweep {
            Some(chosen) => Some(Cow::Owned(table.at_worst_on_all_engines(chosen))),
            None => self.given.is_empty().then_some(Cow::Borrowed(table)),
        }
    }

    /// At its worst over what each combination stands.
    fn words(&self) -> String {
        if self.given.is_empty() { String::new() } else { format!("each at its worst over {}", self.given.join(", ")) }
    }
}

/// What a sweep gave, in words of at most [`Style::width`] columns: a row for each combination of the keys and each engine, what draws
/// scatter by, which key costs how much, and the combinations that no other one beats in time and vibration.
///
/// Of draws a row has the median and the value that 95 % of them are within, and the share that keeps all limits with the bound that it is
/// above with 95 % confidence (Clopper and Pearson). A run without a verdict does not keep them, and what it measured is not counted; one that
/// broke a requirement never arrives. Combinations are chosen at their worst over the keys of the machine and the engines.
#[must_use]
pub fn sweep_table(table: &Table<'_>, style: Style, options: &SweepOptions<'_>) -> String {
    let survey = Survey::of(table, options);
    let choice = Choice::of(table);
    let chosen = choice.table(table);
    let chosen = chosen.as_ref().map(|chosen| Survey::of(chosen, options));
    let front = chosen.map_or_else(
        || sections::no_choice(&survey, &choice.given, style),
        |chosen| sections::front(&chosen, &choice.words(), options.seed, style),
    );
    let sections = [
        combinations::combinations(&survey, style),
        sections::quantiles(&survey, style),
        sections::sensitivities(&survey, style),
        front,
        sections::remarks(&survey, options.seed, style),
    ];
    let parts: Vec<String> = sections.into_iter().filter(|part| !part.is_empty()).collect();
    parts.join("\n")
}

/// The metrics of a sweep over what varied, as SVG: over two dimensions colours, over one dimension lines, over draws alone their
/// distribution. Further dimensions are small drawings side by side. `None` where nothing varied or nothing was measured.
#[must_use]
pub fn sweep_map(table: &Table<'_>, options: &SweepOptions<'_>) -> Option<String> {
    let survey = Survey::of(table, options);
    match survey.dimensions.len() {
        0 if survey.is_drawn => distributions::distributions(&survey, options.title),
        0 => None,
        1 => lines::lines(&survey, options.title),
        _ => heat::heat_maps(&survey, options.title),
    }
}

/// Vibration against time of all combinations that are chosen, as SVG, with those that no other one beats in both. Of draws it is the medians.
/// `None` where nothing is chosen, or not both were measured.
#[must_use]
pub fn sweep_front(table: &Table<'_>, options: &SweepOptions<'_>) -> Option<String> {
    let choice = Choice::of(table);
    let table = choice.table(table)?;
    let survey = Survey::of(&table, options);
    let notes = [options.note.to_owned(), choice.words()];
    let notes: Vec<String> = notes.into_iter().filter(|note| !note.is_empty()).collect();
    if survey.dimensions.is_empty() { None } else { scatter::scatter(&survey, options.title, &notes.join("; ")) }
}
