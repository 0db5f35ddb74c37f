//! Modes as each engine integrates them.
use super::{Doubt, Modes};
use servobench_metrics::Quantity;
use servobench_plant::{Distortion, EngineName, Integrator, Mode};
use servobench_scenario::Scenario;
use std::f64::consts::TAU;

/// Largest permitted relative error of the frequency.
const MOST_SHIFT: f64 = 0.01;
/// Largest permitted lead or lag of a mode at the end of its ringing, as a share of a period.
const MOST_PHASE: f64 = 0.01;
/// A mode rings until this share of its amplitude is left; after that its phase is not visible. Every move excites it anew.
const RUNG_OUT: f64 = 0.01;
/// The engine's own damping may be this share of that of the mode …
const MOST_OF_DAMPING: f64 = 0.1;
/// … or take this share of the amplitude over the run, which is not visible.
const MOST_LOST: f64 = 0.01;

/// Integration of the fastest mode of a chain by an engine.
#[derive(Debug, Clone, PartialEq)]
pub struct EngineSteps {
    /// The engine.
    pub engine: EngineName,
    /// The mode.
    pub mode: Mode,
    /// Integrator of the engine.
    pub integrator: Integrator,
    /// Base ticks per period of the mode.
    pub steps: f64,
    /// Distortion of the mode; `None` when the engine does not keep it within bounds, which [`check`](crate::check) reports.
    pub distortion: Option<Distortion>,
    /// The mode whose phase error is largest before it has rung out.
    lag: Option<Phase>,
}

/// The phase of a mode that an engine rings too fast or too slowly.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Phase {
    /// Frequency of the mode (rad/s).
    omega: f64,
    /// Base ticks per period.
    steps: f64,
    /// Share by which it rings too fast.
    shift: f64,
    /// Length of its ringing (s).
    rings: f64,
}

impl Phase {
    /// The phase of `mode` in ticks of `h` (s), in a run of `length` (s); `None` where the engine does not keep it within bounds.
    fn of(mode: Mode, integrator: Integrator, h: f64, length: f64) -> Option<Self> {
        let Mode { omega, damping } = mode;
        let Distortion { damping: added, shift } = integrator.distortion(omega, h)?;
        let rings = -RUNG_OUT.ln() / (omega * (damping + added));
        Some(Self { omega, steps: TAU / (omega * h), shift, rings: rings.min(length) })
    }

    /// Lead at the end (periods); negative behind.
    fn ahead(&self) -> f64 {
        self.shift * self.omega * self.rings / TAU
    }
}

impl EngineSteps {
    /// Steps of those `engines` that integrate the modes, in a run of `length` (s); none on a rigid axis, and where only a user's file or
    /// an FMU defines the modes.
    pub(super) fn of(scenario: &Scenario, modes: Option<&Modes>, engines: &[EngineName], length: f64) -> Vec<Self> {
        let h = scenario.base_rate.period();
        let Some((modes, mode)) = modes.and_then(|modes| Some((modes, modes.fastest()?))) else { return Vec::new() };
        let of = |engine: &EngineName| {
            let integrator = engine.capabilities().integrator?;
            let (steps, distortion) = (TAU / (mode.omega * h), integrator.distortion(mode.omega, h));
            let phases =
                modes.free.iter().chain(&modes.held).filter_map(|mode| Phase::of(*mode, integrator, h, length));
            let lag = phases.max_by(|one, other| one.ahead().abs().total_cmp(&other.ahead().abs()));
            Some(Self { engine: *engine, mode, integrator, steps, distortion, lag })
        };
        engines.iter().filter_map(of).collect()
    }

