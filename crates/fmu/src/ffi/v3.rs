//! The functions of FMI 3.0.
#![expect(unsafe_code, reason = "functions that other programs call, with pointers of theirs")]

mod absent;

use super::{Log, Outcome, call, copy_bytes, free_state, give, keep, put, save, slice, state, take, text, texts};
use crate::error::Refusal;
use crate::instance::{Asked, Experiment};
use crate::interface::Kind;
use servobench_files::path_of_bytes;
use servobench_fmi::abi::v3::{
    self, Boolean, Byte, Float32, Float64, FmuState, Instance, InstanceEnvironment, Status, Text, ValueReference,
};
use std::ffi::CStr;

const fn name_of(kind: Kind) -> &'static str {
    match kind {
        Kind::Real => "Float64",
        Kind::Integer => "Int32",
        Kind::Boolean => "Boolean",
        Kind::Enumeration(_) => "Enumeration (Int64)",
        Kind::Text => "String",
    }
}

const FLOAT64: Asked = Asked { name: "Float64", takes: |kind| kind == Kind::Real, name_of };
const INT32: Asked = Asked { name: "Int32", takes: |kind| kind == Kind::Integer, name_of };
const INT64: Asked = Asked { name: "Int64", takes: |kind| matches!(kind, Kind::Enumeration(_)), name_of };
const BOOLEAN: Asked = Asked { name: "Boolean", takes: |kind| kind == Kind::Boolean, name_of };
const STRING: Asked = Asked { name: "String", takes: |kind| kind == Kind::Text, name_of };

/// A type that no variable has.
const fn absent(name: &'static str) -> Asked {
    Asked { name, takes: |_| false, name_of }
}

impl From<Outcome> for Status {
    fn from(outcome: Outcome) -> Self {
        Self(outcome as i32)
    }
}

/// The logger of the host.
struct Logger {
    function: Option<v3::LogMessageCallback>,
    environment: InstanceEnvironment,
}

impl Log for Logger {
    fn say(&self, outcome: Outcome, category: &CStr, message: &CStr) {
        if let Some(function) = self.function {
            // SAFETY: the host passed the function for this, and the texts live until it returns.
            unsafe { function(self.environment, outcome.into(), category.as_ptr(), message.as_ptr()) };
        }
    }
}

