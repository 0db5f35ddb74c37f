//! FMI 3.0: types (specification 3.0.2, section 2.2, "Platform Dependent Definitions") and functions for co-simulation.
use std::ffi::{c_char, c_int, c_void};

/// Answer of `fmi3GetVersion`.
pub const VERSION: &str = "3.0";

/// `fmi3Instance`: an instance of the FMU, opaque to the importer.
pub type Instance = *mut c_void;
/// `fmi3InstanceEnvironment`: pointer that the importer gets back in its callbacks, opaque to the FMU.
pub type InstanceEnvironment = *mut c_void;
/// `fmi3FMUState`: a saved state, opaque to the importer.
pub type FmuState = *mut c_void;
/// `fmi3ValueReference`: handle of a variable, unique among all of the FMU.
pub type ValueReference = u32;
/// `fmi3Float32`.
pub type Float32 = f32;
/// `fmi3Float64`.
pub type Float64 = f64;
/// `fmi3Boolean`: [`FALSE`], or anything else. C's `bool` is a byte; Rust's does not allow all values that a foreign FMU may write.
pub type Boolean = u8;
/// `fmi3Char`.
pub type Char = c_char;
/// `fmi3String`: UTF-8 that ends with a zero byte.
pub type Text = *const Char;
/// `fmi3Byte`.
pub type Byte = u8;
/// `fmi3Binary`.
pub type Binary = *const Byte;
/// `fmi3Clock`: true if it ticks.
pub type Clock = Boolean;

/// `fmi3True`.
pub const TRUE: Boolean = 1;
/// `fmi3False`.
pub const FALSE: Boolean = 0;

/// `fmi3Status`: status returned by a function (section 2.2, "Status Returned by Functions").
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

    /// Name in the standard; none for an unknown value.
    #[must_use]
    pub fn name(self) -> Option<&'static str> {
        let names = ["fmi3OK", "fmi3Warning", "fmi3Discard", "fmi3Error", "fmi3Fatal"];
        usize::try_from(self.0).ok().and_then(|at| names.get(at).copied())
    }
}

/// `fmi3DependencyKind`: kind of dependency of an unknown on a known.
#[repr(transparent)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct DependencyKind(pub c_int);

impl DependencyKind {
    /// Not at all.
    pub const INDEPENDENT: Self = Self(0);
    /// Linearly, by a factor that never changes.
    pub const CONSTANT: Self = Self(1);
    /// Linearly, by a factor that is fixed after initialisation.
    pub const FIXED: Self = Self(2);
    /// Linearly, by a factor that changes with tunable parameters.
    pub const TUNABLE: Self = Self(3);
    /// Linearly, by a factor that changes at events.
    pub const DISCRETE: Self = Self(4);
    /// In any way.
    pub const DEPENDENT: Self = Self(5);
}

/// `fmi3IntervalQualifier`: state of a clock's interval.
#[repr(transparent)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct IntervalQualifier(pub c_int);

impl IntervalQualifier {
    /// Not known yet.
    pub const NOT_YET_KNOWN: Self = Self(0);
    /// Unchanged.
    pub const UNCHANGED: Self = Self(1);
    /// Changed.
    pub const CHANGED: Self = Self(2);
}

/// `fmi3LogMessageCallback`: the message is plain text.
pub type LogMessageCallback =
    unsafe extern "C" fn(environment: InstanceEnvironment, status: Status, category: Text, message: Text);
/// `fmi3IntermediateUpdateCallback`.
pub type IntermediateUpdateCallback = unsafe extern "C" fn(
    environment: InstanceEnvironment,
    intermediate_update_time: Float64,
    intermediate_variable_set_requested: Boolean,
    intermediate_variable_get_allowed: Boolean,
    intermediate_step_finished: Boolean,
    can_return_early: Boolean,
    early_return_requested: *mut Boolean,
    early_return_time: *mut Float64,
);
/// `fmi3ClockUpdateCallback`.
pub type ClockUpdateCallback = unsafe extern "C" fn(environment: InstanceEnvironment);
/// `fmi3LockPreemptionCallback` and `fmi3UnlockPreemptionCallback`.
pub type PreemptionCallback = unsafe extern "C" fn();

/// `fmi3GetVersion`: [`VERSION`], perhaps with a suffix.
pub type GetVersion = unsafe extern "C" fn() -> Text;
/// `fmi3SetDebugLogging`: zero categories stand for all of them.
pub type SetDebugLogging = unsafe extern "C" fn(
    instance: Instance,
    logging_on: Boolean,
    n_categories: usize,
    categories: *const Text,
) -> Status;

