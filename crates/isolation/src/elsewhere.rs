//! Where nothing can be contained.
use crate::error::ContainError;

/// Contains nothing.
///
/// # Errors
/// Always.
pub fn contain() -> Result<(), ContainError> {
    Err(ContainError::NotStarted)
}

/// There are none.
#[must_use]
pub fn end_all() -> Vec<u32> {
    Vec::new()
}