#[unsafe(no_mangle)]
extern "C" fn fmi3GetVersion() -> Text {
    c"3.0".as_ptr()
}
const _: v3::GetVersion = fmi3GetVersion;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateCoSimulation(
    _instance_name: Text,
    token: Text,
    resource_path: Text,
    _visible: Boolean,
    _logging_on: Boolean,
    _event_mode_used: Boolean,
    _early_return_allowed: Boolean,
    _intermediate: *const ValueReference,
    n_intermediate: usize,
    environment: InstanceEnvironment,
    log_message: Option<v3::LogMessageCallback>,
    _intermediate_update: Option<v3::IntermediateUpdateCallback>,
) -> Instance {
    let told = |pointer, argument| {
        // SAFETY: the host passes texts that end with a zero byte.
        unsafe { text(pointer, argument) }.map_err(|refusal| refusal.to_string())
    };
    let place = || {
        if n_intermediate > 0 {
            return Err("there is no intermediate update (providesIntermediateUpdate = false)".into());
        }
        let folder = path_of_bytes(told(resource_path, "resourcePath")?.to_bytes().to_vec());
        Ok((folder, told(token, "instantiationToken")?.to_string_lossy().into_owned()))
    };
    let log = Logger { function: log_message, environment };
    // Errors are logged in any case: `loggingOn` is about debugging.
    give("fmi3InstantiateCoSimulation", Box::new(log), true, place())
}
const _: v3::InstantiateCoSimulation = fmi3InstantiateCoSimulation;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateModelExchange(
    _instance_name: Text,
    _token: Text,
    _resource_path: Text,
    _visible: Boolean,
    _logging_on: Boolean,
    environment: InstanceEnvironment,
    log_message: Option<v3::LogMessageCallback>,
) -> Instance {
    let why = "this FMU is for co-simulation; it cannot be instantiated for model exchange".into();
    give("fmi3InstantiateModelExchange", Box::new(Logger { function: log_message, environment }), true, Err(why))
}
const _: v3::InstantiateModelExchange = fmi3InstantiateModelExchange;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3InstantiateScheduledExecution(
    _instance_name: Text,
    _token: Text,
    _resource_path: Text,
    _visible: Boolean,
    _logging_on: Boolean,
    environment: InstanceEnvironment,
    log_message: Option<v3::LogMessageCallback>,
    _clock_update: Option<v3::ClockUpdateCallback>,
    _lock_preemption: Option<v3::PreemptionCallback>,
    _unlock_preemption: Option<v3::PreemptionCallback>,
) -> Instance {
    let why = "this FMU is for co-simulation; it cannot be instantiated for scheduled execution".into();
    let log = Logger { function: log_message, environment };
    give("fmi3InstantiateScheduledExecution", Box::new(log), true, Err(why))
}
const _: v3::InstantiateScheduledExecution = fmi3InstantiateScheduledExecution;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3FreeInstance(instance: Instance) {
    // SAFETY: the host does not use it any more.
    unsafe { take(instance) };
}
const _: v3::FreeInstance = fmi3FreeInstance;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetDebugLogging(
    instance: Instance,
    on: Boolean,
    count: usize,
    categories: *const Text,
) -> Status {
    let body = |handle: &mut super::Handle| {
        // SAFETY: the host passes this number of texts.
        handle.set_logging(on != v3::FALSE, &unsafe { texts(categories, count)? })
    };
    // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`.
    unsafe { call(instance, "fmi3SetDebugLogging", body) }.into()
}
const _: v3::SetDebugLogging = fmi3SetDebugLogging;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3EnterInitializationMode(
    instance: Instance,
    _tolerance_defined: Boolean,
    _tolerance: Float64,
    start: Float64,
    stop_defined: Boolean,
    stop: Float64,
) -> Status {
    let body = |handle: &mut super::Handle| {
        let stop = (stop_defined != v3::FALSE).then_some(stop);
        handle.instance.set_experiment(Experiment { start, stop })?;
        handle.instance.enter_initialization()
    };
    // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`.
    unsafe { call(instance, "fmi3EnterInitializationMode", body) }.into()
}
const _: v3::EnterInitializationMode = fmi3EnterInitializationMode;

/// Functions that change the state.
macro_rules! transitions {
    ($($name:ident = $body:expr;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(instance: Instance) -> Status {
            // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`.
            unsafe { call(instance, stringify!($name), $body) }.into()
        }
        const _: v3::Transition = $name;
    )*};
}

transitions! {
    fmi3ExitInitializationMode = |handle| handle.instance.exit_initialization();
    fmi3Terminate = |handle| handle.instance.terminate();
    fmi3Reset = |handle| { handle.instance.reset(); Ok(()) };
    fmi3EnterEventMode = |_| Err(Refusal::Unsupported { why: "there is no event mode (hasEventMode = false)" });
    fmi3EnterStepMode = |_| Err(Refusal::Unsupported { why: "there is no event mode (hasEventMode = false)" });
    fmi3EvaluateDiscreteStates = |_| Err(Refusal::Unsupported { why: "there is no event mode (hasEventMode = false)" });
    fmi3EnterConfigurationMode = |_| Err(Refusal::Unsupported { why: "there are no structural parameters" });
    fmi3ExitConfigurationMode = |_| Err(Refusal::Unsupported { why: "there are no structural parameters" });
    fmi3EnterContinuousTimeMode = |_| Err(Refusal::Unsupported { why: "this FMU is for co-simulation" });
}

/// Checks for as many values as references: all variables are scalars.
fn same_length(references: usize, values: usize) -> Result<(), Refusal> {
    if references == values { Ok(()) } else { Err(Refusal::Length { given: values, wanted: references }) }
}

