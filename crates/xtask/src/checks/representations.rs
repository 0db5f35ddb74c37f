//! One concept, one type: types of different crates with the same variants or fields are one concept twice, and need code that copies one
//! into the other. A necessary pair is listed with its reason.
//!
//! The source is read as `cargo fmt` lays it out; types declared by a macro in the same layout count, too.
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Fewest common variants of two enumerations that are one concept.
const FEWEST_VARIANTS: usize = 3;
/// Fewest common fields of two structures that are one concept.
const FEWEST_FIELDS: usize = 4;
/// Smallest share of common ones among all.
const SHARE: f64 = 2.0 / 3.0;

/// Folder that declares keys of scenario files, which have the names of the types they become.
const KEYS: &str = "crates/scenario/src/file";

/// Necessary pairs, with reasons.
const APART: &[([&str; 2], &str)] = &[
    (
        ["base::Setpoint", "motion::State4"],
        "planning at order 4 begins at any position to jerk; snap is what it chooses",
    ),
    (["cia402::Direction", "plcopen::Direction"], "two standards: an axis of PLCopen also has its current direction"),
    (["drive::MotorEstimate", "plant::Params"], "the firmware knows the motor by its own estimates only (law 2)"),
    (["engine-fmu::Status", "base::StepEnd"], "numbers in memory that two processes share"),
    (
        ["metrics::MoveMetrics", "results::MoveResult"],
        "`results.json` has each metric with its limit and the line of it",
    ),
    (["motion::Limits", "plcopen::Bounds"], "limits of an axis; of one command, with its deceleration"),
    (["motion::Peaks", "plcopen::Bounds"], "what a move reaches; what it may reach"),
    (["motion::RampLimits", "plcopen::Bounds"], "bounds of a command are the same in both directions"),
    (["motion::RampLimits", "plcopen::Dynamics"], "inputs of a block may be left to the axis"),
    (["motion::SymmetricMove", "planner::Sampled"], "a plan, and what is asked of it"),
    (["plcopen::Fate", "trace::CallFate"], "a recording stands for itself: outputs and errors in words"),
];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Enum,
    Struct,
}

/// An enumeration or a structure with named fields.
#[derive(Debug)]
pub(super) struct Declared {
    kind: Kind,
    /// `crate::Name`
    name: String,
    at: (PathBuf, usize),
    /// Variants, or fields with their types.
    parts: BTreeSet<String>,
    /// Variants, or fields without their types.
    names: BTreeSet<String>,
}

impl Declared {
    fn of_crate(&self) -> &str {
        self.name.split("::").next().unwrap_or_default()
    }
}

/// The types that the Rust source `file` of a crate declares, tests aside.
pub(super) fn declared(file: &Path, source: &str) -> Vec<Declared> {
    let mut folders = file.iter().skip_while(|folder| *folder != "crates").skip(1).filter_map(|folder| folder.to_str());
    let (Some(of_crate), Some("src")) = (folders.next(), folders.next()) else { return Vec::new() };
    if file.starts_with(KEYS) || file.extension().is_none_or(|extension| extension != "rs") {
        return Vec::new();
    }
    let mut types = Vec::new();
    let mut lines = source.lines().enumerate().take_while(|(_, line)| *line != "mod tests {");
    while let Some((number, line)) = lines.next() {
        let Some((kind, name, indent)) = head(line) else { continue };
        let body = lines.by_ref().take_while(|(_, line)| line.trim_end() != format!("{indent}}}"));
        let parts = body.filter_map(|(_, line)| part(kind, line.strip_prefix(indent)?.strip_prefix("    ")?));
        let parts: BTreeSet<String> = parts.collect();
        let names = parts.iter().map(|part| part.split(':').next().unwrap_or_default().to_owned()).collect();
        types.push(Declared { kind, name: format!("{of_crate}::{name}"), at: (file.into(), number + 1), parts, names });
    }
    types
}

/// Kind, name and indentation of a type whose variants or fields follow.
fn head(line: &str) -> Option<(Kind, &str, &str)> {
    let text = line.trim_start();
    let indent = &line[..line.len() - text.len()];
    let text = text.strip_suffix('{')?;
    let text = text.strip_prefix("pub").map_or(text, |rest| rest.split_once(' ').map_or(rest, |(_, rest)| rest));
    let (kind, rest) = match text.split_once(' ')? {
        ("enum", rest) => (Kind::Enum, rest),
        ("struct", rest) => (Kind::Struct, rest),
        _ => return None,
    };
    let name = rest.split(|c: char| !c.is_alphanumeric()).next()?;
    (!name.is_empty()).then_some((kind, name, indent))
}

/// The variant, or the field with its type, at the beginning of `line`, one level below its type.
fn part(kind: Kind, line: &str) -> Option<String> {
    let line = line.strip_prefix("pub").map_or(line, |rest| rest.split_once(' ').map_or(rest, |(_, rest)| rest));
    let name = line.split(|c: char| !(c.is_alphanumeric() || c == '_')).next()?;
    let is_upper = name.chars().next()?.is_uppercase();
    match kind {
        Kind::Enum => is_upper.then(|| name.to_owned()),
        Kind::Struct => {
            (!is_upper && line[name.len()..].starts_with(':')).then(|| line.trim_end_matches(',').to_owned())
        }
    }
}

