//! An instance of an FMU of version 2.0: its functions with the types of Rust.
#![expect(unsafe_code, reason = "calls of a C interface")]
use super::callbacks::{Environment, of_two};
use super::calls::during;
use super::open::Open;
use super::status::{Health, Outcome};
use crate::abi::v2::{
    Boolean, CallbackFunctions, Component, DoStep, FALSE, FmuState, FreeFmuState, FreeInstance, Get, GetFmuState,
    GetStatus, GetTypesPlatform, GetVersion, Instantiate, Integer, Real, Set, SetFmuState, SetRealInputDerivatives,
    SetupExperiment, StatusKind, TRUE, TYPES_PLATFORM, Text, Transition, Type, VERSION,
};
use crate::archive::Unpacked;
use crate::error::{FmuError, LibraryProblem};
use crate::loaded::Slot;
use crate::log::{Clock, Log};
use std::ffi::{CStr, CString, c_int};
use std::mem::ManuallyDrop;
use std::ptr;
use std::rc::Rc;
use std::sync::Arc;

/// `fmi2Boolean`, as a type distinct from `fmi2Integer`, which is the same in C.
#[repr(transparent)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Flag(pub(crate) c_int);

struct Functions {
    instantiate: Instantiate,
    free_instance: FreeInstance,
    setup_experiment: SetupExperiment,
    enter_initialization_mode: Transition,
    exit_initialization_mode: Transition,
    terminate: Transition,
    get_real: Get<Real>,
    get_integer: Get<Integer>,
    get_boolean: Get<Boolean>,
    set_real: Set<Real>,
    set_integer: Set<Integer>,
    set_boolean: Set<Boolean>,
    set_string: Set<Text>,
    do_step: DoStep,
    set_real_input_derivatives: Option<SetRealInputDerivatives>,
    get_real_status: Option<GetStatus<Real>>,
    get_boolean_status: Option<GetStatus<Boolean>>,
    get_state: Option<GetFmuState>,
    set_state: Option<SetFmuState>,
    free_state: Option<FreeFmuState>,
}

impl Functions {
    fn of(library: &Open, fmu: &Unpacked) -> Result<Self, FmuError> {
        let can = &fmu.description().co_simulation;
        // SAFETY: each field has the type that the standard gives to the function of this name.
        let functions = unsafe {
            Self {
                instantiate: library.function("fmi2Instantiate")?,
                free_instance: library.function("fmi2FreeInstance")?,
                setup_experiment: library.function("fmi2SetupExperiment")?,
                enter_initialization_mode: library.function("fmi2EnterInitializationMode")?,
                exit_initialization_mode: library.function("fmi2ExitInitializationMode")?,
                terminate: library.function("fmi2Terminate")?,
                get_real: library.function("fmi2GetReal")?,
                get_integer: library.function("fmi2GetInteger")?,
                get_boolean: library.function("fmi2GetBoolean")?,
                set_real: library.function("fmi2SetReal")?,
                set_integer: library.function("fmi2SetInteger")?,
                set_boolean: library.function("fmi2SetBoolean")?,
                set_string: library.function("fmi2SetString")?,
                do_step: library.function("fmi2DoStep")?,
                set_real_input_derivatives: library.optional("fmi2SetRealInputDerivatives"),
                get_real_status: library.optional("fmi2GetRealStatus"),
                get_boolean_status: library.optional("fmi2GetBooleanStatus"),
                get_state: library.optional("fmi2GetFMUstate"),
                set_state: library.optional("fmi2SetFMUstate"),
                free_state: library.optional("fmi2FreeFMUstate"),
            }
        };
        let lacks =
            |symbol| FmuError::Library { path: fmu.path().to_owned(), problem: LibraryProblem::NoFunction { symbol } };
        if can.can_get_and_set_state && functions.get_state.and(functions.set_state).and(functions.free_state).is_none()
        {
            return Err(lacks("fmi2GetFMUstate, fmi2SetFMUstate, fmi2FreeFMUstate"));
        }
        if can.can_interpolate_inputs && functions.set_real_input_derivatives.is_none() {
            return Err(lacks("fmi2SetRealInputDerivatives"));
        }
        Ok(functions)
    }
}

/// An instance; dropping it terminates it, if it still works, and frees it.
pub(crate) struct Two {
    functions: Functions,
    component: Component,
    environment: Arc<Environment>,
    /// The instance points to it, without a reference count.
    _callbacks: Rc<CallbackFunctions>,
    /// Saved states, by slot.
    states: [FmuState; Slot::COUNT],
    is_initialised: bool,
    is_freed: bool,
    pub(crate) health: Health,
    library: ManuallyDrop<Open>,
}

// SAFETY: the standard lets any thread call an instance, one at a time; calls through a shared reference from another thread are
// impossible, since it is not `Sync`.
unsafe impl Send for Two {}

