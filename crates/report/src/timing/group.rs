//! The signals of one source, a row each.
use super::stretch::{Stretch, stretches};
use super::window::Window;
use servobench_trace::{Recording, Signal};

/// Values of a signal in which nothing happens.
const IDLE: [&str; 4] = ["FALSE", "0", "16#0000", "none"];

/// The signals of one source.
#[derive(Debug)]
pub(super) struct Group<'a> {
    pub(super) source: &'a str,
    pub(super) rows: Vec<Row<'a>>,
}

/// One signal in what is shown.
#[derive(Debug)]
pub(super) struct Row<'a> {
    pub(super) name: &'a str,
    pub(super) stretches: Vec<Stretch<'a>>,
    /// Whether its values are TRUE and FALSE.
    pub(super) is_logic: bool,
}

impl<'a> Group<'a> {
    /// Those of `recording` by `sources`, or all, in the order in which they first come.
    pub(super) fn all(recording: &'a Recording, sources: &[String], window: Window) -> Vec<Self> {
        let mut groups: Vec<Self> = Vec::new();
        for signal in &recording.signals {
            let source = signal.source.as_str();
            if !sources.is_empty() && !sources.iter().any(|name| name == source) {
                continue;
            }
            let row = Row::of(signal, window);
            match groups.iter_mut().find(|group| group.source == source) {
                Some(group) => group.rows.push(row),
                None => groups.push(Self { source, rows: vec![row] }),
            }
        }
        groups
    }

    /// Whether every row is idle.
    pub(super) fn is_idle(&self) -> bool {
        self.rows.iter().all(Row::is_idle)
    }
}

impl<'a> Row<'a> {
    fn of(signal: &'a Signal, window: Window) -> Self {
        let is_logic = signal.changes.iter().all(|(_, value)| value == "TRUE" || value == "FALSE");
        Self { name: &signal.name, stretches: stretches(signal, window), is_logic }
    }

    /// Whether nothing happens in it: it has no value, or stays FALSE, 0 or none.
    fn is_idle(&self) -> bool {
        let first = self.stretches.first().map_or(IDLE[0], |stretch| stretch.value);
        IDLE.contains(&first) && self.stretches.iter().all(|stretch| stretch.value == first)
    }

    /// When it becomes TRUE (s).
    pub(super) fn rises(&self) -> impl Iterator<Item = f64> {
        let mut before = "";
        self.stretches.iter().filter_map(move |stretch| {
            let is_rise = stretch.value == "TRUE" && before != "TRUE" && stretch.is_change;
            before = stretch.value;
            is_rise.then_some(stretch.from)
        })
    }
}

/// `groups` without idle rows, and the names of these.
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
