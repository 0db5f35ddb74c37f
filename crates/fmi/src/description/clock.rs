//! Ticks of clocks (FMI 3.0.2, §2.2.8 and §2.4.7.5).
use super::element::Element;
use super::variable::Causality;
use crate::error::FmuError;

servobench_config::choices! {
    /// What is known of the time from one tick of a clock to the next.
    pub enum IntervalVariability {
        /// it is always the same and in the description
        Constant = "constant",
        /// it is always the same from the initialisation on
        Fixed = "fixed",
        /// it changes with tunable parameters
        Tunable = "tunable",
        /// the FMU says it at each tick
        Changing = "changing",
        /// the FMU says it at any event
        Countdown = "countdown",
        /// there is none: the clock ticks when something happens
        Triggered = "triggered",
    }
}

/// Timing of a clock's ticks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ticks {
    /// Kind of its interval.
    pub variability: IntervalVariability,
    /// Time from tick to tick (s), if the description gives it.
    pub interval: Option<f64>,
    /// Time from the start to the first tick (s).
    pub shift: f64,
}

impl Ticks {
    /// True if the importer has to keep its time. A triggered clock ticks when another one does.
    #[must_use]
    pub fn are_by_time(&self) -> bool {
        self.variability != IntervalVariability::Triggered
    }

    /// Reads `<Clock>`. The decimal numbers equal the counters with their resolution, which are rounded less.
    pub(super) fn read(element: Element, causality: Causality) -> Result<Self, FmuError> {
        element.required("intervalVariability")?;
        let variability = element.named("intervalVariability")?.unwrap_or(IntervalVariability::Triggered);
        if causality != Causality::Input && variability != IntervalVariability::Triggered {
            return Err(element.wrong("intervalVariability", "`triggered` for a clock that is no input"));
        }
        let count = |attribute| {
            element.read(attribute, "a whole number of 64 bits without a sign", |text| text.parse::<u64>().ok())
        };
        let resolution = count("resolution")?;
        if resolution == Some(0) {
            return Err(element.wrong("resolution", "at least 1 in a second"));
        }
        let counted = |attribute| -> Result<Option<f64>, FmuError> {
            #[expect(clippy::cast_precision_loss, reason = "a time in seconds is rounded")]
            Ok(count(attribute)?.zip(resolution).map(|(count, resolution)| count as f64 / resolution as f64))
        };
        let interval = counted("intervalCounter")?.or(element.number("intervalDecimal")?);
        if interval.is_some_and(|interval| interval <= 0.0) {
            let attribute =
                if element.text("intervalDecimal").is_some() { "intervalDecimal" } else { "intervalCounter" };
            return Err(element.wrong(attribute, "more than 0 s"));
        }
        if variability == IntervalVariability::Constant && interval.is_none() {
            element.required("intervalDecimal")?;
        }
        let shift = counted("shiftCounter")?.or(element.number("shiftDecimal")?).unwrap_or(0.0);
        if shift < 0.0 {
            return Err(element.wrong("shiftDecimal", "0 s or more"));
        }
        Ok(Self { variability, interval, shift })
    }
}
