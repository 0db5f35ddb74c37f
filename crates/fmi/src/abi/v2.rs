//! FMI 2.0: types (specification 2.0.5, section 2.1.2, platform `default`) and functions for co-simulation.
use std::ffi::{c_char, c_int, c_uint, c_void};

/// Answer of `fmi2GetTypesPlatform`.
pub const TYPES_PLATFORM: &str = "default";
/// Answer of `fmi2GetVersion`.
pub const VERSION: &str = "2.0";

/// `fmi2Component`: an instance of the FMU, opaque to the importer.
pub type Component = *mut c_void;
/// `fmi2ComponentEnvironment`: pointer that the importer gets back in its callbacks, opaque to the FMU.
pub type ComponentEnvironment = *mut c_void;
/// `fmi2FMUstate`: a saved state, opaque to the importer.
pub type FmuState = *mut c_void;
/// `fmi2ValueReference`: handle of a variable, unique within its base type only.
pub type ValueReference = c_uint;
/// `fmi2Real`.
pub type Real = f64;
/// `fmi2Integer`.
pub type Integer = c_int;
/// `fmi2Boolean`: [`TRUE`] or [`FALSE`].
pub type Boolean = c_int;
/// `fmi2Char`.
pub type Char = c_char;
/// `fmi2String`: UTF-8 that ends with a zero byte.
pub type Text = *const Char;
/// `fmi2Byte`.
pub type Byte = c_char;

/// `fmi2True`.
pub const TRUE: Boolean = 1;
/// `fmi2False`.
pub const FALSE: Boolean = 0;

/// `fmi2Status`: status returned by a function (section 2.1.3).
#[repr(transparent)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Status(pub c_int);

impl Status {
    /// All well.
    pub const OK: Self = Self(0);
    /// Done with a warning; the computation can continue.
    pub const WARNING: Self = Self(1);
    /// The call was not carried out, the FMU is as before it.
    pub const DISCARD: Self = Self(2);
    /// The instance cannot continue; it can be reset or freed, or set to a saved state.
    pub const ERROR: Self = Self(3);
    /// No instance of the FMU can continue.
    pub const FATAL: Self = Self(4);
    /// The step continues by itself (`canRunAsynchronuously`).
    pub const PENDING: Self = Self(5);

    /// Name in the standard; none for an unknown value.
    #[must_use]
    pub fn name(self) -> Option<&'static str> {
        let names = ["fmi2OK", "fmi2Warning", "fmi2Discard", "fmi2Error", "fmi2Fatal", "fmi2Pending"];
        usize::try_from(self.0).ok().and_then(|at| names.get(at).copied())
    }
}

/// `fmi2Type`: kind of an instance (section 2.1.5).
#[repr(transparent)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Type(pub c_int);

impl Type {
    /// Without a built-in solver.
    pub const MODEL_EXCHANGE: Self = Self(0);
    /// With one.
    pub const CO_SIMULATION: Self = Self(1);
}

/// `fmi2StatusKind`: a query about the last step (section 4.2.3).
#[repr(transparent)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct StatusKind(pub c_int);

impl StatusKind {
    /// State of a pending step ([`Status`]).
    pub const DO_STEP_STATUS: Self = Self(0);
    /// Reason why it is pending ([`Text`]).
    pub const PENDING_STATUS: Self = Self(1);
    /// Time that the discarded step reached ([`Real`], s).
    pub const LAST_SUCCESSFUL_TIME: Self = Self(2);
    /// True if the FMU wants the simulation to end ([`Boolean`]).
    pub const TERMINATED: Self = Self(3);
}

/// `fmi2CallbackLogger`: the message is a `printf` format, followed by its arguments.
pub type CallbackLogger = unsafe extern "C" fn(
    environment: ComponentEnvironment,
    instance_name: Text,
    status: Status,
    category: Text,
    message: Text,
    ...
);
/// `fmi2CallbackAllocateMemory`: zeroed memory for `nobj` objects of `size` bytes, NULL if there is none.
pub type CallbackAllocateMemory = unsafe extern "C" fn(nobj: usize, size: usize) -> *mut c_void;
/// `fmi2CallbackFreeMemory`: NULL is allowed.
pub type CallbackFreeMemory = unsafe extern "C" fn(obj: *mut c_void);
/// `fmi2StepFinished`: ends a step that was [`Status::PENDING`].
pub type StepFinished = unsafe extern "C" fn(environment: ComponentEnvironment, status: Status);

/// `fmi2CallbackFunctions`: callbacks of the importer, valid for the life of the instance (section 2.1.5).
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct CallbackFunctions {
    /// Logs a message.
    pub logger: Option<CallbackLogger>,
    /// Allocates memory.
    pub allocate_memory: Option<CallbackAllocateMemory>,
    /// Frees memory.
    pub free_memory: Option<CallbackFreeMemory>,
    /// Notified when a pending step has ended.
    pub step_finished: Option<StepFinished>,
    /// Comes back in every call of the others.
    pub component_environment: ComponentEnvironment,
}

