//! A model and its data, stepped so that no error goes unnoticed.
use crate::{NAME, library, messages};
use mujoco_rs::prelude::{MjData, MjModel, MjSpec, MjtDisableBit, MjtWarning};
use mujoco_rs::wrappers::mj_auxiliary::MjVfs;
use servobench_files::with_short_quotes;
use servobench_plant::MechanicsError;
use std::path::Path;
use std::sync::Arc;

/// The data of one simulation.
pub(crate) type Data = MjData<Arc<MjModel>>;

/// Compiles MJCF text. `path` is the origin of the text: included files are looked up beside it.
pub(crate) fn compile(xml: &str, path: &Path) -> Result<MjModel, MechanicsError> {
    library::load().map_err(|message| MechanicsError::Native { engine: NAME, message })?;
    messages::install();
    let model_error = |message: String| MechanicsError::Model { engine: NAME, message: of_a_file(&message, path) };
    if path.as_os_str().as_encoded_bytes().contains(&0) {
        return Err(model_error("the path has a NUL character".into()));
    }
    let mut files = MjVfs::new();
    files.add_from_buffer(path, xml.as_bytes()).map_err(|e| model_error(e.to_string()))?;
    MjSpec::from_xml_vfs(path, &files)
        .and_then(|mut spec| spec.compile_with_vfs(&files))
        .map_err(|e| model_error(e.to_string()))
}

/// Message of `MuJoCo` about the file at `path`, with at most a few characters of its contents. The path itself stays.
fn of_a_file(message: &str, path: &Path) -> String {
    let path = path.display().to_string();
    let parts: Vec<String> = message.split(path.as_str()).map(with_short_quotes).collect();
    parts.join(&path)
}

/// Starts a simulation of `model` with steps of `step` seconds, with the features `disable` switched off in addition to its own.
pub(crate) fn start(mut model: MjModel, step: f64, disable: &[MjtDisableBit]) -> Result<Data, MechanicsError> {
    let options = model.opt_mut();
    options.timestep = step;
    // A diverged step would otherwise restart from time zero without notice.
    for flag in disable.iter().chain([&MjtDisableBit::mjDSBL_AUTORESET]) {
        options.disableflags |= *flag as i32;
    }
    MjData::try_new(Arc::new(model)).map_err(|e| MechanicsError::Native { engine: NAME, message: e.to_string() })
}

/// Runs one step.
///
/// # Errors
/// [`MechanicsError::Diverged`] or [`MechanicsError::Native`] when `MuJoCo` warned during the step.
pub(crate) fn step(data: &mut Data) -> Result<(), MechanicsError> {
    data.step();
    if data.warning().iter().all(|warning| warning.number == 0) {
        return Ok(());
    }
    Err(warned(data))
}

/// The error for the warnings that `data` holds.
#[cold]
fn warned(data: &Data) -> MechanicsError {
    let happened = |kind: MjtWarning| data.warning()[kind as usize].number > 0;
    let bad = [MjtWarning::mjWARN_BADQPOS, MjtWarning::mjWARN_BADQVEL, MjtWarning::mjWARN_BADQACC];
    let message = messages::take_warning().unwrap_or_else(|| "a warning without words".into());
    if bad.into_iter().any(happened) {
        MechanicsError::Diverged { engine: NAME, message }
    } else {
        MechanicsError::Native { engine: NAME, message }
    }
}
