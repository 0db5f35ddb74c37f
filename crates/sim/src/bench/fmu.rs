//! Requests to open FMUs beside the axis.
use servobench_base::Coordinate;
use servobench_fmi::{FmuRequest, SiPort};
use servobench_scenario::{Fmu, InputSource, LoopSignal, si_unit};
use servobench_signals::Equipment;

/// Request for an FMU beside the axis. `outputs` are the ones wanted, each with its signal if it goes to the axis. Its steps are `step` (s)
/// long, and the last one ends at `end` (s).
pub(crate) fn request<'a>(
    fmu: &'a Fmu,
    outputs: &[(&str, Option<LoopSignal>)],
    (equipment, motor_motion): (&Equipment, Coordinate),
    (step, end): (f64, f64),
) -> FmuRequest<'a> {
    let shaft = motor_motion.unit();
    let given = |source: &InputSource| match source {
        InputSource::Time => "s".to_owned(),
        InputSource::ShaftPosition => shaft.to_owned(),
        InputSource::ShaftVelocity => format!("{shaft}/s"),
        InputSource::Signal(signal) => signal.unit().symbol(equipment),
        InputSource::Fmu { .. } => String::new(),
    };
    let taken = |taken: LoopSignal| taken.signal().unit().symbol(equipment);
    let port = |variable: &str, unit: &str| SiPort { variable: variable.to_owned(), unit: si_unit(unit) };
    FmuRequest {
        file: &fmu.file,
        name: Some(&fmu.name),
        inputs: fmu.inputs.iter().map(|(variable, signal)| port(variable, &given(signal))).collect(),
        outputs: outputs
            .iter()
            .map(|(variable, signal)| port(variable, &signal.map_or_else(String::new, taken)))
            .collect(),
        step,
        end: Some(end),
        waits: true,
    }
}
