//! Notes below the row of a run: failures, lifted requirements, and a few warnings and events.
use crate::bound_limits::bound_limits;
use crate::failures::{lifted, missed_limits, other_failures};
use crate::said::{last_words, warnings};
use crate::style::{Ink, Style};
use crate::text::{widest, wrapped};
use servobench_results::printable;
use servobench_results::{Outcome, RunResult};
use servobench_trace::Event;

/// Most warnings and events listed for a run, and most reasons of one that was not executed; the others are counted.
const MOST: usize = 5;
/// Width of `-814 µrad`.
const NUMBER: usize = 9;

/// The lines below a row, each indented by `indent`.
pub(crate) fn row_notes(run: &RunResult, indent: usize, style: Style) -> String {
    let mut notes = Notes { text: String::new(), indent, style };
    if run.verdict == Outcome::Failed {
        notes.missed_limits(run);
        for failure in other_failures(run) {
            notes.wrapped(&failure, None);
        }
    } else {
        notes.a_handful(run.reasons.clone(), None);
    }
    for words in lifted(run) {
        notes.wrapped(&words, Some(Ink::Warning));
    }
    notes.a_handful(remarkable(run), Some(Ink::Warning));
    if !run.verdict.is_whole() {
        for said in last_words(run, style.width.saturating_sub(indent)) {
            notes.line(&said);
        }
    }
    notes.text
}

/// Warnings of the verdict, those of `check`, then events, then limits that bound.
fn remarkable(run: &RunResult) -> Vec<String> {
    let mut all = run.warnings.clone();
    all.extend(run.check_warnings.iter().flatten().map(|warning| format!("check: {warning}")));
    if run.verdict.is_whole() {
        all.extend(warnings(run));
    }
    // A reason or a warning may already describe the event.
    let is_told = |event: &Event| run.reasons.iter().chain(&run.warnings).any(|one| one.contains(&event.message));
    all.extend(run.events.iter().filter(|event| event.limit.is_none() && !is_told(event)).map(happened));
    all.extend(bound_limits(run));
    all
}

/// `at 0.5000 s axis: the command is refused`
fn happened(event: &Event) -> String {
    let Event { start, source, message, .. } = event;
    format!("at {start:.4} s {source}: {message}")
}

struct Notes {
    text: String,
    indent: usize,
    style: Style,
}

impl Notes {
    /// The first few of `all`, and the number of the others.
    fn a_handful(&mut self, mut all: Vec<String>, ink: Option<Ink>) {
        let more = all.len().saturating_sub(MOST);
        if more > 0 {
            all.truncate(MOST);
            all.push(format!("and {more} more: see `results.json`"));
        }
        for text in &all {
            self.wrapped(text, ink);
        }
    }

    /// Limits in columns, those of a move below its name.
    fn missed_limits(&mut self, run: &RunResult) {
        let missed = missed_limits(run);
        let mut of_move = None;
        for limit in &missed {
            if limit.of_move != of_move {
                of_move = limit.of_move;
                if let Some((index, label)) = of_move {
                    self.wrapped(&format!("move {} ({label}):", index + 1), None);
                }
            }
            let together = missed.iter().filter(|other| other.of_move == of_move && other.value.is_some());
            let name = widest(together.map(|other| other.name));
            match &limit.value {
                Some(value) => {
                    let plain = format!("{:name$}  {value:>NUMBER$}  {}", limit.name, limit.words);
                    if self.indent + plain.chars().count() <= self.style.width {
                        let value = self.style.paint(Ink::Bad, &format!("{value:>NUMBER$}"));
                        self.line(&format!("{:name$}  {value}  {}", limit.name, limit.words));
                    } else {
                        self.wrapped(&format!("{} {value}, {}", limit.name, limit.words), None);
                    }
                }
                None => self.wrapped(&format!("{} {}", limit.name, limit.words), None),
            }
        }
    }

    /// Text in wrapped lines; continuation lines are indented further.
    fn wrapped(&mut self, text: &str, ink: Option<Ink>) {
        let room = self.style.width.saturating_sub(self.indent + 2);
        for (k, part) in wrapped(&printable(text), room).iter().enumerate() {
            let part = ink.map_or_else(|| part.clone(), |ink| self.style.paint(ink, part));
            self.line(&format!("{}{part}", if k == 0 { "" } else { "  " }));
        }
    }

    fn line(&mut self, text: &str) {
        let line = format!("{:indent$}{text}", "", indent = self.indent);
        self.text += line.trim_end();
        self.text.push('\n');
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_results::samples;

    #[test]
    fn of_many_events_a_handful_is_shown() {
        let mut run = samples::kept();
        run.warnings = vec!["`jog` was refused: the axis is not homed".into()];
        run.events = (0..9)
            .map(|k| {
                let message = if k == 0 { "the axis is not homed".into() } else { format!("refused {k}") };
                Event::new(f64::from(k), f64::from(k), "jog", message)
            })
            .collect();
        let notes = row_notes(&run, 3, Style::default());
        let lines: Vec<_> = notes.lines().map(str::trim).collect();
        // The warning covers one event already.
        assert_eq!(lines[..2], ["lifted: bounded", "`jog` was refused: the axis is not homed"]);
        assert!(lines.contains(&"at 1.0000 s jog: refused 1"), "{notes}");
        assert_eq!(lines.last(), Some(&"and 5 more: see `results.json`"), "{notes}");
    }
}
