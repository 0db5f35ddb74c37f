//! The table at the end of a run: what failed last, directly above the count, with the reasons below its row.
use crate::metric_table::metric_table;
use crate::row_notes::row_notes;
use crate::style::{Ink, Style};
use crate::text::{widest, wrapped};
use servobench_metrics::{Name, Quantity};
use servobench_results::printable;
use servobench_results::{Outcome, Results, RunResult};

/// Numbers that every row shows, with their headings.
const COLUMNS: [(&str, Name); 4] = [
    ("MOVE", Name::MoveTime),
    ("SETTLING", Name::SettlingTime),
    ("PEAK ERR", Name::FollowingErrorPeakLoad),
    ("VIBR P-P", Name::ResidualVibrationPp),
];
/// `-814 µrad` fits.
const NUMBER: usize = 9;
const VERDICT: usize = 9;
const INDENT: usize = VERDICT + 2;
/// Longer names than the terminal has room for in a row stand in a line of their own; the column is never narrower.
const SHORTEST_NAME: usize = 12;

/// Outcomes in the order of tables and counts: what needs somebody to act is at the end, where the screen is.
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

/// Runs with their verdicts and main numbers: what passed, what failed with the reasons, then overrides and the count. Below a row
/// stands too what is lifted, and a handful of warnings and events. A single run, and with `all_metrics` every run, shows
/// all its metrics. Names are complete.
///
/// MOVE is the set-point's duration, SETTLING the time after it until the load stays in its window, PEAK ERR the peak
/// following error of the load, VIBR P-P its residual vibration, peak-to-peak.
#[must_use]
pub fn verdict_table(results: &Results, style: Style, all_metrics: bool) -> String {
    let runs = &results.scenarios;
    let mut table = String::new();
    if let [run] = runs.as_slice()
        && has_metrics(run)
    {
        table += &metric_table(run, style);
        line(&mut table, "");
    }
    let columns = Columns::of(runs, style);
    line(&mut table, &style.paint(Ink::Heading, &columns.heading()));
    for outcome in ORDER {
        for run in runs.iter().filter(|run| run.verdict == outcome) {
            columns.row(&mut table, run, runs, style);
            table += &row_notes(run, INDENT, style);
            if all_metrics && runs.len() > 1 && has_metrics(run) {
                table += &metric_table(run, style);
                line(&mut table, "");
            }
        }
    }
    line(&mut table, "");
    for (k, part) in wrapped(&overridden(results), style.width.saturating_sub(2)).iter().enumerate() {
        line(&mut table, &format!("{}{part}", if k == 0 { "" } else { "  " }));
    }
    line(&mut table, &summary(results, style));
    table
}

/// Which keys had another value than the files give them; empty where none had.
fn overridden(results: &Results) -> String {
    let mut all: Vec<&str> = Vec::new();
    for one in results.scenarios.iter().flat_map(|run| &run.overrides) {
        if !all.contains(&one.as_str()) {
            all.push(one);
        }
    }
    if all.is_empty() { String::new() } else { printable(&format!("overrides: {}", all.join(", "))) }
}

/// One line for each run that did not pass, the overrides and the count.
#[must_use]
pub fn brief(results: &Results) -> String {
    let runs = &results.scenarios;
    let bad = ORDER.into_iter().filter(|outcome| !outcome.is_good());
    let bad = bad.flat_map(|outcome| runs.iter().filter(move |run| run.verdict == outcome));
    let mut text = String::new();
    for run in bad {
        let engine = if run.engine.is_empty() { String::new() } else { format!(" on {}", run.engine) };
        let first = run.reasons.first().map_or("", String::as_str);
        let more = run.reasons.len().saturating_sub(1);
        let more = if more > 0 { format!(" (and {more} more)") } else { String::new() };
        let name = told_apart(run, runs);
        line(&mut text, &printable(&format!("{:VERDICT$}{name}{engine}: {first}{more}", shown(run.verdict).0)));
    }
    let overridden = overridden(results);
    if !overridden.is_empty() {
        line(&mut text, &overridden);
    }
    line(&mut text, &summary(results, Style::default()));
    text
}

/// Whether there are metrics that mean something.
fn has_metrics(run: &RunResult) -> bool {
    run.verdict.is_whole() && !run.metrics.is_empty()
}

/// Name of a run: of two files with the same name, the file.
fn told_apart(run: &RunResult, runs: &[RunResult]) -> String {
    let is_like = |other: &RunResult| other.name == run.name && other.file != run.file;
    let name = match &run.file {
        Some(file) if runs.iter().any(is_like) => file.strip_suffix(".toml").unwrap_or(file),
        _ => &run.name,
    };
    printable(name).trim().to_owned()
}

/// How wide names and engines are.
struct Columns {
    name: usize,
    engine: usize,
}

impl Columns {
    fn of(runs: &[RunResult], style: Style) -> Self {
        let engine = widest(runs.iter().map(|run| run.engine.as_str())).max("ENGINE".len());
        let fixed = INDENT + 2 + engine + 1 + COLUMNS.len() * (NUMBER + 1);
        let room = style.width.saturating_sub(fixed).max(SHORTEST_NAME);
        let names: Vec<String> = runs.iter().map(|run| told_apart(run, runs)).collect();
        let name = widest(names.iter().map(String::as_str)).max("SCENARIO".len()).min(room);
        Self { name, engine }
    }

