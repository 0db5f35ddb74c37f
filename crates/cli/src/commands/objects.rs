//! `servobench objects`: the object dictionary of the drive.
use crate::args::{ObjectsArgs, ObjectsFormat, OverrideArgs};
use crate::console::style;
use crate::error::CliError;
use crate::exit::Exit;
use crate::output::write_time;
use crate::outputs::Outputs;
use crate::sources;
use servobench_cia402::PowerState;
use servobench_cia402::objects::{Dictionary, Eds, FileInfo, Json};
use servobench_report::{Style, object_table};
use servobench_results::printable_json;
use std::path::Path;

/// Name of a data sheet that goes to standard output.
const DATA_SHEET: &str = "drive.eds";

/// Shows the dictionary with the values after power-on, or with those that a scenario writes.
pub(crate) fn objects(args: &ObjectsArgs) -> Result<Exit, CliError> {
    let configured = args.scenario.as_deref().map(|path| as_written(path, &args.with)).transpose()?;
    let output = Outputs::default().or_standard("-o", args.output.as_deref())?;
    let values = configured.clone().unwrap_or_default();
    match args.format {
        ObjectsFormat::Table => output
            .write_text(&object_table(&values, if output.is_standard_output() { style() } else { Style::default() }))?,
        ObjectsFormat::Eds => {
            let made = write_time()?;
            let (date, time) = (made.strftime("%m-%d-%Y").to_string(), made.strftime("%I:%M%p").to_string());
            let file = FileInfo { name: data_sheet_name(output.path()), date: &date, time: &time };
            output.write(Eds { file, configured: configured.as_ref() }.to_string())?;
        }
        ObjectsFormat::Json => output.write(printable_json(&Json(&values).to_string()))?,
    }
    Ok(Exit::Passed)
}

/// The values that the scenario at `path` writes into a drive after power-on; every refused one is reported.
fn as_written(path: &Path, with: &OverrideArgs) -> Result<Dictionary, CliError> {
    let loaded = sources::read(path, with)?;
    let Some(bus) = &loaded.scenario.bus else {
        return Err(CliError::NoBus { scenario: path.to_owned() });
    };
    let mut dictionary = Dictionary::new();
    let mut refused = Vec::new();
    for write in &bus.objects {
        if let Err(error) = dictionary.write_number(write.object, write.value, PowerState::SwitchOnDisabled) {
            let code = error.abort_code();
            let answer = format!("the drive answers with abort code {code}: {}", code.text());
            refused.push(loaded.mistake(&write.key, error.to_string(), answer));
        }
    }
    if refused.is_empty() {
        Ok(dictionary)
    } else {
        Err(CliError::Mistakes { diagnostics: refused, sources: Box::new(loaded.sources) })
    }
}

/// File name stated in a data sheet: that of its file, if CiA 306 allows it.
fn data_sheet_name(path: Option<&Path>) -> &str {
    let name = path.and_then(Path::file_name).and_then(|name| name.to_str());
    let is_allowed = |name: &&str| name.len() <= 240 && name.bytes().all(|byte| matches!(byte, b' '..=b'~'));
    name.filter(is_allowed).unwrap_or(DATA_SHEET)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_data_sheet_is_called_like_its_file_in_ascii() {
        assert_eq!(data_sheet_name(None), "drive.eds");
        assert_eq!(data_sheet_name(Some(Path::new("/tmp/my axis.dcf"))), "my axis.dcf");
        assert_eq!(data_sheet_name(Some(Path::new("Größe.eds"))), "drive.eds");
        assert_eq!(data_sheet_name(Some(Path::new("a\nb.eds"))), "drive.eds");
    }
}