/// One line for each pair of types that are one concept, and for each listed pair that is not.
pub(super) fn findings(types: &[Declared]) -> Vec<String> {
    let mut pairs = Vec::new();
    for (index, one) in types.iter().enumerate() {
        let others =
            types[index + 1..].iter().filter(|other| other.of_crate() != one.of_crate() && are_same(one, other));
        pairs.extend(others.map(|other| (one, other)));
    }
    let is_listed = |[first, second]: &[&str; 2], (one, other): &(&Declared, &Declared)| {
        (one.name == *first && other.name == *second) || (one.name == *second && other.name == *first)
    };
    let new = pairs.iter().filter(|pair| !APART.iter().any(|(names, _)| is_listed(names, pair)));
    let new = new.map(|(one, other)| {
        let (path, line) = &one.at;
        let common: Vec<&str> = one.names.intersection(&other.names).map(String::as_str).collect();
        format!(
            "{}:{line}: `{}` and `{}` are one concept twice ({}): keep one of them, in the crate that owns it",
            path.display(),
            one.name,
            other.name,
            common.join(", ")
        )
    });
    let old = APART.iter().filter(|(names, _)| !pairs.iter().any(|pair| is_listed(names, pair)));
    let old = old
        .map(|([first, second], _)| format!("`{first}` and `{second}` are no pair any more: take them off the list"));
    new.chain(old).collect()
}

/// True if most variants, most fields with their types, or all names of fields are common.
fn are_same(one: &Declared, other: &Declared) -> bool {
    let fewest = match (one.kind, other.kind) {
        (Kind::Enum, Kind::Enum) => FEWEST_VARIANTS,
        (Kind::Struct, Kind::Struct) => FEWEST_FIELDS,
        (Kind::Enum, Kind::Struct) | (Kind::Struct, Kind::Enum) => return false,
    };
    let common = one.parts.intersection(&other.parts).count();
    let all = one.parts.union(&other.parts).count();
    (common >= fewest && common as f64 >= SHARE * all as f64) || (one.names.len() >= fewest && one.names == other.names)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn types(of_crate: &str, source: &str) -> Vec<Declared> {
        declared(Path::new(&format!("crates/{of_crate}/src/a.rs")), source)
    }

    const ENDING: &str = "/// How.\npub enum Ending {\n    /// One.\n    AtRest,\n    Moving(f64),\n    Lost {\n        at: f64,\n    },\n}\n";
    const POINT: &str = "pub(crate) struct Point<T> {\n    pub x: f64,\n    pub(crate) v: T,\n    a: f64,\n    /// Jerk.\n    j: f64,\n}\n";

    /// The findings other than those about the list.
    fn new(types: &[Declared]) -> Vec<String> {
        findings(types).into_iter().filter(|finding| !finding.contains("no pair any more")).collect()
    }

    #[test]
    fn variants_and_fields_are_read_as_they_are_laid_out() {
        let found = types("sim", &format!("{ENDING}{POINT}mod tests {{\n{ENDING}"));
        let read: Vec<_> =
            found.iter().map(|one| (one.name.as_str(), one.names.iter().cloned().collect::<Vec<_>>())).collect();
        let names = |all: &[&str]| all.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        assert_eq!(
            read,
            [("sim::Ending", names(&["AtRest", "Lost", "Moving"])), ("sim::Point", names(&["a", "j", "v", "x"]))]
        );
        let in_macro = "choices! {\n    pub enum Kind default P {\n        /// one\n        P = \"p\",\n        Pi = \"pi\",\n    }\n}\n";
        let [kind] = &types("drive", in_macro)[..] else { panic!("one type") };
        assert_eq!((kind.name.as_str(), kind.parts.len()), ("drive::Kind", 2));
        assert!(declared("crates/scenario/src/file/axis.rs".as_ref(), POINT).is_empty(), "keys");
        assert!(declared("crates/sim/tests/a.rs".as_ref(), POINT).is_empty(), "tests");
    }

    #[test]
    fn a_concept_in_two_crates_is_found_under_any_name() {
        let mirrored = ENDING.replace("Ending", "Finish").replace("Moving(f64)", "Moving(Speed)");
        let with_one_more = POINT.replace("Point", "Place").replace("    a: f64,\n", "    a: f64,\n    s: f64,\n");
        let of_other_types = POINT.replace("f64", "Number");
        for (one, other) in [(ENDING, mirrored), (POINT, with_one_more), (POINT, of_other_types)] {
            let both: Vec<Declared> = types("sim", one).into_iter().chain(types("scenario", &other)).collect();
            let [finding] = &new(&both)[..] else { panic!("one finding: {:?}", new(&both)) };
            assert!(finding.contains("are one concept twice ("), "{finding}");
        }
        let within: Vec<Declared> = types("sim", ENDING).into_iter().chain(types("sim", ENDING)).collect();
        assert!(new(&within).is_empty(), "a crate may have its reasons");
        let other = "pub enum Other {\n    AtRest,\n    Moving,\n    Found,\n    Gone,\n}\n";
        let apart: Vec<Declared> = types("sim", ENDING).into_iter().chain(types("scenario", other)).collect();
        assert!(new(&apart).is_empty(), "two of five variants are common");
    }

    #[test]
    fn a_listed_pair_that_is_none_any_more_is_told() {
        assert_eq!(findings(&[]).len(), APART.len());
        let listed = types("cia402", &ENDING.replace("Ending", "Direction"));
        let both: Vec<Declared> =
            listed.into_iter().chain(types("plcopen", &ENDING.replace("Ending", "Direction"))).collect();
        assert_eq!(findings(&both).len(), APART.len() - 1);
    }
}
