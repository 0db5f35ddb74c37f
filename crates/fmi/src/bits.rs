//! Numbers as sent to another process.
pub(crate) use servobench_fmu_file::bits::{float, optional};

/// Severity of a log line.
pub(crate) mod severity {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};
    use servobench_base::Severity;

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
    pub(crate) fn serialize<S: Serializer>(value: &Severity, serializer: S) -> Result<S::Ok, S::Error> {
        let number: u8 = match value {
            Severity::Info => 0,
            Severity::Warning => 1,
            Severity::Error => 2,
        };
        number.serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Severity, D::Error> {
        Ok(match u8::deserialize(deserializer)? {
            0 => Severity::Info,
            1 => Severity::Warning,
            _ => Severity::Error,
        })
    }
}
