//! What is to be equal: `vibration`, `vibration=20um`.
use servobench_suite::EqualQuantity;

/// What is equal in all runs of a comparison.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Equal {
    /// The limits: it is an error when one that several moves have differs.
    Limits,
    /// What the moves are slowed for.
    Slowed(EqualTerm),
}

/// A quantity that is made equal, and by how much.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct EqualTerm {
    pub(crate) quantity: EqualQuantity,
    /// The value that is wanted, with its unit; that of the gentlest run without.
    pub(crate) value: Option<String>,
}

impl Equal {
    /// Reads `duration`, `vibration=20um`. Which unit fits depends on the axis.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let (name, value) = match text.split_once('=') {
            Some((name, value)) => (name.trim(), Some(value.trim())),
            None => (text.trim(), None),
        };
        let quantity = match (name, value) {
            ("limits", None) => return Ok(Self::Limits),
            ("limits", Some(_)) => return Err("limits takes no value: those of the scenarios are compared".into()),
            ("duration", _) => EqualQuantity::Duration,
            ("torque" | "force", _) => EqualQuantity::Torque,
            ("current", _) => EqualQuantity::Current,
            ("vibration", _) => EqualQuantity::Vibration,
            _ => {
                return Err(
                    "it is one of limits, duration, torque, current and vibration, all but limits with a value if one is \
                            wanted: vibration=20um"
                        .into(),
                );
            }
        };
        if value == Some("") {
            return Err(format!("a value is missing behind {name}=; leave = out for that of the gentlest run"));
        }
        Ok(Self::Slowed(EqualTerm { quantity, value: value.map(str::to_owned) }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantity_may_have_a_value() {
        let slowed =
            |quantity, value: Option<&str>| Ok(Equal::Slowed(EqualTerm { quantity, value: value.map(str::to_owned) }));
        assert_eq!(Equal::parse("limits"), Ok(Equal::Limits));
        assert_eq!(Equal::parse("duration"), slowed(EqualQuantity::Duration, None));
        assert_eq!(Equal::parse("force=5 N"), slowed(EqualQuantity::Torque, Some("5 N")));
        assert_eq!(Equal::parse("vibration = 20 um"), slowed(EqualQuantity::Vibration, Some("20 um")));
        for wrong in ["", "speed", "limits=1", "torque="] {
            assert!(Equal::parse(wrong).is_err(), "{wrong}");
        }
    }
}
