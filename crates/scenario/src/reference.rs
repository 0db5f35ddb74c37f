//! Reference of the keys of scenario and sweep files, from the description of their tables.
use crate::schema::{json_schema, sweep_schema};
use serde_json::Value as Json;
use std::iter;
use std::sync::LazyLock;

/// A key as the reference describes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyReference {
    /// Its path, without the numbers of list items: `axis.motor_side.mass`, `program.move_to`.
    pub path: String,
    /// The kind of file that has it.
    pub file: KeyFile,
    /// Header of the table that it stands in, `[axis.motor_side]` or `[[program]]`; of a table its own. Empty at the top level.
    pub header: String,
    /// Its meaning, with its default.
    pub meaning: String,
    /// True where its table needs it.
    pub is_required: bool,
    /// Its value, by example; `None` of a table.
    pub value: Option<String>,
    /// Quantity and bound of the value.
    pub quantity: Option<String>,
    /// Names that are its values, with their meanings.
    pub choices: Vec<(String, String)>,
    /// Keys of a table, in the order of the reference.
    pub keys: Vec<String>,
}

/// A kind of file with a reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum KeyFile {
    /// A scenario.
    Scenario,
    /// A sweep.
    Sweep,
}

/// Every key of scenario files, then those of sweep files; each table before its keys.
static KEYS: LazyLock<Vec<KeyReference>> = LazyLock::new(|| {
    let mut keys = Vec::new();
    for (file, schema) in [(KeyFile::Scenario, json_schema()), (KeyFile::Sweep, sweep_schema())] {
        list(file, "", "", &schema, &mut keys);
    }
    keys
});

/// Every key of scenario files, then those of sweep files; each table before its keys.
#[must_use]
pub fn key_references() -> &'static [KeyReference] {
    &KEYS
}

/// The keys that `name` may mean: the one with this path, of scenario files first; otherwise all whose paths end with it. Numbers of list
/// items do not count: `program.0.move_to`, `program[0].move_to` and `program.move_to` are one key.
#[must_use]
pub fn keys_named(name: &str) -> Vec<&'static KeyReference> {
    let parts = name.split(['.', '[', ']']).map(|part| part.trim_matches(['"', '\'', ' ']));
    let is_index = |part: &&str| part.bytes().all(|byte| byte.is_ascii_digit());
    let path = parts.filter(|part| !is_index(part)).collect::<Vec<_>>().join(".");
    if path.is_empty() {
        return Vec::new();
    }
    if let Some(exact) = KEYS.iter().find(|key| key.path == path) {
        return vec![exact];
    }
    let end = format!(".{path}");
    KEYS.iter().filter(|key| key.path.ends_with(&end)).collect()
}

/// The table that `schema` describes: itself, an item of the list, or one of the alternatives.
fn table_of(schema: &Json) -> Option<&Json> {
    let alternatives = schema["anyOf"].as_array().into_iter().flatten();
    iter::once(schema).chain(alternatives).flat_map(|one| [one, &one["items"]]).find(|one| one["x-order"].is_array())
}

/// Adds the keys of `table`, whose path and header these are.
fn list(file: KeyFile, path: &str, header: &str, table: &Json, keys: &mut Vec<KeyReference>) {
    let required = |key: &str| table["required"].as_array().is_some_and(|all| all.iter().any(|one| one == key));
    for key in names(&table["x-order"]) {
        let schema = &table["properties"][key.as_str()];
        let below = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
        let inner = table_of(schema);
        let own = match inner {
            None => header.to_owned(),
            Some(_) if schema["type"] == "array" => format!("[[{below}]]"),
            Some(_) => format!("[{below}]"),
        };
        keys.push(KeyReference {
            path: below.clone(),
            file,
            header: own.clone(),
            meaning: schema["description"].as_str().unwrap_or_default().to_owned(),
            is_required: required(&key),
            value: inner.is_none().then(|| value_of_schema(schema)),
            quantity: if inner.is_none() { quantity(schema) } else { None },
            choices: if inner.is_none() { choices(schema) } else { Vec::new() },
            keys: inner.map(|table| names(&table["x-order"])).unwrap_or_default(),
        });
        if let Some(table) = inner {
            list(file, &below, &own, table, keys);
        }
    }
}

fn names(list: &Json) -> Vec<String> {
    list.as_array().into_iter().flatten().filter_map(Json::as_str).map(str::to_owned).collect()
}

/// A schema and the alternatives in it, those of list items too.
fn alternatives(schema: &Json) -> Vec<&Json> {
    let inner = ["anyOf", "oneOf"].into_iter().filter_map(|several| schema[several].as_array()).flatten();
    let items = schema.get("items").into_iter();
    iter::once(schema).chain(inner.chain(items).flat_map(alternatives)).collect()
}

/// Quantity and bound of a value.
fn quantity(schema: &Json) -> Option<String> {
    let all = alternatives(schema);
    let physical = all.iter().find_map(|one| one["x-quantity"].as_str());
    let number = || all.iter().find(|one| one["type"] == "number").map(|number| a_number(number));
    physical.map(str::to_owned).or_else(number)
}