/// `fmi2GetTypesPlatform`: [`TYPES_PLATFORM`] (section 2.1.4).
pub type GetTypesPlatform = unsafe extern "C" fn() -> Text;
/// `fmi2GetVersion`: [`VERSION`] (section 2.1.4).
pub type GetVersion = unsafe extern "C" fn() -> Text;
/// `fmi2SetDebugLogging`: no categories are all of them (section 2.1.5).
pub type SetDebugLogging =
    unsafe extern "C" fn(c: Component, logging_on: Boolean, n_categories: usize, categories: *const Text) -> Status;

/// `fmi2Instantiate`: NULL if it failed; the location of the resources is a URI (section 2.1.5).
pub type Instantiate = unsafe extern "C" fn(
    instance_name: Text,
    fmu_type: Type,
    fmu_guid: Text,
    fmu_resource_location: Text,
    functions: *const CallbackFunctions,
    visible: Boolean,
    logging_on: Boolean,
) -> Component;
/// `fmi2FreeInstance`: NULL is allowed (section 2.1.5).
pub type FreeInstance = unsafe extern "C" fn(c: Component);

/// `fmi2SetupExperiment`: times in seconds (section 2.1.6).
pub type SetupExperiment = unsafe extern "C" fn(
    c: Component,
    tolerance_defined: Boolean,
    tolerance: Real,
    start_time: Real,
    stop_time_defined: Boolean,
    stop_time: Real,
) -> Status;
/// `fmi2EnterInitializationMode`, `fmi2ExitInitializationMode`, `fmi2Terminate`, `fmi2Reset` (section 2.1.6) and
/// `fmi2CancelStep` (section 4.2.2).
pub type Transition = unsafe extern "C" fn(c: Component) -> Status;

/// `fmi2Get{Real, Integer, Boolean, String}` (section 2.1.7).
pub type Get<T> = unsafe extern "C" fn(c: Component, vr: *const ValueReference, nvr: usize, value: *mut T) -> Status;
/// `fmi2Set{Real, Integer, Boolean, String}` (section 2.1.7).
pub type Set<T> = unsafe extern "C" fn(c: Component, vr: *const ValueReference, nvr: usize, value: *const T) -> Status;

/// `fmi2GetFMUstate`: a new state for NULL, else the one given is written over (section 2.1.8).
pub type GetFmuState = unsafe extern "C" fn(c: Component, state: *mut FmuState) -> Status;
/// `fmi2SetFMUstate` (section 2.1.8).
pub type SetFmuState = unsafe extern "C" fn(c: Component, state: FmuState) -> Status;
/// `fmi2FreeFMUstate`: sets what it frees to NULL (section 2.1.8).
pub type FreeFmuState = unsafe extern "C" fn(c: Component, state: *mut FmuState) -> Status;
/// `fmi2SerializedFMUstateSize`: in bytes (section 2.1.8).
pub type SerializedFmuStateSize = unsafe extern "C" fn(c: Component, state: FmuState, size: *mut usize) -> Status;
/// `fmi2SerializeFMUstate` (section 2.1.8).
pub type SerializeFmuState =
    unsafe extern "C" fn(c: Component, state: FmuState, serialized: *mut Byte, size: usize) -> Status;
/// `fmi2DeSerializeFMUstate` (section 2.1.8).
pub type DeSerializeFmuState =
    unsafe extern "C" fn(c: Component, serialized: *const Byte, size: usize, state: *mut FmuState) -> Status;

/// `fmi2GetDirectionalDerivative` (section 2.1.9).
pub type GetDirectionalDerivative = unsafe extern "C" fn(
    c: Component,
    unknown: *const ValueReference,
    n_unknown: usize,
    known: *const ValueReference,
    n_known: usize,
    dv_known: *const Real,
    dv_unknown: *mut Real,
) -> Status;

/// `fmi2SetRealInputDerivatives`: orders from 1 (section 4.2.1).
pub type SetRealInputDerivatives = unsafe extern "C" fn(
    c: Component,
    vr: *const ValueReference,
    nvr: usize,
    order: *const Integer,
    value: *const Real,
) -> Status;
/// `fmi2GetRealOutputDerivatives`: orders from 1 (section 4.2.1).
pub type GetRealOutputDerivatives = unsafe extern "C" fn(
    c: Component,
    vr: *const ValueReference,
    nvr: usize,
    order: *const Integer,
    value: *mut Real,
) -> Status;
/// `fmi2DoStep`: times in seconds (section 4.2.2).
pub type DoStep = unsafe extern "C" fn(
    c: Component,
    current_communication_point: Real,
    communication_step_size: Real,
    no_set_fmu_state_prior_to_current_point: Boolean,
) -> Status;
/// `fmi2Get{, Real, Integer, Boolean, String}Status` (section 4.2.3).
pub type GetStatus<T> = unsafe extern "C" fn(c: Component, s: StatusKind, value: *mut T) -> Status;

#[cfg(test)]
mod tests {
    use super::*;

    /// `struct` of five pointers, as the header has it.
    #[test]
    fn the_callbacks_are_five_pointers() {
        assert_eq!(size_of::<CallbackFunctions>(), 5 * size_of::<*const ()>());
        assert_eq!(size_of::<Option<CallbackLogger>>(), size_of::<*const ()>());
    }

    #[test]
    fn a_status_of_nobody_has_no_name() {
        assert_eq!(Status::PENDING.name(), Some("fmi2Pending"));
        assert_eq!(Status(6).name(), None);
        assert_eq!(Status(-1).name(), None);
    }
}