impl Two {
    pub(crate) fn new(fmu: &Unpacked, instance_name: &CStr, logging: bool, clock: Clock) -> Result<Self, FmuError> {
        let library = Open::new(fmu)?;
        check_platform(&library, fmu)?;
        let functions = Functions::of(&library, fmu)?;
        let environment = Arc::new(Environment::new(clock));
        let callbacks = Rc::new(of_two(Arc::as_ptr(&environment)));
        let refused = |why: String| FmuError::Library {
            path: fmu.path().to_owned(),
            problem: LibraryProblem::Instantiate { call: "fmi2Instantiate", why },
        };
        let token = CString::new(fmu.description().instantiation_token.as_str());
        let token = token.map_err(|error| refused(error.to_string()))?;
        let location = CString::new(file_uri(&fmu.folder().join("resources").to_string_lossy()));
        let location = location.map_err(|error| refused(error.to_string()))?;
        // SAFETY: the texts live during the call, callbacks and environment as long as the instance.
        let component = during("fmi2Instantiate", || unsafe {
            (functions.instantiate)(
                instance_name.as_ptr(),
                Type::CO_SIMULATION,
                token.as_ptr(),
                location.as_ptr(),
                Rc::as_ptr(&callbacks),
                FALSE,
                flag(logging),
            )
        });
        if component.is_null() {
            return Err(refused(environment.log().last()));
        }
        Ok(Self {
            functions,
            component,
            environment,
            _callbacks: callbacks,
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

    pub(crate) fn setup_experiment(&self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> Outcome {
        let (has_tolerance, has_stop) = (flag(tolerance.is_some()), flag(stop.is_some()));
        let (tolerance, stop) = (tolerance.unwrap_or(0.0), stop.unwrap_or(0.0));
        let setup = self.functions.setup_experiment;
        // SAFETY: the instance lives.
        during("fmi2SetupExperiment", || unsafe {
            setup(self.component, has_tolerance, tolerance, start, has_stop, stop)
        })
        .into()
    }

    pub(crate) fn enter_initialization_mode(&self) -> Outcome {
        // SAFETY: the instance lives.
        during("fmi2EnterInitializationMode", || unsafe { (self.functions.enter_initialization_mode)(self.component) })
            .into()
    }

    pub(crate) fn exit_initialization_mode(&mut self) -> Outcome {
        self.is_initialised = true;
        // SAFETY: the instance lives.
        during("fmi2ExitInitializationMode", || unsafe { (self.functions.exit_initialization_mode)(self.component) })
            .into()
    }

    pub(crate) fn set_string(&self, reference: u32, value: &CStr) -> Outcome {
        let set = self.functions.set_string;
        // SAFETY: one reference and one text, which live during the call.
        during("fmi2SetString", || unsafe { set(self.component, &raw const reference, 1, &value.as_ptr()) }).into()
    }

    /// Sets derivatives of one order of inputs.
    pub(crate) fn set_input_derivatives(&self, references: &[u32], orders: &[Integer], values: &[f64]) -> Outcome {
        let count = references.len();
        debug_assert!(count == orders.len() && count == values.len());
        let Some(set) = self.functions.set_real_input_derivatives else { return Outcome::Done };
        // SAFETY: all three have `count` elements.
        during("fmi2SetRealInputDerivatives", || unsafe {
            set(self.component, references.as_ptr(), count, orders.as_ptr(), values.as_ptr())
        })
        .into()
    }

    pub(crate) fn do_step(&self, time: f64, length: f64, never_goes_back: bool) -> Outcome {
        // SAFETY: the instance lives.
        during("fmi2DoStep", || unsafe {
            (self.functions.do_step)(self.component, time, length, flag(never_goes_back))
        })
        .into()
    }

    /// Time (s) that a discarded step reached, if the FMU reports it.
    pub(crate) fn last_successful_time(&self) -> Option<f64> {
        let mut time = f64::NAN;
        let ask = self.functions.get_real_status?;
        // SAFETY: the value lives during the call.
        let status = during("fmi2GetRealStatus", || unsafe {
            ask(self.component, StatusKind::LAST_SUCCESSFUL_TIME, &raw mut time)
        });
        (Outcome::from(status) == Outcome::Done && time.is_finite()).then_some(time)
    }

    /// True if the FMU wants the simulation to end, after a discarded step.
    pub(crate) fn wants_to_end(&self) -> bool {
        let Some(ask) = self.functions.get_boolean_status else { return false };
        let mut wants = FALSE;
        // SAFETY: the value lives during the call.
        let status =
            during("fmi2GetBooleanStatus", || unsafe { ask(self.component, StatusKind::TERMINATED, &raw mut wants) });
        Outcome::from(status) == Outcome::Done && wants != FALSE
    }

    pub(crate) fn save(&mut self, slot: Slot) -> Option<Outcome> {
        let get = self.functions.get_state?;
        let (component, state) = (self.component, &raw mut self.states[slot as usize]);
        // SAFETY: the state is NULL or belongs to this instance.
        Some(during("fmi2GetFMUstate", || unsafe { get(component, state) }).into())
    }

    /// True if a state has been saved.
    pub(crate) fn has_saved(&self) -> bool {
        self.states.iter().any(|state| !state.is_null())
    }

    pub(crate) fn restore(&self, slot: Slot) -> Option<Outcome> {
        let state = self.states[slot as usize];
        let set = self.functions.set_state.filter(|_| !state.is_null())?;
        // SAFETY: the state belongs to this instance.
        Some(during("fmi2SetFMUstate", || unsafe { set(self.component, state) }).into())
    }
}

impl Two {
    /// Terminates the instance, if it still works, and frees it; a failure is a warning in its log. Only the log may be used afterwards.
    pub(crate) fn end(&mut self) {
        // After a fatal error no function may be called: the library stays loaded, with its memory.
        if self.health == Health::Dead || std::mem::replace(&mut self.is_freed, true) {
            return;
        }
        if let Some(free) = self.functions.free_state {
            for state in self.states.iter_mut().filter(|state| !state.is_null()) {
                // SAFETY: it belongs to this instance and is not used again.
                during("fmi2FreeFMUstate", || unsafe { free(self.component, state) });
            }
        }
        if self.is_initialised && self.health == Health::Well {
            // SAFETY: the instance lives.
            let outcome = during("fmi2Terminate", || unsafe { (self.functions.terminate)(self.component) });
            Outcome::from(outcome).warn("fmi2Terminate", &mut self.health, self.environment.log());
        }
        if self.health != Health::Dead {
            // SAFETY: it is not used again.
            during("fmi2FreeInstance", || unsafe { (self.functions.free_instance)(self.component) });
        }
    }
}

impl Drop for Two {
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
    ($type:ty as $raw:ty, $get:ident, $set:ident, $name:literal) => {
        impl super::Access<$type> for Two {
            fn get(&self, references: &[u32], values: &mut [$type]) -> super::Called {
                debug_assert_eq!(references.len(), values.len());
                let values = values.as_mut_ptr().cast::<$raw>();
                let call = concat!("fmi2Get", $name);
                // SAFETY: as many values as references; the types have the same representation.
                let status = during(call, || unsafe {
                    (self.functions.$get)(self.component, references.as_ptr(), references.len(), values)
                });
                (call, status.into())
            }

            fn set(&self, references: &[u32], values: &[$type]) -> super::Called {
                debug_assert_eq!(references.len(), values.len());
                let values = values.as_ptr().cast::<$raw>();
                let call = concat!("fmi2Set", $name);
                // SAFETY: as many values as references; the types have the same representation.
                let status = during(call, || unsafe {
                    (self.functions.$set)(self.component, references.as_ptr(), references.len(), values)
                });
                (call, status.into())
            }
        }
    };
}

access!(f64 as Real, get_real, set_real, "Real");
access!(i32 as Integer, get_integer, set_integer, "Integer");
access!(Flag as Boolean, get_boolean, set_boolean, "Boolean");

fn flag(is: bool) -> Boolean {
    if is { TRUE } else { FALSE }
}

/// Checks that the library is for these types and this version.
fn check_platform(library: &Open, fmu: &Unpacked) -> Result<(), FmuError> {
    // SAFETY: the types are those of the functions, which return a text of the library's.
    let said = unsafe {
        let ask: [(GetVersion, &str, &str); 2] = [
            (library.function::<GetTypesPlatform>("fmi2GetTypesPlatform")?, "fmi2GetTypesPlatform", TYPES_PLATFORM),
            (library.function("fmi2GetVersion")?, "fmi2GetVersion", VERSION),
        ];
        ask.map(|(ask, call, wanted)| {
            let text = during(call, || ask());
            let said =
                if text.is_null() { "nothing".into() } else { CStr::from_ptr(text).to_string_lossy().into_owned() };
            (call, wanted, said)
        })
    };
    for (call, wanted, said) in said {
        // FMI 2.0.1 and later are still "2.0"; some libraries append more.
        if !said.starts_with(wanted) {
            let problem = LibraryProblem::Says { call, said, wanted };
            return Err(FmuError::Library { path: fmu.path().to_owned(), problem });
        }
    }
    Ok(())
}

/// A path as a URI (RFC 3986, RFC 8089): characters that are neither unreserved nor a slash are written in hexadecimal.
fn file_uri(path: &str) -> String {
    use std::fmt::Write;
    path.bytes().fold("file://".to_owned(), |mut uri, byte| {
        if byte.is_ascii_alphanumeric() || b"/-._~".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            // Writing to a string does not fail.
            write!(uri, "%{byte:02X}").unwrap_or_default();
        }
        uri
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_with_blanks_is_a_uri() {
        assert_eq!(file_uri("/tmp/a b/ü#1"), "file:///tmp/a%20b/%C3%BC%231");
    }
}
