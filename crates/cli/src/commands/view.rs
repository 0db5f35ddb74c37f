//! `servobench view`: opens a recording in the Rerun viewer.
use crate::args::ViewArgs;
use crate::exit::{CliError, Exit};
use servobench_trace::Recording;
use servobench_view::{ViewOptions, write_rrd};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

const HOW_TO_GET_IT: &str = "there is no Rerun viewer: `cargo xtask viewer` fetches one, and so does \
                             `pip install rerun-sdk==0.36.3`";

/// Opens a recording in the viewer that is installed, or that `cargo xtask viewer` fetched.
pub(crate) fn view(args: &ViewArgs) -> Result<Exit, CliError> {
    let recordings = recordings(&args.recording)?;
    let viewer = viewer().ok_or_else(|| CliError::Run(HOW_TO_GET_IT.into()))?;
    let status = Command::new(&viewer)
        .args(&recordings)
        .status()
        .map_err(|error| CliError::Run(format!("cannot start {}: {error}; {HOW_TO_GET_IT}", viewer.display())))?;
    if status.success() { Ok(Exit::Passed) } else { Err(CliError::Run(format!("the viewer ended with {status}"))) }
}

/// The `.rrd` files behind `path`; a Parquet recording is turned into one beside it.
fn recordings(path: &Path) -> Result<Vec<PathBuf>, CliError> {
    let wrong = |error: std::io::Error| CliError::Input(format!("cannot read `{}`: {error}", path.display()));
    if !path.is_dir() {
        std::fs::metadata(path).map_err(wrong)?;
        return Ok(vec![as_rrd(path)?]);
    }
    let mut files = Vec::new();
    for entry in std::fs::read_dir(path).map_err(wrong)? {
        files.push(entry.map_err(wrong)?.path());
    }
    files.sort();
    let is = |path: &Path, ending: &str| path.extension() == Some(OsStr::new(ending));
    let mut found: Vec<PathBuf> = files.iter().filter(|path| is(path, "rrd")).cloned().collect();
    for file in files.iter().filter(|path| is(path, "parquet")) {
        if !found.contains(&file.with_extension("rrd")) {
            found.push(as_rrd(file)?);
        }
    }
    if found.is_empty() {
        return Err(CliError::Input(format!("there is no recording in `{}`", path.display())));
    }
    Ok(found)
}

fn as_rrd(path: &Path) -> Result<PathBuf, CliError> {
    if path.extension() != Some(OsStr::new("parquet")) {
        return Ok(path.to_owned());
    }
    let recording = Recording::read_parquet(path).map_err(|error| CliError::Input(error.to_string()))?;
    let rrd = path.with_extension("rrd");
    write_rrd(&recording, &rrd, &ViewOptions::default()).map_err(|error| CliError::Run(error.to_string()))?;
    Ok(rrd)
}

/// The viewer on the search path, or the one that `cargo xtask viewer` put beside the build.
fn viewer() -> Option<PathBuf> {
    let name = format!("rerun{}", std::env::consts::EXE_SUFFIX);
    let on_path = std::env::var_os("PATH")
        .into_iter()
        .flat_map(|paths| std::env::split_paths(&paths).collect::<Vec<_>>())
        .map(|folder| folder.join(&name));
    let fetched = std::env::current_exe()
        .ok()
        .into_iter()
        .flat_map(|exe| exe.ancestors().skip(1).take(3).map(Path::to_owned).collect::<Vec<_>>())
        .map(|folder| folder.join("viewer").join("bin").join(&name));
    on_path.chain(fetched).find(|candidate| candidate.is_file())
}
