//! The C interface: pointers are checked, panics are caught, and refused calls are logged.
#![expect(unsafe_code, reason = "functions that other programs call, with pointers of theirs")]

#[cfg(test)]
mod host;
mod v2;
mod v3;

use crate::error::Refusal;
use crate::instance::{Instance, State};
use crate::resources::Resources;
use crate::serialized;
use std::any::Any;
use std::ffi::{CStr, CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;

/// Categories of the log, named by the standard (FMI 2.0.5, §2.2.4).
pub(crate) const CATEGORIES: [(&str, &str); 1] = [("logStatusError", "calls that are refused, and why")];

/// Outcome of a call, with the status codes of both versions. `Discard` is never used: it would mean that the same call may be repeated,
/// which some importers then do endlessly.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Ok = 0,
    Error = 3,
}

/// Destination of messages.
trait Log {
    fn say(&self, outcome: Outcome, category: &CStr, message: &CStr);
}

/// Object behind the host's pointer.
struct Handle {
    instance: Instance,
    token: String,
    log: Box<dyn Log>,
    /// True if errors are logged, the only category.
    logged: bool,
}

impl Handle {
    /// Sets the logged categories; an empty list means all.
    ///
    /// # Errors
    /// [`Refusal::Unsupported`] for a category that the model description does not list.
    fn set_logging(&mut self, is_on: bool, categories: &[&CStr]) -> Result<(), Refusal> {
        let is_known = |category: &&CStr| CATEGORIES.iter().any(|(name, _)| category.to_bytes() == name.as_bytes());
        if !categories.iter().all(is_known) {
            return Err(Refusal::Unsupported { why: "the model description does not list this category" });
        }
        let is_chosen =
            |name: &str| categories.is_empty() || categories.iter().any(|one| one.to_bytes() == name.as_bytes());
        self.logged = is_on && CATEGORIES.iter().all(|(name, _)| is_chosen(name));
        Ok(())
    }

    fn say(&self, outcome: Outcome, message: &str) {
        say(&*self.log, self.logged, outcome, message);
    }

    fn serialize(&self, state: &State) -> Vec<u8> {
        serialized::write(state, &self.token)
    }

    fn deserialize(&self, bytes: &[u8]) -> Result<State, Refusal> {
        serialized::read(bytes, self.instance.model(), &self.token)
    }
}

fn say(log: &dyn Log, logged: bool, outcome: Outcome, message: &str) {
    if logged
        && let (Ok(category), Ok(message)) = (CString::new(CATEGORIES[0].0), CString::new(message.replace('\0', " ")))
    {
        log.say(outcome, &category, &message);
    }
}

/// Message of a panic.
fn words_of(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    format!("a defect of the FMU: {}", text.unwrap_or("a panic without a message"))
}

/// Executes `body`, a call of `function` on the instance at `pointer`. After an error the instance only allows reset, a saved state,
/// or its end.
///
/// # Safety
/// `pointer` is NULL, or was returned by [`give`] and not freed since; no other caller uses it at the same time.
unsafe fn call(pointer: *mut c_void, function: &str, body: impl FnOnce(&mut Handle) -> Result<(), Refusal>) -> Outcome {
    // SAFETY: as required by this function.
    let Some(handle) = (unsafe { pointer.cast::<Handle>().as_mut() }) else { return Outcome::Error };
    let message = match catch_unwind(AssertUnwindSafe(|| body(handle))) {
        Ok(Ok(())) => return Outcome::Ok,
        Ok(Err(refusal)) => refusal.to_string(),
        Err(panic) => words_of(&*panic),
    };
    handle.instance.fail();
    handle.say(Outcome::Error, &format!("{function}: {message}"));
    Outcome::Error
}

/// Creates an instance from `place`: the folder of the resources and the token. Returns NULL and logs a message if that fails.
fn give(function: &str, log: Box<dyn Log>, logged: bool, place: Result<(PathBuf, String), String>) -> *mut c_void {
    let made = catch_unwind(|| {
        let (folder, token) = place?;
        let files = Resources::read(&folder)?;
        let own = files.token();
        if own != token {
            return Err(format!("the model description has the token `{token}`, library and resources have `{own}`"));
        }
        Ok((files.model(&folder)?, own))
    });
    let why = match made {
        Ok(Ok((model, token))) => {
            let instance = Instance::new(Arc::new(model));
            return Box::into_raw(Box::new(Handle { instance, token, log, logged })).cast();
        }
        Ok(Err(why)) => why,
        Err(panic) => words_of(&*panic),
    };
    say(&*log, logged, Outcome::Error, &format!("{function}: {why}"));
    std::ptr::null_mut()
}

/// Ends the instance at `pointer`.
///
/// # Safety
/// As for [`call`]; the pointer must not be used any more.
unsafe fn take(pointer: *mut c_void) {
    if !pointer.is_null() {
        // SAFETY: as required by this function: it came from `Box::into_raw` in `give`.
        let handle = unsafe { Box::from_raw(pointer.cast::<Handle>()) };
        // A panic of a destructor must not leave, either.
        drop(catch_unwind(AssertUnwindSafe(move || drop(handle))));
    }
}

/// `length` values at `pointer`.
///
/// # Safety
/// `pointer` is NULL, or points to `length` values that nobody writes while they are used.
unsafe fn slice<'a, T>(pointer: *const T, length: usize, argument: &'static str) -> Result<&'a [T], Refusal> {
    match (pointer.is_null(), length) {
        (_, 0) => Ok(&[]),
        (true, _) => Err(Refusal::Null { argument }),
        // SAFETY: as required by this function.
        (false, _) => Ok(unsafe { std::slice::from_raw_parts(pointer, length) }),
    }
}

