//! Reasons for refusing an MJCF file.
use servobench_files::{listed, named, quoted};
use servobench_plant::{Refusal, RefusedAt};
use thiserror::Error;

/// A part of an MJCF file that the engine `rapier` does not simulate, by name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub(crate) enum MjcfRefusal {
    /// The text is not XML, or not MJCF.
    #[error("{message}")]
    Unreadable {
        /// Message of the reader.
        message: String,
    },
    /// An element outside the subset.
    #[error("line {line}: `<{}>` in `<{parent}>` is not simulated; there can be {supported}", named(.element))]
    Element {
        /// Line in the file, from 1.
        line: u32,
        /// The element.
        element: String,
        /// The parent element.
        parent: &'static str,
        /// Allowed elements.
        supported: String,
    },
    /// An attribute outside the subset.
    #[error("line {line}: attribute `{}` of `<{element}>` is not simulated; it can have {supported}", named(.attribute))]
    Attribute {
        /// Line in the file, from 1.
        line: u32,
        /// The element.
        element: &'static str,
        /// The attribute.
        attribute: String,
        /// Allowed attributes.
        supported: String,
    },
    /// A value outside the subset.
    #[error("line {line}: `{attribute}=\"{}\"` of `<{element}>` is not simulated; it must be {supported}", quoted(.value))]
    Value {
        /// Line in the file, from 1.
        line: u32,
        /// The element.
        element: &'static str,
        /// The attribute.
        attribute: String,
        /// Its value.
        value: String,
        /// Allowed values.
        supported: String,
    },
    /// Elements nested too deep.
    #[error(
        "line {line}: `<{element}>` is nested more than {depth} elements deep; put bodies beside each other, or leave out those without a joint"
    )]
    TooDeep {
        /// Line in the file, from 1.
        line: u32,
        /// The element.
        element: String,
        /// Largest nesting depth.
        depth: usize,
    },
    /// A missing attribute that the engine would have to guess.
    #[error("line {line}: `<{element}>` needs the attribute `{attribute}`")]
    Missing {
        /// Line in the file, from 1.
        line: u32,
        /// The element.
        element: &'static str,
        /// The attribute.
        attribute: &'static str,
    },
    /// Several joints in one body.
    #[error("body {} has {joints} joints; one is simulated: give each further joint a body of its own", names([&**.body]))]
    SeveralJoints {
        /// Name of the body.
        body: String,
        /// Number of its joints.
        joints: usize,
    },
    /// Two geoms that could touch.
    #[error(
        "geoms of body {} and body {} could touch, and contacts are not simulated; \
         set contype=\"0\" conaffinity=\"0\" on one of them, exclude the pair, \
         or switch contacts off by <option><flag contact=\"disable\"/></option>",
        names([&**.first]),
        names([&**.second])
    )]
    Contact {
        /// Name of one body.
        first: String,
        /// Name of the other.
        second: String,
    },
    /// A body with an impossible mass or inertia.
    #[error("body {} has {what}; it must be {bound}", names([&**.body]))]
    Mass {
        /// Name of the body.
        body: String,
        /// The quantity and its value.
        what: String,
        /// Bound of the quantity.
        bound: &'static str,
    },
    /// A joint that moves no inertia.
    #[error("joint {} moves nothing that has {what}; give its body an <inertial> or a geom with mass", names([&**.joint]))]
    Massless {
        /// Name of the joint.
        joint: String,
        /// Mass, or inertia about the axis.
        what: &'static str,
    },
    /// An unknown name.
    #[error("there is no {what} {}; there is {known}", names([&**.name]))]
    Unknown {
        /// Kind of the name: joint, motor, default class.
        what: &'static str,
        /// The name.
        name: String,
        /// Known names.
        known: String,
    },
    /// An actuator that cannot apply the drive's effort to the motor joint.
    #[error("motor `{actuator}` {what}; it must act on joint `{joint}` with a gear other than zero")]
    Actuator {
        /// Name of the actuator.
        actuator: String,
        /// The mistake.
        what: String,
        /// The motor joint.
        joint: String,
    },
    /// A joint that slides where the axis turns, or the reverse.
    #[error("{message}")]
    Misfit {
        /// Name of the joint.
        joint: String,
        /// True for the motor joint.
        is_motor: bool,
        /// The mismatch, and its remedy.
        message: String,
    },
}

impl From<&MjcfRefusal> for Refusal {
    fn from(refusal: &MjcfRefusal) -> Self {
        let place = match refusal {
            MjcfRefusal::Element { line, .. }
            | MjcfRefusal::Attribute { line, .. }
            | MjcfRefusal::Value { line, .. }
            | MjcfRefusal::TooDeep { line, .. }
            | MjcfRefusal::Missing { line, .. } => RefusedAt::Line(*line),
            MjcfRefusal::Unknown { name, .. } | MjcfRefusal::Actuator { actuator: name, .. } => {
                RefusedAt::Name(name.clone())
            }
            MjcfRefusal::Misfit { joint, is_motor, .. } => {
                RefusedAt::Joint { name: joint.clone(), is_motor: *is_motor }
            }
            MjcfRefusal::Unreadable { .. }
            | MjcfRefusal::SeveralJoints { .. }
            | MjcfRefusal::Contact { .. }
            | MjcfRefusal::Mass { .. }
            | MjcfRefusal::Massless { .. } => RefusedAt::File,
        };
        Self { place, message: refusal.to_string() }
    }
}

/// Names of a file in a list for a message.
pub(crate) fn names<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    listed(names, "none")
}

/// Our own words in a list for a message.
pub(crate) fn list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    if names.is_empty() { "none".into() } else { names.join(", ") }
}
