//! Recordings for the tests.
use servobench_base::Rate;
use servobench_trace::{About, Channel, ChannelSpec, Recording, Signal};

/// Nothing yet, of an axis in m.
pub(crate) fn empty() -> Recording {
    Recording {
        about: About {
            scenario: "second block aborts the first".into(),
            engine: "exact".into(),
            axis_unit: "m".into(),
            bodies: vec!["load".into()],
            overrides: vec![],
        },
        rate: Rate::new(1000).unwrap(),
        channels: vec![],
        moves: vec![],
        events: vec![],
        signals: vec![],
        calls: vec![],
        limit_reversals: vec![],
        log: vec![],
        coupling: None,
    }
}

/// A signal with these changes.
pub(crate) fn signal(source: &str, name: &str, changes: &[(f64, &str)]) -> Signal {
    let changes = changes.iter().map(|(time, value)| (*time, (*value).to_owned())).collect();
    Signal { source: source.into(), name: name.into(), changes }
}

/// A signal that is FALSE from 0 on and changes at each of `times` (s).
pub(crate) fn logic(source: &str, name: &str, times: &[f64]) -> Signal {
    let later = times.iter().enumerate().map(|(k, time)| (*time, ["TRUE", "FALSE"][k % 2]));
    signal(source, name, &std::iter::once((0.0, "FALSE")).chain(later).collect::<Vec<_>>())
}

/// A channel with these values.
pub(crate) fn channel(name: &str, unit: &str, values: Vec<f64>) -> Channel {
    let spec = ChannelSpec {
        axis: None,
        name: name.into(),
        unit: unit.into(),
        writer: "test".into(),
        rate: Rate::new(1000).unwrap(),
    };
    Channel { spec, values: values.into() }
}

/// Velocity at `t` (s): at 2 m/s to 6 m, aborted at 1.5 s by 3 m/s to 10 m, with 4 m/s². At 1.5 s 2.1 m are behind it, so
/// that it brakes at 3.8 s and is there at 4.55 s.
pub(crate) fn velocity(t: f64) -> f64 {
    let ramp = |from: f64, start: f64, rate: f64| from + rate * (t - start);
    match t {
        ..0.2 => 0.0,
        0.2..0.7 => ramp(0.0, 0.2, 4.0),
        0.7..1.5 => 2.0,
        1.5..1.75 => ramp(2.0, 1.5, 4.0),
        1.75..3.8 => 3.0,
        3.8..4.55 => ramp(3.0, 3.8, -4.0),
        _ => 0.0,
    }
}

/// MC_MoveAbsolute twice, the second during the first; the load follows with a lag of 30 ms.
pub(crate) fn aborted() -> Recording {
    let set_point: Vec<f64> = (0..=5000).map(|k| velocity(f64::from(k) * 1e-3)).collect();
    let lag = |speed: &mut f64, wanted: &f64| {
        *speed += (wanted - *speed) / 30.0;
        Some(*speed)
    };
    let load: Vec<f64> = set_point.iter().scan(0.0, lag).collect();
    let way = |speeds: &[f64]| -> Vec<f64> {
        let add = |way: &mut f64, speed: &f64| {
            *way += speed * 1e-3;
            Some(*way)
        };
        speeds.iter().scan(0.0, add).collect()
    };
    Recording {
        channels: vec![
            channel("setpoint.position", "m", way(&set_point)),
            channel("load.position", "m", way(&load)),
            channel("setpoint.velocity", "m/s", set_point),
            channel("load.velocity", "m/s", load),
        ],
        signals: vec![
            logic("First", "Execute", &[0.2, 1.6]),
            logic("First", "Done", &[]),
            logic("First", "Busy", &[0.2, 1.5]),
            logic("First", "Active", &[0.2, 1.5]),
            logic("First", "CommandAborted", &[1.5, 1.6]),
            logic("First", "Error", &[]),
            logic("Second", "Execute", &[1.5, 4.8]),
            logic("Second", "Done", &[4.55, 4.8]),
            logic("Second", "Busy", &[1.5, 4.55]),
            logic("Second", "Active", &[1.5, 4.55]),
            logic("Second", "CommandAborted", &[]),
            logic("Second", "Error", &[]),
            signal(
                "axis",
                "state",
                &[(0.0, "Disabled"), (0.1, "Standstill"), (0.2, "Discrete Motion"), (4.55, "Standstill")],
            ),
            signal(
                "drive",
                "state",
                &[
                    (0.0, "Switch on disabled"),
                    (0.04, "Ready to switch on"),
                    (0.06, "Switched on"),
                    (0.08, "Operation enabled"),
                ],
            ),
            signal("drive", "mode", &[(0.0, "cyclic synchronous position")]),
            signal("link", "interpolator", &[(0.0, "Idle"), (0.09, "Running"), (2.5, "Underflow"), (2.501, "Running")]),
        ],
        ..empty()
    }
}
