//! The table at the end of a run: what failed first, each missed limit below its run.
use crate::bound_limits::bound_limits;
use crate::metric_table::metric_table;
use crate::ordered::Ordered;
use crate::results::{MetricResult, Outcome, Results, RunResult};
use crate::said::{last_words, warnings};
use crate::style::{Ink, Style};
use crate::text::{elided, widest, wrapped};
use servobench_metrics::{Name, Quantity};

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
/// A scenario's name is elided to this rather than making the table wider than the terminal.
const SHORTEST_NAME: usize = 12;

/// Outcomes in the order of the table and of the count: the word in the table, that of the count, colour.
const OUTCOMES: [(Outcome, &str, &str, Ink); 5] = [
    (Outcome::Input, "BAD INPUT", "wrong input", Ink::Bad),
    (Outcome::Error, "ERROR", "not carried out", Ink::Bad),
    (Outcome::Failed, "FAILED", "failed", Ink::Bad),
    (Outcome::Unjudged, "no limits", "without limits", Ink::Warning),
    (Outcome::Passed, "passed", "passed", Ink::Good),
];

/// Runs with their verdicts and main numbers: wrong input, errors and failures first, with the reasons and the limits
/// missed; then what passed; then the count. What FMUs said is below their run: the last of it if the run broke off, else how
/// much of it warns. A single run, and with `all_metrics` every run, shows all its metrics.
///
/// MOVE is the set-point's duration, SETTLING the time after it until the load stays in its window, PEAK ERR the peak
/// following error of the load, VIBR P-P its residual vibration, peak-to-peak.
#[must_use]
pub fn verdict_table(results: &Results, style: Style, all_metrics: bool) -> String {
    let runs = &results.scenarios;
    let engine = widest(runs.iter().map(|run| run.engine.as_str())).max("ENGINE".len());
    let fixed = INDENT + 2 + engine + 1 + COLUMNS.len() * (NUMBER + 1);
    let names: Vec<&str> = runs.iter().map(|run| told_apart(run, runs)).collect();
    let widest_name = widest(names.iter().copied()).max("SCENARIO".len());
    let name = widest_name.min(style.width.saturating_sub(fixed)).max(SHORTEST_NAME);
    let mut table = String::new();
    let titles = COLUMNS.map(|(title, _)| format!(" {title:>NUMBER$}")).concat();
    let heading = format!("{:VERDICT$}  {:name$}  {:engine$} {titles}", "VERDICT", "SCENARIO", "ENGINE");
    line(&mut table, &style.paint(Ink::Heading, &heading));
    for (outcome, word, _, ink) in OUTCOMES {
        let verdict = style.paint(ink, &format!("{word:VERDICT$}"));
        for (run, full) in runs.iter().zip(&names).filter(|(run, _)| run.verdict == outcome) {
            let start = format!("{verdict}  {:name$}  {:engine$} ", elided(full, name), run.engine);
            row(&mut table, &start, run, style);
            if all_metrics && runs.len() > 1 && has_metrics(run) {
                table += &metric_table(run, style);
                line(&mut table, "");
            }
        }
    }
    if let [run] = runs.as_slice()
        && has_metrics(run)
    {
        line(&mut table, "");
        table += &metric_table(run, style);
    }
    line(&mut table, "");
    line(&mut table, &summary(results, style));
    table
}

/// Whether there are metrics that mean something.
fn has_metrics(run: &RunResult) -> bool {
    run.verdict.is_whole() && !run.metrics.is_empty()
}

/// Name of a run: of two files with the same name, the file.
fn told_apart<'a>(run: &'a RunResult, runs: &[RunResult]) -> &'a str {
    let is_like = |other: &RunResult| other.name == run.name && other.file != run.file;
    match &run.file {
        Some(file) if runs.iter().any(is_like) => file.strip_suffix(".toml").unwrap_or(file),
        _ => &run.name,
    }
}

