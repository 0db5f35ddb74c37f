//! JSON Schema of a scenario file, from the description of its tables.
use crate::field::Field;
use crate::file::File;
use serde_json::{Value as Json, json};

/// JSON Schema (draft 7, which TOML editors understand) of a scenario file. What only `check` can judge, dimensions
/// and combinations, it leaves open.
#[must_use]
pub fn json_schema() -> Json {
    let mut schema = File::schema(&());
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!("servobench scenario");
    schema
}
