//! `servobench schema`: JSON Schemas.
use crate::args::{SchemaArgs, SchemaOf};
use crate::console::print_json;
use crate::error::CliError;
use crate::exit::Exit;
use servobench_scenario::{json_schema, sweep_schema};

/// Prints the JSON Schema of a scenario or sweep file.
pub(crate) fn schema(args: &SchemaArgs) -> Result<Exit, CliError> {
    let schema = match args.of {
        SchemaOf::Scenario => json_schema(),
        SchemaOf::Sweep => sweep_schema(),
    };
    print_json(&(serde_json::to_string_pretty(&schema).map_err(CliError::Schema)? + "\n"))?;
    Ok(Exit::Passed)
}
