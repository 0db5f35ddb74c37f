//! Texts of restored errors. They must live as long as the program, like those written in it.
use super::Damaged;
use std::boxed::Box;
use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

/// Largest total length of stored texts (bytes): errors have some hundred different ones.
const MOST: usize = 1 << 16;

static KEPT: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());

/// The text `text`, stored once.
///
/// # Errors
/// [`Damaged`] if the total exceeds any set of error texts.
pub(super) fn kept(text: &str) -> Result<&'static str, Damaged> {
    let mut all = KEPT.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(kept) = all.get(text) {
        return Ok(kept);
    }
    if all.iter().map(|kept| kept.len()).sum::<usize>() + text.len() > MOST {
        return Err(Damaged);
    }
    let kept: &'static str = Box::leak(text.into());
    all.insert(kept);
    Ok(kept)
}
