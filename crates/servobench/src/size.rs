//! Memory of the recording of a run.
use servobench_scenario::Scenario;
use servobench_sim::{Program, RECORDING_LIMIT, most_channels, run_length};
use servobench_trace::IN_MEMORY;

/// Bytes of a value.
const VALUE: f64 = size_of::<f64>() as f64;

/// True where `scenario` is measured from rows at `record.rate`, because every tick would take too much memory.
#[must_use]
pub fn is_thinned(scenario: &Scenario) -> bool {
    let Some(duration) = length(scenario) else { return false };
    is_too_much(duration * f64::from(scenario.base_rate.hertz()) + 1.0, channels(scenario))
}

/// Memory that the recording of `scenario` takes (bytes), at most; 0 when the moves cannot be planned and nothing will be recorded.
#[must_use]
pub fn memory(scenario: &Scenario) -> u64 {
    let Scenario { record, base_rate, .. } = scenario;
    let Some(duration) = length(scenario) else {
        return 0;
    };
    let channels = channels(scenario);
    let rows = |hertz: u32| duration * f64::from(hertz) + 1.0;
    // Rows beyond these are in a file.
    let bytes = |hertz: u32| rows(hertz).min(IN_MEMORY as f64) * channels as f64 * VALUE;
    let (every, kept) = (bytes(base_rate.hertz()), bytes(record.rate.hertz()));
    let bytes = if is_too_much(rows(base_rate.hertz()), channels) {
        kept
    } else if record.rate == *base_rate {
        every
    } else {
        // Every tick until it is measured, beside the kept rows.
        every + kept
    };
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates: more than there is")]
    let bytes = bytes.ceil() as u64;
    bytes
}

/// Length of the run (s); `None` where its moves cannot be planned.
fn length(scenario: &Scenario) -> Option<f64> {
    scenario.duration.or_else(|| Some(run_length(scenario, &Program::new(scenario).ok()?)))
}

/// Largest number of channels that it records.
fn channels(scenario: &Scenario) -> usize {
    let named = scenario.record.channels.len();
    if named == 0 { most_channels(scenario) } else { named }
}

/// True where that many rows of `channels` are not kept.
fn is_too_much(rows: f64, channels: usize) -> bool {
    rows * channels as f64 * VALUE > RECORDING_LIMIT * 1e9
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scenario(text: &str) -> Scenario {
        servobench_scenario::parse("test", text, None).unwrap_or_else(|e| panic!("{e}")).scenario
    }

    const TEXT: &str = r#"
        engine = ["exact"]
        [run]
        base_rate = "1 kHz"
        duration = "2 s"
        [axis]
        motion = "linear"
        [axis.motor_side]
        mass = "20 kg"
        [motor]
        kind = "prescribed"
        [record]
        channels = ["load.position", "motor.position"]
    "#;

    /// Instants 0 to 2000 at 1 kHz, two channels, eight bytes each.
    #[test]
    fn memory_is_that_of_the_recorded_values() {
        assert_eq!(memory(&scenario(TEXT)), 2001 * 2 * 8);
        // Without a duration: a pause of 1 s and half a second.
        let paused =
            TEXT.replace("duration = \"2 s\"", "").replace("[record]", "[[program]]\nwait = \"1 s\"\n[record]");
        assert_eq!(memory(&scenario(&paused)), 1501 * 2 * 8);
        let thinned = TEXT.replace("[record]", "[record]\nrate = \"100 Hz\"");
        assert_eq!(memory(&scenario(&thinned)), (2001 + 201) * 2 * 8);
        // Without a list it is that of every channel which such an axis has: none of a bus or of currents, one of which there are.
        let all = scenario(&TEXT.replace("channels = [\"load.position\", \"motor.position\"]", ""));
        let channels = memory(&all) / (2001 * 8);
        assert_eq!(channels as usize, most_channels(&all));
        assert!((10..servobench_signals::Signal::ALL.len() as u64 / 2).contains(&channels), "{channels}");
    }
}
