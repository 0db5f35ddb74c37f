//! The signals of one source, a row each.
use super::stretch::{Stretch, stretches};
use super::window::Window;
use servobench_trace::{Call, CallFate, Recording, Signal};

/// Values of an idle signal.
const IDLE: [&str; 4] = ["FALSE", "0", "16#0000", "none"];

/// Numbers with more values than this are drawn as a curve.
const MOST_BARS: usize = 12;

/// The signals of one source.
#[derive(Debug)]
pub(super) struct Group<'a> {
    pub(super) source: &'a str,
    pub(super) rows: Vec<Row<'a>>,
}

/// Visible part of one signal.
#[derive(Debug)]
pub(super) struct Row<'a> {
    pub(super) name: &'a str,
    pub(super) stretches: Vec<Stretch<'a>>,
    pub(super) kind: Kind,
}

/// Kind of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A signal whose values are TRUE and FALSE.
    Logic,
    /// A signal with other values.
    States,
    /// A number that changes too often for readable bars.
    Number,
    /// Reason why a call did not finish, if the run may do without it.
    Excused,
    /// Reason why a call did not finish, if it should have.
    Missed,
}

impl<'a> Group<'a> {
    /// Groups of `recording` for `sources`, or for all, in the order of their first appearance. A call that was never executed, or
    /// that failed, has a row with the reason before its signals; one without signals comes after the call before it.
    pub(super) fn all(recording: &'a Recording, sources: &[String], window: Window) -> Vec<Self> {
        let mut groups: Vec<Self> = Vec::new();
        let is_asked_for = |source: &str| sources.is_empty() || sources.iter().any(|name| name == source);
        for signal in &recording.signals {
            let source = signal.source.as_str();
            if !is_asked_for(source) {
                continue;
            }
            let row = Row::of(signal, window);
            match groups.iter_mut().find(|group| group.source == source) {
                Some(group) => group.rows.push(row),
                None => groups.push(Self { source, rows: vec![row] }),
            }
        }
        let mut next = 0;
        for call in recording.calls.iter().filter(|call| is_asked_for(&call.name)) {
            let at = groups.iter().position(|group| group.source == call.name);
            if let Some(row) = Row::of_fate(call, window) {
                if at.is_none() {
                    groups.insert(next, Self { source: &call.name, rows: vec![] });
                }
                groups[at.unwrap_or(next)].rows.insert(0, row);
                next = at.unwrap_or(next) + 1;
            } else if let Some(at) = at {
                next = at + 1;
            }
        }
        groups
    }

    /// True if every row is idle.
    pub(super) fn is_idle(&self) -> bool {
        self.rows.iter().all(Row::is_idle)
    }
}

impl<'a> Row<'a> {
    fn of(signal: &'a Signal, window: Window) -> Self {
        let is_logic = signal.changes.iter().all(|(_, value)| value == "TRUE" || value == "FALSE");
        let stretches = stretches(signal, window);
        let is_number = || stretches.len() > MOST_BARS && stretches.iter().all(|stretch| stretch.number().is_some());
        let kind = match is_logic {
            true => Kind::Logic,
            false if is_number() => Kind::Number,
            false => Kind::States,
        };
        Self { name: &signal.name, stretches, kind }
    }

    /// Reason why `call` was never executed or did not finish, over the whole window, or failed, from then on; `None` for any other.
    fn of_fate(call: &'a Call, window: Window) -> Option<Self> {
        let (name, since, why) = match &call.fate {
            CallFate::Executed => return None,
            CallFate::NeverExecuted(why) => ("never executed", window.from, why),
            CallFate::Unfinished(why) => ("unfinished", window.from, why),
            CallFate::Failed { time, message, .. } => ("failed", *time, message),
        };
        let kind = if call.is_optional { Kind::Excused } else { Kind::Missed };
        // Not a number, or after the window.
        let is_seen = since <= window.to;
        let from = since.max(window.from);
        let stretch = Stretch { from, to: window.to, value: why, is_change: since >= window.from };
        is_seen.then_some(Self { name, stretches: vec![stretch], kind })
    }

    /// True if the signal has no value, or stays FALSE, 0 or none.
    fn is_idle(&self) -> bool {
        if matches!(self.kind, Kind::Excused | Kind::Missed) {
            return false;
        }
        let first = self.stretches.first().map_or(IDLE[0], |stretch| stretch.value);
        IDLE.contains(&first) && self.stretches.iter().all(|stretch| stretch.value == first)
    }

    /// Times at which it becomes TRUE (s).
    pub(super) fn rises(&self) -> impl Iterator<Item = f64> {
        let mut before = "";
        self.stretches.iter().filter_map(move |stretch| {
            let is_rise = stretch.value == "TRUE" && before != "TRUE" && stretch.is_change;
            before = stretch.value;
            is_rise.then_some(stretch.from)
        })
    }
}

/// `groups` without idle rows, and the names of those rows.
pub(super) fn without_idle(groups: Vec<Group<'_>>) -> (Vec<Group<'_>>, Vec<String>) {
    let mut idle = Vec::new();
    let mut kept = Vec::new();
    for Group { source, rows } in groups {
        let (none, some): (Vec<_>, Vec<_>) = rows.into_iter().partition(Row::is_idle);
        idle.extend(none.iter().map(|row| format!("{source}.{}", row.name)));
        if !some.is_empty() {
            kept.push(Group { source, rows: some });
        }
    }
    (kept, idle)
}