/// Functions that read numbers, and functions that set them.
macro_rules! numbers {
    ($($get:ident $set:ident $number:ty, $asked:expr, $out:expr, $in:expr;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $get(
            instance: Instance, vr: *const ValueReference, nvr: usize, values: *mut $number, n_values: usize,
        ) -> Status {
            let body = |handle: &mut super::Handle| {
                same_length(nvr, n_values)?;
                // SAFETY: the host passes an array of this length.
                for (at, reference) in unsafe { slice(vr, nvr, "valueReferences")? }.iter().enumerate() {
                    let number = handle.instance.get(*reference, &$asked)?;
                    // SAFETY: the host has room for as many values, unless it is NULL, which `put` refuses.
                    unsafe { put(values.wrapping_add(if values.is_null() { 0 } else { at }), $out(number), "values")? };
                }
                Ok(())
            };
            // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`.
            unsafe { call(instance, stringify!($get), body) }.into()
        }
        const _: v3::Get<$number> = $get;

        #[unsafe(no_mangle)]
        unsafe extern "C" fn $set(
            instance: Instance, vr: *const ValueReference, nvr: usize, values: *const $number, n_values: usize,
        ) -> Status {
            let body = |handle: &mut super::Handle| {
                same_length(nvr, n_values)?;
                // SAFETY: the host passes arrays of these lengths.
                let (references, values) =
                    unsafe { (slice(vr, nvr, "valueReferences")?, slice(values, n_values, "values")?) };
                references.iter().zip(values).try_for_each(|(one, value)| handle.instance.set(*one, &$asked, $in(*value)))
            };
            // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`.
            unsafe { call(instance, stringify!($set), body) }.into()
        }
        const _: v3::Set<$number> = $set;
    )*};
}

#[expect(clippy::cast_possible_truncation, reason = "kept in the range of its type")]
fn int32(number: f64) -> i32 {
    number as i32
}

#[expect(clippy::cast_possible_truncation, reason = "an item of an enumeration")]
fn int64(number: f64) -> i64 {
    number as i64
}

fn boolean(number: f64) -> Boolean {
    if number == 0.0 { v3::FALSE } else { v3::TRUE }
}

fn truth(value: Boolean) -> f64 {
    f64::from(u8::from(value != v3::FALSE))
}

