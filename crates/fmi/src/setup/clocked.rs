//! Clocks of FMI 3.0. None is ticked: a setup that would wait for one for ever is refused.
use crate::description::{Causality, ModelDescription, Ticks};
use servobench_config::Choice as _;

/// Checks that no clock has to be ticked from outside at its own times; the error names the clock and the remedy.
///
/// A triggered input clock is not refused: it stands for an event that need not happen.
pub(super) fn check(it: &ModelDescription) -> Result<(), (&str, String)> {
    let inputs = it.variables.iter().filter(|variable| variable.causality == Causality::Input);
    let mut clocks = inputs.filter_map(|variable| Some((variable, variable.ticks.filter(Ticks::are_by_time)?)));
    let Some((clock, ticks)) = clocks.next() else { return Ok(()) };
    let when = match ticks {
        Ticks { interval: Some(interval), shift: 0.0, .. } => format!("every {interval} s"),
        Ticks { interval: Some(interval), shift, .. } => {
            format!("every {interval} s from {shift} s after the start on")
        }
        Ticks { interval: None, variability, .. } => {
            format!("at times that it says itself (`{}`)", variability.name())
        }
    };
    let problem = format!(
        "it has to be ticked from outside, {when}, which is not supported; export the model without input clocks by time, with \
         events that it announces itself"
    );
    Err((&clock.name, problem))
}

/// A variable with clocks may be set and read only while one of them ticks (FMI 3.0.2, §2.2.6).
pub(super) fn check_wired(it: &ModelDescription, variable: usize) -> Result<(), String> {
    let references = &it.variables[variable].clocks;
    let clocks =
        it.variables.iter().filter(|clock| clock.ticks.is_some() && references.contains(&clock.value_reference));
    let names: Vec<String> = clocks.map(|clock| format!("`{}`", clock.name)).collect();
    let which = match &names[..] {
        [] => return Ok(()),
        [name] => format!("the clock {name}"),
        names => format!("one of the clocks {}", names.join(", ")),
    };
    Err(format!(
        "it is there only while {which} ticks, and clocks are not supported; wire a variable without clocks, or export the model \
         without them"
    ))
}
