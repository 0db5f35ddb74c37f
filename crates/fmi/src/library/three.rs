//! An instance of an FMU of version 3.0: its functions with the types of Rust.
#![expect(unsafe_code, reason = "calls of a C interface")]
use super::callbacks::{Environment, log_three};
use super::calls::during;
use super::open::Open;
use super::status::{Health, Outcome};
use crate::abi::v3::{
    Boolean, DoStep, EnterInitializationMode, FALSE, FmuState, FreeFmuState, FreeInstance, Get, GetFmuState,
    GetVersion, Instance, InstantiateCoSimulation, Set, SetBinary, SetFmuState, TRUE, Text, Transition,
    UpdateDiscreteStates, VERSION,
};
use crate::archive::Unpacked;
use crate::error::{FmuError, LibraryProblem};
use crate::loaded::Slot;
use crate::log::{Clock, Log};
use std::ffi::{CStr, CString};
use std::mem::ManuallyDrop;
use std::ptr;
use std::sync::Arc;

/// `fmi3Boolean`, as a type distinct from `fmi3UInt8`, which is the same in C.
#[repr(transparent)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Flag(pub(crate) u8);

macro_rules! functions {
    (
        required { $($field:ident: $type:ty = $name:literal,)* }
        optional { $($maybe:ident: $maybe_type:ty = $maybe_name:literal,)* }
    ) => {
        struct Functions {
            $($field: $type,)*
            $($maybe: Option<$maybe_type>,)*
        }

        impl Functions {
            fn find(library: &Open) -> Result<Self, FmuError> {
                // SAFETY: each field has the type that the standard gives to the function of this name.
                unsafe {
                    Ok(Self {
                        $($field: library.function($name)?,)*
                        $($maybe: library.optional($maybe_name),)*
                    })
                }
            }
        }
    };
}

functions! {
    required {
    instantiate: InstantiateCoSimulation = "fmi3InstantiateCoSimulation",
    free_instance: FreeInstance = "fmi3FreeInstance",
    enter_initialization_mode: EnterInitializationMode = "fmi3EnterInitializationMode",
    exit_initialization_mode: Transition = "fmi3ExitInitializationMode",
    terminate: Transition = "fmi3Terminate",
    get_f32: Get<f32> = "fmi3GetFloat32",
    get_f64: Get<f64> = "fmi3GetFloat64",
    get_i8: Get<i8> = "fmi3GetInt8",
    get_u8: Get<u8> = "fmi3GetUInt8",
    get_i16: Get<i16> = "fmi3GetInt16",
    get_u16: Get<u16> = "fmi3GetUInt16",
    get_i32: Get<i32> = "fmi3GetInt32",
    get_u32: Get<u32> = "fmi3GetUInt32",
    get_i64: Get<i64> = "fmi3GetInt64",
    get_u64: Get<u64> = "fmi3GetUInt64",
    get_boolean: Get<Boolean> = "fmi3GetBoolean",
    set_f32: Set<f32> = "fmi3SetFloat32",
    set_f64: Set<f64> = "fmi3SetFloat64",
    set_i8: Set<i8> = "fmi3SetInt8",
    set_u8: Set<u8> = "fmi3SetUInt8",
    set_i16: Set<i16> = "fmi3SetInt16",
    set_u16: Set<u16> = "fmi3SetUInt16",
    set_i32: Set<i32> = "fmi3SetInt32",
    set_u32: Set<u32> = "fmi3SetUInt32",
    set_i64: Set<i64> = "fmi3SetInt64",
    set_u64: Set<u64> = "fmi3SetUInt64",
    set_boolean: Set<Boolean> = "fmi3SetBoolean",
    set_string: Set<Text> = "fmi3SetString",
    set_binary: SetBinary = "fmi3SetBinary",
    do_step: DoStep = "fmi3DoStep",
    }
    optional {
    enter_configuration_mode: Transition = "fmi3EnterConfigurationMode",
    exit_configuration_mode: Transition = "fmi3ExitConfigurationMode",
    enter_event_mode: Transition = "fmi3EnterEventMode",
    enter_step_mode: Transition = "fmi3EnterStepMode",
    update_discrete_states: UpdateDiscreteStates = "fmi3UpdateDiscreteStates",
    get_state: GetFmuState = "fmi3GetFMUState",
    set_state: SetFmuState = "fmi3SetFMUState",
    free_state: FreeFmuState = "fmi3FreeFMUState",
    }
}