fn row(table: &mut String, start: &str, run: &RunResult, style: Style) {
    let mut text = start.to_owned();
    for (_, metric) in COLUMNS {
        // What a run that broke off has measured says nothing.
        let value = run.metric(metric).filter(|_| run.verdict.is_whole());
        let cell = value.map_or("–".into(), |(value, unit)| Quantity::new(value, unit).to_string());
        let missed = run.metrics.get(metric.as_str()).is_some_and(|metric| metric.pass == Some(false));
        let cell = format!("{cell:>NUMBER$}");
        text.push(' ');
        text.push_str(&if missed { style.paint(Ink::Bad, &cell) } else { cell });
    }
    line(table, text.trim_end());
    if run.verdict == Outcome::Failed {
        missed_limits(table, &run.metrics, &run.absent, style);
        for (index, made) in run.moves.iter().enumerate() {
            if made.metrics.iter().any(|(_, metric)| metric.pass == Some(false)) {
                line(table, &format!("{:INDENT$}move {} ({}):", "", index + 1, made.label));
                missed_limits(table, &made.metrics, &run.absent, style);
            }
        }
    } else {
        for reason in &run.reasons {
            indented(table, reason, None, style);
        }
    }
    for bound in bound_limits(&run.events) {
        line(table, &format!("{:INDENT$}{}", "", style.paint(Ink::Warning, &bound)));
    }
    if run.verdict.is_whole() {
        for warning in &warnings(run) {
            indented(table, warning, Some(Ink::Warning), style);
        }
    } else {
        let said = last_words(run, style.width.saturating_sub(INDENT));
        for said in &said {
            line(table, &format!("{:INDENT$}{said}", ""));
        }
    }
}

/// `text` below a row; what does not fit in one line is indented further.
fn indented(table: &mut String, text: &str, ink: Option<Ink>, style: Style) {
    for (k, part) in wrapped(text, style.width.saturating_sub(INDENT + 2)).iter().enumerate() {
        let part = ink.map_or_else(|| part.clone(), |ink| style.paint(ink, part));
        line(table, &format!("{:INDENT$}{}{part}", "", if k == 0 { "" } else { "  " }));
    }
}

fn missed_limits(table: &mut String, metrics: &Ordered<MetricResult>, absent: &Ordered<String>, style: Style) {
    let missed: Vec<_> = metrics.iter().filter(|(_, metric)| metric.pass == Some(false)).collect();
    let name = widest(missed.iter().map(|(name, _)| *name));
    for (metric_name, metric) in missed {
        let Some(value) = metric.value else {
            let why = absent.get(metric_name).map_or("it is not measured here", String::as_str);
            indented(table, &format!("{metric_name} could not be measured: {why}"), None, style);
            continue;
        };
        let digits = metric.digits(value);
        let value_text = format!("{:>NUMBER$.digits$}", Quantity::new(value, &metric.unit));
        let value_text = style.paint(Ink::Bad, &value_text);
        let bound = missed_bound(metric_name, metric, value);
        let text = format!("{:INDENT$}{metric_name:name$}  {value_text}  {bound}", "");
        line(table, text.trim_end());
    }
}

/// `limit 20.0 ms, 76 % over`
fn missed_bound(name: &str, metric: &MetricResult, value: f64) -> String {
    let digits = metric.digits(value);
    let bound = |bound: f64| format!("{:.digits$}", Quantity::new(bound, &metric.unit));
    let size = if name.parse::<Name>().is_ok_and(Name::is_signed) { value.abs() } else { value };
    let below = metric.limit_min.filter(|min| size < *min);
    let (words, limit) = match (below, metric.limit) {
        (Some(min), _) => (format!("limit at least {}", bound(min)), min),
        (None, Some(max)) => (format!("limit {}", bound(max)), max),
        (None, None) => return String::new(),
    };
    let share = 100.0 * (size / limit - 1.0);
    match share {
        _ if limit <= 0.0 || !share.is_finite() => words,
        share if below.is_some() => format!("{words}, {} under", percent(-share)),
        // Several times over is easier to grasp than a thousand per cent.
        share if share >= 200.0 => format!("{words}, {:.2} times as much", Quantity::new(size / limit, "")),
        share => format!("{words}, {} over", percent(share)),
    }
}

/// Two digits, and no miss looks like none.
fn percent(share: f64) -> String {
    if share < 0.1 { "less than 0.1 %".into() } else { format!("{:.2} %", Quantity::new(share, "")) }
}

fn summary(results: &Results, style: Style) -> String {
    let runs = results.scenarios.len();
    let counts = OUTCOMES.into_iter().map(|(outcome, _, word, ink)| (results.count(outcome), word, ink));
    let parts: Vec<_> = counts
        .filter(|(count, ..)| *count > 0)
        .map(|(count, word, ink)| style.paint(ink, &format!("{count} {word}")))
        .collect();
    format!("{runs} run{}: {}", if runs == 1 { "" } else { "s" }, parts.join(", "))
}

