//! The functions of FMI 2.0.
#![expect(unsafe_code, reason = "functions that other programs call, with pointers of theirs")]

use super::{Log, Outcome, call, copy_bytes, free_state, give, keep, put, save, slice, state, take, text, texts};
use crate::error::Refusal;
use crate::instance::{Asked, Experiment};
use crate::interface::Kind;
use servobench_files::path_of_bytes;
use servobench_fmi::abi::v2::{
    self, Boolean, Component, FmuState, Integer, Real, Status, StatusKind, Text, ValueReference,
};
use std::ffi::{CStr, CString, c_char, c_void};
use std::path::PathBuf;

const fn name_of(kind: Kind) -> &'static str {
    match kind {
        Kind::Real => "Real",
        Kind::Integer => "Integer",
        Kind::Boolean => "Boolean",
        Kind::Enumeration(_) => "Enumeration",
        Kind::Text => "String",
    }
}

const REAL: Asked = Asked { name: "Real", takes: |kind| kind == Kind::Real, name_of };
const INTEGER: Asked =
    Asked { name: "Integer", takes: |kind| matches!(kind, Kind::Integer | Kind::Enumeration(_)), name_of };
const BOOLEAN: Asked = Asked { name: "Boolean", takes: |kind| kind == Kind::Boolean, name_of };
const STRING: Asked = Asked { name: "String", takes: |kind| kind == Kind::Text, name_of };

impl From<Outcome> for Status {
    fn from(outcome: Outcome) -> Self {
        Self(outcome as i32)
    }
}

/// The logger of the host.
struct Logger {
    function: Option<v2::CallbackLogger>,
    environment: v2::ComponentEnvironment,
    instance_name: CString,
}

impl Log for Logger {
    fn say(&self, outcome: Outcome, category: &CStr, message: &CStr) {
        let Some(function) = self.function else { return };
        // The message is a format of `printf`.
        let Ok(message) = CString::new(message.to_string_lossy().replace('%', "%%")) else { return };
        let (environment, name) = (self.environment, self.instance_name.as_ptr());
        // SAFETY: the host passed the function for this, and the texts live until it returns.
        unsafe { function(environment, name, outcome.into(), category.as_ptr(), message.as_ptr()) };
    }
}