impl Functions {
    fn of(library: &Open, fmu: &Unpacked) -> Result<Self, FmuError> {
        let can = &fmu.description().co_simulation;
        let functions = Self::find(library)?;
        let lacks =
            |symbol| FmuError::Library { path: fmu.path().to_owned(), problem: LibraryProblem::NoFunction { symbol } };
        if can.can_get_and_set_state && functions.get_state.and(functions.set_state).and(functions.free_state).is_none()
        {
            return Err(lacks("fmi3GetFMUState, fmi3SetFMUState, fmi3FreeFMUState"));
        }
        let modes = functions.enter_event_mode.and(functions.enter_step_mode);
        if can.has_event_mode && modes.and(functions.update_discrete_states.map(|_| ())).is_none() {
            return Err(lacks("fmi3EnterEventMode, fmi3EnterStepMode, fmi3UpdateDiscreteStates"));
        }
        Ok(functions)
    }
}

/// Results of a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stepped {
    pub(crate) event_handling_needed: bool,
    pub(crate) terminate_simulation: bool,
    pub(crate) early_return: bool,
    /// (s)
    pub(crate) last_successful_time: f64,
}

/// Results of an update of the discrete states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Updated {
    /// True if another update is needed.
    pub(crate) again: bool,
    pub(crate) terminate_simulation: bool,
    /// (s)
    pub(crate) next_event_time: Option<f64>,
}

/// An instance; dropping it terminates it, if it still works, and frees it.
pub(crate) struct Three {
    functions: Functions,
    instance: Instance,
    environment: Arc<Environment>,
    /// Saved states, by slot.
    states: [FmuState; Slot::COUNT],
    is_initialised: bool,
    is_freed: bool,
    pub(crate) health: Health,
    library: ManuallyDrop<Open>,
}

// SAFETY: the standard lets any thread call an instance, one at a time; calls through a shared reference from another thread are
// impossible, since it is not `Sync`.
unsafe impl Send for Three {}

impl Three {
    pub(crate) fn new(
        fmu: &Unpacked,
        instance_name: &CStr,
        logging: bool,
        event_mode: bool,
        clock: Clock,
    ) -> Result<Self, FmuError> {
        let library = Open::new(fmu)?;
        check_version(&library, fmu)?;
        let functions = Functions::of(&library, fmu)?;
        let environment = Arc::new(Environment::new(clock));
        let refused = |why: String| FmuError::Library {
            path: fmu.path().to_owned(),
            problem: LibraryProblem::Instantiate { call: "fmi3InstantiateCoSimulation", why },
        };
        let can = &fmu.description().co_simulation;
        let token = CString::new(fmu.description().instantiation_token.as_str());
        let token = token.map_err(|error| refused(error.to_string()))?;
        let resources = fmu.folder().join("resources");
        // A path that ends with a separator; NULL without resources.
        let resources = resources.is_dir().then(|| CString::new(format!("{}/", resources.display())));
        let resources = resources.transpose().map_err(|error| refused(error.to_string()))?;
        // SAFETY: the texts live during the call, the environment as long as the instance.
        let instance = during("fmi3InstantiateCoSimulation", || unsafe {
            (functions.instantiate)(
                instance_name.as_ptr(),
                token.as_ptr(),
                resources.as_ref().map_or(ptr::null(), |path| path.as_ptr()),
                FALSE,
                flag(logging),
                flag(event_mode),
                flag(can.might_return_early_from_do_step),
                ptr::null(),
                0,
                Arc::as_ptr(&environment).cast_mut().cast(),
                Some(log_three),
                None,
            )
        });
        if instance.is_null() {
            return Err(refused(environment.log().last()));
        }
        Ok(Self {
            functions,
            instance,
            environment,
            states: [ptr::null_mut(); Slot::COUNT],
            is_initialised: false,
            is_freed: false,
            health: Health::Well,
            library: ManuallyDrop::new(library),
        })
    }

    pub(crate) fn log(&self) -> &Log {
        self.environment.log()
    }

    /// Changes the mode, by a function that the FMU may lack: then it does nothing.
    fn transition(&self, call: &'static str, function: Option<Transition>) -> Outcome {
        // SAFETY: the instance lives.
        function.map_or(Outcome::Done, |function| during(call, || unsafe { function(self.instance) }).into())
    }

    pub(crate) fn has_configuration_mode(&self) -> bool {
        self.functions.enter_configuration_mode.and(self.functions.exit_configuration_mode).is_some()
    }