fn line(table: &mut String, text: &str) {
    table.push_str(text);
    table.push('\n');
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples;

    #[test]
    fn at_eighty_columns() {
        let table = verdict_table(&samples::results(), Style::default(), false);
        insta::assert_snapshot!(table, @r#"
        VERDICT    SCENARIO              ENGINE       MOVE  SETTLING  PEAK ERR  VIBR P-P
        BAD INPUT  two-mass              rapier          –         –         –         –
                   `axis.mjcf.file`: there is no `arm.xml`
        ERROR      two-mass              rapier          –         –         –         –
                   the mechanics diverged at 0.123 s: the position of `load` is not
                     finite; take a smaller step than 1.00 ms
                   FMU load said:
                     0.0010 s  solver: Gear, order 5
                     0.1220 s  warning: Newton's method did not converge within
                               10 iterations; a smaller step is taken (121 times since
                               0.0010 s)
                     0.1230 s  error: the pressure in `tank.p` is negative
        FAILED     feed-axis-…tick-slip  mujoco     500 ms   35.2 ms   45.1 µm   8.30 µm
                   settling_time            35.2 ms  limit 20.0 ms, 76 % over
                   residual_vibration_pp    8.30 µm  limit 2.00 µm, 4.2 times as much
                   current_peak could not be measured: `current.d` is not recorded;
                     only a PMSM has a current
                   effort limit bound for 100 ms
        no limits  lambrechts-jerk       exact      1.30 s   4.00 ms   3.10 µm   3.40 µm
        no limits  lambrechts-snap       exact      1.35 s       0 s    730 nm    210 nm
        passed     kept                  exact      1.00 s         –         –         –
                   voltage limit bound for 500 ms
                   FMU load logged 1 warning, the last at 0.2000 s: the valve is
                     closed against a pressure of more than 2 bar

        6 runs: 1 wrong input, 1 not carried out, 1 failed, 2 without limits, 1 passed
        "#);
        assert!(table.lines().all(|line| line.chars().count() <= 80), "{table}");
    }

    #[test]
    fn a_wide_terminal_shows_whole_names() {
        let table = verdict_table(&samples::results(), Style { width: 120, colour: false }, false);
        assert!(table.contains("feed-axis-reversal-at-low-speed-with-stick-slip"), "{table}");
    }

    #[test]
    fn colours_only_when_asked_for() {
        let plain = verdict_table(&samples::results(), Style::default(), false);
        let coloured = verdict_table(&samples::results(), Style { width: 80, colour: true }, false);
        assert!(!plain.contains('\x1b') && coloured.contains("\x1b[1;31mFAILED"), "{coloured}");
        let mut bare = coloured;
        for code in ["\x1b[0m", "\x1b[1m", "\x1b[2m", "\x1b[32m", "\x1b[33m", "\x1b[1;31m"] {
            bare = bare.replace(code, "");
        }
        assert_eq!(bare, plain);
    }

    #[test]
    fn how_far_beyond_a_limit() {
        let metric =
            |limit_min, limit| MetricResult { value: None, unit: "s".into(), limit, limit_min, pass: Some(false) };
        assert_eq!(missed_bound("steady_state_error", &metric(None, Some(0.02)), 0.0352), "limit 20.0 ms, 76 % over");
        assert_eq!(missed_bound("steady_state_error", &metric(None, Some(0.02)), -0.0352), "limit 20.0 ms, 76 % over");
        assert_eq!(
            missed_bound("steady_state_error", &metric(None, Some(0.02)), 0.1),
            "limit 20.0 ms, 5.0 times as much"
        );
        assert_eq!(
            missed_bound("steady_state_error", &metric(None, Some(0.02)), 0.020_000_1),
            "limit 20.00000 ms, less than 0.1 % over"
        );
        assert_eq!(
            missed_bound("steady_state_error", &metric(Some(1.0), Some(2.0)), 0.9),
            "limit at least 1.00 s, 10 % under"
        );
        assert_eq!(
            missed_bound("steady_state_error", &metric(Some(1.0), Some(2.0)), -0.9),
            "limit at least 1.00 s, 10 % under"
        );
        assert_eq!(missed_bound("steady_state_error", &metric(None, Some(0.0)), 0.9), "limit 0 s");
    }
}
