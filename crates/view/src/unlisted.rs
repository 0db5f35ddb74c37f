//! Channels that the catalogue does not name: they are plotted too, with those of their group.
//!
//! A group is the part of a name before its first dot, and a unit: `power.copper` and `power.shaft` are of one group.
use crate::catalogue::PLOTS;
use crate::reached;
use crate::run::Run;
use crate::style::{self, Rgb};

/// Colours of such channels within a plot.
const COLOURS: [Rgb; 6] =
    [style::AUXILIARY, style::TABLE, style::DISTURBANCE, style::MOTOR, style::LOAD, style::REFERENCE];

/// A channel that the catalogue does not name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Unlisted<'a> {
    /// Its whole name.
    pub(crate) channel: &'a str,
    /// Part before the first dot; the whole name without one.
    pub(crate) group: &'a str,
    /// Its unit.
    pub(crate) unit: &'a str,
}

impl<'a> Unlisted<'a> {
    /// Name in a legend: the part after the group.
    pub(crate) fn name(&self) -> String {
        let name = self.channel.strip_prefix(self.group).unwrap_or(self.channel).trim_start_matches('.');
        if name.is_empty() { self.channel } else { name }.replace('_', " ")
    }

    /// Such channels of `runs`, each once, in the order of the recordings.
    pub(crate) fn of(runs: &[Run<'a>]) -> Vec<Self> {
        let mut found: Vec<Self> = Vec::new();
        for spec in runs.iter().flat_map(|run| &run.recording.channels).map(|channel| &channel.spec) {
            let (channel, unit) = (spec.name.as_str(), spec.unit.as_str());
            if is_listed(channel) || found.iter().any(|known| known.channel == channel) {
                continue;
            }
            found.push(Self { channel, group: channel.split('.').next().unwrap_or(channel), unit });
        }
        found
    }
}

/// True if the catalogue or another view shows it.
fn is_listed(channel: &str) -> bool {
    let is_plotted = || PLOTS.iter().flat_map(|plot| plot.curves).any(|curve| curve.channels.contains(&channel));
    channel.starts_with(reached::GROUP) || is_plotted()
}

/// Colour of the `index`-th one in a plot.
pub(crate) fn colour(index: usize) -> Rgb {
    COLOURS[index % COLOURS.len()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_signals::Signal;

    #[test]
    fn no_signal_of_our_own_is_among_the_others() {
        let others: Vec<_> = Signal::ALL.iter().map(|signal| signal.name()).filter(|name| !is_listed(name)).collect();
        assert!(others.is_empty(), "{others:?} have no plot");
    }
}
