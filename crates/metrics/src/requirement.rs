//! Requirements that every run must meet beside its limits, except for those that its scenario lifts by name.
//!
//! A requirement is a line of [`Requirement`] and a module that gives the reasons why a recording breaks it. Their exact
//! meanings, with all numbers, are in `docs/requirements.md`.
mod arrival;
mod bounds;
mod calm;
mod deflection;
mod effort;
mod excitation;
mod execution;
mod fault;
mod following;
mod growth;
mod harm;
mod held_modes;
mod home_place;
mod judge;
mod phases;
mod rings;
mod rules;
mod servo;
mod stable;
mod standing;
mod stopping;
mod stretch;
mod swings;
mod task;
mod turning_points;
mod velocity;

pub use arrival::arrival_window;
pub use deflection::Deflection;
pub use judge::judge_requirements;
pub use rules::{Disturbance, Driven, EarlyEnd, LinearLoop, Oscillation, Poles, Readings, Rules, Tolerances};
pub use servo::Servo;

use crate::incident::Incident;
use serde::{Deserialize, Serialize};
use servobench_signals::Signal;
use std::fmt;
use std::str::FromStr;

/// Declares [`Requirement`] once: variant, name in files, meaning in a few words.
macro_rules! requirements {
    ($($variant:ident $text:literal $meaning:literal,)*) => {
        /// Requirements that every run must meet unless its scenario lifts them; the order is the order of tables.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Requirement {
            $(#[doc = $meaning] $variant,)*
        }

        impl Requirement {
            /// Every requirement, in the order of tables.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)*];

            /// Name in scenario files and results.
            #[must_use]
            pub const fn as_str(self) -> &'static str {
                match self { $(Self::$variant => $text,)* }
            }

            /// Meaning in a few words.
            #[must_use]
            pub const fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $meaning,)* }
            }
        }
    };
}

requirements! {
    Follows "follows" "the load follows the requested positions",
    Arrives "arrives" "the load rests at each target",
    Stands "stands" "the axis is at rest before its first motion",
    Velocity "velocity" "the load reaches each velocity that is requested and held",
    Effort "effort" "the motor gives each requested torque or force",
    Stopped "stopped" "the axis comes to rest after each stop",
    Executed "executed" "every motion and every call is executed and ends without an error",
    NoFault "no_fault" "axis, drive and link have no faults except expected ones",
    Stable "stable" "the loop is stable, and no oscillation grows or alternates between limits",
    Rings "rings" "no oscillation persists after a motion",
    NoHarm "no_harm" "machine, motor and trajectory come to no harm except expected incidents",
    Bounded "bounded" "positions stay finite and within a multiple of the range of the program",
}

/// Source and name of the signal with the [kind](servobench_base::RequestKind) of request that the task makes.
pub const REQUEST_KIND: (&str, &str) = ("request", "kind");

/// Channels by which requirements are judged, if the axis has them. They are recorded at every tick, whatever is kept.
pub const JUDGED_BY: [Signal; 14] = [
    Signal::RequestPosition,
    Signal::RequestVelocity,
    Signal::RequestEffort,
    Signal::SetpointPosition,
    Signal::MotorPosition,
    Signal::LoadPosition,
    Signal::BusPosition,
    Signal::FollowingErrorMotor,
    Signal::EffortReference,
    Signal::EffortMotor,
    Signal::DisturbanceMotor,
    Signal::DisturbanceLoad,
    Signal::EffortEndStop,
    Signal::TemperatureWinding,
];

impl fmt::Display for Requirement {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.as_str())
    }
}

impl FromStr for Requirement {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        Self::ALL.iter().copied().find(|one| one.as_str() == text).ok_or(())
    }
}

/// Status of a requirement in a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Standing {
    /// The requirement is met.
    Met,
    /// The requirement is broken, for at least one reason.
    Broken,
    /// The scenario lifts it; the reasons are those that would have broken it, if any.
    Lifted,
    /// The requirement has no meaning in this run: a program without calls, an axis without a drive.
    NotAsked,
}

/// Status of a requirement in a run, with reasons.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RequirementResult {
    /// Status of the requirement.
    pub standing: Standing,
    /// Reasons why it is broken, or would be if it were not lifted, each in a sentence.
    pub reasons: Vec<String>,
}

