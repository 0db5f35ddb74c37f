//! A panic as an error, confined to the work that panicked.
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use thiserror::Error;

/// The work panicked.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("the run panicked (a defect of servobench): {words}")]
pub struct Panicked {
    /// Message of the panic.
    pub words: String,
}

/// Does `work`; a panic loses only its values.
///
/// # Errors
/// [`Panicked`] with the message of the panic.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, Panicked> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| Panicked { words: words(panic.as_ref()) })
}

fn words(panic: &(dyn Any + Send)) -> String {
    let literal = panic.downcast_ref::<&str>().map(|words| (*words).to_owned());
    literal.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "no message".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_of_a_panic_are_kept() {
        assert_eq!(caught(|| 1), Ok(1));
        assert_eq!(caught(|| -> () { panic!("plain") }).unwrap_err().words, "plain");
        let formatted = caught(|| -> () { panic!("number {}", 7) }).unwrap_err();
        assert_eq!(formatted.to_string(), "the run panicked (a defect of servobench): number 7");
    }
}
