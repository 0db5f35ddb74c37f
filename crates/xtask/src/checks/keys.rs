//! Keys of scenario files in crates that must not name them: only `scenario` and its dependants state where in a file a thing is set.
use super::metadata::{Metadata, Package};
use std::collections::BTreeSet;
use std::path::Path;

/// The crate that reads scenario files.
const READER: &str = "servobench-scenario";

/// Crates with names of signals, such as `setpoint.velocity`, some of which are keys, too.
const NAMES_OF_SIGNALS: [&str; 2] = ["servobench-signals", "servobench-trace"];

/// Packages that must not name a key: all that `scenario` needs.
pub(super) fn below(metadata: &Metadata) -> Vec<&Package> {
    let reader = metadata.members().filter(|package| package.name == READER);
    let below = metadata.closure(reader).into_iter();
    below
        .filter(|package| metadata.is_member(package) && package.name != READER)
        .filter(|package| !NAMES_OF_SIGNALS.contains(&package.name.as_str()))
        .collect()
}

/// Paths of the keys of a scenario file, with two parts and more, from its JSON Schema.
pub(super) fn paths(schema: &serde_json::Value) -> BTreeSet<String> {
    let mut paths = BTreeSet::new();
    collect(schema, "", &mut paths);
    paths
}

fn collect(schema: &serde_json::Value, path: &str, paths: &mut BTreeSet<String>) {
    for (key, inner) in schema["properties"].as_object().into_iter().flatten() {
        let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        collect(inner, &path, paths);
        if path.contains('.') {
            paths.insert(path);
        }
    }
    for alternative in ["anyOf", "oneOf"] {
        for inner in schema[alternative].as_array().into_iter().flatten() {
            collect(inner, path, paths);
        }
    }
    if schema["items"].is_object() {
        collect(&schema["items"], path, paths);
    }
}

/// One line for each key in a string of the Rust source `file`, without documentation.
pub(super) fn findings(file: &Path, source: &str, paths: &BTreeSet<String>) -> Vec<String> {
    let mut findings = Vec::new();
    for (number, line) in source.lines().enumerate() {
        // Between the first and the last quotation mark: a key between two texts would be code.
        let text = line.split_once('"').and_then(|(_, rest)| rest.rsplit_once('"')).map_or("", |(text, _)| text);
        let is_documentation = line.trim_start().starts_with("//");
        let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || "._".contains(c)));
        for key in words.filter(|word| !is_documentation && paths.contains(word.trim_matches('.'))) {
            let place = format!("{}:{}", file.display(), number + 1);
            findings.push(format!("{place}: `{key}` is a key of scenario files, which this crate knows nothing of"));
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::super::metadata::example::metadata;
    use super::*;
    use serde_json::json;

    fn schema() -> serde_json::Value {
        let faults = json!({ "items": { "properties": { "kind": {} } } });
        let drive = json!({ "anyOf": [{}, { "properties": { "rate": {}, "dc_link": {} } }] });
        json!({ "properties": { "drive": drive, "fault": faults, "engine": {} } })
    }

    #[test]
    fn keys_of_inner_tables_are_paths() {
        assert_eq!(paths(&schema()).into_iter().collect::<Vec<_>>(), ["drive.dc_link", "drive.rate", "fault.kind"]);
    }

    #[test]
    fn a_key_in_a_text_is_found_and_one_in_code_or_documentation_is_not() {
        let found = |line: &str| findings("src/a.rs".as_ref(), line, &paths(&schema()));
        let wanted = "src/a.rs:2: `drive.dc_link` is a key of scenario files, which this crate knows nothing of";
        assert_eq!(found("fn a() {}\nlimit(\"drive.dc_link\", 1.0)?;"), [wanted]);
        assert_eq!(found("let help = \"give `fault.kind` or not\";").len(), 1);
        for fine in ["let rate = self.drive.rate;", "/// \"drive.rate\" is …", "\"drive.rates\"", "\"my.drive.rate\""]
        {
            assert!(found(fine).is_empty(), "{fine}");
        }
    }

    #[test]
    fn what_the_reader_of_files_needs_is_below_it() {
        let members = [READER, "servobench-drive", "servobench-base", "servobench-signals", "servobench-sim"];
        let arrows = [
            (READER, "servobench-drive", None),
            (READER, "servobench-signals", None),
            ("servobench-drive", "servobench-base", None),
            ("servobench-sim", READER, None),
        ];
        let metadata = metadata(&members, &[], &arrows);
        let names: Vec<&str> = below(&metadata).iter().map(|package| package.name.as_str()).collect();
        assert_eq!(names, ["servobench-base", "servobench-drive"]);
    }
}
