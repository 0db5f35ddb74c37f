//! `[requirements]` and `[[expect]]`: requirements on a run in addition to its limits, and the faults and incidents that belong to it.
use crate::diagnostic::Report;
use crate::field::Field;
use crate::simple::OneOf;
use crate::source::At;
use crate::table::{object_schema, table};
use crate::tree::{Node, Value};
use serde_json::{Value as Json, json};
use servobench_config::Kind::Plain;
use servobench_config::quantities::{RATIO, TIME};
use servobench_config::{not_negative, positive};
use servobench_files::suggestion;
use servobench_metrics::{Incident, Requirement};

/// The requirements that the file names; true for those that apply.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RequirementTable(pub(crate) Vec<At<(Requirement, bool)>>);

impl Field for RequirementTable {
    fn decode(path: &str, node: &Node, (): &(), report: &mut Report) -> Option<Self> {
        let Value::Table(table) = &node.value else {
            let message = format!("`{path}` must be a table, got {}", node.value.kind());
            report.error(node.span, message, format!("write `[{path}]`"));
            return None;
        };
        let mut named = Vec::new();
        for entry in &table.entries {
            let Ok(requirement) = entry.key.parse::<Requirement>() else {
                let names = Requirement::ALL.iter().map(|requirement| requirement.as_str());
                let message = format!("unknown requirement `{}`", entry.key);
                report.error(entry.key_span, message, suggestion(&entry.key, names));
                continue;
            };
            let holds = bool::decode(&format!("{path}.{requirement}"), &entry.node, &(), report);
            named.extend(holds.map(|holds| At { value: (requirement, holds), span: entry.key_span }));
        }
        Some(Self(named))
    }

    fn schema((): &()) -> Json {
        let keys = Requirement::ALL
            .iter()
            .map(|requirement| (requirement.as_str(), vec![requirement.meaning()], json!({ "type": "boolean" })));
        let keys: Vec<_> = keys.collect();
        let keys = keys.iter().map(|(name, doc, schema)| (*name, ("", doc.as_slice()), schema.clone())).collect();
        object_schema(&["Requirements on the run beside its limits; each applies unless it is `false`."], &[], keys)
    }
}

servobench_config::choices! {
    /// Kinds of `[[expect]]`.
    pub(crate) enum ExpectedOn default Fault {
        /// `fault` of `who`
        Fault = "fault",
        /// an incident: `event`
        Event = "event",
    }
}

table! {
    /// A fault or an incident that belongs to the run: it violates no requirement, and a run without it fails. The consequences of a
    /// fault for the other parts of the axis are expected with it: a fault of the drive or the link takes the axis to `ErrorStop`.
    /// Blocks that end in `Error`, and incidents, are expected one by one.
    pub(crate) struct Expect {
        /// Fault or incident; default: "fault".
        on: ExpectedOn = OneOf,
        /// State or error code: "ErrorStop" of the axis, the code of the drive (603Fh) as in "8611h", the name of the
        /// link's fault as in "positive limit switch", the `ErrorID` of a call as in "2002h".
        fault: String = (),
        /// Source of the fault: "axis", "drive", "link", or the name of a call.
        who: String = (),
        /// Name of the incident, with `on = "event"`.
        event: Incident = OneOf,
        /// Earliest time of its occurrence; default: the beginning.
        from: f64 = not_negative(Plain(&TIME), "0.2 s"),
        /// Latest time of its first occurrence; default: the end of the run.
        to: f64 = positive(Plain(&TIME), "0.6 s"),
    }
}

table! {
    /// Tolerances between the axis and its requests, as shares.
    pub(crate) struct Tolerance {
        /// Deviation from the response of its loops, as a share of the path between two turning points; default: 0.03.
        follows: f64 = positive(Plain(&RATIO), "0.05"),
        /// Deviation from a target, as a share of the distance to it, where the window is not smaller; default: 0.05.
        arrives: f64 = positive(Plain(&RATIO), "0.05"),
        /// Deviation from a velocity that is held, as a share of it; default: 0.03.
        velocity: f64 = positive(Plain(&RATIO), "0.05"),
        /// Deviation from a torque or force, as a share of it; default: 0.04.
        effort: f64 = positive(Plain(&RATIO), "0.05"),
    }
}
