//! Whatever is recorded: a diagram that can be read, or a refusal in words; never a panic, never a place that is no number.
use crate::recordings::{channel, empty};
use roxmltree::Document;
use servobench_fuzz::{Number, ValueGenerator, check, fuzz, produce};
use servobench_report::{TimingOptions, timing_diagram};
use servobench_trace::{Recording, Signal};

const NAMES: [&str; 8] =
    ["Execute", "Done", "Error", "state", "mode", "<&\">", "", "a name that is far too long to be read"];
const VALUES: [&str; 6] = ["TRUE", "FALSE", "Discrete Motion", "", "]]>&\0", "Fault reaction active"];
const CHANNELS: [&str; 4] = ["setpoint.velocity", "load.velocity", "setpoint.position", "load.position"];

/// What a recording and its options are made of.
#[derive(Debug)]
struct Made {
    /// Channels that are there and how many instants they have, by bits.
    shape: [u8; 4],
    values: [f64; 12],
    /// Name and source of a signal, and its changes: a time and a value.
    signals: [(u8, [(u8, f64); 4]); 5],
    range: [f64; 2],
    width: u16,
}

fn made() -> impl ValueGenerator<Output = Made> {
    let number = Number::any();
    let signal = (produce::<u8>(), [(produce::<u8>(), number); 4]);
    (produce::<[u8; 4]>(), [number; 12], [signal; 5], [number; 2], 400..2000_u16)
        .map_gen(|(shape, values, signals, range, width)| Made { shape, values, signals, range, width })
}

impl Made {
    fn recording(&self) -> Recording {
        let channels = CHANNELS.into_iter().zip(self.shape).filter(|(_, shape)| shape & 1 == 1).map(|(name, shape)| {
            let count = usize::from(shape) * if shape & 2 == 2 { 40 } else { 1 };
            channel(name, "rad/s", self.values.iter().cycle().take(count).copied().collect())
        });
        let signals = self.signals.iter().map(|(names, changes)| {
            let mut changes: Vec<(f64, String)> =
                changes.iter().map(|(value, t)| (*t, VALUES[usize::from(*value) % VALUES.len()].to_owned())).collect();
            if names & 0x80 == 0 {
                changes.sort_by(|one, other| one.0.total_cmp(&other.0));
            }
            let name = |bits: u8| NAMES[usize::from(bits & 7)].to_owned();
            Signal { source: name(names >> 4), name: name(*names), changes }
        });
        let count = usize::from(self.shape[0] >> 5);
        Recording { channels: channels.collect(), signals: signals.take(count).collect(), ..empty() }
    }

    fn options(&self) -> TimingOptions {
        let bits = self.shape[1];
        let part = |bit: u8, value: f64| (bits >> bit & 1 == 1).then_some(value);
        TimingOptions {
            from: part(6, self.range[0]),
            to: part(7, self.range[1]),
            width: u32::from(self.width),
            sources: if bits & 0x30 == 0x30 { vec!["Done".into()] } else { vec![] },
            with_idle: bits & 8 == 8,
        }
    }
}

#[test]
fn random_recordings() {
    fuzz(check!(), 3_000, made(), |made| match timing_diagram(&made.recording(), &made.options()) {
        Ok(svg) => {
            let document = Document::parse(&svg).unwrap();
            for attribute in document.descendants().flat_map(|node| node.attributes()) {
                let value = attribute.value();
                assert!(!value.contains("NaN") && !value.contains("inf"), "{}=\"{value}\"", attribute.name());
                let is_length = ["width", "height"].contains(&attribute.name());
                assert!(!is_length || value.parse::<f64>().unwrap() >= 0.0, "{}=\"{value}\"", attribute.name());
            }
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    });
}