    fn heading(&self) -> String {
        let Self { name, engine } = self;
        let titles = COLUMNS.map(|(title, _)| format!(" {title:>NUMBER$}")).concat();
        format!("{:VERDICT$}  {:name$}  {:engine$} {titles}", "VERDICT", "SCENARIO", "ENGINE")
    }

    /// The row of `run`; a name that does not fit stands in full above its numbers.
    fn row(&self, table: &mut String, run: &RunResult, runs: &[RunResult], style: Style) {
        let (word, ink) = shown(run.verdict);
        let verdict = style.paint(ink, &format!("{word:VERDICT$}"));
        let full = told_apart(run, runs);
        let numbers = self.numbers(run, style);
        if full.chars().count() <= self.name {
            let name = self.name;
            line(table, format!("{verdict}  {full:name$}  {numbers}").trim_end());
            return;
        }
        let characters: Vec<char> = full.chars().collect();
        for (k, part) in characters.chunks(style.width.saturating_sub(INDENT).max(SHORTEST_NAME)).enumerate() {
            let start = if k == 0 { format!("{verdict}  ") } else { format!("{:INDENT$}", "") };
            line(table, &format!("{start}{}", part.iter().collect::<String>()));
        }
        line(table, format!("{:INDENT$}{:name$}  {numbers}", "", "", name = self.name).trim_end());
    }

    /// Engine and numbers.
    fn numbers(&self, run: &RunResult, style: Style) -> String {
        let mut text = format!("{:engine$} ", run.engine, engine = self.engine);
        for (_, metric) in COLUMNS {
            // What a run that broke off has measured says nothing.
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

fn summary(results: &Results, style: Style) -> String {
    let runs = results.scenarios.len();
    let parts = ORDER.into_iter().map(|outcome| (outcome, results.count_of(outcome))).filter(|(_, count)| *count > 0);
    let mut parts: Vec<_> =
        parts.map(|(outcome, count)| style.paint(shown(outcome).1, &format!("{count} {}", outcome.word()))).collect();
    let unfinished = results.unfinished.len();
    if unfinished > 0 {
        parts.push(style.paint(shown(Outcome::Error).1, &format!("{unfinished} more did not end")));
    }
    format!("{runs} run{}: {}", if runs == 1 { "" } else { "s" }, parts.join(", "))
}

fn line(table: &mut String, text: &str) {
    table.push_str(text);
    table.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::style::shown;
    use servobench_results::samples;

    #[test]
    fn at_eighty_columns() {
        let table = verdict_table(&samples::results(), Style::default(), false);
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
                   expected, but did not come: 8611h of `drive` from 0.5 s on
                   lifted: stable: the velocity loop has a pole outside the unit
                     circle
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
        "#);
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    }

    #[test]
    fn names_are_complete_at_any_width() {
        let name = "feed-axis-reversal-at-low-speed-with-stick-slip";
        for width in [40, 80, 120] {
            let table = verdict_table(&samples::results(), Style { width, colour: false }, false);
            let whole: String = table.split_whitespace().collect();
            assert!(whole.contains(name), "{table}");
        }
        let table = verdict_table(&samples::results(), Style { width: 120, colour: false }, false);
        assert!(table.lines().any(|line| line.contains(name) && line.contains("45.1 µm")), "one row: {table}");
    }

    /// What somebody calls a scenario is no command to the terminal, nor to a runner that reads it.
    #[test]
    fn names_are_no_commands() {
        let mut run = samples::short();
        run.name = "x\u{1b}[2J\n::error file=a.rs,line=1::all is fine".into();
        let results = Results::new(vec![run]);
        for text in [verdict_table(&results, Style::default(), false), brief(&results)] {
            assert!(text.contains("x\u{fffd}[2J ::error file=a.rs,line=1::all is fine"), "{text}");
            assert!(
                !text.contains('\u{1b}') && text.lines().all(|line| !line.trim_start().starts_with("::")),
                "{text}"
            );
        }
    }

    #[test]
    fn in_brief_each_run_that_did_not_pass_has_a_line() {
        insta::assert_snapshot!(brief(&samples::results()), @r#"
        FAILED   feed-axis-reversal-at-low-speed-with-stick-slip on mujoco: settling_time 35.2 ms, limit 20.0 ms (and 2 more)
        FAILED   pick on exact: arrives: the load ended 200 mm short of 200 mm (window ±5 µm); effort limit bound for 1.99 s (and 2 more)
        ERROR    two-mass on rapier: the mechanics diverged at 0.123 s: the position of `load` is not finite; take a smaller step than 1.00 ms
        INVALID  two-mass on rapier: `axis.mjcf.file`: there is no `arm.xml`
        7 runs: 1 passed, 2 unjudged (no limits), 2 failed, 1 error, 1 invalid
        "#);
    }

    #[test]
    fn colours_only_when_asked_for() {
        let plain = verdict_table(&samples::results(), Style::default(), false);
        let coloured = shown(&verdict_table(&samples::results(), Style { width: 80, colour: true }, false), true);
        assert!(!plain.contains('\x1b') && coloured.contains("\x1b[1;31mFAILED"), "{coloured}");
        let mut bare = coloured;
        for code in ["\x1b[0m", "\x1b[1m", "\x1b[2m", "\x1b[32m", "\x1b[33m", "\x1b[1;31m"] {
            bare = bare.replace(code, "");
        }
        assert_eq!(bare, plain);
    }
}
