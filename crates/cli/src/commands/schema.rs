//! `servobench schema`
use crate::console::print_json;
use crate::error::CliError;
use crate::exit::Exit;

/// Prints the JSON Schema of a scenario file.
pub(crate) fn schema() -> Result<Exit, CliError> {
    let text = serde_json::to_string_pretty(&servobench_scenario::json_schema()).map_err(CliError::Schema)?;
    print_json(&(text + "\n"))?;
    Ok(Exit::Passed)
}