    pub(crate) fn enter_configuration_mode(&self) -> Outcome {
        self.transition("fmi3EnterConfigurationMode", self.functions.enter_configuration_mode)
    }

    pub(crate) fn exit_configuration_mode(&self) -> Outcome {
        self.transition("fmi3ExitConfigurationMode", self.functions.exit_configuration_mode)
    }

    pub(crate) fn enter_initialization_mode(&self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Outcome {
        let (has_tolerance, has_stop) = (flag(tolerance.is_some()), flag(stop.is_some()));
        let (tolerance, stop) = (tolerance.unwrap_or(0.0), stop.unwrap_or(0.0));
        let enter = self.functions.enter_initialization_mode;
        // SAFETY: the instance lives.
        during("fmi3EnterInitializationMode", || unsafe {
            enter(self.instance, has_tolerance, tolerance, start, has_stop, stop)
        })
        .into()
    }

    pub(crate) fn exit_initialization_mode(&mut self) -> Outcome {
        self.is_initialised = true;
        self.transition("fmi3ExitInitializationMode", Some(self.functions.exit_initialization_mode))
    }

    pub(crate) fn enter_event_mode(&self) -> Outcome {
        self.transition("fmi3EnterEventMode", self.functions.enter_event_mode)
    }

    pub(crate) fn enter_step_mode(&self) -> Outcome {
        self.transition("fmi3EnterStepMode", self.functions.enter_step_mode)
    }

    pub(crate) fn update_discrete_states(&self) -> (Outcome, Updated) {
        let (mut again, mut end, mut others, mut next) = (FALSE, FALSE, [FALSE; 3], 0.0);
        let [nominals, values, has_next] = &mut others;
        let status = self.functions.update_discrete_states.map_or(Outcome::Done, |update| {
            // SAFETY: all that is written to lives during the call.
            during("fmi3UpdateDiscreteStates", || unsafe {
                update(self.instance, &raw mut again, &raw mut end, nominals, values, has_next, &raw mut next)
            })
            .into()
        });
        let next_event_time = (*has_next != FALSE).then_some(next);
        (status, Updated { again: again != FALSE, terminate_simulation: end != FALSE, next_event_time })
    }

    pub(crate) fn set_strings(&self, reference: u32, values: &[CString]) -> Outcome {
        let texts: Vec<Text> = values.iter().map(|value| value.as_ptr()).collect();
        let set = self.functions.set_string;
        // SAFETY: one reference and all texts of its array, which live during the call.
        during("fmi3SetString", || unsafe { set(self.instance, &raw const reference, 1, texts.as_ptr(), texts.len()) })
            .into()
    }

    pub(crate) fn set_binaries(&self, reference: u32, values: &[Vec<u8>]) -> Outcome {
        let sizes: Vec<usize> = values.iter().map(Vec::len).collect();
        let all: Vec<*const u8> = values.iter().map(Vec::as_ptr).collect();
        let set = self.functions.set_binary;
        // SAFETY: one reference and all elements of its array with their sizes, which live during the call.
        during("fmi3SetBinary", || unsafe {
            set(self.instance, &raw const reference, 1, sizes.as_ptr(), all.as_ptr(), all.len())
        })
        .into()
    }

    pub(crate) fn do_step(&self, time: f64, length: f64, never_goes_back: bool) -> (Outcome, Stepped) {
        let (mut event, mut end, mut early, mut last) = (FALSE, FALSE, FALSE, time + length);
        let never = flag(never_goes_back);
        let step = self.functions.do_step;
        // SAFETY: all that is written to lives during the call.
        let status = during("fmi3DoStep", || unsafe {
            step(self.instance, time, length, never, &raw mut event, &raw mut end, &raw mut early, &raw mut last)
        });
        let stepped = Stepped {
            event_handling_needed: event != FALSE,
            terminate_simulation: end != FALSE,
            early_return: early != FALSE,
            last_successful_time: last,
        };
        (status.into(), stepped)
    }

    pub(crate) fn save(&mut self, slot: Slot) -> Option<Outcome> {
        let get = self.functions.get_state?;
        let (instance, state) = (self.instance, &raw mut self.states[slot as usize]);
        // SAFETY: the state is NULL or belongs to this instance.
        Some(during("fmi3GetFMUState", || unsafe { get(instance, state) }).into())
    }

    /// True if a state has been saved.
    pub(crate) fn has_saved(&self) -> bool {
        self.states.iter().any(|state| !state.is_null())
    }

    pub(crate) fn restore(&self, slot: Slot) -> Option<Outcome> {
        let state = self.states[slot as usize];
        let set = self.functions.set_state.filter(|_| !state.is_null())?;
        // SAFETY: the state belongs to this instance.
        Some(during("fmi3SetFMUState", || unsafe { set(self.instance, state) }).into())
    }
}

impl Three {
    /// Terminates the instance, if it still works, and frees it; a failure is a warning in its log. Only the log may be used afterwards.
    pub(crate) fn end(&mut self) {
        // After a fatal error no function may be called: the library stays loaded, with its memory.
        if self.health == Health::Dead || std::mem::replace(&mut self.is_freed, true) {
            return;
        }
        if let Some(free) = self.functions.free_state {
            for state in self.states.iter_mut().filter(|state| !state.is_null()) {
                // SAFETY: it belongs to this instance and is not used again.
                during("fmi3FreeFMUState", || unsafe { free(self.instance, state) });
            }
        }
        if self.is_initialised && self.health == Health::Well {
            // SAFETY: the instance lives.
            let outcome = during("fmi3Terminate", || unsafe { (self.functions.terminate)(self.instance) });
            Outcome::from(outcome).warn("fmi3Terminate", &mut self.health, self.environment.log());
        }
        if self.health != Health::Dead {
            // SAFETY: it is not used again.
            during("fmi3FreeInstance", || unsafe { (self.functions.free_instance)(self.instance) });
        }
    }
}

impl Drop for Three {
    fn drop(&mut self) {
        self.end();
        if self.health != Health::Dead {
            // SAFETY: neither it nor anything of the library is used again.
            during("dlclose", || unsafe { ManuallyDrop::drop(&mut self.library) });
        }
    }
}

/// A type of values that are set and read.
macro_rules! access {
    ($($type:ty as $raw:ty, $get:ident, $set:ident, $name:literal;)*) => {$(
        impl super::Access<$type> for Three {
            fn get(&self, references: &[u32], values: &mut [$type]) -> super::Called {
                let (all, count) = (values.as_mut_ptr().cast::<$raw>(), values.len());
                let (call, get) = (concat!("fmi3Get", $name), self.functions.$get);
                // SAFETY: both live during the call with the given lengths; the types have the same representation.
                let status =
                    during(call, || unsafe { get(self.instance, references.as_ptr(), references.len(), all, count) });
                (call, status.into())
            }

            fn set(&self, references: &[u32], values: &[$type]) -> super::Called {
                let (all, count) = (values.as_ptr().cast::<$raw>(), values.len());
                let (call, set) = (concat!("fmi3Set", $name), self.functions.$set);
                // SAFETY: both live during the call with the given lengths; the types have the same representation.
                let status =
                    during(call, || unsafe { set(self.instance, references.as_ptr(), references.len(), all, count) });
                (call, status.into())
            }
        }
    )*};
}

access! {
    f32 as f32, get_f32, set_f32, "Float32";
    f64 as f64, get_f64, set_f64, "Float64";
    i8 as i8, get_i8, set_i8, "Int8";
    u8 as u8, get_u8, set_u8, "UInt8";
    i16 as i16, get_i16, set_i16, "Int16";
    u16 as u16, get_u16, set_u16, "UInt16";
    i32 as i32, get_i32, set_i32, "Int32";
    u32 as u32, get_u32, set_u32, "UInt32";
    i64 as i64, get_i64, set_i64, "Int64";
    u64 as u64, get_u64, set_u64, "UInt64";
    Flag as Boolean, get_boolean, set_boolean, "Boolean";
}

fn flag(is: bool) -> Boolean {
    if is { TRUE } else { FALSE }
}

/// Checks that the library is for this version.
fn check_version(library: &Open, fmu: &Unpacked) -> Result<(), FmuError> {
    let call = "fmi3GetVersion";
    // SAFETY: the type is that of the function, which returns a text of the library's.
    let said = unsafe {
        let ask = library.function::<GetVersion>(call)?;
        let text = during(call, || ask());
        if text.is_null() { "nothing".into() } else { CStr::from_ptr(text).to_string_lossy().into_owned() }
    };
    if said.starts_with(VERSION) {
        return Ok(());
    }
    let problem = LibraryProblem::Says { call, said, wanted: VERSION };
    Err(FmuError::Library { path: fmu.path().to_owned(), problem })
}
