//! Callbacks of an FMU: its log, and C's memory.
#![expect(unsafe_code, reason = "the FMU calls these with pointers of its own")]
use crate::abi::{v2, v3};
use crate::log::{Clock, Log};
use std::ffi::{CStr, c_char, c_int};
use std::ptr;

/// Data passed back by the FMU with each callback. The C part of the logger knows the first field.
#[repr(C)]
pub(super) struct Environment {
    hand_over: unsafe extern "C" fn(*const Self, c_int, *const c_char, *const c_char),
    log: Log,
}

impl Environment {
    pub(super) fn new(clock: Clock) -> Self {
        Self { hand_over: take, log: Log::new(clock) }
    }

    pub(super) fn log(&self) -> &Log {
        &self.log
    }
}

unsafe extern "C" {
    /// `logger.c`: formats a message with its arguments and calls `hand_over`.
    fn servobench_fmi2_logger(
        environment: v2::ComponentEnvironment,
        instance_name: v2::Text,
        status: v2::Status,
        category: v2::Text,
        message: v2::Text,
        ...
    );
}

/// The callbacks of FMI 2.0. `environment` has to live as long as the instance that uses them.
pub(super) fn of_two(environment: *const Environment) -> v2::CallbackFunctions {
    v2::CallbackFunctions {
        logger: Some(servobench_fmi2_logger),
        allocate_memory: Some(libc::calloc),
        free_memory: Some(libc::free),
        step_finished: None,
        component_environment: environment.cast_mut().cast(),
    }
}

/// The logger of FMI 3.0.
pub(super) unsafe extern "C" fn log_three(
    environment: v3::InstanceEnvironment,
    status: v3::Status,
    category: v3::Text,
    message: v3::Text,
) {
    // SAFETY: the FMU passes back the pointer that it was instantiated with, and texts that live during the call.
    unsafe { take(environment.cast_const().cast(), status.0, category, message) }
}

/// # Safety
/// `environment` is NULL or lives; the texts are NULL or end with a zero byte.
unsafe extern "C" fn take(
    environment: *const Environment,
    status: c_int,
    category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: see above; an environment is only ever shared.
    let Some(environment) = (unsafe { environment.as_ref() }) else { return };
    // SAFETY: see above.
    let (category, message) = unsafe { (text(&category), text(&message)) };
    environment.log.push(status, &category, &message);
}

/// # Safety
/// The text is NULL, which counts as empty, or ends with a zero byte.
unsafe fn text(text: &*const c_char) -> std::borrow::Cow<'_, str> {
    if ptr::eq(*text, ptr::null()) {
        return "".into();
    }
    // SAFETY: the caller's.
    unsafe { CStr::from_ptr(*text) }.to_string_lossy()
}
