//! Units in which a file gives positions and their derivatives, so that results are shown in the same units.
use crate::argument::{Derivative, axis_quantity};
use crate::parameters::Parameter;
use servobench_base::Coordinate;
use servobench_metrics::DisplayUnits;

/// Keys of `[setpoint]` and `[[program]]` that give a derivative of position.
const KEYS: [(&str, Derivative); 7] = [
    ("move_to", Derivative::Position),
    ("move_by", Derivative::Position),
    ("velocity", Derivative::Velocity),
    ("reach_velocity", Derivative::Velocity),
    ("acceleration", Derivative::Acceleration),
    ("jerk", Derivative::Jerk),
    ("snap", Derivative::Snap),
];

/// Display units of an axis with coordinate `motion`: for each derivative, the first unit used by a key of a move.
pub(crate) fn display_units(parameters: &[Parameter], motion: Coordinate) -> DisplayUnits {
    let mut units = DisplayUnits::new(motion.unit());
    // The first unit of a kind counts, so it is set last.
    for Parameter { key, value, .. } in parameters.iter().rev() {
        let (table, last) = (key.split('.').next(), key.rsplit('.').next());
        if !matches!(table, Some("setpoint" | "program")) {
            continue;
        }
        let derivative = KEYS.iter().find(|(name, _)| Some(*name) == last).map(|(_, derivative)| *derivative);
        if let Some(derivative) = derivative
            && let Ok((si, _)) = axis_quantity(derivative, Some(motion), value)
        {
            units = units.as_given(derivative as usize, value, si);
        }
    }
    units
}

#[cfg(test)]
mod tests {
    use crate::parse;

    const TEXT: &str = r#"
run.base_rate = "12 kHz"
axis = { motion = "linear", motor_side.mass = "21 kg" }
motor.kind = "prescribed"
[setpoint]
order = 3
velocity = "30 m/min"
acceleration = "1 m/s2"
jerk = "0.5 km/s3"
[[program]]
move_to = "0 mm"
[[program]]
move_by = "1 cm"
[[program]]
move_to = "250 mm"
[limits]
overshoot = "1 um"
"#;

    fn told(text: &str, k: usize, value: f64) -> String {
        let loaded = parse("a.toml", text, None).unwrap_or_else(|error| panic!("{error}"));
        loaded.scenario.units.plain(k).text(value)
    }

    /// Zero gives no scale of its unit: the next value counts.
    #[test]
    fn a_length_is_told_in_the_unit_of_the_first_move() {
        assert_eq!(told(TEXT, 0, 0.25), "25 cm");
        assert_eq!(told(&TEXT.replace("1 cm", "20 mm"), 0, 0.25), "250 mm");
        assert_eq!(
            (told(TEXT, 1, 0.5), told(TEXT, 2, 0.5), told(TEXT, 3, 0.5)),
            ("30 m/min".into(), "0.5 m/s2".into(), "0.0005 km/s3".into())
        );
        assert_eq!(told(TEXT, 4, 10.0), "0.01 km/s⁴", "as the jerk, which is nearest");
        let without = TEXT.split("[[program]]").next().unwrap();
        assert_eq!(told(without, 0, 0.25), "0.25 m");
    }

    #[test]
    fn angles_are_told_in_the_unit_of_the_file() {
        let text = TEXT
            .replace("\"linear\", motor_side.mass = \"21 kg\"", "\"rotary\", motor_side.inertia = \"1 kg m2\"")
            .replace("30 m/min", "60 rpm")
            .replace("1 m/s2", "1 rad/s2")
            .replace("0.5 km/s3", "5 rad/s3")
            .replace("1 cm", "90 deg")
            .replace("250 mm", "1 rev")
            .replace("0 mm", "0 deg")
            .replace("1 um", "1 urad");
        assert_eq!(told(&text, 0, std::f64::consts::PI), "180 deg");
        assert_eq!(told(&text, 1, std::f64::consts::PI), "30 rpm");
    }
}