/// `fmi3InstantiateModelExchange`: NULL if it failed.
pub type InstantiateModelExchange = unsafe extern "C" fn(
    instance_name: Text,
    instantiation_token: Text,
    resource_path: Text,
    visible: Boolean,
    logging_on: Boolean,
    environment: InstanceEnvironment,
    log_message: Option<LogMessageCallback>,
) -> Instance;
/// `fmi3InstantiateCoSimulation`: NULL if it failed; the resource path is absolute and ends with a separator.
pub type InstantiateCoSimulation = unsafe extern "C" fn(
    instance_name: Text,
    instantiation_token: Text,
    resource_path: Text,
    visible: Boolean,
    logging_on: Boolean,
    event_mode_used: Boolean,
    early_return_allowed: Boolean,
    required_intermediate_variables: *const ValueReference,
    n_required_intermediate_variables: usize,
    environment: InstanceEnvironment,
    log_message: Option<LogMessageCallback>,
    intermediate_update: Option<IntermediateUpdateCallback>,
) -> Instance;
/// `fmi3InstantiateScheduledExecution`: NULL if it failed.
pub type InstantiateScheduledExecution = unsafe extern "C" fn(
    instance_name: Text,
    instantiation_token: Text,
    resource_path: Text,
    visible: Boolean,
    logging_on: Boolean,
    environment: InstanceEnvironment,
    log_message: Option<LogMessageCallback>,
    clock_update: Option<ClockUpdateCallback>,
    lock_preemption: Option<PreemptionCallback>,
    unlock_preemption: Option<PreemptionCallback>,
) -> Instance;
/// `fmi3FreeInstance`: NULL is allowed.
pub type FreeInstance = unsafe extern "C" fn(instance: Instance);

/// `fmi3EnterInitializationMode`: times in seconds.
pub type EnterInitializationMode = unsafe extern "C" fn(
    instance: Instance,
    tolerance_defined: Boolean,
    tolerance: Float64,
    start_time: Float64,
    stop_time_defined: Boolean,
    stop_time: Float64,
) -> Status;
/// `fmi3ExitInitializationMode`, `fmi3Enter{Event, Step, Configuration}Mode`, `fmi3ExitConfigurationMode`,
/// `fmi3EvaluateDiscreteStates`, `fmi3Terminate` and `fmi3Reset`.
pub type Transition = unsafe extern "C" fn(instance: Instance) -> Status;

/// `fmi3Get{Float32 … UInt64, Boolean, String}`: an array takes as many values as it has elements, in row-major order.
pub type Get<T> = unsafe extern "C" fn(
    instance: Instance,
    value_references: *const ValueReference,
    n_value_references: usize,
    values: *mut T,
    n_values: usize,
) -> Status;
/// `fmi3Set{Float32 … UInt64, Boolean, String}`.
pub type Set<T> = unsafe extern "C" fn(
    instance: Instance,
    value_references: *const ValueReference,
    n_value_references: usize,
    values: *const T,
    n_values: usize,
) -> Status;
/// `fmi3GetBinary`.
pub type GetBinary = unsafe extern "C" fn(
    instance: Instance,
    value_references: *const ValueReference,
    n_value_references: usize,
    value_sizes: *mut usize,
    values: *mut Binary,
    n_values: usize,
) -> Status;
/// `fmi3SetBinary`.
pub type SetBinary = unsafe extern "C" fn(
    instance: Instance,
    value_references: *const ValueReference,
    n_value_references: usize,
    value_sizes: *const usize,
    values: *const Binary,
    n_values: usize,
) -> Status;
/// `fmi3GetClock`.
pub type GetClock = unsafe extern "C" fn(
    instance: Instance,
    value_references: *const ValueReference,
    n_value_references: usize,
    values: *mut Clock,
) -> Status;
/// `fmi3SetClock`.
pub type SetClock = unsafe extern "C" fn(
    instance: Instance,
    value_references: *const ValueReference,
    n_value_references: usize,
    values: *const Clock,
) -> Status;

/// `fmi3GetNumberOfVariableDependencies`.
pub type GetNumberOfVariableDependencies =
    unsafe extern "C" fn(instance: Instance, value_reference: ValueReference, n_dependencies: *mut usize) -> Status;
/// `fmi3GetVariableDependencies`.
pub type GetVariableDependencies = unsafe extern "C" fn(
    instance: Instance,
    dependent: ValueReference,
    element_indices_of_dependent: *mut usize,
    independents: *mut ValueReference,
    element_indices_of_independents: *mut usize,
    dependency_kinds: *mut DependencyKind,
    n_dependencies: usize,
) -> Status;

