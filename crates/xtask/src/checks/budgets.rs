//! Upper bounds for each crate: lines, doc comments that begin with a relative clause, words that the project avoids. The table is
//! `docs/budgets.md`; rows may fall, and rise only with a reason.
use super::words::{self, Words};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// The table of budgets.
pub(super) const TABLE: &str = "docs/budgets.md";
/// Its columns.
const COLUMNS: &str = "| crate | source | tests | clauses | words in comments | words in strings | reason of a raise |";
/// Variable that makes `cargo xtask checks` rewrite the table.
const WRITE: &str = "SERVOBENCH_WRITE_DOCS";

/// Counts of a crate.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
struct Counts {
    /// Lines of source.
    source: usize,
    /// Lines of tests, benchmarks and examples.
    tests: usize,
    words: Words,
}

impl Counts {
    const NAMES: [&'static str; 5] =
        ["lines of source", "lines of tests", "relative clauses", "words in comments", "words in strings"];

    const fn all(&self) -> [usize; 5] {
        [self.source, self.tests, self.words.clauses, self.words.in_comments, self.words.in_strings]
    }
}

/// Counts by crate.
#[derive(Debug, Default)]
pub(super) struct Budgets(BTreeMap<String, Counts>);

impl Budgets {
    /// Counts the file at `path`, relative to the root of the workspace.
    pub(super) fn count(&mut self, path: &Path, text: &str) {
        if path.extension().is_none_or(|extension| extension != "rs") {
            return;
        }
        let mut parts = path.iter().filter_map(|part| part.to_str());
        let name = match (parts.next(), parts.next()) {
            (Some("crates"), Some(name)) => name,
            (Some("tests"), _) => "tests",
            _ => return,
        };
        let is_source = name != "tests" && parts.next() == Some("src") && !path.ends_with("tests.rs");
        let is_source = is_source && !path.iter().any(|part| part == "tests");
        let counts = self.0.entry(name.to_owned()).or_default();
        let lines = text.lines().count();
        if is_source {
            // A module of tests ends its file.
            let own = text.find("\n#[cfg(test)]\n").map_or(text, |at| &text[..=at]);
            let own_lines = own.lines().count();
            counts.source += own_lines;
            counts.tests += lines - own_lines;
            counts.words += words::count(own);
        } else {
            counts.tests += lines;
        }
    }

    /// One line for each count that is above its budget.
    pub(super) fn findings(&self, table: &str) -> Vec<String> {
        let budgets = read(table);
        let mut findings = Vec::new();
        for (name, counts) in &self.0 {
            let Some(budget) = budgets.get(name) else {
                findings.push(format!("{TABLE} has no row for the crate `{name}`: add one"));
                continue;
            };
            for ((what, count), budget) in Counts::NAMES.iter().zip(counts.all()).zip(budget) {
                if count > *budget {
                    findings.push(format!(
                        "crate `{name}` has {count} {what}, and {TABLE} allows {budget}: take away as much, or raise the row with its reason"
                    ));
                }
            }
        }
        findings
    }

    /// True if the table is to be rewritten.
    pub(super) fn are_written() -> bool {
        std::env::var_os(WRITE).is_some()
    }

    /// `table` with the present counts and its former reasons.
    pub(super) fn written(&self, table: &str) -> String {
        let head = table.find(COLUMNS).map_or("", |at| &table[..at]);
        let reasons = reasons(table);
        let mut text = format!("{head}{COLUMNS}\n|---|---|---|---|---|---|---|\n");
        for (name, counts) in &self.0 {
            let [source, tests, clauses, comments, strings] = counts.all();
            let reason = reasons.get(name).map_or("", String::as_str);
            let _ = writeln!(text, "| {name} | {source} | {tests} | {clauses} | {comments} | {strings} | {reason} |");
        }
        text
    }

    /// The sums of all crates, in a line.
    pub(super) fn sums(&self) -> String {
        let mut sums = [0; 5];
        for counts in self.0.values() {
            for (sum, count) in sums.iter_mut().zip(counts.all()) {
                *sum += count;
            }
        }
        Counts::NAMES.iter().zip(sums).map(|(what, sum)| format!("{sum} {what}")).collect::<Vec<_>>().join(", ")
    }
}

/// The cells of each row of crates.
fn rows(table: &str) -> impl Iterator<Item = Vec<&str>> {
    let rows = table.find(COLUMNS).map_or("", |at| &table[at..]).lines().skip(2);
    rows.map(|row| row.trim_matches('|').split('|').map(str::trim).collect())
}

fn read(table: &str) -> BTreeMap<String, Vec<usize>> {
    let numbers = |cells: &[&str]| cells.iter().filter_map(|cell| cell.parse().ok()).collect();
    rows(table).filter_map(|cells| Some((cells.first()?.to_string(), numbers(cells.get(1..6)?)))).collect()
}

fn reasons(table: &str) -> BTreeMap<String, String> {
    rows(table).filter_map(|cells| Some((cells.first()?.to_string(), cells.get(6)?.to_string()))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOURCE: &str = "/// What it is.\nfn x() {}\n\n#[cfg(test)]\nmod tests {}\n";

    fn budgets() -> Budgets {
        let mut budgets = Budgets::default();
        budgets.count(Path::new("crates/a/src/lib.rs"), SOURCE);
        budgets.count(Path::new("crates/a/tests/x.rs"), "one\ntwo\n");
        budgets.count(Path::new("tests/y.rs"), "one\n");
        budgets.count(Path::new("docs/x.md"), "one\n");
        budgets
    }

    #[test]
    fn counts_above_their_budget_are_found() {
        let budgets = budgets();
        let written = budgets.written(&format!("# Budgets\n\n{COLUMNS}\n|---|\n| a | 9 | 9 | 9 | 9 | 9 | because |\n"));
        assert!(
            written.starts_with("# Budgets\n\n") && written.contains("| a | 3 | 4 | 1 | 0 | 0 | because |"),
            "{written}"
        );
        assert_eq!(budgets.findings(&written), [""; 0]);
        let found = budgets.findings(&written.replace("| a | 3 | 4 | 1 |", "| a | 3 | 3 | 0 |"));
        assert!(
            found.len() == 2 && found[0].contains("4 lines of tests") && found[1].contains("allows 0"),
            "{found:?}"
        );
        let found = budgets.findings(&written.replace("| tests | 0", "| b | 0"));
        assert!(found.len() == 1 && found[0].contains("no row for the crate `tests`"), "{found:?}");
    }
}
