//! Messages of FMUs, below the row of their run: the last ones of a run that broke off, for any other a count of the warnings.
use crate::text::{elided, wrapped};
use servobench_base::Severity;
use servobench_results::RunResult;
use servobench_trace::LogEntry;

/// Most lines of one source shown for a run that broke off: the last ones.
const SHOWN: usize = 8;
/// Most characters of a line that are shown.
const LONGEST: usize = 300;

/// Messages of one source, equal lines together.
struct Voice<'a> {
    source: &'a str,
    lines: Vec<Line<'a>>,
}

/// A message, with its first and last time.
struct Line<'a> {
    severity: Severity,
    text: &'a str,
    start: f64,
    end: f64,
    times: u64,
}

/// Last messages of each source, in lines of at most `width` characters; empty without any.
pub(crate) fn last_words(run: &RunResult, width: usize) -> Vec<String> {
    let mut all = Vec::new();
    for mut voice in voices(&run.log) {
        // Messages of the same time keep their order.
        voice.lines.sort_by(|one, two| one.end.total_cmp(&two.end));
        let before = voice.lines.len().saturating_sub(SHOWN);
        let source = printable(voice.source);
        all.push(match before {
            0 => format!("{source} said:"),
            1 => format!("{source} said, after 1 other line:"),
            _ => format!("{source} said, after {before} other lines:"),
        });
        let lines = &voice.lines[before..];
        let times: Vec<String> = lines.iter().map(|line| format!("{:.4} s", line.end)).collect();
        let time_width = times.iter().map(String::len).max().unwrap_or(0);
        for (line, time) in lines.iter().zip(times) {
            let indent = 2 + time_width + 2;
            let parts = wrapped(&line.words(), width.saturating_sub(indent).max(1));
            all.extend(parts.iter().enumerate().map(|(k, part)| {
                let time = if k == 0 { time.as_str() } else { "" };
                format!("  {time:>time_width$}  {part}")
            }));
        }
    }
    all
}

/// One sentence for each source with warnings: their number, and the last one.
pub(crate) fn warnings(run: &RunResult) -> Vec<String> {
    voices(&run.log).iter().filter_map(Voice::warnings).collect()
}

/// Messages by source, in the order of their first messages.
fn voices(log: &[LogEntry]) -> Vec<Voice<'_>> {
    let mut voices: Vec<Voice<'_>> = Vec::new();
    for entry in log {
        let index = voices.iter().position(|voice| voice.source == entry.source).unwrap_or_else(|| {
            voices.push(Voice { source: &entry.source, lines: Vec::new() });
            voices.len() - 1
        });
        let lines = &mut voices[index].lines;
        let severity = entry.severity;
        if let Some(line) = lines.iter_mut().find(|line| line.severity == severity && line.text == entry.text) {
            line.start = line.start.min(entry.start);
            line.end = line.end.max(entry.end);
            line.times = line.times.saturating_add(entry.times);
        } else {
            let LogEntry { start, end, times, ref text, .. } = *entry;
            lines.push(Line { severity, text, start, end, times });
        }
    }
    voices
}

impl Voice<'_> {
    fn warnings(&self) -> Option<String> {
        let count = |severity| -> u64 {
            self.lines
                .iter()
                .filter(|line| line.severity == severity)
                .map(|line| line.times)
                .fold(0, u64::saturating_add)
        };
        let counts = [(count(Severity::Error), "error"), (count(Severity::Warning), "warning")];
        let counts = counts.into_iter().filter(|(count, _)| *count > 0);
        let counts: Vec<_> =
            counts.map(|(count, what)| format!("{count} {what}{}", if count == 1 { "" } else { "s" })).collect();
        let warned = self.lines.iter().filter(|line| line.severity > Severity::Info);
        let last = warned.max_by(|one, two| one.end.total_cmp(&two.end))?;
        let (source, counts) = (printable(self.source), counts.join(" and "));
        Some(format!("{source} logged {counts}, the last at {:.4} s: {}", last.end, printable(last.text)))
    }
}

impl Line<'_> {
    fn words(&self) -> String {
        let word = match self.severity {
            Severity::Info => "",
            Severity::Warning => "warning: ",
            Severity::Error => "error: ",
        };
        let text = printable(self.text);
        match self.times {
            1 => format!("{word}{text}"),
            times => format!("{word}{text} ({times} times since {:.4} s)", self.start),
        }
    }
}

/// A foreign line made safe for a terminal.
fn printable(text: &str) -> String {
    elided(&servobench_results::printable(text), LONGEST)
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_results::samples;

    fn entry(severity: Severity, start: f64, end: f64, times: u64, text: &str) -> LogEntry {
        LogEntry { source: "FMU load".into(), severity, start, end, times, text: text.into() }
    }

    fn run(log: Vec<LogEntry>) -> RunResult {
        RunResult { log, ..samples::broken() }
    }

    #[test]
    fn equal_lines_are_one() {
        let mut log: Vec<_> =
            (0..10).map(|k| entry(Severity::Warning, f64::from(k), f64::from(k), 1, "stiff")).collect();
        log.push(entry(Severity::Warning, 10.0, 12.5, 4_990, "stiff"));
        log.push(entry(Severity::Error, 11.0, 11.0, 1, "leak"));
        let said = last_words(&run(log.clone()), 80);
        let rows =
            ["FMU load said:", "  11.0000 s  error: leak", "  12.5000 s  warning: stiff (5000 times since 0.0000 s)"];
        assert_eq!(said, rows);
        let sentence = "FMU load logged 1 error and 5000 warnings, the last at 12.5000 s: stiff";
        assert_eq!(warnings(&run(log)), [sentence]);
        assert!(warnings(&run(vec![entry(Severity::Info, 0.0, 0.0, 1, "hello")])).is_empty());
    }

    #[test]
    fn of_many_lines_the_last_are_shown_and_the_others_counted() {
        let log =
            (0..100).map(|k| entry(Severity::Info, f64::from(k), f64::from(k), 1, &format!("line {k}"))).collect();
        let said = last_words(&run(log), 80);
        assert_eq!(said.len(), 9);
        assert_eq!(
            (said[0].as_str(), said[1].as_str()),
            ("FMU load said, after 92 other lines:", "  92.0000 s  line 92")
        );
    }

    #[test]
    fn a_terminal_gets_no_commands() {
        let said = last_words(&run(vec![entry(Severity::Info, 0.0, 0.0, 1, "\x1b[2J\u{7}a\tb")]), 80);
        assert_eq!(said[1], "  0.0000 s  \u{fffd}[2J\u{fffd}a b");
        let long = last_words(&run(vec![entry(Severity::Info, 0.0, 0.0, 1, &"x".repeat(2_000))]), 80);
        assert_eq!(long[1].chars().count(), 12 + LONGEST);
    }
}