impl RequirementResult {
    /// True of a requirement `name` that is broken, or lifted and would be: the run did not do what was requested, and its metrics cannot
    /// be compared with those of other runs. Lifting `rings` is the method to measure swings after a stop.
    #[must_use]
    pub fn is_not_met(&self, name: &str) -> bool {
        match self.standing {
            Standing::Broken => true,
            Standing::Lifted => !self.reasons.is_empty() && name != "rings",
            Standing::Met | Standing::NotAsked => false,
        }
    }
}

/// A fault or an incident that the scenario expects.
#[derive(Debug, Clone, PartialEq)]
pub struct Expectation {
    /// The fault or incident.
    pub on: Occasion,
    /// Earliest time (s).
    pub from: f64,
    /// Latest time (s); infinite: the end of the run.
    pub to: f64,
}

/// Occasions that can be expected.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Occasion {
    /// A fault.
    Fault {
        /// State or error code: `ErrorStop`, `8611h`, the `ErrorID` of a block.
        fault: String,
        /// Its source: `axis`, `drive`, `link`, or the name of a call.
        who: String,
    },
    /// An event that is an incident.
    Event(Incident),
}

/// An expectation, and the time at which it was met.
#[derive(Debug, Clone, PartialEq)]
pub struct Expected {
    /// The expectation.
    pub expectation: Expectation,
    /// Time of its occurrence (s); `None`: it did not occur.
    pub met: Option<f64>,
}

impl Expectation {
    /// True without a window of time: such an expectation excuses its occasion at any time, as a lifted requirement does.
    #[must_use]
    pub fn is_wide_open(&self) -> bool {
        self.from <= 0.0 && !self.to.is_finite()
    }

    /// True if an occurrence at `time` (s) is within the window of time.
    #[must_use]
    pub fn is_open_at(&self, time: f64) -> bool {
        (self.from..=self.to).contains(&time)
    }

    /// Value of `fault` as a code, if it is one: four hexadecimal digits and an `h`.
    #[must_use]
    pub fn code_of(fault: &str) -> Option<u32> {
        let digits = fault.strip_suffix('h').filter(|digits| digits.len() == 4)?;
        digits.bytes().all(|digit| digit.is_ascii_hexdigit()).then(|| u32::from_str_radix(digits, 16).ok())?
    }
}

/// `8611h of the drive`, `the event end_stop`
impl fmt::Display for Occasion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fault { fault, who } => write!(f, "{fault} of `{who}`"),
            Self::Event(incident) => write!(f, "the event `{incident}`"),
        }
    }
}

