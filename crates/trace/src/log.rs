//! Log messages of the parts of a run, kept within limits: a line repeated at every step would fill the memory.
use crate::number;
use serde::{Deserialize, Serialize};
use servobench_base::Severity;
use std::collections::{BTreeMap, VecDeque};

/// Lines of one source that are kept from the start.
const FIRST: usize = 300;
/// Lines of one source that are kept from the end.
const LAST: usize = 300;
/// Number of times that a repeated line is kept; after that it is counted.
const SINGLE: u64 = 10;
/// Number of different lines of one source that are counted.
const DIFFERENT: usize = 1_000;
/// Bytes of a line that are kept.
const LONGEST: usize = 2_000;

/// A log message of a part of a run, in its own words: a line, or a count of its repetitions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LogEntry {
    /// Its source: `FMU load`.
    pub source: String,
    /// Its severity.
    pub severity: Severity,
    /// Time of the message (s), or of the first of several.
    #[serde(with = "number")]
    pub start: f64,
    /// Time of the last one (s).
    #[serde(with = "number")]
    pub end: f64,
    /// Number of messages between `start` and `end`.
    pub times: u64,
    /// The line.
    pub text: String,
}

impl LogEntry {
    /// The line with its count, if there are several.
    #[must_use]
    pub fn words(&self) -> String {
        let Self { end, times, text, .. } = self;
        if *times > 1 { format!("{text} ({times} times until {end:.4} s)") } else { text.clone() }
    }
}

/// Messages of one source.
#[derive(Debug, Default)]
struct Voice {
    first: Vec<LogEntry>,
    last: VecDeque<LogEntry>,
    /// Count of the lines between the first and the last ones.
    between: Option<LogEntry>,
    /// Count of each line; from [`SINGLE`] on with the counted entry.
    said: BTreeMap<(Severity, String), (u64, Option<LogEntry>)>,
}

/// Messages of all sources, in the order of their first message.
#[derive(Debug, Default)]
pub(crate) struct Log(Vec<(String, Voice)>);

impl Log {
    /// Takes a line, without trailing blanks; an empty one is dropped.
    pub(crate) fn note(&mut self, source: &str, severity: Severity, time: f64, text: &str) {
        let text = clipped(text.trim_end());
        if text.is_empty() {
            return;
        }
        let voice = match self.0.iter().position(|(known, _)| known == source) {
            Some(index) => &mut self.0[index].1,
            None => &mut self.0.push_mut((source.to_owned(), Voice::default())).1,
        };
        voice.note(LogEntry { source: source.to_owned(), severity, start: time, end: time, times: 1, text });
    }

    /// Everything that is kept, in order of time.
    pub(crate) fn finish(self) -> Vec<LogEntry> {
        let mut all: Vec<LogEntry> = self.0.into_iter().flat_map(|(_, voice)| voice.entries()).collect();
        all.sort_by(|one, two| one.start.total_cmp(&two.start));
        all
    }
}

impl Voice {
    fn note(&mut self, entry: LogEntry) {
        let is_known = self.said.len() < DIFFERENT;
        let key = (entry.severity, entry.text.clone());
        if is_known || self.said.contains_key(&key) {
            let (times, counted) = self.said.entry(key).or_default();
            *times += 1;
            if *times > SINGLE {
                count(counted, entry);
                return;
            }
        }
        if self.first.len() < FIRST {
            self.first.push(entry);
            return;
        }
        self.last.push_back(entry);
        if self.last.len() > LAST
            && let Some(old) = self.last.pop_front()
        {
            count(&mut self.between, LogEntry { severity: Severity::Info, ..old });
        }
    }

    fn entries(self) -> impl Iterator<Item = LogEntry> {
        let between = self.between.map(|between| LogEntry {
            text: format!("({} other lines, which are not kept)", between.times),
            times: 1,
            ..between
        });
        let counted = self.said.into_values().filter_map(|(_, counted)| counted);
        self.first.into_iter().chain(between).chain(self.last).chain(counted)
    }
}

/// Adds `entry` to the counted ones.
fn count(counted: &mut Option<LogEntry>, entry: LogEntry) {
    match counted {
        Some(counted) => {
            counted.times += entry.times;
            counted.start = counted.start.min(entry.start);
            counted.end = counted.end.max(entry.end);
        }
        None => *counted = Some(entry),
    }
}

/// The start of a text that may be of any length.
fn clipped(text: &str) -> String {
    if text.len() <= LONGEST {
        return text.to_owned();
    }
    let (start, rest) = text.split_at(text.floor_char_boundary(LONGEST));
    format!("{start} … ({} bytes more)", rest.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHO: &str = "FMU load";

    fn entry(severity: Severity, start: f64, end: f64, times: u64, text: &str) -> LogEntry {
        LogEntry { source: WHO.into(), severity, start, end, times, text: text.into() }
    }

    /// Two lines in turn do not hide a third.
    #[test]
    fn a_line_that_is_said_again_and_again_is_counted() {
        let mut log = Log::default();
        for k in 0..5_000 {
            let t = f64::from(k);
            log.note(WHO, Severity::Warning, t, "stiff");
            log.note(WHO, Severity::Info, t, "step\n");
            if k == 3_000 {
                log.note(WHO, Severity::Error, t, "leak");
            }
        }
        let all = log.finish();
        assert_eq!(all.len(), 23);
        assert_eq!(all[0], entry(Severity::Warning, 0.0, 0.0, 1, "stiff"));
        assert_eq!(all[19], entry(Severity::Info, 9.0, 9.0, 1, "step"));
        let counted = all.iter().filter(|entry| entry.times > 1).cloned().collect::<Vec<_>>();
        let of = |severity, text| entry(severity, 10.0, 4_999.0, 4_990, text);
        assert_eq!(counted, [of(Severity::Info, "step"), of(Severity::Warning, "stiff")]);
        assert_eq!(counted[0].words(), "step (4990 times until 4999.0000 s)");
        assert_eq!(all[22], entry(Severity::Error, 3_000.0, 3_000.0, 1, "leak"));
    }

    #[test]
    fn of_a_flood_the_first_and_the_last_lines_are_kept() {
        let mut log = Log::default();
        for k in 0..10_000 {
            log.note(WHO, Severity::Info, f64::from(k), &format!("line {k}"));
        }
        let all = log.finish();
        assert_eq!(all.len(), FIRST + 1 + LAST);
        assert_eq!((all[299].text.as_str(), all[301].text.as_str()), ("line 299", "line 9700"));
        let between = "(9400 other lines, which are not kept)";
        assert_eq!(all[300], entry(Severity::Info, 300.0, 9_699.0, 1, between));
    }

    #[test]
    fn each_source_has_its_own_room_and_all_are_in_order_of_time() {
        let mut log = Log::default();
        for k in 0..1_000 {
            log.note("FMU chatty", Severity::Info, f64::from(k), &format!("line {k}"));
        }
        log.note(WHO, Severity::Warning, 2.5, "once");
        let all = log.finish();
        assert_eq!(all[3], entry(Severity::Warning, 2.5, 2.5, 1, "once"));
        assert!(all.is_sorted_by(|one, two| one.start <= two.start));
    }

    #[test]
    fn long_lines_are_cut_between_characters() {
        let mut log = Log::default();
        log.note(WHO, Severity::Info, 0.0, &("x".to_owned() + &"µ".repeat(2_000)));
        let all = log.finish();
        assert!(all[0].text.starts_with("xµ") && all[0].text.ends_with("µ … (2002 bytes more)"));
    }
}
