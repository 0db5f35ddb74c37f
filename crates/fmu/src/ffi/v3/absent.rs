//! Functions of FMI 3.0 required by the standard for features that this FMU lacks.
#![expect(unsafe_code, reason = "functions that other programs call, with pointers of theirs")]

use crate::error::Refusal;
use crate::ffi::call;
use servobench_fmi::abi::v3::{
    self, Binary, Boolean, Clock, DependencyKind, Float64, Instance, IntervalQualifier, Status, ValueReference,
};

/// Functions that refuse, with their reasons.
macro_rules! unsupported {
    ($($name:ident($($argument:ident: $of:ty),*) $why:literal;)*) => {$(
        #[unsafe(no_mangle)]
        unsafe extern "C" fn $name(instance: Instance, $($argument: $of),*) -> Status {
            let _unused = ($($argument,)*);
            // SAFETY: the host passes the pointer from `fmi3InstantiateCoSimulation`.
            unsafe { call(instance, stringify!($name), |_| Err(Refusal::Unsupported { why: $why })) }.into()
        }
    )*};
}

type References = *const ValueReference;

unsupported! {
    fmi3GetBinary(vr: References, nvr: usize, sizes: *mut usize, values: *mut Binary, n: usize) "no variable is a Binary";
    fmi3SetBinary(vr: References, nvr: usize, sizes: *const usize, values: *const Binary, n: usize)
        "no variable is a Binary";
    fmi3GetClock(vr: References, nvr: usize, values: *mut Clock) "there are no clocks";
    fmi3SetClock(vr: References, nvr: usize, values: *const Clock) "there are no clocks";
    fmi3GetNumberOfVariableDependencies(vr: ValueReference, n: *mut usize)
        "dependencies stand in the model description (providesPerElementDependencies = false)";
    fmi3GetVariableDependencies(
        dependent: ValueReference, elements: *mut usize, independents: *mut ValueReference, others: *mut usize,
        kinds: *mut DependencyKind, n: usize
    ) "dependencies stand in the model description (providesPerElementDependencies = false)";
    fmi3GetDirectionalDerivative(
        unknowns: References, n_unknowns: usize, knowns: References, n_knowns: usize, seed: *const Float64,
        n_seed: usize, sensitivity: *mut Float64, n_sensitivity: usize
    ) "there are no directional derivatives (providesDirectionalDerivatives = false)";
    fmi3GetAdjointDerivative(
        unknowns: References, n_unknowns: usize, knowns: References, n_knowns: usize, seed: *const Float64,
        n_seed: usize, sensitivity: *mut Float64, n_sensitivity: usize
    ) "there are no adjoint derivatives (providesAdjointDerivatives = false)";
    fmi3GetIntervalDecimal(vr: References, nvr: usize, intervals: *mut Float64, qualifiers: *mut IntervalQualifier)
        "there are no clocks";
    fmi3GetIntervalFraction(
        vr: References, nvr: usize, counters: *mut u64, resolutions: *mut u64, qualifiers: *mut IntervalQualifier
    ) "there are no clocks";
    fmi3GetShiftDecimal(vr: References, nvr: usize, shifts: *mut Float64) "there are no clocks";
    fmi3GetShiftFraction(vr: References, nvr: usize, counters: *mut u64, resolutions: *mut u64) "there are no clocks";
    fmi3SetIntervalDecimal(vr: References, nvr: usize, intervals: *const Float64) "there are no clocks";
    fmi3SetIntervalFraction(vr: References, nvr: usize, counters: *const u64, resolutions: *const u64)
        "there are no clocks";
    fmi3SetShiftDecimal(vr: References, nvr: usize, shifts: *const Float64) "there are no clocks";
    fmi3SetShiftFraction(vr: References, nvr: usize, counters: *const u64, resolutions: *const u64)
        "there are no clocks";
    fmi3UpdateDiscreteStates(
        needed: *mut Boolean, terminate: *mut Boolean, nominals: *mut Boolean, values: *mut Boolean,
        defined: *mut Boolean, time: *mut Float64
    ) "there is no event mode (hasEventMode = false)";
    fmi3GetOutputDerivatives(vr: References, nvr: usize, orders: *const i32, values: *mut Float64, n: usize)
        "there are no derivatives of outputs (maxOutputDerivativeOrder = 0)";
    fmi3ActivateModelPartition(clock: ValueReference, time: Float64) "this FMU is for co-simulation";
    fmi3CompletedIntegratorStep(no_set_state: Boolean, event: *mut Boolean, terminate: *mut Boolean)
        "this FMU is for co-simulation";
    fmi3SetTime(time: Float64) "this FMU is for co-simulation";
    fmi3SetContinuousStates(states: *const Float64, n: usize) "this FMU is for co-simulation";
    fmi3GetContinuousStateDerivatives(derivatives: *mut Float64, n: usize) "this FMU is for co-simulation";
    fmi3GetEventIndicators(indicators: *mut Float64, n: usize) "this FMU is for co-simulation";
    fmi3GetContinuousStates(states: *mut Float64, n: usize) "this FMU is for co-simulation";
    fmi3GetNominalsOfContinuousStates(nominals: *mut Float64, n: usize) "this FMU is for co-simulation";
    fmi3GetNumberOfEventIndicators(n: *mut usize) "this FMU is for co-simulation";
    fmi3GetNumberOfContinuousStates(n: *mut usize) "this FMU is for co-simulation";
}

const _: v3::GetBinary = fmi3GetBinary;
const _: v3::SetBinary = fmi3SetBinary;
const _: v3::GetClock = fmi3GetClock;
const _: v3::SetClock = fmi3SetClock;
const _: v3::GetNumberOfVariableDependencies = fmi3GetNumberOfVariableDependencies;
const _: v3::GetVariableDependencies = fmi3GetVariableDependencies;
const _: v3::GetDerivative = fmi3GetDirectionalDerivative;
const _: v3::GetDerivative = fmi3GetAdjointDerivative;
const _: v3::GetIntervalDecimal = fmi3GetIntervalDecimal;
const _: v3::GetIntervalFraction = fmi3GetIntervalFraction;
const _: v3::GetShiftDecimal = fmi3GetShiftDecimal;
const _: v3::GetShiftFraction = fmi3GetShiftFraction;
const _: v3::SetClockDecimal = fmi3SetIntervalDecimal;
const _: v3::SetClockFraction = fmi3SetIntervalFraction;
const _: v3::SetClockDecimal = fmi3SetShiftDecimal;
const _: v3::SetClockFraction = fmi3SetShiftFraction;
const _: v3::UpdateDiscreteStates = fmi3UpdateDiscreteStates;
const _: v3::GetOutputDerivatives = fmi3GetOutputDerivatives;
