//! FMUs beside an axis, loaded into this process: they are compiled by the drill itself.
use servobench_engine_fmu::{Code, Fmu, HostCommand};
use servobench_fmi::{FmuMistake, FmuRequest, Slave};
use servobench_sim::FmuOpener;
use std::io;

/// Opens FMUs whose scenario says `isolation = "none"`.
pub(crate) struct Here;

impl FmuOpener for Here {
    fn open(&self, request: &FmuRequest<'_>) -> Result<Box<dyn Slave>, Vec<FmuMistake>> {
        Fmu { host, code: Code::Anywhere }.open(request)
    }
}

fn host() -> io::Result<HostCommand> {
    Err(io::Error::other("this program hosts no FMU: say `isolation = \"none\"`"))
}
