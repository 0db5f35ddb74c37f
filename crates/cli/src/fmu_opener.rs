//! Opening of FMUs in scenarios, and the program that runs them.
use servobench_engine_fmu::{Code, Fmu, HostCommand};
use servobench_fmi::{FmuMistake, FmuRequest, Slave};
use servobench_sim::FmuOpener;
use std::io;

/// The command with which this program hosts an FMU.
pub(crate) const HOST: &str = "fmu-host";

/// The engine `fmu`, which also opens FMUs beside an axis: without running any of their code, in separate processes, or as the scenario
/// specifies.
pub(crate) const DESCRIBED: Fmu = Fmu { host, code: Code::None };
pub(crate) const ISOLATED: Fmu = Fmu { host, code: Code::Isolated };
pub(crate) const ANYWHERE: Fmu = Fmu { host, code: Code::Anywhere };

/// This program again.
fn host() -> io::Result<HostCommand> {
    Ok(HostCommand { program: std::env::current_exe()?, args: vec![HOST.into()], env: Vec::new() })
}

/// Opens FMUs by this engine `fmu`.
pub(crate) struct ByEngine(pub(crate) Fmu);

impl FmuOpener for ByEngine {
    fn open(&self, request: &FmuRequest<'_>) -> Result<Box<dyn Slave>, Vec<FmuMistake>> {
        self.0.open(request)
    }
}
