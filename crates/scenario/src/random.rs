//! The keys that seed the random numbers of a scenario.
use crate::scenario::Scenario;

/// A key that seeds random numbers, and its value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Seed {
    /// The key: `motor.encoder.seed`, `bus.fault.0.seed`.
    pub key: String,
    /// Its value in the file, or its default.
    pub value: u32,
}

/// Default seed of noise.
const OF_NOISE: u32 = 0;
/// Default seed of jitter.
const OF_JITTER: u32 = 1;
/// Kinds of bus faults that use random numbers.
const JITTER: [&str; 2] = ["jitter", "task-jitter"];

impl Scenario {
    /// The seeds of everything random in it: noise of encoders and current sensors, jitter of frames and of the task. Without any seed, all
    /// runs are identical.
    #[must_use]
    pub fn seeds(&self) -> Vec<Seed> {
        let value = |key: &str| self.parameters.iter().find(|one| one.key == key).map(|one| one.value.as_str());
        let seed = |table: &str, default: u32| {
            let key = format!("{table}.seed");
            let value = value(&key).and_then(|value| value.parse().ok()).unwrap_or(default);
            Seed { key, value }
        };
        let all = self.parameters.iter().filter_map(|one| {
            let (table, key) = one.key.rsplit_once('.')?;
            match key {
                "noise" if !is_zero(&one.value) => Some(seed(table, OF_NOISE)),
                "kind" if table.starts_with("bus.fault.") && JITTER.contains(&one.value.as_str()) => {
                    Some(seed(table, OF_JITTER))
                }
                _ => None,
            }
        });
        all.collect()
    }
}

/// True if a quantity as written, such as `0 um`, is zero.
fn is_zero(text: &str) -> bool {
    let number: String = text.trim().chars().take_while(|c| c.is_ascii_digit() || "+-.".contains(*c)).collect();
    number.parse::<f64>() == Ok(0.0)
}

#[cfg(test)]
mod tests {
    use crate::parse;

    const AXIS: &str = r#"
        [run]
        base_rate = "8 kHz"
        [axis]
        motion = "linear"
        motor_side = { mass = "20 kg" }
        [motor]
        kind = "ideal-source"
        encoder = { step = "1 um", ENCODER }
        [drive]
        velocity = { rate = "4 kHz", bandwidth = "80 Hz" }
        position = { rate = "4 kHz", gain = "60 1/s" }
        BUS
        [setpoint]
        order = 2
        velocity = "0.5 m/s"
        acceleration = "5 m/s2"
        [[program]]
        move_to = "50 mm"
    "#;

    fn seeds(encoder: &str, bus: &str) -> Vec<(String, u32)> {
        let text = AXIS.replace("ENCODER", encoder).replace("BUS", bus);
        let scenario = parse("axis", &text, None).unwrap_or_else(|error| panic!("{error}")).scenario;
        scenario.seeds().into_iter().map(|seed| (seed.key, seed.value)).collect()
    }

    #[test]
    fn noise_and_jitter_have_seeds_and_nothing_else_has() {
        assert_eq!(seeds("", ""), []);
        assert_eq!(seeds("noise = \"0 um\", seed = 7", ""), [], "no noise");
        assert_eq!(seeds("noise = \"0.1 um\"", ""), [("motor.encoder.seed".to_owned(), 0)]);
        assert_eq!(seeds("noise = \"0.1 um\", seed = 7", ""), [("motor.encoder.seed".to_owned(), 7)]);
        let late = "[bus]\ncycle = \"1 ms\"\n[[bus.fault]]\nkind = \"late\"\nby = \"250 us\"\n";
        let jitter = format!("{late}[[bus.fault]]\nkind = \"jitter\"\nby = \"250 us\"\n");
        assert_eq!(seeds("", late), []);
        assert_eq!(seeds("", &jitter), [("bus.fault.1.seed".to_owned(), 1)]);
    }
}
