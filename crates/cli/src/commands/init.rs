//! `servobench init`: a scenario to begin with.
use crate::args::InitArgs;
use crate::console::{command, print};
use crate::error::CliError;
use crate::exit::Exit;
use crate::outputs::Outputs;
use crate::ready;
use std::path::Path;

/// Writes a template and prints the next commands.
pub(crate) fn init(args: &InitArgs) -> Result<Exit, CliError> {
    let template = ready::named(&format!("templates/{}", args.from))?;
    let text: String = template.written().files.into_iter().take(1).map(|(_, text)| text).collect();
    let mut outputs = Outputs::default();
    if args.file == Path::new("-") {
        outputs.or_standard("FILE", None)?.write_text(&text)?;
        return Ok(Exit::Passed);
    }
    let file = outputs.new_file("FILE", &args.file, "name another file, as in `servobench init NAME.toml`")?;
    file.write(&text)?;
    let path = args.file.to_string_lossy();
    print(&format!(
        "{path}: {}\n\nReplace its values by those of your machine. It runs as it is:\n  {}\n  {}\n",
        template.description(),
        command(&["check", &path]),
        command(&["run", &path])
    ))?;
    Ok(Exit::Passed)
}
