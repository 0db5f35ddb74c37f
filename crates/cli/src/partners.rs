//! FMUs of scenarios: who opens them, and the program that they run in.
use servobench_engine_fmu::{Fmu, HostCommand, PartnerModel};
use servobench_fmi::Slave;
use servobench_plant::MechanicsError;
use servobench_sim::{PartnerOrder, Partners, fmu_isolation, fmu_start};
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

impl Partners for ByEngine {
    fn open(&self, order: &PartnerOrder<'_>) -> Result<Box<dyn Slave>, String> {
        let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        let model = PartnerModel {
            path: order.fmu.path.clone(),
            name: order.fmu.name.clone(),
            start: fmu_start(&order.fmu.start),
            inputs: owned(&order.inputs),
            outputs: owned(&order.outputs),
            end: order.end,
            isolation: fmu_isolation(order.fmu),
        };
        ENGINE.partner(&model).map_err(|error| match error {
            MechanicsError::Model { message, .. } => message,
            other => other.to_string(),
        })
    }
}
