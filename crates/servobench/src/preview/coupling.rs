//! Expected error of the coupling with FMUs, from the slowest mode of the axis.
use super::{Doubt, Modes};
use servobench_metrics::{COUPLING_ERROR_WARNED, Quantity};
use servobench_scenario::{Fmu, InputSource, Scenario};
use std::f64::consts::TAU;

/// A doubt where an FMU pushes an axis that it follows, and the exchange is too coarse for the slowest mode with the motor held. Modes of
/// the FMU itself, and the share of a faster mode, appear only in a run, in the metric `coupling_error`.
pub(super) fn doubt(scenario: &Scenario, modes: Option<&Modes>) -> Option<Doubt> {
    let omega = modes?.held.first()?.omega;
    let coupled = scenario.fmus.iter().filter(|fmu| fmu.efforts().next().is_some() && follows_the_axis(fmu));
    let length = f64::from(coupled.map(|fmu| fmu.every).max()?) * scenario.base_rate.period();
    let error = scenario.coupling.error_of_a_mode(omega * length);
    (error > COUPLING_ERROR_WARNED).then(|| {
        let (frequency, exchanges) = (Quantity::new(omega / TAU, "Hz"), TAU / (omega * length));
        let message = format!(
            "the mode of {frequency} has {exchanges:.1} exchanges with FMUs to a period: what they exchange is off by about {:.1} %",
            100.0 * error
        );
        Doubt::new("coupling.step", message, "take a smaller step, or another `method` or `extrapolation`")
    })
}

/// True where an input of the FMU is the motion of the axis.
fn follows_the_axis(fmu: &Fmu) -> bool {
    fmu.inputs.iter().any(|(_, source)| !matches!(source, InputSource::Time | InputSource::Fmu { .. }))
}
