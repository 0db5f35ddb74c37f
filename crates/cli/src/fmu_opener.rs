//! FMUs of scenarios: who opens them, and the program that they run in.
use servobench_engine_fmu::{Fmu, HostCommand};
use servobench_fmi::{FmuMistake, FmuRequest, Slave};
use servobench_sim::FmuOpener;
use std::io;

/// The command with which this program hosts an FMU.
pub(crate) const HOST: &str = "fmu-host";

/// The engine `fmu`, and whoever opens FMUs beside an axis.
pub(crate) const ENGINE: Fmu = Fmu { host };

/// This program again.
fn host() -> io::Result<HostCommand> {
    Ok(HostCommand { program: std::env::current_exe()?, args: vec![HOST.into()], env: Vec::new() })
}

/// Opens FMUs by the engine `fmu`.
pub(crate) struct ByEngine;

impl FmuOpener for ByEngine {
    fn open(&self, request: &FmuRequest<'_>) -> Result<Box<dyn Slave>, Vec<FmuMistake>> {
        ENGINE.open(request)
    }
}
