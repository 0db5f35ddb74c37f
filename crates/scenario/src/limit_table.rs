//! `[limits]`: metrics by name, each with what it measures.
use crate::diagnostic::Report;
use crate::field::{Field, Measure, any, not_negative};
use crate::nearest::suggestion;
use crate::physical::Kind::{self, Axis as InAxis, Motor as InMotor, Plain};
use crate::physical::{
    CURRENT, CURRENT_RMS, EFFORT, ENERGY, FREQUENCY, POSITION, POWER, RATIO, TIME, VELOCITY, VOLTAGE_AMPLITUDE,
};
use crate::scenario::Limit;
use crate::source::At;
use crate::table::object_schema;
use crate::tree::{Node, Value};
use serde_json::{Value as Json, json};

/// A metric that can have a limit.
struct Metric {
    name: &'static str,
    kind: Kind,
    example: &'static str,
    meaning: &'static str,
}

const fn metric(name: &'static str, kind: Kind, example: &'static str, meaning: &'static str) -> Metric {
    Metric { name, kind, example, meaning }
}

const LENGTH: Kind = InAxis(&POSITION);
const SECONDS: Kind = Plain(&TIME);
const PURE: Kind = Plain(&RATIO);

/// Negative where a vibration grows.
const DAMPING: &str = "residual_vibration_damping";

/// Names and order are those of the crate `metrics`; a test holds them together.
const METRICS: [Metric; 35] = [
    metric("move_time", SECONDS, "1.35 s", "duration of the longest set-point profile"),
    metric("settling_time", SECONDS, "50 ms", "last exit of the load from the window after the end of the profile"),
    metric("move_and_settling_time", SECONDS, "1.4 s", "longest profile with its settling time"),
    metric("overshoot", LENGTH, "5 um", "largest excursion of the load beyond the target"),
    metric("steady_state_error", LENGTH, "1 um", "target minus load position once at rest"),
    metric("following_error_peak_motor", LENGTH, "10 um", "largest following error of the motor"),
    metric("following_error_peak_load", LENGTH, "10 um", "largest following error of the load"),
    metric("following_error_rms_motor", LENGTH, "5 um", "RMS following error of the motor during moves"),
    metric("following_error_rms_load", LENGTH, "5 um", "RMS following error of the load during moves"),
    metric("following_error_cruise_motor", LENGTH, "0.8 mm", "following error of the motor at constant velocity"),
    metric("following_error_cruise_load", LENGTH, "0.8 mm", "following error of the load at constant velocity"),
    metric(
        "velocity_error_peak",
        InAxis(&VELOCITY),
        "5 mm/s",
        "largest difference between commanded and actual motor velocity",
    ),
    metric("residual_vibration_pp", LENGTH, "1 um", "peak-to-peak vibration of the load after the profile"),
    metric("residual_vibration_rms", LENGTH, "0.3 um", "RMS vibration of the load after the profile"),
    metric(
        "residual_vibration_amplitude",
        LENGTH,
        "0.5 um",
        "amplitude of the dominant mode at the end of the profile",
    ),
    metric("residual_vibration_frequency", Plain(&FREQUENCY), "40 Hz", "natural frequency of the dominant mode"),
    metric(DAMPING, PURE, "0.02", "damping ratio of the dominant mode"),
    metric("residual_vibration_share", PURE, "0.9", "share of the vibration that the fitted modes explain"),
    metric("setpoint_velocity_ratio", PURE, "1", "peak velocity of the set-point over its limit"),
    metric("setpoint_acceleration_ratio", PURE, "1", "peak acceleration of the set-point over its limit"),
    metric("setpoint_jerk_ratio", PURE, "1", "peak jerk of the set-point over its limit"),
    metric("setpoint_snap_ratio", PURE, "1", "peak snap of the set-point over its limit"),
    metric("current_peak", Plain(&CURRENT), "12 Apk", "largest current vector"),
    metric("current_rms", Plain(&CURRENT_RMS), "4 Arms", "effective phase current over the recording"),
    metric("current_saturation_time", SECONDS, "0 s", "time at the current limit"),
    metric("voltage_peak", Plain(&VOLTAGE_AMPLITUDE), "300 V", "largest voltage vector of the inverter"),
    metric("voltage_saturation_time", SECONDS, "0 s", "time at the voltage limit"),
    metric("effort_saturation_time", SECONDS, "0 s", "time at the effort limit"),
    metric("torque_peak", InMotor(&EFFORT), "8 Nm", "largest torque or force of the motor"),
    metric("torque_reference_peak", InMotor(&EFFORT), "8 Nm", "largest torque or force that the drive asks for"),
    metric("torque_rms", InMotor(&EFFORT), "2 Nm", "RMS torque or force of the motor over the recording"),
    metric(
        "electrical_power_peak",
        Plain(&POWER),
        "800 W",
        "largest electrical power of the motor, taken or given back",
    ),
    metric("shaft_power_peak", Plain(&POWER), "750 W", "largest power of the motor on its shaft, driving or braking"),
    metric(
        "electrical_energy",
        Plain(&ENERGY),
        "120 J",
        "electrical energy that the motor takes, less what it gives back",
    ),
    metric("copper_loss", Plain(&ENERGY), "15 J", "energy lost in the winding"),
];