numbers! {
    fmi3GetFloat64 fmi3SetFloat64 Float64, FLOAT64, |number| number, |value| value;
    fmi3GetInt32 fmi3SetInt32 i32, INT32, int32, f64::from;
    fmi3GetInt64 fmi3SetInt64 i64, INT64, int64, |value: i64| value as f64;
    fmi3GetBoolean fmi3SetBoolean Boolean, BOOLEAN, boolean, truth;
    fmi3GetFloat32 fmi3SetFloat32 Float32, absent("Float32"), |_| 0.0, |_| 0.0;
    fmi3GetInt8 fmi3SetInt8 i8, absent("Int8"), |_| 0, |_| 0.0;
    fmi3GetUInt8 fmi3SetUInt8 u8, absent("UInt8"), |_| 0, |_| 0.0;
    fmi3GetInt16 fmi3SetInt16 i16, absent("Int16"), |_| 0, |_| 0.0;
    fmi3GetUInt16 fmi3SetUInt16 u16, absent("UInt16"), |_| 0, |_| 0.0;
    fmi3GetUInt32 fmi3SetUInt32 u32, absent("UInt32"), |_| 0, |_| 0.0;
    fmi3GetUInt64 fmi3SetUInt64 u64, absent("UInt64"), |_| 0, |_| 0.0;
}

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetString(
    instance: Instance,
    vr: *const ValueReference,
    nvr: usize,
    values: *mut Text,
    n_values: usize,
) -> Status {
    let body = |handle: &mut super::Handle| {
        same_length(nvr, n_values)?;
        // SAFETY: the host passes an array of this length.
        for (at, reference) in unsafe { slice(vr, nvr, "valueReferences")? }.iter().enumerate() {
            let found = handle.instance.get_text(*reference, &STRING)?.as_ptr();
            // SAFETY: the host has room for as many values, unless it is NULL, which `put` refuses.
            unsafe { put(values.wrapping_add(if values.is_null() { 0 } else { at }), found, "values")? };
        }
        Ok(())
    };
    // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`.
    unsafe { call(instance, "fmi3GetString", body) }.into()
}
const _: v3::Get<Text> = fmi3GetString;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetString(
    instance: Instance,
    vr: *const ValueReference,
    nvr: usize,
    _values: *const Text,
    n_values: usize,
) -> Status {
    let body = |handle: &mut super::Handle| {
        same_length(nvr, n_values)?;
        // SAFETY: the host passes an array of this length.
        let references = unsafe { slice(vr, nvr, "valueReferences")? };
        references.iter().try_for_each(|one| handle.instance.set(*one, &STRING, f64::NAN))
    };
    // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`.
    unsafe { call(instance, "fmi3SetString", body) }.into()
}
const _: v3::Set<Text> = fmi3SetString;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3GetFMUState(instance: Instance, place: *mut FmuState) -> Status {
    // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`, and NULL or a state of it to overwrite.
    unsafe { call(instance, "fmi3GetFMUState", |handle| save(handle, place)) }.into()
}
const _: v3::GetFmuState = fmi3GetFMUState;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SetFMUState(instance: Instance, saved: FmuState) -> Status {
    // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`, and a state returned by this library.
    unsafe { call(instance, "fmi3SetFMUState", |handle| handle.instance.restore(state(saved)?)) }.into()
}
const _: v3::SetFmuState = fmi3SetFMUState;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3FreeFMUState(instance: Instance, place: *mut FmuState) -> Status {
    let body = |_: &mut super::Handle| {
        // SAFETY: the host passes NULL or a state returned by this library.
        unsafe { free_state(place) };
        Ok(())
    };
    // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`.
    unsafe { call(instance, "fmi3FreeFMUState", body) }.into()
}
const _: v3::FreeFmuState = fmi3FreeFMUState;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SerializedFMUStateSize(instance: Instance, saved: FmuState, size: *mut usize) -> Status {
    let body = |handle: &mut super::Handle| {
        // SAFETY: the host passes a state returned by this library, and room for the size.
        unsafe { put(size, handle.serialize(state(saved)?).len(), "size") }
    };
    // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`.
    unsafe { call(instance, "fmi3SerializedFMUStateSize", body) }.into()
}
const _: v3::SerializedFmuStateSize = fmi3SerializedFMUStateSize;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3SerializeFMUState(instance: Instance, saved: FmuState, to: *mut Byte, size: usize) -> Status {
    let body = |handle: &mut super::Handle| {
        // SAFETY: the host passes a state returned by this library, and room for this number of bytes.
        unsafe { copy_bytes(&handle.serialize(state(saved)?), to, size) }
    };
    // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`.
    unsafe { call(instance, "fmi3SerializeFMUState", body) }.into()
}
const _: v3::SerializeFmuState = fmi3SerializeFMUState;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: Instance,
    bytes: *const Byte,
    size: usize,
    place: *mut FmuState,
) -> Status {
    let body = |handle: &mut super::Handle| {
        // SAFETY: the host passes this number of bytes, and room for the state.
        unsafe { keep(handle.deserialize(slice(bytes, size, "serializedState")?)?, place) }
    };
    // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`.
    unsafe { call(instance, "fmi3DeserializeFMUState", body) }.into()
}
const _: v3::DeserializeFmuState = fmi3DeserializeFMUState;

#[unsafe(no_mangle)]
unsafe extern "C" fn fmi3DoStep(
    instance: Instance,
    point: Float64,
    length: Float64,
    _no_set_state_prior: Boolean,
    event_handling_needed: *mut Boolean,
    terminate_simulation: *mut Boolean,
    early_return: *mut Boolean,
    last_successful_time: *mut Float64,
) -> Status {
    let body = |handle: &mut super::Handle| {
        let done = handle.instance.step(point, length);
        for flag in [event_handling_needed, terminate_simulation, early_return] {
            // SAFETY: the host has room for the flags.
            unsafe { put(flag, v3::FALSE, "eventHandlingNeeded, terminateSimulation or earlyReturn")? };
        }
        // SAFETY: the host has room for the time.
        unsafe { put(last_successful_time, handle.instance.last_successful_time(), "lastSuccessfulTime")? };
        done
    };
    // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`.
    unsafe { call(instance, "fmi3DoStep", body) }.into()
}
const _: v3::DoStep = fmi3DoStep;

#[cfg(test)]
mod tests;
