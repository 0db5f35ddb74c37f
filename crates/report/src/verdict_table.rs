//! The table at the end of a run: failures last, directly above the count, with the reasons below each row.
use crate::metric_table::metric_table;
use crate::row_notes::row_notes;
use crate::style::{Ink, Style};
use crate::text::{widest, wrapped};
use servobench_metrics::{Name, Quantity};
use servobench_results::{JournalError, Outcome, RunHead, RunResult, Runs, printable};
use servobench_trace::of_axis;
use std::collections::{HashMap, HashSet};
use std::iter::once;

/// Numbers that every row shows, with their headings.
const COLUMNS: [(&str, Name); 4] = [
    ("MOVE", Name::MoveTime),
    ("SETTLING", Name::SettlingTime),
    ("PEAK ERR", Name::FollowingErrorPeakLoad),
    ("VIBR P-P", Name::ResidualVibrationPp),
];
/// Width of `-814 µrad`.
const NUMBER: usize = 9;
const VERDICT: usize = 9;
const INDENT: usize = VERDICT + 2;
/// Narrowest column of names: names too long for a row of the terminal are on a separate line.
const SHORTEST_NAME: usize = 12;

/// Outcomes in the order of tables and counts: those that need action come last, where the eye is.
pub(crate) const ORDER: [Outcome; 5] =
    [Outcome::Passed, Outcome::Unjudged, Outcome::Failed, Outcome::Error, Outcome::Invalid];

/// The word in the first column, and its colour.
const fn shown(outcome: Outcome) -> (&'static str, Ink) {
    match outcome {
        Outcome::Passed => ("passed", Ink::Good),
        Outcome::Unjudged => ("no limits", Ink::Warning),
        Outcome::Failed => ("FAILED", Ink::Bad),
        Outcome::Error => ("ERROR", Ink::Bad),
        Outcome::Invalid => ("INVALID", Ink::Bad),
    }
}

/// Runs with their verdicts and main numbers: those that passed, those that failed with the reasons, then overrides and the count. Below
/// a row are also lifted requirements, and a few warnings and events. A single run, and with `all_metrics` every run, shows
/// all its metrics. Names are complete.
///
/// MOVE is the set-point's duration, SETTLING the time after it until the load stays in its window, PEAK ERR the peak
/// following error of the load, VIBR P-P its residual vibration, peak-to-peak.
///
/// The parts add up to one text, whole lines each.
///
/// # Errors
/// [`JournalError`] in place of a run that cannot be read.
pub fn verdict_table(runs: &dyn Runs, style: Style, all_metrics: bool) -> impl Iterator<Item = Part> {
    let heads: Vec<_> = runs.heads().collect();
    let names = told_apart(&heads);
    let columns = Columns::of(&heads, &names, style);
    let is_single = heads.len() == 1;
    let start = match heads.as_slice() {
        [head] => runs.result(head.index).map(|run| metrics_of(&run, style)),
        _ => Ok(String::new()),
    };
    let start = start.map(|metrics| format!("{metrics}{}\n", style.paint(Ink::Heading, &columns.heading())));
    let rows: Vec<(usize, String)> = in_order(&heads).into_iter().map(|k| (heads[k].index, names[k].clone())).collect();
    let rows = rows.into_iter().map(move |(index, name)| {
        let run = runs.result(index)?;
        let mut row = columns.row(&run, &name, style);
        row += &row_notes(&run, INDENT, style);
        if all_metrics && !is_single {
            row += &metrics_of(&run, style);
        }
        Ok(row)
    });
    let mut end = String::from("\n");
    for (k, part) in wrapped(&overridden(runs), style.width.saturating_sub(2)).iter().enumerate() {
        line(&mut end, &format!("{}{part}", if k == 0 { "" } else { "  " }));
    }
    line(&mut end, &outcome_count(runs, style));
    let doubtful = doubtful_count(runs, style);
    if !doubtful.is_empty() {
        line(&mut end, &doubtful);
    }
    once(start).chain(rows).chain(once(Ok(end)))
}

/// A part of a text about runs, or the reason why it is missing.
type Part = Result<String, JournalError>;

