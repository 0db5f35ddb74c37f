//! Definitions of metrics, from the tables of `docs/metrics.md`.
use servobench_metrics::Name;

const PAGE: &str = include_str!("../../../../../docs/metrics.md");

/// A row of the page, as plain text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Definition {
    pub(super) unit: String,
    pub(super) text: String,
    /// Signals from which it is computed.
    pub(super) channels: Option<String>,
}

/// The row of a metric: its first cell names it, alone or with others.
pub(super) fn definition(metric: Name) -> Option<Definition> {
    let name = format!("`{metric}`");
    let rows = PAGE.lines().filter_map(|line| line.strip_prefix("| ")?.strip_suffix(" |"));
    let cells: Vec<&str> = rows
        .map(|row| row.split(" | ").collect::<Vec<_>>())
        .find(|cells| cells[0].split(", ").any(|one| one.trim_end_matches(" ±") == name))?;
    let [_, unit, text, rest @ ..] = cells.as_slice() else { return None };
    // "–" for none; "the same" is as in the row before.
    let channels = rest.first().filter(|channels| channels.contains('`')).map(|channels| plain(channels));
    Some(Definition { unit: plain(unit), text: plain(text), channels })
}

/// Markdown without backticks and without the targets of links.
fn plain(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, label, after)) = link(rest) {
        out.extend([before, label]);
        rest = after;
    }
    (out + rest).replace('`', "")
}

/// The first link of `text`: the text before it, its label, and the text after it.
fn link(text: &str) -> Option<(&str, &str, &str)> {
    let (before, rest) = text.split_once('[')?;
    let (label, rest) = rest.split_once("](")?;
    let (_, after) = rest.split_once(')')?;
    Some((before, label, after))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_defines_every_metric() {
        for metric in Name::ALL {
            let found = definition(*metric).unwrap_or_else(|| panic!("docs/metrics.md has no row of `{metric}`"));
            let all = [Some(&found.unit), Some(&found.text), found.channels.as_ref()];
            assert!(all.into_iter().flatten().all(|text| !text.is_empty() && !text.contains(['`', '|'])), "{found:?}");
            assert!(!found.text.contains("]("), "{found:?}");
        }
    }

    #[test]
    fn links_are_their_labels() {
        assert_eq!(plain("as [loop.md](loop.md#x) has `a` in [limits]"), "as loop.md has a in [limits]");
    }
}
