//! What each engine makes of the fastest mode.
use super::{Doubt, Modes};
use servobench_metrics::Quantity;
use servobench_plant::{Distortion, EngineName, Integrator, Mode};
use servobench_scenario::Scenario;
use std::f64::consts::TAU;

/// Frequency may be wrong by this share.
const MOST_SHIFT: f64 = 0.01;
/// The engine's own damping may be this share of that of the mode …
const MOST_OF_DAMPING: f64 = 0.1;
/// … or take this share of the amplitude over the run, which nobody sees.
const MOST_LOST: f64 = 0.01;

/// How an engine integrates the fastest mode of a chain.
#[derive(Debug, Clone, PartialEq)]
pub struct EngineSteps {
    /// The engine.
    pub engine: EngineName,
    /// The mode.
    pub mode: Mode,
    /// How the engine goes from tick to tick.
    pub integrator: Integrator,
    /// Base ticks per period of it.
    pub steps: f64,
    /// What becomes of it; `None` when the engine does not keep it within bounds, which [`check`](crate::check) says.
    pub distortion: Option<Distortion>,
}

impl EngineSteps {
    /// Of those `engines` that integrate it; none on a rigid axis, and where a file of the user's or an FMU knows the modes.
    pub(super) fn of(scenario: &Scenario, modes: Option<&Modes>, engines: &[EngineName]) -> Vec<Self> {
        let h = scenario.base_rate.period();
        let Some(mode) = modes.and_then(Modes::fastest) else { return Vec::new() };
        let of = |engine: &EngineName| {
            let integrator = engine.capabilities().integrator?;
            let (steps, distortion) = (TAU / (mode.omega * h), integrator.distortion(mode.omega, h));
            Some(Self { engine: *engine, mode, integrator, steps, distortion })
        };
        engines.iter().filter_map(of).collect()
    }

    /// What is wrong with it in a run of `length` (s).
    pub(super) fn doubt(&self, length: f64) -> Option<Doubt> {
        let (Mode { omega, damping }, Distortion { damping: added, shift }) = (self.mode, self.distortion?);
        let lost = 1.0 - (-added * omega * length).exp();
        let (frequency, steps) =
            (Quantity::new(omega / TAU, "Hz"), format!("{:.1} base ticks to a period", self.steps));
        let engine = self.engine;
        let message = if shift.abs() > MOST_SHIFT {
            let way = if shift > 0.0 { "too fast" } else { "too slowly" };
            format!("on `{engine}` the mode of {frequency} rings {:.1} % {way}: {steps}", 100.0 * shift.abs())
        } else if added > MOST_OF_DAMPING * damping && lost > MOST_LOST {
            let own =
                if damping > 0.0 { format!("beside {damping:.1e} of its own") } else { "to an undamped one".into() };
            format!(
                "on `{engine}` the mode of {frequency} has a damping ratio of {added:.1e} {own} that the engine adds ({steps}): \
                 {:.0} % of its amplitude over the run",
                100.0 * lost
            )
        } else {
            return None;
        };
        Some(Doubt::new("run.base_rate", message, "raise the base rate, or choose the engine `exact`"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Source, jobs, preview};

    /// The two-mass drive of Saarakkala and Hinkkanen: 84.22 Hz free, 59.55 Hz held.
    fn doubts(rate: &str, damping: &str, duration: &str) -> Vec<String> {
        let text = format!(
            "engine = [\"exact\", \"rapier\", \"mujoco\"]\n[run]\nbase_rate = \"{rate}\"\nduration = \"{duration}\"\n[axis]\n\
             motion = \"rotary\"\nmotor_side.inertia = \"0.005 kg m2\"\nload = {{ inertia = \"0.005 kg m2\", stiffness = \
             \"700 Nm/rad\"{damping} }}\n[motor]\nkind = \"ideal-source\"\n[drive]\nenabled = false\n"
        );
        let scenario =
            servobench_scenario::parse("test", &text, None).unwrap_or_else(|error| panic!("{error}")).scenario;
        let preview = preview(&jobs(vec![Source { scenario, text }], &[])).unwrap().unwrap();
        let modes = preview.modes.as_ref().unwrap();
        // Half a unit of the last digit.
        assert!((modes.free[0].omega / TAU - 84.22).abs() < 0.005 && (modes.held[0].omega / TAU - 59.55).abs() < 0.005);
        preview.doubts.into_iter().map(|doubt| doubt.message).collect()
    }

    /// Oracle: ω·h = 0.2646 at 2 kHz: (ω·h)²/24 = 0.29 %, (ω·h)⁵/144 = 9.0e-6, less (ω·h)²/8 of it,
    /// of which 60 s at 529 rad/s make e^(−0.28).
    #[test]
    fn damping_of_the_engine_is_doubted_where_it_shows() {
        let found = doubts("2 kHz", "", "60 s");
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].contains("`mujoco`") && found[0].contains("8.9e-6 to an undamped one"), "{found:?}");
        assert!(found[0].contains("23.7 base ticks") && found[0].contains("25 %"), "{found:?}");
        assert_eq!(doubts("2 kHz", "", "1 s"), [""; 0], "half a per cent of the amplitude");
        assert_eq!(doubts("2 kHz", ", damping = \"0.01 Nm s/rad\"", "60 s"), [""; 0], "ζ is 3.8e-3");
        assert_eq!(doubts("16 kHz", "", "60 s"), [""; 0]);
    }

    /// Oracle: ω·h = 1.058 at 500 Hz: asin(ω·h/2)/(ω·h/2) is 5.4 % above one; RK4 takes (ω·h)⁵/144 = 9e-3.
    #[test]
    fn a_mode_that_rings_too_fast_is_doubted() {
        let found = doubts("500 Hz", ", damping = \"0.01 Nm s/rad\"", "1 s");
        assert!(
            found.len() == 2 && found[0].contains("on `rapier`") && found[0].contains("5.4 % too fast"),
            "{found:?}"
        );
        assert!(found[1].contains("on `mujoco`") && found[1].contains("beside 3.8e-3 of its own"), "{found:?}");
    }
}