/// Writes `value` to `pointer`.
///
/// # Safety
/// `pointer` is NULL or may be written to.
unsafe fn put<T>(pointer: *mut T, value: T, argument: &'static str) -> Result<(), Refusal> {
    if pointer.is_null() {
        return Err(Refusal::Null { argument });
    }
    // SAFETY: as required by this function.
    unsafe { pointer.write(value) };
    Ok(())
}

/// The text at `pointer`.
///
/// # Safety
/// `pointer` is NULL or points to a text that ends with a zero byte.
unsafe fn text<'a>(pointer: *const c_char, argument: &'static str) -> Result<&'a CStr, Refusal> {
    if pointer.is_null() {
        return Err(Refusal::Null { argument });
    }
    // SAFETY: as required by this function.
    Ok(unsafe { CStr::from_ptr(pointer) })
}

/// The texts at `pointer`.
///
/// # Safety
/// As for [`slice`] and [`text`].
unsafe fn texts<'a>(pointer: *const *const c_char, count: usize) -> Result<Vec<&'a CStr>, Refusal> {
    // SAFETY: as required by this function.
    let all = unsafe { slice(pointer, count, "categories")? };
    // SAFETY: the same.
    all.iter().map(|one| unsafe { text(*one, "categories") }).collect()
}

/// Saves the state of `handle` to `state`, replacing the one there.
///
/// # Safety
/// `state` may be written to; it holds NULL or a state returned by this library.
unsafe fn save(handle: &mut Handle, state: *mut *mut c_void) -> Result<(), Refusal> {
    // SAFETY: as required by this function.
    let Some(place) = (unsafe { state.as_mut() }) else { return Err(Refusal::Null { argument: "FMUState" }) };
    let saved = handle.instance.save()?;
    // SAFETY: the same: it came from `Box::into_raw` here or in `keep`.
    match unsafe { place.cast::<State>().as_mut() } {
        Some(old) => *old = saved,
        None => *place = Box::into_raw(Box::new(saved)).cast(),
    }
    Ok(())
}

/// Hands `state` over to the host.
///
/// # Safety
/// `place` may be written to.
unsafe fn keep(state: State, place: *mut *mut c_void) -> Result<(), Refusal> {
    // SAFETY: as required by this function.
    unsafe { put(place, Box::into_raw(Box::new(state)).cast(), "FMUState") }
}

/// The state at `pointer`.
///
/// # Safety
/// `pointer` is NULL, or a state returned by this library and not freed since.
unsafe fn state<'a>(pointer: *mut c_void) -> Result<&'a State, Refusal> {
    // SAFETY: as required by this function.
    unsafe { pointer.cast::<State>().as_ref() }.ok_or(Refusal::Null { argument: "FMUState" })
}

/// Frees the state at `place` and sets it to NULL.
///
/// # Safety
/// `place` is NULL, or may be written to and holds NULL or a state returned by this library.
unsafe fn free_state(place: *mut *mut c_void) {
    // SAFETY: as required by this function.
    if let Some(place) = unsafe { place.as_mut() }
        && !place.is_null()
    {
        // SAFETY: the same: it came from `Box::into_raw`.
        drop(unsafe { Box::from_raw(place.cast::<State>()) });
        *place = std::ptr::null_mut();
    }
}

/// Copies the bytes of a state to the host's buffer.
///
/// # Safety
/// `to` has room for `size` bytes.
unsafe fn copy_bytes(bytes: &[u8], to: *mut u8, size: usize) -> Result<(), Refusal> {
    if size < bytes.len() {
        return Err(Refusal::Size { given: size, wanted: bytes.len() });
    }
    if to.is_null() {
        return Err(Refusal::Null { argument: "serializedState" });
    }
    // SAFETY: as required by this function; the bytes are our own, so they do not overlap.
    unsafe { to.copy_from_nonoverlapping(bytes.as_ptr(), bytes.len()) };
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::host::Room;
    use super::*;
    use crate::part::Part;

    struct Nothing;

    impl Log for Nothing {
        fn say(&self, _: Outcome, _: &CStr, message: &CStr) {
            assert_eq!(message.to_str(), Ok("fmi2DoStep: a defect of the FMU: boom"));
        }
    }

    #[test]
    fn a_panic_is_an_error_and_stays_inside() {
        let room = Room::new(Part::Axis);
        let place = Ok((room.folder().to_owned(), room.token.to_str().unwrap().to_owned()));
        let handle = give("fmi2Instantiate", Box::new(Nothing), true, place);
        assert!(!handle.is_null());
        // SAFETY: the handle is the one above.
        unsafe {
            assert_eq!(call(handle, "fmi2DoStep", |_| panic!("boom")), Outcome::Error);
            let reset = |handle: &mut Handle| {
                handle.instance.reset();
                Ok(())
            };
            assert_eq!(call(handle, "fmi2Reset", reset), Outcome::Ok);
            take(handle);
        }
    }

    #[test]
    fn nothing_is_no_instance() {
        // SAFETY: NULL is allowed.
        unsafe {
            assert_eq!(call(std::ptr::null_mut(), "fmi2Reset", |_| Ok(())), Outcome::Error);
            take(std::ptr::null_mut());
        }
    }
}
