//! Left-overs in tracked text: paths of a private machine, notes to oneself, silenced lints.
use std::path::Path;

/// Folders that exist only on the author's machine, if at all.
const HOMES: [&str; 4] = ["home", "root", "work", "Users"];

/// Notes to oneself; halves, so that this file does not find itself.
const NOTES: [[&str; 2]; 3] = [["TO", "DO"], ["FIX", "ME"], ["XX", "X"]];

/// Attributes that silence a lint for good, in halves as well.
const SILENCERS: [[&str; 2]; 2] = [["#[al", "low("], ["#![al", "low("]];

/// One line per left-over in the text of `file`.
pub(super) fn findings(file: &Path, text: &str) -> Vec<String> {
    let is_rust = file.extension().is_some_and(|extension| extension == "rs");
    let mut findings = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let place = format!("{}:{}", file.display(), number + 1);
        if let Some(home) = HOMES.iter().find(|home| has_absolute(line, home)) {
            findings.push(format!("{place}: a path under `/{home}` exists on one machine only"));
        }
        if let Some(note) = NOTES.map(|n| n.concat()).iter().find(|note| has_word(line, note)) {
            findings.push(format!("{place}: `{note}` belongs into an issue"));
        }
        if is_rust && SILENCERS.map(|s| s.concat()).iter().any(|silencer| line.contains(silencer)) {
            findings.push(format!("{place}: use `#[expect(…, reason = \"…\")]` instead of `allow`"));
        }
    }
    findings
}

/// True if `line` holds a path below `folder` at the root of the file system.
fn has_absolute(line: &str, folder: &str) -> bool {
    let path = format!("/{folder}/");
    line.match_indices(&path).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        !before.is_some_and(|c| c.is_alphanumeric() || "_-.~/}>)".contains(c))
    })
}

/// True if `line` has `word` as a whole word.
fn has_word(line: &str, word: &str) -> bool {
    line.match_indices(word).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        let after = line[at + word.len()..].chars().next();
        ![before, after].into_iter().flatten().any(|c| c.is_alphanumeric() || c == '_')
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn machine_paths_are_found_and_relative_or_web_paths_are_not() {
        for home in HOMES {
            let line = format!("let lib = \"/{home}/me/lib\";");
            let found = findings("a.md".as_ref(), &format!("fine\n{line}\n"));
            assert_eq!(found.len(), 1, "{line}");
            assert!(found[0].starts_with("a.md:2: "), "{found:?}");
            let path = format!("/{home}/x");
            for fine in [format!("docs{path}"), format!("..{path}"), format!("example.org{path}")] {
                assert!(findings("a.md".as_ref(), &fine).is_empty(), "{fine}");
            }
        }
    }

    #[test]
    fn notes_to_oneself_are_found_as_words_only() {
        for note in NOTES.map(|n| n.concat()) {
            assert_eq!(findings("a.toml".as_ref(), &format!("# {note}: later")).len(), 1, "{note}");
            assert!(findings("a.toml".as_ref(), &format!("METHOD_{note}S = 1")).is_empty(), "{note}");
        }
    }

    #[test]
    fn silenced_lints_are_found_in_rust_only() {
        for silencer in SILENCERS.map(|s| s.concat()) {
            let line = format!("{silencer}dead_code)]");
            assert_eq!(findings("src/a.rs".as_ref(), &line).len(), 1);
            assert!(findings("docs/a.md".as_ref(), &line).is_empty());
        }
    }
}