/// `fmi3GetFMUState`: creates a state for NULL, otherwise overwrites the given one.
pub type GetFmuState = unsafe extern "C" fn(instance: Instance, state: *mut FmuState) -> Status;
/// `fmi3SetFMUState`.
pub type SetFmuState = unsafe extern "C" fn(instance: Instance, state: FmuState) -> Status;
/// `fmi3FreeFMUState`: sets what it frees to NULL.
pub type FreeFmuState = unsafe extern "C" fn(instance: Instance, state: *mut FmuState) -> Status;
/// `fmi3SerializedFMUStateSize`: in bytes.
pub type SerializedFmuStateSize = unsafe extern "C" fn(instance: Instance, state: FmuState, size: *mut usize) -> Status;
/// `fmi3SerializeFMUState`.
pub type SerializeFmuState =
    unsafe extern "C" fn(instance: Instance, state: FmuState, serialized: *mut Byte, size: usize) -> Status;
/// `fmi3DeserializeFMUState`.
pub type DeserializeFmuState =
    unsafe extern "C" fn(instance: Instance, serialized: *const Byte, size: usize, state: *mut FmuState) -> Status;

/// `fmi3GetDirectionalDerivative` and `fmi3GetAdjointDerivative`.
pub type GetDerivative = unsafe extern "C" fn(
    instance: Instance,
    unknowns: *const ValueReference,
    n_unknowns: usize,
    knowns: *const ValueReference,
    n_knowns: usize,
    seed: *const Float64,
    n_seed: usize,
    sensitivity: *mut Float64,
    n_sensitivity: usize,
) -> Status;

/// `fmi3GetIntervalDecimal`.
pub type GetIntervalDecimal = unsafe extern "C" fn(
    instance: Instance,
    value_references: *const ValueReference,
    n_value_references: usize,
    intervals: *mut Float64,
    qualifiers: *mut IntervalQualifier,
) -> Status;
/// `fmi3GetIntervalFraction`.
pub type GetIntervalFraction = unsafe extern "C" fn(
    instance: Instance,
    value_references: *const ValueReference,
    n_value_references: usize,
    counters: *mut u64,
    resolutions: *mut u64,
    qualifiers: *mut IntervalQualifier,
) -> Status;
/// `fmi3GetShiftDecimal`.
pub type GetShiftDecimal = unsafe extern "C" fn(
    instance: Instance,
    value_references: *const ValueReference,
    n_value_references: usize,
    shifts: *mut Float64,
) -> Status;
/// `fmi3GetShiftFraction`.
pub type GetShiftFraction = unsafe extern "C" fn(
    instance: Instance,
    value_references: *const ValueReference,
    n_value_references: usize,
    counters: *mut u64,
    resolutions: *mut u64,
) -> Status;
/// `fmi3SetIntervalDecimal` and `fmi3SetShiftDecimal`.
pub type SetClockDecimal = unsafe extern "C" fn(
    instance: Instance,
    value_references: *const ValueReference,
    n_value_references: usize,
    seconds: *const Float64,
) -> Status;
/// `fmi3SetIntervalFraction` and `fmi3SetShiftFraction`.
pub type SetClockFraction = unsafe extern "C" fn(
    instance: Instance,
    value_references: *const ValueReference,
    n_value_references: usize,
    counters: *const u64,
    resolutions: *const u64,
) -> Status;
/// `fmi3UpdateDiscreteStates` (section 2.3, "State: Event Mode").
pub type UpdateDiscreteStates = unsafe extern "C" fn(
    instance: Instance,
    discrete_states_need_update: *mut Boolean,
    terminate_simulation: *mut Boolean,
    nominals_of_continuous_states_changed: *mut Boolean,
    values_of_continuous_states_changed: *mut Boolean,
    next_event_time_defined: *mut Boolean,
    next_event_time: *mut Float64,
) -> Status;

/// `fmi3GetOutputDerivatives`: orders from 1 (section 4.2).
pub type GetOutputDerivatives = unsafe extern "C" fn(
    instance: Instance,
    value_references: *const ValueReference,
    n_value_references: usize,
    orders: *const i32,
    values: *mut Float64,
    n_values: usize,
) -> Status;
/// `fmi3DoStep`: times in seconds (section 4.2).
pub type DoStep = unsafe extern "C" fn(
    instance: Instance,
    current_communication_point: Float64,
    communication_step_size: Float64,
    no_set_fmu_state_prior_to_current_point: Boolean,
    event_handling_needed: *mut Boolean,
    terminate_simulation: *mut Boolean,
    early_return: *mut Boolean,
    last_successful_time: *mut Float64,
) -> Status;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_status_of_nobody_has_no_name() {
        assert_eq!(Status::FATAL.name(), Some("fmi3Fatal"));
        assert_eq!(Status(5).name(), None);
        assert_eq!(Status(-1).name(), None);
    }
}