/// The occasion, with the window of time where there is one
impl fmt::Display for Expectation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { on, from, to } = self;
        write!(f, "{on}")?;
        match (*from > 0.0, to.is_finite()) {
            (false, false) => Ok(()),
            (true, false) => write!(f, " from {from} s on"),
            (false, true) => write!(f, " until {to} s"),
            (true, true) => write!(f, " from {from} s to {to} s"),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::synthetic::Build;

    /// A closed loop without anything special.
    pub(crate) fn rules() -> Rules<'static> {
        Rules {
            lifted: &[],
            expected: &[],
            window: None,
            home_at: None,
            increment: 0.0,
            noise: 0.0,
            motor: Readings::default(),
            disturbances: Vec::new(),
            excited: Vec::new(),
            transmission: 1.0,
            bus_unit: 0.0,
            servo: None,
            held_modes: Vec::new(),
            deflection: Deflection::default(),
            tolerances: Tolerances::default(),
            driven: Driven::ByLoops,
            linear_loop: LinearLoop::Stable,
            poles: None,
            not_analysed: None,
            ended: None,
            winding_limit: None,
        }
    }

    pub(crate) fn expecting(who: &str, fault: &str, from: f64, to: f64) -> Expectation {
        Expectation { on: Occasion::Fault { fault: fault.into(), who: who.into() }, from, to }
    }

    #[test]
    fn names_read_back_and_codes_are_four_digits() {
        for requirement in Requirement::ALL {
            assert_eq!(requirement.as_str().parse(), Ok(*requirement));
        }
        assert_eq!("arrive".parse::<Requirement>(), Err(()));
        for (text, code) in
            [("8611h", Some(0x8611)), ("ff0Ah", Some(0xFF0A)), ("8611", None), ("0x86h", None), ("+611h", None)]
        {
            assert_eq!(Expectation::code_of(text), code, "{text}");
        }
    }

    #[test]
    fn what_is_lifted_keeps_its_reasons_and_fails_nothing() {
        let recording = Build::new(1000, 11).channel(Signal::LoadPosition, "m", |_| 0.0).finish();
        let linear_loop = LinearLoop::Unstable("the loop is unstable".into());
        let strict = judge_requirements(&recording, &Rules { linear_loop: linear_loop.clone(), ..rules() });
        let result = |standing| RequirementResult { standing, reasons: vec!["the loop is unstable".into()] };
        let broken = result(Standing::Broken);
        assert!(!strict.passed() && strict.requirements.contains(&(Requirement::Stable, broken)), "{strict:?}");
        assert_eq!(strict.reasons().collect::<Vec<_>>(), ["stable: the loop is unstable"]);
        let lifted = judge_requirements(&recording, &Rules { linear_loop, lifted: &[Requirement::Stable], ..rules() });
        let standing = result(Standing::Lifted);
        assert!(lifted.passed() && lifted.requirements.contains(&(Requirement::Stable, standing)), "{lifted:?}");
    }

    /// A run that is judged without an analysis of its loop passes with a warning; if it fails anyway, or is lifted, there is no warning.
    #[test]
    fn what_is_not_analysed_is_a_warning() {
        let recording = Build::new(1000, 11).channel(Signal::LoadPosition, "m", |_| 0.0).finish();
        let not_analysed = Some("an FMU stands for the drive".to_owned());
        let open = Rules { linear_loop: LinearLoop::NotAnalysed, not_analysed, ..rules() };
        let verdict = judge_requirements(&recording, &open);
        assert!(verdict.passed());
        assert_eq!(verdict.warnings, ["stable: an FMU stands for the drive"]);
        for (lifted, driven) in [(Requirement::ALL, Driven::ByLoops), (&[], Driven::Not)] {
            let verdict = judge_requirements(&recording, &Rules { lifted, driven, ..open.clone() });
            assert_eq!(verdict.warnings, [""; 0]);
        }
        let unstable = Rules { linear_loop: LinearLoop::Unstable("the loop is unstable".into()), ..open };
        assert_eq!(judge_requirements(&recording, &unstable).warnings, [""; 0]);
    }

    /// A run that diverged cannot be judged: no lift makes it pass.
    #[test]
    fn a_run_that_diverged_cannot_pass() {
        let recording = Build::new(1000, 11).finish();
        let ended = Some(EarlyEnd::Diverged { time: 0.01, reason: "not finite".into() });
        let verdict = judge_requirements(&recording, &Rules { ended, lifted: Requirement::ALL, ..rules() });
        assert!(!verdict.passed(), "{verdict:?}");
    }

    #[test]
    fn an_expected_fault_that_does_not_come_is_a_failure() {
        let recording = Build::new(1000, 11).finish();
        let expected = [expecting("drive", "8611h", 0.2, 0.6)];
        let verdict = judge_requirements(&recording, &Rules { expected: &expected, ..rules() });
        assert_eq!(
            verdict.reasons().collect::<Vec<_>>(),
            ["expected, but did not occur: 8611h of `drive` from 0.2 s to 0.6 s"]
        );
    }

    #[test]
    fn an_expectation_without_a_window_of_time_is_wide_open() {
        let infinite = f64::INFINITY;
        for (from, to, wide) in [(0.0, infinite, true), (0.1, infinite, false), (0.0, 0.5, false), (0.1, 0.5, false)] {
            let of_event = Expectation { on: Occasion::Event(Incident::EndStop), from, to };
            assert_eq!(of_event.is_wide_open(), wide, "{of_event}");
            assert_eq!(expecting("axis", "ErrorStop", from, to).is_wide_open(), wide);
        }
    }

    #[test]
    fn of_many_reasons_a_handful_is_given() {
        let mut recording = Build::new(1000, 11).finish();
        recording.calls = (0..9)
            .map(|k| servobench_trace::Call {
                name: format!("call_{k}"),
                block: "MC_Stop".into(),
                is_optional: false,
                fate: servobench_trace::CallFate::Unfinished("Done".into()),
            })
            .collect();
        let verdict = judge_requirements(&recording, &rules());
        let reasons: Vec<_> = verdict.reasons().collect();
        assert_eq!((reasons.len(), reasons[5].as_str()), (6, "executed: and 4 more"));
    }

    #[test]
    fn the_documentation_defines_every_requirement() {
        let page = include_str!("../../../docs/requirements.md");
        for name in Requirement::ALL {
            assert!(page.contains(&format!("`{name}`")), "docs/requirements.md lacks `{name}`");
        }
    }
}