impl Metric {
    fn largest(&self) -> Measure {
        not_negative(self.kind, self.example)
    }

    /// An end of a range; below zero only where the value can be, and its sign is no direction: bounds are of magnitudes.
    fn end(&self) -> Measure {
        if self.name == DAMPING { any(self.kind, self.example) } else { self.largest() }
    }
}

/// Limits in the order of the file.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LimitTable(pub(crate) Vec<At<Limit>>);

impl Field for LimitTable {
    type Spec = ();

    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        let Value::Table(table) = &node.value else {
            let message = format!("`{path}` must be a table, got {}", node.value.kind());
            report.error(node.span, message, format!("write `[{path}]`"));
            return None;
        };
        let mut limits = Vec::new();
        for entry in &table.entries {
            let Some(metric) = METRICS.iter().find(|metric| metric.name == entry.key) else {
                let names = METRICS.iter().map(|metric| metric.name);
                report.error(
                    entry.key_span,
                    format!("there is no metric `{}`", entry.key),
                    suggestion(&entry.key, names),
                );
                continue;
            };
            let limit = limit(&format!("{path}.{}", metric.name), metric, &entry.node, report);
            limits.extend(limit.map(|value| At { value, span: entry.key_span }));
        }
        Some(Self(limits))
    }

    fn schema((): &()) -> Json {
        let keys = METRICS.iter().map(|metric| {
            let end = f64::schema(&metric.end());
            let range = json!({
                "type": "object",
                "additionalProperties": false,
                "minProperties": 1,
                "properties": { "min": end, "max": end },
            });
            let schema = json!({ "anyOf": [f64::schema(&metric.largest()), range] });
            (metric.name, vec![metric.meaning], schema)
        });
        let keys: Vec<_> = keys.collect();
        let keys = keys.iter().map(|(name, doc, schema)| (*name, doc.as_slice(), schema.clone())).collect();
        object_schema(&["Limits by metric."], &[], keys)
    }
}

fn limit(path: &str, metric: &Metric, node: &Node, report: &mut Report) -> Option<Limit> {
    let name = metric.name.to_owned();
    let Value::Table(range) = &node.value else {
        let max = f64::decode(path, node, &metric.largest(), report)?;
        return Some(Limit { metric: name, min: None, max: Some(max) });
    };
    let mut bounds = [None, None];
    let mut is_right = true;
    for entry in &range.entries {
        let slot = match entry.key.as_str() {
            "min" => 0,
            "max" => 1,
            other => {
                report.error(
                    entry.key_span,
                    format!("unknown key `{other}` in `{path}`"),
                    suggestion(other, ["min", "max"]),
                );
                is_right = false;
                continue;
            }
        };
        bounds[slot] = f64::decode(&format!("{path}.{}", entry.key), &entry.node, &metric.end(), report);
        is_right &= bounds[slot].is_some();
    }
    match bounds {
        _ if !is_right => None,
        [None, None] => {
            report.error(node.span, format!("`{}` has no bound", metric.name), "give `min`, `max` or both");
            None
        }
        [Some(min), Some(max)] if min > max => {
            report.error(node.span, format!("`{}` has a `min` above its `max`", metric.name), "");
            None
        }
        [min, max] => Some(Limit { metric: name, min, max }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use servobench_metrics::Name;

    #[test]
    fn the_metrics_are_those_that_are_measured() {
        let ours: Vec<_> = METRICS.iter().map(|metric| (metric.name, metric.meaning)).collect();
        let measured: Vec<_> = Name::ALL.iter().map(|name| (name.as_str(), name.meaning())).collect();
        assert_eq!(ours, measured);
    }
}
