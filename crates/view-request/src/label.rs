//! Labels of compared runs.
use thiserror::Error;

/// First parts of entity paths that no run may have: bounds in plots, and the planes of the motor.
pub const RESERVED: [&str; 7] =
    ["limit", "allowed", "window", "effort_over_speed", "current_plane", "voltage_plane", "effort_over_angle"];

/// A label that cannot be the first part of an entity path.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("run {number} of the comparison has the label `{label}`, which {reason}; give every run its own short label")]
pub struct LabelError {
    /// Number of the run, from 1.
    pub number: usize,
    /// Rejected label.
    pub label: String,
    /// Reason.
    pub reason: &'static str,
}

/// Checks the labels of overlaid runs.
///
/// # Errors
/// [`LabelError`] for a label that is empty, reserved or used twice.
pub fn check_labels(labels: &[&str]) -> Result<(), LabelError> {
    for (index, label) in labels.iter().enumerate() {
        let reason = if label.is_empty() {
            "is empty"
        } else if label.starts_with("__") || RESERVED.contains(label) {
            "is reserved"
        } else if labels[..index].contains(label) {
            "an earlier run has already"
        } else {
            continue;
        };
        return Err(LabelError { number: index + 1, label: (*label).to_owned(), reason });
    }
    Ok(())
}