/// Indices into `heads`, in the order of [`ORDER`].
fn in_order(heads: &[RunHead<'_>]) -> Vec<usize> {
    let mut places: Vec<usize> = (0..heads.len()).collect();
    places.sort_by_key(|k| ORDER.iter().position(|outcome| *outcome == heads[*k].verdict));
    places
}

/// All metrics of a run that has any, and an empty line.
fn metrics_of(run: &RunResult, style: Style) -> String {
    let has_metrics = run.verdict.is_whole() && !run.metrics.is_empty();
    if has_metrics { metric_table(run, style) + "\n" } else { String::new() }
}

/// Keys whose values were overridden; empty without any.
fn overridden(runs: &dyn Runs) -> String {
    let all = runs.overrides();
    if all.is_empty() { String::new() } else { printable(&format!("overrides: {}", all.join(", "))) }
}

/// One line for each run that did not pass, the overrides and the count. The parts add up to one text.
///
/// # Errors
/// [`JournalError`] in place of a run that cannot be read.
pub fn brief(runs: &dyn Runs) -> impl Iterator<Item = Part> {
    let heads: Vec<_> = runs.heads().collect();
    let names = told_apart(&heads);
    let bad = in_order(&heads).into_iter().filter(|k| !heads[*k].verdict.is_good());
    let bad: Vec<(usize, String)> = bad.map(|k| (heads[k].index, names[k].clone())).collect();
    let rows = bad.into_iter().map(|(index, name)| {
        let run = runs.result(index)?;
        let engine = if run.engine.is_empty() { String::new() } else { format!(" on {}", run.engine) };
        let first = run.reasons.first().map_or("", String::as_str);
        let more = run.reasons.len().saturating_sub(1);
        let more = if more > 0 { format!(" (and {more} more)") } else { String::new() };
        Ok(printable(&format!("{:VERDICT$}{name}{engine}: {first}{more}", shown(run.verdict).0)) + "\n")
    });
    let mut end = String::new();
    let overridden = overridden(runs);
    if !overridden.is_empty() {
        line(&mut end, &overridden);
    }
    line(&mut end, &run_count(runs, Style::default()));
    rows.chain(once(Ok(end)))
}

/// Names of runs, with those of their axes; the files where two of them have the same name.
fn told_apart(heads: &[RunHead<'_>]) -> Vec<String> {
    let mut first = HashMap::new();
    let mut shared = HashSet::new();
    for head in heads {
        if *first.entry(head.name).or_insert(head.file) != head.file {
            shared.insert(head.name);
        }
    }
    let name = |head: &RunHead<'_>| {
        let file = head.file.filter(|_| shared.contains(head.name));
        let name = file.map_or(head.name, |file| file.strip_suffix(".toml").unwrap_or(file));
        format!("{}{}", printable(name).trim(), of_axis(head.axis))
    };
    heads.iter().map(name).collect()
}

/// Widths of names and engines.
struct Columns {
    name: usize,
    engine: usize,
}

impl Columns {
    fn of(heads: &[RunHead<'_>], names: &[String], style: Style) -> Self {
        let engine = widest(heads.iter().map(|head| head.engine)).max("ENGINE".len());
        let fixed = INDENT + 2 + engine + 1 + COLUMNS.len() * (NUMBER + 1);
        let room = style.width.saturating_sub(fixed).max(SHORTEST_NAME);
        let name = widest(names.iter().map(String::as_str)).max("SCENARIO".len()).min(room);
        Self { name, engine }
    }

    fn heading(&self) -> String {
        let Self { name, engine } = self;
        let titles = COLUMNS.map(|(title, _)| format!(" {title:>NUMBER$}")).concat();
        format!("{:VERDICT$}  {:name$}  {:engine$} {titles}", "VERDICT", "SCENARIO", "ENGINE")
    }

    /// The row of `run`, whose name is `full`; if that does not fit it goes above the numbers.
    fn row(&self, run: &RunResult, full: &str, style: Style) -> String {
        let (word, ink) = shown(run.verdict);
        let verdict = style.paint(ink, &format!("{word:VERDICT$}"));
        let numbers = self.numbers(run, style);
        let mut row = String::new();
        if full.chars().count() <= self.name {
            let name = self.name;
            line(&mut row, format!("{verdict}  {full:name$}  {numbers}").trim_end());
            return row;
        }
        let characters: Vec<char> = full.chars().collect();
        for (k, part) in characters.chunks(style.width.saturating_sub(INDENT).max(SHORTEST_NAME)).enumerate() {
            let start = if k == 0 { format!("{verdict}  ") } else { format!("{:INDENT$}", "") };
            line(&mut row, &format!("{start}{}", part.iter().collect::<String>()));
        }
        line(&mut row, format!("{:INDENT$}{:name$}  {numbers}", "", "", name = self.name).trim_end());
        row
    }

    /// Engine and numbers.
    fn numbers(&self, run: &RunResult, style: Style) -> String {
        let mut text = format!("{:engine$} ", run.engine, engine = self.engine);
        for (_, metric) in COLUMNS {
            // Measurements of a run that broke off mean nothing.
            let value = run.metric(metric).filter(|_| run.verdict.is_whole());
            let cell = value.map_or("–".into(), |(value, unit)| Quantity::new(value, unit).to_string());
            let missed = run.metrics.get(metric.as_str()).is_some_and(|metric| metric.pass == Some(false));
            let cell = format!("{cell:>NUMBER$}");
            text.push(' ');
            text.push_str(&if missed { style.paint(Ink::Bad, &cell) } else { cell });
        }
        text
    }
}

/// Counts of runs by outcome, and of those with lifted requirements or warnings, in a line: `31 runs: 30 passed, 1 failed; 2 with
/// something lifted, 1 with warnings`.
#[must_use]
pub fn run_count(runs: &dyn Runs, style: Style) -> String {
    let (outcomes, doubtful) = (outcome_count(runs, style), doubtful_count(runs, style));
    if doubtful.is_empty() { outcomes } else { format!("{outcomes}; {doubtful}") }
}

/// Counts of runs by outcome: `31 runs: 30 passed, 1 failed`.
fn outcome_count(runs: &dyn Runs, style: Style) -> String {
    let parts = ORDER.into_iter().map(|outcome| (outcome, runs.count_of(outcome))).filter(|(_, count)| *count > 0);
    let mut parts: Vec<_> =
        parts.map(|(outcome, count)| style.paint(shown(outcome).1, &format!("{count} {}", outcome.word()))).collect();
    let unfinished = runs.unfinished().count();
    if unfinished > 0 {
        parts.push(style.paint(shown(Outcome::Error).1, &format!("{unfinished} more did not end")));
    }
    let count = runs.heads().count();
    format!("{count} run{}: {}", if count == 1 { "" } else { "s" }, parts.join(", "))
}

/// Counts of finished runs with lifted requirements or warnings; empty without any.
fn doubtful_count(runs: &dyn Runs, style: Style) -> String {
    let count =
        |is_so: fn(&RunHead<'_>) -> bool| runs.heads().filter(|head| head.verdict.is_whole() && is_so(head)).count();
    let counts = [
        (count(|head| head.lifts), "with something lifted"),
        (count(|head| head.warns == Some(true)), "with warnings"),
    ];
    let parts = counts.into_iter().filter(|(count, _)| *count > 0);
    parts.map(|(count, what)| style.paint(Ink::Warning, &format!("{count} {what}"))).collect::<Vec<_>>().join(", ")
}

fn line(table: &mut String, text: &str) {
    table.push_str(text);
    table.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::shown;
    use servobench_results::{Results, samples};

    /// The whole table, every part of it.
    fn table_of(results: &Results, style: Style) -> String {
        verdict_table(results, style, false).collect::<Result<_, _>>().unwrap()
    }

    fn brief_of(results: &Results) -> String {
        brief(results).collect::<Result<_, _>>().unwrap()
    }

    #[test]
    fn at_eighty_columns() {
        let table = table_of(&samples::results(), Style::default());
        insta::assert_snapshot!(table, @r#"
        VERDICT    SCENARIO              ENGINE       MOVE  SETTLING  PEAK ERR  VIBR P-P
        passed     kept                  exact      1.00 s         –         –         –
                   lifted: bounded
                   FMU load logged 1 warning, the last at 0.2000 s: the valve is
                     closed against a pressure of more than 2 bar
                   voltage limit bound for 500 ms
        no limits  lambrechts-jerk       exact      1.30 s   4.00 ms   3.10 µm   3.40 µm
        no limits  lambrechts-snap       exact      1.35 s       0 s    730 nm    210 nm
        FAILED     feed-axis-reversal-at-low-speed-with-stick-slip
                                         mujoco     500 ms   35.2 ms   45.1 µm   8.30 µm
                   settling_time            35.2 ms  limit 20.0 ms, 76 % over
                   residual_vibration_pp    8.30 µm  limit 2.00 µm, 4.2 times as much
                   current_peak could not be measured: `current.d` is not recorded;
                     only a PMSM has a current
                   effort limit bound for 100 ms
        FAILED     pick                  exact      650 ms         –         –         –
                   arrives: the load ended 200 mm short of 200 mm (window ±5 µm);
                     effort limit bound for 1.99 s
                   executed: `jog` was never executed: `home.Done` did not come
                   expected, but did not occur: 8611h of `drive` from 0.5 s on
                   lifted: stable: the velocity loop has a pole outside the unit
                     circle
                   lifted: 8611h of `drive` from 0.5 s on
                   two frames were lost
        ERROR      two-mass              rapier          –         –         –         –
                   the mechanics diverged at 0.123 s: the position of `load` is not
                     finite; take a smaller step than 1.00 ms
                   FMU load said:
                     0.0010 s  solver: Gear, order 5
                     0.1220 s  warning: Newton's method did not converge within
                               10 iterations; a smaller step is taken (121 times since
                               0.0010 s)
                     0.1230 s  error: the pressure in `tank.p` is negative
        INVALID    two-mass              rapier          –         –         –         –
                   `axis.mjcf.file`: there is no `arm.xml`

        7 runs: 1 passed, 2 unjudged (no limits), 2 failed, 1 error, 1 invalid
        2 with something lifted, 1 with warnings
        "#);
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    }

    #[test]
    fn axes_have_their_names() {
        let mut results = samples::results();
        for (run, name) in results.scenarios.iter_mut().zip(["x", "gantry-left_2"].into_iter().cycle()) {
            run.axis = Some(name.parse().unwrap());
        }
        let table = table_of(&results, Style::default());
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
        assert!(table.contains("no limits  lambrechts-jerk (axis x)\n"), "{table}");
        assert!(table.contains("feed-axis-reversal-at-low-speed-with-stick-slip (axis gantry-left_2)\n"), "{table}");
        assert!(brief_of(&results).contains("two-mass (axis x) on rapier: "), "{}", brief_of(&results));
    }

    #[test]
    fn names_are_complete_at_any_width() {
        let name = "feed-axis-reversal-at-low-speed-with-stick-slip";
        for width in [40, 80, 120] {
            let table = table_of(&samples::results(), Style { width, colour: false });
            let whole: String = table.split_whitespace().collect();
            assert!(whole.contains(name), "{table}");
        }
        let table = table_of(&samples::results(), Style { width: 120, colour: false });
        assert!(table.lines().any(|line| line.contains(name) && line.contains("45.1 µm")), "one row: {table}");
    }

    /// A foreign scenario name is not a command to the terminal, nor to a CI runner that reads the output.
    #[test]
    fn names_are_no_commands() {
        let mut run = samples::short();
        run.name = "x\u{1b}[2J\n::error file=a.rs,line=1::all is fine".into();
        let results = Results::new(vec![run]);
        for text in [table_of(&results, Style::default()), brief_of(&results)] {
            assert!(text.contains("x\u{fffd}[2J ::error file=a.rs,line=1::all is fine"), "{text}");
            assert!(
                !text.contains('\u{1b}') && text.lines().all(|line| !line.trim_start().starts_with("::")),
                "{text}"
            );
        }
    }

    #[test]
    fn in_brief_each_run_that_did_not_pass_has_a_line() {
        insta::assert_snapshot!(brief_of(&samples::results()), @r#"
        FAILED   feed-axis-reversal-at-low-speed-with-stick-slip on mujoco: settling_time 35.2 ms, limit 20.0 ms (and 2 more)
        FAILED   pick on exact: arrives: the load ended 200 mm short of 200 mm (window ±5 µm); effort limit bound for 1.99 s (and 2 more)
        ERROR    two-mass on rapier: the mechanics diverged at 0.123 s: the position of `load` is not finite; take a smaller step than 1.00 ms
        INVALID  two-mass on rapier: `axis.mjcf.file`: there is no `arm.xml`
        7 runs: 1 passed, 2 unjudged (no limits), 2 failed, 1 error, 1 invalid; 2 with something lifted, 1 with warnings
        "#);
    }

    #[test]
    fn colours_only_when_asked_for() {
        let plain = table_of(&samples::results(), Style::default());
        let coloured = shown(&table_of(&samples::results(), Style { width: 80, colour: true }), true);
        assert!(!plain.contains('\x1b') && coloured.contains("\x1b[1;31mFAILED"), "{coloured}");
        let mut bare = coloured;
        for code in ["\x1b[0m", "\x1b[1m", "\x1b[2m", "\x1b[32m", "\x1b[33m", "\x1b[1;31m"] {
            bare = bare.replace(code, "");
        }
        assert_eq!(bare, plain);
    }
}