/// The bound of a pure number, in words.
fn a_number(schema: &Json) -> String {
    match (&schema["exclusiveMinimum"], &schema["minimum"], &schema["maximum"]) {
        (Json::Number(_), ..) => "a number, above zero".into(),
        (_, Json::Number(low), Json::Number(high)) => format!("a number, from {low} to {high}"),
        (_, Json::Number(_), _) => "a number, zero or more".into(),
        _ => "a number".into(),
    }
}

/// Names that are values, with their meanings.
fn choices(schema: &Json) -> Vec<(String, String)> {
    let named = alternatives(schema).into_iter().filter_map(|one| {
        let (name, meaning) = (one["const"].as_str()?, one["description"].as_str()?);
        Some((name.to_owned(), meaning.to_owned()))
    });
    let mut all: Vec<_> = named.collect();
    // One value or a list of them: the names of both are the same.
    let mut known = Vec::new();
    all.retain(|choice| {
        !known.contains(choice) && {
            known.push(choice.clone());
            true
        }
    });
    all
}

/// Values that `schema` allows, in a few characters of Markdown: an example, the names, or the range.
#[must_use]
pub fn value_of_schema(schema: &Json) -> String {
    if schema["title"] == "condition" {
        return "output, or a condition".into();
    }
    if let (true, Some(example)) = (schema["type"] == "object", schema["examples"][0].as_str()) {
        return format!("`{{ {example} }}`");
    }
    if let Some(example) = schema["examples"][0].as_str() {
        return format!("`\"{example}\"`");
    }
    if let Some(constant) = schema["const"].as_str() {
        return format!("`\"{constant}\"`");
    }
    for several in ["oneOf", "anyOf"] {
        if let Some(all) = schema[several].as_array() {
            // A number may also be written in percent, which is not worth saying each time.
            let is_said = |one: &&Json| one["type"] != "array" && !is_percentage(one);
            let values: Vec<String> = all.iter().filter(is_said).map(value_of_schema).collect();
            let more = if all.iter().any(|one| one["type"] == "array") { ", or a list" } else { "" };
            return if values.len() > 12 { format!("a name{more}") } else { format!("{}{more}", values.join(", ")) };
        }
    }
    if schema["enum"].is_array() {
        return "a name".into();
    }
    match schema["type"].as_str() {
        Some("boolean") => "`true`, `false`".into(),
        Some("integer") => format!("{} to {}", schema["minimum"], schema["maximum"]),
        Some("object") => "`{ min = …, max = … }`".into(),
        other => other.unwrap_or_default().to_owned(),
    }
}

fn is_percentage(schema: &Json) -> bool {
    schema["type"] == "string" && schema["pattern"].is_string() && schema["examples"].is_null()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one(name: &str) -> &'static KeyReference {
        match keys_named(name).as_slice() {
            [key] => key,
            several => panic!("{name}: {several:?}"),
        }
    }

    #[test]
    fn a_key_has_value_quantity_and_table() {
        let mass = one("axis.motor_side.mass");
        assert_eq!(mass.value.as_deref(), Some("`\"20 kg\"`"));
        assert_eq!(mass.quantity.as_deref(), Some("a mass, above zero"));
        assert_eq!((mass.header.as_str(), mass.is_required), ("[axis.motor_side]", false));
        assert!(one("run.base_rate").is_required);
        assert_eq!(one("axis.motion").choices.len(), 2);
        assert_eq!(one("drive.position_feedback").quantity, None);
        assert_eq!(one("limits.settling_time").quantity.as_deref(), Some("a time, zero or more"));
    }

    #[test]
    fn numbers_of_items_do_not_count() {
        let expected = "program.move_to";
        for name in ["program.0.move_to", "program[12].move_to", "program.move_to", "[[program]].move_to"] {
            assert_eq!(one(name).path, expected, "{name}");
        }
        assert_eq!(one("[program]").header, "[[program]]");
        assert!(keys_named("0").is_empty() && keys_named("").is_empty() && keys_named("..").is_empty());
    }

    #[test]
    fn the_end_of_a_path_names_all_keys_with_it() {
        let found = keys_named("mass");
        assert!(found.iter().any(|key| key.path == "axis.table.mass"), "{found:?}");
        assert!(found.len() > 2 && found.iter().all(|key| key.path.rsplit('.').next() == Some("mass")));
        assert_eq!(one("motor_side.mass").path, "axis.motor_side.mass");
        assert_eq!(one("move_to").path, "program.move_to");
    }

    #[test]
    fn every_key_has_a_meaning_and_every_table_its_keys() {
        let keys = key_references();
        assert!(keys.len() > 300, "{}", keys.len());
        for key in keys {
            assert!(!key.meaning.is_empty(), "{}", key.path);
            assert_eq!(key.value.is_none(), !key.keys.is_empty(), "{}", key.path);
        }
        assert!(keys.iter().any(|key| key.file == KeyFile::Sweep));
    }
}