/// The folder named by a URI of the scheme `file`, or by a path as some hosts pass it.
fn folder(uri: &CStr) -> Result<PathBuf, String> {
    let text = uri.to_bytes();
    let path = match text.strip_prefix(b"file:") {
        None => return Ok(path_of_bytes(text.to_vec())),
        Some(rest) => match rest.strip_prefix(b"//") {
            None => rest,
            Some(rest) => rest.strip_prefix(b"localhost").unwrap_or(rest),
        },
    };
    if !path.starts_with(b"/") {
        return Err(format!("`{}` is no location of a folder", uri.to_string_lossy()));
    }
    let (mut bytes, mut rest) = (Vec::with_capacity(path.len()), path);
    while let Some((first, after)) = rest.split_first() {
        let escaped = after.first_chunk::<2>().filter(|_| *first == b'%');
        let byte = escaped.and_then(|two| u8::from_str_radix(std::str::from_utf8(two).ok()?, 16).ok());
        bytes.push(byte.unwrap_or(*first));
        rest = if byte.is_some() { &after[2..] } else { after };
    }
    Ok(path_of_bytes(bytes))
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetTypesPlatform() -> Text {
    c"default".as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn fmi2GetVersion() -> Text {
    c"2.0".as_ptr()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2Instantiate(
    instance_name: Text,
    fmu_type: v2::Type,
    guid: Text,
    resource_location: Text,
    functions: *const v2::CallbackFunctions,
    _visible: Boolean,
    _logging_on: Boolean,
) -> Component {
    // SAFETY: the host passes its functions, and they stay (§2.1.5).
    let functions = unsafe { functions.as_ref() };
    let told = |pointer, argument| {
        // SAFETY: the host passes texts that end with a zero byte.
        unsafe { text(pointer, argument) }.map_err(|refusal| refusal.to_string())
    };
    let log = Logger {
        function: functions.and_then(|functions| functions.logger),
        environment: functions.map_or(std::ptr::null_mut(), |functions| functions.component_environment),
        instance_name: told(instance_name, "instanceName").map(CString::from).unwrap_or_default(),
    };
    let place = || {
        if fmu_type != v2::Type::CO_SIMULATION {
            return Err("this FMU is for co-simulation; it cannot be instantiated for model exchange".into());
        }
        let guid = told(guid, "fmuGUID")?.to_string_lossy().into_owned();
        Ok((folder(told(resource_location, "fmuResourceLocation")?)?, guid))
    };
    // Errors are logged in any case: `loggingOn` is about debugging.
    give("fmi2Instantiate", Box::new(log), true, place())
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2FreeInstance(c: Component) {
    // SAFETY: the host does not use it any more.
    unsafe { take(c) };
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetDebugLogging(c: Component, on: Boolean, count: usize, categories: *const Text) -> Status {
    let body = |handle: &mut super::Handle| {
        // SAFETY: the host passes this number of texts.
        handle.set_logging(on != v2::FALSE, &unsafe { texts(categories, count)? })
    };
    // SAFETY: the host passes the pointer from `fmi2Instantiate`.
    unsafe { call(c, "fmi2SetDebugLogging", body) }.into()
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetupExperiment(
    c: Component,
    _tolerance_defined: Boolean,
    _tolerance: Real,
    start: Real,
    stop_defined: Boolean,
    stop: Real,
) -> Status {
    let experiment = Experiment { start, stop: (stop_defined != v2::FALSE).then_some(stop) };
    // SAFETY: the host passes the pointer from `fmi2Instantiate`.
    unsafe { call(c, "fmi2SetupExperiment", |handle| handle.instance.set_experiment(experiment)) }.into()
}

/// Functions that change the state.
macro_rules! transitions {
    ($($name:ident = $body:expr;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(c: Component) -> Status {
            // SAFETY: the host passes the pointer from `fmi2Instantiate`.
            unsafe { call(c, stringify!($name), $body) }.into()
        }
        const _: v2::Transition = $name;
    )*};
}

transitions! {
    fmi2EnterInitializationMode = |handle| handle.instance.enter_initialization();
    fmi2ExitInitializationMode = |handle| handle.instance.exit_initialization();
    fmi2Terminate = |handle| handle.instance.terminate();
    fmi2Reset = |handle| { handle.instance.reset(); Ok(()) };
    fmi2CancelStep = |_| Err(Refusal::Unsupported { why: "steps do not run by themselves" });
}

/// Functions that read numbers, and functions that set them.
macro_rules! numbers {
    ($($get:ident $set:ident $number:ty, $asked:expr, $out:expr, $in:expr;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $get(c: Component, vr: *const ValueReference, nvr: usize, value: *mut $number) -> Status {
            let body = |handle: &mut super::Handle| {
                // SAFETY: the host passes an array of this length.
                for (at, reference) in unsafe { slice(vr, nvr, "vr")? }.iter().enumerate() {
                    let number = handle.instance.get(*reference, &$asked)?;
                    // SAFETY: the host has room for as many values, unless it is NULL, which `put` refuses.
                    unsafe { put(value.wrapping_add(if value.is_null() { 0 } else { at }), $out(number), "value")? };
                }
                Ok(())
            };
            // SAFETY: the host passes the pointer from `fmi2Instantiate`.
            unsafe { call(c, stringify!($get), body) }.into()
        }
        const _: v2::Get<$number> = $get;

        #[unsafe(no_mangle)]
        unsafe extern "C" fn $set(c: Component, vr: *const ValueReference, nvr: usize, value: *const $number) -> Status {
            let body = |handle: &mut super::Handle| {
                // SAFETY: the host passes arrays of these lengths.
                let (references, values) = unsafe { (slice(vr, nvr, "vr")?, slice(value, nvr, "value")?) };
                references.iter().zip(values).try_for_each(|(one, value)| handle.instance.set(*one, &$asked, $in(*value)))
            };
            // SAFETY: the host passes the pointer from `fmi2Instantiate`.
            unsafe { call(c, stringify!($set), body) }.into()
        }
        const _: v2::Set<$number> = $set;
    )*};
}

#[expect(clippy::cast_possible_truncation, reason = "kept in the range of its type")]
fn integer(number: f64) -> Integer {
    number as Integer
}

fn truth(value: Boolean) -> f64 {
    f64::from(value != v2::FALSE)
}

numbers! {
    fmi2GetReal fmi2SetReal Real, REAL, |number| number, |value| value;
    fmi2GetInteger fmi2SetInteger Integer, INTEGER, integer, f64::from;
    fmi2GetBoolean fmi2SetBoolean Boolean, BOOLEAN, integer, truth;
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetString(c: Component, vr: *const ValueReference, nvr: usize, value: *mut Text) -> Status {
    let body = |handle: &mut super::Handle| {
        // SAFETY: the host passes an array of this length.
        for (at, reference) in unsafe { slice(vr, nvr, "vr")? }.iter().enumerate() {
            let found = handle.instance.get_text(*reference, &STRING)?.as_ptr();
            // SAFETY: the host has room for as many values, unless it is NULL, which `put` refuses.
            unsafe { put(value.wrapping_add(if value.is_null() { 0 } else { at }), found, "value")? };
        }
        Ok(())
    };
    // SAFETY: the host passes the pointer from `fmi2Instantiate`.
    unsafe { call(c, "fmi2GetString", body) }.into()
}
const _: v2::Get<Text> = fmi2GetString;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetString(c: Component, vr: *const ValueReference, nvr: usize, _value: *const Text) -> Status {
    let body = |handle: &mut super::Handle| {
        // SAFETY: the host passes an array of this length.
        let references = unsafe { slice(vr, nvr, "vr")? };
        references.iter().try_for_each(|one| handle.instance.set(*one, &STRING, f64::NAN))
    };
    // SAFETY: the host passes the pointer from `fmi2Instantiate`.
    unsafe { call(c, "fmi2SetString", body) }.into()
}
const _: v2::Set<Text> = fmi2SetString;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetFMUstate(c: Component, place: *mut FmuState) -> Status {
    // SAFETY: the host passes the pointer from `fmi2Instantiate`, and NULL or a state of it to overwrite.
    unsafe { call(c, "fmi2GetFMUstate", |handle| save(handle, place)) }.into()
}
const _: v2::GetFmuState = fmi2GetFMUstate;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SetFMUstate(c: Component, saved: FmuState) -> Status {
    // SAFETY: the host passes the pointer from `fmi2Instantiate`, and a state returned by this library.
    unsafe { call(c, "fmi2SetFMUstate", |handle| handle.instance.restore(state(saved)?)) }.into()
}
const _: v2::SetFmuState = fmi2SetFMUstate;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2FreeFMUstate(c: Component, place: *mut FmuState) -> Status {
    let body = |_: &mut super::Handle| {
        // SAFETY: the host passes NULL or a state returned by this library.
        unsafe { free_state(place) };
        Ok(())
    };
    // SAFETY: the host passes the pointer from `fmi2Instantiate`.
    unsafe { call(c, "fmi2FreeFMUstate", body) }.into()
}
const _: v2::FreeFmuState = fmi2FreeFMUstate;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SerializedFMUstateSize(c: Component, saved: FmuState, size: *mut usize) -> Status {
    let body = |handle: &mut super::Handle| {
        // SAFETY: the host passes a state returned by this library, and room for the size.
        unsafe { put(size, handle.serialize(state(saved)?).len(), "size") }
    };
    // SAFETY: the host passes the pointer from `fmi2Instantiate`.
    unsafe { call(c, "fmi2SerializedFMUstateSize", body) }.into()
}
const _: v2::SerializedFmuStateSize = fmi2SerializedFMUstateSize;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2SerializeFMUstate(c: Component, saved: FmuState, to: *mut c_char, size: usize) -> Status {
    let body = |handle: &mut super::Handle| {
        // SAFETY: the host passes a state returned by this library, and room for this number of bytes.
        unsafe { copy_bytes(&handle.serialize(state(saved)?), to.cast(), size) }
    };
    // SAFETY: the host passes the pointer from `fmi2Instantiate`.
    unsafe { call(c, "fmi2SerializeFMUstate", body) }.into()
}
const _: v2::SerializeFmuState = fmi2SerializeFMUstate;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2DeSerializeFMUstate(
    c: Component,
    bytes: *const c_char,
    size: usize,
    place: *mut FmuState,
) -> Status {
    let body = |handle: &mut super::Handle| {
        // SAFETY: the host passes this number of bytes, and room for the state.
        unsafe { keep(handle.deserialize(slice(bytes.cast(), size, "serializedState")?)?, place) }
    };
    // SAFETY: the host passes the pointer from `fmi2Instantiate`.
    unsafe { call(c, "fmi2DeSerializeFMUstate", body) }.into()
}
const _: v2::DeSerializeFmuState = fmi2DeSerializeFMUstate;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2DoStep(c: Component, point: Real, length: Real, _no_set_state_prior: Boolean) -> Status {
    // SAFETY: the host passes the pointer from `fmi2Instantiate`.
    unsafe { call(c, "fmi2DoStep", |handle| handle.instance.step(point, length)) }.into()
}
const _: v2::DoStep = fmi2DoStep;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetRealStatus(c: Component, kind: StatusKind, value: *mut Real) -> Status {
    let body = |handle: &mut super::Handle| match kind {
        // SAFETY: the host has room for the value.
        StatusKind::LAST_SUCCESSFUL_TIME => unsafe { put(value, handle.instance.last_successful_time(), "value") },
        _ => Err(Refusal::Unsupported { why: "there is no such status of this type" }),
    };
    // SAFETY: the host passes the pointer from `fmi2Instantiate`.
    unsafe { call(c, "fmi2GetRealStatus", body) }.into()
}
const _: v2::GetStatus<Real> = fmi2GetRealStatus;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi2GetBooleanStatus(c: Component, kind: StatusKind, value: *mut Boolean) -> Status {
    let body = |_: &mut super::Handle| match kind {
        // SAFETY: the host has room for the value.
        StatusKind::TERMINATED => unsafe { put(value, v2::FALSE, "value") },
        _ => Err(Refusal::Unsupported { why: "there is no such status of this type" }),
    };
    // SAFETY: the host passes the pointer from `fmi2Instantiate`.
    unsafe { call(c, "fmi2GetBooleanStatus", body) }.into()
}
const _: v2::GetStatus<Boolean> = fmi2GetBooleanStatus;

/// Functions required by the standard for features that this FMU lacks.
macro_rules! unsupported {
    ($($name:ident($($argument:ident: $of:ty),*) $why:literal;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(c: Component, $($argument: $of),*) -> Status {
            let _unused = ($($argument,)*);
            // SAFETY: the host passes the pointer from `fmi2Instantiate`.
            unsafe { call(c, stringify!($name), |_| Err(Refusal::Unsupported { why: $why })) }.into()
        }
    )*};
}

unsupported! {
    fmi2GetStatus(kind: StatusKind, value: *mut Status) "steps do not run by themselves";
    fmi2GetIntegerStatus(kind: StatusKind, value: *mut Integer) "the standard has no such status";
    fmi2GetStringStatus(kind: StatusKind, value: *mut Text) "steps do not run by themselves";
    fmi2SetRealInputDerivatives(vr: *const ValueReference, nvr: usize, order: *const Integer, value: *const Real)
        "inputs are held (canInterpolateInputs = false)";
    fmi2GetRealOutputDerivatives(vr: *const ValueReference, nvr: usize, order: *const Integer, value: *mut Real)
        "there are no derivatives of outputs (maxOutputDerivativeOrder = 0)";
    fmi2GetDirectionalDerivative(
        unknown: *const ValueReference, n_unknown: usize, known: *const ValueReference, n_known: usize,
        dv_known: *const Real, dv_unknown: *mut Real
    ) "there are no directional derivatives (providesDirectionalDerivative = false)";
    fmi2EnterEventMode() "this FMU is for co-simulation";
    fmi2NewDiscreteStates(info: *mut c_void) "this FMU is for co-simulation";
    fmi2EnterContinuousTimeMode() "this FMU is for co-simulation";
    fmi2CompletedIntegratorStep(no_set_state: Boolean, event: *mut Boolean, terminate: *mut Boolean)
        "this FMU is for co-simulation";
    fmi2SetTime(time: Real) "this FMU is for co-simulation";
    fmi2SetContinuousStates(x: *const Real, nx: usize) "this FMU is for co-simulation";
    fmi2GetDerivatives(derivatives: *mut Real, nx: usize) "this FMU is for co-simulation";
    fmi2GetEventIndicators(indicators: *mut Real, ni: usize) "this FMU is for co-simulation";
    fmi2GetContinuousStates(x: *mut Real, nx: usize) "this FMU is for co-simulation";
    fmi2GetNominalsOfContinuousStates(x: *mut Real, nx: usize) "this FMU is for co-simulation";
}

const _: v2::GetTypesPlatform = fmi2GetTypesPlatform;
const _: v2::GetVersion = fmi2GetVersion;
const _: v2::Instantiate = fmi2Instantiate;
const _: v2::FreeInstance = fmi2FreeInstance;
const _: v2::SetDebugLogging = fmi2SetDebugLogging;
const _: v2::SetupExperiment = fmi2SetupExperiment;
const _: v2::GetStatus<Status> = fmi2GetStatus;
const _: v2::GetStatus<Integer> = fmi2GetIntegerStatus;
const _: v2::GetStatus<Text> = fmi2GetStringStatus;
const _: v2::SetRealInputDerivatives = fmi2SetRealInputDerivatives;
const _: v2::GetRealOutputDerivatives = fmi2GetRealOutputDerivatives;
const _: v2::GetDirectionalDerivative = fmi2GetDirectionalDerivative;

#[cfg(test)]
mod tests;
