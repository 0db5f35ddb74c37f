//! JSON Schemas of scenario and sweep files, from the description of their tables.
use crate::field::Field;
use crate::file::File;
use crate::sweep_file::SweepFile;
use serde_json::{Value as Json, json};

/// JSON Schema (draft 7, which TOML editors understand) of a scenario file. Dimensions and combinations of keys are left to `check`.
#[must_use]
pub fn json_schema() -> Json {
    titled(File::schema(&()), "servobench scenario")
}

/// JSON Schema of a sweep file.
#[must_use]
pub fn sweep_schema() -> Json {
    titled(SweepFile::schema(&()), "servobench sweep")
}

fn titled(mut schema: Json, title: &str) -> Json {
    schema["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    schema["title"] = json!(title);
    schema
}