    /// Doubt about the distortion in a run of `length` (s).
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
            return self.lag.filter(|phase| phase.ahead().abs() > MOST_PHASE).map(|phase| self.phase_doubt(&phase));
        };
        Some(Doubt::new("run.base_rate", message, "raise the base rate, or choose the engine `exact`"))
    }

    fn phase_doubt(&self, phase: &Phase) -> Doubt {
        let Phase { omega, steps, shift, rings } = *phase;
        let (way, fast) = if shift > 0.0 { ("ahead", "fast") } else { ("behind", "slowly") };
        let periods = phase.ahead().abs();
        let apart = if periods < 1.0 {
            format!("{:.1} % of a period", 100.0 * periods)
        } else {
            format!("{periods:.1} periods")
        };
        let message = format!(
            "on `{}` the mode of {} is {way} by {apart} after the {} that it rings: {:.2} % too {fast}, {steps:.1} base ticks to a period",
            self.engine,
            Quantity::new(omega / TAU, "Hz"),
            Quantity::new(rings, "s"),
            100.0 * shift.abs()
        );
        let others = if self.engine == EngineName::Mujoco { "`exact`" } else { "`exact` or `mujoco`" };
        Doubt::new("run.base_rate", message, format!("raise the base rate, or choose the engine {others}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preview::preview;

    /// The two-mass drive of Saarakkala and Hinkkanen: 84.22 Hz free, 59.55 Hz held.
    fn doubts(rate: &str, damping: &str, duration: &str) -> Vec<String> {
        let text = format!(
            "engine = [\"exact\", \"rapier\", \"mujoco\"]\n[run]\nbase_rate = \"{rate}\"\nduration = \"{duration}\"\n[axis]\n\
             motion = \"rotary\"\nmotor_side.inertia = \"0.005 kg m2\"\nload = {{ inertia = \"0.005 kg m2\", stiffness = \
             \"700 Nm/rad\"{damping} }}\n[motor]\nkind = \"ideal-source\"\n[drive]\nenabled = false\n"
        );
        let scenario =
            servobench_scenario::parse("test", &text, None).unwrap_or_else(|error| panic!("{error}")).scenario;
        let preview = preview(&scenario, &scenario.engines, None).unwrap();
        let modes = preview.modes.as_ref().unwrap();
        // Half a unit of the last digit.
        assert!((modes.free[0].omega / TAU - 84.22).abs() < 0.005 && (modes.held[0].omega / TAU - 59.55).abs() < 0.005);
        preview.doubts.into_iter().map(|doubt| doubt.message).collect()
    }

    /// Oracle: ω·h = 0.2646 at 2 kHz: (ω·h)²/24 = 0.29 %, (ω·h)⁵/144 = 9.0e-6, less (ω·h)²/8 of it,
    /// of which 60 s at 529 rad/s make e^(−0.28).
    #[test]
    fn damping_of_the_engine_is_doubted_where_it_shows() {
        let doubts = |rate, damping, duration| {
            let all = doubts(rate, damping, duration);
            all.into_iter().filter(|said| said.contains("`mujoco`")).collect::<Vec<_>>()
        };
        let found = doubts("2 kHz", "", "60 s");
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].contains("8.9e-6 to an undamped one"), "{found:?}");
        assert!(found[0].contains("23.7 base ticks") && found[0].contains("25 %"), "{found:?}");
        assert_eq!(doubts("2 kHz", "", "1 s"), [""; 0], "half a per cent of the amplitude");
        assert_eq!(doubts("2 kHz", ", damping = \"0.01 Nm s/rad\"", "60 s"), [""; 0], "ζ is 3.8e-3");
        assert_eq!(doubts("16 kHz", "", "60 s"), [""; 0]);
    }

    /// Oracle: 0.114 % too fast at ω·h = 0.165: of 8.4 periods in a tenth of a second 0.96 % of a period, of a second's 9.6 %, of a minute's
    /// 5.8 periods. With ζ = 3.78e-3 the amplitude has fallen to 1 % after 193.9 periods, 22.2 %; with ζ = 0.094 after 7.7 of them, 0.9 %. The
    /// held mode is slower.
    #[test]
    fn a_phase_that_adds_up_to_a_hundredth_of_a_period_is_doubted() {
        for (damping, duration, expected) in [
            ("", "0.1 s", None),
            (
                "",
                "1 s",
                Some("ahead by 9.6 % of a period after the 1.00 s that it rings: 0.11 % too fast, 38.0 base ticks"),
            ),
            (
                ", damping = \"0.01 Nm s/rad\"",
                "60 s",
                Some("ahead by 22.2 % of a period after the 2.30 s that it rings"),
            ),
            (", damping = \"0.25 Nm s/rad\"", "60 s", None),
        ] {
            let found = doubts("3200 Hz", damping, duration);
            assert!(found.len() == usize::from(expected.is_some()), "{damping} {duration}: {found:?}");
            for said in &found {
                assert!(said.starts_with("on `rapier` the mode of 84.2 Hz is"), "{said}");
                assert!(expected.is_some_and(|part| said.contains(part)), "{said}");
            }
        }
        assert_eq!(doubts("16 kHz", "", "1 s"), [""; 0], "0.0046 % of 84 periods");
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
